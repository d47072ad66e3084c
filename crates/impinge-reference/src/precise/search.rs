//! Searches the direction of the largest height in `f64`, with a bracket. The sphere or circle of
//! directions is divided into smaller pieces as long as a piece may contain a better direction.

use crate::geometry::sphere_search;
use crate::geometry::vector::{add, axis, dot, negate, sub, unit};

/// A bracket of the maximum: it lies between `lower`, the height of `normal`, and `upper`.
pub(super) struct Bracket<const D: usize> {
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) normal: [f64; D],
}

/// The input of a search. `lowest` maps a unit vector to the point of the Minkowski difference with
/// the least height along this vector.
pub(super) struct Task<'a, const D: usize> {
    pub(super) lowest: &'a dyn Fn(&[f64; D]) -> [f64; D],
    /// The size of the pair, a length.
    pub(super) size: f64,
    /// The search stops when at most this share of `size` can still be gained.
    pub(super) tolerance: f64,
}

impl<const D: usize> Task<'_, D> {
    /// Returns the bracket of the maximum. `seeds` are start directions.
    ///
    /// # Panics
    /// Unless D is 2 or 3.
    pub(super) fn maximise(&self, seeds: &[[f64; D]]) -> Bracket<D> {
        match D {
            2 => self.on_circle(seeds),
            3 => self.on_sphere(seeds),
            _ => panic!("only the plane and space are known, not dimension {D}"),
        }
    }

    fn on_sphere(&self, seeds: &[[f64; D]]) -> Bracket<D> {
        let lowest = |normal: &[f64; 3]| convert(&(self.lowest)(&convert(normal)));
        let seeds: Vec<[f64; 3]> = seeds.iter().map(convert).collect();
        let found = sphere_search::maximise(&lowest, &seeds, self.size, self.tolerance);
        Bracket { lower: found.lower, upper: found.upper, normal: convert(&found.normal) }
    }

    fn on_circle(&self, seeds: &[[f64; D]]) -> Bracket<D> {
        /// The largest number of halvings of an arc.
        const DEPTH: usize = 48;
        let mut best = Bracket { lower: f64::NEG_INFINITY, upper: 0.0, normal: [0.0; D] };
        for seed in seeds {
            self.probe(seed, &mut best);
            self.probe(&negate(seed), &mut best);
        }
        let (x, y) = (axis::<D>(0), axis::<D>(1));
        let corners = [x, y, negate(&x), negate(&y)];
        let mut arcs: Vec<[[f64; D]; 2]> =
            (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect();
        let mut upper = f64::NEG_INFINITY;
        for depth in 0..DEPTH {
            let mut next = Vec::new();
            for [start, end] in arcs {
                let (bound, guess) = self.bound(&start, &end, &mut best);
                self.probe(&guess, &mut best);
                let settled = bound <= best.lower + self.tolerance * self.size;
                if settled || depth + 1 == DEPTH {
                    upper = upper.max(bound);
                } else if let Some(middle) = unit(&add(&start, &end)) {
                    next.extend([[start, middle], [middle, end]]);
                }
            }
            arcs = next;
        }
        Bracket { upper: upper.max(best.lower), ..best }
    }

    /// Evaluates the height of `direction`, scaled to unit length, and keeps it if the height is
    /// the largest so far. Returns the support point; the origin if `direction` is zero.
    fn probe(&self, direction: &[f64; D], best: &mut Bracket<D>) -> [f64; D] {
        let Some(normal) = unit(direction) else { return [0.0; D] };
        let point = (self.lowest)(&normal);
        let height = dot(&normal, &point);
        if height > best.lower {
            (best.lower, best.normal) = (height, normal);
        }
        point
    }

    /// Returns an upper bound of the height over an arc, and the direction at which the bound is
    /// attained.
    ///
    /// For the lowest points p of the start and q of the end, `h(n) ≤ min(n·p, n·q)`. Each of `n·p`
    /// and `n·q` has its maximum over the arc at an end, or where n is parallel to p or q. The
    /// minimum of both may also have its maximum where they are equal.
    fn bound(&self, start: &[f64; D], end: &[f64; D], best: &mut Bracket<D>) -> (f64, [f64; D]) {
        let (p, q) = (self.probe(start, best), self.probe(end, best));
        let middle = add(start, end);
        let half = dot(&unit(&middle).unwrap_or(*start), start);
        let difference = sub(&p, &q);
        let across: [f64; D] =
            std::array::from_fn(|i| if i == 0 { -difference[1] } else { difference[0] });
        let mut most = (f64::NEG_INFINITY, *start);
        for direction in [*start, *end, p, q, across, negate(&across)] {
            let Some(normal) = unit(&direction) else { continue };
            let inside = dot(&normal, &unit(&middle).unwrap_or(normal)) >= half - 1e-15;
            let height = dot(&normal, &p).min(dot(&normal, &q));
            if inside && height > most.0 {
                most = (height, normal);
            }
        }
        most
    }
}

/// Converts a vector between two array types of equal length. The compiler does not know that the
/// lengths are equal.
fn convert<const FROM: usize, const TO: usize>(v: &[f64; FROM]) -> [f64; TO] {
    std::array::from_fn(|i| v[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::scale;

    #[test]
    fn a_box_around_the_origin_of_the_plane() {
        let corners = [[-3.0, -2.0], [4.0, -2.0], [4.0, 9.0], [-3.0, 9.0]];
        let lowest = |n: &[f64; 2]| {
            *corners.iter().min_by(|a, b| dot(a, n).total_cmp(&dot(b, n))).expect("four")
        };
        let found = Task { lowest: &lowest, size: 10.0, tolerance: 1e-11 }.maximise(&[]);
        assert_eq!((found.lower, found.normal), (-2.0, [0.0, 1.0]));
        assert!(found.upper <= -2.0 + 2e-10, "{}", found.upper);
    }

    #[test]
    fn a_disk_that_is_not_at_the_origin() {
        let lowest = |n: &[f64; 2]| sub(&[0.3, 0.4], &scale(n, 2.0));
        let found = Task { lowest: &lowest, size: 3.0, tolerance: 1e-11 }.maximise(&[]);
        assert!((found.lower + 1.5).abs() < 1e-10 && found.upper < -1.5 + 1e-10, "half out");
        assert!((found.normal[0] - 0.6).abs() < 1e-4, "{:?}", found.normal);
    }
}
