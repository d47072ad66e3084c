//! Computes the corners, edges and faces of a convex hull without any topology. A plane through D
//! corners with all others on one side is a face. Two corners that share two faces are joined by an
//! edge.
//!
//! The lists contain every true feature, and may contain more, such as a diagonal of a face that is
//! flat up to rounding. Extra features do no harm: each gives one more candidate direction, whose
//! separation is then measured.

use super::pose::Pose;
use super::vector::{axis, dot, norm, perpendicular, scale, sub, unit};

/// The vertices, edges and face normals of a convex hull.
#[derive(Clone, Debug)]
pub(super) struct Features<const D: usize> {
    /// The distinct points, in the order of their first appearance; interior points are kept.
    pub(super) vertices: Vec<[f64; D]>,
    /// For each edge, one end and the unit direction. Empty in 2D, where the edges are the faces.
    pub(super) edges: Vec<([f64; D], [f64; D])>,
    /// The unit directions of the edges without repetition. Opposite directions count as equal.
    pub(super) directions: Vec<[f64; D]>,
    /// A unit normal of each face, of either sign. Without faces: if the points lie on a line in
    /// 3D, some directions perpendicular to the line; if they coincide, the axes.
    pub(super) normals: Vec<[f64; D]>,
}

/// A plane through D or more points that has all other points on one side.
struct Face<const D: usize> {
    normal: [f64; D],
    /// The indices of the points on the plane.
    on: Vec<usize>,
    /// The length of the product of the sides at the first defining point (in 3D the cross product,
    /// in 2D the side itself), after division of the sides by the size of the hull: 0 if the
    /// defining points are collinear. The larger it is, the more accurate is the normal.
    quality: f64,
}

impl<const D: usize> Features<D> {
    /// Computes all features of the convex hull of `points`. In 3D the time grows with the fourth
    /// power of the number of points.
    pub(super) fn new(points: &[[f64; D]]) -> Self {
        let vertices = distinct(points);
        let faces = faces(&vertices);
        let edges = if D == 3 { edges(&vertices, &faces) } else { Vec::new() };
        let directions = distinct_lines(&edges);
        let normals = if faces.is_empty() {
            normals_of_a_line_or_point(&directions)
        } else {
            faces.iter().map(|face| face.normal).collect()
        };
        Self { vertices, edges, directions, normals }
    }

    /// Returns the features transformed by `pose`.
    pub(super) fn placed(&self, pose: &Pose<D>) -> Self {
        let rotate = |list: &[[f64; D]]| list.iter().map(|v| pose.rotate(v)).collect();
        Self {
            vertices: self.vertices.iter().map(|v| pose.apply(v)).collect(),
            edges: self.edges.iter().map(|(p, u)| (pose.apply(p), pose.rotate(u))).collect(),
            directions: rotate(&self.directions),
            normals: rotate(&self.normals),
        }
    }
}

/// Returns the points without exact repetitions, in the order of their first appearance.
fn distinct<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
    let mut kept: Vec<[f64; D]> = Vec::new();
    for point in points {
        if !kept.contains(point) {
            kept.push(*point);
        }
    }
    kept
}

/// Returns one face for each set of coplanar corners, through those defining corners that give the
/// largest `quality`.
fn faces<const D: usize>(vertices: &[[f64; D]]) -> Vec<Face<D>> {
    let size = vertices.iter().map(|v| norm(&sub(v, &vertices[0]))).fold(0.0, f64::max);
    let mut kept: Vec<Face<D>> = Vec::new();
    for corners in subsets(vertices.len(), D) {
        let Some(face) = face_through(vertices, &corners, size) else { continue };
        match kept.iter_mut().find(|other| other.on == face.on) {
            None => kept.push(face),
            Some(other) if other.quality < face.quality => *other = face,
            Some(_) => (),
        }
    }
    kept
}

/// Returns all sets of `size` indices below `count`, each in ascending order; `size` is 2 or 3.
fn subsets(count: usize, size: usize) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = (0..count).map(|i| vec![i]).collect();
    for _ in 1..size {
        sets = sets
            .iter()
            .flat_map(|set| {
                let next = set.last().map_or(0, |last| last + 1);
                (next..count).map(move |i| [set.as_slice(), &[i]].concat())
            })
            .collect();
    }
    sets
}

