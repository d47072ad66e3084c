//! Support maps: the interface between convex solids and the algorithms.

use crate::math::{Matrix, Point, Real, Vector, max, unit};
use crate::shape::solids::segment::length_of;
use crate::shape::{Feature, FeatureId};

/// The support point on a curved feature, and its derivative with respect to the direction.
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
    /// The point of the curved feature farthest along the direction.
    pub point: Point<N, D>,
    /// The derivative of the point with respect to a unit direction: a symmetric matrix that maps
    /// the direction itself to zero. For a ball it is the radius times the projection onto the
    /// plane perpendicular to the direction.
    pub bend: Matrix<N, D>,
}

/// A convex solid: a core, given by its support points, inflated by a rounding radius.
///
/// All coordinates are in the local frame. With a rounding radius of zero (the default) the core is
/// the solid itself.
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
    /// Returns a point of the core farthest along `direction`.
    ///
    /// `direction` is finite and may have any length; for the zero vector any point of the core may
    /// be returned. The result must not depend on the length of `direction`.
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D>;

    /// Returns the radius by which the core is inflated; zero or more.
    fn rounding(&self) -> N {
        N::ZERO
    }

    /// Returns the point farthest along the unit vector `direction` on the curved feature of the
    /// core that contains `point`, with its derivative. `None` if `point` is a corner, or if the
    /// derivative does not exist for `direction`, such as along the axis of a disk.
    ///
    /// `point` is a result of [`Self::core_support`] for a nearby direction, up to rounding. A core
    /// may have several curved features, such as the two rims of a cylinder. The feature that
    /// contains `point` need not be the farthest along `direction`.
    ///
    /// The default is `None`, which is right for cores that are hulls of finitely many points. For
    /// curved cores without this method, contact normals have a relative error of about the square
    /// root of epsilon.
    fn curved_support(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
    ) -> Option<CurvedSupport<N, D>> {
        let _ = (point, direction);
        None
    }

    /// Returns the outward unit normal of a flat round face on the side of `direction`, such as the
    /// cap of a cylinder; `None` if there is none on that side.
    ///
    /// Near such a face support points carry little information: small changes of the direction
    /// move them around its rim. The default is `None`.
    fn round_face(&self, direction: &Vector<N, D>) -> Option<Vector<N, D>> {
        let _ = direction;
        None
    }

    /// Returns the unit axis of the round side of the core, and the component along the axis of the
    /// side's unit normals: zero for a cylinder. `None` if there is no round side.
    ///
    /// If another solid has the same axis, all normals of the round side are nearly optimal, and a
    /// local search has no gradient. The default is `None`.
    fn round_side(&self) -> Option<(Vector<N, D>, N)> {
        None
    }

    /// Returns a point well inside the core; the default is the origin.
    fn center(&self) -> Point<N, D> {
        Point::origin()
    }

    /// Returns an upper bound of the distance of the core's points from the local origin. The bound
    /// must not be much larger than the maximum, as tolerances are proportional to it.
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

    /// Returns a point of the whole solid, including its rounding radius, farthest along
    /// `direction`.
    fn support_point(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let core = self.core_support(direction);
        match unit(direction) {
            Some((along, _)) => core + along * self.rounding(),
            None => core,
        }
    }

    /// Writes the supporting feature of the core for the unit vector `direction`; contact manifolds
    /// are computed from it. The feature is a polygon, a segment or a point, and should contain
    /// every point of the core on the supporting plane perpendicular to `direction`.
    ///
    /// The rule for flat faces: among the edges at the support vertex, take the edge with the
    /// smallest tilt out of the supporting plane. Of the two faces beside that edge, take the face
    /// whose normal is most aligned with `direction`. Return the face if its tilt is at most
    /// atan(1/2) ≈ 26.6°, else the edge if the edge's tilt is within that limit, else the vertex.
    /// In 2D the sides at the vertex are the faces. So the two crossing edges of an edge-edge
    /// contact are found as edges or as sides of the returned faces. The rule depends on angles
    /// only and treats mirrored directions alike. Near its limits both alternatives contain the
    /// touching part. No regular polyhedron, and no regular prism that stands on an edge, has a
    /// feature at a limit.
    ///
    /// A flat round cap is returned as an inscribed polygon with a vertex towards `direction`, a
    /// round side as its generating segment. The default returns the support point alone with the
    /// id `Face(0)`, which suits surfaces that are curved everywhere.
    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        out.set_point(FeatureId::Face(0), self.core_support(direction));
    }
}

/// A convex solid whose core has flat faces: the geometry of its features.
///
/// All coordinates are in the local frame and describe the core: the faces of a rounded solid lie
/// `rounding` inside its surface. A method panics if the solid does not have the feature; the
/// message contains its id.
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
    /// Returns the position of a vertex.
    ///
    /// # Panics
    /// If `id` is not a vertex of the solid.
    fn vertex(&self, id: FeatureId) -> Point<N, D>;

    /// Returns the two ends of an edge (in 2D: of a side) and their ids.
    ///
    /// # Panics
    /// If `id` is not an edge of the solid (in 2D: a face).
    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, D>); 2];

    /// Writes a face as a polygon (in 2D: as a segment with a normal) to `out`.
    ///
    /// # Panics
    /// If `id` is not a face of the solid.
    fn face(&self, id: FeatureId, out: &mut Feature<N, D>);

    /// Returns a unit vector that points out of the solid at the feature: the normal of a face, or
    /// for a vertex or an edge the normalised sum of the normals of the faces around it.
    ///
    /// # Panics
    /// If `id` is not a feature of the solid.
    fn feature_normal(&self, id: FeatureId) -> Vector<N, D>;

    /// Writes the face whose normal is most aligned with the unit vector `direction` to `out`.
    fn support_face_toward(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>);

    /// Writes the largest feature that can touch the supporting plane in `direction` if the solid
    /// rotates by up to `angle` radians: a face, else an edge, else a vertex.
    ///
    /// Applies the rule of [`SupportMap::core_feature`] with the limit `angle` instead of
    /// atan(1/2). `angle` is clamped to the range from the smallest angle that rounded arithmetic
    /// resolves to a little below a right angle.
    fn support_feature_toward(&self, direction: &Vector<N, D>, angle: N, out: &mut Feature<N, D>);

    /// Returns the id of the feature that [`Self::support_feature_toward`] writes for an angle of
    /// zero, which is clamped to the smallest angle that rounded arithmetic resolves.
    fn support_feature_id_toward(&self, direction: &Vector<N, D>) -> FeatureId;
}
