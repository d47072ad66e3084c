//! The suite of batches: one query about many placed pairs, run as one call for all pairs and as
//! one call for each pair. Both contenders are impinge, in `f64` and 3D, on one thread. Times are
//! nanoseconds for each pair.
//!
//! The table counts pairs whose two results differ in any bit. One shape is at the origin, the
//! second shape at many positions around it: about equally many pairs overlap, are near and are
//! far.

mod question;

use impinge::dim3::batch::{Control, OnePose, PairBatch, Shapes, Side, pairs_within_one};
use impinge::dim3::math::{Isometry, Rotation, Vector};
use impinge::dim3::procedural;
use impinge::dim3::shape::{Ball, Capsule, ConvexHull, Cuboid, Cylinder, ShapeHandle, TriMesh};

use crate::Arguments;
use crate::measure::in_turn;
use crate::table::{Row, Table};
use question::{QUESTIONS, Question};

/// A pair of shapes with many relative poses.
pub struct Batch {
    /// The shape at the origin, and the shape with many poses.
    pub shapes: [ShapeHandle<f64>; 2],
    /// The poses of the second shape.
    pub poses: Vec<Isometry<f64>>,
}

/// Runs all queries for all pairs of shapes.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("batch", "ns");
    for (name, batch) in batches(arguments.objects) {
        for question in QUESTIONS {
            let case = format!("{name}: {}", question.name);
            if arguments.wants_case(&case) {
                table.add(race(&case, &batch, question, arguments));
            }
        }
    }
    near_pairs(arguments, &mut table);
    vec![table]
}

/// Returns the batches and their names, with `count` poses; a hundredth of `count` if a mesh is
/// involved.
fn batches(count: usize) -> Vec<(String, Batch)> {
    let shapes: [(&str, ShapeHandle<f64>, usize); 6] = [
        ("ball", ShapeHandle::new(Ball::new(0.5)), count),
        ("capsule", ShapeHandle::new(Capsule::new(0.5, 0.25)), count),
        ("box", ShapeHandle::new(Cuboid::new(Vector::new(0.5, 0.4, 0.3))), count),
        ("cylinder", ShapeHandle::new(Cylinder::new(0.5, 0.4)), count),
        ("hull", ShapeHandle::new(round_hull(12)), count),
        ("mesh", ShapeHandle::new(surface(24)), count / 100),
    ];
    let mut batches = Vec::new();
    for (index, (name1, shape1, count1)) in shapes.iter().enumerate() {
        // Each shape is paired with a box and with itself.
        for other in [2, index] {
            let (name2, shape2, count2) = &shapes[other];
            let is_new = batches.iter().all(|(name, _)| name != &format!("{name1}/{name2}"));
            if is_new {
                let (shapes, poses) =
                    ([shape1.clone(), shape2.clone()], places(*count1.min(count2)));
                batches.push((format!("{name1}/{name2}"), Batch { shapes, poses }));
            }
        }
    }
    batches
}

/// Returns the convex hull of the vertices of a tessellated ball of radius 0.5.
fn round_hull(subdivisions: u32) -> ConvexHull<f64> {
    ConvexHull::from_points(&procedural::ball(&Ball::new(0.5), subdivisions).vertices)
}

/// Returns the surface of a tessellated ball of radius 0.5 as a triangle mesh.
fn surface(subdivisions: u32) -> TriMesh<f64> {
    let surface = procedural::ball(&Ball::new(0.5), subdivisions);
    TriMesh::try_from(surface).expect("a surface of triangles")
}

/// Returns `count` random poses, the same in every run. Each coordinate of the position is less
/// than 1.25 in magnitude.
fn places(count: usize) -> Vec<Isometry<f64>> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut vector = || Vector::new(next(), next(), next());
    let mut place =
        |_| Isometry::from_parts((vector() * 1.25).into(), Rotation::new(vector() * 3.0));
    (0..count).map(&mut place).collect()
}

/// Times the call for the whole batch and the calls for single pairs in alternating rounds, and
/// returns a row for each.
fn race(case: &str, batch: &Batch, question: &Question, arguments: &Arguments) -> Vec<Row> {
    let here = OnePose(Isometry::identity());
    let [shape1, shape2] = &batch.shapes;
    let one = Side::try_new(Shapes::One(&**shape1), &here).expect("one");
    let many = Side::try_new(Shapes::One(&**shape2), &batch.poses).expect("many");
    let pairs = PairBatch::try_new(one, many).expect("one against many");
    let (mut at_once, mut one_by_one) = (Vec::new(), Vec::new());
    let mut in_batch = || (question.in_batch)(&pairs, &mut at_once);
    let mut singly = || (question.one_by_one)(batch, &mut one_by_one);
    let rounds = usize::try_from(arguments.steps.min(20)).expect("few");
    let times = in_turn(rounds, batch.poses.len(), &mut [&mut in_batch, &mut singly]);
    let mut bits = at_once.iter().zip(&one_by_one);
    let differ = bits.clone().filter(|(one, other)| one.to_bits() != other.to_bits()).count();
    let answers = bits.by_ref().filter(|(found, _)| found.is_finite()).count();
    let row = |(contender, times): (&str, _)| Row {
        case: case.to_owned(),
        contender: contender.to_owned(),
        answers,
        differ,
        times,
    };
    ["batch", "one by one"].into_iter().zip(times).map(row).collect()
}

/// Times the search for all pairs of one set that are within a distance, in nanoseconds for each
/// element.
fn near_pairs(arguments: &Arguments, table: &mut Table) {
    let shape = ShapeHandle::new(Cuboid::new(Vector::new(0.5, 0.4, 0.3)));
    let case = "box: all pairs within a distance";
    if !arguments.wants_case(case) {
        return;
    }
    let spread = |pose: &Isometry<f64>| {
        let scale = 0.5 * (arguments.objects as f64).cbrt();
        Isometry::from_parts((pose.translation.vector * scale).into(), pose.rotation)
    };
    let poses: Vec<_> = places(arguments.objects).iter().map(spread).collect();
    let side = Side::try_new(Shapes::One(&*shape), &poses).expect("one box");
    let mut found = 0;
    let mut find = || {
        let pairs = pairs_within_one(&side, 0.1, &Control::new());
        found = pairs.expect("a good distance").len();
    };
    let times = in_turn(arguments.steps.min(20) as usize, poses.len(), &mut [&mut find]);
    let contender = "batch".to_owned();
    let row = |times| Row {
        case: case.to_owned(),
        contender: contender.clone(),
        answers: found,
        differ: 0,
        times,
    };
    table.add(times.into_iter().map(row).collect());
}
