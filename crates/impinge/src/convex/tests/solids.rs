//! Convex solids for the tests, made from entries of the test data, and reference computations.

use serde_json::Value;

use super::super::{Simplicial, separation};
use crate::math::{Point, Pose, Real, Vector, unit};
use crate::shape::{Ball, Capsule, Cone, Cuboid, Cylinder, Segment, SupportMap, Triangle};

pub(super) type Solid<N, const D: usize> = Box<dyn SupportMap<N, D>>;

/// The hull of some points, with a radius.
pub(super) struct Points<N: Real, const D: usize> {
    pub(super) points: Vec<Point<N, D>>,
    pub(super) rounding: N,
}

impl<N: Real, const D: usize> SupportMap<N, D> for Points<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let mut best = self.points[0];
        for point in &self.points[1..] {
            if (point - best).dot(direction) > N::ZERO {
                best = *point;
            }
        }
        best
    }

    fn rounding(&self) -> N {
        self.rounding
    }

    fn center(&self) -> Point<N, D> {
        crate::math::centroid(&self.points)
    }
}

/// A box with a radius.
struct RoundCuboid<N: Real, const D: usize> {
    cuboid: Cuboid<N, D>,
    rounding: N,
}

impl<N: Real, const D: usize> SupportMap<N, D> for RoundCuboid<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        self.cuboid.core_support(direction)
    }

    fn rounding(&self) -> N {
        self.rounding
    }
}

/// A solid of revolution whose axis is the coordinate axis `axis` instead of y: the coordinates y
/// and `axis` of `solid` are exchanged.
struct Along<N: Real> {
    axis: usize,
    solid: Solid<N, 3>,
}

impl<N: Real> SupportMap<N, 3> for Along<N> {
    fn core_support(&self, direction: &Vector<N, 3>) -> Point<N, 3> {
        let mut direction = *direction;
        direction.swap_rows(1, self.axis);
        let mut point = self.solid.core_support(&direction);
        point.coords.swap_rows(1, self.axis);
        point
    }
}

/// Scalars that convert entries of the test data: to solids that exist only in dimension `D`, and
/// to poses in this dimension.
pub(super) trait Own<const D: usize>: Real {
    fn own(shape: &Value) -> Option<Solid<Self, D>>;
    fn pose(pose: &Value) -> Pose<Self, D>;
}

impl<N: Real> Own<2> for N {
    fn own(_: &Value) -> Option<Solid<N, 2>> {
        None
    }

    fn pose(pose: &Value) -> Pose<N, 2> {
        let (cos, sin) = match pose.get("angle") {
            Some(angle) => {
                let angle = angle.as_f64().expect("a number");
                (angle.cos(), angle.sin())
            }
            None => (number(&pose["cos"]), number(&pose["sin"])),
        };
        let length = cos.hypot(sin);
        let [cos, sin] = [cos / length, sin / length].map(N::lit);
        let mut placed = Pose::<N, 2>::from_translation(vector(translation(pose)));
        placed.rotation.set_column(0, &Vector::<N, 2>::new(cos, sin));
        placed.rotation.set_column(1, &Vector::<N, 2>::new(-sin, cos));
        placed
    }
}

impl<N: Real> Own<3> for N {
    fn own(shape: &Value) -> Option<Solid<N, 3>> {
        let height = || scalar::<N>(&shape["half_height"]);
        let radius = || scalar::<N>(first(shape, ["r", "radius"]));
        let solid: Solid<N, 3> = match shape["type"].as_str()? {
            "cylinder_y" | "cylinder" => Box::new(Cylinder::new(height(), radius())),
            "cone_y" | "cone" => Box::new(Cone::new(height(), radius())),
            _ => return None,
        };
        match shape.get("axis").and_then(Value::as_str) {
            Some("x") => Some(Box::new(Along { axis: 0, solid })),
            Some("z") => Some(Box::new(Along { axis: 2, solid })),
            _ => Some(solid),
        }
    }

