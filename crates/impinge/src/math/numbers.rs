//! The numbers of saved data, stored without rounding error in every format.
//!
//! Text formats may round `f64`, and most have neither NaN nor infinities. So in human-readable
//! formats a list of numbers is one string, such as `"0.5 -inf 1e-45"`, which parses to the same
//! bits. A NaN is written as `NaN:` and its bits in hexadecimal. In binary formats the list is a
//! sequence of `f32` or `f64`.

use core::fmt::{self, Write as _};
use core::marker::PhantomData;
use core::slice;
use std::borrow::Cow;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use smallvec::SmallVec;

use super::{Matrix, Point, Pose, Real, Space, Vector};

/// A defect of saved data: a message for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Damage(pub(crate) Cow<'static, str>);

impl Damage {
    /// Creates a defect with the message of another error.
    pub(crate) fn found(error: &impl fmt::Display) -> Self {
        Self(error.to_string().into())
    }
}

/// Returns a [`Damage`] with the message `what` unless the condition holds.
pub(crate) fn ensure(holds: bool, what: &'static str) -> Result<(), Damage> {
    if holds { Ok(()) } else { Err(Damage(what.into())) }
}

/// A list of numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Numbers<N: Real>(SmallVec<[N; 8]>);

impl<N: Real> Numbers<N> {
    /// Creates a list of numbers.
    pub(crate) fn of(numbers: impl IntoIterator<Item = N>) -> Self {
        Self(numbers.into_iter().collect())
    }

    /// Creates a list of the coordinates of points, point by point.
    pub(crate) fn of_points<const D: usize>(points: &[Point<N, D>]) -> Self {
        Self(points.iter().flat_map(|point| point.iter().copied()).collect())
    }

    /// Creates a list of the numbers of an isometry: the translation, followed by the cosine and
    /// sine of the rotation in 2D, or its quaternion (i, j, k, w) in 3D.
    pub(crate) fn of_isometry<const D: usize>(isometry: &N::Isometry) -> Self
    where
        N: Space<D>,
    {
        Self::of(N::numbers(isometry).into_iter().take(isometry_numbers::<D>()))
    }

    /// Appends numbers.
    pub(crate) fn extend<'a>(&mut self, numbers: impl IntoIterator<Item = &'a N>) {
        self.0.extend(numbers.into_iter().copied());
    }

    /// Appends the numbers of a pose: the rotation, column by column, and the translation.
    pub(crate) fn extend_pose<const D: usize>(&mut self, pose: &Pose<N, D>) {
        self.extend(&pose.rotation);
        self.extend(&pose.translation);
    }

    /// Returns the length of the list.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns a reader that starts at the first number.
    pub(crate) fn read(&self) -> NumberSource<'_, N> {
        NumberSource(self.0.iter())
    }

    /// Reads the list with the function `read`; returns a defect if `read` leaves numbers unread.
    pub(crate) fn all<'a, R>(
        &'a self,
        read: impl FnOnce(&mut NumberSource<'a, N>) -> Result<R, Damage>,
    ) -> Result<R, Damage> {
        let mut source = self.read();
        let found = read(&mut source)?;
        ensure(source.0.as_slice().is_empty(), "numbers are left over")?;
        Ok(found)
    }

    /// Returns the numbers as an array; returns a defect unless there are exactly `COUNT` numbers.
    pub(crate) fn array<const COUNT: usize>(&self) -> Result<[N; COUNT], Damage> {
        self.all(NumberSource::array)
    }

    /// Returns the points whose coordinates are the numbers; returns a defect unless the number of
    /// numbers is a multiple of `D`.
    pub(crate) fn points<const D: usize>(&self) -> Result<Vec<Point<N, D>>, Damage> {
        ensure(self.len().is_multiple_of(D), "coordinates are missing")?;
        Ok(self.0.chunks_exact(D).map(|point| Point::from(vector(point))).collect())
    }

    /// Returns the isometry with these numbers, without normalisation, so its rotation need not
    /// have unit length. Returns a defect unless the list has as many numbers as an isometry.
    pub(crate) fn isometry<const D: usize>(&self) -> Result<N::Isometry, Damage>
    where
        N: Space<D>,
    {
        ensure(self.len() == isometry_numbers::<D>(), "a position has another count of numbers")?;
        let mut numbers = [N::ZERO; 7];
        numbers[..self.len()].copy_from_slice(&self.0);
        Ok(N::of_numbers(&numbers))
    }

    /// Converts the list to a vector.
    pub(crate) fn into_vec(self) -> Vec<N> {
        self.0.into_vec()
    }
}

/// Returns how many numbers an isometry has: D for the translation, and 2 (complex number) or 4
/// (quaternion) for the rotation.
const fn isometry_numbers<const D: usize>() -> usize {
    D + (1 << (D - 1))
}

fn vector<N: Real, const D: usize>(numbers: &[N]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| numbers[axis])
}

/// A reader of a list of numbers. Its methods return a defect if there are too few numbers.
pub(crate) struct NumberSource<'a, N>(slice::Iter<'a, N>);

