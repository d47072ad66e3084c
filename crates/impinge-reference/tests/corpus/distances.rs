//! Compares signed distances, ray casts and point queries of the reference with the corpus.

use crate::read::{ReadPose, cases, number, numbers, read, solid};
use impinge_reference::geometry::vector::{norm, sub};
use impinge_reference::geometry::{
    Pose, Reference, Solid, linear_cast, point_signed_distance, ray_cast, separation_along,
    signed_distance,
};
use serde_json::Value;

struct Pair<const D: usize> {
    solid1: Solid<D>,
    pose1: Pose<D>,
    solid2: Solid<D>,
    pose2: Pose<D>,
}

impl<const D: usize> Pair<D> {
    fn new(case: &Value, pose1: Pose<D>, pose2: Pose<D>) -> Option<Self> {
        let (solid1, tilt1) = solid(&case["shape1"])?;
        let (solid2, tilt2) = solid(&case["shape2"])?;
        Some(Self { solid1, pose1: pose1.compose(&tilt1), solid2, pose2: pose2.compose(&tilt2) })
    }

    fn signed_distance(&self) -> Reference<D> {
        signed_distance(&self.solid1, &self.pose1, &self.solid2, &self.pose2)
    }

    fn swapped(&self) -> Reference<D> {
        signed_distance(&self.solid2, &self.pose2, &self.solid1, &self.pose1)
    }

    /// Returns the upper bound of the signed distance minus the separation along `normal`. For
    /// half-spaces, whose separation may be infinite, returns the length of the difference between
    /// `normal` and the normal of `found`.
    fn normal_loss(&self, found: &Reference<D>, normal: &[f64; D]) -> f64 {
        let along = separation_along(&self.solid1, &self.pose1, &self.solid2, &self.pose2, normal);
        if along.is_finite() {
            return found.upper - along;
        }
        norm(&sub(normal, &found.normal.expect("bounded")))
    }

    fn is_curved(&self) -> bool {
        let curved = |s: &Solid<D>| matches!(s, Solid::Cylinder { .. } | Solid::Cone { .. });
        curved(&self.solid1) || curved(&self.solid2)
    }
}

fn check_regression<const D: usize>(case: &Value) -> bool
where
    Pose<D>: ReadPose,
{
    let poses = (Pose::read(&case["pose1"]), Pose::read(&case["pose2"]));
    let Some(pair) = Pair::new(case, poses.0, poses.1) else { return false };
    let expected = number(&case["expected"]["signed_distance"]);
    let tolerance = number(&case["tolerance"]["f64"]);
    for found in [pair.signed_distance(), pair.swapped()] {
        let error = found.error_of(expected);
        assert!(error <= tolerance, "{}: {found:?}, not {expected}", case["id"]);
        assert!(found.upper - found.lower <= 1e-4, "{}: {found:?} is wide", case["id"]);
    }
    if case["expected"]["normal1"].is_array() {
        let loss =
            pair.normal_loss(&pair.signed_distance(), &numbers(&case["expected"]["normal1"]));
        assert!(loss.abs() <= 10.0 * tolerance, "{}: normal loses {loss}", case["id"]);
    }
    true
}

#[test]
fn regression_signed_distances() {
    let corpus = read("regression_cases.json");
    let (mut done, mut left_out) = (0, Vec::new());
    for case in cases(&corpus).iter().filter(|case| case["query"] == "signed_distance") {
        let known = if case["dim"] == 2 {
            check_regression::<2>(case)
        } else {
            check_regression::<3>(case)
        };
        if known {
            done += 1;
        } else {
            left_out.push(case["id"].as_str().expect("an id"));
        }
    }
    assert_eq!(left_out, ["mujoco-EllipsoidSlowConvergence"]);
    assert_eq!(done, 88);
}

fn check_narrow_phase<const D: usize>(case: &Value)
where
    Pose<D>: ReadPose,
{
    let pair = Pair::new(case, Pose::identity(), Pose::read_pos12(&case["pos12"]))
        .unwrap_or_else(|| panic!("{} has an unknown shape", case["id"]));
    let size = number(&case["size"]);
    let share = if pair.is_curved() { 1e-8 } else { 1e-13 };
    let expected = number(&case["expected_signed_distance"]);
    let found = pair.signed_distance();
    let error = found.error_of(expected).max((found.lower - expected).abs()) / size;
    assert!(error <= share, "{}: {found:?}, not {expected}", case["id"]);
    assert!((found.upper - found.lower) / size <= 1e-9, "{}: {found:?} is wide", case["id"]);
    let normal = found.normal.expect("bounded");
    let loss = pair.normal_loss(&found, &normal) / size;
    assert!(loss.abs() <= 1e-9, "{}: normal loses {loss}", case["id"]);
}

