//! Exact crossings of an axis-parallel ray with a closed line or surface.
//!
//! The winding number of a closed line or surface around a point is the number of times that a ray
//! from the point leaves it, minus the number of times that the ray enters it. Exact signs decide
//! whether the ray crosses a segment or triangle. Ties, where the ray meets corners or sides, are
//! resolved as if the point were moved by an infinitesimal step across the ray; the step is the
//! same for all parts (Edelsbrunner and Mücke, "Simulation of Simplicity", 1990; in 2D this is the
//! half-open rule). So exactly one of two neighbours counts a crossing of their common corner or
//! side, and no direction of the ray is degenerate.

use core::cmp::Ordering;

use crate::math::exact::{area, volume};
use crate::math::{Mapped, Point};

/// The direction of a ray from a point to infinity along a coordinate axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayDirection {
    pub(super) axis: usize,
    /// Whether the ray leads towards larger coordinates.
    pub(super) is_ascending: bool,
}

/// The contribution of one part to the winding number; `None` only for a point on the part.
type Added = Option<i64>;

/// Returns the sign of a determinant: 1, −1, or 0 (also for NaN).
fn sign(determinant: f64) -> i64 {
    match determinant.partial_cmp(&0.0) {
        Some(Ordering::Greater) => 1,
        Some(Ordering::Less) => -1,
        _ => 0,
    }
}

/// Returns the contribution of a segment in 2D, whose left is inside. A point at an end of the
/// segment, or on a segment parallel to the ray, may go undetected; the result is then the
/// contribution around a point beside the segment.
pub(super) fn of_segment(
    ends: [Point<f64, 2>; 2],
    point: &Point<f64, 2>,
    direction: RayDirection,
) -> Added {
    let across = 1 - direction.axis;
    let at = point[across];
    let rises = ends[0][across] <= at && at < ends[1][across];
    let falls = ends[1][across] <= at && at < ends[0][across];
    if !rises && !falls {
        return Some(0);
    }
    let side = sign(area(&ends[0], &ends[1], point));
    // A rising segment that has the point on its left crosses the ray's line at a larger x than the
    // point's. For a ray along y, left and right are exchanged.
    let is_above = (rises == (side > 0)) == (direction.axis == 0);
    match side {
        0 => None,
        _ if is_above == direction.is_ascending => Some(side),
        _ => Some(0),
    }
}

/// Returns the contribution of a triangle in 3D, whose front is outside. A point on a side of the
/// triangle, or on a triangle parallel to the ray, may go undetected; the result is then the
/// contribution around a point beside the triangle.
pub(super) fn of_triangle(
    corners: [Point<f64, 3>; 3],
    point: &Point<f64, 3>,
    direction: RayDirection,
) -> Added {
    let project = |p: &Point<f64, 3>| {
        Point::<f64, 2>::new(p[(direction.axis + 1) % 3], p[(direction.axis + 2) % 3])
    };
    let around = winding_around(&corners.each_ref().mapped(project), &project(point));
    if around == 0 {
        return Some(0);
    }
    let side = sign(volume(&corners[0], &corners[1], &corners[2], point));
    // A triangle whose corners run counter-clockwise, seen from the positive end of the axis, has
    // its back towards points with smaller coordinates on the axis.
    let is_above = side * around < 0;
    match side {
        0 => None,
        _ if is_above == direction.is_ascending => {
            Some(if direction.is_ascending { around } else { -around })
        }
        _ => Some(0),
    }
}

/// Returns the winding number of three sides around a point in 2D: 0, or the sign of their turn. A
/// point on a side is treated as moved by (ε, ε²).
fn winding_around(corners: &[Point<f64, 2>; 3], point: &Point<f64, 2>) -> i64 {
    let one = |at: usize| {
        let (a, b) = (&corners[at], &corners[(at + 1) % 3]);
        let (rises, falls) = (a.y <= point.y && point.y < b.y, b.y <= point.y && point.y < a.y);
        if !rises && !falls {
            return 0;
        }
        let side = sign(area(a, b, point));
        let is_beside = if rises { side > 0 } else { side < 0 };
        if is_beside { side } else { 0 }
    };
    (0..3).map(one).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions(axes: usize) -> impl Iterator<Item = RayDirection> {
        (0..axes).flat_map(|axis| {
            [true, false].mapped(|is_ascending| RayDirection { axis, is_ascending })
        })
    }

    /// Around grid points inside and outside an outline of 8 segments, the rays along all axes give
    /// the right winding number, even if they run along segments and through corners. Points on the
    /// outline are not checked.
    #[test]
    fn an_outline_along_the_ray() {
        let ring = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]];
        let corner = |at: usize| Point::<f64, 2>::from(ring[at % 8].mapped(f64::from));
        for (x, y) in (-1..4).flat_map(|x| (-1..4).map(move |y| (x, y))) {
            let point = Point::<f64, 2>::new(f64::from(x), f64::from(y));
            let inside = x == 1 && y == 1;
            let on_line = !inside && (0..3).contains(&x) && (0..3).contains(&y);
            for direction in directions(2) {
                let each =
                    (0..8).map(|at| of_segment([corner(at), corner(at + 1)], &point, direction));
                let winding: Option<i64> = each.sum();
                let expected = Some(i64::from(inside));
                assert!(
                    winding == expected || on_line,
                    "{winding:?} at {point} along {direction:?}"
                );
            }
        }
    }

    /// Around grid points inside and outside a cube whose faces are divided at the edge midpoints
    /// and face centres, the rays along all axes give the right winding number, even if they run
    /// along triangles and through corners. Points on the surface are not checked.
    #[test]
    fn a_surface_along_the_ray() {
        let mut triangles = Vec::new();
        for (axis, end) in (0..3).flat_map(|axis| [0.0, 2.0].mapped(|end| (axis, end))) {
            for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let at = |du: f64, dv: f64| {
                    let mut point = Point::<f64, 3>::origin();
                    (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) =
                        (end, u + du, v + dv);
                    point
                };
                let (a, b, c, d) = (at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0));
                let outward = [[a, b, c], [a, c, d]];
                let reversed = |[a, b, c]: [Point<f64, 3>; 3]| [a, c, b];
                triangles.extend(if end > 1.0 { outward } else { outward.mapped(reversed) });
            }
        }
        let steps = || (-1..6).map(|step| f64::from(step) * 0.5);
        for (x, y, z) in
            steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| (x, y, z))))
        {
            let point = Point::<f64, 3>::new(x, y, z);
            let inside = point.iter().all(|&x| x > 0.0 && x < 2.0);
            let on_surface = !inside && point.iter().all(|&x| (0.0..=2.0).contains(&x));
            for direction in directions(3) {
                let each = triangles.iter().map(|&corners| of_triangle(corners, &point, direction));
                let winding: Option<i64> = each.sum();
                let expected = Some(i64::from(inside));
                assert!(
                    winding == expected || on_surface,
                    "{winding:?} at {point} along {direction:?}"
                );
            }
        }
    }
}
