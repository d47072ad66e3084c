//! What a surface that hangs together admits at a seam: the rule that edges, vertices and joints of
//! every composite surface share.
//!
//! A point set has, at one of its points, exactly those normals along which no direction into the
//! set rises: the polar cone of the directions. For an edge between two triangles that is the arc
//! between their normals on the side where the edge is convex, for a vertex the cone over the normals
//! of a convex corner; on the hollow side of a valley there is none. So the rule asks only for the
//! directions that leave the seam, and neither for winding nor for sides. That contacts with other
//! normals are ghosts of the pieces: Catto, "Ghost Collisions" (2020), for chains; Terdiman, "Contact
//! generation for meshes" (2015); and the active edges of Jolt and Box3D.

use crate::math::{Real, Vector, unit};

/// The sine of the angle up to which faces count as one flat: 0.57 degrees.
pub(in crate::shape) const FLAT_SINE: f64 = 0.01;

/// The sine of the angle that rounding may turn unit vectors by.
pub(in crate::shape) fn slack<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// The angle with this sine counts as none between pieces of one surface.
pub(in crate::shape) fn is_flat<N: Real>(sine: N) -> bool {
    sine.abs() <= N::lit(FLAT_SINE)
}

/// The angle between two lines, whichever way each points, counts as none; given the scalar product
/// of unit vectors along them.
fn is_level<N: Real>(cosine: N) -> bool {
    N::ONE - cosine * cosine <= N::lit(FLAT_SINE * FLAT_SINE)
}

/// A unit vector is perpendicular to an edge. Not to the last digit: what it is asked of may have
/// been found by iteration, and an edge has no other normals to take instead.
pub(in crate::shape) fn is_across<N: Real, const D: usize>(
    edge: &Vector<N, D>,
    normal: &Vector<N, D>,
) -> bool {
    unit(edge).is_none_or(|(along, _)| is_flat(along.dot(normal)))
}

/// Sines of so many times what rounding may turn a vector by are none.
const CLEAR: f64 = 8.0;

/// What the ways from a corner to those around it tell of a normal there, without a look at the faces: most are
/// refused since one of the ways rises along them, or admitted since all sink.
pub(in crate::shape) struct CornerWays<'a, N: Real, const D: usize> {
    normal: &'a Vector<N, D>,
    has_rising: bool,
    has_level: bool,
}

impl<'a, N: Real, const D: usize> CornerWays<'a, N, D> {
    pub(in crate::shape) const fn new(normal: &'a Vector<N, D>) -> Self {
        Self { normal, has_rising: false, has_level: false }
    }

    /// Adds a way of any length.
    #[inline]
    pub(in crate::shape) fn add(&mut self, way: &Vector<N, D>) {
        let (rise, room) = (way.dot(self.normal), N::lit(CLEAR) * slack());
        let is_clear = rise * rise > room * room * way.norm_squared();
        self.has_rising |= is_clear && rise > N::ZERO;
        self.has_level |= !is_clear;
    }

    /// A way rises.
    pub(in crate::shape) const fn is_refused(&self) -> bool {
        self.has_rising
    }

    /// Whether the corner has the normal, given all ways; `None` where the faces decide. Of a face at the corner the
    /// normal is given, and whether another face there is known not to be level with it.
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

/// What is known of a normal at a seam while its pieces are gone through.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Seam<N: Real, const D: usize> {
    normal: Vector<N, D>,
    /// The normal of the face, or the direction of the segment, that is asked; zero if it has none.
    own: Vector<N, D>,
    /// The part of the normal along the face or segment that is asked.
    lean: Vector<N, D>,
    /// A piece into which no direction rises along `lean` by more than this lies on the other side.
    room: N,
    /// The normal and the pieces, that which is asked and all others, lie flat.
    is_flat: bool,
    /// A piece lies on the side that the normal leans to: the seam is no rim there.
    is_hemmed: bool,
    /// No direction into a piece rises along the normal.
    is_in_cone: bool,
    /// How much the highest piece rises, how flat it lies, and whether its front is up. The highest
    /// piece at the seam is the one that a point far along the normal sees; of two in one edge, the
    /// flatter.
    highest: N,
    flatness: N,
    is_front: bool,
}

impl<N: Real, const D: usize> Seam<N, D> {
    /// A seam between faces, asked by the one with the normal `own`.
    pub(in crate::shape) fn of_faces(own: Vector<N, D>, normal: &Vector<N, D>) -> Self {
        let along = own.dot(normal);
        Self::new(own, normal, normal - own * along, is_level(along))
    }

    /// A seam that is an edge: what leans along it more than across it is no normal of a rim.
    pub(in crate::shape) fn along(mut self, edge: &Vector<N, D>) -> Self {
        if let Some((along, _)) = unit(edge) {
            self.room -= along.dot(&self.lean).abs();
        }
        self
    }

    /// A seam between segments, asked by the one with the direction `own`.
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

    /// Adds a face. `rise` returns how much the steepest direction from the seam into the face rises along a
    /// vector; `front` is the normal on its front, zero if it has no area.
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

    /// A segment by its direction away from the seam, and how much its front faces the normal; zero
    /// if it has no front.
    pub(in crate::shape) fn add_segment(&mut self, away: &Vector<N, D>, front: N) {
        self.add(|direction| away.dot(direction), away, front);
    }

    /// `line` is compared with what is asked to tell whether the two lie flat.
    fn add(&mut self, rise: impl Fn(&Vector<N, D>) -> N, line: &Vector<N, D>, front: N) {
        let (own, flatness) = (rise(&self.normal), front.abs());
        self.is_in_cone &= own <= slack();
        self.is_flat &= is_level(line.dot(&self.own));
        self.is_hemmed |= self.is_flat && rise(&self.lean) > self.room;
        let is_same = |a: N, b: N| (a - b).abs() <= slack();
        if is_same(own, self.highest) && is_same(flatness, self.flatness) {
            // One piece twice, with its front up in one of them.
            self.is_front |= front >= N::ZERO;
        } else if own > self.highest || (own == self.highest && flatness > self.flatness) {
            (self.highest, self.flatness) = (own, flatness);
            self.is_front = front >= N::ZERO;
        }
    }

    /// The normal is one that the whole has at the seam and that is not better given by a face:
    /// between pieces that lie flat, only the faces' own normals count. At a rim, where all pieces lie on
    /// one side, the whole has the normals that lean to the other side, however many pieces there are.
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

    /// Whether the edge of some faces, each by the way into it and its front, has a normal.
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
