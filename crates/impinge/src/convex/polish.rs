//! Newton's method for curved cores: reduces the error of a normal from about the square root of
//! the tolerance to rounding error.
//!
//! With support points alone, the error of a normal of curved cores is about the square root of the
//! error of its height, and the height itself converges slowly. If a core provides how its support
//! points move ([`SupportMap::curved_support`](crate::shape::SupportMap::curved_support)), Newton's
//! method computes both to rounding error. At the best normal `n`, a few points `a` of the first
//! core are equally extreme, and so are a few points `b` of the second. Some weighted means of both
//! face each other along the normal: `Σ w b − Σ u a = λ n`, with weights that are not negative and
//! sum to one. The derivatives with respect to `n`, the weights and `λ` give linear equations for a
//! step. Combining active sets and curvature in this way is the VU-decomposition of C. Lemaréchal,
//! F. Oustry and C. Sagastizábal, "The U-Lagrangian of a Convex Function" (2000). Only the height
//! of the normal after a step decides whether it is accepted, as everywhere in this module.

use smallvec::SmallVec;

use super::candidate::SupportCandidate;
use super::difference::{Branch, Difference, Vertex, rounding_error, tolerance};
use super::simplex::Simplicial;
use super::witness::Mix;
use crate::math::{Mapped, Real, Vector, max, min, unit};

/// Cap on the steps. A normal with an error of about the fourth root of epsilon takes two steps,
/// and one more for each point that becomes active or inactive. Along a ring of equally good
/// normals, as for solids with almost the same axis, long steps leave the ring and the next steps
/// return to it: up to twenty.
const STEPS: usize = 24;
/// Largest distance by which an active point may be less extreme than the most extreme one, along a
/// normal that is not yet polished: in units of the square root of the tolerance, which is the
/// error of such a normal.
const SLACK: f64 = 8.0;
/// Length of the longest step; Newton's method does not converge from farther away.
const LONGEST: f64 = 0.25;
/// Largest number of equations, in 3D: three for the step, and one for the weight of each active
/// point except the first of each core.
const ROWS: usize = 5;
/// Number of columns: one for each unknown, and one for the right side.
const COLUMNS: usize = ROWS + 1;
const RIGHT: usize = ROWS;

/// Active points of one core, which are equally extreme or become so, and their weights in the mix.
struct ActiveSet<N: Real, const D: usize> {
    branches: SmallVec<[Branch<N, D>; 4]>,
    weights: SmallVec<[N; 4]>,
}

/// Raises the height of `best` by Newton's method; `vertices` are points of the difference that are
/// lowest along its normal, or nearly so. Returns the points that face each other along the normal,
/// as accurate as the normal before the last step; `None` if they were not found. `best` may be
/// improved even if the result is `None`.
///
/// Returns `None` for flat cores. A support point of the next normal that lies beyond the active
/// points becomes active; a point with a negative weight becomes inactive.
pub(super) fn polish<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut SupportCandidate<N, D>,
    vertices: &[Vertex<N, D>],
) -> Option<Mix<N, D>> {
    if difference.is_flat() {
        return None;
    }
    try_round_faces(difference, best);
    let mut current = *best;
    let mut sides = [ActiveSet::empty(), ActiveSet::empty()];
    activate(difference, &current, vertices, &mut sides)?;
    let mut left = N::INFINITY;
    for _ in 0..STEPS {
        let mut turn = step(&current, &mut sides)?;
        let squared = turn.norm_squared();
        if squared > N::lit(LONGEST * LONGEST) {
            turn *= N::lit(LONGEST) / squared.sqrt();
        }
        current = SupportCandidate::along(difference, unit(&(current.normal + turn))?.0);
        best.improve(&current);
        sides.iter_mut().for_each(|side| side.turn(difference, &current.normal));
        // The error after a step is about the square of the step, and weights are as accurate as
        // the step. At the last step, no weight may be negative beyond rounding.
        let ends = squared <= N::EPSILON;
        let slack = if ends { rounding_error() } else { rounding_error::<N>().sqrt() };
        let changed = add_lower(difference, &current, &mut sides) || drop_worst(&mut sides, slack);
        if changed {
            current = *best;
            sides.iter_mut().for_each(|side| side.turn(difference, &current.normal));
        } else if ends {
            best.prefer(current, N::EPSILON);
            let mix = Mix::new(sides[0].mixed(), sides[1].mixed());
            if mix.meets(best) {
                return Some(mix);
            }
            // A rim point moves fast if the normal is close to the rim's axis. So further steps are
            // made as long as they get shorter.
            if squared >= left {
                return None;
            }
            left = squared;
        }
    }
    None
}

