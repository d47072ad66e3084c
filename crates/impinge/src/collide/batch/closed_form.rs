//! Manifolds of pairs whose separation has a closed form: a ball with a ball, a box, a segment or a
//! capsule, and two segments or capsules. The manifold has one point; for two segments or capsules
//! in 2D, up to two.
//!
//! ```text
//!   rows of `LaneContacts::parts`, each a mask over the lanes
//!     ball, box      i < D: the feature of the box extends along axis i
//!                    D + i: coordinate i of the point on the box is not negative
//!     ball, segment  0, 1: the point is at the first, at the last end of the segment
//!     two segments   0, 1: at the first, last end of segment 1;  2, 3: of segment 2
//!                    4 .. 8: rows 0 .. 4 of the second contact
//!
//!   `per_pair`: row r, bit lane  -->  byte lane, bit r, which `Form::features` decodes
//! ```

use core::marker::PhantomData;

use super::gather::Inputs;
use super::masks::per_pair;
use super::vectors::{bits, is_finite};
use super::{Batch, PairQuestion};
use crate::collide::manifold::ids::{PairPose, is_same_point};
use crate::collide::manifold::{Candidate, PointChoice, choose};
use crate::collide::{RawManifold, RawPoint};
use crate::math::simd::Simd;
use crate::math::{Mapped, Point, Real, Space, Vector, Wide};
use crate::shape::FeatureId;

/// Kernel for pairs whose separation has a closed form.
pub(super) trait Form<N: Real, const D: usize> {
    /// Copies the inputs of a pair into a lane; returns whether the form supports the pair.
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool;

    /// Computes the contacts of all lanes and stores them in `found`.
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut LaneContacts<N, D, L>,
    );

    /// Decodes a pair's byte of [`LaneContacts::parts`] into the features of both solids.
    fn features(parts: u8) -> [FeatureId; 2];
}

/// Adapts a [`Form`] to a [`Batch`].
pub(super) struct ClosedForm<F>(PhantomData<F>);

impl<F: Form<N, D>, N: Space<D>, const D: usize> Batch<N, D> for ClosedForm<F> {
    type Found<const L: usize> = LaneContacts<N, D, L>;

    fn blank<const L: usize>() -> LaneContacts<N, D, L> {
        LaneContacts::new()
    }

    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, D, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, D>,
    ) -> bool {
        F::gather(inputs, lane, pair)
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, D, L>,
        found: &mut LaneContacts<N, D, L>,
    ) {
        F::find::<S, V, L>(simd, inputs, found);
        found.is_found &= inputs.is_usable;
        found.is_apart &= inputs.is_usable;
        found.parts = per_pair(found.parts);
    }

    #[inline(always)]
    fn write_manifold<const L: usize>(
        found: &LaneContacts<N, D, L>,
        lane: usize,
        _: usize,
        raw: &mut RawManifold<N, D>,
    ) -> bool {
        found.write_manifold::<F>(lane & (L - 1), raw)
    }
}

/// Contacts of `L` pairs.
pub(super) struct LaneContacts<N: Real, const D: usize, const L: usize> {
    /// Unit normals from the first solid to the second, in the frame of the first.
    pub(super) normal: [[N; L]; D],
    /// Signed distances of the pairs; negative for overlaps.
    pub(super) gap: [N; L],
    /// Size of each pair, as `collide::size` defines it.
    pub(super) size: [N; L],
    /// Points of the first and second contact, on the first solid and in its frame.
    pub(super) points1: [[[N; L]; D]; 2],
    /// Signed distances of both contacts; unused in lanes with one contact, whose distance is
    /// `gap`.
    pub(super) distances: [[N; L]; 2],
    /// Largest length that counts as a rounding error; zero in kernels that never find two
    /// contacts, because no choice between points depends on it there.
    pub(super) tolerance: [N; L],
    /// Before transposition, masks of the parts that the points lie on (see the figure); after it,
    /// one byte per pair, which [`Form::features`] decodes. With two contacts, the low four bits of
    /// a byte belong to the first contact.
    pub(super) parts: [u8; 8],
    /// Bits of the lanes beyond the prediction, which have no contact.
    pub(super) is_apart: u8,
    /// Bits of the lanes with a contact. Lanes in neither `is_apart` nor `is_found` fall back.
    pub(super) is_found: u8,
    /// Bits of the lanes with two contacts.
    pub(super) is_two: u8,
}

