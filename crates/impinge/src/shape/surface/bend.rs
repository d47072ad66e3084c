//! The edge between two triangles: which normals it has, computed from those of the faces.
//!
//! The normals of an edge are those between the normals of its two faces on the side where it is a ridge,
//! and none on the side where it is hollow. For triangles that are neither thin nor far away for their
//! size that is plain to see without the directions from the edge into the faces, which the rule of
//! [`seam`](super::seam) goes by; what is close is left to that.

use crate::math::{Mapped, Point, Real, Vector, cross, max, max_component, min};
use crate::shape::surface::seam::{FLAT_SINE, slack};

/// A triangle with a squared height of more than this, of its longest side, is not thin.
const TALL: f64 = 1.0 / 1024.0;
/// A share of what counts as flat that is left to the rule of seams.
const CLOSE: f64 = 0.1;

/// Two triangles that share an edge, and whose fronts are on one side.
#[derive(Clone, Copy, Debug)]
pub(in crate::shape) struct Bend<N: Real> {
    /// The unit normals on the fronts, and the scalar product of the two.
    fronts: [Vector<N, 3>; 2],
    cosine: N,
    shape: BendShape,
}

/// How an edge looks from the front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::shape) enum BendShape {
    Flat,
    Ridge,
    Hollow,
}

impl<N: Real> Bend<N> {
    /// By the corners of two triangles that share an edge, and their normals; `None` where it is not plain
    /// how they lie.
    pub(in crate::shape) fn new(
        corners: [&[Point<N, 3>; 3]; 2],
        fronts: [Vector<N, 3>; 2],
    ) -> Option<Self> {
        Some(Self::of(BendShape::new(corners, &fronts)?, fronts))
    }

    /// Of two triangles of which it is known how they lie.
    pub(in crate::shape) fn of(shape: BendShape, fronts: [Vector<N, 3>; 2]) -> Self {
        Self { fronts, cosine: fronts[0].dot(&fronts[1]), shape }
    }

    pub(in crate::shape) const fn fronts(&self) -> &[Vector<N, 3>; 2] {
        &self.fronts
    }

    pub(in crate::shape) const fn shape(&self) -> BendShape {
        self.shape
    }

    /// Whether a unit vector that is none of the faces' normals is one that the edge has; `None` where it
    /// is close, or not on the same side of both faces.
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
                // Close to the faces' normal and yet not flat it may lean along the edge as well.
                let squared_sine = (N::ONE - along1 * along1) / N::lit(FLAT_SINE * FLAT_SINE);
                let is_level = squared_sine < N::lit(1.0 - CLOSE);
                let is_leaning = squared_sine > N::lit(2.0 * (1.0 + CLOSE));
                (is_level || is_leaning).then_some(false)
            }
            (BendShape::Hollow, true) | (BendShape::Ridge, false) => Some(false),
            (BendShape::Ridge, true) => self.is_between(normal, [along1, along2]),
            (BendShape::Hollow, false) => self
                .is_between(normal, [along1, along2])
                .filter(|is_between| !(is_one_sided && *is_between)),
        }
    }

    /// The vector lies between the two normals, or between their opposites, and across the edge.
    fn is_between(&self, normal: &Vector<N, 3>, [along1, along2]: [N; 2]) -> Option<bool> {
        // The heights over the planes that part the normals from what lies beyond them, times their sine.
        let insides = [along2 - self.cosine * along1, along1 - self.cosine * along2];
        let inside = if along1 < N::ZERO {
            min(-insides[0], -insides[1])
        } else {
            min(insides[0], insides[1])
        };
        let room = N::lit(8.0) * slack::<N>();
        if inside < -room {
            return Some(false);
        }
        let sine = (N::ONE - self.cosine * self.cosine).sqrt();
        let along_edge = cross(&self.fronts[0], &self.fronts[1]).dot(normal).abs() / sine;
        if along_edge > N::lit(FLAT_SINE * (1.0 + CLOSE)) {
            return Some(false);
        }
        (inside > room && along_edge < N::lit(FLAT_SINE * (1.0 - CLOSE))).then_some(true)
    }
}

impl BendShape {
    /// As [`Bend::new`].
    pub(in crate::shape) fn new<N: Real>(
        corners: [&[Point<N, 3>; 3]; 2],
        fronts: &[Vector<N, 3>; 2],
    ) -> Option<Self> {
        let cosine = fronts[0].dot(&fronts[1]);
        // False for NaN, which is not plain.
        let is_plain = cosine > N::ZERO && corners.iter().all(|corners| is_plain(corners));
        if !is_plain {
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

/// The height over the plane of one triangle of that corner of another that is farthest from it: the one
/// that is not on their edge.
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

/// The triangle is not thin, and not so far away that its corners are no more than rounding.
fn is_plain<N: Real>(corners: &[Point<N, 3>; 3]) -> bool {
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
    use crate::math::noise::Noise;
    use crate::shape::composite::tri_mesh::{inward_of, normal_of};
    use crate::shape::surface::seam::{Seam, is_across};

    /// The rule of seams for an edge between two faces.
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
            seam.add_face(|way| inward.dot(way), front);
        }
        is_across(&edge, normal) && seam.admits(is_one_sided)
    }

    fn bends_follow_the_rule<N: Real>() {
        let (mut noise, mut known, mut admitted) = (Noise(1), 0, 0);
        for round in 0..20_000 {
            let (a, b) = (noise.vector::<f64>(1.0), noise.vector::<f64>(1.0));
            let tip1 = noise.vector::<f64>(1.0);
            // Some lie almost flat.
            let flat = [1.0, 0.1, 0.01, 0.003, 0.0][round % 5];
            let tip2 = a + b - tip1 + noise.vector::<f64>(1.0) * flat;
            let point = |v: Vector<f64, 3>| Point::from(v.map(N::lit));
            let (first, second) =
                ([point(a), point(b), point(tip1)], [point(b), point(a), point(tip2)]);
            let fronts = [normal_of(&first), normal_of(&second)];
            let Some(bend) = Bend::new([&first, &second], fronts) else { continue };
            // About between the two, on either side, and along the edge.
            let share = N::lit(0.7 * noise.next() + 0.5);
            let aside = noise.vector::<f64>(1.0).map(N::lit) * N::lit([0.0, 0.004, 0.3][round % 3]);
            let sign = if round % 4 == 0 { -N::ONE } else { N::ONE };
            let normal = (fronts[0] + (fronts[1] - fronts[0]) * share + aside) * sign;
            let normal = normal / normal.norm();
            let is_one_sided = round % 7 == 0;
            // Of the faces' own normals neither is asked.
            if fronts.iter().any(|own| max_component(&(own * sign - normal)) <= slack()) {
                continue;
            }
            if let Some(answer) = bend.admits(&normal, is_one_sided) {
                // The rule sees the edge from its first corner in both.
                let turned = [second[0], second[1], second[2]];
                let expected = rule([&first, &turned], &fronts, &normal, is_one_sided);
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
