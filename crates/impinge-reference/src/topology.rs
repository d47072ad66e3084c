//! Tests whether a list of faces is the convex hull of its vertices.
//!
//! Faces are lists of vertex indices, counter-clockwise seen from outside. Input is not repaired,
//! and each property is tested separately.

use crate::geometry::vector::{add, dot, norm, perpendicular, scale, sub};
use std::collections::{BTreeMap, BTreeSet};

/// A fault of a list of faces or of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A face or polygon has fewer than three vertices.
    TooFewVertices {
        /// The index of the face; zero for a polygon.
        face: usize,
    },
    /// A face names a vertex that does not exist.
    NoSuchVertex {
        /// The index of the face.
        face: usize,
    },
    /// A face or polygon contains a vertex twice.
    RepeatedVertex {
        /// The index of the face; zero for a polygon.
        face: usize,
    },
    /// Two faces have the same edge in the same direction.
    EdgeTwice {
        /// The vertex indices of the edge in that direction.
        edge: (usize, usize),
    },
    /// No face has this edge in the opposite direction.
    OpenEdge {
        /// The vertex indices of the edge in the direction of its face.
        edge: (usize, usize),
    },
    /// Vertices minus edges plus faces is not two, or the faces at a vertex form several fans. The
    /// surface has several components, a handle, or a vertex that joins components.
    Euler {
        /// The number of vertices that faces use.
        vertices: usize,
        /// The number of edges; both directions count as one edge.
        edges: usize,
        /// The number of faces.
        faces: usize,
    },
    /// A face has zero area, or a polygon has zero or negative area. The area of a clockwise
    /// polygon is negative.
    NoArea {
        /// The index of the face; zero for a polygon.
        face: usize,
    },
}

/// Checks that the faces form one closed surface without handles, in which each edge occurs once in
/// each direction.
///
/// # Errors
/// The first [`Fault`]. Faults of single faces and [`Fault::EdgeTwice`] are found in the order of
/// the faces, then [`Fault::OpenEdge`] for the least edge, then [`Fault::Euler`].
pub fn check_surface(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Result<(), Fault> {
    let mut edges = BTreeSet::new();
    for (index, face) in faces.iter().enumerate() {
        check_face(vertices, face, index)?;
        for edge in around(face) {
            if !edges.insert(edge) {
                return Err(Fault::EdgeTwice { edge });
            }
        }
    }
    if let Some(&edge) = edges.iter().find(|&&(from, to)| !edges.contains(&(to, from))) {
        return Err(Fault::OpenEdge { edge });
    }
    let used: BTreeSet<usize> = faces.iter().flatten().copied().collect();
    let (vertices, edges, count) = (used.len(), edges.len() / 2, faces.len());
    if vertices + count != edges + 2 || !vertices_have_one_fan(faces) {
        return Err(Fault::Euler { vertices, edges, faces: count });
    }
    Ok(())
}

fn check_face(vertices: &[[f64; 3]], face: &[usize], index: usize) -> Result<(), Fault> {
    if face.len() < 3 {
        return Err(Fault::TooFewVertices { face: index });
    }
    if face.iter().any(|&i| i >= vertices.len()) {
        return Err(Fault::NoSuchVertex { face: index });
    }
    let different: BTreeSet<usize> = face.iter().copied().collect();
    if different.len() < face.len() {
        return Err(Fault::RepeatedVertex { face: index });
    }
    if norm(&area(vertices, face)) <= 0.0 {
        return Err(Fault::NoArea { face: index });
    }
    Ok(())
}

/// Returns the directed edges of a face.
fn around(face: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..face.len()).map(|k| (face[k], face[(k + 1) % face.len()]))
}

