//! Converts the faces of a file to the triangles of a valid mesh.

use impinge::math::na::Vector3;

use super::MeshPart;
use super::raw::RawPart;
use super::report::MeshReport;
use super::topology::examine;
use super::triangulate::Triangulator;

/// Marks a vertex that is dropped because one of its coordinates is not finite.
const NONE: u32 = u32::MAX;

/// A triangle, and the index of its face in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) corners: [u32; 3],
    pub(super) face: usize,
}

/// Welds vertices at equal positions, triangulates polygons, drops degenerate and duplicate
/// triangles, and reports the defects.
pub(super) fn repaired(raw: RawPart) -> MeshPart {
    let mut report = MeshReport::default();
    let welded = weld(&raw, &mut report);
    let mut pieces = pieces(&raw, &welded, &mut report);
    drop_duplicates(&raw, &mut pieces, &mut report);
    let (vertices, triangles) = compact(&raw, &pieces);
    (report.vertices, report.triangles) = (vertices.len(), triangles.len());
    let origin = |triangle: usize| (pieces[triangle].face, raw.line(pieces[triangle].face));
    examine(&vertices, &triangles, origin, &mut report);
    MeshPart { name: raw.name, vertices, triangles, report }
}

/// Returns, for each vertex, the index of the first vertex at the same position; [`NONE`] if a
/// coordinate is not finite.
fn weld(raw: &RawPart, report: &mut MeshReport) -> Vec<u32> {
    let mut welded = vec![NONE; raw.vertices.len()];
    let is_finite = |index: &u32| raw.vertices[*index as usize].iter().all(|x| x.is_finite());
    let mut order: Vec<u32> = (0..NONE).take(raw.vertices.len()).filter(is_finite).collect();
    // Adding 0 converts -0 to 0, so both zeros are the same position.
    let key = |index: &u32| raw.vertices[*index as usize].map(|x| x + 0.0);
    order.sort_unstable_by(|a, b| {
        let [a_key, b_key] = [key(a), key(b)];
        let pairs = a_key.iter().zip(&b_key);
        let by_position = pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
        by_position.unwrap_or_else(|| a.cmp(b))
    });
    for group in order.chunk_by(|a, b| key(a) == key(b)) {
        group.iter().for_each(|index| welded[*index as usize] = group[0]);
    }
    for (index, first) in welded.iter().enumerate() {
        if *first == NONE {
            report.non_finite_vertices.add(index, None);
        } else if *first as usize != index && !raw.is_soup {
            report.duplicate_vertices.add(index, None);
        }
    }
    welded
}

/// Triangulates the faces, and returns the triangles whose corners are not collinear up to
/// rounding. Reports the dropped faces, except faces with a vertex that is not finite: [`weld`]
/// reports these vertices.
fn pieces(raw: &RawPart, welded: &[u32], report: &mut MeshReport) -> Vec<Piece> {
    let mut triangulator = Triangulator::new();
    let mut pieces = Vec::new();
    let mut corners = Vec::new();
    for line in &raw.out_of_range {
        report.out_of_range.add(0, Some(*line));
    }
    for (face, given) in raw.faces().enumerate() {
        let line = raw.line(face);
        if given.iter().any(|corner| *corner as usize >= welded.len()) {
            report.out_of_range.add(face, line);
            continue;
        }
        corners.clear();
        corners.extend(given.iter().map(|corner| welded[*corner as usize]));
        if corners.contains(&NONE) {
            continue;
        }
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        let before = pieces.len();
        if corners.len() >= 3 {
            let cut = triangulator.cut(&corners, &raw.vertices).into_iter();
            let cut = cut.filter(|corners| has_area(*corners, &raw.vertices));
            pieces.extend(cut.map(|corners| Piece { corners, face }));
        }
        report.polygons += usize::from(corners.len() > 3 && pieces.len() > before);
        if pieces.len() == before {
            report.degenerate.add(face, line);
        }
    }
    pieces
}

/// Returns `true` if the corners are not collinear, up to rounding.
fn has_area(corners: [u32; 3], vertices: &[[f64; 3]]) -> bool {
    let [a, b, c] = corners.map(|corner| Vector3::from(vertices[corner as usize]));
    // Scaling by the largest coordinate of the edges prevents overflow and underflow of products.
    let [ab, ac] = [b - a, c - a];
    let size = ab.amax().max(ac.amax());
    let cross = (ab / size).cross(&(ac / size));
    cross.amax() > f64::EPSILON && cross.iter().all(|x| x.is_finite())
}

/// Drops each triangle that has the corners and the orientation of an earlier triangle.
fn drop_duplicates(raw: &RawPart, pieces: &mut Vec<Piece>, report: &mut MeshReport) {
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    let key = |index: &usize| rotated(pieces[*index].corners);
    order.sort_unstable_by_key(|index| (key(index), *index));
    let mut is_double = vec![false; pieces.len()];
    for group in order.chunk_by(|a, b| key(a) == key(b)) {
        group[1..].iter().for_each(|index| is_double[*index] = true);
    }
    let mut doubles = is_double.into_iter();
    pieces.retain(|piece| {
        let is_double = doubles.next().unwrap_or_default();
        if is_double {
            report.duplicate_triangles.add(piece.face, raw.line(piece.face));
        }
        !is_double
    });
}

/// Rotates the corners so that the smallest comes first.
fn rotated([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Returns the vertices that triangles use, in the order of the file, and the triangles with
/// indices of these vertices.
fn compact(raw: &RawPart, pieces: &[Piece]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut number = vec![NONE; raw.vertices.len()];
    pieces.iter().flat_map(|piece| piece.corners).for_each(|corner| number[corner as usize] = 0);
    let mut vertices = Vec::new();
    for (vertex, number) in raw.vertices.iter().zip(&mut number).filter(|(_, n)| **n == 0) {
        *number = u32::try_from(vertices.len()).unwrap_or(NONE);
        vertices.push(*vertex);
    }
    let renumber = |corner: u32| number[corner as usize];
    let triangles = pieces.iter().map(|piece| piece.corners.map(renumber)).collect();
    (vertices, triangles)
}
