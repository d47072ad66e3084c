//! Shapes of all kinds that fly above a plane.

use super::MARGIN;
use super::pile::{axis, edge};
use crate::random::Random;
use crate::{Motion, Scene, SceneObject, SceneQuery, SceneShape, Wave, rounded};

/// A plane and `count` shapes of about size 1, equally many of each kind: balls, boxes, capsules,
/// segments, triangles and convex solids, in 3D also cylinders and cones. All but the plane move
/// and rotate. Every seventh has a proximity query, the others query contacts.
#[must_use]
pub fn mixed_shapes<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(5);
    let edge = edge::<D>(count, (0..D).fold(1.0 / 3.0, |space, _| space * 2.2));
    let mut normal = [0.0; D];
    normal[1] = 1.0;
    let plane = SceneShape::Plane { normal };
    let mut objects = vec![SceneObject::new(plane, query(0), Motion::rest([0.0; D]))];
    for n in 0..count {
        let shape = shape_of_kind(n % (2 + 2 * D), random);
        objects.push(SceneObject::new(shape, query(n), flight(edge, random)));
    }
    Scene { name: "mixed shapes", margin: MARGIN, objects, steps: 100 }
}

/// Returns the query type of object `n`. There are six kinds in 2D and eight in 3D, and neither has
/// a common factor with 7: so each kind occurs with both query types.
const fn query(n: usize) -> SceneQuery {
    if n % 7 == 3 {
        SceneQuery::Proximity { margin: 0.05 }
    } else {
        SceneQuery::Contacts { linear: 0.01, angular: 0.01 }
    }
}

pub(super) fn flight<const D: usize>(edge: f64, random: &mut Random) -> Motion<D> {
    let speed = random.between(0.01, 0.06);
    let velocity = random.direction::<D>().map(|x| x * speed);
    let place = velocity.map(|v| Wave::new((0.0, edge), random.between(0.0, edge), v));
    let tangent = Wave::new((-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.002, 0.02));
    Motion { axis: axis::<D>(random), tangent, ..Motion::translation(place) }
}

/// Returns a shape of a kind: 0 to 5 exist in both dimensions, 6 and 7 in 3D only.
fn shape_of_kind<const D: usize>(kind: usize, random: &mut Random) -> SceneShape<D> {
    let radius = rounded(random.between(0.3, 0.5));
    let half_height = rounded(random.between(0.2, 0.5));
    match kind {
        0 => SceneShape::Ball { radius },
        1 => SceneShape::Cuboid {
            half_extents: [0.0; D].map(|_: f64| rounded(random.between(0.3, 0.6))),
        },
        2 => SceneShape::Capsule { half_height, radius: rounded(radius * 0.6) },
        3 => SceneShape::Segment { ends: [0, 1].map(|_| corner(0.7, random)) },
        4 => SceneShape::Triangle { corners: [0, 1, 2].map(|_| corner(0.7, random)) },
        5 => SceneShape::Convex { points: convex(radius, random) },
        6 => SceneShape::Cylinder { half_height, radius },
        _ => SceneShape::Cone { half_height, radius },
    }
}

/// Returns a random point at the given distance from the origin.
fn corner<const D: usize>(distance: f64, random: &mut Random) -> [f64; D] {
    random.direction::<D>().map(|x| rounded(x * distance))
}

/// Returns the points at the distance `radius` on the axes, which span all dimensions, and up to
/// eight random points at 1.2 times this distance from the origin.
fn convex<const D: usize>(radius: f64, random: &mut Random) -> Vec<[f64; D]> {
    let tips = (0..2 * D).map(|n| {
        let mut tip = [0.0; D];
        tip[n / 2] = if n.is_multiple_of(2) { radius } else { -radius };
        tip
    });
    let mut points: Vec<_> = tips.collect();
    points.extend((0..random.below(9)).map(|_| corner(1.2 * radius, random)));
    points
}
