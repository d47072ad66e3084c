//! Tests laws of contacts with composites, which need no expected contacts: queries agree, and
//! swapping the shapes flips each contact.

use crate::support::samples::samples;
use crate::support::slides;

use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{Isometry3, Real, Space, Vector};
use impinge::query::{Proximity, TrackedContact, contact, distance, proximity};
use impinge::shape::{Compound, Cuboid, Shape, ShapeHandle, TriMesh};
use slides::{Pattern, Random, Sliding, grid, lowest, solids3};

fn v<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn turned<N: Real>(random: &mut Random) -> UnitQuaternion<N> {
    UnitQuaternion::from_scaled_axis(v(random.unit() * 3.0, random.unit() * 3.0, random.unit()))
}

/// Returns a surface of hills, made of small triangles with slopes of up to about 45 degrees.
fn hills<N: Real + Space<3>>(pattern: Pattern) -> TriMesh<N, 3> {
    let height = |x: f64, z: f64| {
        let (x, z) = (x * 1.7, z * 1.3);
        0.4 * (x - x.floor() - 0.5).abs() + 0.3 * (z + 0.4 * x - (z + 0.4 * x).floor() - 0.5).abs()
    };
    grid::<N>(20, 0.35, [0.0; 3], pattern, height)
}

/// Returns, by bisection, the least height by which a solid must be lifted to be free of the floor.
fn lift<N: Real + Space<3, Isometry = Isometry3<N>>>(
    floor: &dyn Shape<N, 3>,
    solid: &dyn Shape<N, 3>,
    pose: &Isometry3<N>,
) -> N {
    let touches = |by: N| {
        let mut lifted = *pose;
        lifted.translation.vector.y += by;
        proximity(&Isometry3::identity(), floor, &lifted, solid, N::ZERO) == Proximity::Intersecting
    };
    if !touches(N::ZERO) {
        return N::ZERO;
    }
    let (mut low, mut high) = (N::ZERO, N::lit(4.0));
    for _ in 0..24 {
        let middle = (low + high) * N::HALF;
        if touches(middle) { low = middle } else { high = middle }
    }
    high
}

fn laws_over_hills<N: Real + Space<3, Isometry = Isometry3<N>>>(floor: &dyn Shape<N, 3>) {
    let (mut random, mut overlaps, mut cases) = (Random::new(1), 0, 0);
    let unmoved = Isometry3::identity();
    let solids = solids3::<N>();
    for round in 0..samples(6).max(12) {
        for (name, solid) in &solids {
            let solid = solid.as_ref();
            let turn = Isometry3::from_parts(Translation3::identity(), turned::<N>(&mut random));
            let low = lowest(solid, &turn).as_f64();
            let at = v(random.unit(), -low + 0.2 + 0.25 * random.unit(), random.unit());
            let pose = Isometry3::from_parts(Translation3::from(at), turn.rotation);
            let label = format!("round {round}: {name} at {pose:?}");
            cases += 1;
            let prediction = N::lit(0.05);
            let mut sliding = Sliding::<N, 3>::new();
            let manifolds = sliding.update((&unmoved, floor), (&pose, solid), prediction);
            let all: Vec<&TrackedContact<N, 3>> =
                manifolds.iter().flat_map(|manifold| manifold.contacts()).collect();
            let deepest = all.iter().map(|tracked| tracked.contact.depth);
            let deepest = deepest.reduce(|a, b| if b > a { b } else { a });
            let is_near = proximity(&unmoved, floor, &pose, solid, N::ZERO);
            let is_touching = is_near == Proximity::Intersecting;
            overlaps += usize::from(is_touching);
            assert_eq!(is_touching, deepest.is_some_and(|depth| depth >= N::ZERO), "{label}");
            let apart = distance(&unmoved, floor, &pose, solid);
            assert_eq!(is_touching, apart == N::ZERO, "{label}");
            let single = contact(&unmoved, floor, &pose, solid, prediction);
            assert_eq!(single.is_some(), deepest.is_some(), "{label}: {single:?} {deepest:?}");
            let (Some(single), Some(deepest)) = (single, deepest) else { continue };
            let off = (single.depth - deepest).abs();
            assert!(off <= N::lit(64.0) * N::EPSILON, "{label}: {} {deepest}", single.depth);
            if !is_touching {
                let off = (apart + deepest).abs();
                assert!(off <= N::lit(1e-4), "{label}: {apart} {deepest}");
            }
            let swapped = contact(&pose, solid, &unmoved, floor, prediction).expect("touches");
            assert_eq!(swapped.flipped(), single, "{label}");
            // A depth along the normal of a slope may exceed the lift straight up, but by no more
            // than half.
            let lift = lift(floor, solid, &pose);
            // The centre of a deeper solid may be below the surface, which then pushes the solid
            // out downwards.
            if lift > N::lit(0.15) {
                continue;
            }
            let lift = lift * N::lit(1.5) + N::lit(1e-4);
            for tracked in &all {
                let contact = &tracked.contact;
                assert!(contact.depth <= lift, "{label}: {contact:?}, lift {lift} {all:#?}");
                let gap =
                    contact.world1 - contact.world2 - contact.normal.into_inner() * contact.depth;
                assert!(gap.norm() <= N::lit(32.0) * N::EPSILON, "{label}: {contact:?}");
                assert!(
                    contact.normal.y > N::ZERO,
                    "{label}: from below {contact:?}, lift {lift} {all:#?}"
                );
            }
        }
    }
    assert!(overlaps * 4 > cases && overlaps * 4 < cases * 3, "{overlaps} of {cases} overlap");
}

