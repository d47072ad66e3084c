//! Curved cores: from half of the digits of a normal to all of them.
//!
//! Support points alone find a normal of curved cores up to about the root of the accuracy of its
//! height, and the last digits of the height slowly. A core that says how its support points move
//! ([`SupportMap::curved_support`](crate::shape::SupportMap::curved_support)) lets Newton's method
//! finish. At the best normal `n` a few points `a` of the first core are equally extreme, a few
//! points `b` of the second, and some mix of them lies across: `Σ w b − Σ u a = λ n`, with weights that
//! are not negative and sum to one. Derived by `n`, the weights and `λ`, these are linear equations
//! for a step; that active sets and curvature go together like this is the VU-decomposition of
//! C. Lemaréchal, F. Oustry and C. Sagastizábal, "The U-Lagrangian of a Convex Function" (2000).
//! As everywhere, the normal that a step leads to is trusted for its certificate only.

use smallvec::SmallVec;

use super::candidate::Candidate;
use super::difference::{Branch, Difference, Vertex, noise};
use super::simplex::Simplicial;
use super::witness::Mix;
use crate::math::{Matrix, Real, Vector, max, min, unit};

/// Cap on the steps; a normal with a quarter of its digits takes two.
const STEPS: usize = 4;
/// Cap on the choices of active points; each drops one.
const CHOICES: usize = 4;
/// How much less extreme than the most extreme point others may be along a normal that is right to
/// half of its digits, in units of the root of the noise.
const SLACK: f64 = 16.0;
/// The unknowns of three dimensions: `n`, `λ`, and a weight for each active point but the first of
/// each core; and the right side.
const COLUMNS: usize = 7;

/// Points of one core that are, or move to be, equally extreme.
type Branches<N, const D: usize> = SmallVec<[Branch<N, D>; 4]>;

/// What a core contributes.
#[derive(Clone)]
struct Side<N: Real, const D: usize> {
    branches: Branches<N, D>,
    weights: SmallVec<[N; 4]>,
}

/// Raises the height of `best`, given points of the difference that lie lowest along it or nearly so;
/// the points across from each other, if they were found on the way.
///
/// Does nothing where nothing is curved.
pub(super) fn polish<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut Candidate<N, D>,
    vertices: &[Vertex<N, D>],
) -> Option<Mix<N, D>> {
    let start = best.normal;
    let mut sides = active(difference, &start, vertices)?;
    for _ in 0..CHOICES {
        let end = newton(difference, best, &mut sides)?;
        if !drop_worst(&mut sides) {
            best.prefer(end, N::EPSILON);
            let mix = Mix::new(sides[0].mixed(), sides[1].mixed());
            return Some(mix).filter(|mix| mix.meets(best));
        }
        sides.iter_mut().for_each(|side| side.turn(difference, &start));
    }
    None
}

/// The points that lie lowest along a normal, or nearly so: those that [`polish`] may need.
pub(super) fn lowest<N: Simplicial<D>, const D: usize>(
    vertices: &[Vertex<N, D>],
    normal: &Vector<N, D>,
) -> SmallVec<[Vertex<N, D>; 8]> {
    let height = |vertex: &Vertex<N, D>| normal.dot(&vertex.point);
    let least = vertices.iter().fold(N::MAX, |least, vertex| min(height(vertex), least));
    let slack = N::lit(SLACK) * noise::<N>().sqrt();
    vertices.iter().filter(|vertex| height(vertex) <= least + slack).copied().collect()
}

/// The active points of both cores; `None` if all are corners, or there are too many for a normal
/// that is to be found.
fn active<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    normal: &Vector<N, D>,
    vertices: &[Vertex<N, D>],
) -> Option<[Side<N, D>; 2]> {
    let mut sides = [Branches::new(), Branches::new()];
    for vertex in vertices {
        for (index, on) in [vertex.on1, vertex.on2].iter().enumerate() {
            let branch = difference.branch(index == 1, on, normal);
            if !sides[index].iter().any(|known| known.on == branch.on) {
                sides[index].push(branch);
            }
        }
    }
    let outward = [*normal, -normal];
    for (side, outward) in sides.iter_mut().zip(&outward) {
        keep_extreme(side, outward);
    }
    let count = sides[0].len() + sides[1].len();
    let is_curved = sides.iter().flatten().any(|branch| branch.bend.is_some());
    (is_curved && count <= D + 1).then(|| sides.map(Side::new))
}

/// Drops the points that are not extreme, even if the normal is off by the root of the noise.
fn keep_extreme<N: Simplicial<D>, const D: usize>(
    branches: &mut Branches<N, D>,
    outward: &Vector<N, D>,
) {
    let extent = |branch: &Branch<N, D>| outward.dot(&branch.on);
    let most = branches.iter().fold(-N::MAX, |most, branch| max(extent(branch), most));
    let slack = N::lit(SLACK) * noise::<N>().sqrt();
    branches.retain(|branch| extent(branch) >= most - slack);
}

impl<N: Simplicial<D>, const D: usize> Side<N, D> {
    fn new(branches: Branches<N, D>) -> Self {
        let share = N::ONE / branches.iter().fold(N::ZERO, |count, _| count + N::ONE);
        Self { weights: branches.iter().map(|_| share).collect(), branches }
    }

    /// The points as they are for another normal.
    fn turn(&mut self, difference: &dyn Difference<N, D>, normal: &Vector<N, D>) {
        for branch in &mut self.branches {
            *branch = difference.branch(branch.is_second, &branch.on, normal);
        }
    }

