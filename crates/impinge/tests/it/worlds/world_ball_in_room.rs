//! Tests that the guide's main program prints what the guide shows, in 2D and 3D.

#[path = "../../../../impinge-first/src/bin/ball_in_room2.rs"]
mod plane;
#[path = "../../../../impinge-first/src/bin/ball_in_room3.rs"]
mod space;

#[test]
fn in_the_plane() {
    assert_eq!(plane::run(13), plane::EXPECTED, "the printed lines");
}

#[test]
fn in_space() {
    assert_eq!(space::run(13), space::EXPECTED, "the printed lines");
}

#[test]
fn every_area_is_left_before_it_is_entered_again() {
    for log in [plane::run(400), space::run(400)] {
        for area in ["purple", "blue", "green", "yellow"] {
            let lines: Vec<&String> = log.iter().filter(|line| line.contains(area)).collect();
            assert!(lines.len() > 50, "the ball comes by often");
            for (count, line) in lines.iter().enumerate() {
                assert_eq!(line.contains("enters"), count % 2 == 0, "{area} at {count}: {line}");
            }
        }
    }
}
