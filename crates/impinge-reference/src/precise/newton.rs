//! Refines an approximate normal to all digits by Newton's method.
//!
//! The separation along a normal n is the least height of the parts of the second solid, minus the
//! largest extent of the parts of the first. At the best normal some parts of each solid are
//! active: they attain this least height or largest extent together. Let a and b be the support
//! points of the active parts of the first and the second solid. A combination `x = Σ w b − Σ u a`,
//! with weights that are not negative and sum to one for each solid, is then a multiple of n. This
//! x is the projection of the origin onto the supporting plane of the difference. There are as many
//! equations as unknowns: n, the weights and the multiple. Newton's method solves them with second
//! derivatives in closed form. The active parts are chosen by their heights along the start normal,
//! and each choice is rated by its final height.

use super::linear::solve;
use super::number::Quad;
use super::solid::{Placed, height, mixed};
use super::vector::{Vector, add, dot, negate, norm, scale, sub, unit};

/// The largest number of Newton steps; a start with three correct digits needs five.
const STEPS: usize = 12;
/// The largest number of rounds, each of which chooses the active parts anew.
const ROUNDS: usize = 4;

/// A normal, with a lower and an upper bound of the signed distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polished<const D: usize> {
    pub(super) normal: Vector<D>,
    /// The separation along the normal: a lower bound of the signed distance.
    pub(super) height: Quad,
    /// A point of the Minkowski difference; its length is an upper bound of the distance if the
    /// solids are apart.
    pub(super) point: Vector<D>,
}

impl<const D: usize> Polished<D> {
    /// Returns the distance of `point` from `height · normal`: zero at every local maximum of the
    /// height.
    pub(super) fn miss(&self) -> f64 {
        norm(&sub(&self.point, &scale(&self.normal, self.height))).to_f64()
    }
}

/// The cores of two solids (without their radii), in one frame.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a, const D: usize> {
    pub(super) parts1: &'a [Placed<D>],
    pub(super) parts2: &'a [Placed<D>],
}

/// Returns the best normal near `start`. Active parts are chosen among the `breadth` most extreme
/// parts of each solid. A `breadth` above one is needed if edges or faces are parallel, since some
/// choices then have no solution.
pub(super) fn polish<const D: usize>(
    pair: Pair<'_, D>,
    start: &Vector<D>,
    breadth: usize,
) -> Polished<D> {
    let mut best = Polished {
        normal: *start,
        height: height(pair.parts1, pair.parts2, start),
        point: supported(pair, start),
    };
    for _ in 0..ROUNDS {
        let before = best.height;
        let order1 = by_extent(pair.parts1, &best.normal);
        let order2 = by_extent(pair.parts2, &negate(&best.normal));
        let around = best.normal;
        for active in choices(pair, &order1, &order2, breadth) {
            if let Some(found) = active.polished(pair, &around)
                && is_better(&found, &best)
            {
                best = found;
            }
        }
        if (best.height - before).to_f64() <= 1e-29 * best.height.to_f64().abs() {
            break;
        }
    }
    best
}

/// Returns the sets of parts that may be active: up to D + 1 parts in all, at least one of each
/// solid.
fn choices<'a, const D: usize>(
    pair: Pair<'a, D>,
    order1: &[usize],
    order2: &[usize],
    breadth: usize,
) -> Vec<Active<'a, D>> {
    let mut found = Vec::new();
    for (count1, count2) in [(1, 1), (2, 1), (1, 2), (3, 1), (2, 2), (1, 3)] {
        if count1 + count2 > D + 1 {
            continue;
        }
        for chosen1 in subsets(order1, count1, breadth) {
            for chosen2 in subsets(order2, count2, breadth) {
                let parts1 = chosen1.iter().map(|&i| &pair.parts1[i]).collect();
                let parts2 = chosen2.iter().map(|&i| &pair.parts2[i]).collect();
                found.push(Active { parts1, parts2 });
            }
        }
    }
    found
}

/// Returns all choices of `count` indices among the first `max(breadth, count)` of `order`.
fn subsets(order: &[usize], count: usize, breadth: usize) -> Vec<Vec<usize>> {
    let first = &order[..breadth.max(count).min(order.len())];
    let masks = (0_u32..1 << first.len()).filter(|mask| mask.count_ones() as usize == count);
    let chosen = |mask: u32| {
        let places = (0..first.len()).filter(|place| mask >> place & 1 == 1);
        places.map(|place| first[place]).collect()
    };
    masks.map(chosen).collect()
}

