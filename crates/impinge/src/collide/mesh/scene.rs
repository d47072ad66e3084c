//! Parts of two shapes, placed for the pair algorithms.

use core::cell::OnceCell;

use super::part_cache::PartCache;
use super::patch::Piece;
use crate::collide::packet::LANES;
use crate::collide::parts::between::{Between, anchor, recentred};
use crate::collide::parts::slabs::corners;
use crate::collide::parts::{PairMasks, PartPairs};
use crate::collide::{Pair, RawManifold, RawPoints};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector};
use crate::shape::{CompositeShape, Geometry, Kind, Part, PartSolid, Plane, SurfaceAccess};
use crate::tables::ByDimension;

/// Two shapes, at least one of them a composite, whose parts can be placed in pairs.
pub(crate) struct Scene<'a, N: Real, const D: usize> {
    pub(super) between: &'a Between<'a, N, D>,
    /// The surface of each shape, if it has one.
    pub(super) surfaces: [Option<SurfaceAccess<'a, N, D>>; 2],
    /// The cached parts of the second shape.
    around: &'a PartCache<N, D>,
    /// Placement of a part of the second shape relative to a convex first shape, computed for the
    /// first part that is placed; most parts of a surface have this placement.
    shared: OnceCell<SharedPlacement<N, D>>,
}

/// The placement of a part with corners relative to a convex first shape.
#[derive(Clone, Copy)]
struct SharedPlacement<N: Real, const D: usize> {
    /// The pose of the part in the frame of its shape.
    pose: Pose<N, D>,
    is_segment: bool,
    /// The anchor, which is the origin of the first shape, in the frame of the part.
    local: Vector<N, D>,
    /// Anchor in the frame of the first shape, and in the frame of the second.
    origins: [Point<N, D>; 2],
    relative: RelativePose<N, D>,
}

/// Relative pose of the two bodies (the placed parts) of a pair, in the order of their kinds.
#[derive(Clone, Copy)]
struct RelativePose<N: Real, const D: usize> {
    /// Pose of the second body in the frame of the first.
    pose12: Pose<N, D>,
    /// Whether the first body is the part of the second shape.
    is_swapped: bool,
    /// Pose of the first body in the frame of the first shape, with the anchor as the origin.
    frame: Pose<N, D>,
    /// Rotation from the frame of the second shape to the frame of the first.
    turn: Pose<N, D>,
}

/// A part of one of the shapes, placed relative to an anchor; a convex shape counts as its only
/// part.
struct PlacedPart<'a, N: Real, const D: usize> {
    /// Pose of `solid` in the frame of the part's shape, with the anchor as the origin.
    pose: Pose<N, D>,
    /// The solid; corners of triangles and segments are relative to the anchor.
    solid: WholeOrPart<'a, N, D>,
}

/// A whole convex shape, or a part of a composite.
enum WholeOrPart<'a, N: Real, const D: usize> {
    Whole(Kind<'a, N, D>),
    Part(PartSolid<'a, N, D>),
}

/// A part of the first shape and a part of the second, in the order of their kinds.
///
/// Both parts are translated so that an anchor close to them becomes the origin, as in
/// [`Between::parts`]. The distance of the two parts is therefore equal, bit for bit, to the
/// distance of the pair that [`Between::parts`] makes; only the order of the parts may differ.
pub(super) struct PlacedPair<'a, N: Real, const D: usize> {
    /// The two parts, in the order of their kinds.
    bodies: [PlacedPart<'a, N, D>; 2],
    relative: RelativePose<N, D>,
    /// Anchor in the frame of the first shape, and in the frame of the second.
    origins: [Point<N, D>; 2],
    /// Whether the part of the second shape has the shared placement of its [`Scene`].
    is_shared: bool,
}

/// Translates a part so that `origin` becomes the origin. For triangles and segments, the corners
/// are moved instead of the pose, so that adjacent parts still share their corners bit for bit.
fn moved<'a, N: Real, const D: usize>(
    part: &Part<'a, N, D>,
    origin: &Point<N, D>,
) -> PlacedPart<'a, N, D> {
    let local = part.pose.inverse_point(origin).coords;
    let Pose { rotation, translation } = part.pose;
    match recentred(&part.solid, &local) {
        Some(solid) => {
            let translation = Vector::<N, D>::zeros();
            PlacedPart { pose: Pose { rotation, translation }, solid: WholeOrPart::Part(solid) }
        }
        None => {
            let translation = translation - origin.coords;
            PlacedPart {
                pose: Pose { rotation, translation },
                solid: WholeOrPart::Part(part.solid),
            }
        }
    }
}

