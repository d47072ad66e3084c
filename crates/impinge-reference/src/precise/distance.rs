//! Signed distance of two placed solids in [`Quad`] precision.

use super::newton::{Pair, Polished, across_disk, is_better, polish};
use super::number::Quad;
use super::polytope::{self, Polytope};
use super::search::{Bracket, Task};
use super::solid::{Kind, Placed, Pose, Solid, extent, height, placed, support64};
use super::topology::Topology;
use super::vector::{Vector, exact, negate, norm, rounded, scale, sub, unit};
use crate::geometry::vector as plain;

/// The result of [`signed_distance`].
#[derive(Clone, Copy, Debug)]
pub struct Precise<const D: usize> {
    /// The separation along `normal`: the signed distance, or a lower bound of it.
    pub distance: Quad,
    /// The unit normal in the world frame, from the first solid to the second; one of several if
    /// the best normal is not unique. The zero vector for two half-spaces, which count as
    /// overlapping without bound.
    pub normal: Vector<D>,
    /// An upper bound of the error of `distance`: the signed distance is at most `distance + gap`.
    /// Proven up to rounding errors of 1e-28 of the size.
    pub gap: f64,
    /// The error with which `normal` satisfies the conditions of a local maximum of the separation,
    /// as a length. If Newton's method has converged, it consists of rounding errors. 0 for pairs
    /// of polytopes or with a half-space, which need no Newton's method.
    pub miss: f64,
    /// The size of the pair: the bounding radii plus the distance of the origins. The radius of a
    /// half-space counts as 0.
    pub size: f64,
}

impl<const D: usize> Precise<D> {
    /// Returns `true` if `distance` is accurate to `share` of the size, or to 1e-20 of the size.
    ///
    /// Either `gap` proves this; or `gap` proves that no other local maximum is higher by more than
    /// 1e-10 of the size, and `miss` shows that Newton's method has converged. (The second case
    /// could fail only if two local maxima agreed to ten digits.)
    #[must_use]
    pub fn is_settled(&self, share: f64) -> bool {
        let small = |length: f64, share: f64| length <= share * self.size;
        small(self.gap, share) || small(self.gap, 1e-10) && small(self.miss, 1e-20)
    }
}

/// Computes the signed distance of two solids: positive if they are disjoint, otherwise minus the
/// length of the shortest translation that separates their interiors.
///
/// - Polytopes, with or without a radius, and a half-space against anything: every candidate
///   direction is tested.
/// - With a disk or ellipsoid: the sphere of directions is searched in `f64`, and Newton's method
///   refines the result to all digits. If the solids are apart or touch, a point of the Minkowski
///   difference proves the result. If they overlap, the search proves that no other direction is
///   better by more than 1e-11 of the size.
///
/// Only the difference of the two translations matters. For two half-spaces the distance is -1e300,
/// which stands for an overlap without bound.
#[must_use]
pub fn signed_distance<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
) -> Precise<D> {
    let size = size(solid1, pose1, solid2, pose2);
    let (found, gap, miss) = match (&solid1.kind, &solid2.kind) {
        (Kind::HalfSpace(_), Kind::HalfSpace(_)) => {
            ((Quad::new(-1e300), [Quad::ZERO; D]), 0.0, 0.0)
        }
        (Kind::HalfSpace(normal), _) => (above(normal, pose1, solid2, pose2), 0.0, 0.0),
        (_, Kind::HalfSpace(normal)) => {
            let (distance, normal) = above(normal, pose2, solid1, pose1);
            ((distance, negate(&normal)), 0.0, 0.0)
        }
        (Kind::Points(points1), Kind::Points(points2)) => {
            let (parts1, parts2) = parts(solid1, pose1, solid2, pose2);
            let (topology1, topology2) = (Topology::new(points1), Topology::new(points2));
            let one = Polytope { parts: &parts1, topology: &topology1 };
            let two = Polytope { parts: &parts2, topology: &topology2 };
            (polytope::distance(&one, &two, size), 0.0, 0.0)
        }
        _ => {
            let (parts1, parts2) = parts(solid1, pose1, solid2, pose2);
            let (found, gap) = curved(Pair { parts1: &parts1, parts2: &parts2 }, size);
            ((found.height, found.normal), gap, found.miss())
        }
    };
    let rounding = Quad::new(solid1.radius) + Quad::new(solid2.radius);
    Precise { distance: found.0 - rounding, normal: found.1, gap, miss, size }
}

/// Returns the least of `normal · b` over the second solid minus the greatest of `normal · a` over
/// the first: for every direction a lower bound of the signed distance. `normal` is normalized
/// first. If one solid is a half-space, the normal of the half-space is used instead of `normal`.
/// `None` for two half-spaces, and for a zero `normal` if neither solid is a half-space.
#[must_use]
pub fn separation_along<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
    normal: &[f64; D],
) -> Option<Quad> {
    let is_half_space = |solid: &Solid<D>| matches!(solid.kind, Kind::HalfSpace(_));
    if is_half_space(solid1) || is_half_space(solid2) {
        let both = is_half_space(solid1) && is_half_space(solid2);
        let found = || signed_distance(solid1, pose1, solid2, pose2).distance;
        return (!both).then(found);
    }
    let normal = unit(&exact(normal))?;
    let (parts1, parts2) = parts(solid1, pose1, solid2, pose2);
    let rounding = Quad::new(solid1.radius) + Quad::new(solid2.radius);
    Some(height(&parts1, &parts2, &normal) - rounding)
}

