//! What a convex solid offers to the algorithms.

use crate::math::{Matrix, Point, Real, Vector, max, unit};
use crate::shape::solids::segment::length_of;
use crate::shape::{Feature, FeatureId};

/// Where the support point of a curved part lies, and how it moves.
///
/// ```
/// use impinge::dim2::math::Vector;
/// use impinge::dim2::shape::{Ellipse, SupportMap};
///
/// let disk = Ellipse::new(Vector::new(2.0_f64, 2.0));
/// let (east, near) = (Vector::x(), disk.core_support(&Vector::new(1.0, 0.1)));
/// let support = disk.curved_support(&near, &east).expect("it is curved everywhere");
/// assert_eq!(support.point.x, 2.0);
/// assert_eq!((support.bend.m22, support.bend.m11), (2.0, 0.0), "the radius, across");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedSupport<N: Real, const D: usize> {
    /// The point of the part farthest along the direction.
    pub point: Point<N, D>,
    /// The derivative of the point by the direction, for a unit direction: a symmetric matrix that
    /// takes the direction itself to zero; of a ball, the radius across the direction.
    pub bend: Matrix<N, D>,
}

/// A convex solid: a core, known by its support points, inflated by a rounding radius.
///
/// All in the local frame. Without rounding (the default) the core is the solid itself.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::shape::{Capsule, SupportMap};
///
/// let capsule = Capsule::<f32>::new(2.0, 0.5);
/// assert_eq!(capsule.core_support(&Vector::new(1.0, 1.0, 0.0)).y, 2.0, "of the segment");
/// assert_eq!(capsule.rounding(), 0.5, "by which it is inflated");
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no support points in {D} dimensions with the scalar `{N}`",
    label = "not a `SupportMap<{N}, {D}>`",
    note = "convex shapes have them, in their own dimension and scalar; half-spaces and composites have none",
    note = "a convex shape of your own implements `SupportMap`, whose one required method is `core_support`"
)]
pub trait SupportMap<N: Real, const D: usize>: Send + Sync {
    /// A point of the core farthest along `direction`.
    ///
    /// `direction` is finite, of any length; for the zero vector any point of the core will do. The
    /// answer depends on nothing but `direction`, and not on its length.
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D>;

    /// The radius by which the core is inflated; zero or more.
    fn rounding(&self) -> N {
        N::ZERO
    }

    /// The point farthest along the unit vector `direction` on the curved part of the core that
    /// `point` lies on, and how it moves; `None` if `point` is a corner, or for a direction at which
    /// there is no derivative, such as along the axis of a disk.
    ///
    /// `point` is an answer of [`Self::core_support`] for a direction nearby, up to rounding. A core
    /// may have several curved parts, as a cylinder has two rims, and the part of `point` may be
    /// another than the one that is farthest.
    ///
    /// The default is `None`, which is right for cores that are hulls of points. Curved ones are
    /// found without it too, up to about half the digits in their normals.
    fn curved_support(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
    ) -> Option<CurvedSupport<N, D>> {
        let _ = (point, direction);
        None
    }

    /// The outward unit normal of the flat round face of the core that faces `direction`, such as the
    /// cap of a cylinder; `None` if the side that faces `direction` has none.
    ///
    /// There support points say least: they run around the rim. The default is `None`.
    fn round_face(&self, direction: &Vector<N, D>) -> Option<Vector<N, D>> {
        let _ = direction;
        None
    }

    /// The axis of the round side of the core, a unit vector, and the sine by which the normals of the side
    /// lean along it: zero for a cylinder. `None` if there is no such side.
    ///
    /// In or beside another solid about the same axis a whole ring of these normals is about as good; there
    /// a local search has nothing to go by. The default is `None`.
    fn round_side(&self) -> Option<(Vector<N, D>, N)> {
        None
    }

    /// A point well inside the core.
    fn center(&self) -> Point<N, D> {
        Point::origin()
    }