/// Replaces `best` by the exact normal of a round face close to it if that normal has a larger
/// height. The height may have a maximum at such a normal, where it is not differentiable.
fn try_round_faces<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut SupportCandidate<N, D>,
) {
    for face in difference.round_faces(&best.normal).into_iter().flatten() {
        let is_close = (face - best.normal).norm_squared() < N::lit(SLACK) * tolerance();
        if let Some((normal, _)) = unit(&face).filter(|_| is_close) {
            best.improve(&SupportCandidate::along(difference, normal));
        }
    }
}

/// Returns the points that are lowest along a normal, or nearly so, for [`polish`].
pub(super) fn lowest<N: Simplicial<D>, const D: usize>(
    vertices: &[Vertex<N, D>],
    normal: &Vector<N, D>,
) -> SmallVec<[Vertex<N, D>; 8]> {
    let height = |vertex: &Vertex<N, D>| normal.dot(&vertex.point);
    let least = vertices.iter().fold(N::MAX, |least, vertex| min(height(vertex), least));
    let slack = N::lit(SLACK) * tolerance::<N>().sqrt();
    vertices.iter().filter(|vertex| height(vertex) <= least + slack).copied().collect()
}

/// Finds the active points of both cores; `None` if all are corners, or if a core has none because
/// coordinates are NaN.
fn activate<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    vertices: &[Vertex<N, D>],
    sides: &mut [ActiveSet<N, D>; 2],
) -> Option<()> {
    for (index, side) in sides.iter_mut().enumerate() {
        let on = |vertex: &Vertex<N, D>| if index == 1 { vertex.on2 } else { vertex.on1 };
        side.insert(difference.branch(index == 1, &on(&best.vertex), &best.normal));
        for (earlier, vertex) in vertices.iter().enumerate() {
            let is_known = |other: &Vertex<N, D>| on(other) == on(vertex);
            if !is_known(&best.vertex) && !vertices[..earlier].iter().any(is_known) {
                side.insert(difference.branch(index == 1, &on(vertex), &best.normal));
            }
        }
    }
    let mut branches = sides.iter().flat_map(|side| &side.branches);
    if branches.all(|branch| branch.bend.is_none()) {
        return None;
    }
    keep_extreme(sides, &best.normal);
    sides.iter_mut().for_each(ActiveSet::share_evenly);
    sides.iter().all(|side| !side.branches.is_empty()).then_some(())
}

/// Drops points that are not extreme even if the normal has an error of the square root of the
/// tolerance. Then drops the least extreme points until at most `D + 1` are left, enough to
/// determine a normal.
fn keep_extreme<N: Simplicial<D>, const D: usize>(
    sides: &mut [ActiveSet<N, D>; 2],
    normal: &Vector<N, D>,
) {
    let extent = |branch: &Branch<N, D>| {
        if branch.is_second { -normal.dot(&branch.on) } else { normal.dot(&branch.on) }
    };
    let most = [0, 1].mapped(|index: usize| {
        sides[index].branches.iter().fold(-N::MAX, |most, branch| max(extent(branch), most))
    });
    let lag = |branch: &Branch<N, D>| most[usize::from(branch.is_second)] - extent(branch);
    let slack = N::lit(SLACK) * tolerance::<N>().sqrt();
    sides.iter_mut().for_each(|side| side.branches.retain(|branch| lag(branch) <= slack));
    while sides[0].branches.len() + sides[1].branches.len() > D + 1 {
        let mut worst = (0, 0, -N::ONE);
        for (index, side) in sides.iter().enumerate() {
            for (branch_index, branch) in side.branches.iter().enumerate() {
                if side.branches.len() > 1 && lag(branch) >= worst.2 {
                    worst = (index, branch_index, lag(branch));
                }
            }
        }
        sides[worst.0].branches.remove(worst.1);
    }
}

