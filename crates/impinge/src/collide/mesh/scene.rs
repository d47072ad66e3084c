//! The parts of two shapes, placed for computing with them.

use crate::tables::ByDimension;
use core::cell::OnceCell;

use super::part_cache::PartCache;
use super::patch::Piece;
use crate::collide::packet::LANES;
use crate::collide::parts::between::{Between, anchor, recentred};
use crate::collide::parts::slabs::corners;
use crate::collide::parts::{PairVerdicts, PartPairs};
use crate::collide::{Pair, RawManifold, RawPoints};
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, min};
use crate::shape::{CompositeShape, Geometry, Kind, Part, PartSolid, Plane, SurfaceAccess};

/// Two shapes, one of them a composite at least.
pub(crate) struct Scene<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    /// What holds the parts of each together.
    pub(super) surfaces: [Option<SurfaceAccess<'a, N, D>>; 2],
    /// What is kept of the parts of the second.
    around: &'a PartCache<N, D>,
    /// How the parts of a surface lie that a convex solid meets: most lie alike.
    usual: OnceCell<Usual<N, D>>,
}

/// How a part that is given by its corners lies to a convex first shape.
#[derive(Clone, Copy)]
struct Usual<N: Real, const D: usize> {
    /// Of the part, in the frame of its shape.
    pose: Pose<N, D>,
    is_segment: bool,
    /// Of the part's frame, the point that the two are seen from.
    local: Vector<N, D>,
    /// The point in the frames of the two shapes.
    origins: [Point<N, D>; 2],
    lying: Lying<N, D>,
}

/// How two bodies lie to each other.
#[derive(Clone, Copy)]
struct Lying<N: Real, const D: usize> {
    /// The second of the bodies, in the order of their kinds, in the frame of the first.
    pose12: Pose<N, D>,
    /// The first of the bodies is the part of the second shape.
    is_turned: bool,
    /// The frame of the first of the bodies, in that of the first shape put through the point.
    frame: Pose<N, D>,
    /// The rotation of the second shape's frame in that of the first.
    turn: Pose<N, D>,
}

/// A part of one of the shapes; a convex shape is its own part.
struct PlacedPart<'a, N: Real, const D: usize> {
    /// Where it lies to the axes of its shape put through the point that it is seen from.
    pose: Pose<N, D>,
    solid: WholeOrPart<'a, N, D>,
}

enum WholeOrPart<'a, N: Real, const D: usize> {
    Whole(Kind<'a, N, D>),
    Part(PartSolid<'a, N, D>),
}

/// A part of the first shape and one of the second, in the order of their kinds.
///
/// Both are seen from one point close to them, as [`Between::parts`] does; so this is the same
/// pair, up to the order, and as far apart to the bit.
pub(super) struct PlacedPair<'a, N: Real, const D: usize> {
    /// In the order of kinds.
    bodies: [PlacedPart<'a, N, D>; 2],
    lying: Lying<N, D>,
    /// The point in the frames of the two shapes.
    origins: [Point<N, D>; 2],
    /// The part of the second shape lies as those of its [`Scene`] usually do.
    is_usual: bool,
}

/// A part seen from another origin. Corners are moved rather than the pose, so that solids that share
/// corners still do.
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

    /// The corners of what is given by them.
    fn corners(&self) -> Option<[Vector<N, D>; 3]> {
        match &self.solid {
            WholeOrPart::Whole(_) => None,
            WholeOrPart::Part(solid) => corners(solid, &self.pose),
        }
    }

    /// A point well inside; `None` of a half-space.
    fn center(&self) -> Option<Point<N, D>> {
        let map = Geometry(self.kind()).as_support_map()?;
        Some(self.pose.point(&map.center()))
    }
}

impl<'a, N: Space<D>, const D: usize> Scene<'a, N, D> {
    pub(super) fn new(between: &'a Between<'a, N, D>, around: &'a PartCache<N, D>) -> Self {
        let surface = |composite: Option<&'a dyn CompositeShape<N, D>>| composite?.surface_access();
        let surfaces = between.composites().mapped(surface);
        Self { between, surfaces, around, usual: OnceCell::new() }
    }

