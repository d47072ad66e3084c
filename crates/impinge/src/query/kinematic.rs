//! Contact kinematics: they predict a contact after small motions of its solids, to first order and
//! without a new query.

mod own;
mod side;
#[cfg(test)]
mod tests;

use core::fmt;

pub use self::own::ContactSide;
use self::side::KinematicSide;
use super::Contact;
use crate::collide::{Pair, RawPoint};
use crate::convex::Separation;
use crate::math::{AbstractRotation, Isometry, Mapped, Point, Pose, Real, Unit, Vector, min, unit};
use crate::shape::{FeatureId, Geometry};

/// The local geometry of a solid's core near a contact, in its local frame.
///
/// ```
/// use impinge::dim2::math::Vector;
/// use impinge::dim2::query::{ContactSide, NeighborhoodGeometry};
/// use impinge::dim2::shape::FeatureId;
///
/// // The upper side of a box, for a contact that a user's algorithm has found.
/// let geometry = NeighborhoodGeometry::Plane(Vector::<f32>::y());
/// let side = ContactSide { feature: FeatureId::Face(1), geometry, rounding: 0.0 };
/// assert_ne!(side.geometry, NeighborhoodGeometry::Point);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NeighborhoodGeometry<N: Real, const D: usize> {
    /// A point that is fixed to the solid.
    Point,
    /// A line along this unit vector.
    Line(Vector<N, D>),
    /// A plane with this outward unit normal.
    Plane(Vector<N, D>),
}

/// The rule by which the normal of a moved contact is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum NormalRule<N: Real, const D: usize> {
    /// The normal rotates with the first solid; it is usually the normal of a face of that solid.
    First,
    /// The normal rotates with the second solid; it is usually the normal of a face of that solid.
    Second,
    /// The points and lines of the contact define the normal: it is perpendicular to the lines, or
    /// along the connection of the points.
    Geometry,
    /// The normal is perpendicular to two edges, one of each solid, whose crossing defines the
    /// manifold's normal. The values are their unit directions, each in the frame of its solid.
    Edges(Vector<N, D>, Vector<N, D>),
}

/// The data to predict a contact at new poses of its two solids.
///
/// All vectors are in the local frames of the solids and describe their cores (the solids without
/// their rounding radii); the radii are added at the end. A round side has its axis as its core.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// for (x, y) in [(0.0, 0.0), (0.5, 1.75)] {
///     world.add(Isometry::translation(x, y), square.clone(), groups, contacts, ());
/// }
/// world.update();
///
/// let (_, _, manifold) = world.contact_manifolds().next().expect("they overlap");
/// let kinematic = manifold.contacts()[0].kinematic;
/// let moved = kinematic.contact(&Isometry::identity(), &Isometry::translation(0.625, 1.5));
/// assert_eq!(moved.depth, 0.5, "without a new query");
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct ContactKinematic<N: Real, const D: usize> {
    pub(crate) feature1: FeatureId,
    pub(crate) feature2: FeatureId,
    pub(crate) local1: Point<N, D>,
    pub(crate) local2: Point<N, D>,
    pub(crate) geometry1: NeighborhoodGeometry<N, D>,
    pub(crate) geometry2: NeighborhoodGeometry<N, D>,
    pub(crate) rounding1: N,
    pub(crate) rounding2: N,
    /// The normal from the first solid to the second, in the frame of the first; used if the
    /// geometry defines no normal.
    pub(crate) normal1: Vector<N, D>,
    /// The normal from the first solid to the second, in the frame of the second.
    pub(crate) normal2: Vector<N, D>,
    rule: NormalRule<N, D>,
    /// Whether the frame of each solid rotates with it; false for a ball.
    turns: [bool; 2],
}

impl<N: Real, const D: usize> fmt::Debug for ContactKinematic<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ContactKinematic")
            .field("feature1", &self.feature1)
            .field("feature2", &self.feature2)
            .field("local1", &self.local1)
            .field("local2", &self.local2)
            .finish_non_exhaustive()
    }
}

/// A point of the first core and a point of the second, both in the frame of the first solid.
type Feet<N, const D: usize> = (Point<N, D>, Point<N, D>);

