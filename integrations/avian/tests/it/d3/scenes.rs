//! Tests that stacks, pyramids and chains stay stable, that contacts keep their ids, and that runs
//! repeat.

use avian3d::prelude::*;
use bevy_math::Vec3;

use crate::scenes3::{Backend, Impinge, app, chain, floor, place, pyramid, stack, steps, velocity};

fn stack_stands<B: Backend>() {
    let mut app = app::<B>();
    floor::<B>(&mut app);
    let cubes = stack::<B>(&mut app, Vec3::ZERO, 10);
    steps(&mut app, 600);
    for (level, &cube) in cubes.iter().enumerate() {
        let at = place(&app, cube);
        let aside = (at - Vec3::Y * (level as f32 + 0.5)).length();
        println!("{} {level}: {at} {aside}", B::NAME);
        assert!(aside < 0.05, "{level} is at {at}");
    }
}

#[test]
fn a_stack_of_ten_stands() {
    stack_stands::<Impinge>();
}

fn pyramid_stands<B: Backend>() {
    let mut app = app::<B>();
    floor::<B>(&mut app);
    let cubes = pyramid::<B>(&mut app, 8);
    steps(&mut app, 600);
    let farthest = cubes.iter().map(|&(cube, from)| (place(&app, cube) - from).length());
    let farthest = farthest.fold(0.0, f32::max);
    println!("{} pyramid: {farthest}", B::NAME);
    assert!(farthest < 0.05, "{farthest}");
}

#[test]
fn a_pyramid_stands() {
    pyramid_stands::<Impinge>();
}

/// Asserts that a chain stays joined while it swings down to the floor, and that no link is in the
/// floor at the end.
fn chain_holds<B: Backend>() {
    let mut app = app::<B>();
    floor::<B>(&mut app);
    let links = chain::<B>(&mut app, Vec3::Y * 3.0, 10);
    let hold = |app: &bevy_app::App| {
        for pair in links.windows(2) {
            let ends = [(pair[0], -0.3), (pair[1], 0.3)].map(|(link, end)| {
                let turned = app.world().get::<Rotation>(link).expect("a body").0 * Vec3::Y;
                place(app, link) + turned * end
            });
            let gap = (ends[0] - ends[1]).length();
            assert!(gap < 0.1, "{gap}");
        }
    };
    for _ in 0..6 {
        steps(&mut app, 100);
        hold(&app);
    }
    let lowest = links.iter().map(|&link| place(&app, link).y).fold(f32::MAX, f32::min);
    println!("{} lowest: {lowest}", B::NAME);
    assert!(lowest > 0.08, "no link is in the floor: {lowest}");
    assert!(links.iter().all(|&link| place(&app, link).is_finite()));
}

#[test]
fn a_chain_of_capsules_holds() {
    chain_holds::<Impinge>();
}

/// Asserts that contact points keep their feature ids from step to step, and that the solver is
/// warm-started.
#[test]
fn contacts_keep_their_names() {
    let mut app = app::<Impinge>();
    floor::<Impinge>(&mut app);
    let cubes = stack::<Impinge>(&mut app, Vec3::ZERO, 3);
    let names = |app: &bevy_app::App| {
        let graph = app.world().resource::<ContactGraph>();
        let mut names = Vec::new();
        for pair in graph.iter_active_touching() {
            for point in pair.manifolds.iter().flat_map(|manifold| &manifold.points) {
                let ids = [point.feature_id1, point.feature_id2].map(|id| id.0);
                assert!(ids.iter().all(|&id| id != 0), "none is unknown");
                names.push((pair.collider1, pair.collider2, ids, point.warm_start_normal_impulse));
            }
        }
        names
    };
    steps(&mut app, 60);
    let before = names(&app);
    assert_eq!(before.len(), 12, "three faces");
    assert!(before.iter().all(|(.., impulse)| *impulse > 0.0), "they carry");
    steps(&mut app, 60);
    let bare = |names: &[(_, _, [u32; 2], f32)]| names.iter().map(|n| n.2).collect::<Vec<_>>();
    assert_eq!(bare(&names(&app)), bare(&before));
    assert!(velocity(&app, cubes[2]).length() < 1e-2);
}

/// Asserts that two runs of a pile end at the same positions, to the bit.
#[test]
fn runs_repeat() {
    let run = || {
        let mut app = app::<Impinge>();
        floor::<Impinge>(&mut app);
        let bodies = crate::scenes3::pile::<Impinge>(&mut app, 3, 3, 1.0);
        steps(&mut app, 200);
        bodies
            .iter()
            .map(|&body| place(&app, body).to_array().map(f32::to_bits))
            .collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}

#[cfg(feature = "parry")]
mod beside_parry {
    use crate::scenes3::Parry;

    #[test]
    fn scenes_stand() {
        super::stack_stands::<Parry>();
        super::pyramid_stands::<Parry>();
        super::chain_holds::<Parry>();
    }
}
