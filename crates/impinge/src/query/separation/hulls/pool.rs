//! The few edges of two solids that may decide, while these move no farther than a little.
//!
//! A pair of edges that is a face of the Minkowski difference stays out of question if its height falls
//! short of that of the best face by more than both may change. Its height changes by the motion of
//! the points, and by the turn of the common perpendicular, which is the larger the less the edges
//! cross. Whether it is a face at all are signs of products that change by no more than the turn of
//! the solids. Distances of edges change by no more than the motion of points.

use super::edges::{Chosen, Edge, Edges, squares};
use super::face::Meeting;
use super::guide::ROOM;
use super::{Found, LANES, noise};
use crate::math::lanes::{self, by_axis, dot, load, spread};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Vector, Wide};

/// So many edges of each solid are noted.
const MOST: usize = 7;

/// What edges are looked at for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Aim {
    /// Not at all.
    #[default]
    Nothing,
    /// Faces of the Minkowski difference.
    Crossing,
    /// The nearest points.
    Nearest,
    Both,
}

/// What edges were looked at for, and within what reach.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked<N> {
    pub(super) aim: Aim,
    pub(super) reach: N,
}

impl<N: Real> Default for Asked<N> {
    fn default() -> Self {
        Self { aim: Aim::Nothing, reach: -N::INFINITY }
    }
}

impl<N: Real> Asked<N> {
    pub(super) const fn crossing(reach: N) -> Self {
        Self { aim: Aim::Crossing, reach }
    }

    pub(super) const fn nearest(reach: N) -> Self {
        Self { aim: Aim::Nearest, reach }
    }

    /// Both.
    pub(super) fn and(self, other: Self) -> Self {
        let aim =
            if self.aim == Aim::Nothing || self.aim == other.aim { other.aim } else { Aim::Both };
        Self { aim, reach: if self.reach > other.reach { self.reach } else { other.reach } }
    }
}

/// The numbers of a few edges, ascending.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Few {
    indices: [u8; MOST],
    len: u8,
}

impl Few {
    /// Those whose numbers are bits, if they are few.
    fn of_bits(bits: u128) -> Option<Self> {
        let chosen = Chosen::of_bits(bits);
        let (len, mut indices) = (chosen.indices().len(), [0; MOST]);
        indices.get_mut(..len)?.copy_from_slice(chosen.indices());
        Some(Self { indices, len: u8::try_from(len).ok()? })
    }

    pub(super) fn indices(&self) -> &[u8] {
        &self.indices[..usize::from(self.len)]
    }
}

/// All edges that may decide, of the solid with the best face and of the other one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pool<N> {
    pub(super) own: Few,
    pub(super) other: Few,
    asked: Asked<N>,
}

/// The same of the first and of the second solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pools<N> {
    pub(super) edges: [Few; 2],
    /// What they are all for.
    pub(super) asked: Asked<N>,
}

impl<N: Real> Pools<N> {
    pub(super) const fn seen_from(&self, is_second: bool) -> Pool<N> {
        let [first, second] = self.edges;
        let (own, other) = if is_second { (second, first) } else { (first, second) };
        Pool { own, other, asked: self.asked }
    }
}

impl<N: Real> Pool<N> {
    pub(super) const fn by_solid(&self, is_second: bool) -> Pools<N> {
        let edges = if is_second { [self.other, self.own] } else { [self.own, self.other] };
        Pools { edges, asked: self.asked }
    }

    /// No other edges can answer this.
    pub(super) fn serves(&self, asked: Asked<N>) -> bool {
        asked.aim == Aim::Nothing || self.asked.aim == asked.aim && asked.reach <= self.asked.reach
    }
}

/// By how much what is known may have changed.
struct Slack<N> {
    /// The motion of points and the turn.
    room: N,
    /// A height that no pair of edges has that falls short of it by now.
    floor: N,
    /// The square of a distance that no pair of edges has that exceeds it by now.
    squared: N,
}

/// Edges of the solid with the best face and of the other one that are within the reach of some face, as
/// bits.
#[derive(Default)]
pub(super) struct Reached([u128; 2]);

