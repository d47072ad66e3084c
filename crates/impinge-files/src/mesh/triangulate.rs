//! Triangulates polygons in 3D.

use earcut::Earcut;
use impinge::math::na::Vector3;

/// Triangulates polygons with Mapbox's earcut algorithm, in the coordinate plane in which the
/// projection of the polygon is largest.
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    outline: Vec<[f64; 2]>,
    cut: Vec<u32>,
}

impl Triangulator {
    pub(super) fn new() -> Self {
        Self { earcut: Earcut::new(), outline: Vec::new(), cut: Vec::new() }
    }

    /// Returns the triangles of a polygon, in the orientation of its corners. A triangle is
    /// returned unchanged. For a polygon with more corners, returns no triangles if its area is not
    /// finite. Corners must be valid indices of `vertices`.
    pub(super) fn cut(&mut self, corners: &[u32], vertices: &[[f64; 3]]) -> Vec<[u32; 3]> {
        if let &[a, b, c] = corners {
            return vec![[a, b, c]];
        }
        let points: Vec<Vector3<f64>> =
            corners.iter().map(|corner| vertices[*corner as usize].into()).collect();
        let normal = newell(&points);
        if !normal.iter().all(|x| x.is_finite()) {
            return Vec::new();
        }
        let dropped = normal.iamax();
        let axes = [(dropped + 1) % 3, (dropped + 2) % 3];
        self.outline.clear();
        // Coordinates are relative to the first corner, since products lose accuracy far from the
        // origin.
        let relative = points.iter().map(|point| point - points[0]);
        self.outline.extend(relative.map(|point| axes.map(|axis| point[axis])));
        self.earcut.earcut(self.outline.iter().copied(), &[], &mut self.cut);
        let is_front = normal[dropped] > 0.0;
        self.cut.chunks_exact(3).map(|cut| self.oriented(cut, is_front, corners)).collect()
    }

    /// Returns a triangle of the projected outline, in the orientation of the polygon.
    fn oriented(&self, cut: &[u32], is_front: bool, corners: &[u32]) -> [u32; 3] {
        let [a, b, c] = [cut[0], cut[1], cut[2]].map(|index| self.outline[index as usize]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let order = if (area > 0.0) == is_front { [0, 1, 2] } else { [0, 2, 1] };
        order.map(|index: usize| corners[cut[index] as usize])
    }
}

/// Returns twice the vector area of a polygon (Newell's method).
fn newell(points: &[Vector3<f64>]) -> Vector3<f64> {
    let (first, rest) = (points.first().copied().unwrap_or_default(), points.get(1..));
    let rest = rest.unwrap_or_default();
    let sides = rest.iter().zip(rest.iter().skip(1));
    sides.fold(Vector3::zeros(), |sum, (a, b)| sum + (a - first).cross(&(b - first)))
}
