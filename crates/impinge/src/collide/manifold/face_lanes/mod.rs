//! Contacts of a face, an edge or a corner of one solid with up to eight triangles, each along a normal of its own.
//!
//! ```text
//!        v3────────────v2        The face of the solid, v, and a triangle, c, seen along the normal. The
//!        │      c2     │         corners of what they share are corners of the triangle in the face (c1),
//!        │    ╱   ╲    │         corners of the face in the triangle (v0), and crossings of two sides
//!        │  ╱  c1───╲──┼         (x). Each candidate is a point of the triangle, and how far along the
//!   c0───x╱──────────╲x│         normal the face is from it.
//!        v0────────────v1
//! ```
//!
//! That is the clip of [`clip`](super::clip) for what a solid and a triangle show along the normal: a face, a side or a
//! corner each, of which one at least is a face. A lane is one triangle. The kernel measures how far inside of each
//! side of the one ring the corners of the other are; few of all candidates count, and these are made one by one.
//! Lanes whose rings have hardly an extent along the normal, or show neither clearly, are left to the clip of the pair.
//!
//! All is in the frame of the solid.

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

/// What is asked of one triangle.
#[derive(Clone, Copy)]
pub(in crate::collide) struct ClipRequest<N: Real> {
    /// Unit, from the triangle to the solid.
    pub(in crate::collide) normal: Vector<N, 3>,
    /// The part of the solid that is seen against the normal.
    part: FeatureId,
    /// How near the nearest points are, if they have this normal. One of the points is that near, or there are none.
    pub(in crate::collide) nearest: Option<N>,
    /// Points nearer than this by more than rounding are left out, others are as near as this.
    pub(in crate::collide) least: N,
}

impl<N: Real> ClipRequest<N> {
    /// `None` of solids other than boxes and hulls, and of flat boxes.
    pub(in crate::collide) fn new(
        solid: Kind<'_, N, 3>,
        normal: Vector<N, 3>,
        nearest: Option<N>,
        least: N,
    ) -> Option<Self> {
        Some(Self { normal, part: supporting_part(solid, &-normal)?, nearest, least })
    }
}

/// A solid and how the triangles lie to it.
pub(in crate::collide) struct FaceSolid<'a, N: Real> {
    pub(in crate::collide) solid: Kind<'a, N, 3>,
    /// Its axes in the frame of the triangles, as columns, and where it is.
    pub(in crate::collide) turn: &'a Matrix<N, 3>,
    pub(in crate::collide) origin: Vector<N, 3>,
    /// Points farther than this are left out.
    pub(in crate::collide) prediction: N,
}

impl<N: Real> FaceSolid<'_, N> {
    /// Appends the points of each of up to eight triangles and calls with the number of the triangle and the least
    /// distance of its points; with `None` where the clip of the pair is needed.
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

    /// [`Self::each_clip`] with the vectors of an instruction set; the numbers do not depend on it.
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

    fn reach(&self) -> N {
        Geometry(self.solid).as_support_map().map_or(N::ZERO, SupportMap::reach)
    }
}

/// The lanes of some bits.
fn ones(bits: u8) -> Ones<LANES> {
    Ones(bits.into())
}
