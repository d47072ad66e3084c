//! Tests that worlds are scale invariant: if all lengths are scaled by a power of two, all
//! resulting lengths are scaled to the bit, and everything else stays the same.

use crate::support::scene_stage;

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Real, Vector};
use impinge::query::{ContactManifold, Ray, TrackedContact};
use impinge::world::CollisionGroups;
use impinge_scenes::{Scene, mixed_shapes, mixed_sizes, pile, sparse_drift, tower};
use scene_stage::{Play, Player, World};

/// Exponents of the scale factors: negative and positive, even and odd.
const POWERS: [i32; 4] = [-20, -7, 9, 20];

fn power_of_two(k: i32) -> f64 {
    let power = |k: u32| f64::from(1_u32 << k);
    if k < 0 { 1.0 / power(k.unsigned_abs()) } else { power(k.unsigned_abs()) }
}

/// Returns `true` if `x * scale` and `y` have the same bits, up to the sign of zero.
fn is_scaled<N: Real>(x: N, y: N, scale: N) -> bool {
    (x * scale).bits() == y.bits() || x == N::ZERO && y == N::ZERO
}

fn check_lengths<N: Real>(lengths: &[N], scaled: &[N], scale: N, place: &str) {
    assert_eq!(lengths.len(), scaled.len(), "{place}");
    for (x, y) in lengths.iter().zip(scaled) {
        assert!(is_scaled(*x, *y, scale), "{place}: {x} became {y}, not {}", *x * scale);
    }
}

/// Asserts that all lengths of `scaled` are those of `usual` times `scale`, to the bit, and that
/// everything else is equal.
fn check_manifolds<N: Real, const D: usize>(
    usual: &ContactManifold<N, D>,
    scaled: &ContactManifold<N, D>,
    scale: N,
    place: &str,
) {
    assert_eq!(usual.len(), scaled.len(), "{place}: as many points");
    assert_eq!(usual.deepest_contact_id(), scaled.deepest_contact_id(), "{place}");
    for (a, b) in usual.contacts().iter().zip(scaled.contacts()) {
        let lengths = |tracked: &TrackedContact<N, D>| {
            let contact = tracked.contact;
            let points = contact.world1.coords.iter().chain(contact.world2.coords.iter());
            points.copied().chain([contact.depth]).collect::<Vec<N>>()
        };
        check_lengths(&lengths(a), &lengths(b), scale, place);
        let normals = (a.contact.normal.as_slice(), b.contact.normal.as_slice());
        check_lengths(normals.0, normals.1, N::ONE, place);
        assert_eq!(a.id, b.id, "{place}: names");
        assert_eq!(a.kinematic.feature1(), b.kinematic.feature1(), "{place}: features");
        assert_eq!(a.kinematic.feature2(), b.kinematic.feature2(), "{place}: features");
    }
}

/// Asserts that two worlds report the same except for the scale of lengths; returns the number of
/// contacts.
fn check_worlds<N: Play<D>, const D: usize>(
    usual: &World<N, D>,
    scaled: &World<N, D>,
    scale: N,
    place: &str,
) -> usize {
    // Compared as text: handles of two worlds differ, but their text is the same.
    let events = [usual, scaled]
        .map(|world| format!("{:?} {:?}", world.contact_events(), world.proximity_events()));
    assert_eq!(events[0], events[1], "{place}");
    let pairs = |world: &World<N, D>| {
        let pairs = world.proximity_pairs();
        pairs.map(|(a, b, pair)| (a.handle().uid(), b.handle().uid(), pair)).collect::<Vec<_>>()
    };
    assert_eq!(pairs(usual), pairs(scaled), "{place}: proximities");
    let (manifolds, others) = (usual.contact_manifolds(), scaled.contact_manifolds());
    let (manifolds, others): (Vec<_>, Vec<_>) = (manifolds.collect(), others.collect());
    assert_eq!(manifolds.len(), others.len(), "{place}: as many manifolds");
    for ((a1, a2, a), (b1, b2, b)) in manifolds.iter().zip(&others) {
        let uids = [a1, a2, b1, b2].map(|object| object.handle().uid());
        assert_eq!(uids[..2], uids[2..], "{place}: pairs");
        let place = format!("{place}, {:?} and {:?}", a1.shape(), a2.shape());
        check_manifolds(a, b, scale, &place);
    }
    manifolds.iter().map(|(.., manifold)| manifold.len()).sum()
}

