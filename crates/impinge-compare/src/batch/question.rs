//! The queries, each in one call for a batch and pair by pair. Each fills `out` with one number for
//! each pair.

use impinge::dim3::batch::{
    ClosestColumns, ContactColumns, Control, ImpactColumns, ManifoldRows, PairBatch,
};
use impinge::dim3::math::{Isometry, Vector};
use impinge::dim3::narrow_phase::{
    ContactManifoldGenerator, DefaultContactDispatcher, IdAllocator, PairManifoldGenerator,
};
use impinge::dim3::query::{
    ClosestPoints, ContactPrediction, ImpactOptions, Moving, closest_points, contact, distance,
    impact,
};

use super::Batch;

/// The maximum distance of closest points, and the prediction of contacts and manifolds.
const LIMIT: f64 = 0.25;

/// The velocity of the second shape in impact queries.
const VELOCITY: [f64; 3] = [-1.0, -0.5, 0.25];

/// A query, with its name in the table.
pub struct Question {
    /// The name.
    pub name: &'static str,
    /// Runs the query for all pairs in one call.
    pub in_batch: fn(&PairBatch<'_, f64>, &mut Vec<f64>),
    /// Runs the query pair by pair.
    pub one_by_one: fn(&Batch, &mut Vec<f64>),
}

/// All queries of the suite.
pub const QUESTIONS: &[Question] = &[
    Question { name: "distance", in_batch: distances, one_by_one: distances_singly },
    Question { name: "closest points", in_batch: closest, one_by_one: closest_singly },
    Question { name: "contact", in_batch: contacts, one_by_one: contacts_singly },
    Question { name: "impact", in_batch: impacts, one_by_one: impacts_singly },
    Question { name: "manifold", in_batch: manifolds, one_by_one: manifolds_singly },
];

fn distances(pairs: &PairBatch<'_, f64>, out: &mut Vec<f64>) {
    out.resize(pairs.len(), 0.0);
    pairs.distances(&Control::new(), out).expect("a slot for each");
}

fn closest(pairs: &PairBatch<'_, f64>, out: &mut Vec<f64>) {
    out.resize(pairs.len(), 0.0);
    let mut point1 = vec![[0.0; 3]; pairs.len()];
    let columns = ClosestColumns { point1: &mut point1, ..Default::default() };
    pairs.closest_points(LIMIT, &Control::new(), columns).expect("a slot for each");
    out.iter_mut().zip(point1).for_each(|(slot, point)| *slot = number(point[0]));
}

fn contacts(pairs: &PairBatch<'_, f64>, out: &mut Vec<f64>) {
    out.resize(pairs.len(), 0.0);
    let columns = ContactColumns { depth: out, ..Default::default() };
    pairs.contacts(LIMIT, &Control::new(), columns).expect("a slot for each");
}

fn impacts(pairs: &PairBatch<'_, f64>, out: &mut Vec<f64>) {
    out.resize(pairs.len(), 0.0);
    let columns = ImpactColumns { time: out, ..Default::default() };
    let (velocities, options): ([&[_]; 2], _) = ([&[], &[VELOCITY]], ImpactOptions::new());
    pairs.impacts(velocities, &options, &Control::new(), columns).expect("a slot for each");
}

fn manifolds(pairs: &PairBatch<'_, f64>, out: &mut Vec<f64>) {
    let (prediction, mut rows) = (ContactPrediction::new(LIMIT, 0.0, 0.0), ManifoldRows::new());
    pairs.manifolds(&prediction, None, &Control::new(), &mut rows).expect("not cancelled");
    let last =
        |pair| rows.points_of(pair).next_back().map_or(f64::INFINITY, |slot| rows.depth[slot]);
    out.clear();
    out.extend((0..rows.num_pairs()).map(last));
}

/// Fills `out` with a result for each pose.
fn each(batch: &Batch, out: &mut Vec<f64>, answer: impl FnMut(&Isometry<f64>) -> f64) {
    out.clear();
    out.extend(batch.poses.iter().map(answer));
}

fn distances_singly(batch: &Batch, out: &mut Vec<f64>) {
    let [shape1, shape2] = &batch.shapes;
    each(batch, out, |pose| distance(&Isometry::identity(), &**shape1, pose, &**shape2));
}

fn closest_singly(batch: &Batch, out: &mut Vec<f64>) {
    let ([shape1, shape2], here) = (&batch.shapes, Isometry::identity());
    each(batch, out, |pose| match closest_points(&here, &**shape1, pose, &**shape2, LIMIT) {
        ClosestPoints::WithinMargin(point1, _) => point1.x,
        _ => f64::INFINITY,
    });
}

fn contacts_singly(batch: &Batch, out: &mut Vec<f64>) {
    let ([shape1, shape2], here) = (&batch.shapes, Isometry::identity());
    each(batch, out, |pose| {
        let found = contact(&here, &**shape1, pose, &**shape2, LIMIT);
        found.map_or(-f64::INFINITY, |found| found.depth)
    });
}

fn impacts_singly(batch: &Batch, out: &mut Vec<f64>) {
    let ([shape1, shape2], here) = (&batch.shapes, Isometry::identity());
    each(batch, out, |pose| {
        let moving = Moving::new(pose, &Vector::from(VELOCITY), &**shape2);
        let found = impact(&Moving::still(&here, &**shape1), &moving, &ImpactOptions::new());
        found.map_or(f64::INFINITY, |found| found.toi)
    });
}

fn manifolds_singly(batch: &Batch, out: &mut Vec<f64>) {
    let ([shape1, shape2], here) = (&batch.shapes, Isometry::identity());
    let (dispatcher, ids) = (DefaultContactDispatcher::new(), &mut IdAllocator::new());
    let prediction = ContactPrediction::new(LIMIT, 0.0, 0.0);
    each(batch, out, |pose| {
        let mut generator = PairManifoldGenerator::default();
        generator.update(&dispatcher, &here, &**shape1, pose, &**shape2, &prediction, ids);
        let mut manifolds = Vec::new();
        generator.contacts(&mut manifolds);
        let last = manifolds.last().and_then(|manifold| manifold.contacts().last());
        last.map_or(f64::INFINITY, |point| point.contact.depth)
    });
}

/// Maps NaN, the value of a pair without a result, to infinity.
fn number(value: f64) -> f64 {
    if value.is_nan() { f64::INFINITY } else { value }
}
