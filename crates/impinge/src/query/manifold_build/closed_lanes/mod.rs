//! Balls, segments and capsules, eight pairs at a time.
//!
//! Pairs whose separation is one closed form and whose manifold is one point: a ball against a ball, a
//! box, a segment or a capsule, and segments and capsules that are not side by side. Each lane of a
//! vector is another pair, with the operations of the functions for one pair in the same order, so with
//! the same bits; a lone pair of 2D segments or capsules is a batch of one. What is unusual about a pair (a
//! centre in a box, cores that cross, solids too small or too large to be squared, more than one point, numbers
//! that are none) is declined and goes one by one.
//!
//! The idea of lanes across pairs is that of bepuphysics (R. Nordby).

mod ball_ball;
mod ball_cuboid;
mod ball_segment;
mod gather;
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
use self::gather::Inputs;
use self::segments2::Segments2;
use self::segments3::Segments3;
pub(crate) use self::solid::Solid;
use self::vectors::{bits, is_finite};
use super::box_lanes::transposed;
use super::{Candidate, Pair, choose, names};
use crate::convex::Separation;
use crate::math::lanes::with_lanes;
use crate::math::simd::{Level, Simd};
use crate::math::{Point, Pose, Real, Space, Vector, Wide};
use crate::query::{ManifoldRequest, RawManifold};
use crate::shape::{FeatureId, Geometry};

/// How many pairs are treated at once.
const LANES: usize = 8;

/// A pair of solids in canonical order and what is asked of it.
pub(crate) struct PairQuestion<'a, N: Real, const D: usize> {
    pub(crate) poses: [&'a Pose<N, D>; 2],
    pub(crate) solids: [&'a Solid<N, D>; 2],
    pub(crate) request: &'a ManifoldRequest<N>,
}

/// Pairs of the same kinds whose manifolds are kept somewhere.
pub(crate) trait KeptPairs<N: Real, const D: usize> {
    /// How many there are.
    fn len(&self) -> usize;

    /// Begins the update of a pair, if it needs one.
    fn begin(&mut self, index: usize) -> Option<PairQuestion<'_, N, D>>;

    /// What [`Self::begin`] answered, and the manifold of the last update, which is to be replaced.
    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>);

    /// The manifold alone.
    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D>;

    /// The manifold of a pair is as it will be.
    fn end(&mut self, index: usize);
}

/// Brings pairs of the plane up to date, of which these are the solids of the first; `false` if there
/// are no lanes for pairs of their kinds.
pub(crate) fn update_pairs2<N: Space<2>>(
    solids: [&Solid<N, 2>; 2],
    pairs: &mut impl KeptPairs<N, 2>,
) -> bool {
    let are_segments = solids.iter().all(|solid| solid.is_segment());
    if are_segments {
        update_at::<Segments2, _, _, 2>(Level::new(), pairs);
    }
    are_segments || update_with_ball(solids, pairs)
}

/// The manifold of two segments or capsules of the plane; answers whether the pair is one.
pub(super) fn build_segments2<N: Space<2>>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, 2>,
) -> bool {
    let solid = |kind| Solid::of(Geometry(kind)).filter(Solid::is_segment);
    let (Some(first), Some(second)) = (solid(pair.first), solid(pair.second)) else { return false };
    let poses = [Pose::identity(), pair.pose12];
    let mut alone = Alone { poses, solids: [first, second], request, raw };
    update_at::<Segments2, _, _, 2>(Level::new(), &mut alone);
    true
}

/// A batch of one.
struct Alone<'a, N: Real, const D: usize> {
    poses: [Pose<N, D>; 2],
    solids: [Solid<N, D>; 2],
    request: &'a ManifoldRequest<N>,
    raw: &'a mut RawManifold<N, D>,
}

impl<N: Real, const D: usize> KeptPairs<N, D> for Alone<'_, N, D> {
    fn len(&self) -> usize {
        1
    }

    fn begin(&mut self, index: usize) -> Option<PairQuestion<'_, N, D>> {
        Some(self.parts(index).0)
    }

    fn parts(&mut self, _: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>) {
        let (poses, solids) = (self.poses.each_ref(), self.solids.each_ref());
        (PairQuestion { poses, solids, request: self.request }, self.raw)
    }

    fn raw(&mut self, _: usize) -> &mut RawManifold<N, D> {
        self.raw
    }

    fn end(&mut self, _: usize) {}
}

