//! Tests that stacks, pyramids and chains stay stable, that contacts keep their ids, and that runs
//! repeat.

use avian2d::prelude::*;
use bevy_math::Vec2;

use crate::scenes2::{Backend, Impinge, app, chain, floor, pile, place, pyramid, stack, steps};

fn stack_stands<B: Backend>() {
    let mut app = app::<B>();
    floor::<B>(&mut app);
    let squares = stack::<B>(&mut app, Vec2::ZERO, 10);
    steps(&mut app, 600);
    for (level, &square) in squares.iter().enumerate() {
        let at = place(&app, square);
        let aside = (at - Vec2::Y * (level as f32 + 0.5)).length();
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
    let squares = pyramid::<B>(&mut app, 10);
    steps(&mut app, 600);
    let farthest = squares.iter().map(|&(square, from)| (place(&app, square) - from).length());
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
    let links = chain::<B>(&mut app, Vec2::Y * 3.0, 10);
    for _ in 0..6 {
        steps(&mut app, 100);
        for pair in links.windows(2) {
            let ends = [(pair[0], -0.3), (pair[1], 0.3)].map(|(link, end)| {
                let turned = *app.world().get::<Rotation>(link).expect("a body") * Vec2::Y;
                place(&app, link) + turned * end
            });
            let gap = (ends[0] - ends[1]).length();
            assert!(gap < 0.1, "{gap}");
        }
    }
    let lowest = links.iter().map(|&link| place(&app, link).y).fold(f32::MAX, f32::min);
    println!("{} lowest: {lowest}", B::NAME);
    assert!(lowest > 0.08, "no link is in the floor: {lowest}");
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
    stack::<Impinge>(&mut app, Vec2::ZERO, 3);
    let names = |app: &bevy_app::App| {
        let graph = app.world().resource::<ContactGraph>();
        let manifolds = graph.iter_active_touching().flat_map(|pair| &pair.manifolds);
        let points = manifolds.flat_map(|manifold| &manifold.points);
        points.map(|p| ([p.feature_id1.0, p.feature_id2.0], p.warm_start_normal_impulse)).collect()
    };
    steps(&mut app, 60);
    let before: Vec<([u32; 2], f32)> = names(&app);
    assert_eq!(before.len(), 6, "three sides");
    assert!(before.iter().all(|(ids, impulse)| *impulse > 0.0 && !ids.contains(&0)));
    steps(&mut app, 60);
    let bare = |names: Vec<([u32; 2], f32)>| names.iter().map(|n| n.0).collect::<Vec<_>>();
    assert_eq!(bare(names(&app)), bare(before));
}

/// Asserts that two runs of a pile end at the same positions, to the bit.
#[test]
fn runs_repeat() {
    let run = || {
        let mut app = app::<Impinge>();
        floor::<Impinge>(&mut app);
        let bodies = pile::<Impinge>(&mut app, 5, 5, 1.0);
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
    use crate::scenes2::Parry;

    #[test]
    fn scenes_stand() {
        super::stack_stands::<Parry>();
        super::pyramid_stands::<Parry>();
        super::chain_holds::<Parry>();
    }
}
