//! Numbers on the command line: lists such as `1,2.5,-3`, lengths, and sizes of pictures.

use core::fmt;
use core::str::FromStr;

use crate::number::significant;

/// Finite numbers separated by commas: a point, a vector or the sizes of a shape.
///
/// How many numbers an argument needs may depend on the dimension of the scene. The count is
/// checked after the scene is read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Numbers(pub(crate) Vec<f64>);

/// A finite number that is zero or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NonNegative(pub(crate) f64);

/// A width and a height in pixels, from 1 to [`MAX_SIDE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size(pub(crate) [u32; 2]);

/// The maximum width and height of a picture. With four bytes per pixel the largest picture takes
/// 256 MiB.
const MAX_SIDE: u32 = 8192;

/// The reason why an argument cannot be parsed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum NumberError {
    /// The text does not parse as a number.
    NotANumber(String),
    /// The number is NaN or infinite.
    NotFinite(String),
    /// The number is negative.
    Negative(String),
    /// The text is not a width and a height, or one of them is 0 or above [`MAX_SIDE`].
    NotASize(String),
}

impl fmt::Display for NumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber(text) => write!(f, "{text:?} is not a number"),
            Self::NotFinite(text) => write!(f, "{text} is not finite"),
            Self::Negative(text) => write!(f, "{text} is negative"),
            Self::NotASize(text) => {
                write!(
                    f,
                    "{text:?} is not a size such as 800x600, of at most {MAX_SIDE} pixels a side"
                )
            }
        }
    }
}

impl std::error::Error for NumberError {}

/// Parses one finite number.
fn finite(text: &str) -> Result<f64, NumberError> {
    let number = text.trim().parse::<f64>();
    let number = number.map_err(|_| NumberError::NotANumber(text.to_owned()))?;
    if number.is_finite() { Ok(number) } else { Err(NumberError::NotFinite(text.to_owned())) }
}

/// Writes the numbers in the syntax of the argument, rounded to six digits.
impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<_> = self.0.iter().copied().map(significant).collect();
        f.write_str(&words.join(","))
    }
}

impl FromStr for Numbers {
    type Err = NumberError;

    fn from_str(text: &str) -> Result<Self, NumberError> {
        text.split(',').map(finite).collect::<Result<_, _>>().map(Self)
    }
}

impl FromStr for NonNegative {
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
        let side =
            |text: &str| text.parse::<u32>().ok().filter(|side| (1..=MAX_SIDE).contains(side));
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
        assert_eq!(Numbers(vec![1.0, -2.5, 1e300]).to_string(), "1,-2.5,1e300");
        let refused = |text: &str| text.parse::<Numbers>().map_err(|error| error.to_string());
        assert_eq!(refused("1,,2"), Err("\"\" is not a number".into()));
        assert_eq!(refused("1,inf"), Err("inf is not finite".into()));
        assert_eq!(refused("NaN"), Err("NaN is not finite".into()));
    }

    #[test]
    fn lengths_and_sizes() {
        assert_eq!("0.5".parse(), Ok(NonNegative(0.5)));
        assert_eq!("-0.5".parse::<NonNegative>(), Err(NumberError::Negative("-0.5".into())));
        assert_eq!("800x600".parse(), Ok(Size([800, 600])));
        assert_eq!("8192x1".parse(), Ok(Size([8192, 1])));
        for text in ["800", "0x600", "800x", "800x-1", "800x600x1", "1x8193"] {
            assert_eq!(text.parse::<Size>(), Err(NumberError::NotASize(text.into())));
        }
    }
}
