//! Tests rays whose results are computed by hand.

use impinge::math::na::{Complex, Translation2, UnitComplex};
use impinge::math::{Isometry2, Isometry3, Point, Space, Unit, Vector};
use impinge::query::{PointQuery, Ray, RayCast};
use impinge::shape::{
    Ball, Capsule, Cone, Cuboid, Cylinder, FeatureId, Plane, Rounded, Segment, Shape, ShapeHandle,
    TaperedCapsule, Triangle,
};

type P2 = Point<f64, 2>;
type P3 = Point<f64, 3>;
type V2 = Vector<f64, 2>;
type V3 = Vector<f64, 3>;

/// The origin and the direction of a ray, and the expected times at which it hits the solid and the
/// hollow shape; `None` for a miss.
type Case<const D: usize> = ([f64; D], [f64; D], Option<f64>, Option<f64>);

fn check<const D: usize>(shape: &dyn Shape<f64, D>, cases: &[Case<D>])
where
    f64: Space<D>,
{
    for &(origin, dir, solid, hollow) in cases {
        let ray = Ray::new(Point::from(origin), Vector::<f64, D>::from(dir));
        for (solid, expected) in [(true, solid), (false, hollow)] {
            let found = shape.cast_local_ray(&ray, solid).map(|hit| hit.toi);
            let same = match (found, expected) {
                (Some(found), Some(expected)) => (found - expected).abs() <= 4e-15 * expected,
                (found, expected) => found == expected,
            };
            assert!(same, "{shape:?} {ray:?} solid {solid}: {found:?}, not {expected:?}");
        }
    }
}

fn at(t: f64) -> (Option<f64>, Option<f64>) {
    (Some(t), Some(t))
}

/// Returns the case of a ray that starts outside, for which solid and hollow shapes have the same
/// hit.
fn from_outside<const D: usize>(origin: [f64; D], dir: [f64; D], t: f64) -> Case<D> {
    let (solid, hollow) = at(t);
    (origin, dir, solid, hollow)
}

fn miss<const D: usize>(origin: [f64; D], dir: [f64; D]) -> Case<D> {
    (origin, dir, None, None)
}

fn from_inside<const D: usize>(origin: [f64; D], dir: [f64; D], leave: f64) -> Case<D> {
    (origin, dir, Some(0.0), Some(leave))
}

#[test]
fn balls() {
    check::<2>(
        &Ball::new(1.0),
        &[
            from_outside([-3.0, 0.0], [1.0, 0.0], 2.0),
            from_outside([-3.0, 0.0], [0.5, 0.0], 4.0),
            from_outside([-3.0, 1.0], [1.0, 0.0], 3.0),
            miss([-3.0, 1.0001], [1.0, 0.0]),
            miss([3.0, 0.0], [1.0, 0.0]),
            from_inside([0.0, 0.0], [2.0, 0.0], 0.5),
            from_inside([1.0, 0.0], [1.0, 0.0], 0.0),
            from_outside([1.0, 0.0], [-1.0, 0.0], 0.0),
        ],
    );
    check::<3>(
        &Ball::new(2.0),
        &[
            from_outside([0.0, 0.0, -6.0], [0.0, 0.0, 1000.0], 0.004),
            from_outside([0.0, 2.0, -6.0], [0.0, 0.0, 1.0], 6.0),
            miss([0.0, 2.0, -6.0], [0.0, 1e-9, 1.0]),
            from_inside([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], 3.0),
        ],
    );
    check::<3>(
        &Ball::new(0.0),
        &[
            from_outside([0.0, 0.0, -6.0], [0.0, 0.0, 1.0], 6.0),
            miss([0.0, 1e-9, -6.0], [0.0, 0.0, 1.0]),
        ],
    );
}

