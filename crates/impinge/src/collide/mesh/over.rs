//! The feature of a triangle that a ball touches, if rounding cannot change it.
//!
//! In general the feature of a contact follows from the supporting features of a manifold. For a
//! ball over a triangle that is not thin the region of its centre decides: over the inside, beside
//! one side or beside one corner, by far more than rounding error.

use crate::math::{Mapped, Point, Real, Vector, cross, max};
use crate::shape::{FeatureId, Triangle};

/// Distance from the border of a region, in tolerances, from which the region is certain.
const CERTAIN: f64 = 64.0;
/// The least ratio of a triangle's height to its longest side.
const MIN_HEIGHT: f64 = 1.0 / 32.0;

/// In 2D triangles are filled and have no such regions.
pub(crate) fn over2<N: Real>(_: &Triangle<N, 2>, _: &Point<N, 2>, _: N) -> Option<FeatureId> {
    None
}

/// Returns the feature of a triangle in 3D nearest to the centre of a ball, as supporting features
/// would name it; of the two faces, the one on the side of the ball. `None` if it is not certain.
pub(crate) fn over3<N: Real>(
    triangle: &Triangle<N, 3>,
    center: &Point<N, 3>,
    tolerance: N,
) -> Option<FeatureId> {
    let corners = triangle.corners();
    let sides = [0, 1, 2].mapped(|at: usize| corners[(at + 1) % 3] - corners[at]);
    let arms = corners.each_ref().mapped(|corner| center - corner);
    let lengths = sides.mapped(|side| side.norm());
    let longest = max(lengths[0], max(lengths[1], lengths[2]));
    let normal = cross(&sides[0], &sides[1]);
    let (area, room) = (normal.norm(), N::lit(CERTAIN) * tolerance);
    // False for NaN.
    let is_plain = area > N::lit(MIN_HEIGHT) * longest * longest && longest > room;
    if !is_plain {
        return None;
    }
    let front = normal / area;
    let insides =
        [0, 1, 2].mapped(|at: usize| cross(&sides[at], &arms[at]).dot(&front) / lengths[at]);
    if insides.iter().all(|&inside| inside > room) {
        let height = front.dot(&arms[0]);
        return (height.abs() > room).then_some(FeatureId::Face(u32::from(height < N::ZERO)));
    }
    if !insides.iter().any(|&inside| inside < -room) {
        return None;
    }
    beside(&Border { sides, arms, lengths, insides, room })
}

/// A triangle and the position of a point relative to its border.
struct Border<N: Real> {
    sides: [Vector<N, 3>; 3],
    /// From the corners to the point.
    arms: [Vector<N, 3>; 3],
    lengths: [N; 3],
    /// The distance of the point from each side, positive inside.
    insides: [N; 3],
    room: N,
}

/// Returns the side that the point is beyond, between its ends, or the corner that it is beyond
/// along both sides.
fn beside<N: Real>(border: &Border<N>) -> Option<FeatureId> {
    let Border { sides, arms, lengths, insides, room } = border;
    // Where two sides meet at a small angle, the nearest point may be on the other side.
    let aside = N::lit(CERTAIN) * *room;
    for at in 0..3 {
        let along = sides[at].dot(&arms[at]) / lengths[at];
        let number = u32::try_from(at).expect("there are three sides");
        if insides[at] < -*room && along > aside && along < lengths[at] - aside {
            return Some(FeatureId::Edge(number));
        }
        let before = (at + 2) % 3;
        let back = sides[before].dot(&arms[at]) / lengths[before];
        if along < -aside && back > aside {
            return Some(FeatureId::Vertex(number));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_of_a_triangle() {
        let corner = Point::<f64, 3>::new;
        let triangle =
            Triangle::new(corner(0.0, 0.0, 0.0), corner(4.0, 0.0, 0.0), corner(0.0, 4.0, 0.0));
        let over = |x, y, z| over3(&triangle, &corner(x, y, z), 1e-9);
        assert_eq!(over(1.0, 1.0, 2.0), Some(FeatureId::Face(0)), "in front");
        assert_eq!(over(1.0, 1.0, -2.0), Some(FeatureId::Face(1)), "behind");
        assert_eq!(over(2.0, -1.0, 2.0), Some(FeatureId::Edge(0)), "beside the first side");
        assert_eq!(over(3.0, 3.0, 2.0), Some(FeatureId::Edge(1)), "beside the second");
        assert_eq!(over(-1.0, 2.0, 0.0), Some(FeatureId::Edge(2)), "beside the third");
        assert_eq!(over(-1.0, -1.0, 1.0), Some(FeatureId::Vertex(0)), "beyond a corner");
        assert_eq!(over(6.0, -1.0, 1.0), Some(FeatureId::Vertex(1)), "beyond the next");
        assert_eq!(over(-1.0, 7.0, 1.0), Some(FeatureId::Vertex(2)), "beyond the last");
        for (x, y, z) in [(2.0, 0.0, 1.0), (0.0, -1.0, 1.0), (1.0, 1.0, 0.0), (f64::NAN, 0.0, 0.0)]
        {
            assert_eq!(over(x, y, z), None, "on a border: {x} {y} {z}");
        }
        let thin =
            Triangle::new(corner(0.0, 0.0, 0.0), corner(4.0, 0.0, 0.0), corner(2.0, 0.1, 0.0));
        assert_eq!(over3(&thin, &corner(2.0, 0.05, 1.0), 1e-9), None, "a thin one");
    }
}