    /// A part of the second shape, from what is kept of it or else from the shape.
    fn part2(&self, composite: &'a dyn CompositeShape<N, D>, part: u32) -> Part<'a, N, D> {
        self.around.part(part).unwrap_or_else(|| composite.part(part))
    }

    /// The first shape is one solid.
    pub(super) fn first_is_convex(&self) -> bool {
        self.between.composites()[0].is_none()
    }

    /// One of two parts bounds a body.
    pub(super) fn are_bodies(&self, parts: [u32; 2]) -> bool {
        let mut both = self.surfaces.iter().zip(parts);
        both.any(|(surface, part)| surface.is_some_and(|surface| surface.is_body(part)))
    }

    /// A point of the first shape's frame lies in that shape by more than a depth: no plane parts the two
    /// by less than that. False of composites.
    pub(super) fn is_within(&self, point: &Point<N, D>, depth: N) -> bool {
        match self.between.pair.first {
            Kind::Composite(_) | Kind::Plane(_) => false,
            Kind::Cuboid(cuboid) => (0..D).all(|axis| {
                let half = cuboid.half_extents()[axis];
                min(half - point[axis], point[axis] + half) > depth
            }),
            // A hull without faces is a segment or a point.
            Kind::Polytope(hull) => {
                let mut faces = hull.faces().iter();
                !hull.faces().is_empty()
                    && faces.all(|face| face.offset - face.normal.dot(&point.coords) > depth)
            }
            first => {
                let found = <N::Algorithms>::surface_point(first, point);
                found.is_inside && (found.point - point).norm() > depth
            }
        }
    }

    /// A part of the second shape, if that is a composite.
    pub(super) fn second_part(&self, part: u32) -> Option<Part<'a, N, D>> {
        let [_, composite] = self.between.composites();
        Some(self.part2(composite?, part))
    }

    /// Calls with the corners of a part of the second shape that others may share.
    pub(super) fn each_corner(&self, part: u32, mut visit: impl FnMut(u64)) {
        if let [_, Some(composite)] = self.between.composites() {
            composite.each_corner(part, &mut visit);
        }
    }

    /// [`Self::pair`] in a place that is used again and again: of parts that lie alike only the part is
    /// exchanged.
    pub(super) fn pair_in<'s>(
        &self,
        slot: &'s mut Option<PlacedPair<'a, N, D>>,
        parts: [u32; 2],
    ) -> &'s PlacedPair<'a, N, D> {
        let is_exchanged = match (&mut *slot, self.usual.get(), self.between.composites()) {
            (Some(old), Some(usual), [_, Some(composite)]) if old.is_usual => {
                old.exchange(usual, &self.part2(composite, parts[1]))
            }
            _ => false,
        };
        if !is_exchanged {
            *slot = None;
        }
        slot.get_or_insert_with(|| self.pair(parts))
    }

    /// Two parts.
    pub(super) fn pair(&self, [part1, part2]: [u32; 2]) -> PlacedPair<'a, N, D> {
        let [composite1, composite2] = self.between.composites();
        let piece1 = composite1.map(|composite| composite.part(part1));
        let piece2 = composite2.map(|composite| self.part2(composite, part2));
        if let (None, Some(piece2)) = (&piece1, &piece2)
            && let Some(pair) = self.as_usual(piece2)
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

    /// A part of the first shape (0) or the second (1), and in the place of the other shape a half-space, given in the
    /// other's frame, whose boundary runs through a point of the frame of the first.
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

    /// The rotation of the second shape's frame in that of the first.
    fn turn(&self) -> Pose<N, D> {
        Pose { rotation: self.between.pair.pose12.rotation, ..Pose::identity() }
    }

    /// A convex solid and a part that lies like those before: the same pair at less cost. `None` of
    /// others.
    fn as_usual(&self, part: &Part<'a, N, D>) -> Option<PlacedPair<'a, N, D>> {
        if let PartSolid::Shape(_) = part.solid {
            return None;
        }
        let usual = self.usual.get_or_init(|| self.usual(part));
        let solid = WholeOrPart::Part(usual.recentred(part)?);
        let pose = Pose { rotation: part.pose.rotation, translation: Vector::<N, D>::zeros() };
        let whole = WholeOrPart::Whole(self.between.pair.first);
        let bodies =
            [PlacedPart { pose: Pose::identity(), solid: whole }, PlacedPart { pose, solid }];
        Some(PlacedPair { is_usual: true, ..PlacedPair::of(bodies, usual.lying, usual.origins) })
    }

    fn usual(&self, part: &Part<'a, N, D>) -> Usual<N, D> {
        let origins = [Point::origin(), Point::from(self.between.pose21.translation)];
        let rotation = part.pose.rotation;
        let pose = Pose { rotation, translation: Vector::<N, D>::zeros() };
        let kind = part.solid.geometry().kind();
        let is_turned = Geometry(self.between.pair.first).kind() > kind;
        Usual {
            pose: part.pose,
            is_segment: matches!(part.solid, PartSolid::Segment(_)),
            local: part.pose.inverse_point(&origins[1]).coords,
            origins,
            lying: Lying::new([&Pose::identity(), &pose], self.turn(), is_turned),
        }
    }
}

