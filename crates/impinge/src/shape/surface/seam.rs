//! The normals that a connected surface admits at a seam: one rule for the edges, vertices and
//! joints of every composite surface.
//!
//! The normals of a point set at one of its points form the polar cone of the directions into the
//! set: each of these directions has a component of at most zero along each normal. For an edge
//! between two triangles this is the arc between their normals on the convex side; for a vertex it
//! is the cone over the normals of a convex corner; on the concave side it is empty. So the rule
//! depends only on the directions that leave the seam, not on winding or sides. Contacts with other
//! normals are computed from single pieces as if these had no neighbours. They are called ghost
//! collisions: Catto, "Ghost Collisions" (2020), for chains; Terdiman, "Contact generation for
//! meshes" (2015); and the active edges of Jolt and Box3D.
//!
//! ```text
//!   n1   n2         ╲           ╱            n1
//!     ╲ ╱            ╲ ↗n1 n2↖ ╱             │ ╱
//!      e              ╲       ╱              │╱
//!    ╱   ╲             ╲     ╱         ──────e──
//!  ╱       ╲            ╲ e ╱                │╲
//!                                           -n1
//!  ridge: n1 to n2    valley: none    rim: n1 to -n1, away from the face
//! ```
//!
//! The figure looks along the edge `e`, with fronts up. On the back of the valley, the edge has the
//! normals from -n1 to -n2. A one-sided surface admits a normal only if the front of the highest
//! piece (the piece with the largest component along the normal) faces that way.

use crate::math::{Real, Vector, unit};

/// The sine of the angle up to which two faces are treated as coplanar: 0.57 degrees.
pub(in crate::shape) const FLAT_SINE: f64 = 0.01;

/// Returns a bound of the sine of the angle by which rounding may turn a unit vector.
pub(in crate::shape) fn slack<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// Returns whether an angle between pieces of one surface is treated as zero, given its sine.
pub(in crate::shape) fn is_flat<N: Real>(sine: N) -> bool {
    sine.abs() <= N::lit(FLAT_SINE)
}

/// Returns whether two lines are treated as parallel, given the scalar product of unit vectors
/// along them.
fn are_parallel<N: Real>(cosine: N) -> bool {
    N::ONE - cosine * cosine <= N::lit(FLAT_SINE * FLAT_SINE)
}

/// Returns whether a unit vector is perpendicular to an edge, within `FLAT_SINE`. The tolerance is
/// large because the vector may be the result of an iteration, and an edge has no other normals to
/// replace it. True for an edge without length.
pub(in crate::shape) fn is_across<N: Real, const D: usize>(
    edge: &Vector<N, D>,
    normal: &Vector<N, D>,
) -> bool {
    unit(edge).is_none_or(|(along, _)| is_flat(along.dot(normal)))
}

/// A side clearly rises or sinks along a normal if the component of its unit direction along the
/// normal exceeds, in magnitude, `slack` times this factor.
const CLEAR: f64 = 8.0;

/// Compares a normal at a corner with the sides that leave the corner. This decides most cases
/// without the faces: the normal is rejected if a side rises along it (has a positive component),
/// and mostly admitted if all sides sink (have negative components).
pub(in crate::shape) struct CornerEdges<'a, N: Real, const D: usize> {
    normal: &'a Vector<N, D>,
    /// Whether a side clearly rises along the normal.
    has_rising: bool,
    /// Whether a side is perpendicular to the normal, within rounding.
    has_perpendicular: bool,
}

impl<'a, N: Real, const D: usize> CornerEdges<'a, N, D> {
    pub(in crate::shape) const fn new(normal: &'a Vector<N, D>) -> Self {
        Self { normal, has_rising: false, has_perpendicular: false }
    }

    /// Adds a side, as a vector of any length away from the corner.
    #[inline]
    pub(in crate::shape) fn add(&mut self, edge: &Vector<N, D>) {
        let (rise, margin) = (edge.dot(self.normal), N::lit(CLEAR) * slack());
        let is_clear = rise * rise > margin * margin * edge.norm_squared();
        self.has_rising |= is_clear && rise > N::ZERO;
        self.has_perpendicular |= !is_clear;
    }

