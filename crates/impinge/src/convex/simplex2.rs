//! Simplices in 2D: points, segments, triangles.

use super::difference::{Difference, rounding_error};
use super::simplex::{NearestOfSimplex, Simplex, Simplicial, nearest_on_segment};
use super::{Separation, epa2};
use crate::math::{Real, Vector, cross2, max, perp};

impl<N: Real> Simplicial<2> for N {
    fn nearest(points: &[Vector<N, 2>]) -> NearestOfSimplex<N, 2> {
        match points {
            [point] => NearestOfSimplex::corner(0, point),
            [_, _] => nearest_on_side(points, [0, 1]),
            _ => nearest_in_triangle(points),
        }
    }

    fn clears(points: &[Vector<N, 2>], radius: N) -> bool {
        let is_clear = |[i, j]: [usize; 2]| {
            let area = cross2(&points[i], &points[j]);
            area * area > radius * radius * (points[j] - points[i]).norm_squared()
        };
        points.len() == 3 && SIDES.into_iter().all(is_clear)
    }

    fn visit_facets(points: &[Vector<N, 2>], visit: &mut dyn FnMut(&Vector<N, 2>)) {
        for (i, a) in points.iter().enumerate() {
            for b in &points[i + 1..] {
                visit(&perp(&(b - a)));
            }
        }
    }

    fn deepest(difference: &dyn Difference<N, 2>, simplex: &Simplex<N, 2>) -> Separation<N, 2> {
        epa2::deepest(difference, simplex)
    }
}

/// Returns the result of [`nearest_on_segment`]. A nearest point between the ends is computed as a
/// multiple of the edge's normal, so that in 2D its direction is accurate to rounding.
fn nearest_on_side<N: Real>(points: &[Vector<N, 2>], [i, j]: [usize; 2]) -> NearestOfSimplex<N, 2> {
    let nearest = nearest_on_segment(points, [i, j]);
    if nearest.weights[i] == N::ZERO || nearest.weights[j] == N::ZERO {
        return nearest;
    }
    let end = if nearest.weights[i] > N::HALF { &points[i] } else { &points[j] };
    let across = perp(&(points[j] - points[i]));
    NearestOfSimplex::new(across * (across.dot(end) / across.norm_squared()), nearest.weights)
}

/// The three sides; side `i` is opposite to corner `i`.
const SIDES: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

fn nearest_in_triangle<N: Real>(points: &[Vector<N, 2>]) -> NearestOfSimplex<N, 2> {
    let [a, b, c] = [points[0], points[1], points[2]];
    let (e, f) = (b - a, c - a);
    let area = cross2(&e, &f);
    let longest = max(max(e.norm_squared(), f.norm_squared()), (c - b).norm_squared());
    // If the triangle is flat up to rounding, the sign of its area is unknown, and all three sides
    // are searched.
    let flat = area * area <= rounding_error::<N>() * rounding_error::<N>() * longest;
    let (on_b, on_c) = (-cross2(&a, &f) / area, -cross2(&e, &a) / area);
    let weights = [N::ONE - on_b - on_c, on_b, on_c];
    let mut best: Option<NearestOfSimplex<N, 2>> = None;
    for (weight, side) in weights.into_iter().zip(SIDES) {
        if flat || weight <= N::ZERO {
            best = Some(nearest_on_side(points, side).or_nearer(best));
        }
    }
    best.unwrap_or(NearestOfSimplex::enclosed([weights[0], weights[1], weights[2], N::ZERO]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(points: &[[f64; 2]]) -> NearestOfSimplex<f64, 2> {
        let points: Vec<_> = points.iter().map(|&p| Vector::<f64, 2>::from(p)).collect();
        <f64 as Simplicial<2>>::nearest(&points)
    }

    #[test]
    fn features_of_a_triangle() {
        let inside = nearest(&[[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]]);
        assert!(inside.enclosed, "the origin is inside");
        assert_eq!(inside.weights, [0.25, 0.25, 0.5, 0.0], "hand-computed");
        let side = nearest(&[[-1.0, 1.0], [1.0, 1.0], [0.0, 2.0]]);
        assert_eq!((side.point.x, side.point.y), (0.0, 1.0), "the middle of the lower side");
        assert_eq!(side.weights, [0.5, 0.5, 0.0, 0.0], "of two corners");
        let corner = nearest(&[[1.0, 1.0], [3.0, 1.0], [2.0, 4.0]]);
        assert_eq!(corner.weights, [1.0, 0.0, 0.0, 0.0], "the corner");
    }

    #[test]
    fn flat_triangles_fall_back_to_sides() {
        let flat = nearest(&[[-1.0, 0.5], [0.25, 0.5], [1.0, 0.5]]);
        assert!(!flat.enclosed, "a segment holds no area");
        assert_eq!((flat.point.x, flat.point.y), (0.0, 0.5), "on the line");
        let point = nearest(&[[0.0, 0.5], [0.0, 0.5], [0.0, 0.5]]);
        assert_eq!(point.squared, 0.25, "three times the same corner");
    }
}