/// Brings pairs of space up to date, as [`update_pairs2`].
pub(crate) fn update_pairs3<N: Space<3>>(
    solids: [&Solid<N, 3>; 2],
    pairs: &mut impl KeptPairs<N, 3>,
) -> bool {
    let are_segments = solids.iter().all(|solid| solid.is_segment());
    if are_segments {
        update_at::<Segments3, _, _, 3>(Level::new(), pairs);
    }
    are_segments || update_with_ball(solids, pairs)
}

/// Brings pairs of a ball and another solid up to date, as [`update_pairs2`].
fn update_with_ball<N: Space<D>, const D: usize>(
    solids: [&Solid<N, D>; 2],
    pairs: &mut impl KeptPairs<N, D>,
) -> bool {
    let level = Level::new();
    match solids {
        [Solid::Ball(_), Solid::Ball(_)] => update_at::<BallBall, _, _, D>(level, pairs),
        [Solid::Ball(_), Solid::Cuboid(_)] | [Solid::Cuboid(_), Solid::Ball(_)] => {
            update_at::<BallCuboid, _, _, D>(level, pairs);
        }
        [Solid::Ball(_), _] | [_, Solid::Ball(_)] => {
            update_at::<BallSegment, _, _, D>(level, pairs);
        }
        _ => return false,
    }
    true
}

impl<'a, N: Real, const D: usize> PairQuestion<'a, N, D> {
    fn pair(&self) -> Pair<'a, N, D> {
        Pair::new(self.solids.map(|solid| Geometry(solid.kind())), self.poses)
    }
}

/// A closed form in lanes.
trait Form<N: Real, const D: usize> {
    /// Puts the numbers of a pair into a lane; answers whether the pair is one for this form.
    fn gather(inputs: &mut Inputs<N, D>, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool;

    /// The contacts of eight pairs.
    fn find<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        inputs: &Inputs<N, D>,
        found: &mut Found<N, D>,
    );

    /// The features of the two solids that a pair's byte of [`Found::parts`] stands for.
    fn features(parts: u8) -> [FeatureId; 2];

    /// The manifold of a pair that is declined.
    #[inline(never)]
    fn fall_back(pair: &Pair<'_, N, D>, request: &ManifoldRequest<N>, raw: &mut RawManifold<N, D>)
    where
        N: Space<D>,
    {
        (N::tables().contacts)(pair, request, raw);
    }
}

/// [`Form`] for all pairs, with the vectors of an instruction set.
fn update_at<F: Form<N, D>, P: KeptPairs<N, D>, N: Space<D>, const D: usize>(
    level: Level,
    pairs: &mut P,
) {
    with_lanes!(level, simd => update::<F, P, _, N, N::Lanes<_>, D>(simd, pairs));
}

/// Eight by eight. The numbers of the next eight are gathered before those gathered last are used,
/// which gives the memory time to put them together.
#[inline(always)]
fn update<F, P, S: Simd, N: Space<D>, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    pairs: &mut P,
) where
    F: Form<N, D>,
    P: KeptPairs<N, D>,
{
    let (mut now, mut next) = (&mut Inputs::new(), &mut Inputs::new());
    let mut found = Found::new();
    let mut from = now.gather::<F, P>(pairs, 0);
    while now.count > 0 {
        from = next.gather::<F, P>(pairs, from);
        F::find::<S, V>(simd, now, &mut found);
        found.is_found &= now.is_usable;
        found.is_apart &= now.is_usable;
        let parts = transposed(u64::from_le_bytes(found.parts)).to_le_bytes();
        let taken = now.places.iter().zip(parts).take(now.count);
        for (lane, (&index, parts)) in taken.enumerate() {
            if !found.settle::<F>(lane, parts, pairs.raw(index)) {
                let (question, raw) = pairs.parts(index);
                F::fall_back(&question.pair(), question.request, raw);
            }
            pairs.end(index);
        }
        core::mem::swap(&mut now, &mut next);
    }
}