    /// Returns whether a side clearly rises along the normal. More sides then cannot change the
    /// result.
    pub(in crate::shape) const fn is_refused(&self) -> bool {
        self.has_rising
    }

    /// Returns whether the corner admits the normal, after all its sides were added; `None` if the
    /// faces decide. `own` is the unit normal of a face at the corner; `is_bent` is true if another
    /// face there is known not to be coplanar with that face.
    pub(in crate::shape) fn admit(
        &self,
        (own, is_bent): (&Vector<N, D>, bool),
        is_one_sided: bool,
    ) -> Option<bool> {
        if self.has_rising {
            return Some(false);
        }
        let cosine = own.dot(self.normal);
        let is_tilted = N::ONE - cosine * cosine > N::lit(2.0 * FLAT_SINE * FLAT_SINE);
        ((is_tilted || is_bent) && !self.has_perpendicular && !is_one_sided).then_some(true)
    }
}

/// The state of one normal at a seam while the pieces around the seam are added.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Seam<N: Real, const D: usize> {
    normal: Vector<N, D>,
    /// The unit normal of the queried face, or the unit direction of the queried segment; zero if
    /// it has none.
    own: Vector<N, D>,
    /// The component of the normal along the queried face or segment.
    tilt: Vector<N, D>,
    /// A piece lies on the side to which the normal tilts if a unit direction into it has a
    /// component along `tilt` of more than `margin`.
    margin: N,
    /// Whether the normal is a normal of the queried face or segment, and all pieces added so far
    /// are coplanar with that face or segment, within `FLAT_SINE`.
    is_flat: bool,
    /// Whether a coplanar piece lies on the side to which the normal tilts: the seam is then not a
    /// rim there.
    is_hemmed: bool,
    /// Whether every direction into a piece has a component of at most zero along the normal.
    is_in_cone: bool,
    /// The component along the normal of the highest piece, the absolute cosine between its front
    /// and the normal, and whether the scalar product of front and normal is at least zero. The
    /// highest piece at the seam is the first one met when coming from far along the normal; of two
    /// equally high pieces, the flatter.
    highest: N,
    flatness: N,
    is_front: bool,
}

impl<N: Real, const D: usize> Seam<N, D> {
    /// Starts a seam between faces, for the queried face with the unit normal `own`.
    pub(in crate::shape) fn of_faces(own: Vector<N, D>, normal: &Vector<N, D>) -> Self {
        let along = own.dot(normal);
        Self::new(own, normal, normal - own * along, are_parallel(along))
    }

    /// Marks the seam as an edge. A normal that tilts more along the edge than across it is then
    /// not a normal of a rim.
    pub(in crate::shape) fn along(mut self, edge: &Vector<N, D>) -> Self {
        if let Some((along, _)) = unit(edge) {
            self.margin -= along.dot(&self.tilt).abs();
        }
        self
    }

    /// Starts a seam between segments, for the queried segment with the unit direction `own`.
    pub(in crate::shape) fn of_segments(own: Vector<N, D>, normal: &Vector<N, D>) -> Self {
        let along = own.dot(normal);
        Self::new(own, normal, own * along, is_flat(along))
    }

    fn new(own: Vector<N, D>, normal: &Vector<N, D>, tilt: Vector<N, D>, is_flat: bool) -> Self {
        Self {
            normal: *normal,
            own,
            tilt,
            margin: slack(),
            is_flat,
            is_hemmed: false,
            is_in_cone: true,
            highest: -N::INFINITY,
            flatness: -N::ONE,
            is_front: true,
        }
    }

    /// Adds a face. `rise(v)` returns the largest component along `v` of the unit directions from
    /// the seam into the face; `front` is the unit normal on the front, zero if the face has no
    /// area.
    pub(in crate::shape) fn add_face(
        &mut self,
        rise: impl Fn(&Vector<N, D>) -> N,
        front: &Vector<N, D>,
    ) {
        if *front == Vector::<N, D>::zeros() {
            self.is_in_cone &= rise(&self.normal) <= slack();
        } else {
            self.add(rise, front, front.dot(&self.normal));
        }
    }