#[test]
fn cuboids() {
    check::<2>(
        &Cuboid::new(V2::new(1.0, 2.0)),
        &[
            from_outside([-3.0, 0.0], [1.0, 0.0], 2.0),
            from_outside([-2.0, -3.0], [1.0, 1.0], 1.0),
            from_outside([-3.0, 0.0], [1.0, 1.0], 2.0),
            from_outside([-3.0, 2.0], [1.0, 0.0], 2.0),
            miss([-3.0, 2.0001], [1.0, 0.0]),
            miss([3.0, 2.0], [1.0, 0.0]),
            from_inside([0.0, 0.0], [0.0, 4.0], 0.5),
            from_inside([1.0, 0.0], [1.0, 0.0], 0.0),
            from_outside([1.0, 0.0], [-1.0, 0.0], 0.0),
            from_inside([0.0, 2.0], [1.0, 0.0], 0.0),
        ],
    );
    check::<3>(
        &Cuboid::new(V3::new(1.0, 1.0, 1.0)),
        &[
            from_outside([-2.0, -2.0, -2.0], [1.0, 1.0, 1.0], 1.0),
            from_outside([-2.0, 1.0, 1.0], [1.0, 0.0, 0.0], 1.0),
            from_outside([-2.0, 0.0, 1.0], [1.0, 1.0, 0.0], 1.0),
            miss([-2.0, 1.0, 1.0001], [1.0, 0.0, 0.0]),
        ],
    );
    check::<2>(
        &Cuboid::new(V2::new(0.0, 1.0)),
        &[
            from_outside([-1.0, 0.0], [1.0, 0.0], 1.0),
            from_outside([0.0, -3.0], [0.0, 1.0], 2.0),
            from_inside([0.0, 0.0], [0.0, 1.0], 0.0),
            miss([1e-9, -3.0], [0.0, 1.0]),
        ],
    );
}

#[test]
fn half_spaces() {
    check::<2>(
        &Plane::new(Unit::new_unchecked(V2::y())),
        &[
            from_outside([0.0, 2.0], [3.0, -1.0], 2.0),
            miss([0.0, 2.0], [0.0, 1.0]),
            miss([0.0, 2.0], [1.0, 0.0]),
            ([0.0, -1.0], [0.0, -1.0], Some(0.0), None),
            ([0.0, -1.0], [1.0, 0.0], Some(0.0), None),
            from_inside([0.0, -1.0], [1.0, 2.0], 0.5),
            from_inside([0.0, 0.0], [1.0, 0.0], 0.0),
            from_outside([0.0, 0.0], [0.0, -1.0], 0.0),
        ],
    );
}

#[test]
fn segments() {
    check::<2>(
        &Segment::new(P2::new(0.0, 0.0), P2::new(2.0, 0.0)),
        &[
            from_outside([1.0, 3.0], [0.0, -1.0], 3.0),
            from_outside([0.0, 3.0], [0.0, -1.0], 3.0),
            from_outside([2.0, 3.0], [0.0, -0.25], 12.0),
            miss([2.5, 3.0], [0.0, -1.0]),
            from_outside([-1.0, 0.0], [1.0, 0.0], 1.0),
            from_outside([3.0, 0.0], [-2.0, 0.0], 0.5),
            miss([-1.0, 0.0], [-1.0, 0.0]),
            miss([0.0, 1.0], [1.0, 0.0]),
            from_inside([1.0, 0.0], [1.0, 0.0], 0.0),
            from_inside([1.0, 0.0], [0.0, 1.0], 0.0),
        ],
    );
    check::<3>(
        &Segment::new(P3::new(0.0, 0.0, 0.0), P3::new(1.0, 2.0, 3.0)),
        &[
            from_outside([0.5, 1.0, 5.5], [0.0, 0.0, -1.0], 4.0),
            miss([0.5, 1.001, 5.5], [0.0, 0.0, -1.0]),
            from_outside([-1.0, -2.0, -3.0], [1.0, 2.0, 3.0], 1.0),
            miss([2.0, 4.0, 6.0], [1.0, 2.0, 3.0]),
        ],
    );
    check::<2>(
        &Segment::new(P2::new(3.0, 1.0), P2::new(3.0, 1.0)),
        &[
            from_outside([0.0, 1.0], [1.0, 0.0], 3.0),
            from_outside([0.0, 0.0], [3.0, 1.0], 1.0),
            miss([0.0, 0.0], [3.0, 1.01]),
        ],
    );
}