/// Whether the faces at each vertex form a single closed fan: a walk around the vertex from face to
/// face visits all of them. The surface must be closed.
fn vertices_have_one_fan(faces: &[Vec<usize>]) -> bool {
    // For each vertex, a map between its neighbours: from the next vertex of each face to the
    // previous one, at which the adjacent face continues.
    let mut turns: BTreeMap<usize, BTreeMap<usize, usize>> = BTreeMap::new();
    for face in faces {
        for k in 0..face.len() {
            let (before, after) =
                (face[(k + face.len() - 1) % face.len()], face[(k + 1) % face.len()]);
            turns.entry(face[k]).or_default().insert(after, before);
        }
    }
    turns.values().all(|turn| {
        let start = turn.keys().next().copied();
        let walk = std::iter::successors(start, |at| turn.get(at).copied());
        let steps = walk.skip(1).take(turn.len()).position(|at| Some(at) == start);
        steps == Some(turn.len() - 1)
    })
}

/// Returns a vector along the outward normal whose length is twice the area of the face.
fn area(vertices: &[[f64; 3]], face: &[usize]) -> [f64; 3] {
    let origin = vertices[face[0]];
    let mut sum = [0.0; 3];
    for pair in face[1..].windows(2) {
        let spans = [sub(&vertices[pair[0]], &origin), sub(&vertices[pair[1]], &origin)];
        sum = add(&sum, &perpendicular(&spans));
    }
    sum
}

/// Returns the largest height of a point above the plane of a face. Negative if all points lie
/// strictly inside; minus infinity if there are no points or no faces.
///
/// With the vertices as `points` this tests convexity. The result is zero, up to rounding and the
/// deviation of faces from a plane, if and only if a closed surface is convex and its faces are
/// oriented outwards.
///
/// # Panics
/// If a face is empty or has the index of a vertex that does not exist; [`check_surface`] reports
/// both.
#[must_use]
pub fn highest_above(vertices: &[[f64; 3]], faces: &[Vec<usize>], points: &[[f64; 3]]) -> f64 {
    let mut highest = f64::NEG_INFINITY;
    for face in faces {
        let product = area(vertices, face);
        let normal = scale(&product, 1.0 / norm(&product));
        for point in points {
            highest = highest.max(dot(&normal, &sub(point, &vertices[face[0]])));
        }
    }
    highest
}

