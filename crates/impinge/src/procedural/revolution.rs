//! Surfaces of revolution: the common part of balls, capsules, cylinders and cones.

use super::TriangleSurface;
use super::circle::direction;
use crate::math::{Point, Real, Vector, cross, orthonormal_basis};

/// A circle on a surface of revolution, in a plane perpendicular to the axis. The first and the
/// last stop of a profile are points on the axis, and their `radius` is ignored.
///
/// Normals are (away from the axis, along the axis). At a crease the normals on the two sides of
/// the circle differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop<N: Real> {
    pub(super) center: Point<N, 3>,
    pub(super) radius: N,
    /// The normal, as (away from the axis, along the axis), at the end of the preceding band.
    pub(super) before: Vector<N, 2>,
    /// The normal, as (away from the axis, along the axis), at the start of the following band.
    pub(super) after: Vector<N, 2>,
}

impl<N: Real> Stop<N> {
    /// Returns a circle with the same normal on both sides.
    pub(super) fn smooth(center: Point<N, 3>, radius: N, normal: Vector<N, 2>) -> Self {
        Self { center, radius, before: normal, after: normal }
    }
}

/// A right-handed frame whose second vector is the axis; the identity for the y axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct RevolutionFrame<N: Real> {
    across: Vector<N, 3>,
    axis: Vector<N, 3>,
    third: Vector<N, 3>,
}

impl<N: Real> RevolutionFrame<N> {
    /// Returns a frame whose second vector is the unit vector `axis`.
    pub(super) fn around(axis: Vector<N, 3>) -> Self {
        let (across, _) = orthonormal_basis(&axis);
        Self { across, axis, third: cross(&across, &axis) }
    }

    /// Converts a 2D unit vector to the 3D direction away from the axis.
    fn radial(&self, toward: &Vector<N, 2>) -> Vector<N, 3> {
        self.across * toward.x + self.third * toward.y
    }

    /// Converts a normal (away from the axis, along the axis) at a direction around the axis to 3D.
    fn normal(&self, profile: &Vector<N, 2>, toward: &Vector<N, 2>) -> Vector<N, 3> {
        self.radial(toward) * profile.x + self.axis * profile.y
    }
}

/// Returns the surface that results from the rotation of a profile around the axis in `count` equal
/// steps. The stops of the profile follow each other along the axis, from the end towards which it
/// points to the other end.
pub(super) fn revolve<N: Real>(
    frame: &RevolutionFrame<N>,
    count: u32,
    profile: &[Stop<N>],
) -> TriangleSurface<N> {
    let last = profile.len() - 1;
    let directions: Vec<_> = (0..count).map(|index| direction::<N>(index, count)).collect();
    let mut vertices = vec![profile[0].center];
    for stop in &profile[1..last] {
        let at = |toward: &Vector<N, 2>| stop.center + frame.radial(toward) * stop.radius;
        vertices.extend(directions.iter().map(at));
    }
    vertices.push(profile[last].center);
    let mut bands = Bands { frame, directions, surface: TriangleSurface::of_vertices(vertices) };
    for (row, stops) in (0_u32..).zip(profile.windows(2)) {
        bands.push(row, usize::try_from(row).is_ok_and(|row| row + 1 == last), stops);
    }
    bands.surface
}

/// The surface under construction, band by band.
struct Bands<'a, N: Real> {
    frame: &'a RevolutionFrame<N>,
    directions: Vec<Vector<N, 2>>,
    surface: TriangleSurface<N>,
}

impl<N: Real> Bands<'_, N> {
    /// Adds the band between the stops `row` and `row + 1`.
    ///
    /// Seen from outside, with the far end of the axis up, directions run to the left: they turn
    /// from the frame's first vector to its third, and the frame is right-handed.
    fn push(&mut self, row: u32, is_last: bool, stops: &[Stop<N>]) {
        let count = u32::try_from(self.directions.len()).expect("a turn has few parts");
        let ring = |row: u32, column: u32| 1 + (row - 1) * count + column;
        for column in 0..count {
            let next = (column + 1) % count;
            let upper = |column| if row == 0 { 0 } else { ring(row, column) };
            let lower = |column| ring(row + 1, if is_last { 0 } else { column });
            let columns = [column, next];
            let normals = [
                self.normals(&stops[0].after, columns, row == 0),
                self.normals(&stops[1].before, columns, is_last),
            ];
            if !is_last {
                self.surface.triangles.push([lower(column), upper(next), lower(next)]);
                self.surface.normals.push([normals[1][0], normals[0][1], normals[1][1]]);
            }
            if row > 0 {
                self.surface.triangles.push([lower(column), upper(column), upper(next)]);
                self.surface.normals.push([normals[1][0], normals[0][0], normals[0][1]]);
            }
        }
    }

    /// Returns the normals at two neighbouring columns. At a pole both are the normal midway
    /// between the columns.
    fn normals(
        &self,
        profile: &Vector<N, 2>,
        columns: [u32; 2],
        is_pole: bool,
    ) -> [Vector<N, 3>; 2] {
        if is_pole {
            let count = u32::try_from(self.directions.len()).expect("a turn has few parts");
            let middle = direction(2 * columns[0] + 1, 2 * count);
            return [self.frame.normal(profile, &middle); 2];
        }
        columns.map(|column| self.frame.normal(profile, &self.directions[column as usize]))
    }
}