/// Returns `true` if `found` has a larger height than `best`, or, if the heights are equal up to
/// rounding, a smaller miss.
pub(super) fn is_better<const D: usize>(found: &Polished<D>, best: &Polished<D>) -> bool {
    let gain = (found.height - best.height).to_f64();
    let noise = 1e-29 * (found.height.to_f64().abs() + norm(&found.point).to_f64());
    gain > noise || gain > -noise && found.miss() < best.miss()
}

/// Returns a candidate whose normal is `normal`, an axis of `disk`. Its `point` is the difference
/// of a touching point of the other solid and the nearest point of the disk. Among several touching
/// points, the one with the smallest miss is used.
pub(super) fn across_disk<const D: usize>(
    pair: Pair<'_, D>,
    disk: &Placed<D>,
    is_second: bool,
    normal: &Vector<D>,
) -> Polished<D> {
    let outward = if is_second { negate(normal) } else { *normal };
    let others = if is_second { pair.parts1 } else { pair.parts2 };
    let height = height(pair.parts1, pair.parts2, normal);
    let touching = touching_points(others, &negate(&outward), &disk.center);
    let candidate = |on_other: &Vector<D>| {
        let on_disk = disk.nearest_in_disk(on_other);
        let (on1, on2) = if is_second { (*on_other, on_disk) } else { (on_disk, *on_other) };
        Polished { normal: *normal, height, point: sub(&on2, &on1) }
    };
    let candidates = common_candidates(&touching, &disk.center, &outward);
    let mut found = candidate(&touching[0]);
    for other in candidates.iter().map(candidate) {
        if other.miss() < found.miss() {
            found = other;
        }
    }
    found
}

/// Returns the support points of all parts with the largest extent along `normal`. A disk
/// perpendicular to `normal` contributes its point nearest to `center`.
fn touching_points<const D: usize>(
    parts: &[Placed<D>],
    normal: &Vector<D>,
    center: &Vector<D>,
) -> Vec<Vector<D>> {
    let order = by_extent(parts, normal);
    let most = parts[order[0]].extent(normal);
    let slack = 1e-27 * (most.to_f64().abs() + norm(&parts[order[0]].center).to_f64());
    let equal = |i: &&usize| (most - parts[**i].extent(normal)).to_f64() <= slack;
    let point = |&i: &usize| {
        let part = &parts[i];
        let flat = !part.is_point() && {
            let components = part.components(normal);
            components.iter().all(|x| x.to_f64().abs() <= 1e-25 * norm(&part.columns[0]).to_f64())
        };
        if flat { part.nearest_in_disk(center) } else { part.support(normal) }
    };
    order.iter().take_while(equal).map(point).collect()
}

/// Returns points of the flat polygon with these corners, which is perpendicular to `normal`. If a
/// disk about `center` overlaps the polygon in the projection along `normal`, one of the returned
/// points lies in the projected disk. They are the corners, the point nearest to the centre on each
/// line between two corners, and the projected centre if the polygon contains it.
fn common_candidates<const D: usize>(
    corners: &[Vector<D>],
    center: &Vector<D>,
    normal: &Vector<D>,
) -> Vec<Vector<D>> {
    let mut found = corners.to_vec();
    let away = dot(&sub(&corners[0], center), normal);
    let projected = add(center, &scale(normal, away));
    for (i, a) in corners.iter().enumerate() {
        for (j, b) in corners.iter().enumerate().skip(i + 1) {
            let along = sub(b, a);
            let share = dot(&sub(&projected, a), &along) / dot(&along, &along);
            found.push(add(a, &scale(&along, share.max(Quad::ZERO).min(Quad::ONE))));
            for c in &corners[j + 1..] {
                if D == 3 && holds(&[*a, *b, *c], &projected, normal) {
                    found.push(projected);
                }
            }
        }
    }
    found
}

/// Whether a triangle contains a point of its plane.
fn holds<const D: usize>([a, b, c]: &[Vector<D>; 3], p: &Vector<D>, normal: &Vector<D>) -> bool {
    let side = |from: &Vector<D>, to: &Vector<D>| {
        dot(&super::vector::perpendicular(&[sub(to, from), sub(p, from)]), normal)
    };
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|s| *s >= Quad::ZERO) || sides.iter().all(|s| *s <= Quad::ZERO)
}

