//! Pairs of boxes, balls, segments and capsules, eight at a time; a lone pair is a batch of one.
//!
//! Each lane of a vector is another pair, and never looks at its neighbours: the bits of a pair do not depend on
//! the batch. The numbers of eight pairs are gathered ([`gather`]), a kernel finds what it can of all of them
//! ([`Batch`]), then manifold by manifold is replaced. Degenerate pairs (a centre in a box, cores that cross, solids
//! too small or too large to be squared, NaN) fall back to the builder for one pair.
//!
//! The idea of lanes across pairs is that of bepuphysics (R. Nordby).

mod ball_ball;
mod ball_cuboid;
mod ball_segment;
mod boxes;
mod closed_form;
mod convex;
mod gather;
mod masks;
mod nearest;
mod segments2;
mod segments3;
mod solid;
#[cfg(test)]
mod tests;
mod vectors;

use self::ball_ball::BallBall;
use self::ball_cuboid::BallCuboid;
use self::ball_segment::BallSegment;
use self::boxes::{Boxes2, Boxes3};
use self::closed_form::ClosedForm;
pub(crate) use self::convex::{ConvexPair, distances2, distances3, separations2, separations3};
use self::gather::Inputs;
use self::segments2::Segments2;
use self::segments3::Segments3;
pub(crate) use self::solid::Solid;
use super::Pair;
use crate::collide::{ManifoldRequest, RawManifold};
use crate::math::lanes::in_lanes;
use crate::math::simd::{Level, Run, Simd};
use crate::math::{Mapped, Pose, Real, Space, Wide};
use crate::shape::Geometry;

/// How many pairs are treated at once.
const LANES: usize = 8;

/// A pair of solids in canonical order and what is asked of it.
pub(crate) struct PairQuestion<'a, N: Real, const D: usize> {
    pub(crate) poses: [&'a Pose<N, D>; 2],
    pub(crate) solids: [&'a Solid<N, D>; 2],
    pub(crate) request: &'a ManifoldRequest<N>,
}

impl<'a, N: Real, const D: usize> PairQuestion<'a, N, D> {
    fn pair(&self) -> Pair<'a, N, D> {
        Pair::new(self.solids.mapped(|solid| Geometry(solid.kind())), self.poses)
    }
}

/// Pairs of the same kinds whose manifolds are kept somewhere.
pub(crate) trait KeptPairs<N: Real, const D: usize> {
    /// How many there are.
    fn len(&self) -> usize;

    /// Begins the update of a pair.
    fn begin(&mut self, index: usize) -> PairQuestion<'_, N, D>;

    /// What [`Self::begin`] answered, and the manifold of the last update, which is to be replaced.
    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>);

    /// The manifold alone.
    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D>;

    /// The manifold of a pair is as it will be.
    fn end(&mut self, index: usize);
}

/// An algorithm for pairs of two kinds, eight at a time.
trait Batch<N: Real, const D: usize> {
    /// What is known of eight pairs before their manifolds are replaced.
    type Found;

    /// Nothing yet.
    fn blank() -> Self::Found;

    /// Puts the numbers of a pair into a lane; answers whether the pair is one for this algorithm.
    fn gather(inputs: &mut Inputs<N, D>, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool;

    /// Everything that goes for eight pairs at once, or for one of them.
    fn find<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        inputs: &Inputs<N, D>,
        found: &mut Self::Found,
    );

    /// Replaces the manifold of one pair by at most `max_points` points; answers whether the pair is not declined.
    fn settle(
        found: &Self::Found,
        lane: usize,
        max_points: usize,
        raw: &mut RawManifold<N, D>,
    ) -> bool;