impl<N: Real, const D: usize> PlacedPart<'_, N, D> {
    fn kind(&self) -> Kind<'_, N, D> {
        match &self.solid {
            WholeOrPart::Whole(kind) => *kind,
            WholeOrPart::Part(solid) => solid.geometry().0,
        }
    }

    /// Returns the corners of a triangle or segment, relative to the anchor; `None` for other
    /// solids.
    fn corners(&self) -> Option<[Vector<N, D>; 3]> {
        match &self.solid {
            WholeOrPart::Whole(_) => None,
            WholeOrPart::Part(solid) => corners(solid, &self.pose),
        }
    }

    /// Returns a point well inside the solid; `None` for a half-space.
    fn center(&self) -> Option<Point<N, D>> {
        let map = Geometry(self.kind()).as_support_map()?;
        Some(self.pose.point(&map.center()))
    }
}

impl<'a, N: Space<D>, const D: usize> Scene<'a, N, D> {
    pub(super) fn new(between: &'a Between<'a, N, D>, around: &'a PartCache<N, D>) -> Self {
        let surface = |composite: Option<&'a dyn CompositeShape<N, D>>| composite?.surface_access();
        let surfaces = between.composites().mapped(surface);
        Self { between, surfaces, around, shared: OnceCell::new() }
    }

    /// Returns a part of the second shape, from the cache if it is there.
    fn part2(&self, composite: &'a dyn CompositeShape<N, D>, part: u32) -> Part<'a, N, D> {
        self.around.part(part).unwrap_or_else(|| composite.part(part))
    }

    pub(super) fn first_is_convex(&self) -> bool {
        self.between.composites()[0].is_none()
    }

    /// Calls `visit` with each ghost that is adjacent to one of two parts, and the other part.
    pub(super) fn each_ghost_beside(&self, parts: [u32; 2], visit: &mut dyn FnMut([u32; 2])) {
        if let Some(surface) = self.surfaces[0] {
            surface.each_ghost_beside(parts[0], &mut |ghost| visit([ghost, parts[1]]));
        }
        if let Some(surface) = self.surfaces[1] {
            surface.each_ghost_beside(parts[1], &mut |ghost| visit([parts[0], ghost]));
        }
    }

    /// Returns whether one of two parts belongs to a surface that encloses a solid region.
    pub(super) fn are_bodies(&self, parts: [u32; 2]) -> bool {
        let mut both = self.surfaces.iter().zip(parts);
        both.any(|(surface, part)| surface.is_some_and(|surface| surface.is_body(part)))
    }

    /// Returns a part of the second shape; `None` if the second shape is not a composite.
    pub(super) fn second_part(&self, part: u32) -> Option<Part<'a, N, D>> {
        let [_, composite] = self.between.composites();
        Some(self.part2(composite?, part))
    }

    /// Calls `visit` with the ids of the corners of a part of the second shape. Parts that share a
    /// corner give the same id.
    pub(super) fn each_corner(&self, part: u32, mut visit: impl FnMut(u64)) {
        if let [_, Some(composite)] = self.between.composites() {
            composite.each_corner(part, &mut visit);
        }
    }