/// Returns the mean of the support points of all parts with the largest extent along `normal`.
fn touched<const D: usize>(parts: &[Placed<D>], normal: &Vector<D>) -> Vector<D> {
    let points = touching_points(parts, normal, &parts[0].center);
    mixed(&points, &vec![Quad::ONE / Quad::new(points.len() as f64); points.len()])
}

/// Returns a point of the Minkowski difference with the least height along `normal`: the difference
/// of the means of the support points of both solids.
fn supported<const D: usize>(pair: Pair<'_, D>, normal: &Vector<D>) -> Vector<D> {
    sub(&touched(pair.parts2, &negate(normal)), &touched(pair.parts1, normal))
}

/// Returns the indices of the parts, sorted by falling extent along `normal`.
fn by_extent<const D: usize>(parts: &[Placed<D>], normal: &Vector<D>) -> Vec<usize> {
    let extents: Vec<Quad> = parts.iter().map(|part| part.extent(normal)).collect();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    let falling = |&i: &usize, &j: &usize| {
        extents[j].partial_cmp(&extents[i]).unwrap_or(std::cmp::Ordering::Equal)
    };
    order.sort_by(falling);
    order
}

/// A choice of active parts of both solids.
struct Active<'a, const D: usize> {
    parts1: Vec<&'a Placed<D>>,
    parts2: Vec<&'a Placed<D>>,
}

/// The unknowns of the equations, as of the last step.
#[derive(Clone)]
struct State<const D: usize> {
    normal: Vector<D>,
    /// The factor `m` in the equation `point = m · normal`.
    multiple: Quad,
    weights1: Vec<Quad>,
    weights2: Vec<Quad>,
}

/// The extent of a part along a normal, to second order.
struct Local<const D: usize> {
    extent: Quad,
    support: Vector<D>,
    /// The matrix of second derivatives of the extent, by rows.
    bend: [Vector<D>; D],
}

impl<const D: usize> Local<D> {
    /// Evaluates the extent of `part` along `normal`. Returns `None` for a disk if `normal` is its
    /// axis, since the extent is not differentiable there.
    fn new(part: &Placed<D>, normal: &Vector<D>) -> Option<Self> {
        let support = part.support(normal);
        let mut bend = [[Quad::ZERO; D]; D];
        if !part.is_point() {
            let components = part.components(normal);
            let squared = components.iter().fold(Quad::ZERO, |sum, x| sum + *x * *x);
            let size = part.columns.iter().fold(Quad::ZERO, |sum, c| sum + dot(c, c));
            if squared.to_f64() <= 1e-40 * size.to_f64() {
                return None;
            }
            let length = squared.sqrt();
            let outward = sub(&support, &part.center);
            for (i, row) in bend.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    let product = part.columns.iter().fold(Quad::ZERO, |sum, c| sum + c[i] * c[j]);
                    *entry = (product - outward[i] * outward[j]) / length;
                }
            }
        }
        Some(Self { extent: dot(&support, normal), support, bend })
    }
}