impl Reached {
    /// Those of a face, which belongs to the other solid if `is_turned`.
    pub(super) fn add(&mut self, [own, other]: [Chosen; 2], is_turned: bool) {
        let (own, other) = if is_turned { (other, own) } else { (own, other) };
        self.0[0] |= own.bits();
        self.0[1] |= other.bits();
    }
}

impl<N: Real> Meeting<'_, '_, N> {
    /// Counts what is likely to be asked soon as asked, if it does not differ from what was.
    pub(super) fn expect(&self, expected: Asked<N>) {
        let both = self.asked.get().and(expected);
        if expected.aim != Aim::Nothing && both.aim == expected.aim {
            self.asked.set(both);
        }
    }

    /// What will be asked: the reach may grow by thrice the room.
    fn asked_by_then(&self) -> Asked<N> {
        let Asked { aim, reach } = self.asked.get();
        Asked { aim, reach: reach + N::lit(3.0) * N::lit(ROOM) }
    }

    /// Within what reach edges are now that may come within the reach by then: vertices move by twice the
    /// room to one another along the normal. `None` where edges are not looked at.
    pub(super) fn wide(&self) -> Option<N> {
        let Asked { aim, reach } = self.asked_by_then();
        let is_asked = matches!(aim, Aim::Crossing | Aim::Nearest);
        is_asked.then_some(reach + N::TWO * N::lit(ROOM))
    }

    /// The edges that may decide while the solids move no farther than [`ROOM`]; `None` if they are many.
    /// They are among those within the reach of one of the faces that may be the best by then.
    #[inline(always)]
    pub(super) fn pool<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        reached: &Reached,
        found: Option<&Found<N>>,
    ) -> Option<Pool<N>> {
        let (room, asked) = (N::lit(ROOM), self.asked_by_then());
        let aim = asked.aim;
        if aim == Aim::Both {
            return None;
        }
        if aim == Aim::Nothing {
            return Some(Pool { own: Few::default(), other: Few::default(), asked });
        }
        let [own, other] = reached.0.map(Chosen::of_bits);
        let rounding = N::lit(16.0) * noise();
        let nearest = match found {
            Some(found) => (found.on_other - found.on_own).norm(),
            None if aim == Aim::Nearest => return None,
            None => N::ZERO,
        };
        let apart = nearest + N::TWO * room + rounding;
        // The squares of distances are off by some rounding errors of the squares of lengths.
        let squared = apart * apart + N::lit(32.0) * noise();
        let slack = Slack { room, floor: self.height() - rounding, squared };
        let [own, other] = self.decisive::<S, V>(simd, [&own, &other], &slack);
        Some(Pool { own: Few::of_bits(own)?, other: Few::of_bits(other)?, asked })
    }

    /// Of some edges of each solid those of pairs that may decide, as bits.
    #[inline(always)]
    fn decisive<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        [own, other]: [&Chosen; 2],
        slack: &Slack<N>,
    ) -> [u128; 2] {
        let (mut bits, is_crossing) = ([0; 2], self.asked.get().aim == Aim::Crossing);
        for eight in other.indices().chunks(LANES) {
            let edges2 = self.edges::<S, V>(simd, eight, is_crossing);
            let valid = ALL >> (LANES - eight.len());
            for &index in own.indices() {
                let edge1 = self.edge(usize::from(index));
                let mut found = if is_crossing {
                    let normals1 = self.own.solid.edges[edge1.index].faces;
                    let normals1 = normals1.map(|face| self.own.solid.normal(face as usize));
                    may_cross::<S, N, V>(simd, (&edge1, &normals1), (&edges2, valid), slack)
                } else {
                    let squares = squares::<S, N, V>(simd, &edge1, &edges2);
                    !squares.simd_gt(V::all(simd, slack.squared)).to_bitmask() & ALL
                };
                found &= valid;
                bits[0] |= u128::from(found != 0) << index;
                while found != 0 {
                    bits[1] |= 1 << edges2.indices[found.trailing_zeros() as usize];
                    found &= found - 1;
                }
            }
        }
        bits
    }
}