impl<N: Space<D>, const D: usize> Usual<N, D> {
    /// A part seen from the point; `None` of one that lies otherwise.
    fn recentred<'a>(&self, part: &Part<'a, N, D>) -> Option<PartSolid<'a, N, D>> {
        let is_segment = matches!(part.solid, PartSolid::Segment(_));
        let is_alike = self.pose.is_same(&part.pose) && self.is_segment == is_segment;
        if is_alike { recentred(&part.solid, &self.local) } else { None }
    }
}

impl<N: Space<D>, const D: usize> Lying<N, D> {
    /// By the poses of a part of the first shape and one of the second.
    fn new([pose1, pose2]: [&Pose<N, D>; 2], turn: Pose<N, D>, is_turned: bool) -> Self {
        let (frame1, frame2) = (*pose1, turn.compose(pose2));
        let pose12 = Pose::relative(&frame1, &frame2);
        // Turned round like any pair whose kinds are in the opposite order: to the bit that of the separation.
        let (frame, pose12) = if is_turned { (frame2, pose12.inverse()) } else { (frame1, pose12) };
        Self { pose12, is_turned, frame, turn }
    }
}

impl<'a, N: Space<D>, const D: usize> PlacedPair<'a, N, D> {
    fn new(bodies: [PlacedPart<'a, N, D>; 2], turn: Pose<N, D>, origins: [Point<N, D>; 2]) -> Self {
        let kind = |body: &PlacedPart<'_, N, D>| Geometry(body.kind()).kind();
        let is_turned = kind(&bodies[0]) > kind(&bodies[1]);
        let lying = Lying::new([&bodies[0].pose, &bodies[1].pose], turn, is_turned);
        Self::of(bodies, lying, origins)
    }

    /// A part of the first shape and one of the second.
    fn of(
        [body1, body2]: [PlacedPart<'a, N, D>; 2],
        lying: Lying<N, D>,
        origins: [Point<N, D>; 2],
    ) -> Self {
        let bodies = if lying.is_turned { [body2, body1] } else { [body1, body2] };
        Self { bodies, lying, origins, is_usual: false }
    }

    /// Puts another part of the second shape in the place of one that lies as usual; answers whether that
    /// one does.
    fn exchange(&mut self, usual: &Usual<N, D>, part: &Part<'a, N, D>) -> bool {
        let Some(solid) = usual.recentred(part) else { return false };
        let at = usize::from(!self.lying.is_turned);
        self.bodies[at].solid = WholeOrPart::Part(solid);
        true
    }
}

impl<N: Space<D>, const D: usize> PlacedPair<'_, N, D> {
    /// The two parts in the order of their kinds.
    pub(super) fn pair(&self) -> Pair<'_, N, D> {
        let [first, second] = &self.bodies;
        Pair { first: first.kind(), second: second.kind(), pose12: self.lying.pose12 }
    }

    /// None of the two is a half-space.
    pub(super) fn has_centers(&self) -> bool {
        self.bodies.iter().all(|body| Geometry(body.kind()).as_support_map().is_some())
    }

    /// Points well inside the part of the first shape and that of the second, each as seen by the
    /// first shape and by the second; `None` if one is a half-space.
    pub(super) fn centers(&self) -> Option<[[Point<N, D>; 2]; 2]> {
        let [center1, center2] = self.turned([self.bodies[0].center()?, self.bodies[1].center()?]);
        let [origin1, origin2] = self.origins.mapped(|origin| origin.coords);
        let [in1, in2] = [self.lying.turn.inverse_point(&center1), self.lying.turn.point(&center2)];
        Some([[center1 + origin1, in1 + origin2], [in2 + origin1, center2 + origin2]])
    }

    /// Of a convex first shape and a part of the second, of which [`Self::centers`] are known to be: these
    /// as the second shape sees them, or the first as where it comes from.
    pub(super) fn centers_in_second(&self, from: &Option<Point<N, D>>) -> Option<[Point<N, D>; 2]> {
        let [first, second] = if self.lying.is_turned { [1, 0] } else { [0, 1] };
        let origin = self.origins[1].coords;
        let own = self.bodies[second].center()? + origin;
        let other = match from {
            Some(from) => *from,
            None => self.lying.turn.inverse_point(&self.bodies[first].center()?) + origin,
        };
        Some([other, own])
    }

