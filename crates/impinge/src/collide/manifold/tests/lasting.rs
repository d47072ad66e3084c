//! Tests that ids of contacts persist while boxes slide, spin slowly or rest on each other, and
//! that an id is not used again for a contact that begins later.

use std::collections::BTreeMap;

use super::scene::{Random, Scene, fact, request};
use crate::collide::{Pair, RawManifold};
use crate::math::{Pose, Unit, Vector};
use crate::shape::{Cuboid, FeatureId, Plane, Shape};

type IdsByFeatures = BTreeMap<[FeatureId; 2], u32>;

fn ids_by_features<N: Scene<D>, const D: usize>(raw: &RawManifold<N, D>) -> IdsByFeatures {
    raw.points.iter().map(|point| ([point.feature1, point.feature2], point.id)).collect()
}

/// Moves a box on a half-space or box for a thousand steps. Asserts that features that persist keep
/// their id, and that new features get an id of the previous step or a new one, but no id that
/// ended earlier. Returns the number of ids assigned.
fn slide<N: Scene<D>, const D: usize>(terrain: &dyn Shape<N, D>, top: f64) -> usize {
    let solid = Cuboid::new(Vector::<N, D>::repeat(N::HALF));
    let (mut raw, mut old) = (RawManifold::default(), IdsByFeatures::new());
    let mut last_given = None;
    let full = 1 << (D - 1);
    for step in 0..1000 {
        let time = f64::from(step) * 1e-3;
        let mut position = Vector::<N, D>::zeros();
        position[0] = N::lit(0.3 * time);
        position[1] = N::lit(0.499 + 1e-4 * (37.0 * time).sin());
        let wobble = 1e-4 * (91.0 * time).sin();
        let pose1 = N::pose(position, [wobble, 0.3 * time * f64::from(D == 3), wobble]);
        let mut below = Vector::<N, D>::zeros();
        below[1] = N::lit(-top);
        let pose12 = Pose::relative(&pose1, &N::pose(below, [0.0; 3]));
        let pair = Pair { first: solid.geometry().0, second: terrain.geometry().0, pose12 };
        N::build(&pair, &fact(&pair), &request(0.02, 0.0), &mut raw);
        let new = ids_by_features(&raw);
        assert_eq!(new.len(), raw.points.len(), "no two points share their features");
        assert_eq!(new.len(), full, "all corners, step {step}: {raw:?}");
        for (features, id) in &new {
            match old.get(features) {
                Some(before) => assert_eq!(id, before, "renamed without reason in step {step}"),
                None => {
                    let is_kept = old.values().any(|before| before == id);
                    assert!(is_kept || Some(*id) > last_given, "an old number in step {step}");
                }
            }
        }
        last_given = last_given.max(new.values().copied().max());
        old = new;
    }
    last_given.map_or(0, |last| last as usize + 1)
}

fn on_plane<N: Scene<D>, const D: usize>() -> usize {
    let up = Vector::<N, D>::from_fn(|axis, _| if axis == 1 { N::ONE } else { N::ZERO });
    slide::<N, D>(&Plane::new(Unit::new_normalize(up)), 0.0)
}

fn on_box<N: Scene<D>, const D: usize>(half_extent: f64) -> usize {
    let mut half_extents = Vector::<N, D>::repeat(N::lit(half_extent));
    half_extents[1] = N::ONE;
    slide::<N, D>(&Cuboid::new(half_extents), 1.0)
}

#[test]
fn a_sliding_box_keeps_its_ids() {
    assert_eq!([on_plane::<f32, 2>(), on_plane::<f64, 2>()], [2; 2], "two corners in 2D");
    assert_eq!([on_plane::<f32, 3>(), on_plane::<f64, 3>()], [4; 2], "four corners in 3D");
    assert_eq!([on_box::<f32, 2>(4.0), on_box::<f64, 3>(4.0)], [2, 4], "on a large box");
}

#[test]
fn a_box_sliding_over_an_edge_keeps_its_ids_on_new_features() {
    assert_eq!(on_box::<f32, 2>(0.6), 2, "the corner that leaves goes on as the point on the edge");
    assert!(on_box::<f32, 3>(0.6) <= 6, "{} numbers", on_box::<f32, 3>(0.6));
    assert!(on_box::<f64, 3>(0.45) <= 6, "{} numbers", on_box::<f64, 3>(0.45));
}

/// Asserts that no id changes for two equal boxes, one on the other, under random rotations and
/// displacements of up to two epsilons. The upper box is shifted along the x axis by `shift`; in
/// 3D, two pairs of sides coincide even if `shift` is not zero.
fn stack_rests<N: Scene<D>, const D: usize>(shift: f64) {
    let solid = Cuboid::new(Vector::<N, D>::repeat(N::HALF));
    let (mut raw, mut random) = (RawManifold::default(), Random(11));
    let perturbation = 2.0 * N::EPSILON.as_f64();
    for step in 0..300 {
        let mut position = random.vector::<N, D>(perturbation);
        position[0] += N::lit(shift);
        position[1] += N::lit(0.999);
        let turn = [(); 3].map(|()| random.between(-perturbation, perturbation));
        let pair = Pair {
            first: solid.geometry().0,
            second: solid.geometry().0,
            pose12: N::pose(position, turn),
        };
        N::build(&pair, &fact(&pair), &request(0.0, 0.0), &mut raw);
        assert_eq!(raw.points.len(), 1 << (D - 1), "step {step}, {shift}: {raw:?}");
        let ids: Vec<u32> = raw.points.iter().map(|point| point.id).collect();
        assert!(ids.iter().zip(0..).all(|(id, index)| *id == index), "step {step}: {raw:?}");
    }
}

#[test]
fn a_stack_at_rest_keeps_its_ids() {
    for shift in [0.0, 0.25] {
        stack_rests::<f32, 2>(shift);
        stack_rests::<f64, 2>(shift);
        stack_rests::<f32, 3>(shift);
        stack_rests::<f64, 3>(shift);
    }
}

/// Asserts that contacts that end and begin again get new ids.
#[test]
fn a_number_is_never_given_twice() {
    let solid = Cuboid::new(Vector::<f64, 2>::new(0.5, 0.5));
    let (mut raw, mut id_count) = (RawManifold::default(), 0);
    for height in [1.0, 2.0, 0.99, 3.0, 0.98] {
        let pose12 = f64::pose(Vector::<f64, 2>::new(0.0, height), [0.0; 3]);
        let pair = Pair { first: solid.geometry().0, second: solid.geometry().0, pose12 };
        f64::build(&pair, &fact(&pair), &request(0.0, 0.0), &mut raw);
        assert_eq!(raw.points.is_empty(), height > 1.0, "{height}: {raw:?}");
        assert!(raw.points.iter().all(|point| point.id >= id_count), "{height}: {raw:?}");
        id_count += u32::try_from(raw.points.len()).expect("two at most");
    }
    assert_eq!(id_count, 6, "two contacts three times");
}
