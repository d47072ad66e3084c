//! Ball against convex hull in space.

use super::projection::{Projection, center_in_second, noise};
use super::segments::nearest_on_segment;
use super::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, cross, unit};
use crate::query::Pair;
use crate::shape::{Kind, Polytope, PolytopeFace, SupportMap};

/// The separation of a ball from a convex hull.
///
/// Inside, the nearest face is the way out, and its plane's distance the exact depth. Outside, the
/// nearest point lies on one of the faces that see the centre in front of them: each is projected
/// on. Cost: linear in the number of faces.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Ball(ball), Kind::Polytope(hull)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(hull, &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// The distance of a point from the plane of a face: positive in front of it.
fn height<N: Real>(face: &PolytopeFace<N, 3>, point: &Point<N, 3>) -> N {
    face.normal.dot(&point.coords) - face.offset
}

/// A point seen from a convex hull.
fn project<N: Real>(hull: &Polytope<N, 3>, center: &Point<N, 3>) -> Projection<N, 3> {
    let mut highest = &hull.faces()[0];
    for face in &hull.faces()[1..] {
        if height(face, center) > height(highest, center) {
            highest = face;
        }
    }
    let (distance, outward) = (height(highest, center), highest.normal);
    let flat = Projection { distance, outward, point: center - outward * distance };
    // Written so that NaN ends here too.
    if distance > N::ZERO { project_from_outside(hull, center, &flat) } else { flat }
}

/// A point outside; `flat` is how the face that it is highest above sees it.
fn project_from_outside<N: Real>(
    hull: &Polytope<N, 3>,
    center: &Point<N, 3>,
    flat: &Projection<N, 3>,
) -> Projection<N, 3> {
    let mut best = (N::INFINITY, flat.point);
    for face in hull.faces().iter().filter(|face| height(face, center) > N::ZERO) {
        let point = nearest_on_face(hull, face, center);
        let squared = (center - point).norm_squared();
        if squared < best.0 {
            best = (squared, point);
        }
    }
    let Some((outward, distance)) = unit(&(center - best.1)) else { return *flat };
    // The offset is mostly rounding where the point is close: a face may know better.
    let certain = outward.dot(&(center - hull.core_support(&outward)));
    let reach = hull.reach() + center.coords.norm();
    let outward = if certain + noise(reach) < flat.distance { flat.outward } else { outward };
    Projection { distance, outward, point: best.1 }
}

/// The point of a face nearest to a point in front of it.
fn nearest_on_face<N: Real>(
    hull: &Polytope<N, 3>,
    face: &PolytopeFace<N, 3>,
    center: &Point<N, 3>,
) -> Point<N, 3> {
    let around = hull.face_vertices(face);
    let corner = |at: usize| hull.vertices()[around[at % around.len()] as usize];
    let mut best: Option<(N, Point<N, 3>)> = None;
    for side in 0..around.len() {
        let ends = [corner(side), corner(side + 1)];
        let beyond = cross(&(ends[1] - ends[0]), &face.normal).dot(&(center - ends[0]));
        if beyond > N::ZERO {
            let point = nearest_on_segment(&ends, center).0;
            let squared = (center - point).norm_squared();
            if best.is_none_or(|(least, _)| squared < least) {
                best = Some((squared, point));
            }
        }
    }
    best.map_or_else(|| center - face.normal * height(face, center), |(_, point)| point)
}
