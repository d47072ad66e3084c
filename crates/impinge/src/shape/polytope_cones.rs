//! How far a direction may lean from the normal of a face and certainly still be shown that face.

use super::Polytope;
use super::tilt::FACING_SINE_SQUARED;
use crate::math::{Real, max, min};

/// Of more vertices no cones are kept: each face is held against all of them.
const MOST_VERTICES: usize = 64;

impl<N: Real> Polytope<N, 3> {
    /// For each face the square of a length: a unit vector no farther than that from its normal is shown
    /// the face, whatever rounding does. Negative where there is none; no squares at all of large solids.
    ///
    /// The rule of [`SupportMap::core_feature`](super::SupportMap::core_feature) compares products of
    /// the direction with vectors of the solid. Each of them differs from that of the normal by no
    /// more than the length of the vector times this one.
    pub(super) fn collect_cones(&mut self) {
        let (least, most) = (N::lit(16.0) * N::MIN_POSITIVE, N::ONE / N::MIN_POSITIVE);
        let is_usual = self.reach > least && self.reach < most;
        if self.vertices.len() <= MOST_VERTICES && is_usual {
            self.cones = (0..self.faces.len()).map(|face| self.cone(face)).collect();
        }
    }

    fn cone(&self, face: usize) -> N {
        let (vertices, sides) = (self.room_of_vertices(face), self.room_of_sides(face));
        // Written so that what is no number is no cone.
        if !(vertices > N::ZERO && sides > N::ZERO) {
            return -N::ONE;
        }
        // A little less than the largest angle at which any face is shown.
        let most = N::lit(0.98 * FACING_SINE_SQUARED);
        min(min(vertices, sides * sides), most)
    }

    /// The square of the distance from the normal within which some vertex of the face is the highest of all.
    fn room_of_vertices(&self, face: usize) -> N {
        let (normal, ring) = (self.faces[face].normal, self.face_vertices(&self.faces[face]));
        let (rounding, unit) = (rounding::<N>(), N::ONE / self.reach);
        let mut room = N::INFINITY;
        for (vertex, place) in (0_u32..).zip(&self.vertices) {
            if ring.contains(&vertex) {
                continue;
            }
            // One vertex of the face that is higher is enough.
            let mut most = -N::ONE;
            for &corner in ring {
                let arm = (self.vertices[corner as usize] - place) * unit;
                let height = normal.dot(&arm) - rounding;
                if height > N::ZERO {
                    most = max(height * height / arm.norm_squared(), most);
                }
            }
            room = min(room, most);
        }
        room
    }

    /// The distance from the normal within which the flattest side at any vertex of the face is one of its
    /// own, and the face is nearer to the direction than the one beyond.
    fn room_of_sides(&self, face: usize) -> N {
        let normal = self.faces[face].normal;
        let (mut flattest, mut steepest) = (N::INFINITY, N::ZERO);
        let own = self.face_sides(&self.faces[face]);
        for &vertex in self.face_vertices(&self.faces[face]) {
            for (side, along) in self.fan_along(vertex as usize) {
                let Some(along) = along else { return -N::ONE };
                let slope = along.dot(&normal).abs();
                if own.contains(&side) {
                    steepest = max(slope, steepest);
                } else {
                    flattest = min(slope, flattest);
                }
            }
        }
        let room = (flattest - steepest - rounding()) * N::HALF;
        own.iter().fold(room, |room, &side| {
            let beyond = self.side(side).faces.into_iter().filter(|&other| other as usize != face);
            beyond.fold(room, |room, other| {
                let away = normal - self.faces[other as usize].normal;
                min((away.dot(&normal) - rounding()) / away.norm(), room)
            })
        })
    }
}

/// What a comparison of products of unit vectors has to be clear of.
fn rounding<N: Real>() -> N {
    N::lit(64.0) * N::EPSILON
}

#[cfg(test)]
mod tests {
    use super::super::{ConvexHull, FeatureId, Polytope};
    use crate::math::{Point, Vector};

    /// Directions around the normals of all faces, as far as the cone reaches and a little beyond.
    fn shown_within(hull: &Polytope<f32, 3>) -> usize {
        let mut within = 0;
        for (index, face) in (0_u32..).zip(&hull.faces) {
            let cone = hull.cones[index as usize];
            for at in 0..200_u8 {
                let part = |prime: u32| (u32::from(at) * prime % 101) as f32 / 50.0 - 1.0;
                let share = if at % 3 == 0 { 0.0 } else { f32::from(at) / 190.0 };
                let aside = Vector::<f32, 3>::new(part(7), part(13), part(29)).normalize();
                let way = (face.normal + aside * (cone.max(0.0).sqrt() * share)).normalize();
                if (way - face.normal).norm_squared() <= cone {
                    within += 1;
                    let told = hull.part_shown(&way, Some(index));
                    assert_eq!(told, hull.part_shown(&way, None), "{way:?}");
                    assert_eq!(told, FeatureId::Face(index), "{way:?} at {at}");
                }
            }
        }
        within
    }

    #[test]
    fn directions_within_a_cone_are_shown_the_face() {
        for (count, size) in [(4, 1.0), (8, 1e-6), (12, 1.0), (12, 1e12), (32, 3.0), (60, 1e-20)] {
            let point = |n: u32| {
                let [x, y, z] = [n * 7 % 11, n * 5 % 13, n * 3 % 17].map(|x| x as f32);
                Point::<f32, 3>::from((Vector::<f32, 3>::new(x, y, z).normalize()) * size)
            };
            let points: Vec<_> = (1..=count).map(point).collect();
            let hull = ConvexHull::from_points(&points);
            let within = shown_within(hull.polytope());
            assert!(within > 100, "{count} points of size {size}: {within} directions");
        }
    }

    #[test]
    fn faces_as_good_as_flush_have_no_cones() {
        // A box with a corner pushed in by little: two faces of nearly the same normal.
        let corner = |at: usize| {
            let sign = |axis: usize| if at >> axis & 1 == 0 { -1.0_f32 } else { 1.0 };
            let dent = if at == 7 { 1e-6 } else { 0.0 };
            Point::<f32, 3>::new(sign(0), sign(1), sign(2) - dent)
        };
        let corners: Vec<_> = (0..8).map(corner).collect();
        let hull = ConvexHull::from_points(&corners);
        shown_within(hull.polytope());
        for (face, cone) in hull.polytope().faces.iter().zip(&hull.polytope().cones) {
            let is_doubtful = face.normal.z > 0.9 && hull.polytope().faces.len() > 6;
            assert!(!is_doubtful || *cone < 1e-3, "{face:?}: {cone}");
        }
    }
}
