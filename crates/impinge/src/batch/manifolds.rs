//! Contact manifolds of many pairs.
//!
//! A chunk is computed in three steps. First its pairs are placed, and pairs that are certainly
//! beyond the prediction are rejected. Then the manifolds of the other pairs are computed: pairs of
//! boxes, balls, segments and capsules are sorted by shape kinds and computed 8 at a time in SIMD
//! lanes. Finally the contact points are written in the order of the pairs.

use crate::math::order::sort_few;
use crate::tables::ByDimension;
use core::ops::Range;

use super::control::Progress;
use super::side::{PreparedSide, pair_at};
use super::{BatchError, Control, ManifoldRows, PairBatch};
use crate::collide::pair::Ordered;
use crate::collide::parts::Between;
use crate::collide::{
    CompositeContacts, KeptPairs, ManifoldRequest, Pair, PairQuestion, Placed, RawManifold, Solid,
    update_pairs2, update_pairs3,
};
use crate::math::{Pose, Real, Space};
use crate::narrow_phase::{ContactPrediction, conforming_points};
use crate::query::{ManifoldView, PairRef, PlacedSolids, Placement};
use crate::shape::{Geometry, ShapeKind};

/// Implements [`PairBatch::manifolds`].
pub(super) fn manifolds<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    (prediction, max_points): (&ContactPrediction<N>, Option<usize>),
    control: &Control<'_>,
    out: &mut ManifoldRows<N, D>,
) -> Result<(), BatchError> {
    out.clear();
    let sides = batch.prepared();
    let max_points = max_points.unwrap_or(conforming_points::<D>()).max(1);
    let request = prediction.request(max_points);
    let work = |range, rows: &mut ManifoldRows<N, D>| chunk(&sides, range, &request, rows);
    Progress::new(control).collect(batch.len(), work, |rows| out.append(rows))
}

