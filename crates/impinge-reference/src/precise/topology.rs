//! Faces and edges of the hull of a few points, as indices of points.
//!
//! As in [`crate::geometry`], a plane through D corners with all others on one side is a face, and
//! two corners that share two faces are joined by an edge. The lists contain all true features, and
//! may contain more.

use super::number::Quad;
use super::vector::{Vector, dot, exact, norm, perpendicular, sub};

/// The faces and edges of a hull.
#[derive(Clone, Debug)]
pub(super) struct Topology<const D: usize> {
    /// The indices of D corners of each face. Empty if the points lie on a line in 3D, or coincide.
    pub(super) faces: Vec<[usize; D]>,
    /// The indices of both ends of each edge. Empty in 2D, where the edges are the faces.
    pub(super) edges: Vec<[usize; 2]>,
}

/// A plane through D or more points that has all other points on one side.
struct Face<const D: usize> {
    corners: [usize; D],
    /// The indices of all points on the plane.
    on: Vec<usize>,
    /// The sine of the angle between the sides at the first corner: 0 if collinear; 1 in 2D.
    quality: f64,
}

impl<const D: usize> Topology<D> {
    /// Computes the features of the hull of some distinct points. In 3D the time grows with the
    /// fourth power of the number of points.
    pub(super) fn new(points: &[[f64; D]]) -> Self {
        let points: Vec<Vector<D>> = points.iter().map(exact).collect();
        let faces = faces(&points);
        let edges = if D == 3 { edges(points.len(), &faces) } else { Vec::new() };
        Self { faces: faces.iter().map(|face| face.corners).collect(), edges }
    }
}

/// Returns one face for each set of coplanar points, through those corners that give the largest
/// `quality`.
fn faces<const D: usize>(points: &[Vector<D>]) -> Vec<Face<D>> {
    let mut kept: Vec<Face<D>> = Vec::new();
    let mut corners = std::array::from_fn(|i| i);
    while corners[D - 1] < points.len() {
        if let Some(face) = face_through(points, corners) {
            match kept.iter_mut().find(|other| other.on == face.on) {
                None => kept.push(face),
                Some(other) if other.quality < face.quality => *other = face,
                Some(_) => (),
            }
        }
        corners = next(corners, points.len());
    }
    kept
}

/// Returns the next ascending choice of D indices below `count`. After the last choice, the last
/// index of the result is `count`.
fn next<const D: usize>(mut chosen: [usize; D], count: usize) -> [usize; D] {
    for place in (0..D).rev() {
        if chosen[place] + (D - place) < count || place == 0 {
            chosen[place] += 1;
            for later in place + 1..D {
                chosen[later] = chosen[later - 1] + 1;
            }
            break;
        }
    }
    chosen
}

/// Returns the plane through D points if all other points lie on one side of it or on it; `None`
/// otherwise, and if the points are collinear.
fn face_through<const D: usize>(points: &[Vector<D>], corners: [usize; D]) -> Option<Face<D>> {
    let origin = &points[corners[0]];
    let spans: Vec<Vector<D>> = corners[1..].iter().map(|&k| sub(&points[k], origin)).collect();
    let normal = perpendicular(&spans);
    let lengths = spans.iter().fold(1.0, |product, span| product * norm(span).to_f64());
    let quality = norm(&normal).to_f64() / lengths;
    let thick = quality > 1e-25;
    if !thick {
        return None;
    }
    let (mut behind, mut before, mut on) = (false, false, Vec::new());
    for (index, point) in points.iter().enumerate() {
        let offset = sub(point, origin);
        let slack = Quad::new(1e-28 * norm(&offset).to_f64() * lengths);
        let height = dot(&offset, &normal);
        if corners.contains(&index) || height.abs() <= slack {
            on.push(index);
        } else {
            behind |= height < Quad::ZERO;
            before |= height > Quad::ZERO;
        }
        if behind && before {
            return None;
        }
    }
    Some(Face { corners, on, quality })
}

/// Returns the pairs of points that share two faces; all pairs if the points lie in one plane or on
/// one line.
fn edges<const D: usize>(count: usize, faces: &[Face<D>]) -> Vec<[usize; 2]> {
    let flat = faces.iter().all(|face| face.on.len() == count);
    let shares = |i: usize, j: usize| {
        faces.iter().filter(|face| face.on.contains(&i) && face.on.contains(&j)).count() >= 2
    };
    let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| [i, j]));
    pairs.filter(|&[i, j]| flat || shares(i, j)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_choices_are_visited_once() {
        let (mut chosen, mut seen) = ([0, 1, 2], Vec::new());
        while chosen[2] < 6 {
            seen.push(chosen);
            chosen = next(chosen, 6);
        }
        assert_eq!(seen.len(), 20, "6 over 3");
        assert!(seen.is_sorted() && seen.iter().all(|c| c.is_sorted()), "{seen:?}");
    }

    #[test]
    fn counts_of_a_box_a_square_and_a_rod() {
        let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { 0.1 } else { -0.3 });
        let cube = Topology::<3>::new(&(0..8).map(corner).collect::<Vec<_>>());
        assert_eq!((cube.faces.len(), cube.edges.len()), (6, 12));
        let square = Topology::<2>::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!((square.faces.len(), square.edges.len()), (4, 0));
        let rod = Topology::<3>::new(&[[0.0; 3], [1.0, 2.0, 3.0]]);
        assert_eq!((rod.faces.len(), rod.edges.len()), (0, 1));
    }
}
