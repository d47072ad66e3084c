//! A face of a 3D solid with at most 8 corners, in arrays of fixed size.
//!
//! ```text
//! corners[0]  x0 x1 x2 … 0      one row per coordinate, one lane per corner, zeros beyond `count`
//! corners[1]  y0 y1 y2 … 0
//! corners[2]  z0 z1 z2 … 0
//! ids         v0 v1 v2 …        id of each corner
//! sides       s0 s1 s2 …        id of the side from each corner to the next
//! ```

use crate::math::{Point, Real, Vector};
use crate::shape::solids::cuboid::CuboidPart;
use crate::shape::tilt::Tilt;
use crate::shape::{Cuboid, FeatureId};

/// The maximum number of corners, equal to the number of SIMD lanes.
const MAX: usize = 8;

/// A face with its corners and sides, in the same order as in [`Feature`](super::Feature).
#[derive(Clone, Debug)]
pub(crate) struct FaceRing<N: Real> {
    pub(crate) id: FeatureId,
    /// The number of corners; at least 3 for a filled ring.
    pub(crate) count: usize,
    /// The coordinates of the corners, one row per axis; zero from index `count` on.
    pub(crate) corners: [[N; MAX]; 3],
    pub(crate) ids: [FeatureId; MAX],
    /// The id of the side from each corner to the next.
    pub(crate) sides: [FeatureId; MAX],
    /// The outward unit normal.
    pub(crate) normal: Vector<N, 3>,
}

impl<N: Real> FaceRing<N> {
    /// The maximum number of corners of a ring.
    pub(crate) const MAX: usize = MAX;

    /// Returns a ring without corners.
    #[inline]
    pub(crate) fn blank() -> Self {
        let (id, corners) = (FeatureId::Face(0), [[N::ZERO; MAX]; 3]);
        let (ids, normal) = ([id; MAX], Vector::<N, 3>::zeros());
        Self { id, count: 0, corners, ids, sides: ids, normal }
    }

    /// Appends a corner and the side that leaves it. `count` must be below [`Self::MAX`].
    #[inline]
    pub(crate) fn push(&mut self, corner: &Point<N, 3>, [id, side]: [FeatureId; 2]) {
        let at = self.count;
        for (row, value) in self.corners.iter_mut().zip(corner.iter()) {
            row[at] = *value;
        }
        (self.ids[at], self.sides[at]) = (id, side);
        self.count += 1;
    }
}

impl<N: Real> Cuboid<N, 3> {
    /// Returns the id of the feature that [`core_feature`](super::SupportMap::core_feature) writes
    /// for a box. All half extents of the box must be positive.
    #[inline]
    pub(crate) fn supporting_part(direction: &Vector<N, 3>) -> FeatureId {
        CuboidPart::<3>::toward(direction, Tilt::default_limit()).id()
    }

