//! Colours of debug drawing.

/// An sRGB colour with an opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color {
    /// Red, green and blue, each from 0 to 255.
    pub rgb: [u8; 3],
    /// The opacity: 255 is opaque, 0 invisible.
    pub alpha: u8,
}

impl Color {
    /// Returns an opaque colour.
    #[must_use]
    pub const fn rgb(red: u8, green: u8, blue: u8) -> Self {
        Self { rgb: [red, green, blue], alpha: u8::MAX }
    }

    /// Returns the colour with the opacity `alpha`.
    #[must_use]
    pub const fn with_alpha(self, alpha: u8) -> Self {
        Self { alpha, ..self }
    }
}