impl<N: Simplicial<D>, const D: usize> ActiveSet<N, D> {
    fn empty() -> Self {
        Self { branches: SmallVec::new(), weights: SmallVec::new() }
    }

    /// Adds an active point unless there already is one at the same position.
    fn insert(&mut self, branch: Branch<N, D>) {
        if !self.branches.iter().any(|known| known.on == branch.on) {
            self.branches.push(branch);
        }
    }

    fn share_evenly(&mut self) {
        let share = N::ONE / self.branches.iter().fold(N::ZERO, |count, _| count + N::ONE);
        self.weights.clear();
        self.weights.resize(self.branches.len(), share);
    }

    /// Moves the active points to where they are extreme along `normal`.
    fn turn(&mut self, difference: &dyn Difference<N, D>, normal: &Vector<N, D>) {
        for branch in &mut self.branches {
            *branch = difference.branch(branch.is_second, &branch.on, normal);
        }
    }

    fn mixed(&self) -> Vector<N, D> {
        let zero = Vector::<N, D>::zeros();
        self.branches.iter().zip(&self.weights).fold(zero, |sum, (b, &weight)| sum + b.on * weight)
    }

    /// Adds the derivative of the mix with respect to the normal to the first `D` rows and columns.
    fn add_bend(&self, rows: &mut [[N; COLUMNS]; ROWS]) {
        for (branch, &weight) in self.branches.iter().zip(&self.weights) {
            let Some(bend) = &branch.bend else { continue };
            for i in 0..D {
                for j in 0..D {
                    rows[i][j] += bend[(i, j)] * weight;
                }
            }
        }
    }

    /// Returns the vectors from the first active point to each further active point.
    fn directions(&self) -> impl Iterator<Item = Vector<N, D>> {
        self.branches[1..].iter().map(|branch| branch.on - self.branches[0].on)
    }

    /// Returns the index and value of the smallest weight below `-slack`; `None` if there is none.
    fn worst(&self, slack: N) -> Option<(usize, N)> {
        let (mut worst, mut least) = (None, -slack);
        for (index, &weight) in self.weights.iter().enumerate() {
            if weight < least {
                (worst, least) = (Some((index, weight)), weight);
            }
        }
        worst
    }

    fn drop(&mut self, index: usize) {
        self.branches.remove(index);
        self.share_evenly();
    }
}

/// Adds the support points of the current normal that lie beyond the active points of their core by
/// more than rounding, up to `D + 1` active points in total. Returns whether any was added.
fn add_lower<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    current: &SupportCandidate<N, D>,
    sides: &mut [ActiveSet<N, D>; 2],
) -> bool {
    let mut added = false;
    for (index, on) in [current.vertex.on1, current.vertex.on2].iter().enumerate() {
        let outward = if index == 1 { -current.normal } else { current.normal };
        let branches = &sides[index].branches;
        let most = branches.iter().fold(-N::MAX, |most, b| max(outward.dot(&b.on), most));
        let is_beyond = outward.dot(on) > most + rounding_error::<N>();
        if is_beyond && sides[0].branches.len() + sides[1].branches.len() <= D {
            sides[index].branches.push(difference.branch(index == 1, on, &current.normal));
            sides[index].share_evenly();
            added = true;
        }
    }
    added
}