impl<N: Real, const D: usize> ContactKinematic<N, D> {
    /// Returns the kinematic of a point of a manifold; `normal` is the manifold's normal in the
    /// frame of the first solid.
    #[cfg(test)]
    pub(crate) fn new(
        pair: &Pair<'_, N, D>,
        normal: &Vector<N, D>,
        point: &RawPoint<N, D>,
    ) -> Self {
        KinematicSides::new(pair, normal).kinematic(point)
    }

    /// Returns the touching feature of the first solid.
    #[must_use]
    pub fn feature1(&self) -> FeatureId {
        self.feature1
    }

    /// Returns the touching feature of the second solid.
    #[must_use]
    pub fn feature2(&self) -> FeatureId {
        self.feature2
    }

    /// Returns the contact of the same features with the solids at new poses, without a new query.
    ///
    /// At the poses of the last update the result is the contact itself; for a small motion its
    /// error is of second order. The prediction does not detect that other features came nearer, or
    /// that the contact left its features: query again after a larger motion. A corner pairs with
    /// its nearest point on the plane or line of the other solid. Two crossing lines give their
    /// nearest points; two points, or a point and a line, give the shortest connection. If the
    /// connection vanishes, and for nearly parallel lines, the points and the normal at the last
    /// update move with their solids. A contact on a round rim is fixed to its point of the rim:
    /// for the deepest contact the errors are of second order in distance and normal, of first
    /// order in position. If a pose is not finite, the result is not finite.
    #[must_use]
    pub fn contact<R: AbstractRotation<N, D>>(
        &self,
        m1: &Isometry<N, R, D>,
        m2: &Isometry<N, R, D>,
    ) -> Contact<N, D> {
        let pose = |isometry, turns| {
            if turns { Pose::from_isometry(isometry) } else { Pose::unturned(isometry) }
        };
        let (pose1, pose2) = (pose(m1, self.turns[0]), pose(m2, self.turns[1]));
        let moved = self.predicted(&Pose::relative(&pose1, &pose2));
        Contact {
            world1: pose1.point(&moved.point1),
            world2: pose1.point(&moved.point2),
            normal: Unit::new_unchecked(pose1.vector(&moved.normal)),
            depth: -moved.distance,
        }
    }

    /// Returns the kinematic of the solids with `first` and `second` added to their radii.
    pub(super) fn grown(&self, [first, second]: [N; 2]) -> Self {
        let (rounding1, rounding2) = (self.rounding1 + first, self.rounding2 + second);
        Self { rounding1, rounding2, ..*self }
    }

    /// Returns the kinematic with the solids swapped.
    pub(crate) fn flipped(&self) -> Self {
        Self {
            feature1: self.feature2,
            feature2: self.feature1,
            local1: self.local2,
            local2: self.local1,
            geometry1: self.geometry2,
            geometry2: self.geometry1,
            rounding1: self.rounding2,
            rounding2: self.rounding1,
            normal1: -self.normal2,
            normal2: -self.normal1,
            rule: match self.rule {
                NormalRule::First => NormalRule::Second,
                NormalRule::Second => NormalRule::First,
                NormalRule::Edges(edge1, edge2) => NormalRule::Edges(edge2, edge1),
                NormalRule::Geometry => NormalRule::Geometry,
            },
            turns: [self.turns[1], self.turns[0]],
        }
    }

    /// Returns the kinematic of a contact whose normal belongs to a face of the first or second
    /// shape, but not of the touching part alone. The normal then rotates with that shape, unless
    /// the geometry gives the normal.
    pub(super) fn turning_with(self, is_second: bool) -> Self {
        let own = if is_second { NormalRule::Second } else { NormalRule::First };
        let rule = if self.rule == NormalRule::Geometry { NormalRule::Geometry } else { own };
        Self { rule, ..self }
    }

    /// Returns the kinematic in the frames of two shapes that have the solids as parts. `pose1` and
    /// `pose2` are the poses of the solids there; `turns`: whether a rotation changes each shape.
    pub(super) fn in_frames(&self, [pose1, pose2]: [&Pose<N, D>; 2], turns: [bool; 2]) -> Self {
        Self {
            turns,
            local1: pose1.point(&self.local1),
            local2: pose2.point(&self.local2),
            geometry1: self.geometry1.moved(pose1),
            geometry2: self.geometry2.moved(pose2),
            normal1: pose1.vector(&self.normal1),
            normal2: pose2.vector(&self.normal2),
            rule: match self.rule {
                NormalRule::Edges(edge1, edge2) => {
                    NormalRule::Edges(pose1.vector(&edge1), pose2.vector(&edge2))
                }
                rule => rule,
            },
            ..*self
        }
    }

