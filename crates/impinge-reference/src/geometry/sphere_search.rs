//! The maximum of a separation function over all directions in 3D, with a proven upper bound.
//!
//! For a convex set M given by support points, let `h(n) = min n·m` over m in M. The sphere of
//! directions is divided into eight spherical triangles. A triangle is divided into four as long as
//! its upper bound exceeds the best value found so far. The search uses neither local optimization,
//! which may stop at a local maximum, nor topology.
//!
//! Upper bound of a triangle with the corners n1, n2, n3: for any m in M, `h(n) <= n·m`. A unit n
//! of the triangle is `Σ λᵢ nᵢ / |Σ λᵢ nᵢ|` with λ >= 0 and Σ λ = 1, so
//! `h(n) <= max nᵢ·m / |Σ λᵢ nᵢ|`. The denominator is at most 1, and at least the distance of the
//! flat triangle from the origin. The bound holds for every m in M. The search takes the m with the
//! least bound among the combinations of the three corners' support points: it is the solution of a
//! 3 x 3 matrix game.

use super::vector::{add, dot, negate, perpendicular, scale, sub, unit};

type Vector = [f64; 3];

/// The search stops when at most this share of `size` can still be gained.
pub(crate) const TOLERANCE: f64 = 1e-11;
/// Limits of the depth of subdivision, and of the number of triangles at one depth. The second is
/// reached only if the maximum is taken on a whole curve or region, such as for coaxial cylinders.
/// The bracket is then wider.
const MAX_DEPTH: usize = 40;
const MAX_CELLS: usize = 10_000;

/// A bracket of the maximum: it lies between `lower`, which is `h(normal)`, and `upper`.
pub(crate) struct Bracket {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    pub(crate) normal: Vector,
}

/// A spherical triangle of directions.
struct Cell {
    /// The corners, as unit vectors.
    corners: [Vector; 3],
    /// An upper bound of h over the directions of the triangle.
    bound: f64,
    /// The direction at which h is evaluated next: a guess of the maximum within the triangle.
    promising: Vector,
}

struct Search<'a> {
    /// Maps a direction n to a point m of M with the least `n·m`.
    lowest: &'a dyn Fn(&Vector) -> Vector,
    lower: f64,
    normal: Vector,
}

/// Maximises h. `lowest` maps a direction n to a point m of M with the least `n·m`. `seeds` are
/// start directions of any length, which only save time. `size` is the radius of M. The search
/// stops when at most `tolerance · size` can still be gained.
pub(crate) fn maximise(
    lowest: &dyn Fn(&Vector) -> Vector,
    seeds: &[Vector],
    size: f64,
    tolerance: f64,
) -> Bracket {
    let mut search = Search { lowest, lower: f64::NEG_INFINITY, normal: [0.0; 3] };
    for seed in seeds {
        search.try_direction(seed);
        search.try_direction(&negate(seed));
    }
    let mut cells = search.octants();
    // The largest upper bound of the discarded triangles.
    let mut discarded = f64::NEG_INFINITY;
    for _ in 0..MAX_DEPTH {
        for cell in &cells {
            search.try_direction(&cell.promising);
        }
        let limit = search.lower + tolerance * size;
        for cell in cells.iter().filter(|cell| cell.bound <= limit) {
            discarded = discarded.max(cell.bound);
        }
        cells.retain(|cell| cell.bound > limit);
        if cells.is_empty() || cells.len() > MAX_CELLS {
            break;
        }
        cells = cells.iter().flat_map(|cell| search.cut(cell)).collect();
    }
    let upper = cells.iter().map(|cell| cell.bound).fold(discarded.max(search.lower), f64::max);
    Bracket { lower: search.lower, upper, normal: search.normal }
}

impl Search<'_> {
    /// Evaluates h at `normal` and keeps `normal` if its h is the largest so far. Returns the
    /// support point.
    fn probe(&mut self, normal: &Vector) -> Vector {
        let support = (self.lowest)(normal);
        let height = dot(normal, &support);
        if height > self.lower {
            self.lower = height;
            self.normal = *normal;
        }
        support
    }

    fn try_direction(&mut self, direction: &Vector) {
        if let Some(normal) = unit(direction) {
            self.probe(&normal);
        }
    }

    /// Returns the eight triangles between the coordinate axes.
    fn octants(&mut self) -> Vec<Cell> {
        let signs = [-1.0, 1.0];
        let mut cells = Vec::new();
        for x in signs {
            for y in signs {
                for z in signs {
                    cells.push(self.cell([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]));
                }
            }
        }
        cells
    }

    /// Divides a triangle into four: one at each corner and one in the middle.
    fn cut(&mut self, cell: &Cell) -> [Cell; 4] {
        let [a, b, c] = cell.corners;
        let middle = |p: &Vector, q: &Vector| unit(&add(p, q)).expect("corners are never opposite");
        let (ab, bc, ca) = (middle(&a, &b), middle(&b, &c), middle(&c, &a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|corners| self.cell(corners))
    }

    fn cell(&mut self, corners: [Vector; 3]) -> Cell {
        let supports = corners.map(|corner| self.probe(&corner));
        let game = corners.map(|corner| supports.map(|support| dot(&corner, &support)));
        let (value, weights) = game_value(&game);
        let bound = if value > 0.0 { value / flatness(&corners) } else { value };
        let mut point = [0.0; 3];
        for (support, weight) in supports.iter().zip(weights) {
            point = add(&point, &scale(support, weight));
        }
        let promising = promising(&corners, &supports, &point);
        // If the bound is NaN, the triangle is kept: its bound becomes infinite.
        let bound = if bound.is_nan() { f64::INFINITY } else { bound };
        Cell { corners, bound, promising }
    }
}

