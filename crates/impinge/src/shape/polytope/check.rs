//! Consistency checks of polytopes, for tests and debugging.

use crate::math::{Real, cross2};
use crate::shape::Polytope;
#[cfg(feature = "serde")]
use crate::shape::PolytopeFace;

/// The maximum height of a vertex above a face, in units of `N::EPSILON · reach`: the tolerances of
/// the hull plus the rounding error of the plane.
const SLACK: f64 = 48.0;

impl<N: Real, const D: usize> Polytope<N, D> {
    fn slack(&self) -> N {
        N::lit(SLACK) * N::EPSILON * self.reach
    }

    /// Checks that normals are unit, no vertex is above a face, and the vertices of each face are
    /// in its plane.
    fn validate_faces(&self) -> Result<(), &'static str> {
        for face in &self.faces {
            if (face.normal.norm() - N::ONE).abs() > N::lit(4.0) * N::EPSILON {
                return Err("a normal is not unit");
            }
            let height =
                |vertex: u32| self.vertices[vertex as usize].coords.dot(&face.normal) - face.offset;
            if !(0_u32..).take(self.vertices.len()).all(|vertex| height(vertex) <= self.slack()) {
                return Err("a vertex is in front of a face");
            }
            if !self.face_vertices(face).iter().all(|&vertex| height(vertex) >= -self.slack()) {
                return Err("a vertex is not in the plane of its face");
            }
        }
        Ok(())
    }

    /// Checks that the fan of each vertex contains exactly the sides that end at it.
    fn validate_fans(&self) -> Result<(), &'static str> {
        for (index, at) in (0_u32..).zip(0..self.vertices.len()) {
            let fan = self.fan(at);
            if fan.len() < D || !fan.iter().all(|&side| self.side(side).vertices.contains(&index)) {
                return Err("a vertex lacks a side or has a foreign one");
            }
        }
        let ends = if self.edges.is_empty() { self.faces.len() } else { self.edges.len() } * 2;
        if self.fans.len() == ends { Ok(()) } else { Err("a side lacks an end") }
    }
}

/// The maximum height of a vertex above a face that `is_roughly_convex` accepts, as a fraction of
/// `reach`.
#[cfg(feature = "serde")]
const ROUGHLY: f64 = 1e-3;

#[cfg(feature = "serde")]
impl<N: Real, const D: usize> Polytope<N, D> {
    /// Returns whether no vertex is above a face by more than `ROUGHLY` times the reach. A saved
    /// solid that fails this test is damaged.
    pub(in crate::shape) fn is_roughly_convex(&self) -> bool {
        let most = N::lit(ROUGHLY) * self.reach;
        // A NaN height does not fail the test: it comes from an overflow, not from damaged data.
        let is_in_front = |face: &PolytopeFace<N, D>| {
            self.vertices.iter().any(|vertex| face.height_of(vertex) > most)
        };
        !self.faces.iter().any(is_in_front)
    }

    /// Returns whether at least `D` sides end at each vertex.
    pub(in crate::shape) fn has_all_fans(&self) -> bool {
        (0..self.vertices.len()).all(|vertex| self.fan(vertex).len() >= D)
    }
}

impl<N: Real> Polytope<N, 2> {
    /// Checks that the sides close one counter-clockwise, convex loop. Convexity is checked within
    /// 48 · `N::EPSILON` times the largest distance of a vertex from the origin. Quadratic time.
    ///
    /// # Errors
    /// A text with the first violation found.
    pub fn validate(&self) -> Result<(), &'static str> {
        self.validate_faces()?;
        self.validate_fans()?;
        let count = self.vertices.len();
        for (at, face) in self.faces.iter().enumerate() {
            let ring = self.face_vertices(face);
            if [ring[0] as usize, ring[1] as usize] != [at, (at + 1) % count] {
                return Err("a side leads elsewhere than to the next vertex");
            }
            let [a, b, c] = [at, at + 1, at + 2].map(|vertex| self.vertices[vertex % count]);
            // Scaled to about 1, so that areas neither overflow nor underflow.
            let scale = self.reach.power_of_two_below();
            let turn = cross2(&(b / scale - a / scale), &(c / scale - b / scale));
            if turn < -self.slack() / scale {
                return Err("a corner turns right");
            }
        }
        let is_whole = count >= 3 && self.faces.len() == count && self.edges.is_empty();
        if is_whole { Ok(()) } else { Err("the numbers of vertices and sides differ") }
    }
}

