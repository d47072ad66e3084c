//! Two triangles in 3D that overlap or nearly touch: the separating axis test.
//!
//! The Minkowski difference of two triangles has the faces of both, and a parallelogram for each
//! pair of sides whose arcs cross on the Gauss map. If the triangles overlap, the shortest
//! separating translation is along the normal of the face nearest to the origin (Gregorius, "The
//! Separating Axis Test between Convex Polyhedra", GDC 2013). The Gauss map of a triangle has two
//! poles, its normals, and a half circle for each side:
//!
//! ```text
//!              +n1                 side i of the first and side j of the second make a face iff
//!            /  |  \               the arc of j separates the poles of the first, and the arc of i
//!   side 0  | side 1 | side 2      those of the second, on the same side:
//!            \  |  /                  (sides2[j] · n1 < 0)  ≠  (sides1[i] · n2 > 0)
//!              -n1
//! ```
//!
//! A result is accepted if its two points lie on the features that the axis belongs to. All other
//! cases fall back to [`hulls`]: thin triangles, nearly parallel sides, and separated triangles
//! with nearest points at corners.

use crate::collide::Pair;
use crate::collide::separation::hulls::{self, SatResult, THIN};
use crate::convex::{Separation, Units};
use crate::math::{Mapped, Point, Pose, Real, Vector, cross, max, min};
use crate::shape::{Kind, SupportMap, Triangle};

/// Sine of the angle below which two sides count as parallel, in units of epsilon. Their face of
/// the Minkowski difference is then narrower than rounding errors.
const PARALLEL: f64 = 16.0;
/// Sine of the angle below which the common perpendicular of two sides is inexact, by up to 32
/// rounding units.
const MIN_SINE: f64 = 1.0 / 32.0;

/// Returns the separation of two triangles, `None` if its distance exceeds `limit`. If the
/// triangles overlap, the distance is minus the length of the shortest separating translation.
///
/// The normal of the first triangle is preferred to that of the second, and both to common
/// perpendiculars of two sides, unless another gap is larger by more than rounding error.
pub(crate) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let (Kind::Triangle(first), Kind::Triangle(second)) = (pair.first, pair.second) else {
        return hulls::separation(pair, limit);
    };
    by_axes([first, second], &pair.pose12, limit).separation(pair, limit, hulls::separation)
}

/// Tests the axes in the frame of the first triangle, in units of the pair. Returns `Unproved` if a
/// triangle is thin, if the points of the best axis are not on its features, or if a nearly
/// parallel pair of sides may have a larger gap.
fn by_axes<N: Real>(
    triangles: [&Triangle<N, 3>; 2],
    pose12: &Pose<N, 3>,
    limit: N,
) -> SatResult<N> {
    let [reach1, reach2] = triangles.mapped(SupportMap::reach);
    let units = Units::of(reach1, reach2, &pose12.translation);
    let translation = pose12.translation * units.shrink;
    let pose = Pose { rotation: pose12.rotation, translation };
    let placed = [
        PlacedTriangle::new(triangles[0], units.shrink),
        PlacedTriangle::new(triangles[1], units.shrink).map(|second| second.at(&pose)),
    ];
    let [Some(first), Some(second)] = placed else { return SatResult::Unproved };
    let [face1, face2] = [FaceAxis::new(&first, &second), FaceAxis::new(&second, &first)];
    let (edges, inexact) = EdgeAxis::best(&first, &second);
    let rounding_error = hulls::rounding_error::<N>();
    let is_second = face2.gap > face1.gap + rounding_error;
    let face = if is_second { &face2 } else { &face1 };
    if max(face.gap, edges.gap) > hulls::beyond_limit(&units, limit) {
        return SatResult::Beyond;
    }
    let of_edges =
        || edges.points(&first, &second).filter(|_| edges.gap > face.gap - rounding_error);
    let of_face = || {
        let (own, other) = if is_second { (&second, &first) } else { (&first, &second) };
        face.points(own, other).map(|[own, other]| face.found(is_second, own, other))
    };
    let is_edge = edges.gap > face.gap + rounding_error;
    let found = if is_edge { of_edges() } else { of_face().or_else(of_edges) };
    match found {
        // The comparison is false for NaN.
        Some(found) if inexact <= found.distance + rounding_error => {
            SatResult::Found(found.scaled(units.scale))
        }
        _ => SatResult::Unproved,
    }
}

/// A triangle in the frame of the first triangle, in units of the pair.
struct PlacedTriangle<N: Real> {
    corners: [Vector<N, 3>; 3],
    /// Vectors from each corner to the next.
    sides: [Vector<N, 3>; 3],
    /// The squared lengths of the sides.
    squared: [N; 3],
    /// Unit normal; seen from its tip, the corners run counter-clockwise.
    normal: Vector<N, 3>,
}

