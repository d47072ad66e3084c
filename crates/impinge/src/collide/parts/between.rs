//! Pairs of parts, one from each of two shapes, placed near a common origin so that tolerances do
//! not grow with the distance of the parts from the origins of their shapes.
//!
//! The triangles of a mesh are in the frame of the mesh, whose origin may be far away, and the
//! tolerances of the pair algorithms grow with all coordinates. So both parts are placed relative
//! to an anchor close to them: the origin of the convex solid or, for two composites, the
//! [`anchor`] of the first part. All parts that are compared with one convex solid, or with one
//! part of the first composite, are placed relative to one anchor, so that adjacent triangles still
//! share their corners.

use super::bounds::{aabb_of, enclosing};
use crate::bounding_volume::Aabb;
use crate::collide::Pair;
use crate::collide::pair::Ordered;
use crate::convex::Separation;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector};
use crate::shape::{CompositeShape, Geometry, Kind, Part, PartSolid, Segment, Triangle};

/// Two shapes, usually at least one of them a composite, and the pose of each in the frame of the
/// other.
#[derive(Clone, Copy)]
pub(crate) struct Between<'a, N: Real, const D: usize> {
    pub(crate) pair: Pair<'a, N, D>,
    /// Pose of the first shape in the frame of the second. If [`Self::of_ordered`] made the pair,
    /// it is as exact as `pair.pose12`, because both are computed from the difference of the
    /// positions.
    pub(crate) pose21: Pose<N, D>,
}

/// A part of a composite or a whole convex solid, placed relative to an anchor in the frame of its
/// shape.
#[derive(Clone, Copy)]
struct AnchoredPart<'a, N: Real, const D: usize> {
    solid: PartOf<'a, N, D>,
    /// Pose of the solid in the frame of the shape, with the anchor as the origin.
    pose: Pose<N, D>,
}

/// A whole convex shape, or a part of a composite.
#[derive(Clone, Copy)]
enum PartOf<'a, N: Real, const D: usize> {
    Whole(Kind<'a, N, D>),
    Part(PartSolid<'a, N, D>),
}

/// One part of each of two shapes, placed relative to a common anchor, and the pose of the second
/// part in the frame of the first.
pub(crate) struct PartPair<'a, N: Real, const D: usize> {
    part1: AnchoredPart<'a, N, D>,
    part2: AnchoredPart<'a, N, D>,
    /// Anchor of both parts, in the frame of the first shape.
    origin1: Point<N, D>,
    pose12: Pose<N, D>,
}

impl<'a, N: Real, const D: usize> Between<'a, N, D> {
    /// Makes a pair of two placed shapes in canonical order.
    pub(crate) fn of_ordered(ordered: &Ordered<'_, 'a, N, D>) -> Self {
        let pose21 = Pose::relative(&ordered.second.pose, &ordered.first.pose);
        Self { pair: ordered.pair(), pose21 }
    }

    /// Makes a pair from the relative pose `pose12` alone; `pose21` is computed as its inverse.
    pub(crate) fn of_pair(pair: &Pair<'a, N, D>) -> Self {
        Self { pair: *pair, pose21: pair.pose12.inverse() }
    }

    /// Returns each shape as a composite; `None` for a shape that is not a composite.
    pub(crate) fn composites(&self) -> [Option<&'a dyn CompositeShape<N, D>>; 2] {
        [self.pair.first, self.pair.second].mapped(|kind| Geometry(kind).as_composite())
    }

    /// Returns whether one of the composites has ghosts: parts that continue its surface into a
    /// neighbouring shape, but that no query finds.
    #[inline]
    pub(crate) fn has_ghosts(&self) -> bool {
        self.composites().iter().flatten().any(|composite| composite.has_ghosts())
    }

    /// Returns whether one of the composites has bodies: solids bounded by closed surfaces, in
    /// which the other shape may lie.
    #[inline]
    pub(crate) fn has_bodies(&self) -> bool {
        self.composites().iter().flatten().any(|composite| composite.has_bodies())
    }

    pub(crate) fn is_half_space_first(&self) -> bool {
        matches!(self.pair.first, Kind::Plane(_))
    }

