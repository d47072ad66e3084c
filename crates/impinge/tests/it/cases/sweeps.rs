//! Cases of rotating bodies from the corpus of bugs.

use crate::support::query_support;

use impinge::dim2::math::Isometry;
use impinge::math::na::UnitComplex;
use impinge::math::{Real, Vector};
use impinge::query::{ConstantVelocities, ImpactOptions, RigidMotion, nonlinear_time_of_impact};
use query_support::corpus::{number, placed2, regression};
use serde_json::Value;

/// Tests the case of box2d#115, where a sweep that only came near another body was reported as a
/// hit, and a sweep that started after many turns did not end.
fn sweep<N: Real>(case: &Value, tolerance: f64) {
    let (params, expected) = (&case["params"], &case["expected"]);
    let one = placed2::<N>(&case["shape1"], &case["pose1"]).expect("a box");
    let two = placed2::<N>(&case["shape2"], &case["pose2"]).expect("a box");
    let end = placed2::<N>(&case["shape2"], &params["end_pose2"]).expect("a box");
    let way = end.pose.translation.vector - two.pose.translation.vector;
    let turn =
        number::<f64>(&params["end_pose2"]["angle"]) - number::<f64>(&case["pose2"]["angle"]);
    let still = ConstantVelocities::<N, 2>::still(one.pose);
    let after_many_turns = UnitComplex::new(N::lit(513.366_76));
    let starts: [Isometry<N>; 2] =
        [two.pose, Isometry::from_parts(two.pose.translation, after_many_turns)];
    for (turned, start) in starts.into_iter().enumerate() {
        let sweep = ConstantVelocities::<N, 2>::new(start, way, N::lit(turn));
        let within = |distance: f64| {
            let options = ImpactOptions::new().with_max_time(N::ONE);
            let options = options.with_target_distance(N::lit(distance));
            let motions: [&dyn RigidMotion<N, 2>; 2] = [&still, &sweep];
            let (shape1, shape2) = (&*one.shape, &*two.shape);
            let found = nonlinear_time_of_impact(motions[0], shape1, motions[1], shape2, &options);
            let swapped =
                nonlinear_time_of_impact(motions[1], shape2, motions[0], shape1, &options);
            let [found, swapped] = [found, swapped].map(|found| found.map(|found| found.toi));
            assert_eq!(found, swapped, "both orders");
            found.map(Real::as_f64)
        };
        assert_eq!(within(0.0), None, "it only nears");
        let least = number::<f64>(&expected["min_signed_distance"]);
        // The corpus gives the angle of many turns with fewer digits, so its tolerance is greater.
        let tolerance = if turned == 1 { tolerance.max(1e-3) } else { tolerance };
        assert_eq!(within(least - tolerance), None, "not so near");
        let at = number::<f64>(&expected["at"]);
        let found = within(least + tolerance).expect("so near");
        assert!((found - at).abs() < 0.01, "{found} is not the end");
        let start_distance = number::<f64>(&expected["start_signed_distance"]);
        assert_eq!(within(start_distance + tolerance), Some(0.0), "from the start");
        let later = within(start_distance - tolerance).expect("soon");
        assert!(later > 0.0 && later < 0.01, "{later} is not the start");
    }
    assert_eq!(expected["hit"], false, "as the case says");
    assert_ne!(way, Vector::<N, 2>::zeros(), "it moves");
}

#[test]
fn box2d_115_toi_sweep() {
    let cases: Vec<_> =
        regression().into_iter().filter(|case| case["query"] == "nonlinear_cast").collect();
    assert_eq!(cases.len(), 1, "all of them");
    for case in &cases {
        sweep::<f64>(case, number::<f64>(&case["tolerance"]["f64"]));
        sweep::<f32>(case, number::<f64>(&case["tolerance"]["f32"]));
    }
}
