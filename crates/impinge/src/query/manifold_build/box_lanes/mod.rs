//! Boxes against boxes, eight pairs at a time; a lone pair is a batch of one.
//!
//! Each lane of a vector is another pair, and never looks at its neighbours: the bits of a pair do not depend on
//! the batch. What depends on the pair is chosen by masks, and a corner of the common area has a
//! slot of its own whether it is there or not ([`admit`]). Only the choice of the points ([`choose`])
//! goes pair by pair. Flat boxes, and pairs whose nearest points are off the faces that face each other, fall back to
//! the generic builder, one by one.
//!
//! The idea of lanes across pairs is that of bepuphysics (R. Nordby).

mod admit;
mod choose;
mod gather;
mod masks;
mod plane;
mod space;
#[cfg(test)]
pub(super) mod tests;

use self::gather::Inputs;
pub(super) use self::masks::{bits, transposed};
use super::{ManifoldRequest, Pair, RawManifold};
use crate::math::lanes::with_lanes;
use crate::math::simd::{Level, Simd};
use crate::math::{Pose, Real, Wide};
use crate::shape::{Cuboid, Kind};

/// How many pairs are treated at once.
const LANES: usize = 8;

/// A pair of boxes in canonical order whose manifold is to be brought up to date.
pub(crate) struct BoxJob<'a, N: Real, const D: usize> {
    pub(crate) poses: [&'a Pose<N, D>; 2],
    pub(crate) cuboids: [&'a Cuboid<N, D>; 2],
    pub(crate) request: &'a ManifoldRequest<N>,
    /// The manifold of the last update, which is replaced.
    pub(crate) raw: &'a mut RawManifold<N, D>,
}

impl<'a, N: Real, const D: usize> BoxJob<'a, N, D> {
    pub(super) fn pair(&self) -> Pair<'a, N, D> {
        let [first, second] = self.cuboids.map(Kind::Cuboid);
        Pair { first, second, pose12: Pose::relative(self.poses[0], self.poses[1]) }
    }
}

/// What is known of eight pairs before points are chosen.
trait Eights<N: Real, const D: usize> {
    fn new() -> Self;

    /// Everything that goes for eight pairs at once.
    fn find<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S, inputs: &Inputs<N, D>);

    /// The end, pair by pair, of the first eight.
    fn settle(&self, jobs: &mut [BoxJob<'_, N, D>]);

    /// The generic builder for one pair.
    fn fall_back(job: &mut BoxJob<'_, N, D>);
}

/// Brings the manifolds of pairs of 2D boxes up to date, as [`update_box_pairs3`].
pub(crate) fn update_box_pairs2<N: Real>(jobs: &mut [BoxJob<'_, N, 2>]) {
    update_at::<N, plane::Found<N>, 2>(Level::new(), jobs);
}

/// Brings the manifolds of pairs of boxes up to date.
///
/// Any number of pairs; the last vector is filled up with leftovers if that is no multiple of eight,
/// so a few hundred at a time are best.
pub(crate) fn update_box_pairs3<N: Real>(jobs: &mut [BoxJob<'_, N, 3>]) {
    update_at::<N, space::Found<N>, 3>(Level::new(), jobs);
}

/// The manifold of two 2D boxes of which the second is placed in the frame of the first.
pub(super) fn build2<N: Real>(
    cuboids: [&Cuboid<N, 2>; 2],
    pose12: &Pose<N, 2>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, 2>,
) {
    let job = BoxJob { poses: [&Pose::identity(), pose12], cuboids, request, raw };
    update_box_pairs2(&mut [job]);
}

/// The manifold of two 3D boxes of which the second is placed in the frame of the first.
pub(super) fn build3<N: Real>(
    cuboids: [&Cuboid<N, 3>; 2],
    pose12: &Pose<N, 3>,
    request: &ManifoldRequest<N>,
    raw: &mut RawManifold<N, 3>,
) {
    let job = BoxJob { poses: [&Pose::identity(), pose12], cuboids, request, raw };
    update_box_pairs3(&mut [job]);
}

/// [`update_box_pairs3`] with the vectors of an instruction set.
fn update_at<N: Real, E: Eights<N, D>, const D: usize>(
    level: Level,
    jobs: &mut [BoxJob<'_, N, D>],
) {
    with_lanes!(level, simd => update::<_, N, N::Lanes<_>, E, D>(simd, jobs));
}

/// Eight by eight. The numbers of the next eight are gathered before those gathered last are used,
/// which gives the memory time to put them together.
#[inline(always)]
fn update<S: Simd, N: Real, V: Wide<S, Scalar = N>, E: Eights<N, D>, const D: usize>(
    simd: S,
    jobs: &mut [BoxJob<'_, N, D>],
) {
    touch(jobs);
    let mut inputs = [Inputs::new(), Inputs::new()];
    let mut found = E::new();
    inputs[0].gather(jobs);
    for (count, first) in (0..jobs.len()).step_by(LANES).enumerate() {
        if let Some(next) = jobs.get(first + LANES..) {
            inputs[(count + 1) % 2].gather(next);
        }
        found.find::<S, V>(simd, &inputs[count % 2]);
        found.settle(&mut jobs[first..]);
    }
}

/// Reads a little of all that the pairs need, which lies scattered: many reads wait for the memory
/// together here, and would wait one after another between the steps of eight pairs.
#[inline(always)]
fn touch<N: Real, const D: usize>(jobs: &[BoxJob<'_, N, D>]) {
    let mut seen = 0;
    for job in jobs {
        let [half1, half2] = job.cuboids.map(Cuboid::half_extents);
        let [pose1, pose2] = job.poses;
        seen += u32::from(half1[0] > half2[0]);
        seen += u32::from(pose1.rotation[(0, 0)] > pose2.rotation[(0, 0)]);
        seen ^= job.raw.points.last().map_or(0, |point| point.id);
    }
    core::hint::black_box(seen);
}
