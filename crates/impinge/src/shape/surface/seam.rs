//! The normals that a connected surface admits at a seam: one rule for the edges, vertices and
//! joints of every composite surface.
//!
//! A point set has, at one of its points, exactly those normals along which no direction into the
//! set rises: the polar cone of these directions. For an edge between two triangles that is the arc
//! between their normals on the side where the edge is convex, for a vertex the cone over the
//! normals of a convex corner; on the hollow side of a valley it is empty. So the rule depends only
//! on the directions that leave the seam, neither on winding nor on sides. Contacts with other
//! normals are ghosts of the pieces: Catto, "Ghost Collisions" (2020), for chains; Terdiman,
//! "Contact generation for meshes" (2015); and the active edges of Jolt and Box3D.
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
//! The edge `e` is seen along itself, fronts up. On the back of the valley its normals are those
//! from -n1 to -n2. A surface with one side has only the normals that are in front of its highest
//! piece.

use crate::math::{Real, Vector, unit};

/// The sine of the angle up to which two faces count as coplanar: 0.57 degrees.
pub(in crate::shape) const FLAT_SINE: f64 = 0.01;

/// Bound of the sine of the angle by which rounding may turn a unit vector.
pub(in crate::shape) fn slack<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// Whether an angle counts as zero between pieces of one surface, by its sine.
pub(in crate::shape) fn is_flat<N: Real>(sine: N) -> bool {
    sine.abs() <= N::lit(FLAT_SINE)
}

/// Whether two lines count as parallel, by the scalar product of unit vectors along them.
fn is_level<N: Real>(cosine: N) -> bool {
    N::ONE - cosine * cosine <= N::lit(FLAT_SINE * FLAT_SINE)
}

/// Whether a unit vector is perpendicular to an edge, within `FLAT_SINE`: the vector may be the
/// result of an iteration, and an edge has no other normals to take instead. True for an edge
/// without length.
pub(in crate::shape) fn is_across<N: Real, const D: usize>(
    edge: &Vector<N, D>,
    normal: &Vector<N, D>,
) -> bool {
    unit(edge).is_none_or(|(along, _)| is_flat(along.dot(normal)))
}

/// A vector at a corner rises or sinks clearly if its sine exceeds `slack` by this factor.
const CLEAR: f64 = 8.0;

/// The sides that leave a corner, compared with a normal there. They decide most cases without the
/// faces: the normal is rejected if a side rises along it, and admitted if all sink.
pub(in crate::shape) struct CornerWays<'a, N: Real, const D: usize> {
    normal: &'a Vector<N, D>,
    /// A side rises clearly along the normal.
    has_rising: bool,
    /// A side is perpendicular to the normal, within rounding.
    has_level: bool,
}

impl<'a, N: Real, const D: usize> CornerWays<'a, N, D> {
    pub(in crate::shape) const fn new(normal: &'a Vector<N, D>) -> Self {
        Self { normal, has_rising: false, has_level: false }
    }

    /// Adds a side of any length, as a vector away from the corner.
    #[inline]
    pub(in crate::shape) fn add(&mut self, way: &Vector<N, D>) {
        let (rise, room) = (way.dot(self.normal), N::lit(CLEAR) * slack());
        let is_clear = rise * rise > room * room * way.norm_squared();
        self.has_rising |= is_clear && rise > N::ZERO;
        self.has_level |= !is_clear;
    }

    /// Whether a side rises, so that more sides cannot change the answer.
    pub(in crate::shape) const fn is_refused(&self) -> bool {
        self.has_rising
    }

    /// Whether the corner admits the normal, after all its sides were added; `None` where the faces
    /// decide. `own` is the unit normal of a face at the corner; `is_bent` says that another face
    /// there is known not to be coplanar with it.
    pub(in crate::shape) fn admit(
        &self,
        (own, is_bent): (&Vector<N, D>, bool),
        is_one_sided: bool,
    ) -> Option<bool> {
        if self.has_rising {
            return Some(false);
        }
        let cosine = own.dot(self.normal);
        let is_leaning = N::ONE - cosine * cosine > N::lit(2.0 * FLAT_SINE * FLAT_SINE);
        ((is_leaning || is_bent) && !self.has_level && !is_one_sided).then_some(true)
    }
}

/// The state of one normal at a seam while the pieces of the seam are added.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Seam<N: Real, const D: usize> {
    normal: Vector<N, D>,
    /// The unit normal of the face, or the direction of the segment, that asks; zero if it has
    /// none.
    own: Vector<N, D>,
    /// The component of the normal along the face or segment that asks.
    lean: Vector<N, D>,
    /// A piece lies on the side that the normal tilts to if a direction into it rises along `lean`
    /// by more than `room`.
    room: N,
    /// The normal is that of the asking face or segment, and all pieces are coplanar with this,
    /// within `FLAT_SINE`.
    is_flat: bool,
    /// A coplanar piece lies on the side that the normal tilts to, so the seam is no rim there.
    is_hemmed: bool,
    /// No direction into a piece rises along the normal.
    is_in_cone: bool,
    /// The rise of the highest piece along the normal, the absolute cosine of its front with the
    /// normal, and whether its front is up. The highest piece at the seam is the first one met from
    /// far along the normal; of two that rise equally, the flatter.
    highest: N,
    flatness: N,
    is_front: bool,
}

