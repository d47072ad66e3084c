//! What a face of a box shows of itself to a solid that it leans away from.

use crate::math::Real;
use crate::shape::FACING_SINE_SQUARED;

/// The part of the most aligned face of a box that faces a direction, by the rule of
/// [`SupportMap::core_feature`](crate::shape::SupportMap::core_feature): all of it, the side that comes
/// nearest, or the corner. Of each of the face's two axes, in turn after its own, the end that the part is
/// confined to; whether that is on the positive side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shown([Option<bool>; 2]);

impl Shown {
    /// Of the face across the axis `own`, the largest component of a unit vector, whose components on the
    /// next axis and the one after are the `leans`.
    pub(super) fn of<N: Real>(own: usize, leans: [N; 2]) -> Self {
        let (squares, limit) = (leans.map(|lean| lean * lean), N::lit(FACING_SINE_SQUARED));
        if squares[0] + squares[1] <= limit {
            return Self([None; 2]);
        }
        let is_negative = leans.map(|lean| lean < N::ZERO);
        let mut ends = is_negative.map(|is_negative| Some(!is_negative));
        let [one, other] = leans.map(|lean| lean.abs());
        // Of equals the first axis of the box is the weaker one: the last of three comes before it in turn.
        let is_first_weaker = one < other || (one == other && own != 1);
        let weaker = usize::from(!is_first_weaker);
        if squares[weaker] <= limit {
            ends[weaker] = None;
        }
        Self(ends)
    }

    pub(super) fn is_whole(self) -> bool {
        self.0 == [None; 2]
    }

    pub(super) fn is_corner(self) -> bool {
        self.0.iter().all(Option::is_some)
    }

    /// The corner at these ends is part of it.
    pub(super) fn has_corner(self, signs: [bool; 2]) -> bool {
        self.has_place([true; 2], signs)
    }

    /// The side at one end of an axis is part of it.
    pub(super) fn has_side(self, axis: usize, is_positive: bool) -> bool {
        self.0[1 - axis].is_none() && self.0[axis].is_none_or(|end| end == is_positive)
    }

    /// A place that is at an end of some axes, on sides of given signs, is part of it.
    pub(super) fn has_place(self, at_end: [bool; 2], signs: [bool; 2]) -> bool {
        let is_there =
            |axis: usize| self.0[axis].is_none_or(|end| at_end[axis] && end == signs[axis]);
        is_there(0) && is_there(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Real, Vector};
    use crate::shape::{Cuboid, Feature, FeatureId, SupportMap};

    /// The corners that a box shows to a direction are those of the part.
    #[test]
    fn a_face_shows_what_the_box_shows() {
        let cuboid = Cuboid::new(Vector::<f64, 3>::new(1.0, 2.0, 3.0));
        let mut counts = [0; 3];
        for number in 0..27 * 27 {
            let digits = [number % 27, number / 27 % 27];
            let (turn, rise) = (f64::from(digits[0]) * 0.25, f64::from(digits[1]) * 0.125 - 1.5);
            let ((sine, cosine), (up, out)) = (turn.sine_cosine(), rise.sine_cosine());
            let direction = Vector::<f64, 3>::new(cosine * out, sine * out, up);
            let mut feature = Feature::default();
            cuboid.core_feature(&direction, &mut feature);
            let own = direction.iamax();
            let (next, last) = ((own + 1) % 3, (own + 2) % 3);
            let shown = Shown::of(own, [direction[next], direction[last]]);
            let is_shown = |signs: [bool; 2]| {
                let bit = |axis: usize, is: bool| u32::from(is) << axis;
                let is_up = direction[own] >= 0.0;
                let corner = bit(own, is_up) | bit(next, signs[0]) | bit(last, signs[1]);
                feature.vertex_ids.contains(&FeatureId::Vertex(corner))
            };
            for signs in [[true, true], [true, false], [false, true], [false, false]] {
                assert_eq!(shown.has_corner(signs), is_shown(signs), "{direction} {signs:?}");
            }
            counts[usize::from(shown.is_whole()) + 2 * usize::from(shown.is_corner())] += 1;
        }
        assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
    }

    #[test]
    fn of_two_axes_that_lean_alike_the_first_is_shown() {
        let lean = 0.16_f64.sqrt();
        let side = [(0, [None, Some(true)]), (1, [Some(true), None]), (2, [None, Some(true)])];
        for (own, ends) in side {
            assert_eq!(Shown::of(own, [lean, lean]), Shown(ends), "across {own}");
        }
    }
}