impl<const D: usize> Active<'_, D> {
    /// Runs Newton's method from `start`. Returns the final normal with its height over all parts;
    /// `None` if a step fails.
    fn polished(&self, pair: Pair<'_, D>, start: &Vector<D>) -> Option<Polished<D>> {
        let equal = |count: usize| vec![Quad::ONE / Quad::new(count as f64); count];
        let mut state = State {
            normal: *start,
            multiple: height(pair.parts1, pair.parts2, start),
            weights1: equal(self.parts1.len()),
            weights2: equal(self.parts2.len()),
        };
        for _ in 0..STEPS {
            let moved = self.step(&mut state)?;
            if moved < 1e-30 {
                break;
            }
        }
        let normal = unit(&state.normal)?;
        let supports = |parts: &[&Placed<D>], normal: &Vector<D>| -> Vec<Vector<D>> {
            parts.iter().map(|part| part.support(normal)).collect()
        };
        let on1 = mixed(&supports(&self.parts1, &normal), &proper(&state.weights1));
        let on2 = mixed(&supports(&self.parts2, &negate(&normal)), &proper(&state.weights2));
        let height = height(pair.parts1, pair.parts2, &normal);
        Some(Polished { normal, height, point: sub(&on2, &on1) })
    }

    /// Makes one Newton step, and returns the length of the change of the normal; `None` if the
    /// step is too long or an extent is not differentiable.
    fn step(&self, state: &mut State<D>) -> Option<f64> {
        let inward = negate(&state.normal);
        let local = |parts: &[&Placed<D>], normal: &Vector<D>| -> Option<Vec<Local<D>>> {
            parts.iter().map(|part| Local::new(part, normal)).collect()
        };
        let (local1, local2) = (local(&self.parts1, &state.normal)?, local(&self.parts2, &inward)?);
        let change = solve(equations(state, &local1, &local2));
        let turned: Vector<D> = std::array::from_fn(|i| change[i]);
        // The normal has length one: a longer change is no correction, and Newton's method has
        // failed. A change with a NaN fails too.
        let length = norm(&turned).to_f64();
        let sane = length < 1.5;
        if !sane {
            return None;
        }
        state.normal = unit(&add(&state.normal, &turned))?;
        state.multiple += change[D];
        let (count1, count2) = (local1.len() - 1, local2.len() - 1);
        shift(&mut state.weights1, &change[D + 1..D + 1 + count1]);
        shift(&mut state.weights2, &change[D + 1 + count1..D + 1 + count1 + count2]);
        Some(length)
    }
}

/// Adds `change` to all weights but the first, and subtracts it from the first, so that the sum
/// stays one.
fn shift(weights: &mut [Quad], change: &[Quad]) {
    for (index, &by) in change.iter().enumerate() {
        weights[index + 1] += by;
        weights[0] -= by;
    }
}

/// Sets negative weights to zero and scales the sum to one.
fn proper(weights: &[Quad]) -> Vec<Quad> {
    let kept: Vec<Quad> = weights.iter().map(|weight| weight.max(Quad::ZERO)).collect();
    let sum = kept.iter().fold(Quad::ZERO, |sum, weight| sum + *weight);
    kept.iter().map(|weight| *weight / sum).collect()
}

/// Returns the linear equations of a step, each row with its right side at the end. In this order:
/// the point is a multiple of the normal (D rows), the normal has unit length, the active parts
/// have equal extents.
fn equations<const D: usize>(
    state: &State<D>,
    local1: &[Local<D>],
    local2: &[Local<D>],
) -> Vec<Vec<Quad>> {
    let supports = |local: &[Local<D>]| local.iter().map(|l| l.support).collect::<Vec<_>>();
    let (supports1, supports2) = (supports(local1), supports(local2));
    let point = sub(&mixed(&supports2, &state.weights2), &mixed(&supports1, &state.weights1));
    let away1 = supports1[1..].iter().map(|a| sub(&supports1[0], a));
    let away2 = supports2[1..].iter().map(|b| sub(b, &supports2[0]));
    // The derivative of the point with respect to each weight except the first of each solid.
    let columns: Vec<Vector<D>> = away1.chain(away2).collect();
    let unknowns = D + 1 + columns.len();
    let mut rows = vec![vec![Quad::ZERO; unknowns + 1]; unknowns];
    let bends = || {
        let one = local1.iter().zip(&state.weights1);
        one.chain(local2.iter().zip(&state.weights2))
    };
    for i in 0..D {
        for (j, entry) in rows[i].iter_mut().enumerate().take(D) {
            let bend = bends().fold(Quad::ZERO, |sum, (l, weight)| sum + l.bend[i][j] * *weight);
            *entry = -bend - if i == j { state.multiple } else { Quad::ZERO };
        }
        rows[i][D] = -state.normal[i];
        rows[D][i] = state.normal[i];
        for (k, column) in columns.iter().enumerate() {
            rows[i][D + 1 + k] = column[i];
            rows[D + 1 + k][i] = column[i];
        }
        rows[i][unknowns] = state.multiple * state.normal[i] - point[i];
    }
    let apart1 = local1[1..].iter().map(|l| local1[0].extent - l.extent);
    let apart2 = local2[1..].iter().map(|l| local2[0].extent - l.extent);
    for (k, difference) in apart1.chain(apart2).enumerate() {
        // `difference` is `column · normal` for both solids. The extents of the second solid are
        // measured along `-normal`, so its heights along `normal` are the negated extents. The step
        // must cancel this difference.
        rows[D + 1 + k][unknowns] = -difference;
    }
    rows
}