impl<N: Real, const D: usize> Seam<N, D> {
    /// Starts a seam between faces, for the face with the unit normal `own`.
    pub(in crate::shape) fn of_faces(own: Vector<N, D>, normal: &Vector<N, D>) -> Self {
        let along = own.dot(normal);
        Self::new(own, normal, normal - own * along, is_level(along))
    }

    /// Marks the seam as an edge. A normal that tilts more along the edge than across it is not one
    /// of a rim.
    pub(in crate::shape) fn along(mut self, edge: &Vector<N, D>) -> Self {
        if let Some((along, _)) = unit(edge) {
            self.room -= along.dot(&self.lean).abs();
        }
        self
    }

    /// Starts a seam between segments, for the one with the unit direction `own`.
    pub(in crate::shape) fn of_segments(own: Vector<N, D>, normal: &Vector<N, D>) -> Self {
        let along = own.dot(normal);
        Self::new(own, normal, own * along, is_flat(along))
    }

    fn new(own: Vector<N, D>, normal: &Vector<N, D>, lean: Vector<N, D>, is_flat: bool) -> Self {
        Self {
            normal: *normal,
            own,
            lean,
            room: slack(),
            is_flat,
            is_hemmed: false,
            is_in_cone: true,
            highest: -N::INFINITY,
            flatness: -N::ONE,
            is_front: true,
        }
    }

    /// Adds a face. `rise` returns the largest component, along a vector, of the unit directions
    /// from the seam into the face; `front` is the unit normal on its front, zero if it has no
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
    /// normal along its front, zero if it has two sides.
    pub(in crate::shape) fn add_segment(&mut self, away: &Vector<N, D>, front: N) {
        self.add(|direction| away.dot(direction), away, front);
    }

    /// Adds a piece; it is coplanar with the asking piece if `line` is parallel to `own`.
    fn add(&mut self, rise: impl Fn(&Vector<N, D>) -> N, line: &Vector<N, D>, front: N) {
        let (own, flatness) = (rise(&self.normal), front.abs());
        self.is_in_cone &= own <= slack();
        self.is_flat &= is_level(line.dot(&self.own));
        self.is_hemmed |= self.is_flat && rise(&self.lean) > self.room;
        let is_same = |a: N, b: N| (a - b).abs() <= slack();
        if is_same(own, self.highest) && is_same(flatness, self.flatness) {
            // A piece that was added twice has its front up if it has in either.
            self.is_front |= front >= N::ZERO;
        } else if own > self.highest || (own == self.highest && flatness > self.flatness) {
            (self.highest, self.flatness) = (own, flatness);
            self.is_front = front >= N::ZERO;
        }
    }

    /// Whether the whole surface has the normal at the seam and no face gives a better one: between
    /// coplanar pieces only the normals of the faces count. At a rim, where all pieces lie on one
    /// side, the normals that tilt to the other side are admitted, however many pieces there are.
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

    /// Whether the edge of some faces admits a normal; a face is the direction into it and its
    /// front.
    fn admits(normal: &Vector<f64, 3>, faces: &[(Vector<f64, 3>, Vector<f64, 3>)]) -> bool {
        let mut seam = Seam::of_faces(faces[0].1, normal).along(&Vector::<f64, 3>::z());
        for (inward, front) in faces {
            seam.add_face(|way| inward.dot(way), front);
        }
        seam.admits(true)
    }

    #[test]
    fn a_rim_is_one_however_often_its_face_is_there() {
        let (left, outward, inward) = ((v(-1.0, 0.0), v(0.0, 1.0)), v(0.005, 1.0), v(-0.005, 1.0));
        for faces in [[left].as_slice(), &[left; 2], &[left; 3]] {
            assert!(admits(&outward, faces) && !admits(&inward, faces), "{} faces", faces.len());
        }
        let other_way = [left, (left.0, -left.1)];
        assert!(admits(&outward, &other_way), "one of the two has its front up");
        let almost_level = [left, (v(-1.0, -0.004), v(-0.004, 1.0))];
        assert!(admits(&outward, &almost_level), "on one side");
    }

    #[test]
    fn between_faces_that_are_almost_level_only_their_normals_count() {
        let ridge = [(v(-1.0, -0.003), v(-0.003, 1.0)), (v(1.0, -0.003), v(0.003, 1.0))];
        assert!(!admits(&v(0.0, 1.0), &ridge), "within half a degree of both");
        let sharp = [(v(-1.0, -0.3), v(-0.3, 1.0)), (v(1.0, -0.3), v(0.3, 1.0))];
        assert!(admits(&v(0.0, 1.0), &sharp), "a ridge has it");
        let level = [(v(-1.0, 0.0), v(0.0, 1.0)), (v(1.0, 0.0), v(0.0, 1.0))];
        let along = Vector::<f64, 3>::new(0.0, 1.0, 0.004).normalize();
        assert!(!admits(&along, &level) && !admits(&along, &level[..1]), "along the edge");
    }
}