/// The contacts of eight pairs.
struct Found<N: Real, const D: usize> {
    normal: [[N; LANES]; D],
    gap: [N; LANES],
    /// The first and the second contact: the points on the first solid, and the distances, of which that of a
    /// lone contact is the gap.
    points1: [[[N; LANES]; D]; 2],
    distances: [[N; LANES]; 2],
    /// Lengths up to this are rounding errors, where there are two contacts.
    tolerance: [N; LANES],
    /// Eight masks that tell what the points lie on, the same number of each pair; what they mean is up
    /// to the form. Where there are two contacts, four are of the first.
    parts: [u8; LANES],
    /// The lanes that are too far apart, those that have a contact, and those that have two. The others are
    /// declined.
    is_apart: u8,
    is_found: u8,
    is_two: u8,
}

impl<N: Real, const D: usize> Found<N, D> {
    fn new() -> Self {
        let row = [N::ZERO; LANES];
        Self {
            normal: [row; D],
            gap: row,
            points1: [[row; D]; 2],
            distances: [row; 2],
            tolerance: row,
            parts: [0; LANES],
            is_apart: 0,
            is_found: 0,
            is_two: 0,
        }
    }

    /// What is known of eight pairs, where that is usual: the distance, the normal and the point on the
    /// first solid.
    #[inline(always)]
    fn put<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        inputs: &Inputs<N, D>,
        (distance, is_usual): (V, V::Mask),
        [normal, point1]: [&[V; D]; 2],
    ) {
        let prediction = inputs.prediction::<S, V>(simd);
        let is_usual = is_usual & is_finite(simd, distance);
        self.is_apart = bits(distance.simd_gt(prediction) & is_usual);
        self.is_found = bits(distance.simd_le(prediction) & is_usual);
        distance.store(&mut self.gap);
        for axis in 0..D {
            normal[axis].store(&mut self.normal[axis]);
            point1[axis].store(&mut self.points1[0][axis]);
        }
    }

    /// Replaces the manifold of one pair; answers whether that was possible.
    #[inline(always)]
    fn settle<F: Form<N, D>>(&self, lane: usize, parts: u8, raw: &mut RawManifold<N, D>) -> bool {
        let [is_found, is_apart, is_two] =
            [self.is_found, self.is_apart, self.is_two].map(|lanes| lanes >> lane & 1 == 1);
        if is_found {
            raw.normal = vector(&self.normal, lane);
            if is_two {
                self.settle_two([F::features(parts), F::features(parts >> 4)], lane, raw);
                return true;
            }
            let (point1, distance) = (vector(&self.points1[0], lane), self.gap[lane & (LANES - 1)]);
            let features = F::features(parts);
            match raw.points.as_mut_slice() {
                [old] if [old.feature1, old.feature2] == features => {
                    old.point1 = Point::from(point1);
                    old.distance = distance;
                }
                _ => replace((point1, distance), features, raw),
            }
        } else if is_apart {
            raw.points.clear();
        }
        is_found | is_apart
    }

    /// Two contacts, whose normal is given.
    fn settle_two(&self, features: [[FeatureId; 2]; 2], lane: usize, raw: &mut RawManifold<N, D>) {
        let lane = lane & (LANES - 1);
        let mut candidates = [0, 1].map(|which| Candidate {
            point1: Point::from(vector(&self.points1[which], lane)),
            distance: self.distances[which][lane],
            flat: Vector::<N, 2>::zeros(),
            features: features[which],
            kept_id: None,
        });
        choose(&mut candidates, (self.gap[lane], self.tolerance[lane]), 2, raw);
    }
}

/// Makes a point the only one of a manifold which had another, or others.
#[inline(never)]
fn replace<N: Real, const D: usize>(
    (point, distance): (Vector<N, D>, N),
    features: [FeatureId; 2],
    raw: &mut RawManifold<N, D>,
) {
    let (point1, point2) = (Point::from(point), Point::from(point));
    let found = Separation { distance, normal: raw.normal, point1, point2 };
    names::settle_alone(&Candidate::alone(&found, features), raw);
}

/// The vector of one lane.
#[inline(always)]
fn vector<N: Real, const D: usize>(rows: &[[N; LANES]; D], lane: usize) -> Vector<N, D> {
    let mut vector = Vector::<N, D>::zeros();
    for axis in 0..D {
        vector[axis] = rows[axis][lane & (LANES - 1)];
    }
    vector
}
