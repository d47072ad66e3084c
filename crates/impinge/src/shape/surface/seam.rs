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

/// A vector rises along a unit vector by far more than what counts as rounding.
pub(in crate::shape) fn leads_up_clearly<N: Real, const D: usize>(
    vector: &Vector<N, D>,
    normal: &Vector<N, D>,
) -> bool {
    let rise = vector.dot(normal);
    rise > N::ZERO && rise * rise > N::lit(CLEAR) * vector.norm_squared()
}

/// Squares of sines above this are no rounding.
const CLEAR: f64 = 1.0 / (512.0 * 512.0);

/// What is known of a normal at a seam while its pieces are gone through.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Seam<N: Real, const D: usize> {
    normal: Vector<N, D>,
    /// The normal of the face, or the direction of the segment, that is asked; zero if it has none.
    own: Vector<N, D>,
    /// The normal and the pieces, that which is asked and all others, lie flat.
    is_flat: bool,
    /// No direction into a piece rises along the normal.
    is_in_cone: bool,
    pieces: u32,
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
        Self::new(own, normal, is_level(own.dot(normal)))
    }

    /// A seam between segments, asked by the one with the direction `own`.
    pub(in crate::shape) fn of_segments(own: Vector<N, D>, normal: &Vector<N, D>) -> Self {
        Self::new(own, normal, is_flat(own.dot(normal)))
    }

    fn new(own: Vector<N, D>, normal: &Vector<N, D>, is_flat: bool) -> Self {
        Self {
            normal: *normal,
            own,
            is_flat,
            is_in_cone: true,
            pieces: 0,
            highest: -N::INFINITY,
            flatness: -N::ONE,
            is_front: true,
        }
    }

    /// A face whose steepest direction from the seam rises so much along the normal, and its normal
    /// on the front; zero if it has no area.
    pub(in crate::shape) fn add_face(&mut self, rise: N, front: &Vector<N, D>) {
        if *front == Vector::<N, D>::zeros() {
            self.is_in_cone &= rise <= slack();
        } else {
            self.add(rise, front, front.dot(&self.normal));
        }
    }

    /// A segment by its direction away from the seam, and how much its front faces the normal; zero
    /// if it has no front.
    pub(in crate::shape) fn add_segment(&mut self, away: &Vector<N, D>, front: N) {
        self.add(away.dot(&self.normal), away, front);
    }

    /// `line` is compared with what is asked to tell whether the two lie flat.
    fn add(&mut self, rise: N, line: &Vector<N, D>, front: N) {
        self.is_in_cone &= rise <= slack();
        self.is_flat &= is_level(line.dot(&self.own));
        self.pieces += 1;
        if rise > self.highest || (rise == self.highest && front.abs() > self.flatness) {
            (self.highest, self.flatness) = (rise, front.abs());
            self.is_front = front >= N::ZERO;
        }
    }

    /// The normal is one that the whole has at the seam and that is not better given by a face:
    /// between pieces that lie flat, only the faces' own normals count.
    pub(in crate::shape) const fn admits(&self, is_one_sided: bool) -> bool {
        let is_flat = self.is_flat && self.pieces > 1;
        self.is_in_cone && !is_flat && (self.is_front || !is_one_sided)
    }
}