/// Returns the distance from the origin of the plane through three unit vectors; 1 if they do not
/// span a plane.
fn flatness([a, b, c]: &[Vector; 3]) -> f64 {
    unit(&perpendicular(&[sub(b, a), sub(c, a)])).map_or(1.0, |normal| dot(&normal, a).abs())
}

/// Returns a direction at which the maximum within a triangle may lie. It is the normal of the
/// plane of the support points, which is exact if M has a face there. If the support points are
/// collinear, it is the direction of `point`, their combination with the weights of the matrix
/// game. The sign is chosen towards the middle of the triangle.
fn promising(corners: &[Vector; 3], supports: &[Vector; 3], point: &Vector) -> Vector {
    let [a, b, c] = supports;
    let face = perpendicular(&[sub(b, a), sub(c, a)]);
    let inner = add(&add(&corners[0], &corners[1]), &corners[2]);
    let best = unit(&face).or_else(|| unit(point)).unwrap_or(inner);
    scale(&best, dot(&best, &inner).signum())
}

/// Returns the minimum over all weights w >= 0 with sum 1 of the largest row sum `Σⱼ wⱼ
/// game[i][j]`, and the weights at which it is taken.
///
/// The largest row sum is convex and piecewise linear in w. So its minimum is taken at a corner of
/// the triangle of weights, at a point of a side where two rows are equal, or where all three rows
/// are equal.
fn game_value(game: &[[f64; 3]; 3]) -> (f64, [f64; 3]) {
    let row_sum = |row: &[f64; 3], w: &[f64; 3]| dot(row, w);
    let mut best = (f64::INFINITY, [1.0, 0.0, 0.0]);
    let mut consider = |w: [f64; 3]| {
        let value = game.iter().map(|row| row_sum(row, &w)).fold(f64::NEG_INFINITY, f64::max);
        if value < best.0 {
            best = (value, w);
        }
    };
    let differences = [sub(&game[0], &game[1]), sub(&game[1], &game[2]), sub(&game[2], &game[0])];
    for (j, k) in [(0, 1), (1, 2), (2, 0)] {
        consider(std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 }));
        for difference in &differences {
            let share = difference[k] / (difference[k] - difference[j]);
            if share > 0.0 && share < 1.0 {
                let mut w = [0.0; 3];
                w[j] = share;
                w[k] = 1.0 - share;
                consider(w);
            }
        }
    }
    let w = perpendicular(&differences[..2]);
    let sum: f64 = w.iter().sum();
    let w = w.map(|x| x / sum);
    if w.iter().all(|&x| x >= 0.0) {
        consider(w);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::vector::norm;
    use super::*;

    fn of_points(points: &[Vector]) -> Bracket {
        let lowest = |n: &Vector| {
            *points.iter().min_by(|a, b| dot(a, n).total_cmp(&dot(b, n))).expect("points")
        };
        maximise(&lowest, &[], points.iter().map(norm).fold(0.0, f64::max), TOLERANCE)
    }

    #[test]
    fn a_box_around_the_origin() {
        let corner = |i: usize| {
            std::array::from_fn(|k| [[-3.0, 4.0], [-2.0, 9.0], [-5.0, 5.0]][k][i >> k & 1])
        };
        let points: Vec<Vector> = (0..8).map(corner).collect();
        let found = of_points(&points);
        assert_eq!(found.lower, -2.0);
        assert_eq!(found.normal, [0.0, 1.0, 0.0]);
        assert!(found.upper < -2.0 + 1e-7, "upper {}", found.upper);
    }

    #[test]
    fn a_triangle_away_from_the_origin() {
        let found = of_points(&[[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]);
        assert!((found.lower - 3f64.sqrt()).abs() < 1e-14, "lower {}", found.lower);
        assert!(found.upper - found.lower < 1e-8, "upper {}", found.upper);
    }

    #[test]
    fn a_ball_is_bounded_although_all_directions_are_equal() {
        let found = maximise(&|n: &Vector| scale(n, -2.0), &[], 2.0, TOLERANCE);
        assert!((found.lower + 2.0).abs() < 1e-15, "lower {}", found.lower);
        assert!(found.upper > -2.0 && found.upper < -1.99, "upper {}", found.upper);
    }

    #[test]
    fn the_game_by_hand() {
        // Equal weights of the first two columns make the first two rows equal; the third column
        // gets no weight.
        let (value, weights) = game_value(&[[1.0, -1.0, 9.0], [-1.0, 1.0, 9.0], [-5.0, -5.0, 9.0]]);
        assert_eq!((value, weights), (0.0, [0.5, 0.5, 0.0]));
        let (value, _) = game_value(&[[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]);
        assert!((value - 1.0).abs() < 1e-15, "value {value}");
    }
}