    /// Predicts the contact, in the frame of the first solid, for the new relative pose `pose12`.
    pub(crate) fn predicted(&self, pose12: &Pose<N, D>) -> Separation<N, D> {
        let point2 = pose12.point(&self.local2);
        let geometry2 = self.geometry2.moved(pose12);
        let normal = self.normal(&point2, geometry2, pose12);
        let geometry1 = self.geometry1.moved(&Pose::identity());
        let (foot1, foot2) = feet([&self.local1, &point2], [geometry1, geometry2], &normal);
        let distance = normal.dot(&(foot2 - foot1)) - self.rounding1 - self.rounding2;
        let point1 = foot1 + normal * self.rounding1;
        Separation { distance, normal, point1, point2: point1 + normal * distance }
    }

    /// Returns whether the geometry alone gives the manifold's normal, up to rounding.
    fn reproduces(&self, pose12: &Pose<N, D>) -> bool {
        let is_flat = |geometry| matches!(geometry, NeighborhoodGeometry::Plane(_));
        if is_flat(self.geometry1) || is_flat(self.geometry2) {
            return false;
        }
        if self.is_steep() {
            return false;
        }
        let normal = self.normal(&pose12.point(&self.local2), self.geometry2.moved(pose12), pose12);
        (normal - self.normal1).norm() <= least_angle()
    }

    /// Returns whether a line is too far from perpendicular to the manifold's normal to give that
    /// normal. The limit for the second line is larger, as it may be nearly parallel to the first.
    fn is_steep(&self) -> bool {
        let is_tilted = |geometry: NeighborhoodGeometry<N, D>, normal: &Vector<N, D>, least: N| {
            match geometry {
                NeighborhoodGeometry::Line(along) => along.dot(normal).abs() > least,
                _ => false,
            }
        };
        let least = N::TWO * least_angle();
        let nearly_parallel = N::lit(MIN_SINE_SQUARED).sqrt();
        is_tilted(self.geometry1, &self.normal1, least)
            || is_tilted(self.geometry2, &self.normal2, least + N::TWO * nearly_parallel)
    }

    fn normal(
        &self,
        point2: &Point<N, D>,
        geometry2: NeighborhoodGeometry<N, D>,
        pose12: &Pose<N, D>,
    ) -> Vector<N, D> {
        match self.rule {
            NormalRule::First => self.normal1,
            NormalRule::Second => pose12.vector(&self.normal2),
            NormalRule::Edges(edge1, edge2) => {
                let edge2 = NeighborhoodGeometry::Line(pose12.vector(&edge2));
                let lines = SlideLines::along(NeighborhoodGeometry::Line(edge1), edge2);
                lines.upright(&self.normal1)
            }
            NormalRule::Geometry => {
                let lines = SlideLines::along(self.geometry1, geometry2);
                lines.connection(&self.local1, point2, &self.normal1)
            }
        }
    }
}

/// Returns the difference up to which unit vectors are treated as equal. The margin is for normals
/// from a query, which accumulates more rounding than one operation.
fn least_angle<N: Real>() -> N {
    N::lit(256.0) * N::EPSILON
}

/// The data that the kinematics of all points of one manifold share.
pub(super) struct KinematicSides<'a, N: Real, const D: usize> {
    pose12: &'a Pose<N, D>,
    /// The manifold's normal in the frames of the first and the second solid.
    normal1: Vector<N, D>,
    normal2: Vector<N, D>,
    side1: KinematicSide<N, D>,
    side2: KinematicSide<N, D>,
    turns: [bool; 2],
    /// The rule of points whose own geometry does not give the normal; computed on first use.
    rule: Option<NormalRule<N, D>>,
}