    fn mixed(&self) -> Vector<N, D> {
        let zero = Vector::<N, D>::zeros();
        self.branches.iter().zip(&self.weights).fold(zero, |sum, (b, &weight)| sum + b.on * weight)
    }

    /// How the mix moves with the normal.
    fn bend(&self) -> Matrix<N, D> {
        let mut sum = Matrix::<N, D>::zeros();
        for (branch, &weight) in self.branches.iter().zip(&self.weights) {
            if let Some(bend) = &branch.bend {
                sum += bend * weight;
            }
        }
        sum
    }

    /// The place of the least weight that is negative by more than noise.
    fn worst(&self) -> Option<(usize, N)> {
        let mut worst = None;
        let mut least = -noise::<N>().sqrt();
        for (index, &weight) in self.weights.iter().enumerate() {
            if weight < least {
                (worst, least) = (Some((index, weight)), weight);
            }
        }
        worst
    }

    fn drop(&mut self, index: usize) {
        self.branches.remove(index);
        *self = Self::new(std::mem::take(&mut self.branches));
    }
}

/// Drops the point that would have to pull instead of push; says whether there was one.
fn drop_worst<N: Simplicial<D>, const D: usize>(sides: &mut [Side<N, D>; 2]) -> bool {
    let place = match (sides[0].worst(), sides[1].worst()) {
        (Some((index, one)), Some((_, two))) if one <= two => (0, index),
        (Some((index, _)), None) => (0, index),
        (_, Some((index, _))) => (1, index),
        (None, None) => return false,
    };
    sides[place.0].drop(place.1);
    true
}

/// Newton's method from the normal of `best`, which takes over what is better; the normal at the end.
fn newton<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut Candidate<N, D>,
    sides: &mut [Side<N, D>; 2],
) -> Option<Candidate<N, D>> {
    let mut current = *best;
    for _ in 0..STEPS {
        let turn = step(&current, sides)?;
        let squared = turn.norm_squared();
        let sane = squared < N::lit(1.0 / 16.0);
        if !sane {
            return None;
        }
        let (normal, _) = unit(&(current.normal + turn))?;
        current = Candidate::along(difference, normal);
        best.improve(&current);
        sides.iter_mut().for_each(|side| side.turn(difference, &normal));
        // What is left after a step is about its square.
        if squared <= N::EPSILON {
            break;
        }
    }
    Some(current)
}

/// A step of the normal; the weights are set to those that go with it.
fn step<N: Simplicial<D>, const D: usize>(
    current: &Candidate<N, D>,
    sides: &mut [Side<N, D>; 2],
) -> Option<Vector<N, D>> {
    let [first, second] = &*sides;
    let (normal, height) = (&current.normal, current.height);
    let bend = first.bend() + second.bend();
    let across = second.branches[0].on - first.branches[0].on;
    let ways = first.branches[1..].iter().map(|branch| first.branches[0].on - branch.on);
    let ways: SmallVec<[Vector<N, D>; 4]> =
        ways.chain(second.branches[1..].iter().map(|b| b.on - second.branches[0].on)).collect();
    let count = D + 1 + ways.len();
    let mut rows = [[N::ZERO; COLUMNS]; COLUMNS - 1];
    for i in 0..D {
        for j in 0..D {
            rows[i][j] = -bend[(i, j)];
        }
        rows[i][i] -= height;
        (rows[i][D], rows[D][i]) = (-normal[i], normal[i]);
        rows[i][count] = -across[i];
        for (k, way) in ways.iter().enumerate() {
            (rows[i][D + 1 + k], rows[D + 1 + k][i]) = (way[i], way[i]);
        }
    }
    for (k, way) in ways.iter().enumerate() {
        rows[D + 1 + k][count] = -way.dot(normal);
    }
    let solution = solve(rows, count)?;
    let (mut rest, mut turn) = (solution[D + 1..count].iter(), Vector::<N, D>::zeros());
    (0..D).for_each(|i| turn[i] = solution[i]);
    for side in sides {
        let mut sum = N::ZERO;
        for weight in &mut side.weights[1..] {
            *weight = *rest.next()?;
            sum += *weight;
        }
        side.weights[0] = N::ONE - sum;
    }
    Some(turn)
}

/// Solves the first `count` equations, each with its right side in the column `count`, by elimination
/// with row pivoting; `None` if they are dependent.
fn solve<N: Real>(mut rows: [[N; COLUMNS]; COLUMNS - 1], count: usize) -> Option<[N; COLUMNS - 1]> {
    for column in 0..count {
        let mut pivot = column;
        for row in column + 1..count {
            if rows[row][column].abs() > rows[pivot][column].abs() {
                pivot = row;
            }
        }
        rows.swap(column, pivot);
        let usable = rows[column][column].abs() > noise::<N>() * noise();
        if !usable {
            return None;
        }
        for row in column + 1..count {
            let factor = rows[row][column] / rows[column][column];
            for k in column..=count {
                let above = rows[column][k];
                rows[row][k] -= factor * above;
            }
        }
    }
    let mut solution = [N::ZERO; COLUMNS - 1];
    for row in (0..count).rev() {
        let mut value = rows[row][count];
        for k in row + 1..count {
            value -= rows[row][k] * solution[k];
        }
        solution[row] = value / rows[row][row];
    }
    Some(solution)
}
