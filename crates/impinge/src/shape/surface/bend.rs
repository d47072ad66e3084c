//! The edge between two triangles: the contact normals that it admits, computed from its face
//! normals.
//!
//! On the front, a convex edge (ridge) admits the normals between the normals of its two faces, and
//! a concave edge (hollow) admits none. On the back, a ridge admits none, and a hollow admits the
//! normals between the back normals of its faces. If the triangles are not thin and not far from
//! the origin for their size, the face normals alone decide this, without the directions from the
//! edge into the faces that the rule of [`seam`](super::seam) needs. Cases near a limit are left to
//! the rule of `seam`.

use crate::math::{Mapped, Point, Real, Vector, cross, max, max_component, min};
use crate::shape::surface::seam::{FLAT_SINE, slack};

/// Minimum squared ratio of height to longest side of a triangle that is not thin: a height of 1/32
/// of that side.
const TALL: f64 = 1.0 / 1024.0;
/// Relative width of the band around each limit of flatness that is left to the rule of `seam`.
const CLOSE: f64 = 0.1;

/// An edge shared by two triangles whose fronts are on the same side of the surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Bend<N: Real> {
    /// The unit normals on the fronts of the two triangles; `cosine` is their scalar product.
    fronts: [Vector<N, 3>; 2],
    cosine: N,
    shape: BendShape,
}

/// The shape of an edge, seen from the front of its faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::shape) enum BendShape {
    /// The sine of the angle between the fronts is below `FLAT_SINE`.
    Flat,
    /// Each face lies behind the plane of the other face.
    Ridge,
    /// Each face lies in front of the plane of the other face.
    Hollow,
}

impl<N: Real> Bend<N> {
    /// Classifies the edge by the corners of its triangles and their unit normals; `None` if these
    /// do not decide.
    pub(in crate::shape) fn new(
        corners: [&[Point<N, 3>; 3]; 2],
        fronts: [Vector<N, 3>; 2],
    ) -> Option<Self> {
        Some(Self::of(BendShape::new(corners, &fronts)?, fronts))
    }

    /// Returns the edge between two faces for which `shape` is already known.
    pub(in crate::shape) fn of(shape: BendShape, fronts: [Vector<N, 3>; 2]) -> Self {
        Self { fronts, cosine: fronts[0].dot(&fronts[1]), shape }
    }

    pub(in crate::shape) const fn fronts(&self) -> &[Vector<N, 3>; 2] {
        &self.fronts
    }

    pub(in crate::shape) const fn shape(&self) -> BendShape {
        self.shape
    }

    /// Returns whether the edge admits the unit vector `normal`, which must differ from both face
    /// normals. `None` close to a limit, for a vector that is not on the same side of both faces,
    /// and for a vector behind a concave edge of a one-sided surface, between the two back normals.
    pub(in crate::shape) fn admits(
        &self,
        normal: &Vector<N, 3>,
        is_one_sided: bool,
    ) -> Option<bool> {
        let [along1, along2] = self.fronts.each_ref().mapped(|front| front.dot(normal));
        let is_front = along1 > N::ZERO && along2 > N::ZERO;
        let is_back = along1 < N::ZERO && along2 < N::ZERO;
        if !(is_front || is_back) {
            return None;
        }
        match (self.shape, is_front) {
            (BendShape::Flat, _) => {
                // Between coplanar faces only the face normal is admitted. If the sine of the tilt
                // exceeds √2 times `FLAT_SINE`, the tilt along the edge or the tilt across it
                // exceeds the limit. In between, the rule of `seam` decides.
                let squared_sine = (N::ONE - along1 * along1) / N::lit(FLAT_SINE * FLAT_SINE);
                let is_face_normal = squared_sine < N::lit(1.0 - CLOSE);
                let is_tilted = squared_sine > N::lit(2.0 * (1.0 + CLOSE));
                (is_face_normal || is_tilted).then_some(false)
            }
            (BendShape::Hollow, true) | (BendShape::Ridge, false) => Some(false),
            (BendShape::Ridge, true) => self.is_between(normal, [along1, along2]),
            (BendShape::Hollow, false) => self
                .is_between(normal, [along1, along2])
                .filter(|is_between| !(is_one_sided && *is_between)),
        }
    }

    /// Returns whether the vector lies between the two front normals, or between their opposites,
    /// and is perpendicular to the edge. `None` close to a limit.
    fn is_between(&self, normal: &Vector<N, 3>, [along1, along2]: [N; 2]) -> Option<bool> {
        // The components of the vector across each front normal and towards the other front normal,
        // times the sine of the angle between the fronts.
        let insides = [along2 - self.cosine * along1, along1 - self.cosine * along2];
        let inside = if along1 < N::ZERO {
            min(-insides[0], -insides[1])
        } else {
            min(insides[0], insides[1])
        };
        let margin = N::lit(8.0) * slack::<N>();
        if inside < -margin {
            return Some(false);
        }
        let sine = (N::ONE - self.cosine * self.cosine).sqrt();
        let along_edge = cross(&self.fronts[0], &self.fronts[1]).dot(normal).abs() / sine;
        if along_edge > N::lit(FLAT_SINE * (1.0 + CLOSE)) {
            return Some(false);
        }
        (inside > margin && along_edge < N::lit(FLAT_SINE * (1.0 - CLOSE))).then_some(true)
    }
}