#[test]
fn narrow_phase_signed_distances() {
    let corpus = read("narrow_phase_cases.json");
    let (mut penetrating, mut done) = (0, 0);
    for case in cases(&corpus) {
        if case["dim"] == 2 {
            check_narrow_phase::<2>(case);
        } else {
            check_narrow_phase::<3>(case);
        }
        done += 1;
        penetrating += u32::from(number(&case["expected_signed_distance"]) < 0.0);
    }
    assert!(done > 1500 && penetrating > done / 4, "{done} cases, {penetrating} penetrate");
}

fn check_ray<const D: usize>(case: &Value) -> bool
where
    Pose<D>: ReadPose,
{
    let Some((shape, tilt)) = solid::<D>(&case["shape1"]) else { return false };
    let pose = Pose::read(&case["pose1"]).compose(&tilt);
    let (params, expected) = (&case["params"], &case["expected"]);
    let t = ray_cast(&shape, &pose, &numbers(&params["origin"]), &numbers(&params["dir"]));
    assert_eq!(Some(t.is_some()), expected["hit"].as_bool(), "{}: {t:?}", case["id"]);
    if let Some(t) = t {
        let error = (t - number(&expected["t"])).abs();
        assert!(error <= number(&case["tolerance"]["f64"]), "{}: {t}, not {expected}", case["id"]);
    }
    true
}

#[test]
fn regression_rays() {
    let corpus = read("regression_cases.json");
    let rays = cases(&corpus).iter().filter(|case| case["query"] == "ray");
    let done = rays
        .filter(|case| if case["dim"] == 2 { check_ray::<2>(case) } else { check_ray::<3>(case) });
    // The other cases are about height fields and meshes.
    assert_eq!(done.count(), 13);
}

#[test]
fn regression_point_distances() {
    let corpus = read("regression_cases.json");
    let mut done = 0;
    for case in cases(&corpus).iter().filter(|case| case["query"] == "point_projection") {
        let distance = if case["dim"] == 2 {
            let Some((shape, _)) = solid::<2>(&case["shape1"]) else { continue };
            let pose = ReadPose::read(&case["pose1"]);
            point_signed_distance(&shape, &pose, &numbers(&case["params"]["point"]))
        } else {
            let Some((shape, _)) = solid::<3>(&case["shape1"]) else { continue };
            let pose = ReadPose::read(&case["pose1"]);
            point_signed_distance(&shape, &pose, &numbers(&case["params"]["point"]))
        };
        let error = (distance - number(&case["expected"]["distance"])).abs();
        assert!(error <= number(&case["tolerance"]["f64"]), "{}: {distance}", case["id"]);
        done += 1;
    }
    assert_eq!(done, 4);
}

fn check_cast<const D: usize>(case: &Value) -> bool
where
    Pose<D>: ReadPose,
{
    let poses = (Pose::read(&case["pose1"]), Pose::read(&case["pose2"]));
    let Some(pair) = Pair::<D>::new(case, poses.0, poses.1) else { return false };
    let (params, expected) = (&case["params"], &case["expected"]);
    let found = linear_cast(
        (&pair.solid1, &pair.pose1, &numbers(&params["vel1"])),
        (&pair.solid2, &pair.pose2, &numbers(&params["vel2"])),
        number(&params["max_time_of_impact"]),
    );
    assert_eq!(Some(found.time_of_impact.is_some()), expected["hit"].as_bool(), "{}", case["id"]);
    let tolerance = case["tolerance"]["f64"].as_f64().unwrap_or(0.0);
    if let Some(time) = found.time_of_impact {
        let error = (time - number(&expected["time_of_impact"])).abs();
        assert!(error <= tolerance, "{}: {found:?}, not {expected}", case["id"]);
    }
    if let Some(least) = expected["min_signed_distance_on_path"].as_f64() {
        let error = (found.least_distance - least).abs();
        assert!(error <= tolerance, "{}: {found:?}, not {expected}", case["id"]);
    }
    true
}

#[test]
fn regression_casts() {
    let corpus = read("regression_cases.json");
    let casts = cases(&corpus).iter().filter(|case| case["query"] == "linear_cast");
    let run = |case: &&Value| {
        if case["dim"] == 2 { check_cast::<2>(case) } else { check_cast::<3>(case) }
    };
    // The other two cases are about height fields.
    assert_eq!(casts.filter(run).count(), 25);
}
