//! The parts of two shapes, placed for computing with them.

use smallvec::SmallVec;

use crate::math::{Point, Pose, Real, Space, Vector};
use crate::query::manifold_build::{Patch, PatchPoint, extremes};
use crate::query::{Pair, RawManifold};
use crate::shape::{CompositeShape, Geometry, Kind, Part, PartSolid, Segment, Surface, Triangle};

/// One of the two shapes.
#[derive(Clone, Copy)]
pub(super) struct Side<'a, N: Real, const D: usize> {
    kind: Kind<'a, N, D>,
    composite: Option<&'a dyn CompositeShape<N, D>>,
    pub(super) surface: Option<&'a dyn Surface<N, D>>,
    /// The point of the shape's frame that is computed from: near the other shape, so that nothing
    /// is lost by being far from the shape's own origin.
    pub(super) origin: Vector<N, D>,
}

/// Two shapes, one of them a composite at least.
pub(super) struct Scene<'a, N: Real, const D: usize> {
    pub(super) first: Side<'a, N, D>,
    pub(super) second: Side<'a, N, D>,
    /// The second's frame in the first's, both moved to their origins.
    pub(super) pose12: Pose<N, D>,
}

/// A part of one of the shapes, in that shape's moved frame; a convex shape is its own part.
struct Body<'a, N: Real, const D: usize> {
    pose: Pose<N, D>,
    solid: Solid<'a, N, D>,
}

enum Solid<'a, N: Real, const D: usize> {
    Whole(Kind<'a, N, D>),
    Part(PartSolid<'a, N, D>),
}

/// A part of the first shape and one of the second, in the order of their kinds.
pub(super) struct PartPair<'a, N: Real, const D: usize> {
    /// In the order of kinds.
    bodies: [Body<'a, N, D>; 2],
    pose12: Pose<N, D>,
    /// The frame of the first of the bodies, in the moved frame of the first shape.
    frame: Pose<N, D>,
    /// The first of the bodies is the part of the second shape.
    is_turned: bool,
}

impl<'a, N: Space<D>, const D: usize> Side<'a, N, D> {
    pub(super) fn new(kind: Kind<'a, N, D>, origin: Vector<N, D>) -> Self {
        let composite = Geometry(kind).as_composite();
        let surface = composite.and_then(CompositeShape::surface);
        Self { kind, composite, surface, origin }
    }

    fn body(&self, part: u32) -> Body<'a, N, D> {
        match self.composite {
            None => Body { pose: Pose::identity(), solid: Solid::Whole(self.kind) },
            Some(composite) => moved(&composite.part(part), &self.origin),
        }
    }
}

/// A part seen from another origin. Corners are moved rather than the pose, so that solids that share
/// corners still do.
fn moved<'a, N: Real, const D: usize>(
    part: &Part<'a, N, D>,
    origin: &Vector<N, D>,
) -> Body<'a, N, D> {
    let local = part.pose.inverse_point(&Point::from(*origin)).coords;
    let corners = match part.solid {
        PartSolid::Triangle(triangle) => {
            let [a, b, c] = triangle.corners().map(|corner| corner - local);
            Triangle::try_new(a, b, c).ok().map(PartSolid::Triangle)
        }
        PartSolid::Segment(segment) => {
            let moved = Segment::try_new(segment.a() - local, segment.b() - local);
            moved.ok().map(PartSolid::Segment)
        }
        PartSolid::Shape(_) => None,
    };
    let Pose { rotation, translation } = part.pose;
    match corners {
        Some(solid) => {
            let translation = rotation * local + translation - origin;
            Body { pose: Pose { rotation, translation }, solid: Solid::Part(solid) }
        }
        None => {
            let translation = translation - origin;
            Body { pose: Pose { rotation, translation }, solid: Solid::Part(part.solid) }
        }
    }
}

impl<N: Real, const D: usize> Body<'_, N, D> {
    fn kind(&self) -> Kind<'_, N, D> {
        match &self.solid {
            Solid::Whole(kind) => *kind,
            Solid::Part(solid) => solid.geometry().0,
        }
    }

    /// A point well inside; `None` of a half-space.
    fn center(&self) -> Option<Point<N, D>> {
        let map = Geometry(self.kind()).as_support_map()?;
        Some(self.pose.point(&map.center()))
    }
}

