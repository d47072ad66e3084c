//! Compares the hits of `cast` and `ray` with results computed by hand, also for starts inside a
//! solid and for groups.

use serde_json::json;

use crate::support::{Desk, is_close, numbers};

#[test]
fn a_ray_hits_the_near_ball_first() {
    let desk = Desk::new();
    let report = desk.json("ray balls.json --from -5,0,0 --to 5,0,0", 1);
    let hits = report["hits"].as_array().expect("a list");
    assert_eq!(hits.len(), 1, "the first alone");
    let hit = &hits[0];
    assert_eq!(hit["object"], "left");
    assert!(is_close(&hit["length"], 2.75), "the left ball begins at -2.25: {hit}");
    assert!(is_close(&hit["time"], 0.275), "of the way of 10: {hit}");
    assert_eq!(numbers(&hit["point"]), [-2.25, 0.0, 0.0]);
    assert_eq!(numbers(&hit["normal"]), [-1.0, 0.0, 0.0]);
}

#[test]
fn a_ray_without_end_hits_both_and_a_short_one_none() {
    let desk = Desk::new();
    let all = desk.json("ray balls.json --from -5,0,0 --direction 1,0,0 --all", 1);
    let times: Vec<_> =
        all["hits"].as_array().expect("a list").iter().map(|hit| hit["time"].clone()).collect();
    assert_eq!(times, [json!(2.75), json!(5.25)]);
    let short = desk.json("ray balls.json --from -5,0,0 --to -3,0,0", 0);
    assert_eq!(short["hits"], json!([]));
    let text = desk.run("ray balls.json --from -5,0,0 --to -3,0,0");
    assert!(text.out.starts_with("nothing is hit"), "{text:?}");
}

#[test]
fn a_ray_from_inside_meets_a_solid_at_once_and_leaves_a_hollow_one() {
    let desk = Desk::new();
    let solid = desk.json("ray balls.json --from 1.25,0,0 --direction 1,0,0", 1);
    assert_eq!(solid["hits"][0]["time"], 0.0);
    let hollow = desk.json("ray balls.json --from 1.25,0,0 --direction 1,0,0 --hollow", 1);
    assert_eq!(hollow["hits"][0]["time"], 1.0, "at the surface");
}

#[test]
fn a_ball_of_radius_a_quarter_hits_the_left_one() {
    let desk = Desk::new();
    let hit =
        &desk.json("cast balls.json --shape ball:0.25 --from -5,0,0 --to 5,0,0", 1)["hits"][0];
    assert_eq!(hit["object"], "left");
    assert!(is_close(&hit["moved"], 2.5), "{hit}");
    assert!(is_close(&hit["time"], 0.25), "{hit}");
    assert!(is_close(&hit["position"][0], -2.5), "{hit}");
    assert!(is_close(&hit["point"][0], -2.25), "{hit}");
    assert_eq!(numbers(&hit["normal"]), [1.0, 0.0, 0.0], "towards the object");
}

#[test]
fn boxes_and_capsules_are_cast_in_2d_and_3d() {
    let desk = Desk::new();
    let moved = |arguments: &str| {
        let report = desk.json(arguments, 1);
        report["hits"][0]["moved"].as_f64().expect("a number")
    };
    // The disc covers y from 2.5 to 3.5 at x = 0. The capsule is upright, with a height of 1.5.
    let capsule = moved("cast squares.json --shape capsule:0.5,0.25 --from 0,6 --to 0,0");
    assert!((capsule - 1.75).abs() < 1e-5, "{capsule}");
    let square = moved("cast squares.json --shape box:0.5,0.5 --from 4,0 --to 0,0");
    assert!((square - 0.625).abs() < 1e-5, "from the square that ends at 2.875: {square}");
    // The top of the lamp is at 2.15. The floor, box and ghost are below it.
    let all = "cast boxes.json --shape box:1,1,1 --from 0,9,0 --to 0,0,0 --all";
    let report = desk.json(all, 1);
    assert_eq!(report["hits"].as_array().map(Vec::len), Some(4), "{report}");
    assert!(is_close(&report["hits"][0]["moved"], 9.0 - 1.0 - 2.15), "{report}");
}

#[test]
fn an_object_hits_others_by_its_groups() {
    let desk = Desk::new();
    let hit = &desk.json("cast balls.json --object left --by 2,0,0", 1)["hits"][0];
    assert_eq!((&hit["object"], &hit["moved"]), (&json!("right"), &json!(0.5)));
    let none = desk.json("cast boxes.json --object ghost --by 0,-9,0 --all", 0);
    assert_eq!(none["hits"], json!([]), "the ghost accepts nobody");
    let early =
        &desk.json("cast balls.json --object left --by 2,0,0 --distance 0.25", 1)["hits"][0];
    assert!(is_close(&early["moved"], 0.25), "{early}");
}
