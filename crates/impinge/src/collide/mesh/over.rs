//! The feature of a triangle that a ball touches, if it does not depend on rounding errors.
//!
//! In general the feature of a contact follows from the supporting features of a manifold. For a
//! ball near a triangle that is not thin, the Voronoi region that contains the ball's centre
//! decides: that of the face, of a side or of a corner. The feature counts as certain only if the
//! centre's distance from the region's border is larger than a multiple of the rounding error.

use crate::math::{Mapped, Point, Real, Vector, cross, max};
use crate::shape::{FeatureId, Triangle};

/// Distance from the border of a Voronoi region, in units of the rounding tolerance, beyond which
/// the region is certain.
const CERTAIN: f64 = 64.0;
/// Smallest ratio of a triangle's height to its longest side; thinner triangles have no certain
/// feature.
const MIN_HEIGHT: f64 = 1.0 / 32.0;

/// Returns `None`: triangles in 2D are filled and have no such regions.
pub(crate) fn over2<N: Real>(_: &Triangle<N, 2>, _: &Point<N, 2>, _: N) -> Option<FeatureId> {
    None
}

/// Returns the feature of a triangle in 3D nearest to the centre of a ball, with the id that
/// supporting features have: for the face, 0 if the centre is in front, 1 if it is behind. `None`
/// if the triangle is thin or a coordinate is NaN. Also `None` if the centre is close to a border:
/// within `CERTAIN · tolerance` perpendicular to a side (or, above the face, to the plane), or
/// within `CERTAIN² · tolerance` along a side.
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
    let (area, margin) = (normal.norm(), N::lit(CERTAIN) * tolerance);
    // Both comparisons are false for NaN.
    let is_nondegenerate = area > N::lit(MIN_HEIGHT) * longest * longest && longest > margin;
    if !is_nondegenerate {
        return None;
    }
    let front = normal / area;
    let insides =
        [0, 1, 2].mapped(|at: usize| cross(&sides[at], &arms[at]).dot(&front) / lengths[at]);
    if insides.iter().all(|&inside| inside > margin) {
        let height = front.dot(&arms[0]);
        return (height.abs() > margin).then_some(FeatureId::Face(u32::from(height < N::ZERO)));
    }
    if !insides.iter().any(|&inside| inside < -margin) {
        return None;
    }
    beside(&Border { sides, arms, lengths, insides, margin })
}

/// A triangle and the position of a point relative to its sides and corners.
struct Border<N: Real> {
    sides: [Vector<N, 3>; 3],
    /// Vectors from the corners to the point.
    arms: [Vector<N, 3>; 3],
    lengths: [N; 3],
    /// Signed distances of the point from the lines of the sides, within the triangle's plane;
    /// positive inside.
    insides: [N; 3],
    margin: N,
}

/// Returns the side or corner whose Voronoi region contains the point; `None` close to the border
/// of a region.
fn beside<N: Real>(border: &Border<N>) -> Option<FeatureId> {
    let Border { sides, arms, lengths, insides, margin } = border;
    // Where two sides meet at a small angle, the point nearest to the centre may be on the adjacent
    // side. So the margin along the sides is larger.
    let aside = N::lit(CERTAIN) * *margin;
    for at in 0..3 {
        let along = sides[at].dot(&arms[at]) / lengths[at];
        let number = u32::try_from(at).expect("there are three sides");
        if insides[at] < -*margin && along > aside && along < lengths[at] - aside {
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