impl<N: Real> NumberSource<'_, N> {
    pub(crate) fn number(&mut self) -> Result<N, Damage> {
        self.0.next().copied().ok_or(Damage("numbers are missing".into()))
    }

    pub(crate) fn array<const COUNT: usize>(&mut self) -> Result<[N; COUNT], Damage> {
        let mut numbers = [N::ZERO; COUNT];
        for number in &mut numbers {
            *number = self.number()?;
        }
        Ok(numbers)
    }

    pub(crate) fn vector<const D: usize>(&mut self) -> Result<Vector<N, D>, Damage> {
        Ok(vector(&self.array::<D>()?))
    }

    pub(crate) fn point<const D: usize>(&mut self) -> Result<Point<N, D>, Damage> {
        self.vector().map(Point::from)
    }

    pub(crate) fn points<const D: usize, const COUNT: usize>(
        &mut self,
    ) -> Result<[Point<N, D>; COUNT], Damage> {
        let mut points = [Point::<N, D>::origin(); COUNT];
        for point in &mut points {
            *point = self.point()?;
        }
        Ok(points)
    }

    pub(crate) fn pose<const D: usize>(&mut self) -> Result<Pose<N, D>, Damage> {
        let mut rotation = Matrix::<N, D>::zeros();
        for number in rotation.iter_mut() {
            *number = self.number()?;
        }
        Ok(Pose { rotation, translation: self.vector()? })
    }
}

impl<N: Real> fmt::Display for Numbers<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, &number) in self.0.iter().enumerate() {
            if at > 0 {
                f.write_char(' ')?;
            }
            match Either::of(number) {
                Either::Single(single) if !single.is_nan() => write!(f, "{single:?}")?,
                Either::Double(double) if !double.is_nan() => write!(f, "{double:?}")?,
                _ => write!(f, "{NAN}{:x}", number.bits())?,
            }
        }
        Ok(())
    }
}

/// The prefix of a NaN in text; its bits follow in hexadecimal.
const NAN: &str = "NaN:";

/// A number in its own scalar type.
enum Either {
    Single(f32),
    Double(f64),
}

impl Either {
    fn of<N: Real>(number: N) -> Self {
        match u32::try_from(number.bits()) {
            Ok(bits) if is_single::<N>() => Self::Single(f32::from_bits(bits)),
            _ => Self::Double(f64::from_bits(number.bits())),
        }
    }
}

const fn is_single<N>() -> bool {
    size_of::<N>() == size_of::<f32>()
}

fn parse<N: Real>(text: &str) -> Option<N> {
    let bits = match text.strip_prefix(NAN) {
        Some(bits) => u64::from_str_radix(bits, 16).ok()?,
        None if is_single::<N>() => text.parse::<f32>().ok()?.to_bits().into(),
        None => text.parse::<f64>().ok()?.to_bits(),
    };
    Some(N::of_bits(bits))
}

impl<N: Real> Serialize for Numbers<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            return serializer.collect_str(self);
        }
        let mut sequence = serializer.serialize_seq(Some(self.len()))?;
        for &number in &self.0 {
            match Either::of(number) {
                Either::Single(number) => sequence.serialize_element(&number)?,
                Either::Double(number) => sequence.serialize_element(&number)?,
            }
        }
        sequence.end()
    }
}

impl<'de, N: Real> Deserialize<'de> for Numbers<N> {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_str(NumbersVisitor(PhantomData))
        } else {
            deserializer.deserialize_seq(NumbersVisitor(PhantomData))
        }
    }
}

struct NumbersVisitor<N>(PhantomData<N>);

impl<'de, N: Real> Visitor<'de> for NumbersVisitor<N> {
    type Value = Numbers<N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("numbers")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Numbers<N>, E> {
        let words = text.split_ascii_whitespace();
        let number = |word| parse(word).ok_or_else(|| E::custom(format!("{word:?} is no number")));
        words.map(number).collect::<Result<_, E>>().map(Numbers)
    }

    /// Allocates memory as numbers are read, since the count that the data declares may be wrong.
    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Numbers<N>, A::Error> {
        let mut numbers = Numbers::default();
        if is_single::<N>() {
            while let Some(number) = sequence.next_element::<f32>()? {
                numbers.0.push(N::of_bits(number.to_bits().into()));
            }
        } else {
            while let Some(number) = sequence.next_element::<f64>()? {
                numbers.0.push(N::of_bits(number.to_bits()));
            }
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn returns<N: Real>(bits: &[u64]) {
        let numbers = Numbers::of(bits.iter().map(|&bits| N::of_bits(bits)));
        let text = serde_json::to_string(&numbers).expect("a string");
        let again: Numbers<N> = serde_json::from_str(&text).expect("just written");
        let same: Vec<u64> = again.into_vec().into_iter().map(Real::bits).collect();
        assert_eq!(same, bits, "{text}");
    }

    #[test]
    fn text_keeps_all_bits() {
        let of = |number: f32| u64::from(number.to_bits());
        let single = [0.0, -0.0, 0.1, 1e-45, -3.402_823_5e38, f32::INFINITY, f32::NEG_INFINITY];
        returns::<f32>(&single.map(of));
        returns::<f32>(&[0x7fc0_0000, 0xffc0_0001, 0x7f80_0001]);
        let double = [0.1, -0.0, 5e-324, 1.797_693_134_862_315_7e308, f64::NEG_INFINITY, 1.0 / 3.0];
        returns::<f64>(&double.map(f64::to_bits));
        returns::<f64>(&[0x7ff8_0000_0000_0000, 0xfff0_0000_0000_0001]);
        returns::<f64>(&[]);
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in ["\"one\"", "\"1,5\"", "\"NaN:xyz\"", "1.5", "[1.5]"] {
            assert!(serde_json::from_str::<Numbers<f64>>(text).is_err(), "{text}");
        }
        let two = Numbers::of([1.0_f32, 2.0]);
        assert!(two.array::<3>().is_err() && two.array::<1>().is_err(), "counts are checked");
        assert!(two.isometry::<2>().is_err() && two.points::<3>().is_err(), "of all kinds");
    }
}
