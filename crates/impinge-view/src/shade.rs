//! Colours of surfaces under soft light, and of edges.

use impinge::dim3::math::Vector;

/// The direction to the light in the camera's frame: from the upper left, in front. Its length is 1
/// to within 1e-3.
const LIGHT: [f64; 3] = [-0.465, 0.675, 0.573];
/// The factors of red, green and blue on a surface that faces away from the light; slightly blue.
const SHADE: [f64; 3] = [0.48, 0.52, 0.60];
/// The factors of red, green and blue on a surface that faces the light; slightly warm.
const LIT: [f64; 3] = [1.10, 1.08, 1.05];
/// The colour with which the colour of a face is mixed for its edges.
const INK: [u8; 3] = [26, 32, 44];

/// Returns a colour as it appears on a surface with this unit normal in the camera's frame. A zero
/// normal counts as halfway between light and shade.
pub(crate) fn shaded(rgb: [u8; 3], normal: &Vector<f64>) -> [u8; 3] {
    let [x, y, z] = LIGHT;
    let light = 0.5 + 0.5 * (normal.x * x + normal.y * y + normal.z * z);
    let channel = |index: usize| {
        let factor = SHADE[index] + (LIT[index] - SHADE[index]) * light;
        byte(f64::from(rgb[index]) * factor)
    };
    [channel(0), channel(1), channel(2)]
}

/// Returns the colour of the edges of a face with this colour.
pub(crate) fn edge_tone(rgb: [u8; 3]) -> [u8; 3] {
    mixed(rgb, INK, 0.55)
}

/// Interpolates linearly between two colours; `part` is 0 at `from` and 1 at `to`.
pub(crate) fn mixed(from: [u8; 3], to: [u8; 3], part: f64) -> [u8; 3] {
    let channel = |index: usize| {
        let (from, to) = (f64::from(from[index]), f64::from(to[index]));
        byte(from + (to - from) * part)
    };
    [channel(0), channel(1), channel(2)]
}

/// Rounds to an integer and clamps it to the range from 0 to 255; 0 for NaN.
#[expect(clippy::cast_possible_truncation, reason = "clamped")]
#[expect(clippy::cast_sign_loss, reason = "clamped")]
fn byte(x: f64) -> u8 {
    (x + 0.5).clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_left_is_lighter_than_the_lower_right() {
        let gray = [128; 3];
        let [x, y, z] = LIGHT;
        let light = Vector::new(x, y, z);
        assert!((light.norm() - 1.0).abs() < 1e-3, "a unit vector");
        assert_eq!(shaded(gray, &light), [141, 138, 134], "128 times LIT");
        assert_eq!(shaded(gray, &-light), [61, 67, 77], "128 times SHADE");
        assert_eq!(shaded([255; 3], &light), [255; 3], "clamped");
    }

    #[test]
    fn tones() {
        assert_eq!(mixed([0, 100, 200], [100, 200, 0], 0.5), [50, 150, 100], "halfway");
        assert!(edge_tone([200; 3]).iter().all(|x| *x < 120), "darker");
    }
}