fn size<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
) -> f64 {
    let radius = |solid: &Solid<D>| {
        let radius = solid.bounding_radius();
        if radius.is_finite() { radius } else { 0.0 }
    };
    let between = plain::sub(&pose2.translation, &pose1.translation);
    radius(solid1) + radius(solid2) + plain::norm(&between)
}

/// Returns the parts of both solids, relative to the origin of the first.
fn parts<const D: usize>(
    solid1: &Solid<D>,
    pose1: &Pose<D>,
    solid2: &Solid<D>,
    pose2: &Pose<D>,
) -> (Vec<Placed<D>>, Vec<Placed<D>>) {
    let origin = &pose1.translation;
    (placed(solid1, pose1, origin), placed(solid2, pose2, origin))
}

/// Returns the height of a solid's core above a half-space, and the world normal of the half-space.
fn above<const D: usize>(
    local: &[f64; D],
    pose: &Pose<D>,
    solid: &Solid<D>,
    solid_pose: &Pose<D>,
) -> (Quad, Vector<D>) {
    let normal = unit(&pose.rotate(&exact(local))).expect("a normal is not zero");
    let parts = placed(solid, solid_pose, &pose.translation);
    (-extent(&parts, &negate(&normal)), normal)
}

/// Returns the best normal of two cores and an upper bound of its gap. At least one of the cores
/// has a disk or ellipsoid.
fn curved<const D: usize>(pair: Pair<'_, D>, size: f64) -> (Polished<D>, f64) {
    let lowest = |normal: &[f64; D]| {
        let on2 = support64(pair.parts2, &plain::negate(normal));
        plain::sub(&on2, &support64(pair.parts1, normal))
    };
    let search = |tolerance: f64, seeds: &[[f64; D]]| -> Bracket<D> {
        Task { lowest: &lowest, size, tolerance }.maximise(seeds)
    };
    let mut seeds: Vec<[f64; D]> = disks(pair).iter().map(|disk| rounded(&disk.normal)).collect();
    let middle = |parts: &[Placed<D>]| parts[0].center;
    seeds.push(rounded(&sub(&middle(pair.parts2), &middle(pair.parts1))));
    let mut best = polished(pair, &search(1e-6, &seeds).normal);
    for disk in disks(pair) {
        if is_better(&disk, &best) {
            best = disk;
        }
    }
    let proven = proven_gap(&best);
    if proven <= 1e-22 * size {
        return (best, proven);
    }
    if best.miss() > 1e-21 * size {
        best = coaxed(pair, best, size);
    }
    let bracket = search(1e-11, &[rounded(&best.normal)]);
    if bracket.lower > best.height.to_f64() + 1e-14 * size || best.miss() > 1e-21 * size {
        let other = coaxed(pair, polished(pair, &bracket.normal), size);
        best = if is_better(&other, &best) { other } else { best };
    }
    let searched = (Quad::new(bracket.upper) - best.height).to_f64().max(0.0);
    (best, proven_gap(&best).min(searched))
}

fn polished<const D: usize>(pair: Pair<'_, D>, start: &[f64; D]) -> Polished<D> {
    let start = unit(&exact(start)).unwrap_or_else(|| exact(&plain::axis(0)));
    polish(pair, &start, 1)
}

/// Improves a normal at which Newton's method did not converge.
///
/// If the solids nearly touch, the separation is almost constant along whole arcs of normals, so
/// small errors move the normal far. Therefore the second solid is first moved away along the
/// normal n by s. The best normal m of the moved pair maximises `h(m) + s m·n`, where h is the
/// separation of the original pair. This maximum is sharp, and `h(m) >= h(n)` (the proximal point
/// method). Then the original pair is tried again, with more choices of active parts.
fn coaxed<const D: usize>(pair: Pair<'_, D>, found: Polished<D>, size: f64) -> Polished<D> {
    const ROUNDS: usize = 6;
    let mut best = found;
    for _ in 0..ROUNDS {
        let by = scale(&best.normal, Quad::new(0.25 * size));
        let moved: Vec<Placed<D>> = pair.parts2.iter().map(|part| part.moved(&by)).collect();
        let away = Pair { parts1: pair.parts1, parts2: &moved };
        let start = polish(away, &best.normal, 4).normal;
        for breadth in [1, 4] {
            let next = polish(pair, &start, breadth);
            if is_better(&next, &best) {
                best = next;
            }
        }
        if best.miss() <= 1e-24 * size {
            break;
        }
    }
    best
}

/// Returns the length of `point`, an upper bound of the separation, minus the separation along the
/// normal. At the best normal the result is near zero if the solids are apart or barely overlap;
/// for deeper overlap it proves nothing.
fn proven_gap<const D: usize>(found: &Polished<D>) -> f64 {
    (norm(&found.point) - found.height).to_f64().max(0.0)
}

/// Returns one candidate for each of the two normals of each disk.
fn disks<const D: usize>(pair: Pair<'_, D>) -> Vec<Polished<D>> {
    let mut found = Vec::new();
    for (parts, is_second) in [(pair.parts1, false), (pair.parts2, true)] {
        for part in parts {
            for normal in part.axes().into_iter().flatten() {
                found.push(across_disk(pair, part, is_second, &normal));
            }
        }
    }
    found
}
