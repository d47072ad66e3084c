//! Tetrahedra, in 3D.

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::exact::{area_vector, volume};
use crate::math::{Point, Pose, Real, Vector, unit};
use crate::shape::error::{finite, or_panic};
use crate::shape::scale::Scale;
use crate::shape::solids::tetrahedron_flat::FlatOutline;
use crate::shape::{
    ConvexPolyhedron, Feature, FeatureId, Geometry, Kind, Polytope, ScaleError, Shape, ShapeError,
    ShapeHandle, SupportMap,
};

/// A tetrahedron is flat if its smallest height is at most `FLAT` epsilon times its size.
const FLAT: f64 = 4096.0;

/// The corners of the faces, for a tetrahedron whose first three corners run clockwise seen from
/// the fourth; `FACES[i]` is opposite to corner `i`.
const FACES: [[u32; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The vertices of each edge, by edge index.
pub(in crate::shape) const EDGES: [[u32; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The convex hull of four corners, which may be given in any order and may coincide or lie on a
/// line or in a plane.
///
/// The vertices 0 to 3 are the corners as given. `Face(i)` is opposite to `Vertex(i)`. The edges 0
/// to 5 join the vertices 0 1, 0 2, 0 3, 1 2, 1 3 and 2 3.
///
/// A tetrahedron without volume (a height of at most 4096 epsilon times its size) is still the hull
/// of its corners, and distances to it are as accurate as to one with a volume. Its features are
/// then the whole outline, with the id of one of the faces, and the edges and vertices of the
/// outline. If the corners lie on a line, the only feature is the longest edge; if they coincide,
/// the first vertex.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::shape::{ConvexPolyhedron, FeatureId, Tetrahedron};
///
/// let p = |x: f32, y: f32, z: f32| Point::new(x, y, z);
/// let corner = Tetrahedron::new([p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0), p(0.0, 0.0, 1.0)]);
/// assert_eq!(corner.feature_normal(FeatureId::Face(3)).z, -1.0);
/// assert_eq!(corner.edge(FeatureId::Edge(3)).map(|(vertex, _)| vertex), [1, 2].map(FeatureId::Vertex));
/// ```
#[derive(Clone, PartialEq)]
pub struct Tetrahedron<N: Real> {
    corners: [Point<N, 3>; 4],
    /// The vertices, edges and faces. If the tetrahedron is flat, only the vertices and ids are
    /// valid; the faces overlap.
    polytope: Polytope<N, 3>,
    /// The outline of a flat tetrahedron; `None` for a tetrahedron with a volume.
    flat: Option<FlatOutline<N>>,
}

impl<N: Real> Tetrahedron<N> {
    /// Returns the tetrahedron with four corners.
    ///
    /// # Panics
    /// If a coordinate is not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(corners: [Point<N, 3>; 4]) -> Self {
        or_panic(Self::try_new(corners))
    }

    /// Returns the tetrahedron with four corners.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn try_new(corners: [Point<N, 3>; 4]) -> Result<Self, ShapeError> {
        const NAMES: [&str; 4] = [
            "a coordinate of the first corner",
            "a coordinate of the second corner",
            "a coordinate of the third corner",
            "a coordinate of the fourth corner",
        ];
        for (name, corner) in NAMES.into_iter().zip(&corners) {
            finite(name, &corner.coords)?;
        }
        let extent = TetrahedronExtent::of(&corners);
        let polytope = polytope(corners, extent.is_mirrored);
        let flat = extent.is_flat::<N>().then(|| FlatOutline::of(&corners));
        Ok(Self { corners, polytope, flat })
    }

    /// Returns the corners, in the order given.
    #[inline]
    #[must_use]
    pub const fn corners(&self) -> &[Point<N, 3>; 4] {
        &self.corners
    }

    /// Returns the vertices, edges and faces of the solid; `None` if it has no volume.
    #[must_use]
    pub fn polytope(&self) -> Option<&Polytope<N, 3>> {
        self.flat.is_none().then_some(&self.polytope)
    }
}

/// The size, height and orientation of four points, in doubles scaled to about 1.
struct TetrahedronExtent {
    /// Whether the first three corners run counter-clockwise seen from the fourth.
    is_mirrored: bool,
    /// The largest distance of a corner from the first.
    size: f64,
    /// The smallest distance of a corner from the plane of the other three.
    height: f64,
}

impl TetrahedronExtent {
    fn of<N: Real>(corners: &[Point<N, 3>; 4]) -> Self {
        let [a, b, c, d] = scaled(corners);
        let (e, f, g) = (b - a, c - a, d - a);
        let spanned = e.cross(&f).dot(&g).abs();
        let areas = [e.cross(&f), f.cross(&g), g.cross(&e), (f - e).cross(&(g - e))];
        let area = areas.iter().fold(0.0, |most: f64, area| most.max(area.norm()));
        let size = e.norm().max(f.norm()).max(g.norm());
        let height = if area > 0.0 { spanned / area } else { 0.0 };
        let [a, b, c, d] = doubles(corners);
        Self { is_mirrored: volume(&a, &b, &c, &d) < 0.0, size, height }
    }

    fn is_flat<N: Real>(&self) -> bool {
        let has_volume = self.height > FLAT * N::EPSILON.as_f64() * self.size;
        !has_volume
    }
}

/// Returns the corners as doubles, relative to the first, divided by a power of two near their
/// size.
pub(in crate::shape) fn scaled<N: Real>(corners: &[Point<N, 3>; 4]) -> [Vector<f64, 3>; 4] {
    let corners = corners.map(|corner| corner.coords.map(N::as_f64));
    // Scales twice: first, because the difference of two large corners may overflow; then, because
    // the difference of two close corners is small.
    let unit = power_of_two_below(&corners) * 2.0;
    let from_first = corners.map(|corner| corner / unit - corners[0] / unit);
    let unit = power_of_two_below(&from_first);
    from_first.map(|corner| corner / unit)
}

/// Returns the corners as doubles, divided by a power of two near the largest magnitude of a
/// coordinate, without rounding.
fn doubles<N: Real>(corners: &[Point<N, 3>; 4]) -> [Point<f64, 3>; 4] {
    let corners = corners.map(|corner| corner.coords.map(N::as_f64));
    let unit = power_of_two_below(&corners);
    corners.map(|corner| Point::from(corner / unit))
}

/// Returns a power of two near the largest magnitude of a coordinate; the least normal number if
/// all are zero. This code always uses doubles, even if the crate is built without `f64` shapes.
fn power_of_two_below(corners: &[Vector<f64, 3>; 4]) -> f64 {
    let largest = corners.iter().fold(0.0, |size: f64, corner| size.max(corner.amax()));
    f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000).max(f64::MIN_POSITIVE)
}

/// Returns the polytope of four corners, which may be coplanar. `is_mirrored` is as in
/// [`TetrahedronExtent`].
fn polytope<N: Real>(corners: [Point<N, 3>; 4], is_mirrored: bool) -> Polytope<N, 3> {
    let positions = doubles(&corners);
    let faces = FACES.map(|[a, b, c]| if is_mirrored { [a, c, b] } else { [a, b, c] });
    let faces = faces.into_iter().map(|face| {
        let [a, b, c] = face.map(|corner| &positions[corner as usize]);
        // If the normal were computed from rounded sides, it would have a relative error of epsilon
        // times the ratio of length to height.
        let normal = area_vector(a, b, c).try_normalize(0.0);
        let normal = normal.unwrap_or_else(Vector::<f64, 3>::y).map(N::lit);
        (unit(&normal).map_or(normal, |(normal, _)| normal), face)
    });
    let mut polytope = Polytope::<N, 3>::from_closed_faces(corners.to_vec(), faces)
        .expect("four triangles around four corners close a surface");
    polytope.name_edges(&EDGES);
    polytope
}

impl<N: Real> SupportMap<N, 3> for Tetrahedron<N> {
    fn core_support(&self, direction: &Vector<N, 3>) -> Point<N, 3> {
        self.polytope.core_support(direction)
    }

    fn center(&self) -> Point<N, 3> {
        self.polytope.center()
    }

    fn reach(&self) -> N {
        self.polytope.reach()
    }

    fn core_feature(&self, direction: &Vector<N, 3>, out: &mut Feature<N, 3>) {
        match &self.flat {
            Some(outline) => outline.fill_toward(direction, out),
            None => self.polytope.core_feature(direction, out),
        }
    }
}

/// The faces of a flat tetrahedron are the triangles of its corners: they overlap, and the normal
/// of a face without area is an arbitrary unit vector.
impl<N: Real> ConvexPolyhedron<N, 3> for Tetrahedron<N> {
    fn vertex(&self, id: FeatureId) -> Point<N, 3> {
        self.polytope.vertex(id)
    }

    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, 3>); 2] {
        self.polytope.edge(id)
    }

    fn face(&self, id: FeatureId, out: &mut Feature<N, 3>) {
        self.polytope.face(id, out);
    }

    fn feature_normal(&self, id: FeatureId) -> Vector<N, 3> {
        self.polytope.feature_normal(id)
    }

    fn support_face_toward(&self, direction: &Vector<N, 3>, out: &mut Feature<N, 3>) {
        self.polytope.support_face_toward(direction, out);
    }

    fn support_feature_toward(&self, direction: &Vector<N, 3>, angle: N, out: &mut Feature<N, 3>) {
        self.polytope.support_feature_toward(direction, angle, out);
    }

    fn support_feature_id_toward(&self, direction: &Vector<N, 3>) -> FeatureId {
        self.polytope.support_feature_id_toward(direction)
    }
}