    /// Returns the pair of two parts, built in `slot`. If `slot` holds a pair with the shared
    /// placement, only the part of the second shape is replaced.
    pub(super) fn pair_in<'s>(
        &self,
        slot: &'s mut Option<PlacedPair<'a, N, D>>,
        parts: [u32; 2],
    ) -> &'s PlacedPair<'a, N, D> {
        let is_exchanged = match (&mut *slot, self.shared.get(), self.between.composites()) {
            (Some(old), Some(shared), [_, Some(composite)]) if old.is_shared => {
                old.exchange(shared, &self.part2(composite, parts[1]))
            }
            _ => false,
        };
        if !is_exchanged {
            *slot = None;
        }
        slot.get_or_insert_with(|| self.pair(parts))
    }

    /// Returns the pair of two parts.
    pub(super) fn pair(&self, [part1, part2]: [u32; 2]) -> PlacedPair<'a, N, D> {
        let [composite1, composite2] = self.between.composites();
        let piece1 = composite1.map(|composite| composite.part(part1));
        let piece2 = composite2.map(|composite| self.part2(composite, part2));
        if let (None, Some(piece2)) = (&piece1, &piece2)
            && let Some(pair) = self.with_shared_placement(piece2)
        {
            return pair;
        }
        let pose21 = &self.between.pose21;
        let origins = match &piece1 {
            None => [Point::origin(), Point::from(pose21.translation)],
            Some(piece1) => {
                let origin1 = anchor(piece1);
                [origin1, pose21.point(&origin1)]
            }
        };
        let body = |kind, piece: Option<Part<'a, N, D>>, origin| match piece {
            None => PlacedPart { pose: Pose::identity(), solid: WholeOrPart::Whole(kind) },
            Some(piece) => moved(&piece, origin),
        };
        let whole = &self.between.pair;
        let bodies =
            [body(whole.first, piece1, &origins[0]), body(whole.second, piece2, &origins[1])];
        PlacedPair::new(bodies, self.turn(), origins)
    }

    /// Returns the pair of a half-space and one part. `which` is the shape of the part: the first
    /// (0) or the second (1); the half-space replaces the other shape. The `plane` is in the frame
    /// of the shape that it replaces; its boundary runs through `point`, in the frame of the first
    /// shape.
    pub(super) fn above<'p>(
        &'p self,
        plane: &'p Plane<N, D>,
        point: &Point<N, D>,
        (which, part): (usize, u32),
    ) -> PlacedPair<'p, N, D> {
        let whole = &self.between.pair;
        let origins = [*point, whole.pose12.inverse_point(point)];
        let origin = &origins[which];
        let body = match self.between.composites()[which] {
            Some(composite) => moved(&composite.part(part), origin),
            None => {
                let solid = WholeOrPart::Whole([whole.first, whole.second][which]);
                PlacedPart { pose: Pose::from_translation(-origin.coords), solid }
            }
        };
        let boundary = WholeOrPart::Whole(Kind::Plane(plane));
        let boundary = PlacedPart { pose: Pose::identity(), solid: boundary };
        let bodies = if which == 0 { [body, boundary] } else { [boundary, body] };
        PlacedPair::new(bodies, self.turn(), origins)
    }

    /// Returns the rotation from the frame of the second shape to the frame of the first.
    fn turn(&self) -> Pose<N, D> {
        Pose { rotation: self.between.pair.pose12.rotation, ..Pose::identity() }
    }

    /// Returns the pair of a convex solid and a part with the shared placement, without computing
    /// its poses again; `None` for other parts, and if a coordinate overflows.
    fn with_shared_placement(&self, part: &Part<'a, N, D>) -> Option<PlacedPair<'a, N, D>> {
        if let PartSolid::Shape(_) = part.solid {
            return None;
        }
        let shared = self.shared.get_or_init(|| self.placement_of(part));
        let solid = WholeOrPart::Part(shared.recentred(part)?);
        let pose = Pose { rotation: part.pose.rotation, translation: Vector::<N, D>::zeros() };
        let whole = WholeOrPart::Whole(self.between.pair.first);
        let bodies =
            [PlacedPart { pose: Pose::identity(), solid: whole }, PlacedPart { pose, solid }];
        Some(PlacedPair {
            is_shared: true,
            ..PlacedPair::of(bodies, shared.relative, shared.origins)
        })
    }

    /// Returns the placement of a part; it holds for all parts with the same pose and kind.
    fn placement_of(&self, part: &Part<'a, N, D>) -> SharedPlacement<N, D> {
        let origins = [Point::origin(), Point::from(self.between.pose21.translation)];
        let rotation = part.pose.rotation;
        let pose = Pose { rotation, translation: Vector::<N, D>::zeros() };
        let kind = part.solid.geometry().kind();
        let is_swapped = Geometry(self.between.pair.first).kind() > kind;
        SharedPlacement {
            pose: part.pose,
            is_segment: matches!(part.solid, PartSolid::Segment(_)),
            local: part.pose.inverse_point(&origins[1]).coords,
            origins,
            relative: RelativePose::new([&Pose::identity(), &pose], self.turn(), is_swapped),
        }
    }
}