#[test]
fn capsules() {
    check::<2>(
        &Capsule::new(1.0, 1.0),
        &[
            from_outside([-3.0, 0.0], [1.0, 0.0], 2.0),
            from_outside([0.0, 5.0], [0.0, -1.0], 3.0),
            from_outside([-3.0, 1.0], [1.0, 0.0], 2.0),
            from_outside([-3.0, 1.6], [1.0, 0.0], 2.2),
            from_outside([-3.0, 2.0], [1.0, 0.0], 3.0),
            miss([-3.0, 2.0001], [1.0, 0.0]),
            from_outside([1.0, 5.0], [0.0, -1.0], 4.0),
            from_inside([0.0, 0.0], [0.0, 1.0], 2.0),
            from_inside([0.0, 0.0], [1.0, 0.0], 1.0),
            // Along the side, which the ends touch.
            from_inside([1.0, 0.0], [0.0, 1.0], 0.0),
        ],
    );
    check::<3>(&Capsule::new(1.0, 1.0), &[from_inside([0.0, 0.0, 1.0], [0.0, 1.0, 0.0], 0.0)]);
    check::<3>(&Capsule::new(0.0, 2.0), &[from_outside([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0)]);
    check::<3>(
        &Capsule::new(1.0, 0.0),
        &[
            from_outside([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0], 3.0),
            from_outside([0.0, -3.0, 0.0], [0.0, 1.0, 0.0], 2.0),
        ],
    );
}

#[test]
fn tapered_capsules() {
    let even = TaperedCapsule::<f64, 3>::new(1.0, 0.5, 0.5);
    let ends = [P3::origin(), P3::new(0.0, 5.0, 0.0)];
    let club = TaperedCapsule::try_from_ends(ends[0], ends[1], [1.0, 4.0]).expect("finite");
    // Tangent to the side, which the ray touches at the height 0 and 1.
    let tangents = |touch: [f64; 2]| {
        let [y, z] = touch;
        let toward = from_outside([-10.0, y, z], [1.0, 0.0, 0.0], 10.0);
        [toward, miss([10.0, y, z], [1.0, 0.0, 0.0])]
    };
    check::<3>(&even, &tangents([0.0, 0.5]));
    check::<3>(&club, &tangents([1.0, 2.0]));
    let ray = Ray::new(P3::new(-10.0, 0.0, 0.5), V3::x());
    let hits = [true, false].map(|solid| even.cast_local_ray(&ray, solid).map(|hit| hit.normal));
    assert_eq!(hits, [Some(V3::z()); 2], "out of the side");
    // Along the side, which the ends touch.
    check::<3>(&even, &[from_inside([0.5, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0)]);
    let flat = TaperedCapsule::<f64, 2>::new(1.0, 0.5, 0.5);
    check::<2>(&flat, &[from_inside([0.5, 0.0], [0.0, 1.0], 0.0)]);
    check::<2>(&flat, &[from_inside([0.25, 0.0], [1.0, 0.0], 0.25)]);
}

/// Asserts that a ray tangent to a round side hits the side where it touches it, or misses it by
/// rounding, and that it hits nothing if the side is behind it.
#[test]
fn tangents_of_round_sides() {
    type Side = (ShapeHandle<f64, 3>, [f64; 2], [f64; 2]);
    // Each solid has a point of its side and the normal there, across and along the axis.
    let sides: [Side; 3] = [
        (ShapeHandle::new(TaperedCapsule::<f64, 3>::new(1.0, 0.5, 0.5)), [0.5, 0.25], [1.0, 0.0]),
        (ShapeHandle::new(TaperedCapsule::<f64, 3>::new(2.5, 1.0, 4.0)), [2.0, -1.5], [0.8, -0.6]),
        (ShapeHandle::new(Cone::new(1.0, 1.0)), [0.5, 0.0], [0.8_f64.sqrt(), 0.2_f64.sqrt()]),
    ];
    for (solid, [x, y], [across, along]) in &sides {
        let mut hits = 0;
        for step in (0..200).map(f64::from) {
            let (sine, cosine) = ((0.7 * step).sin(), (0.7 * step).cos());
            let generator = V3::new(-along * cosine, *across, -along * sine);
            let dir = V3::new(-sine, 0.0, cosine) * step.sin().cos() + generator * step.sin().sin();
            let start = P3::new(x * cosine, *y, x * sine) - dir * 7.0;
            let found = solid.cast_local_ray(&Ray::new(start, dir), true).map(|hit| hit.toi);
            assert!(
                found.is_none_or(|toi| (toi - 7.0).abs() < 1e-5),
                "{solid:?} {step}: {found:?}"
            );
            hits += i32::from(found.is_some());
            let away = solid.cast_local_ray(&Ray::new(start, -dir), true);
            assert_eq!(away, None, "{solid:?} {step}: behind the ray");
        }
        assert!((60..200).contains(&hits), "{solid:?}: {hits} hits");
    }
}

#[test]
fn rounded_boxes() {
    let solid = Rounded::new(Cuboid::new(V3::new(1.0, 1.0, 1.0)), 0.5);
    let cases = [
        from_outside([-4.0, 0.0, 0.0], [1.0, 0.0, 0.0], 2.5),
        from_inside([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.5),
        // Along the side.
        from_inside([0.0, 1.5, 0.0], [1.0, 0.0, 0.0], 0.0),
        from_inside([0.5, 0.25, -1.5], [0.0, -2.0, 0.0], 0.0),
    ];
    check::<3>(&solid, &cases);
    let flat = Rounded::new(Cuboid::new(V2::new(1.0, 2.0)), 0.5);
    check::<2>(&flat, &[from_inside([1.5, 1.0], [0.0, 1.0], 0.0)]);
}

#[test]
fn triangles_of_the_plane() {
    let [a, b, c] = [P2::new(0.0, 0.0), P2::new(4.0, 0.0), P2::new(0.0, 4.0)];
    for triangle in [Triangle::new(a, b, c), Triangle::new(a, c, b), Triangle::new(c, a, b)] {
        check::<2>(
            &triangle,
            &[
                from_outside([1.0, -1.0], [0.0, 1.0], 1.0),
                from_outside([-1.0, 0.0], [1.0, 0.0], 1.0),
                from_outside([-2.0, 6.0], [1.0, -1.0], 2.0),
                from_outside([-1.0, 4.0], [1.0, 0.0], 1.0),
                from_outside([-1.0, -1.0], [1.0, 1.0], 1.0),
                miss([-1.0, 4.1], [1.0, 0.0]),
                miss([5.0, 5.0], [1.0, 1.0]),
                from_inside([1.0, 1.0], [1.0, 0.0], 2.0),
                from_inside([1.0, 0.0], [1.0, 0.0], 0.0),
            ],
        );
    }
    let flat = Triangle::new(a, P2::new(2.0, 0.0), b);
    check::<2>(
        &flat,
        &[
            from_outside([1.0, 3.0], [0.0, -1.0], 3.0),
            from_outside([-1.0, 0.0], [1.0, 0.0], 1.0),
            miss([5.0, 3.0], [0.0, -1.0]),
        ],
    );
}

#[test]
fn triangles_of_space() {
    let [a, b, c] = [P3::new(0.0, 0.0, 0.0), P3::new(4.0, 0.0, 0.0), P3::new(0.0, 4.0, 0.0)];
    for triangle in [Triangle::new(a, b, c), Triangle::new(a, c, b)] {
        check::<3>(
            &triangle,
            &[
                from_outside([1.0, 1.0, 3.0], [0.0, 0.0, -1.0], 3.0),
                from_outside([1.0, 1.0, -3.0], [0.0, 0.0, 2.0], 1.5),
                from_outside([2.0, 0.0, 1.0], [0.0, 0.0, -1.0], 1.0),
                from_outside([2.0, 2.0, 1.0], [0.0, 0.0, -1.0], 1.0),
                from_outside([4.0, 0.0, 1.0], [0.0, 0.0, -1.0], 1.0),
                miss([2.0, 2.001, 1.0], [0.0, 0.0, -1.0]),
                miss([1.0, 1.0, 3.0], [0.0, 0.0, 1.0]),
                from_outside([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0], 1.0),
                from_outside([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0),
                miss([-1.0, 1.0, 0.001], [1.0, 0.0, 0.0]),
                from_inside([1.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.0),
                from_inside([1.0, 1.0, 0.0], [0.0, 0.0, 1.0], 0.0),
            ],
        );
    }
    check::<3>(
        &Triangle::new(a, P3::new(2.0, 0.0, 0.0), b),
        &[
            from_outside([1.0, 0.0, 3.0], [0.0, 0.0, -1.0], 3.0),
            miss([1.0, 0.1, 3.0], [0.0, 0.0, -1.0]),
        ],
    );
    check::<3>(&Triangle::new(b, b, b), &[from_outside([4.0, 0.0, 3.0], [0.0, 0.0, -1.0], 3.0)]);
}

#[test]
fn cylinders() {
    check::<3>(
        &Cylinder::new(1.0, 2.0),
        &[
            from_outside([0.0, 5.0, 0.0], [0.0, -1.0, 0.0], 4.0),
            from_outside([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0], 3.0),
            from_outside([-5.0, 1.0, 0.0], [1.0, 0.0, 0.0], 3.0),
            miss([-5.0, 1.0001, 0.0], [1.0, 0.0, 0.0]),
            from_outside([-5.0, 0.0, 2.0], [1.0, 0.0, 0.0], 5.0),
            from_outside([2.0, 5.0, 0.0], [0.0, -1.0, 0.0], 4.0),
            from_outside([-3.0, 2.0, 0.0], [1.0, -1.0, 0.0], 1.0),
            from_inside([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0),
            from_inside([0.0, 0.0, 0.0], [0.0, 0.0, 4.0], 0.5),
            from_inside([2.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0),
        ],
    );
    check::<3>(
        &Cylinder::new(0.0, 2.0),
        &[
            from_outside([1.0, 1.0, 0.0], [0.0, -1.0, 0.0], 1.0),
            from_outside([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0], 3.0),
        ],
    );
}

#[test]
fn cones() {
    check::<3>(
        &Cone::new(1.0, 1.0),
        &[
            from_outside([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0], 4.5),
            from_outside([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 4.5),
            from_outside([0.0, 5.0, 0.0], [0.0, -1.0, 0.0], 4.0),
            from_outside([0.0, -5.0, 0.0], [0.0, 1.0, 0.0], 4.0),
            from_outside([0.5, 5.0, 0.0], [0.0, -1.0, 0.0], 5.0),
            from_outside([-5.0, -1.0, 0.0], [1.0, 0.0, 0.0], 4.0),
            from_outside([-5.0, 1.0, 0.0], [1.0, 0.0, 0.0], 5.0),
            miss([-5.0, 1.0001, 0.0], [1.0, 0.0, 0.0]),
            miss([-5.0, 2.0, 0.0], [1.0, 0.0, 0.0]),
            miss([0.0, 5.0, 0.0], [0.0, 1.0, 0.0]),
            from_inside([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0),
            from_inside([0.0, 0.0, 0.0], [0.0, -1.0, 0.0], 1.0),
            from_inside([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5),
            from_outside([-0.5, 2.0, 0.0], [0.5, -1.0, 0.0], 1.0),
        ],
    );
    // Along the side.
    check::<3>(&Cone::new(0.5, 1.0), &[from_inside([0.5, 0.0, 0.0], [-1.0, 1.0, 0.0], 0.0)]);
    check::<3>(&Cone::new(0.0, 2.0), &[from_outside([1.0, 1.0, 0.0], [0.0, -1.0, 0.0], 1.0)]);
    check::<3>(&Cone::new(2.0, 0.0), &[from_outside([1.0, 1.0, 0.0], [-1.0, 0.0, 0.0], 1.0)]);
}

#[test]
fn normals_are_in_the_world_and_point_out() {
    let quarter = Isometry2::new(V2::new(10.0, 0.0), std::f64::consts::FRAC_PI_2);
    let cuboid = Cuboid::new(V2::new(1.0, 2.0));
    let ray = Ray::new(P2::new(0.0, 0.0), V2::new(1.0, 0.0));
    let hit = cuboid.toi_and_normal_with_ray(&quarter, &ray, true).expect("it is ahead");
    assert!((hit.toi - 8.0).abs() < 1e-14, "{hit:?}");
    assert!((hit.normal + V2::x()).norm() < 1e-15, "{hit:?}");
    assert_eq!(hit.feature, FeatureId::Face(2), "the side that was up");
    let inside = Ray::new(P2::new(10.0, 0.0), V2::new(1.0, 0.0));
    let hit = cuboid.toi_and_normal_with_ray(&quarter, &inside, false).expect("it leaves");
    assert!((hit.normal - V2::x()).norm() < 1e-15, "out of the solid: {hit:?}");
    let solid = cuboid.toi_and_normal_with_ray(&quarter, &inside, true).expect("it is inside");
    assert_eq!((solid.toi, solid.normal), (0.0, V2::zeros()), "no surface is met");
}

#[test]
fn flat_sets_face_the_ray() {
    let [a, b, c] = [P3::new(0.0, 0.0, 0.0), P3::new(4.0, 0.0, 0.0), P3::new(0.0, 4.0, 0.0)];
    let triangle = Triangle::new(a, b, c);
    for (height, face) in [(1.0, 0), (-1.0, 1)] {
        let ray = Ray::new(P3::new(1.0, 1.0, height), V3::new(0.0, 0.0, -height));
        let hit = triangle.cast_local_ray(&ray, true).expect("it is ahead");
        assert_eq!(hit.normal, V3::new(0.0, 0.0, height), "from {height}");
        assert_eq!(hit.feature, FeatureId::Face(face), "from {height}");
    }
}

fn all_of_space() -> Vec<ShapeHandle<f64, 3>> {
    let [a, b, c] = [P3::new(-1.0, 0.0, 0.0), P3::new(1.0, 0.0, 0.0), P3::new(0.0, 1.0, 0.0)];
    vec![
        ShapeHandle::new(Ball::new(1.0)),
        ShapeHandle::new(Segment::new(a, b)),
        ShapeHandle::new(Capsule::new(1.0, 1.0)),
        ShapeHandle::new(Triangle::new(a, b, c)),
        ShapeHandle::new(Cuboid::new(V3::new(1.0, 1.0, 1.0))),
        ShapeHandle::new(Cylinder::new(1.0, 1.0)),
        ShapeHandle::new(Cone::new(1.0, 1.0)),
        ShapeHandle::new(Plane::new(Unit::new_unchecked(V3::y()))),
    ]
}

#[test]
fn a_ray_without_direction_is_a_point() {
    for shape in all_of_space() {
        let m = Isometry3::translation(3.0, 2.0, 1.0);
        let inside = Ray::new(P3::new(3.0, 2.0, 1.0), V3::zeros());
        assert_eq!(shape.toi_with_ray(&m, &inside, true), Some(0.0), "{shape:?}");
        let outside = Ray::new(P3::new(3.0, 9.0, 1.0), V3::zeros());
        assert_eq!(shape.toi_with_ray(&m, &outside, true), None, "{shape:?}");
        assert_eq!(shape.toi_with_ray(&m, &outside, false), None, "{shape:?}");
    }
    let middle = Ray::new(P3::origin(), V3::zeros());
    assert_eq!(Ball::new(1.0).cast_local_ray(&middle, false), None, "not on the boundary");
    let pole = Ray::new(P3::new(0.0, 1.0, 0.0), V3::zeros());
    assert!(Ball::new(1.0).cast_local_ray(&pole, false).is_some(), "on the boundary");
}

#[test]
fn rays_that_are_not_finite_hit_nothing() {
    for shape in all_of_space() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let ray = Ray::new(P3::origin(), V3::new(bad, 0.0, 1.0));
            assert_eq!(shape.cast_local_ray(&ray, true), None, "{shape:?} along {bad}");
            let ray = Ray::new(P3::new(0.0, bad, 0.0), V3::x());
            assert_eq!(shape.cast_local_ray(&ray, true), None, "{shape:?} from {bad}");
        }
        let far = Ray::new(P3::new(1e300, 1e300, 0.0), V3::new(-1e-300, -1e-300, 0.0));
        let found = shape.cast_local_ray(&far, false);
        assert!(found.is_none_or(|hit| hit.toi.is_finite()), "{shape:?}: {found:?}");
    }
}

/// Asserts that a ray that starts on a rotated segment hits it at once, although rounding may place
/// the crossing before the start of the ray.
#[test]
fn a_ray_that_starts_on_a_turned_segment_hits_it() {
    let capsule = Capsule::<f32, 2>::new(1.0, 0.0);
    let turn = UnitComplex::new_unchecked(Complex::new(0.0, -1.0));
    let pose = Isometry2::from_parts(Translation2::new(-1.875, -0.5), turn);
    let start = Point::<f32, 2>::new(-2.25, -0.5);
    assert!(capsule.contains_point(&pose, &start), "it starts on the segment");
    let ray = Ray::new(start, Vector::<f32, 2>::new(0.25, 0.5));
    assert_eq!(capsule.toi_with_ray(&pose, &ray, true), Some(0.0), "so it hits at once");
}