/// Returns the volume that a closed surface encloses; negative if its faces are oriented inwards.
///
/// # Panics
/// If a face is empty or has the index of a vertex that does not exist; [`check_surface`] reports
/// both.
#[must_use]
pub fn volume(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> f64 {
    let Some(origin) = faces.first().map(|face| vertices[face[0]]) else { return 0.0 };
    let cone = |face: &Vec<usize>| dot(&area(vertices, face), &sub(&vertices[face[0]], &origin));
    faces.iter().map(cone).sum::<f64>() / 6.0
}

/// Checks that a closed polygon has at least three corners, no corner twice, and a positive area. A
/// polygon with positive area is counter-clockwise.
///
/// # Errors
/// The first [`Fault`] in this order, with face 0.
pub fn check_polygon(corners: &[[f64; 2]]) -> Result<(), Fault> {
    if corners.len() < 3 {
        return Err(Fault::TooFewVertices { face: 0 });
    }
    if (1..corners.len()).any(|k| corners[..k].contains(&corners[k])) {
        return Err(Fault::RepeatedVertex { face: 0 });
    }
    if polygon_area(corners) <= 0.0 {
        return Err(Fault::NoArea { face: 0 });
    }
    Ok(())
}

/// Returns the area that a closed polygon encloses; positive if it is counter-clockwise.
#[must_use]
pub fn polygon_area(corners: &[[f64; 2]]) -> f64 {
    let Some(origin) = corners.first() else { return 0.0 };
    let cross =
        |pair: &[[f64; 2]]| dot(&perpendicular(&[sub(&pair[0], origin)]), &sub(&pair[1], origin));
    corners.windows(2).map(cross).sum::<f64>() / 2.0
}

/// Returns the largest distance of a point to the right of the line through an edge of a closed
/// polygon. Negative if all points lie to the left of all edges; minus infinity if there are no
/// points or no corners. With the corners as `points`, a polygon that passes [`check_polygon`]
/// gives zero, up to rounding, if and only if it is convex and counter-clockwise.
#[must_use]
pub fn farthest_outside(corners: &[[f64; 2]], points: &[[f64; 2]]) -> f64 {
    let mut farthest = f64::NEG_INFINITY;
    for (k, from) in corners.iter().enumerate() {
        let along = sub(&corners[(k + 1) % corners.len()], from);
        let left = scale(&perpendicular(&[along]), 1.0 / norm(&along));
        for point in points {
            farthest = farthest.max(-dot(&left, &sub(point, from)));
        }
    }
    farthest
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn tetrahedron() -> Vec<Vec<usize>> {
        vec![vec![0, 2, 1], vec![0, 3, 2], vec![0, 1, 3], vec![1, 2, 3]]
    }

    #[test]
    fn a_tetrahedron_passes() {
        assert_eq!(check_surface(&CORNERS, &tetrahedron()), Ok(()));
        assert_eq!(highest_above(&CORNERS, &tetrahedron(), &CORNERS), 0.0);
        assert!((volume(&CORNERS, &tetrahedron()) - 1.0 / 6.0).abs() < 1e-15, "volume");
        let outside = highest_above(&CORNERS, &tetrahedron(), &[[1.0, 1.0, 1.0]]);
        assert!((outside - 2.0 / 3f64.sqrt()).abs() < 1e-15, "outside {outside}");
    }

    #[test]
    fn faults_are_found() {
        let mut faces = tetrahedron();
        faces[3].reverse();
        assert_eq!(check_surface(&CORNERS, &faces), Err(Fault::EdgeTwice { edge: (3, 2) }));
        faces.pop();
        assert_eq!(check_surface(&CORNERS, &faces), Err(Fault::OpenEdge { edge: (1, 3) }));
        let mut faces = tetrahedron();
        faces[1] = vec![0, 3, 3];
        assert_eq!(check_surface(&CORNERS, &faces), Err(Fault::RepeatedVertex { face: 1 }));
        faces[1] = vec![0, 3, 9];
        assert_eq!(check_surface(&CORNERS, &faces), Err(Fault::NoSuchVertex { face: 1 }));
        let inward: Vec<Vec<usize>> =
            tetrahedron().into_iter().map(|face| face.into_iter().rev().collect()).collect();
        assert_eq!(check_surface(&CORNERS, &inward), Ok(()));
        assert!(highest_above(&CORNERS, &inward, &CORNERS) > 0.5, "faces look inward");
    }

    #[test]
    fn two_pieces_are_found() {
        let shifted = CORNERS.map(|corner| add(&corner, &[5.0, 0.0, 0.0]));
        let vertices = [CORNERS, shifted].concat();
        let second = tetrahedron().into_iter().map(|face| face.iter().map(|i| i + 4).collect());
        let faces: Vec<Vec<usize>> = tetrahedron().into_iter().chain(second).collect();
        assert_eq!(
            check_surface(&vertices, &faces),
            Err(Fault::Euler { vertices: 8, edges: 12, faces: 8 })
        );
        // Two surfaces joined at one vertex: this vertex has two fans.
        let glued: Vec<Vec<usize>> = faces
            .iter()
            .map(|face| face.iter().map(|&i| if i == 4 { 1 } else { i }).collect())
            .collect();
        assert_eq!(
            check_surface(&vertices, &glued),
            Err(Fault::Euler { vertices: 7, edges: 12, faces: 8 })
        );
    }

    #[test]
    fn polygons() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        assert_eq!(check_polygon(&square), Ok(()));
        assert_eq!(polygon_area(&square), 4.0);
        assert_eq!(farthest_outside(&square, &square), 0.0);
        assert_eq!(farthest_outside(&square, &[[1.0, 5.0], [1.5, 1.0]]), 3.0);
        let dented = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [0.0, 2.0]];
        assert!(farthest_outside(&dented, &dented) > 0.1, "dented");
        let clockwise = [[0.0, 0.0], [0.0, 2.0], [2.0, 0.0]];
        assert_eq!(check_polygon(&clockwise), Err(Fault::NoArea { face: 0 }));
        assert_eq!(check_polygon(&[[0.0; 2]; 3]), Err(Fault::RepeatedVertex { face: 0 }));
    }
}