impl<N: Real> PlacedTriangle<N> {
    /// Scales a triangle in its own frame; `None` if it is thin, or its height is within the
    /// rounding error of the pair.
    fn new(triangle: &Triangle<N, 3>, shrink: N) -> Option<Self> {
        let corners = triangle.corners().mapped(|corner| corner.coords * shrink);
        let [a, b, c] = &corners;
        let sides = [b - a, c - b, a - c];
        let squared = [sides[0].norm_squared(), sides[1].norm_squared(), sides[2].norm_squared()];
        let longest = max(max(squared[0], squared[1]), squared[2]);
        let across = cross(&sides[0], &sides[1]);
        let area = across.norm();
        let least = N::TWO * hulls::rounding_error() * longest.sqrt();
        // `is_wide` is false for NaN.
        let is_wide = area > N::lit(THIN) * longest && area > least && area < N::INFINITY;
        is_wide.then(|| Self { corners, sides, squared, normal: across / area })
    }

    /// Transforms the triangle by a pose.
    fn at(self, pose: &Pose<N, 3>) -> Self {
        Self {
            corners: self.corners.mapped(|corner| pose.point(&Point::from(corner)).coords),
            sides: self.sides.mapped(|side| pose.vector(&side)),
            squared: self.squared,
            normal: pose.vector(&self.normal),
        }
    }

    /// Returns whether the projection of a point onto the triangle's plane lies in the triangle, up
    /// to rounding error.
    fn is_over(&self, point: &Vector<N, 3>) -> bool {
        let rounding_error = hulls::rounding_error::<N>();
        (0..3).all(|side: usize| {
            let inward = cross(&self.normal, &self.sides[side]);
            let inside = inward.dot(&(point - self.corners[side]));
            inside >= N::ZERO
                || inside * inside <= rounding_error * rounding_error * self.squared[side]
        })
    }
}

/// The normal of one triangle, negated if that gives a larger gap to the other triangle.
struct FaceAxis<N: Real> {
    /// Signed height of the other triangle above this one's plane; negative if it extends below.
    gap: N,
    /// Unit normal on the side of the other triangle.
    outward: Vector<N, 3>,
    /// Heights of the other triangle's corners above the plane.
    heights: [N; 3],
}

impl<N: Real> FaceAxis<N> {
    /// Chooses the direction with the larger gap, the front normal in a tie.
    fn new(own: &PlacedTriangle<N>, other: &PlacedTriangle<N>) -> Self {
        let up = other.corners.mapped(|corner| own.normal.dot(&(corner - own.corners[0])));
        let (low, high) = (min(min(up[0], up[1]), up[2]), max(max(up[0], up[1]), up[2]));
        if -high > low {
            Self { gap: -high, outward: -own.normal, heights: up.mapped(|height| -height) }
        } else {
            Self { gap: low, outward: own.normal, heights: up }
        }
    }

    /// Returns the first of the lowest corners of the other triangle that projects into this one,
    /// preceded by its projection. `None` if there is none.
    fn points(
        &self,
        own: &PlacedTriangle<N>,
        other: &PlacedTriangle<N>,
    ) -> Option<[Vector<N, 3>; 2]> {
        let most = self.gap + hulls::rounding_error();
        let mut corners = other.corners.iter().zip(self.heights);
        let (corner, _) = corners.find(|(at, height)| *height <= most && own.is_over(at))?;
        Some([corner - self.outward * self.gap, *corner])
    }

    /// Returns the separation at a point `own` of the triangle with this face and a point `other`
    /// of the other triangle. `is_second` says whether the face belongs to the second triangle.
    fn found(&self, is_second: bool, own: Vector<N, 3>, other: Vector<N, 3>) -> Separation<N, 3> {
        let (normal, points) =
            if is_second { (-self.outward, [other, own]) } else { (self.outward, [own, other]) };
        let [point1, point2] = points.mapped(Point::from);
        Separation { distance: self.gap, normal, point1, point2 }
    }
}

/// Common perpendicular of one side of each triangle.
struct EdgeAxis<N: Real> {
    gap: N,
    sides: [usize; 2],
    /// Vector from the first triangle to the second; its length is `length`.
    across: Vector<N, 3>,
    length: N,
}