impl<'a, N: Real, const D: usize> KinematicSides<'a, N, D> {
    /// Returns the shared data of a manifold; `normal` is in the frame of the first solid.
    pub(super) fn new(pair: &'a Pair<'_, N, D>, normal: &Vector<N, D>) -> Self {
        let normal2 = pair.pose12.inverse_vector(normal);
        Self {
            pose12: &pair.pose12,
            normal1: *normal,
            normal2,
            side1: KinematicSide::new(pair.first, *normal),
            side2: KinematicSide::new(pair.second, -normal2),
            turns: [pair.first, pair.second].mapped(|kind| Geometry(kind).turns()),
            rule: None,
        }
    }

    /// Returns the kinematic of a point of the manifold.
    pub(super) fn kinematic(&mut self, point: &RawPoint<N, D>) -> ContactKinematic<N, D> {
        let point2 = self.pose12.inverse_point(&(point.point1 + self.normal1 * point.distance));
        let mut kinematic = ContactKinematic {
            feature1: point.feature1,
            feature2: point.feature2,
            local1: self.side1.core(&point.point1),
            local2: self.side2.core(&point2),
            geometry1: self.side1.geometry(point.feature1),
            geometry2: self.side2.geometry(point.feature2),
            rounding1: self.side1.rounding,
            rounding2: self.side2.rounding,
            normal1: self.normal1,
            normal2: self.normal2,
            rule: NormalRule::Geometry,
            turns: self.turns,
        };
        if !kinematic.reproduces(self.pose12) {
            kinematic.rule = self.rule();
        }
        kinematic
    }

    /// Returns the rule for contacts whose own geometry does not give the manifold's normal: the
    /// face perpendicular to the normal, else the edges perpendicular to it, else the face with the
    /// smaller tilt. Caches the result.
    fn rule(&mut self) -> NormalRule<N, D> {
        let (side1, side2) = (&self.side1, &self.side2);
        *self.rule.get_or_insert_with(|| {
            let (tilt1, tilt2) = (side1.tilt(), side2.tilt());
            let has_face = min(tilt1, tilt2) <= least_angle();
            let edges =
                if has_face { None } else { perpendicular_edges(side1, side2, self.pose12) };
            match edges {
                Some((edge1, edge2)) => NormalRule::Edges(edge1, edge2),
                None if tilt2 < tilt1 => NormalRule::Second,
                None => NormalRule::First,
            }
        })
    }
}

/// Returns an edge of each solid, in its own frame, whose crossing defines the manifold's normal;
/// `None` if a solid has no edge perpendicular to it, or the two edges are nearly parallel.
fn perpendicular_edges<N: Real, const D: usize>(
    side1: &KinematicSide<N, D>,
    side2: &KinematicSide<N, D>,
    pose12: &Pose<N, D>,
) -> Option<(Vector<N, D>, Vector<N, D>)> {
    let (edge1, edge2) = (side1.perpendicular_edge()?, side2.perpendicular_edge()?);
    let across = edge1.dot(&pose12.vector(&edge2));
    (across * across < N::ONE - N::lit(MIN_SINE_SQUARED)).then_some((edge1, edge2))
}

impl<N: Real, const D: usize> NeighborhoodGeometry<N, D> {
    /// Returns the geometry in the frame that `pose` maps to.
    fn moved(self, pose: &Pose<N, D>) -> Self {
        match self {
            Self::Point => Self::Point,
            Self::Line(along) => Self::Line(pose.vector(&along)),
            Self::Plane(normal) => Self::Plane(pose.vector(&normal)),
        }
    }
}

/// Orthonormal directions along which a contact may slide: none, one or two.
struct SlideLines<N: Real, const D: usize> {
    first: Vector<N, D>,
    second: Vector<N, D>,
    are_two: bool,
}

impl<N: Real, const D: usize> SlideLines<N, D> {
    fn along(geometry1: NeighborhoodGeometry<N, D>, geometry2: NeighborhoodGeometry<N, D>) -> Self {
        let direction = |geometry| match geometry {
            NeighborhoodGeometry::Line(along) => along,
            _ => Vector::<N, D>::zeros(),
        };
        let (mut first, mut second) = (direction(geometry1), direction(geometry2));
        if first == Vector::<N, D>::zeros() {
            core::mem::swap(&mut first, &mut second);
        }
        let across = second - first * first.dot(&second);
        let least = N::lit(MIN_SINE_SQUARED).sqrt();
        let across = unit(&across).filter(|&(_, sine)| sine > least).map(|(across, _)| across);
        Self {
            first,
            second: across.unwrap_or_else(Vector::<N, D>::zeros),
            are_two: across.is_some(),
        }
    }

