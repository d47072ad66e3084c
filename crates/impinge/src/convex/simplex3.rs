//! Simplices in 3D: points, segments, triangles, tetrahedra.

use super::difference::{Difference, rounding_error};
use super::simplex::{NearestOfSimplex, Simplex, Simplicial, nearest_on_segment};
use super::{Separation, epa3};
use crate::math::{Mapped, Real, Vector, cross, max};

impl<N: Real> Simplicial<3> for N {
    fn nearest(points: &[Vector<N, 3>]) -> NearestOfSimplex<N, 3> {
        match points {
            [point] => NearestOfSimplex::corner(0, point),
            [_, _] => nearest_on_segment(points, [0, 1]),
            [_, _, _] => nearest_on_triangle(points, [0, 1, 2]),
            _ => nearest_in_tetrahedron(points),
        }
    }

    fn clears(points: &[Vector<N, 3>], radius: N) -> bool {
        let is_clear = |[i, j, k]: [usize; 3]| {
            let normal = cross(&(points[j] - points[i]), &(points[k] - points[i]));
            let height = normal.dot(&points[i]);
            height * height > radius * radius * normal.norm_squared()
        };
        points.len() == 4 && FACES.into_iter().all(is_clear)
    }

    fn visit_facets(points: &[Vector<N, 3>], visit: &mut dyn FnMut(&Vector<N, 3>)) {
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                for c in &points[j + 1..] {
                    visit(&cross(&(b - a), &(c - a)));
                }
            }
        }
    }

    fn deepest(difference: &dyn Difference<N, 3>, simplex: &Simplex<N, 3>) -> Separation<N, 3> {
        epa3::deepest(difference, simplex)
    }
}

/// Returns the point of a triangle nearest to the origin. For a triangle flatter than
/// `rounding_error`, only its sides are searched.
fn nearest_on_triangle<N: Real>(
    points: &[Vector<N, 3>],
    [i, j, k]: [usize; 3],
) -> NearestOfSimplex<N, 3> {
    let (a, b, c) = (&points[i], &points[j], &points[k]);
    let (e, f) = (b - a, c - a);
    let normal = cross(&e, &f);
    let squared = normal.norm_squared();
    let longest = max(max(e.norm_squared(), f.norm_squared()), (c - b).norm_squared());
    let flat = squared <= rounding_error::<N>() * rounding_error::<N>() * longest;
    // Barycentric coordinates of the origin's projection. Their errors are inversely proportional
    // to the triangle's smallest height, not to its square.
    let (on_b, on_c) = (-normal.dot(&cross(a, &f)) / squared, -normal.dot(&cross(&e, a)) / squared);
    let on_a = N::ONE - on_b - on_c;
    let mut best: Option<NearestOfSimplex<N, 3>> = None;
    for (weight, side) in [(on_a, [j, k]), (on_b, [k, i]), (on_c, [i, j])] {
        if flat || weight <= N::ZERO {
            let found = nearest_on_segment(points, side);
            // The origin projects beyond a side and between its ends, so no other point of the
            // triangle is nearer.
            if !flat && found.weighs(side) {
                return found;
            }
            best = Some(found.or_nearer(best));
        }
    }
    best.unwrap_or_else(|| {
        let mut weights = [N::ZERO; 4];
        (weights[i], weights[j], weights[k]) = (on_a, on_b, on_c);
        NearestOfSimplex::new(normal * (normal.dot(a) / squared), weights)
    })
}

/// The four faces; face `i` is opposite to corner `i`.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

fn nearest_in_tetrahedron<N: Real>(points: &[Vector<N, 3>]) -> NearestOfSimplex<N, 3> {
    // Six times the signed volumes of the tetrahedron and of its four parts, each with a corner
    // replaced by the origin.
    let (mut parts, mut largest) = ([N::ZERO; 4], N::ZERO);
    let mut volume = N::ZERO;
    for (corner, [i, j, k]) in FACES.into_iter().enumerate() {
        let normal = cross(&(points[j] - points[i]), &(points[k] - points[i]));
        parts[corner] = normal.dot(&points[i]);
        volume = normal.dot(&(points[i] - points[corner]));
        largest = max(largest, normal.norm_squared());
    }
    // If the height over the largest face is below the rounding error, the signs are unknown, and
    // all four faces are searched.
    let flat = volume * volume <= rounding_error::<N>() * rounding_error::<N>() * largest;
    let mut best: Option<NearestOfSimplex<N, 3>> = None;
    for (part, face) in parts.into_iter().zip(FACES) {
        if flat || part * volume <= N::ZERO {
            let found = nearest_on_triangle(points, face);
            // The origin is beyond a face and projects into it, so no other point of the
            // tetrahedron is nearer.
            if !flat && found.weighs(face) {
                return found;
            }
            best = Some(found.or_nearer(best));
        }
    }
    best.unwrap_or_else(|| NearestOfSimplex::enclosed(parts.mapped(|part| part / volume)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(points: &[[f64; 3]]) -> NearestOfSimplex<f64, 3> {
        let points: Vec<_> = points.iter().map(|&p| Vector::<f64, 3>::from(p)).collect();
        <f64 as Simplicial<3>>::nearest(&points)
    }

    const CORNER: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];

    fn moved(offset: [f64; 3]) -> Vec<[f64; 3]> {
        CORNER.iter().map(|p| [p[0] + offset[0], p[1] + offset[1], p[2] + offset[2]]).collect()
    }

    #[test]
    fn features_of_a_tetrahedron() {
        let inside = nearest(&moved([-1.0, -1.0, -1.0]));
        assert!(inside.enclosed, "the origin is inside");
        assert_eq!(inside.weights, [0.25; 4], "at the point (1, 1, 1) of the corner of a cube");
        let face = nearest(&moved([-1.0, -1.0, 2.0]));
        assert_eq!(face.point, Vector::<f64, 3>::new(0.0, 0.0, 2.0), "under the face z = 0");
        assert_eq!(face.weights, [0.5, 0.25, 0.25, 0.0], "of three corners");
        let edge = nearest(&moved([-1.0, 3.0, 4.0]));
        assert_eq!((edge.squared, edge.weights[0], edge.weights[1]), (25.0, 0.75, 0.25), "edge");
        assert_eq!(nearest(&moved([1.0, 2.0, 2.0])).squared, 9.0, "the corner itself");
    }

    #[test]
    fn flat_tetrahedra_fall_back_to_faces() {
        let square = [[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [1.0, 1.0, 0.5], [-1.0, 1.0, 0.5]];
        let flat = nearest(&square);
        assert!(!flat.enclosed, "no volume");
        assert_eq!(flat.point, Vector::<f64, 3>::new(0.0, 0.0, 0.5), "in the square");
        let line = nearest(&[[-1.0, 0.5, 0.0], [0.5, 0.5, 0.0], [1.0, 0.5, 0.0], [2.0, 0.5, 0.0]]);
        assert_eq!(line.squared, 0.25, "on a line");
    }
}