impl<N: Space<D>, const D: usize> SharedPlacement<N, D> {
    /// Returns a part with the anchor as its origin; `None` if the part does not have this
    /// placement or a coordinate overflows.
    fn recentred<'a>(&self, part: &Part<'a, N, D>) -> Option<PartSolid<'a, N, D>> {
        let is_segment = matches!(part.solid, PartSolid::Segment(_));
        let is_alike = self.pose.is_same(&part.pose) && self.is_segment == is_segment;
        if is_alike { recentred(&part.solid, &self.local) } else { None }
    }
}

impl<N: Space<D>, const D: usize> RelativePose<N, D> {
    /// Computes the relative pose from the poses of a part of the first shape and a part of the
    /// second shape, each with the anchor as the origin.
    fn new([pose1, pose2]: [&Pose<N, D>; 2], turn: Pose<N, D>, is_swapped: bool) -> Self {
        let (frame1, frame2) = (*pose1, turn.compose(pose2));
        let pose12 = Pose::relative(&frame1, &frame2);
        // In the opposite order of kinds, `pose12` is the inverse of the pose in the order of
        // shapes, as for a pair of whole shapes. Composed directly, it would differ by rounding,
        // and the contact would not agree bit for bit with a separation query.
        let (frame, pose12) =
            if is_swapped { (frame2, pose12.inverse()) } else { (frame1, pose12) };
        Self { pose12, is_swapped, frame, turn }
    }
}

impl<'a, N: Space<D>, const D: usize> PlacedPair<'a, N, D> {
    fn new(bodies: [PlacedPart<'a, N, D>; 2], turn: Pose<N, D>, origins: [Point<N, D>; 2]) -> Self {
        let kind = |body: &PlacedPart<'_, N, D>| Geometry(body.kind()).kind();
        let is_swapped = kind(&bodies[0]) > kind(&bodies[1]);
        let relative = RelativePose::new([&bodies[0].pose, &bodies[1].pose], turn, is_swapped);
        Self::of(bodies, relative, origins)
    }

    /// Creates a pair of a part of the first shape and a part of the second.
    fn of(
        [body1, body2]: [PlacedPart<'a, N, D>; 2],
        relative: RelativePose<N, D>,
        origins: [Point<N, D>; 2],
    ) -> Self {
        let bodies = if relative.is_swapped { [body2, body1] } else { [body1, body2] };
        Self { bodies, relative, origins, is_shared: false }
    }

    /// Replaces the part of the second shape by `part`. Returns `false`, and changes nothing, if
    /// `part` does not have the shared placement or a coordinate overflows.
    fn exchange(&mut self, shared: &SharedPlacement<N, D>, part: &Part<'a, N, D>) -> bool {
        let Some(solid) = shared.recentred(part) else { return false };
        let at = usize::from(!self.relative.is_swapped);
        self.bodies[at].solid = WholeOrPart::Part(solid);
        true
    }
}

impl<N: Space<D>, const D: usize> PlacedPair<'_, N, D> {
    /// Returns the two parts in the order of their kinds.
    pub(super) fn pair(&self) -> Pair<'_, N, D> {
        let [first, second] = &self.bodies;
        Pair { first: first.kind(), second: second.kind(), pose12: self.relative.pose12 }
    }

