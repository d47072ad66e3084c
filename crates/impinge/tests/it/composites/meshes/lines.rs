//! Tests which normals polylines admit.

use impinge::dim2::procedural;
use impinge::math::{Pose, Real, Space, Vector};
use impinge::shape::{Ball, CompositeShape, FeatureId, MeshError, PartSolid, Polyline, Shape};

use super::{points, surface, unit, vector};

const START: FeatureId = FeatureId::Vertex(0);
const END: FeatureId = FeatureId::Vertex(1);
const WHOLE: FeatureId = FeatureId::Edge(0);

fn open<N: Space<D>, const D: usize>(vertices: &[[f64; D]]) -> Polyline<N, D> {
    Polyline::open(points(vertices))
}

/// Returns the upward normal tilted by `degrees` to the right.
fn leaning<N: Real>(degrees: f64) -> Vector<N, 2> {
    let (sine, cosine) = degrees.to_radians().sine_cosine();
    vector([sine, cosine])
}

#[test]
fn chains_run_from_each_vertex_to_the_next() {
    let corners = points(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    let (open, closed) = (Polyline::<f32, 2>::open(corners.clone()), Polyline::closed(corners));
    assert_eq!(open.segments(), [[0, 1], [1, 2]], "open");
    assert_eq!(closed.segments(), [[0, 1], [1, 2], [2, 0]], "closed");
    assert!(!open.is_closed() && closed.is_closed(), "as named");
    assert!(open.are_adjacent(0, 1) && closed.are_adjacent(0, 2), "in a row");
    assert_eq!((closed.joined(0, 0), open.joined(0, 0)), ([0, 2].as_slice(), [0].as_slice()));
    let part = closed.part(2);
    assert_eq!(part.pose, Pose::identity(), "in the frame of the line");
    assert!(matches!(part.solid, PartSolid::Segment(s) if s == closed.segment(2)), "a segment");
    let aabb = Shape::<f32, 2>::local_aabb(&closed);
    assert_eq!((aabb.mins(), aabb.maxs()), (&[0.0, 0.0].into(), &[1.0, 1.0].into()), "tight");
}

#[test]
fn a_straight_joint_has_the_normals_of_its_segments_only() {
    let straight = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    let chain = open::<f32, 2>(&straight);
    let soup = Polyline::<f32, 2>::new(points(&straight), vec![[0, 1], [3, 2]]);
    for (line, last) in [(&chain, (2, START)), (&soup, (1, END))] {
        for (part, feature) in [(0, END), (0, WHOLE), last] {
            let admits = |degrees| surface(line).admits(part, feature, &leaning(degrees));
            assert!(admits(0.0) && admits(180.0), "{part} {feature:?}: its own");
            for degrees in [90.0, -90.0, 45.0, 1.0, -0.1, 179.0] {
                assert!(!admits(degrees), "{part} {feature:?}: {degrees}");
            }
            let snapped = |degrees| surface(line).snapped(part, &leaning(degrees));
            assert_eq!(snapped(45.0), Some(leaning(0.0)), "above");
            assert_eq!(snapped(91.0), Some(-leaning::<f32>(0.0)), "below");
            assert_eq!(snapped(90.0), None, "neither");
        }
    }
    assert_eq!(surface(&chain).snapped(1, &leaning(0.0)), None, "no length, no normal");
}

#[test]
fn bends_and_ends() {
    // A line of three segments: up to a top, down to a valley, and up again.
    let line = open::<f64, 2>(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0]]);
    let admits = |part, feature, degrees| surface(&line).admits(part, feature, &leaning(degrees));
    for (part, end) in [(0, END), (1, START)] {
        for degrees in [-44.9, 0.0, 30.0, 44.9] {
            assert!(admits(part, end, degrees), "the top: {degrees}");
            assert!(!admits(part, end, 180.0 + degrees), "under the top: {degrees}");
        }
        assert!(!admits(part, end, 46.0) && !admits(part, end, 90.0), "the slope");
    }
    assert!(admits(0, END, -45.0) && admits(1, START, 45.0), "their own");
    for (part, end) in [(1, END), (2, START)] {
        for degrees in [-44.0, 0.0, 30.0] {
            assert!(!admits(part, end, degrees), "the valley: {degrees}");
            assert!(admits(part, end, 180.0 + degrees), "under the valley: {degrees}");
        }
    }
    for degrees in [-45.0, -90.0, -135.0, -180.0, -224.0] {
        assert!(admits(0, START, degrees), "the start: {degrees}");
    }
    assert!(!admits(0, START, -44.0) && !admits(0, START, 45.0), "along the segment");
}

