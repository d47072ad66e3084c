//! Deserializes a value that is either a number or a list of three numbers.

use core::fmt;

use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};

/// A number, or a list of three numbers. Deserialized by hand, since an untagged enum loses the
/// position of an error.
#[derive(Clone, Copy, Debug)]
pub(super) enum OneOrThree {
    One(f64),
    Three([f64; 3]),
}

impl<'de> Deserialize<'de> for OneOrThree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumbersVisitor)
    }
}

struct NumbersVisitor;

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = OneOrThree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number or a list of three numbers")
    }

    fn visit_f64<E>(self, number: f64) -> Result<OneOrThree, E> {
        Ok(OneOrThree::One(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<OneOrThree, E> {
        Ok(OneOrThree::One(number as f64))
    }

    fn visit_i64<E>(self, number: i64) -> Result<OneOrThree, E> {
        Ok(OneOrThree::One(number as f64))
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut list: S) -> Result<OneOrThree, S::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        let three = numbers.as_slice().try_into();
        three.map(OneOrThree::Three).map_err(|_| S::Error::invalid_length(numbers.len(), &self))
    }
}
