//! Disks perpendicular to the y axis: the caps of cylinders and cones.

use crate::math::{Matrix, Point, Real, Vector, unit};
use crate::shape::solids::segment::length_of;
use crate::shape::{CurvedSupport, Feature, FeatureId};

/// Returns the coordinate of a point along the y axis and its distance from that axis.
fn axial<N: Real, const D: usize>(point: &Point<N, D>) -> (N, N) {
    let squares = (0..D).filter(|&axis| axis != 1).map(|axis| point[axis] * point[axis]);
    (point[1], squares.fold(N::ZERO, |sum, square| sum + square).sqrt())
}

/// Returns the coordinates of [`axial`] for a surface point of a solid about the y axis. `None` if
/// `half_height` or `radius` is at most `4 tolerance`: a point could then lie on several features
/// at once.
pub(in crate::shape) fn axial_on<N: Real, const D: usize>(
    point: &Point<N, D>,
    [half_height, radius]: [N; 2],
    tolerance: N,
) -> Option<(N, N)> {
    let least = N::lit(4.0) * tolerance;
    (half_height > least && radius > least).then(|| axial(point))
}

/// The supporting feature of a cylinder or a cone, if it is not a cap.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RoundPart<N: Real> {
    /// A point of a rim, or the apex.
    Point(FeatureId, Point<N, 3>),
    /// The generating line nearest to the direction, and its ends.
    Line(FeatureId, [(FeatureId, Point<N, 3>); 2]),
}

impl<N: Real> RoundPart<N> {
    /// Writes the feature to `out`.
    pub(in crate::shape) fn fill(self, out: &mut Feature<N, 3>) {
        match self {
            Self::Point(id, point) => out.set_point(id, point),
            Self::Line(id, ends) => out.set_segment(id, ends),
        }
    }
}

/// The points within `radius` of the y axis at height `y`.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Disk<N: Real> {
    pub(in crate::shape) radius: N,
    pub(in crate::shape) y: N,
}

/// Returns the component of a direction perpendicular to the y axis, as (x, z).
pub(in crate::shape) fn radial_of<N: Real>(direction: &Vector<N, 3>) -> Vector<N, 2> {
    Vector::<N, 2>::new(direction.x, direction.z)
}

impl<N: Real> Disk<N> {
    /// Returns the rim point farthest along `direction`; the centre if `direction` is along the
    /// axis.
    pub(in crate::shape) fn rim_toward(self, direction: &Vector<N, 3>) -> Point<N, 3> {
        self.at(unit(&radial_of(direction)).map_or_else(Vector::<N, 2>::zeros, |(along, _)| along))
    }

    /// Returns the rim point farthest along the unit vector `direction`, and its derivative. `None`
    /// if the squared component across the axis is at most epsilon, too small to give a direction.
    pub(in crate::shape) fn curved_rim(
        self,
        direction: &Vector<N, 3>,
    ) -> Option<CurvedSupport<N, 3>> {
        let (radial, length) = unit(&radial_of(direction))?;
        let resolved = length * length > N::EPSILON;
        if !resolved {
            return None;
        }
        // The point moves along the rim by `radius` per radian of rotation about the axis.
        let around = Vector::<N, 3>::new(-radial.y, N::ZERO, radial.x);
        let pace = self.radius / length;
        let bend = Matrix::<N, 3>::from_fn(|i, j| around[i] * around[j] * pace);
        Some(CurvedSupport { point: self.at(radial), bend })
    }

    /// Returns the half extents, along the outer axes, of this disk after it is centred at the
    /// origin and rotated by `rotation`. They are computed from the two columns that span the disk.
    /// If they were computed from the axis, the extent at a small tilt would lose half of its
    /// significant digits.
    pub(in crate::shape) fn extents(self, rotation: &Matrix<N, 3>) -> Vector<N, 3> {
        Vector::<N, 3>::from_fn(|axis, _| {
            let spans = Vector::<N, 2>::new(rotation[(axis, 0)], rotation[(axis, 2)]);
            length_of(&spans) * self.radius
        })
    }

    fn at(self, radial: Vector<N, 2>) -> Point<N, 3> {
        Point::<N, 3>::new(radial.x * self.radius, self.y, radial.y * self.radius)
    }

    /// Writes the disk as an inscribed octagon, whose normal points to the side of the y axis on
    /// which `direction` lies. The first vertex is towards `direction`, or towards x if `direction`
    /// is along the y axis up to rounding. A disk without radius is written as a point.
    pub(in crate::shape) fn fill_polygon(
        self,
        face: FeatureId,
        rim: FeatureId,
        direction: &Vector<N, 3>,
        out: &mut Feature<N, 3>,
    ) {
        if self.radius == N::ZERO {
            return out.set_point(rim, self.at(Vector::<N, 2>::zeros()));
        }
        out.clear();
        out.id = face;
        // Seen from positive y, with x to the right, z points down. So a loop that is clockwise in
        // (x, z) is counter-clockwise in this view.
        let turn = if direction.y < N::ZERO { N::ONE } else { -N::ONE };
        let mut radial = first_sample(direction);
        for _ in 0..8 {
            out.push(rim, self.at(radial));
            out.side_ids.push(rim);
            radial = eighth_turn(&radial, turn);
        }
        out.normal = Some(Vector::<N, 3>::new(N::ZERO, -turn, N::ZERO));
    }
}

/// Returns the unit vector of a direction's component across the y axis; the x axis if that
/// component is only rounding error.
fn first_sample<N: Real>(direction: &Vector<N, 3>) -> Vector<N, 2> {
    let fallback = Vector::<N, 2>::new(N::ONE, N::ZERO);
    match unit(&radial_of(direction)) {
        Some((along, length)) if length > N::lit(64.0) * N::EPSILON => along,
        _ => fallback,
    }
}

/// Rotates a 2D vector by 45 degrees, counter-clockwise for `turn` 1, clockwise for −1.
fn eighth_turn<N: Real>(v: &Vector<N, 2>, turn: N) -> Vector<N, 2> {
    let cosine = N::lit(std::f64::consts::FRAC_1_SQRT_2);
    let sine = cosine * turn;
    Vector::<N, 2>::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y)
}
