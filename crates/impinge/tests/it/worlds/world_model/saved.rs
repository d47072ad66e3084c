//! Compares restored worlds with the worlds from which they were saved, after equal random
//! operations.

use impinge::math::{Point, Vector};
use impinge::shape::{Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionObject, Registry, RestoreError, SavedWorld};
use impinge_reference::random::Random;

use super::draw::Grid;
use super::forks::{FILTERS, World, digest, is_updated_by, new_world, position};
use crate::support::samples::samples;

/// The largest number of operations that are compared before the restored world is replaced.
const TOGETHER: usize = 200;

fn registry<N: Grid<D>, const D: usize>() -> Registry<N, D, u64> {
    let named = |registry, number: usize| N::name(registry, &number.to_string(), number);
    FILTERS.into_iter().fold(Registry::new(), named)
}

/// Saves a world as text or as bytes, and restores it.
fn restored<N: Grid<D>, const D: usize>(world: &World<N, D>, as_text: bool) -> World<N, D> {
    let registry = registry();
    if as_text {
        let text = serde_json::to_string(world).expect("it can be saved");
        let mut source = serde_json::Deserializer::from_str(&text);
        registry.restore(&mut source).expect("saved just now")
    } else {
        let bytes = postcard::to_allocvec(world).expect("it can be saved");
        let saved: SavedWorld<N, D, u64> = postcard::from_bytes(&bytes).expect("saved just now");
        saved.restore(&registry).expect("saved just now")
    }
}

/// Returns the shapes that can be saved, and their mirror images. Custom shapes of the table cannot
/// be saved.
fn shapes<N: Grid<D>, const D: usize>() -> Vec<ShapeHandle<N, D>> {
    let own = ["support map", "pieces"];
    let shapes = N::all_shapes(0.5).into_iter().filter(|(name, _)| !own.contains(name));
    let mut shapes: Vec<_> = shapes.map(|(_, shape)| shape).collect();
    let mut mirror = Vector::<N, D>::repeat(N::ONE);
    mirror[0] = -N::ONE;
    let mirrored: Vec<_> = shapes.iter().filter_map(|shape| shape.scaled(&mirror).ok()).collect();
    assert!(mirrored.len() > 10, "most shapes have a mirror image");
    shapes.extend(mirrored);
    shapes
}

/// Performs the operation that `seed` determines: one of [`is_updated_by`], another shape of any
/// kind, moved vertices of a mesh or polyline, or new positions of all objects.
fn change<N: Grid<D>, const D: usize>(
    world: &mut World<N, D>,
    shapes: &[ShapeHandle<N, D>],
    seed: u64,
) {
    let random = &mut Random::new(seed);
    let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    if handles.is_empty() || random.chance(0.75) {
        is_updated_by(world, random.bits());
        return;
    }
    let handle = *random.pick(&handles);
    match random.below(5) {
        0 => world.set_shape(handle, random.pick(shapes).clone()),
        1 => {
            let mut moved = |points: &[Point<N, D>]| moved(points, random);
            let _ = world.try_deform(handle, |mesh: &mut TriMesh<N, D>| {
                mesh.set_vertices(&moved(mesh.vertices()));
            });
            let _ = world.try_deform(handle, |line: &mut Polyline<N, D>| {
                line.set_vertices(&moved(line.vertices()));
            });
        }
        _ => {
            for handle in handles {
                world.set_position(handle, position::<N, D>(random));
            }
        }
    }
}

/// Returns the points, each displaced by up to 0.1 along each axis.
fn moved<N: Grid<D>, const D: usize>(
    points: &[Point<N, D>],
    random: &mut Random,
) -> Vec<Point<N, D>> {
    let mut move_one = |point: &Point<N, D>| {
        point + Vector::<N, D>::from_fn(|_, _| N::lit(random.range(-0.1, 0.1)))
    };
    points.iter().map(&mut move_one).collect()
}