#[test]
fn one_side_is_the_right_one() {
    let outline = procedural::ball(&Ball::new(1.0_f64), 16);
    let ring = Polyline::try_from(outline).expect("a good outline").one_sided();
    assert!(ring.is_one_sided() && ring.is_closed(), "as asked");
    for part in 0..ring.num_parts() {
        let segment = ring.segment(part);
        let outward = (segment.a().coords + segment.b().coords).normalize();
        let whole = surface(&ring);
        assert!(whole.admits(part, WHOLE, &outward) && !whole.admits(part, WHOLE, &-outward));
        for normal in [outward, -outward] {
            let own = whole.snapped(part, &normal).expect("a length");
            assert!((own - outward).norm() < 1e-15, "always the front: {part}");
        }
        for (end, at) in [(START, segment.a()), (END, segment.b())] {
            assert!(whole.admits(part, end, &at.coords), "{part}: outwards");
            assert!(!whole.admits(part, end, &-at.coords), "{part}: inwards");
            assert!(!whole.admits(part, end, &-outward), "{part}: its back");
        }
        assert!(whole.faces(part, &(outward * 2.0).into()), "{part}: from outside");
        assert!(!whole.faces(part, &vector([0.0, 0.0]).into()), "{part}: from inside");
    }
    let mirrored = ring.try_scaled(&vector([-2.0, 1.0])).expect("not zero");
    for part in 0..mirrored.num_parts() {
        assert!(!surface(&mirrored).faces(part, &vector([0.0, 0.0]).into()), "still outside");
    }
    let kept = ring.with_internal_edges_kept();
    assert!(surface(&kept).admits(0, END, &unit([1.0, -0.2])), "like any end");
    assert!(!surface(&kept).admits(0, END, &unit([-1.0, -0.2])), "from behind");
}

#[test]
fn a_one_sided_valley_has_no_back() {
    let line = open::<f64, 2>(&[[3.0, 1.0], [2.0, 0.0], [1.0, 1.0]]).one_sided();
    assert!(surface(&line).faces(0, &vector([2.0, 0.5]).into()), "seen from above");
    assert!(!surface(&line).admits(0, END, &leaning(180.0)), "a ridge from behind");
    assert!(!surface(&line).admits(0, END, &leaning(0.0)), "hollow");
    assert!(surface(&line).admits(0, END, &leaning(-45.0)), "its own");
}

#[test]
fn joints_in_space() {
    let line = open::<f64, 3>(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
    let admits = |part, feature, normal| surface(&line).admits(part, feature, &unit(normal));
    for normal in [[0.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, -1.0]] {
        assert!(admits(0, WHOLE, normal) && admits(0, END, normal), "around the segment");
        assert!(!admits(0, END, [0.5, normal[1], normal[2]]), "along it");
    }
    assert!(admits(0, START, [-1.0, 0.0, 0.0]) && admits(0, START, [-1.0, 1.0, 0.0]), "the end");
    assert!(admits(1, END, [1.0, -1.0, 0.0]) && admits(1, END, [1.0, -1.0, 1.0]), "outside");
    assert!(!admits(1, END, [-1.0, 1.0, 0.0]) && !admits(1, END, [1.0, 1.0, 0.0]), "inside");
    let snapped = surface(&line).snapped(0, &unit([3.0, 0.0, 4.0])).expect("a circle of normals");
    assert!((snapped - vector::<f64, 3>([0.0, 0.0, 1.0])).norm() < 1e-15, "straightened");
    assert_eq!(surface(&line).snapped(0, &unit([1.0, 0.0, 0.0])), None, "along the segment");
}

#[test]
fn lines_are_scaled() {
    let line = open::<f32, 3>(&[[0.0; 3], [1.0, 2.0, 3.0]]);
    let scaled = line.try_scaled(&vector([2.0, 1.0, -1.0])).expect("not zero");
    assert_eq!(scaled.segment(0).a(), &[2.0, 2.0, -3.0].into(), "mirrored: turned around");
    let refused = line.try_scaled(&vector([1.0, f64::NAN, 1.0])).expect_err("bad scale");
    assert!(matches!(refused, MeshError::BadScale { axis: 1, .. }), "{refused}");
}