    /// The manifold of a pair that is declined.
    fn fall_back(pair: &Pair<'_, N, D>, request: &ManifoldRequest<N>, raw: &mut RawManifold<N, D>);
}

/// Brings pairs of the plane up to date, of which these are the solids of the first; `false` if there
/// are no lanes for pairs of their kinds.
pub(crate) fn update_pairs2<N: Space<2>>(
    solids: [&Solid<N, 2>; 2],
    pairs: &mut impl KeptPairs<N, 2>,
) -> bool {
    let level = Level::new();
    match solids {
        [Solid::Cuboid(_), Solid::Cuboid(_)] => update_at::<Boxes2, _, _, 2>(level, pairs),
        [one, other] if one.is_segment() && other.is_segment() => {
            update_at::<ClosedForm<Segments2>, _, _, 2>(level, pairs);
        }
        _ => return update_with_ball(solids, pairs),
    }
    true
}

/// Brings pairs of space up to date, as [`update_pairs2`].
pub(crate) fn update_pairs3<N: Space<3>>(
    solids: [&Solid<N, 3>; 2],
    pairs: &mut impl KeptPairs<N, 3>,
) -> bool {
    let level = Level::new();
    match solids {
        [Solid::Cuboid(_), Solid::Cuboid(_)] => update_at::<Boxes3, _, _, 3>(level, pairs),
        [one, other] if one.is_segment() && other.is_segment() => {
            update_at::<ClosedForm<Segments3>, _, _, 3>(level, pairs);
        }
        _ => return update_with_ball(solids, pairs),
    }
    true
}

/// Brings pairs of a ball and another solid up to date, as [`update_pairs2`].
fn update_with_ball<N: Space<D>, const D: usize>(
    solids: [&Solid<N, D>; 2],
    pairs: &mut impl KeptPairs<N, D>,
) -> bool {
    let level = Level::new();
    match solids {
        [Solid::Ball(_), Solid::Ball(_)] => {
            update_at::<ClosedForm<BallBall>, _, _, D>(level, pairs);
        }
        [Solid::Ball(_), Solid::Cuboid(_)] | [Solid::Cuboid(_), Solid::Ball(_)] => {
            update_at::<ClosedForm<BallCuboid>, _, _, D>(level, pairs);
        }
        [Solid::Ball(_), _] | [_, Solid::Ball(_)] => {
            update_at::<ClosedForm<BallSegment>, _, _, D>(level, pairs);
        }
        _ => return false,
    }
    true
}

/// The manifold of two boxes, segments or capsules of the plane as a batch of one; answers whether they are.
pub(super) fn build2<N: Space<2>>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, 2>,
) -> bool {
    match solids(pair) {
        Some([one, other]) if one.is_segment() && other.is_segment() => {
            build::<ClosedForm<Segments2>, _, 2>([one, other], pair, request, raw)
        }
        Some([one @ Solid::Cuboid(_), other @ Solid::Cuboid(_)]) => {
            build::<Boxes2, _, 2>([one, other], pair, request, raw)
        }
        _ => false,
    }
}

/// The manifold of two boxes as a batch of one; answers whether they are.
pub(super) fn build3<N: Space<3>>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, 3>,
) -> bool {
    match solids(pair) {
        Some([one @ Solid::Cuboid(_), other @ Solid::Cuboid(_)]) => {
            build::<Boxes3, _, 3>([one, other], pair, request, raw)
        }
        _ => false,
    }
}

/// Copies of both solids.
fn solids<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> Option<[Solid<N, D>; 2]> {
    Some([Solid::of(Geometry(pair.first))?, Solid::of(Geometry(pair.second))?])
}

/// A batch of one; returns true.
fn build<B: Batch<N, D>, N: Space<D>, const D: usize>(
    solids: [Solid<N, D>; 2],
    pair: &Pair<'_, N, D>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, D>,
) -> bool {
    let (mut inputs, mut found) = (Inputs::new(), B::blank());
    let poses = [&Pose::identity(), &pair.pose12];
    inputs.put::<B>(0, &PairQuestion { poses, solids: solids.each_ref(), request });
    for run in Level::new().runs(1) {
        find::<B, N, D>(run, &inputs, &mut found);
    }
    if !B::settle(&found, 0, request.max_points, raw) {
        B::fall_back(pair, request, raw);
    }
    true
}

/// [`Batch`] for all pairs, eight by eight. The numbers of the next eight are gathered before those gathered last
/// are used, which gives the memory time to put them together.
fn update_at<B: Batch<N, D>, P: KeptPairs<N, D>, N: Real, const D: usize>(
    level: Level,
    pairs: &mut P,
) {
    let (mut now, mut next) = (&mut Inputs::new(), &mut Inputs::new());
    let mut found = B::blank();
    now.gather::<B, P>(pairs, 0);
    while now.count > 0 {
        next.gather::<B, P>(pairs, now.first + now.count);
        for run in level.runs(now.count) {
            find::<B, N, D>(run, now, &mut found);
            for lane in run.lanes() {
                let index = now.first + lane;
                if !B::settle(&found, lane, now.max_points[lane & (LANES - 1)], pairs.raw(index)) {
                    let (question, raw) = pairs.parts(index);
                    B::fall_back(&question.pair(), question.request, raw);
                }
                pairs.end(index);
            }
        }
        core::mem::swap(&mut now, &mut next);
    }
}

/// [`Batch::find`] of some lanes, compiled once for all that keep pairs.
#[inline(never)]
fn find<B: Batch<N, D>, N: Real, const D: usize>(
    run: Run,
    inputs: &Inputs<N, D>,
    found: &mut B::Found,
) {
    in_lanes!(run, simd => B::find::<_, N::Lanes<_>>(simd, inputs, found));
}