#[test]
fn laws_hold_over_hills() {
    for pattern in [Pattern::Slash, Pattern::Random] {
        laws_over_hills::<f64>(&hills::<f64>(pattern));
        laws_over_hills::<f32>(&hills::<f32>(pattern));
    }
}

#[test]
fn laws_hold_over_hills_with_one_side() {
    laws_over_hills::<f64>(&hills::<f64>(Pattern::Zigzag).one_sided());
}

/// Tests laws for any two shapes. Overlap, a distance of zero, and a contact with prediction zero
/// occur together; a single contact and the manifolds agree; swapping the shapes flips the contact.
fn laws_of_pairs<N: Real + Space<3, Isometry = Isometry3<N>>>(
    label: &str,
    shapes: [&dyn Shape<N, 3>; 2],
    reach: f64,
) {
    let (mut random, mut overlaps, rounds) = (Random::new(4), 0, 60);
    for round in 0..rounds {
        let mut place = |scale: f64| {
            let at = v(random.unit() * scale, random.unit() * scale, random.unit() * scale);
            Isometry3::from_parts(Translation3::from(at), turned::<N>(&mut random))
        };
        let (pose1, pose2) = (place(0.1), place(reach));
        let label = format!("{label}, round {round}: {pose1:?} {pose2:?}");
        let prediction = N::lit(0.05);
        let (placed1, placed2) = ((&pose1, shapes[0]), (&pose2, shapes[1]));
        let mut sliding = Sliding::<N, 3>::new();
        let manifolds = sliding.update(placed1, placed2, prediction);
        let all: Vec<TrackedContact<N, 3>> =
            manifolds.iter().flat_map(|manifold| manifold.contacts().to_vec()).collect();
        let depths = all.iter().map(|tracked| tracked.contact.depth);
        let deepest = depths.reduce(|a, b| if b > a { b } else { a });
        let apart = distance(&pose1, shapes[0], &pose2, shapes[1]);
        overlaps += i32::from(apart == N::ZERO);
        let is_touching = deepest.is_some_and(|depth| depth >= N::ZERO);
        assert_eq!(apart == N::ZERO, is_touching, "{label}: {apart} {deepest:?}");
        let single = contact(&pose1, shapes[0], &pose2, shapes[1], prediction);
        assert_eq!(single.is_some(), deepest.is_some(), "{label}: {single:?} {deepest:?}");
        let swapped = contact(&pose2, shapes[1], &pose1, shapes[0], prediction);
        assert_eq!(swapped.map(|swapped| swapped.flipped()), single, "{label}");
        let mut other = Sliding::<N, 3>::new();
        let flipped = other.update(placed2, placed1, prediction);
        let flipped: Vec<_> = flipped.iter().flat_map(|m| m.contacts().to_vec()).collect();
        assert_eq!(flipped.len(), all.len(), "{label}");
        for (one, two) in all.iter().zip(&flipped) {
            assert_eq!(one.contact, two.contact.flipped(), "{label}");
            assert_eq!((one.part1, one.part2), (two.part2, two.part1), "{label}");
            let same = one.kinematic.contact(&pose1, &pose2);
            let off = (same.depth - one.contact.depth).abs();
            assert!(off <= N::lit(1e4) * N::EPSILON, "{label}: {same:?} {one:?}");
        }
        let (Some(single), Some(deepest)) = (single, deepest) else { continue };
        let off = (single.depth - deepest).abs();
        assert!(off <= N::lit(256.0) * N::EPSILON, "{label}: {} {deepest}", single.depth);
    }
    assert!(overlaps > 5 && overlaps < rounds - 2, "{label}: {overlaps} of {rounds} overlap");
}

fn stairs<N: Real + Space<3, Isometry = Isometry3<N>>>() -> Compound<N, 3> {
    let step = |i: u32| {
        let (x, z) = (f64::from(i % 4) * 0.5 - 0.75, f64::from(i / 4) * 0.5 - 0.75);
        let y = 0.2 * f64::from((i * 7) % 3) - 0.2;
        let cube = ShapeHandle::new(Cuboid::new(v::<N>(0.25, 0.3, 0.25)));
        (Isometry3::from_parts(Translation3::from(v(x, y, z)), UnitQuaternion::identity()), cube)
    };
    Compound::<N, 3>::new((0..16).map(step).collect())
}

fn laws_of_all_pairs<N: Real + Space<3, Isometry = Isometry3<N>>>() {
    let (hills, stairs) = (grid_piece::<N>(), stairs::<N>());
    for (name, solid) in solids3::<N>() {
        laws_of_pairs(&format!("{name} and stairs"), [solid.as_ref(), &stairs], 1.8);
        laws_of_pairs(&format!("{name} and hills"), [&hills, solid.as_ref()], 1.3);
    }
    laws_of_pairs("stairs", [&stairs, &stairs], 1.9);
    laws_of_pairs("stairs and hills", [&stairs, &hills], 1.2);
    laws_of_pairs("hills", [&hills, &hills], 1.2);
}

/// Returns a small piece of a surface with hills.
fn grid_piece<N: Real + Space<3>>() -> TriMesh<N, 3> {
    let height = |x: f64, z: f64| 0.3 * x * x - 0.2 * x * z;
    grid::<N>(5, 0.4, [0.0; 3], Pattern::Zigzag, height)
}

#[test]
fn laws_hold_for_pairs_in_single_precision() {
    laws_of_all_pairs::<f32>();
}

#[test]
fn laws_hold_for_pairs_in_double_precision() {
    laws_of_all_pairs::<f64>();
}