    /// Returns whether both parts have a centre: neither is a half-space.
    pub(super) fn has_centers(&self) -> bool {
        self.bodies.iter().all(|body| Geometry(body.kind()).as_support_map().is_some())
    }

    /// Returns points well inside the part of the first shape and the part of the second, each in
    /// the frames of both shapes, as `[part][frame]`. `None` if one part is a half-space.
    pub(super) fn centers(&self) -> Option<[[Point<N, D>; 2]; 2]> {
        let [center1, center2] = self.swapped([self.bodies[0].center()?, self.bodies[1].center()?]);
        let [origin1, origin2] = self.origins.mapped(|origin| origin.coords);
        let [in1, in2] =
            [self.relative.turn.inverse_point(&center1), self.relative.turn.point(&center2)];
        Some([[center1 + origin1, in1 + origin2], [in2 + origin1, center2 + origin2]])
    }

    /// Returns `from` or, if that is `None`, the centre of a convex first shape, and the centre of
    /// the part of the second shape. Both are in the frame of the second shape. `None` if a centre
    /// is needed but does not exist.
    pub(super) fn centers_in_second(&self, from: &Option<Point<N, D>>) -> Option<[Point<N, D>; 2]> {
        let [first, second] = if self.relative.is_swapped { [1, 0] } else { [0, 1] };
        let origin = self.origins[1].coords;
        let own = self.bodies[second].center()? + origin;
        let other = match from {
            Some(from) => *from,
            None => self.relative.turn.inverse_point(&self.bodies[first].center()?) + origin,
        };
        Some([other, own])
    }

