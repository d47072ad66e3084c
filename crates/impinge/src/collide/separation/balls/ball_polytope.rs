//! Ball against convex hull in 3D.

use crate::collide::Pair;
use crate::collide::separation::balls::ball_segment;
use crate::collide::separation::projection::{Projection, center_in_second, rounding_error};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, cross};
use crate::shape::{Kind, Polytope, PolytopeFace, SupportMap};

/// Returns the separation of a ball from a convex hull; `None` above `limit`.
///
/// If the centre is inside the hull, the ball is pushed out through the face whose plane is
/// nearest; the distance to that plane is the exact depth of the centre. If it is outside, the
/// nearest point lies on one of the faces that have the centre in front of them. The centre is
/// projected onto the face above whose plane it is highest and, unless that proves the nearest
/// point, onto each of these faces. Cost: linear in the number of faces.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let (Kind::Ball(ball), Kind::Polytope(hull)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(hull, &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// Projects a point onto a convex hull.
pub(in crate::collide::separation) fn project<N: Real>(
    hull: &Polytope<N, 3>,
    center: &Point<N, 3>,
) -> Projection<N, 3> {
    let (index, distance) = hull.highest_face(center);
    let highest = &hull.faces()[index as usize];
    let outward = highest.normal;
    let flat = Projection { distance, outward, point: center - outward * distance };
    // A NaN distance takes the branch for points inside.
    if distance > N::ZERO { project_from_outside(hull, center, highest, &flat) } else { flat }
}

/// Projects a point that is outside the hull. `highest` is the face with the largest height of the
/// point, `flat` the projection onto its plane.
///
/// In most cases the nearest point lies on that face, and the supporting plane there proves it.
fn project_from_outside<N: Real>(
    hull: &Polytope<N, 3>,
    center: &Point<N, 3>,
    highest: &PolytopeFace<N, 3>,
    flat: &Projection<N, 3>,
) -> Projection<N, 3> {
    let rounding_error = rounding_error(hull.reach() + center.coords.norm());
    let certain = |projected: &Projection<N, 3>| {
        projected.outward.dot(&(center - hull.core_support(&projected.outward)))
    };
    let projected = project_on_face(hull, highest, center);
    let is_over_face = projected.outward == highest.normal;
    if is_over_face || certain(&projected) + rounding_error / N::lit(4.0) >= projected.distance {
        return projected;
    }
    let mut best: Option<Projection<N, 3>> = None;
    for face in hull.faces().iter().filter(|face| face.height_of(center) > N::ZERO) {
        let projected = project_on_face(hull, face, center);
        if best.is_none_or(|best| projected.distance < best.distance) {
            best = Some(projected);
        }
    }
    let mut best = best.unwrap_or(*flat);
    // Close to an edge or corner the offset is mostly rounding error. The normal of the highest
    // face replaces it if the height along this normal is larger by more than rounding.
    if certain(&best) + rounding_error < flat.distance {
        best.outward = flat.outward;
    }
    best
}

/// Projects a point that is in front of a face onto this face.
fn project_on_face<N: Real>(
    hull: &Polytope<N, 3>,
    face: &PolytopeFace<N, 3>,
    center: &Point<N, 3>,
) -> Projection<N, 3> {
    let around = hull.face_vertices(face);
    let corner = |vertex: u32| hull.vertices()[vertex as usize];
    let mut best: Option<Projection<N, 3>> = None;
    for (&from, &to) in around.iter().zip(around.iter().cycle().skip(1)) {
        let ends = [corner(from), corner(to)];
        let beyond = cross(&(ends[1] - ends[0]), &face.normal).dot(&(center - ends[0]));
        if beyond > N::ZERO {
            let projected = ball_segment::project(&ends, center);
            if best.is_none_or(|best| projected.distance < best.distance) {
                best = Some(projected);
            }
        }
    }
    best.unwrap_or_else(|| {
        let distance = face.height_of(center);
        let point = center - face.normal * distance;
        Projection { distance, outward: face.normal, point }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ConvexHull;

    #[test]
    fn over_a_face_an_edge_a_vertex_and_inside() {
        let p = Point::<f64, 3>::new;
        let corners = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(0.0, 4.0, 0.0), p(0.0, 0.0, 4.0)];
        let hull = ConvexHull::from_points(&corners);
        let below = project(&hull, &p(1.0, 1.0, -2.0));
        assert_eq!((below.distance, below.outward.z), (2.0, -1.0), "below the base");
        let edge = project(&hull, &p(2.0, -3.0, -4.0));
        assert_eq!((edge.distance, edge.point), (5.0, p(2.0, 0.0, 0.0)), "beside an edge");
        let vertex = project(&hull, &p(-2.0, -1.0, -2.0));
        assert_eq!((vertex.distance, vertex.point), (3.0, p(0.0, 0.0, 0.0)), "beyond a vertex");
        let inside = project(&hull, &p(0.5, 0.75, 1.0));
        assert_eq!((inside.distance, inside.outward.x), (-0.5, -1.0), "out through x = 0");
        assert_eq!(inside.point, p(0.0, 0.75, 1.0), "on that face");
    }
}