/// Appends the contact points of a chunk's pairs to `rows`.
fn chunk<N: Space<D>, const D: usize>(
    sides: &[PreparedSide<'_, N, D>; 2],
    range: Range<usize>,
    request: &ManifoldRequest<N>,
    rows: &mut ManifoldRows<N, D>,
) {
    let near = |index: usize| {
        let [one, other] = pair_at(sides, index);
        Placed::within(&one, &other, request.prediction)
    };
    let mut pairs: Vec<Option<PairManifolds<'_, N, D>>> =
        range.map(|index| near(index).map(PairManifolds::new)).collect();
    update_all(&mut pairs, request);
    for pair in &pairs {
        if let Some(pair) = pair {
            pair.write(rows);
        }
        rows.end_pair();
    }
}

/// Computes the manifolds of all pairs that are not `None`.
fn update_all<N: Space<D>, const D: usize>(
    pairs: &mut [Option<PairManifolds<'_, N, D>>],
    request: &ManifoldRequest<N>,
) {
    let mut by_kinds: Vec<([ShapeKind; 2], usize)> = Vec::new();
    for (index, pair) in pairs.iter_mut().enumerate() {
        let Some(pair) = pair else { continue };
        match &pair.solids {
            Some(solids) => by_kinds.push((kinds_of(solids), index)),
            None => pair.update(request),
        }
    }
    sort_few(&mut by_kinds, |one, other| one < other);
    for group in by_kinds.chunk_by(|one, other| one.0 == other.0) {
        let Some(solids) = pairs[group[0].1].as_ref().and_then(|pair| pair.solids) else {
            continue;
        };
        let mut members = SolidGroup { pairs: &mut *pairs, group, request };
        if !<N::Algorithms>::update_group(solids.each_ref(), &mut members) {
            members.update_one_by_one();
        }
    }
}

fn kinds_of<N: Real, const D: usize>(solids: &[Solid<N, D>; 2]) -> [ShapeKind; 2] {
    [Geometry(solids[0].kind()).kind(), Geometry(solids[1].kind()).kind()]
}

/// A pair that may be within the prediction according to its bounds, with its contacts.
struct PairManifolds<'a, N: Real, const D: usize> {
    /// Both solids with their poses, in the canonical order of
    /// [`canonical`](crate::collide::canonical).
    placed: [Placed<'a, N, D>; 2],
    /// Whether the canonical order is the reverse of the caller's order.
    is_swapped: bool,
    /// Copies of the solids in canonical order; `None` unless each is a ball, a segment, a capsule
    /// or a box, the kinds with SIMD kernels.
    solids: Option<[Solid<N, D>; 2]>,
    /// Contacts of two convex solids, in the frame of the first one in canonical order.
    raw: RawManifold<N, D>,
    /// Contacts of a pair with a composite; `None` for two convex solids.
    composite: Option<CompositeContacts<N, D>>,
}

impl<'a, N: Space<D>, const D: usize> PairManifolds<'a, N, D> {
    fn new([one, other]: [Placed<'a, N, D>; 2]) -> Self {
        let is_swapped = Ordered::new(&one, &other).swapped;
        let placed = if is_swapped { [other, one] } else { [one, other] };
        let solids = Solid::of(placed[0].shape).zip(Solid::of(placed[1].shape));
        let solids = solids.map(<[_; 2]>::from);
        Self { placed, is_swapped, solids, raw: RawManifold::default(), composite: None }
    }

    fn ordered(&self) -> Ordered<'_, 'a, N, D> {
        let [first, second] = &self.placed;
        Ordered { first, second, swapped: self.is_swapped }
    }

    /// Computes the manifolds of this pair.
    fn update(&mut self, request: &ManifoldRequest<N>) {
        let ordered = self.ordered();
        if ordered.has_composite() {
            let mut contacts = CompositeContacts::default();
            contacts.update(&Between::of_ordered(&ordered), false, request);
            self.composite = Some(contacts);
        } else {
            let pair: Pair<'_, N, D> = ordered.pair();
            <N::Algorithms>::contacts(&pair, request, &mut self.raw);
        }
    }

    /// Appends all contact points of the pair to `rows`.
    fn write(&self, rows: &mut ManifoldRows<N, D>) {
        let pose1 = &self.placed[0].pose;
        let placement = Placement { pose1, pair: 0, is_swapped: self.is_swapped };
        let pair = PairRef::new(self, [self.is_swapped, !self.is_swapped].map(u32::from));
        if let Some(contacts) = &self.composite {
            let views = (0..).map_while(|patch| contacts.view(patch, placement, pair));
            (0..).zip(views).for_each(|(manifold, view)| rows.push(manifold, &view));
        } else if !self.raw.points.is_empty() {
            rows.push(0, &ManifoldView::of_convex(&self.raw, placement, pair));
        }
    }
}

/// Object 0 is the first shape in canonical order, object 1 the second.
impl<N: Real, const D: usize> PlacedSolids<N, D> for PairManifolds<'_, N, D> {
    fn placed(&self, object: u32) -> (&Pose<N, D>, Geometry<'_, N, D>) {
        let placed = &self.placed[object as usize];
        (&placed.pose, placed.shape)
    }
}

/// The pairs of a chunk whose solids have the same two kinds. If these kinds have a kernel, it
/// computes the pairs in SIMD lanes.
pub(crate) struct SolidGroup<'g, 'a, N: Real, const D: usize> {
    pairs: &'g mut [Option<PairManifolds<'a, N, D>>],
    /// For each pair in the group: the kinds of its solids, and its index in `pairs`.
    group: &'g [([ShapeKind; 2], usize)],
    request: &'g ManifoldRequest<N>,
}

impl<'a, N: Space<D>, const D: usize> SolidGroup<'_, 'a, N, D> {
    fn pair(&mut self, index: usize) -> &mut PairManifolds<'a, N, D> {
        self.pairs[self.group[index].1].as_mut().expect("all pairs of a group are near")
    }

    /// Computes the pairs one by one, for kinds without a SIMD kernel.
    fn update_one_by_one(&mut self) {
        let request = self.request;
        (0..self.group.len()).for_each(|index| self.pair(index).update(request));
    }
}

impl<N: Space<D>, const D: usize> KeptPairs<N, D> for SolidGroup<'_, '_, N, D> {
    #[inline(always)]
    fn len(&self) -> usize {
        self.group.len()
    }

    #[inline(always)]
    fn begin(&mut self, index: usize) -> PairQuestion<'_, N, D> {
        self.parts(index).0
    }

    #[inline(always)]
    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>) {
        let request = self.request;
        let PairManifolds { placed, solids, raw, .. } = self.pair(index);
        let solids = solids.as_ref().expect("all pairs of a group have copies of their solids");
        let (poses, solids) = ([&placed[0].pose, &placed[1].pose], [&solids[0], &solids[1]]);
        (PairQuestion { poses, solids, request }, raw)
    }

    #[inline(always)]
    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D> {
        &mut self.pair(index).raw
    }

    #[inline(always)]
    fn end(&mut self, _: usize) {}
}

/// Computes a group of 2D pairs in SIMD lanes by [`update_pairs2`]; returns `false` if the kinds
/// have no kernel.
pub(crate) fn update_group2<N: Space<2>>(
    solids: [&Solid<N, 2>; 2],
    group: &mut SolidGroup<'_, '_, N, 2>,
) -> bool {
    update_pairs2(solids, group)
}

/// Computes a group of 3D pairs in SIMD lanes by [`update_pairs3`]; returns `false` if the kinds
/// have no kernel.
pub(crate) fn update_group3<N: Space<3>>(
    solids: [&Solid<N, 3>; 2],
    group: &mut SolidGroup<'_, '_, N, 3>,
) -> bool {
    update_pairs3(solids, group)
}