impl<N: Real> EdgeAxis<N> {
    /// Returns the common perpendicular with the largest gap among the pairs of sides that form a
    /// face of the Minkowski difference, and an upper bound of the gaps along inexact
    /// perpendiculars.
    fn best(first: &PlacedTriangle<N>, second: &PlacedTriangle<N>) -> (Self, N) {
        let falls = second.sides.mapped(|side| side.dot(&first.normal) < N::ZERO);
        let rises = first.sides.mapped(|side| side.dot(&second.normal) > N::ZERO);
        let (least, exact) = (N::lit(PARALLEL) * N::EPSILON, N::lit(MIN_SINE));
        let none = Vector::<N, 3>::zeros();
        let mut best = Self { gap: -N::INFINITY, sides: [0; 2], across: none, length: N::ONE };
        let mut inexact = -N::INFINITY;
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            if falls[j] == rises[i] {
                continue;
            }
            let across = cross(&first.sides[i], &second.sides[j]);
            let across = if rises[i] { across } else { -across };
            let slack = across.dot(&(second.corners[j] - first.corners[i]));
            let (squared, both) = (across.norm_squared(), first.squared[i] * second.squared[j]);
            let length = squared.sqrt();
            if squared > exact * exact * both {
                if slack > best.gap * length {
                    best = Self { gap: slack / length, sides: [i, j], across, length };
                }
            } else if squared > least * least * both {
                let extra_slack = N::TWO * hulls::rounding_error() * both.sqrt();
                inexact = max((slack + extra_slack) / length, inexact);
            }
        }
        (best, inexact)
    }

    /// Returns the separation at the nearest points of the lines through both sides; `None` if one
    /// of the points is not on its side.
    fn points(
        &self,
        first: &PlacedTriangle<N>,
        second: &PlacedTriangle<N>,
    ) -> Option<Separation<N, 3>> {
        let [i, j] = self.sides;
        let (side1, side2) = (&first.sides[i], &second.sides[j]);
        let (start1, start2) = (&first.corners[i], &second.corners[j]);
        let (arm, along) = (start2 - start1, cross(side1, side2));
        let squared = self.length * self.length;
        let shares = [cross(&arm, side2), cross(&arm, side1)].mapped(|turn| turn.dot(&along));
        // `is_inside` is false for NaN.
        let is_inside = shares.iter().all(|share| *share >= N::ZERO && *share <= squared);
        is_inside.then(|| Separation {
            distance: self.gap,
            normal: self.across / self.length,
            point1: Point::from(start1 + side1 * (shares[0] / squared)),
            point2: Point::from(start2 + side2 * (shares[1] / squared)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::separation::general;
    use crate::math::xorshift::Xorshift;
    use crate::shape::Shape;

    /// Returns the distance by the general algorithm, and the distance by axes; `None` if the axes
    /// do not prove it.
    fn both<N: Real>(one: &Triangle<N, 3>, other: &Triangle<N, 3>) -> (N, Option<N>) {
        let (first, second) = (one.geometry().0, other.geometry().0);
        let pair = Pair { first, second, pose12: Pose::identity() };
        let found = general::of_flat_cores(&pair, N::INFINITY).expect("within infinity");
        match by_axes([one, other], &pair.pose12, N::INFINITY) {
            SatResult::Found(axes) => (found.distance, Some(axes.distance)),
            SatResult::Beyond => unreachable!("there is no limit"),
            SatResult::Unproved => (found.distance, None),
        }
    }

    /// Returns the share of proved results among 600 overlapping pairs of triangles, with corners
    /// from `corner`. Asserts that proved distances agree with the general algorithm.
    fn share<N: Real>(mut corner: impl FnMut() -> Point<N, 3>) -> f64 {
        let (mut proved, mut overlapping) = (0, 0);
        while overlapping < 600 {
            let mut triangle = || Triangle::new(corner(), corner(), corner());
            let (one, other) = (triangle(), triangle());
            let (distance, axes) = both(&one, &other);
            if distance < -N::lit(1e-4) {
                overlapping += 1;
                proved += u32::from(axes.is_some());
            }
            let off = axes.map_or(N::ZERO, |axes| (axes - distance).abs());
            assert!(off <= N::lit(512.0) * N::EPSILON, "off by {off}: {one:?} {other:?}");
        }
        f64::from(proved) / f64::from(overlapping)
    }

    #[test]
    fn most_overlaps_are_proved() {
        let (mut random, mut grid) = (Xorshift(3), Xorshift(4));
        assert!(share::<f32>(|| Point::from(random.vector(1.0))) > 0.9);
        assert!(share::<f64>(|| Point::from(random.vector(1.0))) > 0.9);
        // Corners on a grid: parallel sides, shared corners, coplanar triangles and triangles
        // without area.
        let mut step = || Point::from(grid.vector::<f64>(1.5).map(f64::round));
        assert!(share::<f64>(&mut step) > 0.5);
    }
}
