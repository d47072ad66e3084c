//! Tests hulls of every point set of the shared test data.

use std::path::Path;

use impinge::math::{Point, Real};
use impinge::shape::{ConvexHull, ConvexPolygon, ShapeError};
use impinge::transformation::{convex_hull2, convex_hull3};
use serde_json::Value;

use super::checks::{cast, hull_of};
use super::points::P3;

fn read(file: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    let text = std::fs::read_to_string(&path).expect("the data lie beside the tests");
    serde_json::from_str(&text).expect("the data are JSON")
}

fn cases(file: &str) -> Vec<Value> {
    read(file)["cases"].as_array().expect("a list of cases").clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().expect("a list of numbers");
    numbers.iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn points3(value: &Value) -> Vec<P3> {
    let points = value.as_array().expect("a list of points");
    points.iter().map(|p| Point::from_slice(&numbers(p))).collect()
}

fn points2<N: Real>(value: &Value) -> Vec<Point<N, 2>> {
    let points = value.as_array().expect("a list of points");
    points.iter().map(numbers).map(|p| Point::<N, 2>::new(N::lit(p[0]), N::lit(p[1]))).collect()
}

/// Returns the lists of points of all shapes of these kinds in the pair cases of both files.
fn shapes(kinds: &[&str]) -> Vec<Value> {
    let mut shapes = Vec::new();
    for file in ["narrow_phase_cases.json", "regression_cases.json"] {
        for case in cases(file) {
            for side in ["shape1", "shape2"] {
                let shape = &case[side];
                if kinds.iter().any(|&kind| shape["type"] == kind) {
                    shapes.push(shape["points"].clone());
                }
            }
        }
    }
    shapes
}

fn solids<N: Real>() {
    let shapes = shapes(&["convex", "convex_hull"]);
    assert!(shapes.len() > 300, "{} solids", shapes.len());
    for shape in &shapes {
        let points = points3(shape);
        hull_of::<N>("corpus", &points);
        let solid = ConvexHull::<N>::from_points(&cast(&points));
        assert_eq!(solid.validate(), Ok(()), "{points:?}");
    }
}

#[test]
fn solids_of_the_corpus() {
    solids::<f32>();
    solids::<f64>();
}

fn polygons<N: Real>() {
    let shapes = shapes(&["convex_polygon"]);
    assert!(shapes.len() > 100, "{} polygons", shapes.len());
    for shape in &shapes {
        let points = points2::<N>(shape);
        let (given, found) = (ConvexPolygon::new(&points), ConvexPolygon::from_points(&points));
        assert_eq!((given.validate(), found.validate()), (Ok(()), Ok(())), "{points:?}");
        assert_eq!(given.vertices().len(), found.vertices().len(), "all corners: {points:?}");
    }
}

#[test]
fn polygons_of_the_corpus() {
    polygons::<f32>();
    polygons::<f64>();
}

/// Asserts that the hull passes the checks, or that the points are refused as degenerate or too
/// few.
fn hull_or_flat<N: Real>(points: &[P3]) {
    match convex_hull3(&cast::<N>(points)) {
        Ok(_) => assert!(!hull_of::<N>("hard", points).faces.is_empty(), "faces"),
        Err(ShapeError::Degenerate { .. } | ShapeError::TooFewPoints { .. }) => (),
        Err(other) => panic!("{other}"),
    }
}

fn area<N: Real>(points: &[Point<N, 2>], ring: &[usize]) -> f64 {
    let at = |i: usize| points[ring[i % ring.len()]].coords.map(Real::as_f64);
    (0..ring.len()).map(|i| at(i).x * at(i + 1).y - at(i).y * at(i + 1).x).sum::<f64>() / 2.0
}

fn hull_case2<N: Real>(case: &Value) {
    let points = points2::<N>(&case["params"]["points"]);
    let expected = &case["expected"];
    if expected["area"].is_null() {
        let error = convex_hull2(&points).expect_err("no area");
        assert_eq!(error, ShapeError::Degenerate { dimension: 1 }, "{case}");
        return;
    }
    let mut ring = convex_hull2(&points).expect("an area");
    let difference = area(&points, &ring) - expected["area"].as_f64().expect("a number");
    let tolerance = N::EPSILON.as_f64() * 1e3;
    assert!(difference.abs() < tolerance, "area off by {difference}: {case}");
    ring.sort_unstable();
    let vertices: Vec<usize> = numbers(&expected["hull_vertices_set"])
        .iter()
        .map(|&v| format!("{v}").parse().expect("whole"))
        .collect();
    // A vertex that protrudes by less than rounding may be missing.
    assert!(ring.iter().all(|vertex| vertices.contains(vertex)), "{ring:?} of {case}");
}

#[test]
fn hull_cases_of_the_corpus() {
    let cases = cases("regression_cases.json");
    let hulls: Vec<&Value> = cases.iter().filter(|case| case["query"] == "convex_hull").collect();
    assert_eq!(hulls.len(), 8, "all of them are run");
    for case in hulls {
        if case["dim"] == 2 {
            hull_case2::<f32>(case);
            hull_case2::<f64>(case);
            continue;
        }
        let params = &case["params"];
        let sets = params["point_sets"].as_array().cloned();
        for set in sets.unwrap_or_else(|| vec![params["points"].clone()]) {
            hull_or_flat::<f32>(&points3(&set));
            hull_or_flat::<f64>(&points3(&set));
        }
    }
}
