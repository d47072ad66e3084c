//! The supporting feature of a 2D solid in a direction: a side or a vertex.

use crate::math::{Point, Real, Vector};
use crate::shape::{Feature, FeatureId, Geometry, Kind, Segment, SupportMap};

/// The result of [`SupportMap::core_feature`] in 2D, without heap allocation or storage for a
/// polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SideOrVertex<N: Real> {
    pub(crate) id: FeatureId,
    /// The two ends of a side; the same point twice for a vertex.
    pub(crate) ends: [(FeatureId, Point<N, 2>); 2],
    pub(crate) is_side: bool,
}

impl<N: Real> SideOrVertex<N> {
    #[inline]
    pub(super) fn vertex(id: FeatureId, point: Point<N, 2>) -> Self {
        Self { id, ends: [(id, point); 2], is_side: false }
    }

    #[inline]
    pub(super) fn side(id: FeatureId, ends: [(FeatureId, Point<N, 2>); 2]) -> Self {
        Self { id, ends, is_side: true }
    }

    /// Returns the supporting feature for the unit vector `direction`. `None` for half-spaces and
    /// composites, and for support maps whose feature has more than two vertices.
    pub(crate) fn of(kind: Kind<'_, N, 2>, direction: &Vector<N, 2>) -> Option<Self> {
        let own = match kind {
            Kind::Segment(segment) => Some(Self::of_segment(segment)),
            Kind::Capsule(capsule) => Some(Self::of_segment(capsule.segment())),
            Kind::Cuboid(cuboid) => cuboid.supporting(direction),
            Kind::Polytope(polygon) => Some(polygon.supporting(direction)),
            Kind::Triangle(triangle) => triangle.supporting(direction),
            Kind::Rounded(solid) => Self::of(solid.inner().0, direction),
            _ => None,
        };
        own.or_else(|| Self::of_map(Geometry(kind).as_support_map()?, direction))
    }

    /// Returns the segment itself, which is its supporting feature for every direction.
    #[inline]
    pub(crate) fn of_segment(segment: &Segment<N, 2>) -> Self {
        let ends = [(FeatureId::Vertex(0), *segment.a()), (FeatureId::Vertex(1), *segment.b())];
        Self::side(FeatureId::Edge(0), ends)
    }

    /// Returns the supporting feature of a support map; `None` if the feature has more than two
    /// vertices.
    fn of_map(map: &dyn SupportMap<N, 2>, direction: &Vector<N, 2>) -> Option<Self> {
        let mut feature = Feature::default();
        map.core_feature(direction, &mut feature);
        match (feature.vertices.as_slice(), feature.vertex_ids.as_slice()) {
            ([point], [id]) => {
                Some(Self { id: feature.id, ends: [(*id, *point); 2], is_side: false })
            }
            ([a, b], [id1, id2]) => Some(Self::side(feature.id, [(*id1, *a), (*id2, *b)])),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Capsule, ConvexPolygon, Cuboid, Rounded, Shape, Triangle};
    use super::*;

    #[test]
    fn the_result_is_the_core_feature() {
        let p = |x: f64, y: f64| Point::<f64, 2>::new(x, y);
        let corners = [p(0.0, -1.0), p(1.5, 0.0), p(1.0, 1.0), p(-0.5, 0.75)];
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 0.5));
        let solids: [Box<dyn Shape<f64, 2>>; 10] = [
            Box::new(Segment::new(corners[0], corners[1])),
            Box::new(Capsule::<f64, 2>::new(1.0, 0.5)),
            Box::new(Triangle::new(corners[0], corners[1], corners[2])),
            Box::new(Triangle::new(corners[0], corners[2], corners[1])),
            Box::new(Triangle::new(p(0.0, 0.0), p(1.0, 0.5), p(2.0, 1.0))),
            Box::new(Rounded::new(cuboid, 0.25)),
            Box::new(Rounded::new(Capsule::<f64, 2>::new(1.0, 0.5), 0.25)),
            Box::new(cuboid),
            Box::new(Cuboid::new(Vector::<f64, 2>::new(0.0, 0.5))),
            Box::new(ConvexPolygon::new(&corners)),
        ];
        let (mut sides, mut vertices) = (0, 0);
        for solid in &solids {
            for step in 0..64_u32 {
                let (sine, cosine) = Real::sine_cosine(f64::from(step) * 0.1);
                let direction = Vector::<f64, 2>::new(cosine, sine);
                let kind = solid.geometry().0;
                let found = SideOrVertex::of(kind, &direction).expect("a solid of the plane");
                let map = Geometry(kind).as_support_map().expect("convex");
                let expected = SideOrVertex::of_map(map, &direction).expect("a side or a vertex");
                assert_eq!(found, expected, "{solid:?} along {direction}");
                sides += usize::from(found.is_side);
                vertices += usize::from(!found.is_side);
            }
        }
        assert!(sides > 100 && vertices > 20, "{sides} sides and {vertices} vertices");
    }
}