/// Performs equal operations on a world and on a restored copy, and compares their digests after
/// each.
fn run<N: Grid<D>, const D: usize>(seed: u64) {
    let (random, shapes) = (&mut Random::new(seed), shapes::<N, D>());
    let mut world = new_world::<N, D>(seed);
    let (mut twin, mut age, mut most, mut saved) = (None, 0, 0, 0);
    for operation in 0..samples(1500) {
        if twin.is_none() || age > TOGETHER || random.chance(0.02) {
            let again = restored(&world, random.chance(0.5));
            assert_eq!(again.validate(), world.validate(), "the parts agree, but for what waits");
            assert_eq!(digest(&again), digest(&world), "restored at {operation} of {seed}");
            if random.chance(0.5) {
                world = restored(&again, false);
            }
            (twin, age, saved) = (Some(again), 0, saved + 1);
        }
        let seed = random.bits();
        change(&mut world, &shapes, seed);
        let twin = twin.as_mut().expect("restored above");
        change(twin, &shapes, seed);
        assert_eq!(digest(twin), digest(&world), "{age} operations on, at {operation}");
        age += 1;
        most = most.max(world.contact_manifolds().count());
    }
    assert!(saved > 20 && most > 20, "{saved} {most}");
}

#[test]
fn restored_worlds_go_on_in_plane() {
    run::<f32, 2>(1);
    run::<f64, 2>(2);
}

#[test]
fn restored_worlds_go_on_in_space() {
    run::<f32, 3>(4);
    run::<f64, 3>(3);
}

/// Truncates the bytes of a saved world or flips some of their bits. Asserts that such bytes are
/// refused, or restored as a world that can be used.
#[test]
fn damaged_worlds_are_refused_or_valid() {
    damage::<f32, 2>(1);
    damage::<f64, 3>(2);
}

fn damage<N: Grid<D>, const D: usize>(seed: u64) {
    let (random, shapes) = (&mut Random::new(seed), shapes::<N, D>());
    let mut world = new_world::<N, D>(seed);
    for _ in 0..300 {
        change(&mut world, &shapes, random.bits());
    }
    let bytes = postcard::to_allocvec(&world).expect("it can be saved");
    let registry = registry::<N, D>();
    let restore = |bytes: &[u8]| {
        let saved: SavedWorld<N, D, u64> = postcard::from_bytes(bytes).ok()?;
        Some(saved.restore(&registry))
    };
    for length in 0..bytes.len().min(400) {
        assert!(restore(&bytes[..length]).is_none(), "cut after {length} bytes");
    }
    let (mut refused, mut read) = (0, 0);
    for _ in 0..samples(2000) {
        let mut damaged = bytes.clone();
        for _ in 0..1 + random.below(3) {
            let (at, bit) = (random.below(damaged.len()), random.below(8));
            damaged[at] ^= 1 << bit;
        }
        match restore(&damaged) {
            Some(Ok(mut world)) => {
                use_up(&mut world, &shapes, random);
                read += 1;
            }
            Some(Err(RestoreError::Damaged { .. })) => refused += 1,
            _ => {}
        }
    }
    assert!(refused > 100 && read > 100, "{refused} refused, {read} read");
}

/// Performs random operations on a world that was restored from damaged bytes, and reads its
/// contacts.
fn use_up<N: Grid<D>, const D: usize>(
    world: &mut World<N, D>,
    shapes: &[ShapeHandle<N, D>],
    random: &mut Random,
) {
    for _ in 0..10 {
        read(world);
        change(world, shapes, random.bits());
    }
    world.update();
    read(world);
}

/// Asserts that views and manifolds have equal numbers of contacts of positive depth, where depths
/// may be NaN or infinite. Reads the events too.
fn read<N: Grid<D>, const D: usize>(world: &World<N, D>) {
    let points = world.contact_views().flat_map(|(_, _, view)| view.contacts());
    let points = points.filter(|point| point.contact.depth > N::ZERO).count();
    let tracked = world.contact_manifolds().flat_map(|(_, _, manifold)| manifold.contacts());
    let tracked = tracked.filter(|tracked| tracked.contact.depth > N::ZERO).count();
    assert_eq!(points, tracked, "as many in manifolds as in views");
    let names = world.contact_events().iter().map(|event| event.handles().0);
    let gone = names.filter(|handle| world.removed_object(*handle).is_some()).count();
    let most = world.contact_events().len();
    assert!(gone <= most && world.proximity_pairs().count() < 10_000, "{gone} of {most}");
}
