//! Numbers on the command line: `1,2.5,-3`, positive lengths, sizes of pictures.

use core::fmt;
use core::str::FromStr;

/// Finite numbers between commas: a point, a vector or the sizes of a shape.
///
/// How many there have to be is known when the scene is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Numbers(pub(crate) Vec<f64>);

/// A finite number that is zero or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Positive(pub(crate) f64);

/// A width and a height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size(pub(crate) [u32; 2]);

/// Why a text is not what an argument asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum NumberError {
    /// It is no number.
    NotANumber(String),
    /// It is NaN or infinite.
    NotFinite(String),
    /// It is negative.
    Negative(String),
    /// It is not a width and a height.
    NotASize(String),
}

impl fmt::Display for NumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber(text) => write!(f, "{text:?} is not a number"),
            Self::NotFinite(text) => write!(f, "{text} is not finite"),
            Self::Negative(text) => write!(f, "{text} is negative"),
            Self::NotASize(text) => write!(f, "{text:?} is not a size such as 800x600"),
        }
    }
}

impl std::error::Error for NumberError {}

/// One finite number.
fn finite(text: &str) -> Result<f64, NumberError> {
    let number = text.trim().parse::<f64>();
    let number = number.map_err(|_| NumberError::NotANumber(text.to_owned()))?;
    if number.is_finite() { Ok(number) } else { Err(NumberError::NotFinite(text.to_owned())) }
}

impl FromStr for Numbers {
    type Err = NumberError;

    fn from_str(text: &str) -> Result<Self, NumberError> {
        text.split(',').map(finite).collect::<Result<_, _>>().map(Self)
    }
}

impl FromStr for Positive {
    type Err = NumberError;

    fn from_str(text: &str) -> Result<Self, NumberError> {
        let number = finite(text)?;
        if number < 0.0 { Err(NumberError::Negative(text.to_owned())) } else { Ok(Self(number)) }
    }
}

impl FromStr for Size {
    type Err = NumberError;

    fn from_str(text: &str) -> Result<Self, NumberError> {
        let refused = || NumberError::NotASize(text.to_owned());
        let (width, height) = text.split_once('x').ok_or_else(refused)?;
        let side = |text: &str| text.parse::<u32>().ok().filter(|side| *side > 0);
        let sides = side(width).zip(side(height)).ok_or_else(refused)?;
        Ok(Self([sides.0, sides.1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_by_hand() {
        assert_eq!("1, -2.5,3e2".parse(), Ok(Numbers(vec![1.0, -2.5, 300.0])));
        let refused = |text: &str| text.parse::<Numbers>().map_err(|error| error.to_string());
        assert_eq!(refused("1,,2"), Err("\"\" is not a number".into()));
        assert_eq!(refused("1,inf"), Err("inf is not finite".into()));
        assert_eq!(refused("NaN"), Err("NaN is not finite".into()));
    }

    #[test]
    fn lengths_and_sizes() {
        assert_eq!("0.5".parse(), Ok(Positive(0.5)));
        assert_eq!("-0.5".parse::<Positive>(), Err(NumberError::Negative("-0.5".into())));
        assert_eq!("800x600".parse(), Ok(Size([800, 600])));
        for text in ["800", "0x600", "800x", "800x-1", "800x600x1"] {
            assert_eq!(text.parse::<Size>(), Err(NumberError::NotASize(text.into())));
        }
    }
}
