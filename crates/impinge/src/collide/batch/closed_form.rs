//! Pairs whose separation is one closed form: a ball against a ball, a box, a segment or a capsule, and segments
//! and capsules. Their manifold is one point, of segments of the plane perhaps two.

use core::marker::PhantomData;

use super::gather::{Inputs, RelativePoses};
use super::masks::turned;
use super::vectors::{bits, is_finite};
use super::{Batch, LANES, LaneResult, PairQuestion};
use crate::collide::manifold::{Candidate, PointChoice, choose, ids};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::math::simd::Simd;
use crate::math::{Point, Real, Space, Vector, Wide};
use crate::shape::FeatureId;

/// A closed form in lanes.
pub(super) trait Form<N: Real, const D: usize> {
    /// As [`Batch::gather`].
    fn gather(inputs: &mut Inputs<N, D>, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool;

    /// The contacts of eight pairs.
    fn find<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        inputs: &Inputs<N, D>,
        found: &mut EightContacts<N, D>,
    );

    /// Neither solid is a ball.
    const KEEPS_POSE: bool = false;

    /// The features of the two solids that a pair's byte of [`EightContacts::parts`] stands for.
    fn features(parts: u8) -> [FeatureId; 2];

    /// As [`Batch::fall_back`].
    #[inline(never)]
    fn fall_back(pair: &Pair<'_, N, D>, request: &ManifoldRequest<N>, raw: &mut RawManifold<N, D>)
    where
        N: Space<D>,
    {
        (N::tables().contacts)(pair, request, raw);
    }
}

/// A batch of pairs with such a form.
pub(super) struct ClosedForm<F>(PhantomData<F>);

impl<F: Form<N, D>, N: Space<D>, const D: usize> Batch<N, D> for ClosedForm<F> {
    type Found = EightContacts<N, D>;

    fn blank() -> Self::Found {
        EightContacts::new()
    }

    #[inline(always)]
    fn gather(inputs: &mut Inputs<N, D>, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool {
        F::gather(inputs, lane, pair)
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        inputs: &Inputs<N, D>,
        found: &mut EightContacts<N, D>,
    ) {
        F::find::<S, V>(simd, inputs, found);
        found.is_found &= inputs.is_usable;
        found.is_apart &= inputs.is_usable;
        found.parts = turned(found.parts);
    }

    #[inline(always)]
    fn settle(
        found: &EightContacts<N, D>,
        lane: usize,
        _: usize,
        raw: &mut RawManifold<N, D>,
    ) -> LaneResult {
        found.settle::<F>(lane, raw)
    }

    fn settle_matched(
        found: &Self::Found,
        lane: usize,
        _: usize,
        pair: &Pair<'_, N, D>,
        raw: &mut RawManifold<N, D>,
    ) {
        let count = 1 + usize::from(found.is_two >> lane & 1);
        choose(&mut found.candidates::<F>(lane)[..count], &found.choice(lane, pair), raw);
    }

    fn fall_back(pair: &Pair<'_, N, D>, request: &ManifoldRequest<N>, raw: &mut RawManifold<N, D>) {
        F::fall_back(pair, request, raw);
    }
}

/// The contacts of eight pairs.
pub(super) struct EightContacts<N: Real, const D: usize> {
    pub(super) pose: RelativePoses<N, D>,
    pub(super) normal: [[N; LANES]; D],
    pub(super) gap: [N; LANES],
    /// The first and the second contact: the points on the first solid, and the distances, of which that of a
    /// lone contact is the gap.
    pub(super) points1: [[[N; LANES]; D]; 2],
    pub(super) distances: [[N; LANES]; 2],
    /// Lengths up to this are rounding errors, where there are two contacts.
    pub(super) tolerance: [N; LANES],
    /// Eight masks that encode what the points lie on, then a byte for each pair; what the bits mean is up to the
    /// form. Where there are two contacts, four are of the first.
    pub(super) parts: [u8; LANES],
    /// The lanes that are too far apart, those that have a contact, and those that have two. The others are
    /// declined.
    pub(super) is_apart: u8,
    pub(super) is_found: u8,
    pub(super) is_two: u8,
}

impl<N: Real, const D: usize> EightContacts<N, D> {
    const fn new() -> Self {
        let row = [N::ZERO; LANES];
        Self {
            pose: RelativePoses::new(),
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
    pub(super) fn put<S: Simd, V: Wide<S, Scalar = N>>(
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

    /// Replaces the manifold of one pair if its points have the features of the old ones.
    #[inline(always)]
    fn settle<F: Form<N, D>>(&self, lane: usize, raw: &mut RawManifold<N, D>) -> LaneResult {
        let lane = lane & (LANES - 1);
        let [is_found, is_apart, is_two] =
            [self.is_found, self.is_apart, self.is_two].map(|lanes| lanes >> lane & 1 == 1);
        if is_apart {
            raw.points.clear();
        } else if !is_found {
            return LaneResult::Declined;
        } else if is_two {
            let candidates = self.candidates::<F>(lane);
            if !ids::renew(&candidates, self.gap[lane], raw) {
                return LaneResult::Unmatched;
            }
        } else if raw.points.is_empty() {
            let id = raw.ids.next();
            raw.points.push(self.candidates::<F>(lane)[0].named(id));
        } else {
            let features = F::features(self.parts[lane]);
            match raw.points.as_mut_slice() {
                [old] if [old.feature1, old.feature2] == features => {
                    old.point1 = Point::from(vector(&self.points1[0], lane));
                    old.distance = self.gap[lane];
                }
                _ => return LaneResult::Unmatched,
            }
        }
        if is_found {
            raw.normal = vector(&self.normal, lane);
            self.keep_pose::<F>(lane, raw);
        }
        LaneResult::Done
    }

    #[inline(always)]
    fn keep_pose<F: Form<N, D>>(&self, lane: usize, raw: &mut RawManifold<N, D>) {
        if F::KEEPS_POSE {
            self.pose.copy_to(lane, &mut raw.pose12);
        } else {
            raw.forget_pose();
        }
    }

    /// The first and the second contact; where there is one, the first.
    fn candidates<F: Form<N, D>>(&self, lane: usize) -> [Candidate<N, D>; 2] {
        let lane = lane & (LANES - 1);
        let is_two = self.is_two >> lane & 1 == 1;
        [0, 1].map(|which| Candidate {
            point1: Point::from(vector(&self.points1[which], lane)),
            distance: if is_two { self.distances[which][lane] } else { self.gap[lane] },
            flat: Vector::<N, 2>::zeros(),
            features: F::features(self.parts[lane] >> (4 * which)),
            kept: None,
        })
    }

    /// What the choice of points is held against; of a lone contact it is of no meaning.
    fn choice<'p>(&self, lane: usize, pair: &'p Pair<'p, N, D>) -> PointChoice<'p, N, D> {
        let lane = lane & (LANES - 1);
        let (normal, distance) = (vector(&self.normal, lane), self.gap[lane]);
        PointChoice { pair, normal, distance, tolerance: self.tolerance[lane], limit: 2 }
    }
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