    /// Fills a blank ring with face `index`. Returns false, with the ring unchanged, if the face
    /// has no area.
    pub(crate) fn fill_ring(&self, index: u32, face: &mut FaceRing<N>) -> bool {
        let (axis, is_negative) = ((index / 2) as usize, index % 2 == 1);
        if (0..3).any(|other| other != axis && self.half_extents()[other] == N::ZERO) {
            return false;
        }
        let (ring, sides) = &CuboidPart::<3>::FACES[index as usize];
        face.id = FeatureId::Face(index);
        face.normal[axis] = if is_negative { -N::ONE } else { N::ONE };
        for (&corner, &side) in ring.corners.iter().zip(sides) {
            face.push(&self.corner(corner), [FeatureId::Vertex(corner), side]);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ConvexHull, Feature, Kind, Shape, SupportMap, Triangle};
    use super::*;

    fn corner_of(ring: &FaceRing<f64>, at: usize) -> Point<f64, 3> {
        let [x, y, z] = &ring.corners;
        Point::<f64, 3>::new(x[at], y[at], z[at])
    }

    /// Returns the ring of the supporting feature `part` if `part` is a face and `fill` succeeds,
    /// else `None`.
    fn ring_of(
        part: FeatureId,
        fill: impl FnOnce(u32, &mut FaceRing<f64>) -> bool,
    ) -> Option<FaceRing<f64>> {
        let FeatureId::Face(face) = part else { return None };
        let mut ring = FaceRing::blank();
        fill(face, &mut ring).then_some(ring)
    }

    /// Checks that the ring and the feature describe the same face. Returns false if there is no
    /// face.
    fn same(ring: Option<FaceRing<f64>>, feature: &Feature<f64, 3>, what: &str) -> bool {
        let is_face = feature.normal.is_some() && feature.vertices.len() > 2;
        assert_eq!(ring.is_some(), is_face, "{what}: {feature:?}");
        let Some(ring) = ring else { return false };
        let corners: Vec<_> = (0..ring.count).map(|at| corner_of(&ring, at)).collect();
        assert_eq!(corners, feature.vertices.to_vec(), "{what}");
        assert_eq!(ring.ids[..ring.count], feature.vertex_ids[..], "{what}");
        assert_eq!(ring.sides[..ring.count], feature.side_ids[..], "{what}");
        assert_eq!((ring.id, Some(ring.normal)), (feature.id, feature.normal), "{what}");
        true
    }

    #[test]
    fn rings_are_the_supporting_faces() {
        let (mut faces, mut parts, mut feature) = (0, [0; 3], Feature::default());
        let solids = [[1.0, 2.0, 3.0], [1.0, 0.0, 3.0], [0.0, 0.0, 1.0]];
        let corner = |at: usize| {
            let sign = |axis: usize| if at >> axis & 1 == 0 { -1.0 } else { 1.0 };
            Point::<f64, 3>::new(sign(0), 2.0 * sign(1), sign(2))
        };
        let corners: Vec<_> = (0..8).map(corner).collect();
        let hull = ConvexHull::from_points(&corners);
        let Kind::Polytope(hull) = hull.geometry().0 else { panic!("a hull is a polytope") };
        for at in 0..1000_usize {
            let direction = |prime: usize| (at * prime % 201) as f64 / 100.0 - 1.0;
            let direction =
                Vector::<f64, 3>::new(direction(7), direction(11), direction(13)).normalize();
            // The power makes every second direction nearly parallel to an axis, and so to a face
            // normal of the boxes.
            let direction =
                if at % 2 == 0 { direction } else { direction.map(|x| x.powi(41)).normalize() };
            for half in solids {
                let cuboid = Cuboid::new(Vector::<f64, 3>::from(half));
                cuboid.core_feature(&direction, &mut feature);
                let part = Cuboid::<f64, 3>::supporting_part(&direction);
                let ring = ring_of(part, |face, ring| cuboid.fill_ring(face, ring));
                faces += usize::from(same(ring, &feature, "a box"));
            }
            hull.core_feature(&direction, &mut feature);
            let part = hull.supporting_part(&direction);
            let ring = ring_of(part, |face, ring| hull.fill_ring(face, ring));
            faces += usize::from(same(ring, &feature, "a hull"));
            let [a, b, c] = [corners[at % 8], corners[at / 8 % 8], corners[at / 64 % 8]];
            let triangle = Triangle::new(a, b, c);
            triangle.core_feature(&direction, &mut feature);
            if let Some(part) = triangle.supporting_part(&direction) {
                assert_eq!(part, feature.id, "{feature:?} supports {direction}");
                if let FeatureId::Face(_) = part {
                    let mut ring = FaceRing::blank();
                    triangle.fill_ring(&direction, &mut ring);
                    let normal = feature.normal.expect("of a face");
                    assert!((ring.normal - normal).norm() < 1e-14, "{ring:?} {feature:?}");
                    ring.normal = normal;
                    faces += usize::from(same(Some(ring), &feature, "a triangle"));
                }
                parts[match part {
                    FeatureId::Vertex(_) => 0,
                    FeatureId::Edge(_) => 1,
                    FeatureId::Face(_) => 2,
                }] += 1;
            }
        }
        assert!(faces > 500, "{faces} faces");
        assert!(parts.iter().all(|&count| count > 50), "parts of triangles: {parts:?}");
    }
}