    /// Lengths below this are rounding errors of the pair.
    pub(super) fn tolerance(&self) -> N {
        let size = |body: &PlacedPart<'_, N, D>| {
            let map = Geometry(body.kind()).as_support_map();
            map.map_or(N::ZERO, |map| map.reach() + map.rounding())
        };
        let lengths = size(&self.bodies[0]) + size(&self.bodies[1]);
        N::lit(16.0) * N::EPSILON * (lengths + self.lying.pose12.translation.norm())
    }

    /// Something given for the first shape and the second, in the order of the kinds, or back.
    pub(super) fn turned<S>(&self, [a, b]: [S; 2]) -> [S; 2] {
        if self.lying.is_turned { [b, a] } else { [a, b] }
    }

    /// A direction in the second shape's frame, in the first's.
    pub(super) fn seen_by_first(&self, direction: &Vector<N, D>) -> Vector<N, D> {
        self.lying.turn.vector(direction)
    }

    /// A direction in the first shape's frame, in the second's.
    pub(super) fn seen_by_second(&self, direction: &Vector<N, D>) -> Vector<N, D> {
        self.lying.turn.inverse_vector(direction)
    }

    /// A direction from the first body to the second, as one from the first shape to the second.
    pub(super) fn outward(&self, normal: &Vector<N, D>) -> Vector<N, D> {
        let normal = self.lying.frame.vector(normal);
        if self.lying.is_turned { -normal } else { normal }
    }

    /// The opposite of [`Self::outward`].
    pub(super) fn inward(&self, normal: &Vector<N, D>) -> Vector<N, D> {
        let normal = self.lying.frame.inverse_vector(normal);
        if self.lying.is_turned { -normal } else { normal }
    }

    /// Moving the second shape by one of some vectors of the first's frame parts the two, up to a tolerance.
    pub(super) fn is_parted_by_one(&self, ways: &[Vector<N, D>], tolerance: N) -> bool {
        let Some([one, other]) = self.corners() else {
            return ways.iter().any(|way| self.is_parted(way, tolerance));
        };
        let mut pairs = PartPairs::new(N::ZERO);
        ways.chunks(LANES).any(|ways| {
            for (lane, way) in ways.iter().enumerate() {
                pairs.ones.put(lane, &one.mapped(Point::from));
                pairs.others.put(lane, &other.mapped(|corner| Point::from(corner + way)));
            }
            pairs.count = ways.len();
            let PairVerdicts { beyond, within } = <N::Algorithms>::part_pairs(&pairs, -tolerance);
            // Few pairs are as far apart as the tolerance but for rounding.
            let is_open = |lane: usize| (beyond | within) >> lane & 1 == 0;
            let mut open = ways.iter().enumerate().filter(|(lane, _)| is_open(*lane));
            beyond != 0 || open.any(|(_, way)| self.is_parted(way, tolerance))
        })
    }

    /// The corners of the part of the first shape and of that of the second, in the frame of the first put through the
    /// point that they are seen from; `None` of parts without.
    fn corners(&self) -> Option<[[Vector<N, D>; 3]; 2]> {
        let [first, second] = self.turned([&self.bodies[0], &self.bodies[1]]);
        let second = second.corners()?;
        Some([first.corners()?, second.mapped(|corner| self.lying.turn.vector(&corner))])
    }

    /// Moving the second shape by a vector of the first's frame parts the two, up to a tolerance.
    fn is_parted(&self, way: &Vector<N, D>, tolerance: N) -> bool {
        let mut pair = self.pair();
        pair.pose12.translation += self.inward(way);
        <N::Algorithms>::separation(&pair, -tolerance).is_none()
    }

    /// A manifold of the bodies as one of the shapes, in the frame of the first; its points are
    /// appended to others.
    pub(super) fn piece(
        &self,
        raw: &RawManifold<N, D>,
        parts: [u32; 2],
        points: &mut RawPoints<N, D>,
    ) -> Piece<N, D> {
        let start = points.len();
        for point in &raw.points {
            let mut placed = *point;
            let across = if self.lying.is_turned { point.distance } else { N::ZERO };
            let foot = self.lying.frame.point(&(point.point1 + raw.normal * across));
            placed.point1 = self.origins[0] + foot.coords;
            [placed.feature1, placed.feature2] = self.turned([point.feature1, point.feature2]);
            points.push(placed);
        }
        Piece { normal: self.outward(&raw.normal), parts, points: start..points.len() }
    }
}