    /// A length that no point of the core exceeds in distance from the local origin, and that is
    /// not much larger than needed: tolerances are in proportion to it.
    fn reach(&self) -> N {
        let mut corner = Vector::<N, D>::zeros();
        for axis in 0..D {
            let mut direction = Vector::<N, D>::zeros();
            direction[axis] = N::ONE;
            let high = self.core_support(&direction)[axis].abs();
            let low = self.core_support(&-direction)[axis].abs();
            corner[axis] = max(high, low);
        }
        length_of(&corner)
    }

    /// A point of the whole solid farthest along `direction`.
    fn support_point(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let core = self.core_support(direction);
        match unit(direction) {
            Some((along, _)) => core + along * self.rounding(),
            None => core,
        }
    }

    /// The part of the core that faces the unit vector `direction`, for contact manifolds: a polygon,
    /// a segment or a point, which always contains every point of the core that touches the
    /// supporting plane perpendicular to `direction`.
    ///
    /// The rule for flat faces: among the edges at the support vertex take the one that leans least
    /// out of the supporting plane; of the two faces beside it take the one whose normal is most
    /// aligned. Answer with that face if it leans by at most atan(1/2) ≈ 26.6°, else with the edge if
    /// it does, else with the vertex. In 2D the sides at the vertex are the faces. So the two
    /// crossing edges of an edge-edge contact are found as edges or as sides of the faces answered.
    /// The rule knows angles only, treats mirrored directions alike, and near its two limits both
    /// answers contain the touching part. No regular polyhedron, nor a regular prism on an edge,
    /// lies at a limit.
    ///
    /// A flat cap that is round is answered as an inscribed polygon with a vertex towards
    /// `direction`, a round side as its generating segment. The default is the support point alone,
    /// named `Face(0)`: right for surfaces that are curved everywhere.
    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        out.set_point(FeatureId::Face(0), self.core_support(direction));
    }
}

/// A convex solid whose core has flat faces: the geometry of its features.
///
/// All in the local frame, of the core (for a rounded solid the faces lie `rounding` inside its
/// surface). Asking for a feature that the solid does not have panics, and the message names it.
///
/// ```
/// use impinge::dim2::math::{Point, Vector};
/// use impinge::dim2::shape::{ConvexPolyhedron, Cuboid, FeatureId};
///
/// let square = Cuboid::new(Vector::new(1.0_f32, 1.0));
/// let corner = square.support_feature_id_toward(&Vector::new(0.6, 0.8));
/// assert!(matches!(corner, FeatureId::Vertex(_)));
/// assert_eq!(square.vertex(corner), Point::new(1.0, 1.0));
/// ```
pub trait ConvexPolyhedron<N: Real, const D: usize>: SupportMap<N, D> {
    /// The position of a vertex.
    ///
    /// # Panics
    /// If `id` is not a vertex of the solid.
    fn vertex(&self, id: FeatureId) -> Point<N, D>;

    /// The two ends of an edge and their names (in 2D: of a side).
    ///
    /// # Panics
    /// If `id` is not an edge of the solid (in 2D: a face).
    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, D>); 2];

    /// A face, as a polygon (in 2D: as a segment with a normal).
    ///
    /// # Panics
    /// If `id` is not a face of the solid.
    fn face(&self, id: FeatureId, out: &mut Feature<N, D>);

    /// A unit vector that points away from the solid on the feature: the face's normal, or the
    /// normalised sum of the normals of the faces around a vertex or an edge.
    ///
    /// # Panics
    /// If `id` is not a feature of the solid.
    fn feature_normal(&self, id: FeatureId) -> Vector<N, D>;

    /// The face whose normal is most aligned with the unit vector `direction`.
    fn support_face_toward(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>);

    /// The largest feature that touches the supporting plane in `direction`, once the solid may be
    /// turned by up to `angle` radians: a face, else an edge, else a vertex.
    ///
    /// The rule of [`SupportMap::core_feature`] with `angle` in place of its limit; angles are cut
    /// off at the smallest that arithmetic resolves and a little below a right angle.
    fn support_feature_toward(&self, direction: &Vector<N, D>, angle: N, out: &mut Feature<N, D>);

    /// The name of the feature that [`Self::support_feature_toward`] finds for a tiny angle.
    fn support_feature_id_toward(&self, direction: &Vector<N, D>) -> FeatureId;
}