/// Asserts that rays, points and boxes find the same objects in both worlds, and that the times of
/// ray hits differ by the factor `scale`. Returns the number of ray hits.
fn check_queries<N: Play<D>, const D: usize>(
    usual: &World<N, D>,
    scaled: &World<N, D>,
    scale: N,
    place: &str,
) -> usize {
    let (all, mut hits) = (CollisionGroups::new(), 0);
    for object in usual.collision_objects().take(40) {
        let at = N::pose(object.position()).translation;
        let direction = Vector::<N, D>::from_fn(|axis, _| N::lit([0.75, -0.5, 0.25][axis]));
        let origin = at - direction * N::lit(3.0);
        let cast = |world: &World<N, D>, scale: N| {
            let ray = Ray::new(Point::from(origin * scale), direction);
            let found = world.interferences_with_ray(&ray, &all);
            found.map(|(object, hit)| (object.handle().uid(), hit)).collect::<Vec<_>>()
        };
        let (found, others) = (cast(usual, N::ONE), cast(scaled, scale));
        assert_eq!(found.len(), others.len(), "{place}: rays");
        for ((a, hit), (b, other)) in found.iter().zip(&others) {
            assert_eq!((a, hit.feature), (b, other.feature), "{place}: rays");
            check_lengths(&[hit.toi], &[other.toi], scale, place);
            check_lengths(hit.normal.as_slice(), other.normal.as_slice(), N::ONE, place);
        }
        let near = |world: &World<N, D>, scale: N| {
            let (low, high) = (at * scale, (at + direction.abs()) * scale);
            let aabb = Aabb::new(low.into(), high.into());
            let boxes = world.interferences_with_aabb(&aabb, &all);
            let point = Point::from((at + direction * N::lit(0.25)) * scale);
            let held = world.interferences_with_point(&point, &all);
            boxes.chain(held).map(|object| object.handle().uid()).collect::<Vec<_>>()
        };
        assert_eq!(near(usual, N::ONE), near(scaled, scale), "{place}: points and boxes");
        hits += found.len();
    }
    hits
}

fn play<N: Play<D>, const D: usize>(scene: &Scene<D>, steps: u32, powers: &[i32]) {
    let mut usual = Player::<N, D>::new(scene.clone(), 1.0);
    let scaled = powers.iter().map(|&k| Player::<N, D>::new(scene.clone(), power_of_two(k)));
    let mut scaled: Vec<_> = scaled.collect();
    let (mut contacts, mut hits) = (0, 0);
    for step in 0..steps {
        usual.step();
        for (player, &k) in scaled.iter_mut().zip(powers) {
            player.step();
            let place = format!("{} times 2^{k}, step {step}", scene.name);
            let scale = N::lit(power_of_two(k));
            contacts += check_worlds(&usual.world, &player.world, scale, &place);
            hits += check_queries(&usual.world, &player.world, scale, &place);
        }
    }
    assert!(contacts > 1000 && hits > 100, "{contacts} contacts, {hits} hits");
}

macro_rules! scenes {
    ($($name:ident: $scene:expr, $steps:expr, $powers:expr;)*) => {
        $(
            #[test]
            fn $name() {
                play::<f32, _>(&$scene, $steps, &$powers);
                play::<f64, _>(&$scene, $steps, &$powers);
            }
        )*
    };
}

scenes! {
    mixed_shapes_in_plane: mixed_shapes::<2>(240), 20, POWERS;
    mixed_shapes_in_space: mixed_shapes::<3>(240), 20, POWERS;
    piles_in_plane: pile::<2>(150), 4, [-19, 20];
    piles_in_space: pile::<3>(100), 4, [-19, 20];
    drifts_in_plane: sparse_drift::<2>(300), 10, [-19, 20];
    drifts_in_space: sparse_drift::<3>(300), 10, [-19, 20];
    sizes_in_plane: mixed_sizes::<2>(250), 8, [-9, 13];
    sizes_in_space: mixed_sizes::<3>(250), 8, [-9, 13];
    towers_in_plane: tower::<2>(100), 3, [-20, 20];
    towers_in_space: tower::<3>(100), 3, [-20, 20];
}
