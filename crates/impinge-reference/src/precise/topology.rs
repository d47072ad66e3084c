//! Faces and edges of the hull of a few points, as numbers of corners.
//!
//! As in [`crate::geometry`], a plane through D corners that has all others on one side is a face,
//! and two corners that share two faces are joined by an edge; the lists may hold more than the true
//! features, never less.

use super::number::Quad;
use super::vector::{Vector, dot, exact, norm, perpendicular, sub};

/// What a hull can touch another with, besides its corners.
#[derive(Clone, Debug)]
pub(super) struct Topology<const D: usize> {
    /// D corners of each face; none where all points lie on a line of space or coincide.
    pub(super) faces: Vec<[usize; D]>,
    /// Both ends of each edge; none in the plane, where edges are faces.
    pub(super) edges: Vec<[usize; 2]>,
}

/// A plane with no point in front of it.
struct Face<const D: usize> {
    corners: [usize; D],
    /// All points on the plane.
    on: Vec<usize>,
    /// How far from collinear the corners are, at most 1.
    quality: f64,
}

impl<const D: usize> Topology<D> {
    /// The features of the hull of some points, each given once. The cost grows with the fourth
    /// power of their number in space.
    pub(super) fn new(points: &[[f64; D]]) -> Self {
        let points: Vec<Vector<D>> = points.iter().map(exact).collect();
        let faces = faces(&points);
        let edges = if D == 3 { edges(points.len(), &faces) } else { Vec::new() };
        Self { faces: faces.iter().map(|face| face.corners).collect(), edges }
    }
}

/// One face per set of coplanar points, through those that are farthest from collinear.
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

/// The next ascending choice of D numbers below `count`; its last number is `count` after the last
/// one.
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

/// The plane through some points, if no other lies in front of it (for the normal of one sign or of
/// the other).
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

/// The pairs of points that share two faces; all pairs if the points lie in one plane or on one line.
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