    /// Adds a segment by its unit direction away from the seam; `front` is the component of the
    /// normal along the segment's front, zero if it has two sides.
    pub(in crate::shape) fn add_segment(&mut self, away: &Vector<N, D>, front: N) {
        self.add(|direction| away.dot(direction), away, front);
    }

    /// Adds a piece; it is coplanar with the queried piece if `line` is parallel to `own`.
    fn add(&mut self, rise: impl Fn(&Vector<N, D>) -> N, line: &Vector<N, D>, front: N) {
        let (own, flatness) = (rise(&self.normal), front.abs());
        self.is_in_cone &= own <= slack();
        self.is_flat &= are_parallel(line.dot(&self.own));
        self.is_hemmed |= self.is_flat && rise(&self.tilt) > self.margin;
        let is_same = |a: N, b: N| (a - b).abs() <= slack();
        if is_same(own, self.highest) && is_same(flatness, self.flatness) {
            // For a piece that was added twice, one addition with the front towards the normal
            // suffices.
            self.is_front |= front >= N::ZERO;
        } else if own > self.highest || (own == self.highest && flatness > self.flatness) {
            (self.highest, self.flatness) = (own, flatness);
            self.is_front = front >= N::ZERO;
        }
    }

    /// Returns whether the whole surface admits the normal at the seam. Between coplanar pieces
    /// only the face normals are admitted. At a rim, where all pieces lie on one side, the normals
    /// that tilt to the open side are admitted, however many pieces there are.
    pub(in crate::shape) const fn admits(&self, is_one_sided: bool) -> bool {
        let is_flat = self.is_flat && self.is_hemmed;
        self.is_in_cone && !is_flat && (self.is_front || !is_one_sided)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(x: f64, y: f64) -> Vector<f64, 3> {
        Vector::<f64, 3>::new(x, y, 0.0).normalize()
    }

    /// Returns whether the edge of some faces admits a normal; each face is given by the direction
    /// into it and its front normal.
    fn admits(normal: &Vector<f64, 3>, faces: &[(Vector<f64, 3>, Vector<f64, 3>)]) -> bool {
        let mut seam = Seam::of_faces(faces[0].1, normal).along(&Vector::<f64, 3>::z());
        for (inward, front) in faces {
            seam.add_face(|direction| inward.dot(direction), front);
        }
        seam.admits(true)
    }

    #[test]
    fn a_rim_is_one_however_often_its_face_is_there() {
        let (left, outward, inward) = ((v(-1.0, 0.0), v(0.0, 1.0)), v(0.005, 1.0), v(-0.005, 1.0));
        for faces in [[left].as_slice(), &[left; 2], &[left; 3]] {
            assert!(admits(&outward, faces) && !admits(&inward, faces), "{} faces", faces.len());
        }
        let other_order = [left, (left.0, -left.1)];
        assert!(admits(&outward, &other_order), "one of the two has its front up");
        let almost_coplanar = [left, (v(-1.0, -0.004), v(-0.004, 1.0))];
        assert!(admits(&outward, &almost_coplanar), "on one side");
    }

    #[test]
    fn between_almost_coplanar_faces_only_their_normals_count() {
        let ridge = [(v(-1.0, -0.003), v(-0.003, 1.0)), (v(1.0, -0.003), v(0.003, 1.0))];
        assert!(!admits(&v(0.0, 1.0), &ridge), "within half a degree of both");
        let sharp = [(v(-1.0, -0.3), v(-0.3, 1.0)), (v(1.0, -0.3), v(0.3, 1.0))];
        assert!(admits(&v(0.0, 1.0), &sharp), "a ridge has it");
        let coplanar = [(v(-1.0, 0.0), v(0.0, 1.0)), (v(1.0, 0.0), v(0.0, 1.0))];
        let along = Vector::<f64, 3>::new(0.0, 1.0, 0.004).normalize();
        assert!(!admits(&along, &coplanar) && !admits(&along, &coplanar[..1]), "along the edge");
    }
}