    /// Places part `part1` of the first shape and part `part2` of the second relative to a common
    /// anchor. For a convex solid the index is ignored, and the solid counts as its only part.
    pub(crate) fn parts(&self, [part1, part2]: [u32; 2]) -> PartPair<'a, N, D> {
        let [composite1, composite2] = self.composites();
        if composite1.is_none() && composite2.is_none() {
            return self.whole();
        }
        let piece1 = composite1.map(|composite| composite.part(part1));
        let piece2 = composite2.map(|composite| composite.part(part2));
        let (origin1, origin2) = match (&piece1, &piece2) {
            (None, _) => (Point::origin(), Point::from(self.pose21.translation)),
            (Some(_), None) => (Point::from(self.pair.pose12.translation), Point::origin()),
            (Some(piece1), Some(_)) => {
                let origin1 = anchor(piece1);
                (origin1, self.pose21.point(&origin1))
            }
        };
        let part1 = AnchoredPart::new(self.pair.first, piece1, &origin1);
        let part2 = AnchoredPart::new(self.pair.second, piece2, &origin2);
        let turn = Pose { rotation: self.pair.pose12.rotation, ..Pose::identity() };
        let pose12 = Pose::relative(&part1.pose, &turn.compose(&part2.pose));
        PartPair { part1, part2, origin1, pose12 }
    }

    /// Returns two convex solids as a pair of parts, without an anchor.
    fn whole(&self) -> PartPair<'a, N, D> {
        let [part1, part2] = [self.pair.first, self.pair.second]
            .mapped(|kind| AnchoredPart { solid: PartOf::Whole(kind), pose: Pose::identity() });
        PartPair { part1, part2, origin1: Point::origin(), pose12: self.pair.pose12 }
    }
}

impl<N: Space<D>, const D: usize> Between<'_, N, D> {
    /// Returns a bounding box of the first shape (0) or the second (1), in the frame of the other
    /// shape.
    pub(crate) fn whole_in_other(&self, which: usize) -> Aabb<N, D> {
        let (kind, pose) = self.in_frame_of_other(which);
        enclosing(&aabb_of(kind, pose), pose)
    }

    /// Transforms a box from the frame of the first shape (0) or the second (1) into the frame of
    /// the other shape. The result encloses the transformed box, even after rounding.
    pub(crate) fn box_in_other(&self, which: usize, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        let pose = self.in_frame_of_other(which).1;
        enclosing(&aabb.transformed_by(pose), pose)
    }

    /// Returns a box around a part of the first shape (0) or the second (1), in the frame of the
    /// other shape; a convex solid counts as its only part.
    pub(crate) fn aabb_in_other(&self, which: usize, part: u32) -> Aabb<N, D> {
        let Some((part, pose)) = self.part_in_other(which, part) else {
            return self.whole_in_other(which);
        };
        enclosing(&part.solid.as_shape().aabb(&pose), self.in_frame_of_other(which).1)
    }

    /// Returns a part of the first shape (0) or the second (1) and its pose in the frame of the
    /// other shape; `None` for a convex solid.
    pub(crate) fn part_in_other(
        &self,
        which: usize,
        part: u32,
    ) -> Option<(Part<'_, N, D>, Pose<N, D>)> {
        let (kind, pose) = self.in_frame_of_other(which);
        let part = Geometry(kind).as_composite()?.part(part);
        let pose = pose.compose(&part.pose);
        Some((part, pose))
    }

    /// Tests in the frame of each of two composites whether its bounding box is farther than
    /// `limit` from a box around the other composite. Returns `true` if one of the tests succeeds,
    /// which proves that the shapes are farther apart than `limit`. False if one shape is convex.
    pub(crate) fn are_boxes_beyond(&self, limit: N) -> bool {
        let [Some(parts1), Some(parts2)] = self.composites() else { return false };
        let is_beyond = |parts: &dyn CompositeShape<N, D>, other: usize| {
            let bounds = parts.search().bounds();
            bounds.distance_to_aabb(&self.whole_in_other(other)) > limit
        };
        is_beyond(parts1, 1) || is_beyond(parts2, 0)
    }

    /// Returns the first shape (0) or the second (1) and its pose in the frame of the other shape.
    pub(super) fn in_frame_of_other(&self, which: usize) -> (Kind<'_, N, D>, &Pose<N, D>) {
        let Pair { first, second, pose12 } = &self.pair;
        if which == 0 { (*first, &self.pose21) } else { (*second, pose12) }
    }
}

/// Orders two composites by their number of parts. Returns the index of the composite with fewer
/// parts (0 on a tie), this composite, and the composite with more parts.
pub(crate) fn by_number<'a, N: Real, const D: usize>(
    parts1: &'a dyn CompositeShape<N, D>,
    parts2: &'a dyn CompositeShape<N, D>,
) -> (usize, &'a dyn CompositeShape<N, D>, &'a dyn CompositeShape<N, D>) {
    if parts2.num_parts() < parts1.num_parts() { (1, parts2, parts1) } else { (0, parts1, parts2) }
}

