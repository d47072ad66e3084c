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

use crate::math::Real;

/// The sine of the angle up to which faces count as one flat: 0.57 degrees.
const FLAT_SINE: f64 = 0.01;

/// The sine of the angle that rounding may turn unit vectors by.
pub(super) fn slack<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// The angle with this sine counts as none between pieces of one surface.
pub(super) fn is_flat<N: Real>(sine: N) -> bool {
    sine.abs() <= N::lit(FLAT_SINE)
}

/// The angle between two lines, whichever way each points, counts as none; given the scalar product
/// of unit vectors along them.
pub(super) fn is_level<N: Real>(cosine: N) -> bool {
    N::ONE - cosine * cosine <= N::lit(FLAT_SINE * FLAT_SINE)
}

/// What is known of a normal at a seam while its pieces are gone through.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seam<N: Real> {
    /// No direction into a piece rises along the normal.
    is_in_cone: bool,
    /// The normal and those of all pieces are one, within the tolerance.
    is_level: bool,
    pieces: u32,
    /// How much the highest piece rises, how flat it lies, and whether its front is up. The highest
    /// piece at the seam is the one that a point far along the normal sees; of two in one edge, the
    /// flatter.
    highest: N,
    flatness: N,
    is_front: bool,
}

impl<N: Real> Seam<N> {
    pub(super) fn new() -> Self {
        Self {
            is_in_cone: true,
            is_level: true,
            pieces: 0,
            highest: -N::INFINITY,
            flatness: -N::ONE,
            is_front: true,
        }
    }

    /// A direction into a piece rises so much along the normal.
    pub(super) fn add_rise(&mut self, rise: N) {
        self.is_in_cone &= rise <= slack();
    }

    /// A piece whose steepest direction rises so much along the normal; the scalar product of its
    /// front with the normal; and whether it and the normal lie flat with the piece that is asked.
    pub(super) fn add(&mut self, rise: N, front: N, is_level: bool) {
        self.add_rise(rise);
        self.is_level &= is_level;
        self.pieces += 1;
        if rise > self.highest || (rise == self.highest && front.abs() > self.flatness) {
            (self.highest, self.flatness) = (rise, front.abs());
            self.is_front = front >= N::ZERO;
        }
    }

    /// The normal is one that the whole has at the seam and that is not better given by a face:
    /// between pieces that lie flat, only the faces' own normals count.
    pub(super) const fn admits(&self, is_one_sided: bool) -> bool {
        let is_flat = self.is_level && self.pieces > 1;
        self.is_in_cone && !is_flat && (self.is_front || !is_one_sided)
    }
}
