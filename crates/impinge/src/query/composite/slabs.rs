//! Slabs around one part: a part of the other shape whose corners lie far outside of them is far from it.

use smallvec::{SmallVec, smallvec};

use super::between::Between;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component, min, unit};
use crate::shape::{Part, PartSolid, Plane};

/// Gaps are loosened by so many rounding units of all lengths.
const ROUNDING: f64 = 128.0;

/// Slabs that a solid lies in, in the frame of the composite that it is held against.
pub(super) struct Slabs<N: Real, const D: usize> {
    /// Heights are measured from here.
    origin: Vector<N, D>,
    /// A length that the rounding of the solid's place is in proportion to.
    size: N,
    /// Those of a triangle: across each side and, in space, across its plane.
    slabs: SmallVec<[Slab<N, D>; 4]>,
}

/// What lies between two planes across a unit vector.
struct Slab<N: Real, const D: usize> {
    along: Vector<N, D>,
    lowest: N,
    highest: N,
}

type Corners<N, const D: usize> = SmallVec<[Vector<N, D>; 3]>;

impl<N: Space<D>, const D: usize> Slabs<N, D> {
    /// Of a half-space that the second shape is held against: its slab has one side.
    pub(super) fn of_half_space(between: &Between<'_, N, D>, plane: &Plane<N, D>) -> Self {
        let Pose { translation: origin, .. } = between.pose21;
        let along = between.pose21.vector(plane.normal());
        let slab = Slab { along, lowest: -N::INFINITY, highest: N::ZERO };
        Self { origin, size: N::ZERO, slabs: smallvec![slab] }
    }

    /// Of a part of the first shape (0) or the second (1); none of what is not given by its corners.
    pub(super) fn of_part(between: &Between<'_, N, D>, which: usize, part: u32) -> Self {
        let mut slabs =
            Self { origin: Vector::<N, D>::zeros(), size: N::ZERO, slabs: SmallVec::new() };
        let Some((part, pose)) = between.part_in_other(which, part) else { return slabs };
        let corners = corners(&part.solid, &pose);
        if let Some(first) = corners.first() {
            let own = max_component(&part.pose.translation);
            let place = max(own, max_component(&pose.translation));
            slabs.size = corners.iter().fold(place, |size, at| max(max_component(at), size));
            slabs.origin = *first;
            slabs.surround(&corners.iter().map(|corner| corner - first).collect());
        }
        slabs
    }

    /// Adds slabs around corners that are seen from the first of them.
    fn surround(&mut self, corners: &Corners<N, D>) {
        let [_, one, ref rest @ ..] = corners[..] else { return };
        let Some(other) = rest.first() else {
            self.add(&one, corners);
            return self.add(&normal_to(&one, &Vector::<N, D>::zeros()), corners);
        };
        self.add(&without(other, &one), corners);
        self.add(&without(&one, other), corners);
        self.add(&without(&one, &(other - one)), corners);
        self.add(&normal_to(&one, other), corners);
    }

    fn add(&mut self, direction: &Vector<N, D>, corners: &Corners<N, D>) {
        let Some((along, _)) = unit(direction) else { return };
        let (lowest, highest) = range(corners, &along);
        self.slabs.push(Slab { along, lowest, highest });
    }

    /// A part of the composite is certainly farther from the solid than a limit; overlaps count as negative.
    pub(super) fn are_beyond(&self, part: &Part<'_, N, D>, limit: N) -> bool {
        let mut corners = corners(&part.solid, &part.pose);
        if corners.is_empty() || self.slabs.is_empty() {
            return false;
        }
        let mut size = self.size;
        for corner in &mut corners {
            *corner -= self.origin;
            size = max(max_component(corner), size);
        }
        let gap = self.slabs.iter().fold(-N::INFINITY, |gap, slab| {
            let (lowest, highest) = range(&corners, &slab.along);
            max(max(lowest - slab.highest, slab.lowest - highest), gap)
        });
        // Lengths that are subnormal numbers are not precise.
        let is_precise = size > N::MIN_POSITIVE / N::EPSILON;
        is_precise && gap - size * N::lit(ROUNDING) * N::EPSILON > limit
    }
}

/// The placed corners of a part that is given by them.
fn corners<N: Real, const D: usize>(
    solid: &PartSolid<'_, N, D>,
    pose: &Pose<N, D>,
) -> Corners<N, D> {
    let placed = |corner: &Point<N, D>| pose.point(corner).coords;
    match solid {
        PartSolid::Triangle(triangle) => triangle.corners().iter().map(placed).collect(),
        PartSolid::Segment(segment) => [segment.a(), segment.b()].map(placed).into_iter().collect(),
        PartSolid::Shape(_) => Corners::new(),
    }
}

/// How low and how high the corners lie along a direction.
fn range<N: Real, const D: usize>(corners: &[Vector<N, D>], along: &Vector<N, D>) -> (N, N) {
    corners.iter().fold((N::INFINITY, -N::INFINITY), |(lowest, highest), corner| {
        let height = corner.dot(along);
        (min(height, lowest), max(height, highest))
    })
}

/// A vector less what is along another.
fn without<N: Real, const D: usize>(v: &Vector<N, D>, other: &Vector<N, D>) -> Vector<N, D> {
    unit(other).map_or(*v, |(along, _)| v - along * v.dot(&along))
}

/// What is left of the axis of which most is left when what two vectors span is taken from it; zero where they
/// span all.
fn normal_to<N: Real, const D: usize>(one: &Vector<N, D>, other: &Vector<N, D>) -> Vector<N, D> {
    let other = without(other, one);
    let (mut most, mut squared) = (Vector::<N, D>::zeros(), N::lit(0.0625));
    for index in 0..D {
        let mut axis = Vector::<N, D>::zeros();
        axis[index] = N::ONE;
        let left = without(&without(&axis, one), &other);
        if left.norm_squared() > squared {
            (most, squared) = (left, left.norm_squared());
        }
    }
    most
}