impl<'a, N: Space<D>, const D: usize> Scene<'a, N, D> {
    /// The shapes of a pair, seen from a point of the first shape's frame; a convex shape stays in
    /// its own.
    pub(super) fn new(pair: &Pair<'a, N, D>, near: &Point<N, D>) -> Self {
        let origin2 = pair.pose12.inverse_point(near).coords;
        let is_composite = Geometry(pair.first).as_composite().is_some();
        let origin1 = if is_composite { near.coords } else { Vector::zeros() };
        let Pose { rotation, translation } = pair.pose12;
        Self {
            first: Side::new(pair.first, origin1),
            second: Side::new(pair.second, origin2),
            pose12: Pose { rotation, translation: rotation * origin2 + translation - origin1 },
        }
    }

    /// Two parts.
    pub(super) fn pair(&self, [part1, part2]: [u32; 2]) -> PartPair<'a, N, D> {
        let (body1, body2) = (self.first.body(part1), self.second.body(part2));
        let seen2 = self.pose12.compose(&body2.pose);
        let kind = |body: &Body<'_, N, D>| Geometry(body.kind()).kind();
        let is_turned = kind(&body1) > kind(&body2);
        if is_turned {
            let pose12 = seen2.inverse().compose(&body1.pose);
            return PartPair { bodies: [body2, body1], pose12, frame: seen2, is_turned };
        }
        let (pose12, frame) = (body1.pose.inverse().compose(&seen2), body1.pose);
        PartPair { bodies: [body1, body2], pose12, frame, is_turned }
    }

    /// A point of the first's moved frame, in the frame of the second composite.
    pub(super) fn in_second(&self, point: &Point<N, D>) -> Point<N, D> {
        self.pose12.inverse_point(point) + self.second.origin
    }

    /// A point of the second's moved frame, in the frame of the first composite.
    pub(super) fn in_first(&self, point: &Point<N, D>) -> Point<N, D> {
        self.pose12.point(point) + self.first.origin
    }
}

impl<N: Space<D>, const D: usize> PartPair<'_, N, D> {
    /// The two parts in the order of their kinds.
    pub(super) fn pair(&self) -> Pair<'_, N, D> {
        let [first, second] = &self.bodies;
        Pair { first: first.kind(), second: second.kind(), pose12: self.pose12 }
    }

    /// Points well inside the part of the first shape and that of the second, each in its shape's
    /// moved frame; `None` of half-spaces.
    pub(super) fn centers(&self) -> [Option<Point<N, D>>; 2] {
        let [a, b] = &self.bodies;
        if self.is_turned { [b.center(), a.center()] } else { [a.center(), b.center()] }
    }

    /// Lengths below this are rounding errors of the pair.
    pub(super) fn tolerance(&self) -> N {
        let size = |body: &Body<'_, N, D>| {
            let map = Geometry(body.kind()).as_support_map();
            map.map_or(N::ZERO, |map| map.reach() + map.rounding())
        };
        let lengths = size(&self.bodies[0]) + size(&self.bodies[1]);
        N::lit(16.0) * N::EPSILON * (lengths + self.pose12.translation.norm())
    }

    /// Something given for the first shape and the second, in the order of the kinds, or back.
    pub(super) fn turned<S>(&self, [a, b]: [S; 2]) -> [S; 2] {
        if self.is_turned { [b, a] } else { [a, b] }
    }

    /// A direction from the first body to the second, as one from the first shape to the second.
    pub(super) fn outward(&self, normal: &Vector<N, D>) -> Vector<N, D> {
        let normal = self.frame.vector(normal);
        if self.is_turned { -normal } else { normal }
    }

    /// The opposite of [`Self::outward`].
    pub(super) fn inward(&self, normal: &Vector<N, D>) -> Vector<N, D> {
        let normal = self.frame.inverse_vector(normal);
        if self.is_turned { -normal } else { normal }
    }

    /// How far the parts are apart along a direction from the first shape to the second; negative
    /// where they overlap. `None` of half-spaces.
    pub(super) fn gap(&self, normal: &Vector<N, D>) -> Option<N> {
        extremes(&self.pair(), &self.inward(normal)).map(|found| found.distance)
    }

    /// A manifold of the bodies as one of the shapes, in the first shape's moved frame.
    pub(super) fn patch(&self, raw: &RawManifold<N, D>, parts: [u32; 2]) -> Patch<N, D> {
        let mut points = SmallVec::new();
        for point in &raw.points {
            let mut raw_point = *point;
            let foot = if self.is_turned { raw.normal * point.distance } else { Vector::zeros() };
            raw_point.point1 = self.frame.point(&(point.point1 + foot));
            [raw_point.feature1, raw_point.feature2] =
                self.turned([point.feature1, point.feature2]);
            points.push(PatchPoint { raw: raw_point, parts });
        }
        Patch { normal: self.outward(&raw.normal), points }
    }
}