/// Returns the plane through D corners if all other corners lie on one side of it or on it. Returns
/// `None` if corners lie on both sides, or if the D corners are coincident or collinear.
///
/// A corner counts as on the plane if its height is within the rounding error, which grows as `1 /
/// quality`. `size` is the largest distance of a corner from the first corner. The sign of the
/// normal is arbitrary.
fn face_through<const D: usize>(
    vertices: &[[f64; D]],
    corners: &[usize],
    size: f64,
) -> Option<Face<D>> {
    let origin = vertices[corners[0]];
    let shrunk: [[f64; D]; D] =
        std::array::from_fn(|k| scale(&sub(&vertices[corners[k]], &origin), 1.0 / size));
    let product = perpendicular(&shrunk[1..]);
    let quality = norm(&product);
    if quality <= 1e-15 {
        return None;
    }
    let normal = scale(&product, 1.0 / quality);
    let slack = 1e-14 * size / quality.min(1.0);
    let (mut behind, mut before) = (false, false);
    let mut on = Vec::new();
    for (index, vertex) in vertices.iter().enumerate() {
        let height = dot(&sub(vertex, &origin), &normal);
        if corners.contains(&index) || height.abs() <= slack {
            on.push(index);
        } else if height < 0.0 {
            behind = true;
        } else {
            before = true;
        }
        if behind && before {
            return None;
        }
    }
    Some(Face { normal, on, quality })
}

/// Returns a point and the unit direction of each edge: pairs of corners that share two faces. If
/// all corners lie in one plane or on one line, all pairs count as edges.
fn edges<const D: usize>(vertices: &[[f64; D]], faces: &[Face<D>]) -> Vec<([f64; D], [f64; D])> {
    let flat = faces.iter().all(|face| face.on.len() == vertices.len());
    let shares = |i: usize, j: usize| {
        faces.iter().filter(|face| face.on.contains(&i) && face.on.contains(&j)).count() >= 2
    };
    subsets(vertices.len(), 2)
        .into_iter()
        .filter(|pair| flat || shares(pair[0], pair[1]))
        .filter_map(|pair| {
            let along = unit(&sub(&vertices[pair[1]], &vertices[pair[0]]))?;
            Some((vertices[pair[0]], along))
        })
        .collect()
}

/// Returns the directions of the edges without those that are parallel to an earlier one within
/// 1e-15.
fn distinct_lines<const D: usize>(edges: &[([f64; D], [f64; D])]) -> Vec<[f64; D]> {
    let mut kept: Vec<[f64; D]> = Vec::new();
    for (_, direction) in edges {
        let same = |other: &[f64; D]| {
            let flipped = scale(other, dot(other, direction).signum());
            norm(&sub(&flipped, direction)) <= 1e-15
        };
        if !kept.iter().any(same) {
            kept.push(*direction);
        }
    }
    kept
}

/// Returns directions perpendicular to the lines in 3D; all axes if `directions` is empty, because
/// the hull is a single point.
fn normals_of_a_line_or_point<const D: usize>(directions: &[[f64; D]]) -> Vec<[f64; D]> {
    let axes: Vec<[f64; D]> = (0..D).map(axis).collect();
    if directions.is_empty() {
        return axes;
    }
    directions
        .iter()
        .flat_map(|line| axes.iter().filter_map(|axis| unit(&perpendicular(&[*line, *axis]))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::solid::Solid;
    use super::*;

    fn of<const D: usize>(solid: &Solid<D>) -> Features<D> {
        let Solid::Rounded { vertices, .. } = solid else { unreachable!() };
        Features::new(vertices)
    }

    #[test]
    fn counts_of_a_box() {
        let features = of(&Solid::cuboid([1.0, 2.0, 3.0]));
        assert_eq!(features.vertices.len(), 8);
        assert_eq!(features.edges.len(), 12);
        assert_eq!(features.directions.len(), 3);
        assert_eq!(features.normals.len(), 6);
        assert_eq!(of(&Solid::cuboid([1.0, 2.0])).normals.len(), 4);
    }

    #[test]
    fn counts_of_flat_and_thin_shapes() {
        let plate = of(&Solid::cuboid([1.0, 0.0, 3.0]));
        assert_eq!((plate.vertices.len(), plate.edges.len(), plate.normals.len()), (4, 6, 1));
        let rod = of(&Solid::cuboid([0.0, 0.0, 3.0]));
        assert_eq!((rod.vertices.len(), rod.edges.len(), rod.normals.len()), (2, 1, 2));
        let dot = of(&Solid::cuboid([0.0, 0.0, 0.0]));
        assert_eq!((dot.vertices.len(), dot.edges.len(), dot.normals.len()), (1, 0, 3));
    }

    #[test]
    fn counts_of_a_pyramid_with_an_inner_point() {
        let points = vec![
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, 0.5],
        ];
        let features = of(&Solid::polytope(points));
        assert_eq!(features.normals.len(), 5);
        assert_eq!(features.edges.len(), 8);
    }
}
