//! Contacts of one feature of a solid (a face, an edge or a corner) with up to 8 triangles, each
//! along a normal of its own.
//!
//! ```text
//!        v3────────────v2     The face of the solid, v, and a triangle, c, seen along the normal.
//!        │      c2     │      Corners of their overlap are corners of the triangle in the face
//!        │    ╱   ╲    │      (c1), corners of the face in the triangle (v0), and crossings of
//!        │  ╱  c1───╲──┼      two sides (x). A candidate is a point of the triangle, with its
//!   c0───x╱──────────╲x│      distance from the face along the normal.
//!        v0────────────v1
//! ```
//!
//! The contacts equal, up to rounding, those of [`clip`](super::clip) for the supporting features
//! of the solid and of the triangle along the normal: a face, a side or a corner each, at least one
//! of them a face. A lane is one triangle. [`measure`] computes, in lanes, how far the corners of
//! one outline are inside each side of the other. Few candidates remain; [`points`] computes them
//! one by one. Lanes with a degenerate outline or an uncertain supporting feature are left
//! undecided, and the caller clips the pair by [`clip`](super::clip).
//!
//! All vectors are in the frame of the solid.

mod measure;
mod points;

pub(in crate::collide) use self::measure::FaceClip;
use super::supporting::{fill_part, supporting_part};
use crate::collide::RawPoints;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::ones::Ones;
use crate::math::simd::Level;
use crate::math::{Matrix, Real, Vector};
use crate::shape::{FaceRing, FeatureId, Geometry, Kind, SupportMap};

/// Clip request for one triangle.
#[derive(Clone, Copy)]
pub(in crate::collide) struct ClipRequest<N: Real> {
    /// Unit normal from the triangle to the solid, in the frame of the solid.
    pub(in crate::collide) normal: Vector<N, 3>,
    /// Supporting feature of the solid towards the triangle, against the normal.
    part: FeatureId,
    /// Signed distance of the nearest points if their normal is `normal`; else `None`. No point
    /// gets a distance below this value. The lane is undecided if no point has this distance up to
    /// rounding.
    pub(in crate::collide) nearest: Option<N>,
    /// Least distance of a contact point. Points that are nearer by more than rounding are dropped;
    /// the distances of the others are raised to at least `least`.
    pub(in crate::collide) least: N,
}

impl<N: Real> ClipRequest<N> {
    /// Creates a request; `None` for solids other than boxes and hulls, and for flat boxes.
    pub(in crate::collide) fn new(
        solid: Kind<'_, N, 3>,
        normal: Vector<N, 3>,
        nearest: Option<N>,
        least: N,
    ) -> Option<Self> {
        Some(Self { normal, part: supporting_part(solid, &-normal)?, nearest, least })
    }
}

/// A solid and its placement relative to the triangles.
pub(in crate::collide) struct FaceSolid<'a, N: Real> {
    pub(in crate::collide) solid: Kind<'a, N, 3>,
    /// Rotation from the frame of the solid to that of the triangles; its columns are the axes of
    /// the solid.
    pub(in crate::collide) turn: &'a Matrix<N, 3>,
    /// Origin of the solid in the frame of the triangles.
    pub(in crate::collide) origin: Vector<N, 3>,
    /// Largest distance of a contact point; farther points are dropped.
    pub(in crate::collide) prediction: N,
}

impl<N: Real> FaceSolid<'_, N> {
    /// Computes the contact points of up to 8 triangles, with one request each, and appends them to
    /// `points`. The corners of the triangles are in the frame that `turn` and `origin` refer to;
    /// the points are in the frame of the solid. For each lane, calls `visit` with the lane and the
    /// smallest distance of its points (infinite without points), or with `None` if the lane is
    /// undecided. Lanes with the same supporting feature of the solid are visited one after
    /// another.
    pub(in crate::collide) fn each_clip(
        &self,
        triangles: &PartPacket<N, 3>,
        requests: &[ClipRequest<N>],
        clip: &mut FaceClip<N>,
        points: &mut RawPoints<N, 3>,
        visit: impl FnMut(usize, Option<N>, &RawPoints<N, 3>),
    ) {
        self.each_clip_at(Level::new(), (triangles, requests), clip, points, visit);
    }

    /// Runs [`Self::each_clip`] with the instruction set of `level`; the result does not depend on
    /// the level.
    pub(super) fn each_clip_at(
        &self,
        level: Level,
        (triangles, requests): (&PartPacket<N, 3>, &[ClipRequest<N>]),
        clip: &mut FaceClip<N>,
        points: &mut RawPoints<N, 3>,
        mut visit: impl FnMut(usize, Option<N>, &RawPoints<N, 3>),
    ) {
        let mut normals = [[N::ZERO; LANES]; 3];
        for (lane, request) in requests.iter().enumerate() {
            for (row, value) in normals.iter_mut().zip(request.normal.iter()) {
                row[lane] = *value;
            }
        }
        let mut left = u8::MAX >> (LANES - requests.len());
        // Lanes with the same supporting feature of the solid share a ring.
        while left != 0 {
            let part = requests[left.trailing_zeros() as usize].part;
            let is_same = |lane: &usize| requests[*lane].part == part;
            let group = ones(left).filter(is_same).fold(0, |group, lane| group | 1 << lane);
            left &= !group;
            clip.ring = FaceRing::blank();
            if !fill_part(self.solid, part, &mut clip.ring) {
                ones(group).for_each(|lane| visit(lane, None, points));
                continue;
            }
            for run in level.runs(requests.len()) {
                let lanes = run.of_bits(group);
                if lanes != 0 {
                    clip.measure(run, self, triangles, &normals);
                }
                for lane in ones(lanes) {
                    let lowest = clip.points_of(lane, &requests[lane], self.prediction, points);
                    visit(lane, lowest, points);
                }
            }
        }
    }

    /// Returns the bounding radius of the solid's core around its origin.
    fn reach(&self) -> N {
        Geometry(self.solid).as_support_map().map_or(N::ZERO, SupportMap::reach)
    }
}

/// Returns an iterator over the lanes of a mask.
fn ones(bits: u8) -> Ones<LANES> {
    Ones(bits.into())
}
