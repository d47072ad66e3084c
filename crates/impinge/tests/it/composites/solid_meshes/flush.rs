//! Tests solids and solid meshes with sides in one plane: boxes at the edge of a block, and stacks
//! of equal crates. The depth is known by hand, and the normal carries the upper solid.

use super::{V3, at, cuboid, solid};

use impinge::math::{Isometry3, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::contact;
use impinge::shape::{ConvexHull, Cuboid, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Returns the solid mesh of a box around the origin.
fn block<N: Space<3, Isometry = Isometry3<N>>>(half: f64) -> TriMesh<N, 3> {
    solid(cuboid::<N>([half; 3], [0.0; 3]))
}

/// Returns the deepest contact of a world with the two shapes, and its normal; the first shape is at
/// the origin.
fn in_world<N: Space<3, Isometry = Isometry3<N>>>(
    shapes: [ShapeHandle<N, 3>; 2],
    place: Isometry3<N>,
) -> Option<(N, Vector<N, 3>)> {
    let query = GeometricQueryType::Contacts(N::lit(0.02), N::ZERO);
    let (mut world, groups) = (CollisionWorld::new(N::lit(0.02)), CollisionGroups::new());
    let [lower, upper] = shapes;
    world.add(Isometry3::identity(), lower, groups, query, ());
    world.add(place, upper, groups, query, ());
    world.update();
    let all = world.contact_manifolds();
    let deepest = all.filter_map(|(_, _, manifold)| Some(manifold.deepest_contact()?.contact));
    deepest
        .map(|contact| (contact.depth, contact.normal.into_inner()))
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
}

/// Asserts that two shapes that only touch at `place` have a depth of zero, in a query and in a
/// world, and a normal within 90 degrees of the direction to the place.
fn only_touches<N: Space<3, Isometry = Isometry3<N>>>(
    solid: ShapeHandle<N, 3>,
    place: [f64; 3],
    name: &str,
) {
    let (lower, pose) = (ShapeHandle::new(block::<N>(1.0)), at::<N>(place));
    let here = Isometry3::identity();
    let found = contact(&here, &*lower, &pose, &*solid, N::ZERO);
    let found = found.expect("the query has a contact");
    assert!(found.depth.abs() <= N::lit(16.0) * N::EPSILON, "{name} at {place:?}: {}", found.depth);
    let (depth, normal) = in_world([lower, solid], pose).expect("the world has a contact");
    assert!(depth.abs() <= N::lit(16.0) * N::EPSILON, "{name} at {place:?}: {depth}");
    assert!(normal.dot(&pose.translation.vector) > N::ZERO, "{name} at {place:?}: {normal}");
}

fn flush<N: Space<3, Isometry = Isometry3<N>>>() {
    let small = Cuboid::new(Vector::<N, 3>::repeat(N::HALF));
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: u32| {
        let sign = |axis: u32| if corner >> axis & 1 == 1 { N::HALF } else { -N::HALF };
        [sign(0), sign(1), sign(2)].into()
    });
    let solids: [(&str, ShapeHandle<N, 3>); 3] = [
        ("box", ShapeHandle::new(small)),
        ("hull", ShapeHandle::new(ConvexHull::from_points(&corners))),
        ("mesh", ShapeHandle::new(block::<N>(0.5))),
    ];
    for (name, solid) in &solids {
        for place in [
            [0.5, 1.5, 0.0],
            [0.5, 1.5, 0.5],
            [-0.5, 1.5, 0.25],
            [0.25, 1.5, 0.25],
            [1.5, 0.5, -0.5],
            [1.5, 1.5, 0.0],
        ] {
            only_touches(solid.clone(), place, name);
        }
    }
    let (whole, mesh) = (Cuboid::new(Vector::<N, 3>::repeat(N::ONE)), block::<N>(1.0));
    for place in [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.5], [2.0, 2.0, 0.0]] {
        only_touches(ShapeHandle::new(whole), place, "box of equal size");
        only_touches(ShapeHandle::new(mesh.clone()), place, "mesh of equal size");
    }
}

#[test]
fn solids_flush_with_a_side_only_touch() {
    flush::<f64>();
    flush::<f32>();
}

/// Asserts the depth and the normal of two equal solid meshes stacked on each other, and of a box on
/// a solid mesh.
fn stacked<N: Space<3, Isometry = Isometry3<N>>>() {
    let lower = block::<N>(1.0);
    let equal = Cuboid::new(Vector::<N, 3>::repeat(N::ONE));
    for overlap in [0.0001, 0.01, 0.1, 0.25] {
        for aside in [[0.0, 0.0], [0.001, 0.001], [0.001, -0.002], [0.02, 0.02]] {
            let place = at::<N>([aside[0], 2.0 - overlap, aside[1]]);
            for upper in [ShapeHandle::new(lower.clone()), ShapeHandle::new(equal)] {
                let found = in_world([ShapeHandle::new(lower.clone()), upper], place);
                let (depth, normal) = found.expect("they overlap");
                let off = (depth - N::lit(overlap)).abs();
                assert!(off < N::lit(1e-6), "{depth} instead of {overlap}, {aside:?} aside");
                let up = (normal - Vector::<N, 3>::y()).norm();
                assert!(
                    up < N::lit(1e-3),
                    "{normal} instead of y, {overlap} deep, {aside:?} aside"
                );
            }
        }
    }
}

#[test]
fn stacked_solid_meshes_keep_their_support() {
    stacked::<f64>();
    stacked::<f32>();
}

#[test]
fn overlapping_solid_meshes_give_the_depth_in_queries() {
    let (lower, here) = (block::<f64>(1.0), Isometry3::identity());
    for overlap in [0.01, 0.25] {
        let place = at([0.0, 2.0 - overlap, 0.0]);
        let found = contact(&here, &lower, &place, &lower, 0.0).expect("they overlap");
        assert!((found.depth - overlap).abs() < 1e-12, "{} instead of {overlap}", found.depth);
        assert!((found.normal.into_inner() - V3::y()).norm() < 1e-12, "{}", found.normal.y);
    }
}
