//! Solid regions (bodies) that closed surfaces enclose, and the connected pieces of surfaces.
//!
//! Part searches find only the surface of a body. A solid wholly inside touches no part of the
//! surface, so queries also test whether the body contains a point of each piece of the other
//! shape.

use core::ops::Range;

use super::mesh_error::MeshError;
use crate::math::{Mapped, Point, Pose, Real, Space};
use crate::shape::CompositeShape;

/// A body: the solid region that a closed surface of a composite encloses. It consists of all
/// points around which the surface winds.
///
/// Public only because a hidden method of a public trait has it as an argument.
#[expect(missing_debug_implementations, reason = "users cannot reach it")]
pub struct EnclosedBody<'a, N: Real, const D: usize> {
    /// The boundary of the body, in the boundary's own frame.
    boundary: &'a dyn CompositeShape<N, D>,
    /// The pose of the boundary in the frame of the composite.
    pose: Pose<N, D>,
    /// Index, in the composite, of the boundary's first part.
    first: u32,
}

impl<'a, N: Space<D>, const D: usize> EnclosedBody<'a, N, D> {
    /// Returns the body that `boundary` bounds as a whole, in the frame of `boundary`.
    pub(in crate::shape) fn within(boundary: &'a dyn CompositeShape<N, D>) -> Self {
        Self { boundary, pose: Pose::identity(), first: 0 }
    }

    /// Returns this body of a compound's child in the compound's frame. The child lies at `pose`,
    /// and its first part has the index `first` in the compound.
    pub(in crate::shape) fn of_child(&self, pose: &Pose<N, D>, first: u32) -> Self {
        Self { pose: pose.compose(&self.pose), first: first + self.first, ..*self }
    }

    /// Returns the range of indices that the parts of the boundary have in the composite.
    pub(crate) fn parts(&self) -> Range<u32> {
        self.first..self.first + self.boundary.num_parts()
    }

    /// Returns whether the body contains `point`, which is given in the composite's frame.
    pub(crate) fn holds(&self, point: &Point<N, D>) -> bool {
        self.boundary.winds_around(&self.pose.inverse_point(point))
    }
}

/// Returns for each part the index of the first part of its connected piece. Two parts are
/// connected if `number` maps a vertex of each to the same value, which must be below `vertices`.
pub(super) fn pieces<const K: usize>(
    parts: &[[u32; K]],
    vertices: usize,
    number: impl Fn(u32) -> u32,
) -> Vec<u32> {
    // Union-find over the vertices (Galler and Fischer, "An improved equivalence algorithm", 1964);
    // the root of a set is its vertex with the smallest index.
    let mut above: Vec<u32> = (0..).take(vertices).collect();
    for part in parts {
        let roots = part.mapped(|vertex| root(&mut above, number(vertex)));
        let lowest = roots.iter().fold(roots[0], |low, &own| low.min(own));
        roots.iter().for_each(|&own| above[own as usize] = lowest);
    }
    let mut first = vec![u32::MAX; vertices];
    let mut pieces = Vec::with_capacity(parts.len());
    for (part, corners) in (0..).zip(parts) {
        let first = &mut first[root(&mut above, number(corners[0])) as usize];
        *first = part.min(*first);
        pieces.push(*first);
    }
    pieces
}

/// Returns the root of the set of vertex `at`, and halves the path to it in `above`.
fn root(above: &mut [u32], mut at: u32) -> u32 {
    while above[at as usize] != at {
        above[at as usize] = above[above[at as usize] as usize];
        at = above[at as usize];
    }
    at
}

/// Checks the orientation of each piece of a closed surface. The signed area or volume of a piece
/// is negative if its front faces inwards. A piece that is negative beyond rounding errors must
/// bound a cavity.
///
/// `cone(part)` returns the signed area or volume between a part and a point that is fixed for its
/// piece; `winding(part)` returns the winding number of the other pieces around a point of the part,
/// or `None` if they touch all points of it that are tried. The first part of a piece with a number
/// decides; without any, the piece counts as a cavity.
///
/// # Errors
/// [`MeshError::InsideOut`] with the first part of a piece that is negative and bounds no cavity.
pub(super) fn check_fronts(
    pieces: &[u32],
    cone: impl Fn(u32) -> f64,
    winding: impl Fn(u32) -> Option<i64>,
) -> Result<(), MeshError> {
    let is_cavity = |piece: u32| {
        // A piece has the number of its first part.
        let parts = (0..).zip(pieces).skip(piece as usize);
        let mut own = parts.filter(|&(_, &other)| other == piece);
        own.find_map(|(part, _)| winding(part)).is_none_or(|winding| winding > 0)
    };
    let mut contents = vec![[0.0; 2]; pieces.len()];
    for (part, &piece) in (0..).zip(pieces) {
        let (own, [sum, total]) = (cone(part), &mut contents[piece as usize]);
        (*sum, *total) = (*sum + own, *total + own.abs());
    }
    for (part, [sum, total]) in (0..).zip(contents) {
        if sum < -(NONE * total) && !is_cavity(part) {
            return Err(MeshError::InsideOut { part: part as usize });
        }
    }
    Ok(())
}

/// Returns points of a part at which it may be compared with other pieces: its corners, and their
/// mean.
pub(super) fn samples_of<N: Real, const D: usize, const K: usize>(
    corners: [Point<N, D>; K],
) -> impl Iterator<Item = Point<N, D>> {
    let share = N::ONE / N::lit(K as f64);
    let mean = corners.iter().fold(Point::origin(), |sum, corner| sum + corner.coords * share);
    corners.into_iter().chain([mean])
}

/// An upper bound of the rounding error of a signed area or volume, as a fraction of the sum of the
/// magnitudes of its terms.
const NONE: f64 = 1024.0 * f64::EPSILON;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_share_vertices_are_one_piece() {
        let parts = [[0, 1], [4, 5], [2, 3], [1, 2], [6, 6], [5, 4]];
        assert_eq!(pieces(&parts, 7, |vertex| vertex), [0, 1, 0, 0, 4, 1]);
        assert_eq!(pieces(&parts, 7, |vertex| vertex / 2), [0, 1, 0, 0, 4, 1], "3 is 2, 5 is 4");
    }

    #[test]
    fn a_piece_that_is_inside_out_has_to_be_a_cavity() {
        let cone = |part: u32| [1.0, 2.0, -0.5, -0.25][part as usize];
        let check = |windings: [Option<i64>; 4]| {
            check_fronts(&[0, 0, 2, 2], cone, |part| windings[part as usize])
        };
        assert_eq!(check([Some(0), Some(0), Some(1), Some(1)]), Ok(()));
        let refused = Err(MeshError::InsideOut { part: 2 });
        assert_eq!(check([Some(1), Some(1), Some(0), Some(0)]), refused);
        assert_eq!(check([Some(1), Some(1), None, Some(0)]), refused, "part 3 decides");
        assert_eq!(check([Some(0), Some(0), None, Some(1)]), Ok(()), "part 3 decides");
        assert_eq!(check([Some(0), Some(0), None, None]), Ok(()), "undecided");
        let flat = check_fronts(&[0, 0], |part| f64::from(part) - 0.5, |_| Some(0));
        assert_eq!(flat, Ok(()), "flat");
    }
}
