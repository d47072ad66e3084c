//! Tests that the separations of the convex solids in two files of cases have the expected
//! distance, a normal that proves this distance, and points on both solids. The files hold poses on
//! which other libraries returned wrong results.

use serde_json::Value;

use super::super::{Simplicial, separation};
use super::solids::{Own, height, number, outside, solid};
use crate::math::{Pose, Real};

fn cases(file: &str) -> Vec<Value> {
    let path = format!("{}/tests/data/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("the test data is part of the sources");
    let mut data: Value = serde_json::from_str(&text).expect("valid JSON");
    std::mem::take(data["cases"].as_array_mut().expect("an array of cases"))
}

/// A case of either file.
struct Case<'a> {
    id: &'a str,
    shapes: [&'a Value; 2],
    pose12: &'a Value,
    /// World pose of the first solid; `pose12` is then the world pose of the second. `None` if
    /// `pose12` is relative to the first solid.
    pose1: Option<&'a Value>,
    expected: f64,
    tolerance: f64,
}

fn relative<N: Own<D>, const D: usize>(case: &Case<'_>) -> Pose<N, D> {
    match case.pose1 {
        Some(first) => Pose::relative(&N::pose(first), &N::pose(case.pose12)),
        None => N::pose(case.pose12),
    }
}

/// Compares the separation of a case with the expected distance. Returns `Ok`, or the errors as a
/// message; `None` if [`solid`] does not support one of the solids.
fn check<N, const D: usize>(case: &Case<'_>) -> Option<Result<(), String>>
where
    N: Simplicial<D> + Own<D>,
    f64: Own<D> + Simplicial<D>,
{
    let [a, b] = [solid::<N, D>(case.shapes[0])?, solid::<N, D>(case.shapes[1])?];
    let pose12 = relative::<N, D>(case);
    let Some(found) = separation(&*a, &*b, &pose12, N::INFINITY) else {
        return Some(Err(format!("{}: no answer", case.id)));
    };
    let distance = found.distance.as_f64();
    let normal = found.normal.map(Real::as_f64);
    let exact = [solid::<f64, D>(case.shapes[0])?, solid::<f64, D>(case.shapes[1])?];
    let proven = height([&*exact[0], &*exact[1]], &relative::<f64, D>(case), &normal);
    let across = (found.point2 - found.point1).map(Real::as_f64) - normal * distance;
    // The reference itself may be too small, by up to about 1e-9 of the size for curved solids. A
    // larger distance counts as right if its own normal proves it.
    let beyond = distance - case.expected;
    let proven_better = beyond > 0.0 && proven >= case.expected && beyond < 10.0 * case.tolerance;
    let distance_error = if proven_better { distance - proven } else { beyond };
    let errors = [
        ("distance", distance_error.abs()),
        ("normal", case.expected - proven),
        ("points", across.norm()),
        ("length of the normal", (normal.norm() - 1.0).abs() * case.expected.abs()),
        ("point 1", outside(&*exact[0], &found.point1.coords.map(Real::as_f64).into())),
        ("point 2", {
            let pose = relative::<f64, D>(case);
            let local = pose.inverse_point(&found.point2.coords.map(Real::as_f64).into());
            outside(&*exact[1], &local)
        }),
    ];
    let wrong: Vec<_> = errors
        .iter()
        .filter(|(name, error)| error.is_nan() || *error > case.tolerance * slack::<N>(name))
        .collect();
    if wrong.is_empty() {
        return Some(Ok(()));
    }
    Some(Err(format!(
        "{} (f{}): expected {}, found {distance}, tolerance {}, wrong: {wrong:?}",
        case.id,
        size_of::<N>() * 8,
        case.expected,
        case.tolerance
    )))
}

/// Returns the factor by which the error `name` may exceed the tolerance: for the two points 1000
/// in `f64` and 4 in `f32`, else 1. Points on curved surfaces are accurate only to about the square
/// root of the accuracy of distances: to 1e-7 of the size in `f64`. In `f32`, the tolerance of
/// curved solids is already wide enough for this.
fn slack<N: Real>(name: &str) -> f64 {
    match name.starts_with("point ") {
        true if size_of::<N>() == 8 => 1e3,
        true => 4.0,
        false => 1.0,
    }
}

fn run(case: &Case<'_>, dim: &Value, tolerances: [f64; 2], failures: &mut Vec<String>) -> usize {
    let narrow = Case { tolerance: tolerances[0], ..*case };
    let wide = Case { tolerance: tolerances[1], ..*case };
    let results = if dim == 2 {
        [check::<f32, 2>(&narrow), check::<f64, 2>(&wide)]
    } else {
        [check::<f32, 3>(&narrow), check::<f64, 3>(&wide)]
    };
    let mut count = 0;
    for result in results.into_iter().flatten() {
        count += 1;
        failures.extend(result.err());
    }
    count
}

#[test]
fn narrow_phase_cases() {
    let (mut failures, mut count) = (Vec::new(), 0);
    for case in &cases("narrow_phase_cases.json") {
        let pair = case["pair"].to_string();
        let curved = pair.contains("cylinder") || pair.contains("cone");
        let size = number(&case["size"]);
        let input = Case {
            id: case["id"].as_str().expect("an id"),
            shapes: [&case["shape1"], &case["shape2"]],
            pose12: &case["pos12"],
            pose1: None,
            expected: number(&case["expected_signed_distance"]),
            tolerance: 0.0,
        };
        let tolerances = [if curved { 1e-3 } else { 1e-5 } * size, 1e-10 * size];
        let before = failures.len();
        count += run(&input, &case["dim"], tolerances, &mut failures);
        for failure in &mut failures[before..] {
            *failure = format!("{pair} {} {failure}", case["category"]);
        }
    }
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
    assert_eq!(count, 2 * (1600 - 22), "all but the half-spaces, in both scalars");
}

#[test]
fn regression_cases() {
    let (mut failures, mut count) = (Vec::new(), 0);
    for case in &cases("regression_cases.json") {
        let others = ["halfspace", "ellipsoid"];
        let known = |name: &str| others.iter().all(|other| case[name]["type"] != *other);
        if case["query"] != "signed_distance" || !known("shape1") || !known("shape2") {
            continue;
        }
        let input = Case {
            id: case["id"].as_str().expect("an id"),
            shapes: [&case["shape1"], &case["shape2"]],
            pose12: &case["pose2"],
            pose1: Some(&case["pose1"]),
            expected: number(&case["expected"]["signed_distance"]),
            tolerance: 0.0,
        };
        let tolerances = ["f32", "f64"]
            .map(|scalar| case["tolerance"][scalar].as_f64().unwrap_or(f64::INFINITY));
        count += run(&input, &case["dim"], tolerances, &mut failures);
    }
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
    assert_eq!(count, 2 * (89 - 5), "all but half-spaces and ellipsoids, in both scalars");
}