    /// Returns a bound of the rounding errors of lengths computed for the two bodies.
    pub(super) fn tolerance(&self) -> N {
        let size = |body: &PlacedPart<'_, N, D>| {
            let map = Geometry(body.kind()).as_support_map();
            map.map_or(N::ZERO, |map| map.reach() + map.rounding())
        };
        let lengths = size(&self.bodies[0]) + size(&self.bodies[1]);
        N::lit(16.0) * N::EPSILON * (lengths + self.relative.pose12.translation.norm())
    }

    /// Converts a pair of values from the order of shapes to the order of kinds, or back.
    pub(super) fn swapped<S>(&self, [a, b]: [S; 2]) -> [S; 2] {
        if self.relative.is_swapped { [b, a] } else { [a, b] }
    }

    /// Rotates a direction from the frame of the second shape to that of the first.
    pub(super) fn in_first_frame(&self, direction: &Vector<N, D>) -> Vector<N, D> {
        self.relative.turn.vector(direction)
    }

    /// Rotates a direction from the frame of the first shape to that of the second.
    pub(super) fn in_second_frame(&self, direction: &Vector<N, D>) -> Vector<N, D> {
        self.relative.turn.inverse_vector(direction)
    }

    /// Takes a normal that points from the first body to the second, in the frame of the first
    /// body. Returns it as a vector from the first shape to the second, in the frame of the first
    /// shape: rotated, and negated if the order of kinds swaps the shapes.
    pub(super) fn outward(&self, normal: &Vector<N, D>) -> Vector<N, D> {
        let normal = self.relative.frame.vector(normal);
        if self.relative.is_swapped { -normal } else { normal }
    }

    /// Takes a normal that points from the first shape to the second, in the frame of the first
    /// shape. Returns it as a vector from the first body to the second, in the frame of the first
    /// body: rotated, and negated if the order of kinds swaps the shapes.
    pub(super) fn inward(&self, normal: &Vector<N, D>) -> Vector<N, D> {
        let normal = self.relative.frame.inverse_vector(normal);
        if self.relative.is_swapped { -normal } else { normal }
    }

    /// Converts a separation of the two shapes, in the frame of the first shape, to one of
    /// [`Self::pair`].
    pub(super) fn of_kinds(&self, found: &Separation<N, D>) -> Separation<N, D> {
        let origin = self.origins[0].coords;
        let local = |point: &Point<N, D>| self.relative.frame.inverse_point(&(point - origin));
        let [point1, point2] = self.swapped([local(&found.point1), local(&found.point2)]);
        Separation { normal: self.inward(&found.normal), point1, point2, ..*found }
    }

    /// Returns whether one of `translations` of the second shape, in the frame of the first,
    /// separates the two parts up to `tolerance`.
    pub(super) fn is_parted_by_one(&self, translations: &[Vector<N, D>], tolerance: N) -> bool {
        let Some([one, other]) = self.corners() else {
            return translations.iter().any(|translation| self.is_parted(translation, tolerance));
        };
        let mut pairs = PartPairs::new(N::ZERO);
        translations.chunks(LANES).any(|translations| {
            for (lane, translation) in translations.iter().enumerate() {
                pairs.ones.put(lane, &one.mapped(Point::from));
                pairs.others.put(lane, &other.mapped(|corner| Point::from(corner + translation)));
            }
            pairs.count = translations.len();
            let PairMasks { beyond, within } = <N::Algorithms>::part_pairs(&pairs, -tolerance);
            // Few pairs are so close to the limit that the lanes leave them undecided.
            let is_open = |lane: usize| (beyond | within) >> lane & 1 == 0;
            let mut open = translations.iter().enumerate().filter(|(lane, _)| is_open(*lane));
            beyond != 0 || open.any(|(_, translation)| self.is_parted(translation, tolerance))
        })
    }

    /// Returns the corners of both parts in the frame of the first shape, relative to the anchor;
    /// `None` if one part has no corners.
    fn corners(&self) -> Option<[[Vector<N, D>; 3]; 2]> {
        let [first, second] = self.swapped([&self.bodies[0], &self.bodies[1]]);
        let second = second.corners()?;
        Some([first.corners()?, second.mapped(|corner| self.relative.turn.vector(&corner))])
    }

    /// Returns whether `translation` of the second shape, in the frame of the first, separates the
    /// two parts up to `tolerance`.
    fn is_parted(&self, translation: &Vector<N, D>, tolerance: N) -> bool {
        let mut pair = self.pair();
        pair.pose12.translation += self.inward(translation);
        <N::Algorithms>::separation(&pair, -tolerance).is_none()
    }

    /// Takes the manifold of [`Self::pair`], in the frame of its first body. Returns the manifold
    /// of the shapes, in the frame of the first shape, as a piece whose points are appended to
    /// `points`; ids and codes are copied unchanged.
    pub(super) fn piece(
        &self,
        raw: &RawManifold<N, D>,
        parts: [u32; 2],
        points: &mut RawPoints<N, D>,
    ) -> Piece<N, D> {
        let start = points.len();
        for point in &raw.points {
            let mut placed = *point;
            let across = if self.relative.is_swapped { point.distance } else { N::ZERO };
            let foot = self.relative.frame.point(&(point.point1 + raw.normal * across));
            placed.point1 = self.origins[0] + foot.coords;
            [placed.feature1, placed.feature2] = self.swapped([point.feature1, point.feature2]);
            points.push(placed);
        }
        Piece { normal: self.outward(&raw.normal), parts, points: start..points.len() }
    }
}