    /// Returns the component of a vector perpendicular to the lines.
    fn reject(&self, v: &Vector<N, D>) -> Vector<N, D> {
        let once = v - self.first * self.first.dot(v);
        once - self.second * self.second.dot(&once)
    }

    /// Returns the unit vector `fallback` projected perpendicular to the lines and normalised; the
    /// vector itself if the projection vanishes.
    fn upright(&self, fallback: &Vector<N, D>) -> Vector<N, D> {
        unit(&self.reject(fallback)).map_or(*fallback, |(upright, _)| upright)
    }

    /// Returns the unit vector of the shortest connection of two points that may slide along the
    /// lines, on the side of `fallback`. Returns `fallback`, projected perpendicular to the lines,
    /// if the connection vanishes or two lines determine the normal.
    fn connection(
        &self,
        point1: &Point<N, D>,
        point2: &Point<N, D>,
        fallback: &Vector<N, D>,
    ) -> Vector<N, D> {
        if self.are_two {
            return self.upright(fallback);
        }
        let Some((along, length)) = unit(&self.reject(&(point2 - point1))) else {
            return self.upright(fallback);
        };
        let size = point1.coords.norm() + point2.coords.norm();
        if length <= N::lit(16.0) * N::EPSILON * size {
            return self.upright(fallback);
        }
        if along.dot(fallback) < N::ZERO { -along } else { along }
    }
}

/// The crossing of two lines is computed if the squared sine of their angle exceeds this.
const MIN_SINE_SQUARED: f64 = 1e-6;

/// Returns the points of the two cores that face each other along the normal.
///
/// A point or a line is fixed to its solid; the point on a plane follows the point or the line of
/// the other solid. For two planes the point on the first plane is fixed.
fn feet<N: Real, const D: usize>(
    [point1, point2]: [&Point<N, D>; 2],
    geometries: [NeighborhoodGeometry<N, D>; 2],
    normal: &Vector<N, D>,
) -> Feet<N, D> {
    use NeighborhoodGeometry::{Line, Plane, Point};
    let gap = point2 - point1;
    let flat = |v: &Vector<N, D>| v - normal * normal.dot(v);
    match geometries {
        [_, Plane(face)] => (*point1, point1 + normal * (gap.dot(&face) / normal.dot(&face))),
        [Plane(face), _] => (point2 - normal * (gap.dot(&face) / normal.dot(&face)), *point2),
        [Point, Point] => (*point1, *point2),
        [Point, Line(along)] => (*point1, point2 - along * ratio(&flat(&gap), &flat(&along))),
        [Line(along), Point] => (point1 + along * ratio(&flat(&gap), &flat(&along)), *point2),
        [Line(along1), Line(along2)] => {
            let (a, b) = crossing(&flat(&gap), &flat(&along1), &flat(&along2));
            (point1 + along1 * a, point2 + along2 * b)
        }
    }
}

/// Returns the coordinate of a vector along `side`, in units of `side`; 0 if `side` is zero.
fn ratio<N: Real, const D: usize>(v: &Vector<N, D>, side: &Vector<N, D>) -> N {
    let squared = side.norm_squared();
    if squared > N::ZERO { v.dot(side) / squared } else { N::ZERO }
}

/// Returns the parameters of the nearest points of two lines whose starting points are `gap` apart;
/// zeros if the lines are nearly parallel.
fn crossing<N: Real, const D: usize>(
    gap: &Vector<N, D>,
    along1: &Vector<N, D>,
    along2: &Vector<N, D>,
) -> (N, N) {
    let (squared1, squared2) = (along1.norm_squared(), along2.norm_squared());
    let mixed = along1.dot(along2);
    let determinant = squared1 * squared2 - mixed * mixed;
    if determinant > N::lit(MIN_SINE_SQUARED) * squared1 * squared2 {
        let (gap1, gap2) = (gap.dot(along1), gap.dot(along2));
        let a = (gap1 * squared2 - gap2 * mixed) / determinant;
        let b = (gap1 * mixed - gap2 * squared1) / determinant;
        return (a, b);
    }
    (N::ZERO, N::ZERO)
}
