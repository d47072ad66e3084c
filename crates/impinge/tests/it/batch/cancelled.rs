//! Tests that every batch method reports its progress and ends when its callback cancels it.

use std::ops::ControlFlow;
use std::sync::Mutex;

use impinge::batch::{
    BatchError, Control, HitColumns, ImpactColumns, ManifoldRows, OnePose, PairBatch, PointBatch,
    RayColumns, Shapes, Side, pairs_within, pairs_within_one,
};
use impinge::math::{Pose, Vector};
use impinge::narrow_phase::ContactPrediction;
use impinge::query::{ImpactOptions, Proximity};
use impinge::shape::Ball;

use super::scene::on_threads;

const COUNT: usize = 1000;

/// Calls `call` for each batch method, with the method's name and a function that runs it.
fn each_method(call: impl Fn(&str, &dyn Fn(&Control<'_>) -> Result<(), BatchError>)) {
    let ball = Ball::new(1.0_f64);
    let at = |index: usize| Pose::from_translation(Vector::<f64, 2>::new(3.0 * index as f64, 0.0));
    let (poses, here) = ((0..COUNT).map(at).collect::<Vec<_>>(), OnePose(Pose::identity()));
    let one = Side::try_new(Shapes::One(&ball), &here).expect("one");
    let many = Side::try_new(Shapes::One(&ball), &poses).expect("many");
    let pairs = PairBatch::try_new(one, many).expect("one against many");
    let points = PointBatch::try_new(many, &[[5.0, 0.0]]).expect("one point");
    let rays = RayColumns::try_new(many, &[[5.0, 0.0]], &[[0.0, 1.0]]).expect("one ray");
    let prediction = ContactPrediction::new(0.0, 0.0, 0.0);
    let (still, options): ([&[[f64; 2]]; 2], _) = ([&[], &[]], ImpactOptions::new());
    call("distances", &|control| pairs.distances(control, &mut [0.0; COUNT]));
    call("closest_points", &|control| pairs.closest_points(1.0, control, Default::default()));
    call("witnesses", &|control| pairs.witnesses(1.0, control, Default::default()));
    call("proximities", &|control| {
        pairs.proximities(1.0, control, &mut [Proximity::Disjoint; COUNT])
    });
    call("contacts", &|control| pairs.contacts(1.0, control, Default::default()));
    call("impacts", &|control| pairs.impacts(still, &options, control, ImpactColumns::default()));
    call("manifolds", &|control| {
        pairs.manifolds(&prediction, None, control, &mut ManifoldRows::new())
    });
    call("nearest", &|control| pairs.nearest(f64::INFINITY, control).map(drop));
    call("pairs_within", &|control| pairs_within(&one, &many, 1.0, control).map(drop));
    call("pairs_within_one", &|control| pairs_within_one(&many, 1.0, control).map(drop));
    call("project", &|control| points.project(true, control, Default::default()));
    call("signed_distances", &|control| points.signed_distances(control, &mut [0.0; COUNT]));
    call("contains", &|control| points.contains(control, &mut [false; COUNT]));
    call("cast", &|control| rays.cast(control, HitColumns::default()));
}

/// Runs a batch whose callback cancels it in call number `call`, counted from 1; `usize::MAX` never
/// cancels. Returns the result, and the progress reported until then.
fn cancelled_at(
    call: usize,
    run: &dyn Fn(&Control<'_>) -> Result<(), BatchError>,
) -> (Result<(), BatchError>, Vec<usize>) {
    let heard = Mutex::new(Vec::new());
    let report = |done| {
        let mut heard = heard.lock().expect("no panic");
        heard.push(done);
        if heard.len() == call { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let result = run(&Control::with_progress(&report));
    (result, heard.into_inner().expect("no panic"))
}

#[test]
fn nothing_is_called_after_a_break() {
    for threads in [1, 4] {
        on_threads(threads, || {
            each_method(|name, run| {
                for call in [1, 8, 16] {
                    let (result, heard) = cancelled_at(call, run);
                    let last = *heard.last().expect("it was called");
                    let cancelled = Err(BatchError::Cancelled { done: last });
                    assert_eq!(result, cancelled, "{name}, call {call}");
                    assert_eq!(heard.len(), call, "{name} ends after call {call}");
                }
            });
        });
    }
}

#[test]
fn all_chunks_are_reported_in_ascending_order() {
    for threads in [1, 4] {
        on_threads(threads, || {
            each_method(|name, run| {
                let (result, heard) = cancelled_at(usize::MAX, run);
                assert_eq!(result, Ok(()), "{name}");
                assert_eq!(heard.len(), COUNT.div_ceil(64), "{name}: a call for each chunk");
                assert!(heard.is_sorted_by(|one, other| one < other), "{name}: {heard:?}");
                assert_eq!(heard.last(), Some(&COUNT), "{name}: all at last");
            });
        });
    }
}

#[test]
fn on_one_thread_the_first_elements_are_done() {
    let (ball, here) = (Ball::new(1.0_f64), OnePose(Pose::<f64, 2>::identity()));
    let poses = vec![Pose::identity(); COUNT];
    let one = Side::try_new(Shapes::One(&ball), &here).expect("one");
    let many = Side::try_new(Shapes::One(&ball), &poses).expect("many");
    let batch = PairBatch::try_new(one, many).expect("one against many");
    let mut distances = [-1.0; COUNT];
    let until = |done| if done < 500 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let control = Control::with_progress(&until);
    let result = on_threads(1, || batch.distances(&control, &mut distances));
    assert_eq!(result, Err(BatchError::Cancelled { done: 512 }), "after eight chunks");
    assert!(distances[..512].iter().all(|&x| x == 0.0), "the first are done");
    assert!(distances[512..].iter().all(|&x| x == -1.0), "the others are as they were");
    let error = BatchError::Cancelled { done: 512 };
    assert_eq!(error.to_string(), "cancelled after 512 elements", "so");
}