impl<'a, N: Real, const D: usize> AnchoredPart<'a, N, D> {
    /// Places `piece`, or the whole convex shape if `piece` is `None`, relative to the anchor
    /// `origin`.
    fn new(whole: Kind<'a, N, D>, piece: Option<Part<'a, N, D>>, origin: &Point<N, D>) -> Self {
        let Some(piece) = piece else {
            let pose = Pose::from_translation(-origin.coords);
            return Self { solid: PartOf::Whole(whole), pose };
        };
        let turn = piece.pose.rotation;
        let local = piece.pose.inverse_point(origin).coords;
        match recentred(&piece.solid, &local) {
            Some(solid) => {
                let pose = Pose { rotation: turn, translation: Vector::<N, D>::zeros() };
                Self { solid: PartOf::Part(solid), pose }
            }
            None => {
                let pose =
                    Pose { rotation: turn, translation: piece.pose.translation - origin.coords };
                Self { solid: PartOf::Part(piece.solid), pose }
            }
        }
    }

    fn kind(&self) -> Kind<'_, N, D> {
        match &self.solid {
            PartOf::Whole(kind) => *kind,
            PartOf::Part(solid) => solid.geometry().0,
        }
    }
}

impl<N: Real, const D: usize> PartPair<'_, N, D> {
    /// Returns both parts as the input of the algorithms for two solids.
    pub(crate) fn pair(&self) -> Pair<'_, N, D> {
        Pair { first: self.part1.kind(), second: self.part2.kind(), pose12: self.pose12 }
    }

    /// Returns the poses of the solids of [`Self::pair`] in the frame of the first shape. The
    /// triangles and segments of this pair are relative to the anchor, unlike those of the
    /// composites.
    pub(crate) fn poses(&self) -> [Pose<N, D>; 2] {
        let Pose { rotation, translation } = self.part1.pose;
        let pose1 = Pose { rotation, translation: self.origin1.coords + translation };
        [pose1, pose1.compose(&self.pose12)]
    }

    /// Transforms a vector from the frame of the first shape into the frame of the first part.
    pub(crate) fn to_first_part(&self, vector: &Vector<N, D>) -> Vector<N, D> {
        self.part1.pose.inverse_vector(vector)
    }

    /// Transforms a separation from the frame of the first shape into the frame of [`Self::pair`].
    pub(crate) fn in_first_part(&self, found: &Separation<N, D>) -> Separation<N, D> {
        let placed =
            |point: &Point<N, D>| self.part1.pose.inverse_point(&Point::from(point - self.origin1));
        Separation {
            distance: found.distance,
            normal: self.part1.pose.inverse_vector(&found.normal),
            point1: placed(&found.point1),
            point2: placed(&found.point2),
        }
    }

    /// Transforms a separation from the frame of [`Self::pair`] into the frame of the first shape.
    pub(crate) fn in_first(&self, found: &Separation<N, D>) -> Separation<N, D> {
        let placed = |point| self.origin1 + self.part1.pose.point(point).coords;
        Separation {
            distance: found.distance,
            normal: self.part1.pose.vector(&found.normal),
            point1: placed(&found.point1),
            point2: placed(&found.point2),
        }
    }
}

/// Returns the point relative to which a part and its partner are placed: the first corner of a
/// triangle or segment, which is close to the part, or the origin of any other part. The point is
/// in the frame of the composite.
pub(crate) fn anchor<N: Real, const D: usize>(part: &Part<'_, N, D>) -> Point<N, D> {
    match &part.solid {
        PartSolid::Triangle(triangle) => part.pose.point(&triangle.corners()[0]),
        PartSolid::Segment(segment) => part.pose.point(segment.a()),
        PartSolid::Shape(_) => Point::from(part.pose.translation),
    }
}

/// Translates a triangle or segment so that `origin` becomes the origin of its coordinates. `None`
/// for parts of other kinds, which are moved by their pose, and if a coordinate overflows.
pub(crate) fn recentred<'a, N: Real, const D: usize>(
    solid: &PartSolid<'a, N, D>,
    origin: &Vector<N, D>,
) -> Option<PartSolid<'a, N, D>> {
    match solid {
        PartSolid::Triangle(triangle) => {
            let [a, b, c] = triangle.corners().mapped(|corner| corner - origin);
            Triangle::try_new(a, b, c).ok().map(PartSolid::Triangle)
        }
        PartSolid::Segment(segment) => {
            let ends = [segment.a() - origin, segment.b() - origin];
            Segment::try_new(ends[0], ends[1]).ok().map(PartSolid::Segment)
        }
        PartSolid::Shape(_) => None,
    }
}