impl BendShape {
    /// Implements [`Bend::new`].
    pub(in crate::shape) fn new<N: Real>(
        corners: [&[Point<N, 3>; 3]; 2],
        fronts: &[Vector<N, 3>; 2],
    ) -> Option<Self> {
        let cosine = fronts[0].dot(&fronts[1]);
        // The comparison is false for NaN. If the fronts are more than 90° apart, the rule of
        // `seam` decides.
        let is_certain = cosine > N::ZERO && corners.iter().all(|corners| is_well_shaped(corners));
        if !is_certain {
            return None;
        }
        let (squared_sine, flat) = (N::ONE - cosine * cosine, N::lit(FLAT_SINE * FLAT_SINE));
        if squared_sine <= flat * N::lit(1.0 - CLOSE) {
            return Some(Self::Flat);
        }
        let heights = [
            height_of(corners[1], corners[0], &fronts[0]),
            height_of(corners[0], corners[1], &fronts[1]),
        ];
        let is_bent = squared_sine > flat * N::lit(1.0 + CLOSE);
        match heights.mapped(|height| height > N::ZERO) {
            [true, true] if is_bent => Some(Self::Hollow),
            [false, false] if is_bent => Some(Self::Ridge),
            _ => None,
        }
    }
}

/// Returns the signed height, over a plane, of the corner that is farthest from the plane: the
/// corner not on the shared edge. `front` is the unit normal of the plane.
fn height_of<N: Real>(
    corners: &[Point<N, 3>; 3],
    plane: &[Point<N, 3>; 3],
    front: &Vector<N, 3>,
) -> N {
    corners.iter().fold(N::ZERO, |farthest, corner| {
        let height = front.dot(&(corner - plane[0]));
        if height.abs() > farthest.abs() { height } else { farthest }
    })
}

/// Returns whether the triangle is not thin, its sides are longer than 4096 epsilon times its
/// coordinates, and its squared area does not underflow.
fn is_well_shaped<N: Real>(corners: &[Point<N, 3>; 3]) -> bool {
    let [a, b, c] = corners;
    let (ab, ac) = (b - a, c - a);
    let squared = [ab.norm_squared(), ac.norm_squared(), (c - b).norm_squared()];
    let longest = max(squared[0], max(squared[1], squared[2]));
    let shortest = min(squared[0], min(squared[1], squared[2]));
    let farthest = corners.iter().map(|corner| max_component(&corner.coords)).fold(N::ZERO, max);
    let unsure = N::lit(4096.0) * N::EPSILON * farthest;
    let area = cross(&ab, &ac).norm_squared();
    area > N::lit(TALL) * longest * longest
        && shortest > unsure * unsure
        && area > N::MIN_POSITIVE / N::EPSILON
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::xorshift::Xorshift;
    use crate::shape::composite::tri_mesh::{inward_of, normal_of};
    use crate::shape::surface::seam::{Seam, is_across};

    /// Returns whether the rule of `seam` admits a normal at an edge between two faces.
    fn rule<N: Real>(
        corners: [&[Point<N, 3>; 3]; 2],
        fronts: &[Vector<N, 3>; 2],
        normal: &Vector<N, 3>,
        is_one_sided: bool,
    ) -> bool {
        let edge = corners[0][1] - corners[0][0];
        let mut seam = Seam::of_faces(fronts[0], normal).along(&edge);
        for (corners, front) in corners.iter().zip(fronts) {
            let inward = inward_of(corners).expect("an area");
            seam.add_face(|direction| inward.dot(direction), front);
        }
        is_across(&edge, normal) && seam.admits(is_one_sided)
    }

    fn bends_follow_the_rule<N: Real>() {
        let (mut random, mut known, mut admitted) = (Xorshift(1), 0, 0);
        for round in 0..20_000 {
            let (a, b) = (random.vector::<f64>(1.0), random.vector::<f64>(1.0));
            let tip1 = random.vector::<f64>(1.0);
            // In every five edges one is exactly flat and two are nearly flat.
            let flat = [1.0, 0.1, 0.01, 0.003, 0.0][round % 5];
            let tip2 = a + b - tip1 + random.vector::<f64>(1.0) * flat;
            let point = |v: Vector<f64, 3>| Point::from(v.map(N::lit));
            let (first, second) =
                ([point(a), point(b), point(tip1)], [point(b), point(a), point(tip2)]);
            let fronts = [normal_of(&first), normal_of(&second)];
            let Some(bend) = Bend::new([&first, &second], fronts) else { continue };
            // Interpolates or extrapolates the fronts and adds a tilt; a quarter of the normals are
            // on the back.
            let share = N::lit(0.7 * random.next() + 0.5);
            let aside =
                random.vector::<f64>(1.0).map(N::lit) * N::lit([0.0, 0.004, 0.3][round % 3]);
            let sign = if round % 4 == 0 { -N::ONE } else { N::ONE };
            let normal = (fronts[0] + (fronts[1] - fronts[0]) * share + aside) * sign;
            let normal = normal / normal.norm();
            let is_one_sided = round % 7 == 0;
            // `Bend::admits` is not defined for the face normals themselves.
            if fronts.iter().any(|own| max_component(&(own * sign - normal)) <= slack()) {
                continue;
            }
            if let Some(answer) = bend.admits(&normal, is_one_sided) {
                // `rule` takes the first two corners of each triangle as the edge, in either
                // direction.
                let permuted = [second[0], second[1], second[2]];
                let expected = rule([&first, &permuted], &fronts, &normal, is_one_sided);
                assert_eq!(answer, expected, "round {round}: {bend:?} {normal:?}");
                (known, admitted) = (known + 1, admitted + usize::from(answer));
            }
        }
        assert!(known > 5000 && admitted > 500, "{known} known, {admitted} admitted");
    }

    #[test]
    fn bends_follow_the_rule_of_seams() {
        bends_follow_the_rule::<f32>();
        bends_follow_the_rule::<f64>();
    }
}