impl<N: Real> Polytope<N, 3> {
    /// Checks that the faces close a surface without holes, in which each edge lies between two
    /// faces that traverse it in opposite directions. Convexity is checked within 48 · `N::EPSILON`
    /// times the largest distance of a vertex from the origin. Quadratic time.
    ///
    /// # Errors
    /// A text with the first violation found.
    pub fn validate(&self) -> Result<(), &'static str> {
        self.validate_faces()?;
        self.validate_fans()?;
        if self.loops.len() != 2 * self.edges.len() || self.loop_sides.len() != self.loops.len() {
            return Err("an edge is not between two faces");
        }
        for (index, face) in (0_u32..).zip(&self.faces) {
            let (ring, sides) = (self.face_vertices(face), self.face_sides(face));
            for (at, &side) in sides.iter().enumerate() {
                let (from, to) = (ring[at], ring[(at + 1) % ring.len()]);
                let edge = self.side(side);
                let first = edge.vertices == [from, to] && edge.faces[0] == index;
                let second = edge.vertices == [to, from] && edge.faces[1] == index;
                if !(first || second) {
                    return Err("a face runs along an edge that is not its own");
                }
            }
        }
        let is_sphere = self.vertices.len() + self.faces.len() == self.edges.len() + 2;
        if is_sphere { Ok(()) } else { Err("the surface is not that of one solid") }
    }
}

#[cfg(test)]
mod tests {
    use crate::math::{Point, Vector};
    use crate::shape::Polytope;

    const LOOPS: [[u32; 3]; 4] = [[0, 3, 2], [0, 1, 3], [0, 2, 1], [1, 2, 3]];

    fn tetrahedron(loops: &[[u32; 3]]) -> Option<Polytope<f64, 3>> {
        let axis = Vector::<f64, 3>::ith;
        let slant = Vector::<f64, 3>::repeat(1.0).normalize();
        let normals = [-axis(0, 1.0), -axis(1, 1.0), -axis(2, 1.0), slant];
        Polytope::<f64, 3>::from_closed_faces(corners(), normals.into_iter().zip(loops))
    }

    fn corners() -> Vec<Point<f64, 3>> {
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(Point::from)
            .to_vec()
    }

    #[test]
    fn damage_is_detected() {
        let solid = tetrahedron(&LOOPS).expect("closed");
        assert_eq!(solid.validate(), Ok(()), "a tetrahedron");
        let mut dented = solid.clone();
        dented.vertices[3] = Point::<f64, 3>::new(0.1, 0.1, 0.1);
        assert!(dented.validate().is_err(), "a vertex moved inside");
        let mut long = solid.clone();
        long.faces[1].normal *= 2.0;
        assert_eq!(long.validate(), Err("a normal is not unit"), "a long normal");
        let mut crossed = solid.clone();
        crossed.edges[0].faces.swap(0, 1);
        assert_eq!(
            crossed.validate(),
            Err("a face runs along an edge that is not its own"),
            "an edge with its faces swapped"
        );
        let mut polygon = Polytope::<f64, 2>::from_corners(
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point::from).to_vec(),
        );
        assert_eq!(polygon.validate(), Ok(()), "a triangle");
        polygon.vertices.swap(0, 1);
        assert!(polygon.validate().is_err(), "reversed");
    }

    #[test]
    fn open_surfaces_are_refused() {
        let mut reversed = LOOPS;
        reversed[0].reverse();
        assert_eq!(tetrahedron(&reversed), None, "a reversed face");
        assert_eq!(tetrahedron(&LOOPS[..3]), None, "a face is missing");
    }
}