impl<N: Real> Shape<N, 3> for Tetrahedron<N> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        match self.polytope() {
            Some(polytope) => Geometry(Kind::Polytope(polytope)),
            None => Geometry::support_map(self),
        }
    }

    fn local_aabb(&self) -> Aabb<N, 3> {
        self.polytope.aabb_at(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, 3>) -> Aabb<N, 3> {
        self.polytope.aabb_at(pose)
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, 3> {
        self.polytope.bounding_sphere()
    }

    fn scaled(&self, scale: &Vector<N, 3>) -> Result<ShapeHandle<N, 3>, ScaleError> {
        let scale = Scale::try_new(scale)?;
        let corners = self.corners.map(|corner| scale.point(&corner));
        Ok(ShapeHandle::new(Self::try_new(corners)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(points: [[f64; 3]; 4]) -> [Point<f64, 3>; 4] {
        points.map(Point::<f64, 3>::from)
    }

    #[test]
    fn either_orientation_is_outward_with_the_same_ids() {
        let [a, b, c, d] = corners([[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]);
        for given in [[a, b, c, d], [b, a, c, d], [d, c, b, a], [c, d, a, b]] {
            let solid = Tetrahedron::new(given);
            assert!(solid.polytope().is_some_and(|hull| hull.validate() == Ok(())), "{solid:?}");
            for (index, opposite) in (0..).zip(&given) {
                let mut face = Feature::default();
                solid.face(FeatureId::Face(index), &mut face);
                let normal = face.normal.expect("a polygon");
                assert!(!face.vertex_ids.contains(&FeatureId::Vertex(index)), "opposite to it");
                assert!((opposite - face.vertices[0]).dot(&normal) < 0.0, "outward: {face:?}");
            }
            for (index, ends) in (0..).zip(EDGES) {
                let found = solid.edge(FeatureId::Edge(index)).map(|(id, _)| id);
                assert_eq!(found, ends.map(FeatureId::Vertex), "edge {index}");
            }
        }
    }

    #[test]
    fn without_volume_it_is_flat() {
        let up = Vector::<f64, 3>::z();
        let supporting = |points, direction: &Vector<f64, 3>| {
            let (solid, mut feature) = (Tetrahedron::new(corners(points)), Feature::default());
            assert_eq!(solid.polytope(), None, "no volume");
            solid.core_feature(direction, &mut feature);
            feature
        };
        let square = [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
        let top = supporting(square, &up);
        assert_eq!((top.vertices.len(), top.normal), (4, Some(up)), "all of it: {top:?}");
        let side = supporting(square, &Vector::<f64, 3>::x());
        assert_eq!(side.id, FeatureId::Edge(3), "between the vertices 1 and 2: {side:?}");
        let inner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.25, 0.25, 0.0]];
        let below = supporting(inner, &-up);
        assert_eq!((below.vertices.len(), below.id), (3, FeatureId::Face(3)), "{below:?}");
        let line = [[0.0; 3], [1.0; 3], [3.0; 3], [2.0; 3]];
        assert_eq!(supporting(line, &up).id, FeatureId::Edge(1), "from end to end");
        assert_eq!(supporting([[5.0; 3]; 4], &up).id, FeatureId::Vertex(0), "a point");
    }
}