/// Drops the point with the most negative weight below `-slack`; returns whether there was one.
fn drop_worst<N: Simplicial<D>, const D: usize>(
    sides: &mut [ActiveSet<N, D>; 2],
    slack: N,
) -> bool {
    let worst = match (sides[0].worst(slack), sides[1].worst(slack)) {
        (Some((index, one)), Some((_, two))) if one <= two => (0, index),
        (Some((index, _)), None) => (0, index),
        (_, Some((index, _))) => (1, index),
        (None, None) => return false,
    };
    sides[worst.0].drop(worst.1);
    true
}

/// Returns a step of the normal, and sets the weights that belong to it; `None` if the equations
/// are dependent.
///
/// Let `t` be the step, `P` the projection perpendicular to the normal, `B` the sum of the weighted
/// bends, `h` the height, `w` the weights of all active points but the first of each core, and `D`
/// the vectors to these points from the first one (negated for the first core):
///
/// ```text
/// | B + hP + nnᵀ  PD | |  t |   | P (b − a) |
/// |    (PD)ᵀ       0 | | −w | = |  −D·n     |
/// ```
///
/// Bends map the normal to zero; `nnᵀ` keeps the step perpendicular to it and changes nothing else.
fn step<N: Simplicial<D>, const D: usize>(
    current: &SupportCandidate<N, D>,
    sides: &mut [ActiveSet<N, D>; 2],
) -> Option<Vector<N, D>> {
    let (normal, height) = (&current.normal, current.height);
    let [first, second] = &*sides;
    let mut rows = [[N::ZERO; COLUMNS]; ROWS];
    for i in 0..D {
        for j in 0..D {
            rows[i][j] = normal[i] * normal[j] * (N::ONE - height);
        }
        rows[i][i] += height;
    }
    first.add_bend(&mut rows);
    second.add_bend(&mut rows);
    let across = |v: Vector<N, D>| v - normal * normal.dot(&v);
    let directions = first.directions().map(|direction| -direction).chain(second.directions());
    let mut count = D;
    for direction in directions {
        let flat = across(direction);
        for i in 0..D {
            (rows[i][count], rows[count][i]) = (flat[i], flat[i]);
        }
        rows[count][RIGHT] = -direction.dot(normal);
        count += 1;
    }
    let apart = across(second.branches[0].on - first.branches[0].on);
    for i in 0..D {
        rows[i][RIGHT] = apart[i];
    }
    let solution = solve(rows, count)?;
    let mut rest = solution[D..count].iter();
    for side in sides {
        let mut sum = N::ZERO;
        for weight in &mut side.weights[1..] {
            *weight = -*rest.next()?;
            sum += *weight;
        }
        side.weights[0] = N::ONE - sum;
    }
    Some(Vector::from_fn(|axis, _| solution[axis]))
}

/// Solves the first `count` equations, with the right sides in the column [`RIGHT`], by elimination
/// with row pivoting; `None` if they are dependent.
fn solve<N: Real>(mut rows: [[N; COLUMNS]; ROWS], count: usize) -> Option<[N; ROWS]> {
    for column in 0..count {
        let mut pivot = column;
        for row in column + 1..count {
            if rows[row][column].abs() > rows[pivot][column].abs() {
                pivot = row;
            }
        }
        if pivot != column {
            rows.swap(column, pivot);
        }
        let above = rows[column];
        let usable = above[column].abs() > rounding_error::<N>() * rounding_error();
        if !usable {
            return None;
        }
        for row in &mut rows[column + 1..count] {
            let factor = row[column] / above[column];
            // Entries to the left are not read again, but updating whole rows is faster than
            // updating parts of them.
            for (entry, above) in row.iter_mut().zip(&above) {
                *entry -= factor * *above;
            }
        }
    }
    let mut solution = [N::ZERO; ROWS];
    for row in (0..count).rev() {
        let mut value = rows[row][RIGHT];
        for (entry, known) in rows[row][row + 1..count].iter().zip(&solution[row + 1..count]) {
            value -= *entry * *known;
        }
        solution[row] = value / rows[row][row];
    }
    Some(solution)
}
