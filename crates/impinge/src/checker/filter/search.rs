//! What a scan looks for, and what it found.

use crate::checker::chain::{LANES, Row};
use crate::math::lanes::bits;
use crate::math::simd::Simd;
use crate::math::{Wide, max, min};

/// What is asked of eight configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::checker) enum Mode {
    /// Whether there is any pair: what is decided needs no more.
    Any,
    /// All pairs.
    All,
    /// The pairs that may be the nearest.
    Nearest,
}

/// A pair that is not certainly farther apart than the limit.
#[derive(Clone, Copy, Debug)]
pub(in crate::checker) struct Near {
    /// The numbers of the body and of the other body or of the obstacle.
    pub(in crate::checker) body: u32,
    pub(in crate::checker) other: Other,
    /// The lanes in which it is not, and those of them in which it certainly is not.
    pub(in crate::checker) lanes: u8,
    pub(in crate::checker) certain: u8,
    /// How far apart they are at least, in the mode [`Mode::Nearest`].
    pub(in crate::checker) lower: Row<f32>,
}

/// The second of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::checker) enum Other {
    Body(u32),
    Obstacle(u32),
}

/// A search in eight configurations.
#[derive(Debug)]
pub(in crate::checker) struct Search {
    pub(super) mode: Mode,
    /// The lanes that are looked at.
    pub(in crate::checker) live: u8,
    /// The lanes in which numbers are too large for `f32`.
    pub(in crate::checker) blind: u8,
    /// The lanes in which a pair is certainly not farther apart than the limit, in the mode [`Mode::Any`].
    pub(in crate::checker) hits: u8,
    /// Farther apart than this with all margins is farther than the limit; nearer than the other is not.
    pub(super) outer: Row<f32>,
    pub(super) inner: Row<f32>,
    /// The margin for what slides.
    slack: Row<f32>,
    /// The highest number of `outer`, and how far anything slides.
    pub(super) farthest: f32,
    pub(super) slide: f32,
    pub(in crate::checker) near: Vec<Near>,
}

/// What is known of a pair of balls, or of a ball and a core, in eight lanes.
#[derive(Clone, Copy)]
pub(super) struct Distances<V> {
    /// The squares of the distances of the centers, or of the center from the core.
    pub(super) squared: V,
    /// The sum of the radii, and the margin.
    pub(super) radius: f32,
    pub(super) margin: f32,
    /// The solids are within those radii, and all of that.
    pub(super) is_exact: bool,
}

/// The pair that is looked at, and what was found.
pub(super) struct Pairing {
    pub(super) lanes: u8,
    pub(super) certain: u8,
    pub(super) lower: Row<f32>,
}

impl Pairing {
    pub(super) const fn new() -> Self {
        Self { lanes: 0, certain: 0, lower: [f32::INFINITY; LANES] }
    }
}

impl Search {
    pub(in crate::checker) fn new(mode: Mode) -> Self {
        let zero = [0.0; LANES];
        Self {
            mode,
            live: 0,
            blind: 0,
            hits: 0,
            outer: zero,
            inner: zero,
            slack: zero,
            farthest: 0.0,
            slide: 0.0,
            near: Vec::new(),
        }
    }

    /// Begins with new configurations: those of the lanes, and how far things slide in each, with the margin for a unit
    /// of that.
    pub(in crate::checker) fn begin(
        &mut self,
        lanes: u8,
        limit: f32,
        (slides, margin): (&Row<f32>, f32),
    ) {
        (self.live, self.blind, self.hits) = (lanes, 0, 0);
        (self.farthest, self.slide) = (0.0, 0.0);
        // The limit itself was rounded. Without one the first is infinite, and the other NaN.
        let rounding = limit * (2.0 * f32::EPSILON);
        for (lane, &slide) in slides.iter().enumerate() {
            self.slack[lane] = slide * margin;
            self.outer[lane] = limit + rounding + self.slack[lane];
            self.inner[lane] = limit - rounding - self.slack[lane];
            self.farthest = max(self.outer[lane], self.farthest);
            self.slide = max(slide, self.slide);
        }
        self.near.clear();
    }

    /// A pair that was kept may still count in a lane: others may have turned out to be nearer.
    pub(in crate::checker) fn may_count(&self, near: &Near, lane: usize) -> bool {
        let is_far = self.mode == Mode::Nearest && near.lower[lane] > self.outer[lane];
        near.lanes >> lane & 1 == 1 && !is_far
    }

    /// All lanes are decided.
    #[inline(always)]
    pub(super) const fn is_done(&self) -> bool {
        self.live == 0
    }

    /// The live lanes in which solids are not certainly farther apart than the limit: NaN is not.
    #[inline(always)]
    pub(super) fn near_lanes<S: Simd, V: Wide<S, Scalar = f32>>(
        &self,
        simd: S,
        distances: &Distances<V>,
    ) -> u8 {
        let outer = V::all(simd, distances.radius + distances.margin) + V::load(simd, &self.outer);
        !bits(distances.squared.simd_gt(outer * outer)) & self.live
    }

    /// Adds to what is known of a pair of bodies what two of their balls say.
    #[inline(always)]
    pub(super) fn add<S: Simd, V: Wide<S, Scalar = f32>>(
        &mut self,
        simd: S,
        distances: &Distances<V>,
        pairing: &mut Pairing,
    ) {
        let near = self.near_lanes(simd, distances);
        if near == 0 {
            return;
        }
        pairing.lanes |= near;
        if self.mode == Mode::Nearest {
            return self.bound(distances, pairing);
        }
        if distances.is_exact {
            let inner =
                V::all(simd, distances.radius - distances.margin) + V::load(simd, &self.inner);
            let is_certain =
                distances.squared.simd_lt(inner * inner) & inner.simd_gt(V::all(simd, 0.0));
            pairing.certain |= bits(is_certain) & near;
        }
    }

    /// Bounds of the distance: no pair is wanted that is farther apart than the upper bound of one.
    #[inline(always)]
    fn bound<S: Simd, V: Wide<S, Scalar = f32>>(
        &mut self,
        distances: &Distances<V>,
        pairing: &mut Pairing,
    ) {
        let mut apart = [0.0; LANES];
        distances.squared.sqrt().store(&mut apart);
        for (lane, &apart) in apart.iter().enumerate() {
            let (slack, between) = (self.slack[lane], apart - distances.radius);
            let lower = between - distances.margin - slack;
            pairing.lower[lane] = min(lower, pairing.lower[lane]);
            if distances.is_exact {
                let upper = max(between + distances.margin + slack, 0.0);
                self.outer[lane] = min(upper + slack, self.outer[lane]);
            }
        }
        self.farthest = self.outer.iter().fold(0.0, |most, &outer| max(outer, most));
    }

    /// Keeps a pair that is near in some lanes.
    #[inline(always)]
    pub(super) fn finish(&mut self, body: u32, other: Other, pairing: &Pairing) {
        let Pairing { mut lanes, certain, lower } = *pairing;
        if self.mode == Mode::Any {
            self.hits |= certain;
            self.live &= !certain;
            lanes &= !certain;
        }
        if lanes != 0 {
            self.near.push(Near { body, other, lanes, certain, lower });
        }
    }
}
