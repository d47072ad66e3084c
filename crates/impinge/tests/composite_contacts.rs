//! Contacts with composites against what must hold of them, whatever they are.

mod slides;

use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{Isometry3, Real, Space, Vector};
use impinge::query::{Proximity, TrackedContact, contact, distance, proximity};
use impinge::shape::{Shape, TriMesh};
use slides::{Pattern, Random, Sliding, grid, lowest, solids3};

fn v<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn turned<N: Real>(random: &mut Random) -> UnitQuaternion<N> {
    UnitQuaternion::from_scaled_axis(v(random.unit() * 3.0, random.unit() * 3.0, random.unit()))
}

/// Hills of small triangles: slopes up to about 45 degrees.
fn hills<N: Real + Space<3>>(pattern: Pattern) -> TriMesh<N, 3> {
    let height = |x: f64, z: f64| {
        let (x, z) = (x * 1.7, z * 1.3);
        0.4 * (x - x.floor() - 0.5).abs() + 0.3 * (z + 0.4 * x - (z + 0.4 * x).floor() - 0.5).abs()
    };
    grid::<N>(20, 0.35, [0.0; 3], pattern, height)
}

/// How far a solid must be lifted to come free.
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
    for round in 0..60 {
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
            // Along a slope a depth may be larger than straight up, but not by the solid's width.
            let lift = lift(floor, solid, &pose);
            // Deeper, the middle of a solid may be below the hills: then it comes from there.
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
