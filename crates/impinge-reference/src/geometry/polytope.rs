//! Signed distance of two convex polytopes by testing every candidate direction.
//!
//! The signed distance is the maximum of `h(n) = min n·b - max n·a` over the unit vectors n, with a
//! in the first and b in the second polytope. The maximum is taken in one of these directions:
//!
//! - If the polytopes are disjoint: along the line between the closest points. It is perpendicular
//!   to the features of these points: vertex and vertex, vertex and edge, vertex and face, or edge
//!   and edge.
//! - If they interpenetrate: along the normal of a face of the Minkowski difference. This is a face
//!   normal of one polytope, or perpendicular to an edge of each.
//! - If the difference is flat (both polytopes lie in one plane, or on one line) and contains the
//!   origin, the depth is zero along the thin direction, which is also a direction of the two kinds
//!   above.
//!
//! No direction gives more than the signed distance, so superfluous directions cost only time.

use super::features::Features;
use super::vector::{dot, negate, norm, perpendicular, reject, sub, unit};

/// The best direction so far.
struct Best<'a, const D: usize> {
    vertices1: &'a [[f64; D]],
    vertices2: &'a [[f64; D]],
    distance: f64,
    normal: [f64; D],
}

impl<const D: usize> Best<'_, D> {
    /// Tests a direction of any length and its opposite; ignores the zero vector.
    fn try_line(&mut self, direction: &[f64; D]) {
        let Some(normal) = unit(direction) else { return };
        let (least1, greatest1) = interval(self.vertices1, &normal);
        let (least2, greatest2) = interval(self.vertices2, &normal);
        self.offer(least2 - greatest1, normal);
        self.offer(least1 - greatest2, negate(&normal));
    }

    fn offer(&mut self, distance: f64, normal: [f64; D]) {
        if distance > self.distance {
            self.distance = distance;
            self.normal = normal;
        }
    }
}

/// Returns the least and the greatest `normal · v` over the points.
fn interval<const D: usize>(vertices: &[[f64; D]], normal: &[f64; D]) -> (f64, f64) {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for vertex in vertices {
        let height = dot(vertex, normal);
        range = (range.0.min(height), range.1.max(height));
    }
    range
}

/// Returns the signed distance of two polytopes in one frame, and the unit normal from the first to
/// the second along which it is measured. Accurate to a few roundings of the coordinates.
pub(super) fn distance<const D: usize>(one: &Features<D>, two: &Features<D>) -> (f64, [f64; D]) {
    let mut best = Best {
        vertices1: &one.vertices,
        vertices2: &two.vertices,
        distance: f64::NEG_INFINITY,
        normal: [0.0; D],
    };
    try_face_directions(&mut best, one, two);
    // If the origin lies strictly behind all faces of the difference, it lies inside. The
    // directions from corners would then only give smaller values. (A flat difference has a thin
    // direction with height zero or more, so its corners are tested.)
    let size = one.vertices.iter().chain(&two.vertices).map(norm).fold(0.0, f64::max);
    if best.distance >= -1e-12 * size {
        try_corner_directions(&mut best, one, two);
    }
    (best.distance, best.normal)
}

/// Tests the normals of the faces of the Minkowski difference.
fn try_face_directions<const D: usize>(
    best: &mut Best<'_, D>,
    one: &Features<D>,
    two: &Features<D>,
) {
    for normal in one.normals.iter().chain(&two.normals) {
        best.try_line(normal);
    }
    for edge1 in &one.directions {
        for edge2 in &two.directions {
            best.try_line(&perpendicular(&[*edge1, *edge2]));
        }
    }
}

/// Tests the lines from the corners of one polytope to the corners and edges of the other.
fn try_corner_directions<const D: usize>(
    best: &mut Best<'_, D>,
    one: &Features<D>,
    two: &Features<D>,
) {
    for vertex1 in &one.vertices {
        for vertex2 in &two.vertices {
            best.try_line(&sub(vertex2, vertex1));
        }
    }
    for (corners, edges) in [(&one.vertices, &two.edges), (&two.vertices, &one.edges)] {
        for vertex in corners {
            for (start, along) in edges {
                best.try_line(&reject(&sub(vertex, start), along));
            }
        }
    }
}