/// A bit for each lane.
const ALL: u64 = (1 << LANES) - 1;

/// Which of eight pairs of edges may come to be a face of the Minkowski difference that is higher than
/// the best face, as bits.
#[inline(always)]
fn may_cross<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    (edge1, normals1): (&Edge<N>, &[Vector<N, 3>; 2]),
    (edges2, valid): (&Edges<N>, u64),
    slack: &Slack<N>,
) -> u64 {
    let (along1, along2): ([V; 3], [V; 3]) =
        (spread(simd, &edge1.along), load(simd, &edges2.along));
    let squared2 = dot(&along2, &along2);
    let squares = [V::all(simd, edge1.squared), squared2];
    let turn = slack.room + N::lit(16.0) * noise();
    let [left1, right1] = [
        Sign::of(simd, dot(&along2, &spread(simd, &normals1[0])), squares[1], turn),
        Sign::of(simd, dot(&along2, &spread(simd, &normals1[1])), squares[1], turn),
    ];
    let [normals_left, normals_right]: [[V; 3]; 2] =
        [load(simd, &edges2.normals[0]), load(simd, &edges2.normals[1])];
    let [left2, right2] = [
        Sign::of(simd, dot(&along1, &normals_left), squares[0], turn),
        Sign::of(simd, dot(&along1, &normals_right), squares[0], turn),
    ];
    // Of a face the signs on the left are alike and differ from those on the right, which are alike.
    let is_none = left1.is_like(right1)
        | left2.is_like(right2)
        | left2.is_like(right1)
        | left1.is_like(right2)
        | left1.is_unlike(left2)
        | right1.is_unlike(right2);
    if !is_none & valid == 0 {
        return 0;
    }
    let across = lanes::cross(&along1, &along2);
    let crossed = dot(&across, &across).sqrt();
    let from1: [V; 3] = spread(simd, &edge1.from);
    let away: [V; 3] = by_axis(
        #[inline(always)]
        |axis| V::load(simd, &edges2.from[axis]) - from1[axis],
    );
    let height = dot(&across, &away) / crossed;
    // A vector that changes by a share of its length turns its direction by twice that at most.
    let turned = (squares[0] * squares[1]).sqrt() * V::all(simd, N::TWO * turn) / crossed;
    let room = V::all(simd, slack.room);
    let change = turned * (dot(&away, &away).sqrt() + room) + room + room;
    let floor = V::all(simd, slack.floor);
    let is_tame = turned.simd_lt(V::all(simd, N::HALF)).to_bitmask();
    let is_low = (height + change).simd_lt(floor).to_bitmask();
    let is_deep = (change - height).simd_lt(floor).to_bitmask();
    // Outward is the way against the perpendicular where the sign on the left is negative.
    let against = left1.sure & left1.negative | !left1.sure & right1.sure & !right1.negative;
    let along = left1.sure & !left1.negative | !left1.sure & right1.sure & right1.negative;
    let is_out = along & is_low | against & is_deep | is_low & is_deep;
    !(is_none | is_tame & is_out) & ALL
}

/// The signs of eight numbers, as bits.
#[derive(Clone, Copy)]
struct Sign {
    negative: u64,
    /// It stays what it is.
    sure: u64,
}

impl Sign {
    /// Of products of unit vectors with vectors whose squared lengths are given, between which angles
    /// change by no more than `turn`.
    #[inline(always)]
    fn of<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
        simd: S,
        value: V,
        squared: V,
        turn: N,
    ) -> Self {
        let negative = value.simd_lt(V::all(simd, N::ZERO)).to_bitmask();
        let least = squared * V::all(simd, turn * turn);
        Self { negative, sure: (value * value).simd_gt(least).to_bitmask() }
    }

    /// Both are sure, and the same.
    const fn is_like(self, other: Self) -> u64 {
        self.sure & other.sure & !(self.negative ^ other.negative)
    }

    /// Both are sure, and not the same.
    const fn is_unlike(self, other: Self) -> u64 {
        self.sure & other.sure & (self.negative ^ other.negative)
    }
}
