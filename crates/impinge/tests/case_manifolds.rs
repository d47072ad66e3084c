//! How many points the contacts of the corpus's boxes have; of more than four the library keeps four.

mod query_support;

use impinge::math::{AbstractRotation, Isometry, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::ContactManifold;
use impinge::shape::{Cuboid, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld};
use query_support::Placed;
use query_support::corpus::{placed2, placed3, regression, vector};
use serde_json::Value;

/// The manifolds of two boxes in a world, in the order of the case or the other.
fn manifolds<N, R, const D: usize>(
    case: &Value,
    place: fn(&Value, &Value) -> Option<Placed<N, R, D>>,
    names: [[&str; 2]; 2],
) -> Vec<ContactManifold<N, D>>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.01));
    let handles = names.map(|[shape, pose]| {
        let placed = place(&case[shape], &case[pose]).expect("a box");
        let half: Vector<N, D> = vector(&case[shape]["half_extents"]);
        let cuboid = ShapeHandle::new(Cuboid::new(half));
        let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
        world.add(placed.pose, cuboid, CollisionGroups::new(), contacts, ())
    });
    world.update();
    let mut found = Vec::new();
    let pair = world.contact_pair(handles[0], handles[1]);
    pair.expect("the boxes overlap").contacts(&mut found);
    found.into_iter().cloned().collect()
}

fn counts<N, R, const D: usize>(
    case: &Value,
    place: fn(&Value, &Value) -> Option<Placed<N, R, D>>,
) -> [usize; 2]
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let [one, two] = [["shape1", "pose1"], ["shape2", "pose2"]];
    [[one, two], [two, one]].map(|names| {
        let found = manifolds(case, place, names);
        found.iter().map(|manifold| manifold.contacts().len()).sum()
    })
}

#[test]
fn manifold_points_of_the_corpus() {
    let (mut checked, mut wrong) = (0, Vec::new());
    for case in regression() {
        let Some(given) = case["expected"]["manifold_points"].as_u64() else { continue };
        let expected = usize::try_from(given).expect("few").min(4);
        let found = if case["dim"] == 2 {
            [counts(&case, placed2::<f32>), counts(&case, placed2::<f64>)]
        } else {
            [counts(&case, placed3::<f32>), counts(&case, placed3::<f64>)]
        };
        if found != [[expected; 2]; 2] {
            wrong.push(format!("{}: {found:?} points, not {given}", case["id"]));
        }
        checked += 1;
    }
    assert_eq!(checked, 13, "all that say how many");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