impl<N: Real, const D: usize, const L: usize> LaneContacts<N, D, L> {
    /// Returns contacts with all masks empty.
    const fn new() -> Self {
        let row = [N::ZERO; L];
        Self {
            normal: [row; D],
            gap: row,
            size: row,
            points1: [[row; D]; 2],
            distances: [row; 2],
            tolerance: row,
            parts: [0; 8],
            is_apart: 0,
            is_found: 0,
            is_two: 0,
        }
    }

    /// Stores the distances, normals and points on the first solid, and sets `is_apart` and
    /// `is_found`. The arguments are valid only in the lanes of `is_certain`; the other lanes fall
    /// back.
    #[inline(always)]
    pub(super) fn put<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        inputs: &Inputs<N, D, L>,
        (distance, is_certain): (V, V::Mask),
        [normal, point1]: [&[V; D]; 2],
    ) {
        let prediction = inputs.prediction::<S, V>(simd);
        let is_certain = is_certain & is_finite(simd, distance);
        self.is_apart = bits(distance.simd_gt(prediction) & is_certain);
        self.is_found = bits(distance.simd_le(prediction) & is_certain);
        distance.store(&mut self.gap);
        for axis in 0..D {
            normal[axis].store(&mut self.normal[axis]);
            point1[axis].store(&mut self.points1[0][axis]);
        }
    }

    /// Replaces the manifold of the pair in `lane`; clears its points if the solids are beyond the
    /// prediction. Returns `false`, without a change, if the pair has to fall back.
    #[inline(always)]
    fn write_manifold<F: Form<N, D>>(&self, lane: usize, raw: &mut RawManifold<N, D>) -> bool {
        let [is_found, is_apart, is_two] =
            [self.is_found, self.is_apart, self.is_two].mapped(|lanes| lanes >> lane & 1 == 1);
        if is_apart {
            raw.points.clear();
        }
        if !is_found {
            return is_apart;
        }
        let (features, point1) = (F::features(self.parts[lane]), vector(&self.points1[0], lane));
        let normal = vector(&self.normal, lane);
        let normals = [raw.normal, normal];
        // A single point on unchanged features keeps its id and is updated in place, unless it is a
        // crossing of two edges that jumped or turned.
        let is_same = |old: &RawPoint<N, D>| {
            let (moved, size) = (point1 - old.point1.coords, || self.size[lane]);
            [old.feature1, old.feature2] == features
                && is_same_point(features, &moved, || normals, size)
        };
        match raw.points.as_mut_slice() {
            [old] if !is_two && is_same(old) => {
                old.point1 = Point::from(point1);
                old.distance = self.gap[lane];
                raw.normal = normal;
            }
            [] if !is_two => {
                let id = raw.ids.next();
                let ([feature1, feature2], distance) = (features, self.gap[lane]);
                let point1 = Point::from(point1);
                raw.points.push(RawPoint { point1, distance, feature1, feature2, id, code: 0 });
                raw.normal = normal;
            }
            _ => self.choose::<F>(lane, 1 + usize::from(is_two), raw),
        }
        true
    }

    /// Replaces the points of the pair in `lane` by `count` contacts, keeping ids by the rules of
    /// `manifold::choose`.
    #[inline(never)]
    fn choose<F: Form<N, D>>(&self, lane: usize, count: usize, raw: &mut RawManifold<N, D>) {
        let mut candidates = [0, 1].mapped(|which| Candidate {
            point1: Point::from(vector(&self.points1[which], lane)),
            distance: if count > 1 { self.distances[which][lane] } else { self.gap[lane] },
            flat: Vector::<N, 2>::zeros(),
            features: F::features(self.parts[lane] >> (4 * which)),
            kept: None,
        });
        let choice = PointChoice {
            pose: PairPose { pose12: None, normal: &vector(&self.normal, lane) },
            size: &|| self.size[lane],
            distance: self.gap[lane],
            tolerance: self.tolerance[lane],
            limit: 2,
        };
        choose(&mut candidates[..count], &choice, raw);
    }
}

/// Returns the vector of one lane.
#[inline(always)]
fn vector<N: Real, const D: usize, const L: usize>(
    rows: &[[N; L]; D],
    lane: usize,
) -> Vector<N, D> {
    let mut vector = Vector::<N, D>::zeros();
    for axis in 0..D {
        vector[axis] = rows[axis][lane & (L - 1)];
    }
    vector
}
