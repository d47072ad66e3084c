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

use super::candidate::SupportCandidate;
use super::difference::{Branch, Difference, Vertex, noise, tolerance};
use super::simplex::Simplicial;
use super::witness::Mix;
use crate::math::{Mapped, Real, Vector, max, min, unit};

/// Cap on the steps; a normal with a quarter of its digits takes two, and one for each point that turns
/// out to be active or not to be. Along a ring of normals that are about as good, as of solids whose axes
/// all but coincide, long steps leave the ring and the next lead back to it: that takes up to twenty.
const STEPS: usize = 24;
/// How much less extreme than the most extreme point others may be along a normal that has yet to be
/// polished, in units of the root of the tolerance: that is what a normal may be off by.
const SLACK: f64 = 8.0;
/// The longest step: Newton's method is of no use farther away.
const LONGEST: f64 = 0.25;
/// The most equations, in three dimensions: of the step, and of a weight for each active point but the first of each core.
const ROWS: usize = 5;
/// A column for each unknown, and the right side.
const COLUMNS: usize = ROWS + 1;
const RIGHT: usize = ROWS;

/// What a core contributes: points that are, or move to be, equally extreme, and their shares in the mix.
struct ActiveSet<N: Real, const D: usize> {
    branches: SmallVec<[Branch<N, D>; 4]>,
    weights: SmallVec<[N; 4]>,
}

/// Raises the height of `best`, given points of the difference that lie lowest along it or nearly so;
/// the points across from each other, if they were found on the way. These are as near to their
/// places as the normal was to its own; without them, a normal may have been found all the same.
///
/// Does nothing where nothing is curved. A point that the next normal finds lower than the active
/// ones becomes active; one that would have to pull instead of push is no more.
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
        // What is left after a step is about its square, and the weights are as good as the step: a
        // point outside its core, by however little, is none in the end.
        let ends = squared <= N::EPSILON;
        let slack = if ends { noise() } else { noise::<N>().sqrt() };
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
            // A rim runs fast where the normal is close to its axis: then its points take a step more.
            if squared >= left {
                return None;
            }
            left = squared;
        }
    }
    None
}

/// Tries the very normals of round faces that the normal is close to: the height has a peak there, and
/// no derivative.
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

/// The points that lie lowest along a normal, or nearly so: those that [`polish`] may need.
pub(super) fn lowest<N: Simplicial<D>, const D: usize>(
    vertices: &[Vertex<N, D>],
    normal: &Vector<N, D>,
) -> SmallVec<[Vertex<N, D>; 8]> {
    let height = |vertex: &Vertex<N, D>| normal.dot(&vertex.point);
    let least = vertices.iter().fold(N::MAX, |least, vertex| min(height(vertex), least));
    let slack = N::lit(SLACK) * tolerance::<N>().sqrt();
    vertices.iter().filter(|vertex| height(vertex) <= least + slack).copied().collect()
}

/// Finds the active points of both cores; `None` if all are corners, or if so large that their extents are no numbers.
fn activate<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    vertices: &[Vertex<N, D>],
    sides: &mut [ActiveSet<N, D>; 2],
) -> Option<()> {
    for (index, side) in sides.iter_mut().enumerate() {
        let on = |vertex: &Vertex<N, D>| if index == 1 { vertex.on2 } else { vertex.on1 };
        side.insert(difference.branch(index == 1, &on(&best.vertex), &best.normal));
        for (place, vertex) in vertices.iter().enumerate() {
            let is_known = |other: &Vertex<N, D>| on(other) == on(vertex);
            if !is_known(&best.vertex) && !vertices[..place].iter().any(is_known) {
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

/// Drops the points that are not extreme, even if the normal is off by the root of the noise, and of
/// the others the least extreme, until there are no more than can determine a normal.
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
            for (place, branch) in side.branches.iter().enumerate() {
                if side.branches.len() > 1 && lag(branch) >= worst.2 {
                    worst = (index, place, lag(branch));
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

    /// Adds a point, if it is not known.
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

    /// Adds how the mix moves with the normal.
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

    /// From the first point to each of the others.
    fn ways(&self) -> impl Iterator<Item = Vector<N, D>> {
        self.branches[1..].iter().map(|branch| branch.on - self.branches[0].on)
    }

    /// The place of the least weight that is negative by more than the slack.
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

/// Adds the points that the last normal has found beyond the active ones, by more than noise, as long
/// as these can determine a normal; says whether there were any.
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
        let is_beyond = outward.dot(on) > most + noise::<N>();
        if is_beyond && sides[0].branches.len() + sides[1].branches.len() <= D {
            sides[index].branches.push(difference.branch(index == 1, on, &current.normal));
            sides[index].share_evenly();
            added = true;
        }
    }
    added
}

/// Drops the point that would have to pull instead of push; says whether there was one.
fn drop_worst<N: Simplicial<D>, const D: usize>(
    sides: &mut [ActiveSet<N, D>; 2],
    slack: N,
) -> bool {
    let place = match (sides[0].worst(slack), sides[1].worst(slack)) {
        (Some((index, one)), Some((_, two))) if one <= two => (0, index),
        (Some((index, _)), None) => (0, index),
        (_, Some((index, _))) => (1, index),
        (None, None) => return false,
    };
    sides[place.0].drop(place.1);
    true
}

/// A step of the normal; the weights are set to those that go with it.
///
/// With `t` for the step, `P` for what projects across the normal, `B` for the bends of both mixes, `h` for the height,
/// `w` for the weights of all active points but the first of each core, and `D` for the ways to these from the first, of
/// the first core backwards:
///
/// ```text
/// | B + hP + nnᵀ  PD | |  t |   | P (b − a) |
/// |    (PD)ᵀ       0 | | −w | = |  −D·n     |
/// ```
///
/// Bends take the normal to zero; so `nnᵀ` keeps the step across it, and changes nothing else.
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
    let ways = first.ways().map(|way| -way).chain(second.ways());
    let mut count = D;
    for way in ways {
        let flat = across(way);
        for i in 0..D {
            (rows[i][count], rows[count][i]) = (flat[i], flat[i]);
        }
        rows[count][RIGHT] = -way.dot(normal);
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

/// Solves the first `count` equations, each with its right side in the column [`RIGHT`], by elimination
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
        let usable = above[column].abs() > noise::<N>() * noise();
        if !usable {
            return None;
        }
        for row in &mut rows[column + 1..count] {
            let factor = row[column] / above[column];
            // What is to the left is not looked at again: whole rows are quicker than their rests.
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