    fn pose(pose: &Value) -> Pose<N, 3> {
        let q: Vec<f64> = first(pose, ["rotation_xyzw", "q"])
            .as_array()
            .expect("a quaternion")
            .iter()
            .map(number)
            .collect();
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (axis, w) = (Vector::<f64, 3>::new(q[0], q[1], q[2]) / length, q[3] / length);
        let mut placed = Pose::<N, 3>::from_translation(vector(translation(pose)));
        for column in 0..3 {
            let mut e = Vector::<f64, 3>::zeros();
            e[column] = 1.0;
            let twice = axis.cross(&e) * 2.0;
            let rotated: Vector<f64, 3> = e + twice * w + axis.cross(&twice);
            placed.rotation.set_column(column, &rotated.map(|x| N::lit(x)));
        }
        placed
    }
}

fn first<'a>(value: &'a Value, names: [&str; 2]) -> &'a Value {
    value.get(names[0]).unwrap_or(&value[names[1]])
}

fn translation(pose: &Value) -> &Value {
    first(pose, ["translation", "t"])
}

pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn scalar<N: Real>(value: &Value) -> N {
    N::lit(number(value))
}

pub(super) fn vector<N: Real, const D: usize>(value: &Value) -> Vector<N, D> {
    let values = value.as_array().expect("an array");
    Vector::<N, D>::from_fn(|row, _| scalar(&values[row]))
}

fn point<N: Real, const D: usize>(value: &Value) -> Point<N, D> {
    Point::from(vector(value))
}

/// Returns the solid of an entry of the test data; `None` for half-spaces, ellipsoids and other
/// types without a constructor here.
pub(super) fn solid<N: Own<D>, const D: usize>(shape: &Value) -> Option<Solid<N, D>> {
    if let Some(own) = N::own(shape) {
        return Some(own);
    }
    let radius = || scalar::<N>(first(shape, ["r", "radius"]));
    let corner = |name: &str| point::<N, D>(&shape[name]);
    Some(match shape["type"].as_str()? {
        "ball" => Box::new(Ball::new(radius())),
        "segment" => Box::new(Segment::new(corner("a"), corner("b"))),
        "triangle" => Box::new(Triangle::new(corner("a"), corner("b"), corner("c"))),
        "capsule_y" => Box::new(Capsule::new(scalar(&shape["half_height"]), radius())),
        "capsule" => Box::new(
            Capsule::try_from_ends(corner("a"), corner("b"), radius()).expect("a valid capsule"),
        ),
        "cuboid" => Box::new(Cuboid::new(vector(&shape["half_extents"]))),
        "round_cuboid" => Box::new(RoundCuboid {
            cuboid: Cuboid::new(vector(&shape["half_extents"])),
            rounding: radius(),
        }),
        "convex_polygon" | "convex_hull" | "convex" => {
            let points = shape["points"].as_array().expect("points").iter().map(point).collect();
            Box::new(Points { points, rounding: N::ZERO })
        }
        _ => return None,
    })
}

/// Returns the distance by which planes perpendicular to `normal` separate two solids, negative if
/// none does: `min n·b − max n·a`.
pub(super) fn height<N: Real, const D: usize>(
    solids: [&dyn SupportMap<N, D>; 2],
    pose12: &Pose<N, D>,
    normal: &Vector<N, D>,
) -> N {
    let (n, _) = unit(normal).expect("a direction");
    let top1 = solids[0].core_support(&n).coords.dot(&n) + solids[0].rounding();
    let lowest2 = pose12.point(&solids[1].core_support(&-pose12.inverse_vector(&n)));
    lowest2.coords.dot(&n) - solids[1].rounding() - top1
}

/// Returns the signed distance of a point from a solid; NaN if [`separation`] returns `None`.
pub(super) fn outside<const D: usize>(solid: &dyn SupportMap<f64, D>, point: &Point<f64, D>) -> f64
where
    f64: Simplicial<D>,
{
    let pose = Pose::from_translation(point.coords);
    let ball = Points { points: vec![Point::origin()], rounding: 0.0 };
    separation(solid, &ball, &pose, f64::INFINITY).map_or(f64::NAN, |found| found.distance)
}
