//! Sorting by numbers, compiled once for all that sort, and an order of places.

use super::{Real, Vector};

/// A whole number for each number, in the total order of IEEE 754.
pub(crate) fn order_of<N: Real>(value: N) -> u64 {
    const SIGN: u64 = 1 << 63;
    let bits = value.as_f64().to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}

/// How far a vector reaches along a direction to which neither an axis nor a diagonal of space is at right angles: of
/// places that people choose, seldom two reach equally far.
#[inline]
pub(crate) fn askew<N: Real, const D: usize>(vector: &Vector<N, D>) -> N {
    const DIRECTION: [f64; 3] = [1.0, 1.6875, 2.5625];
    let mut reach = N::ZERO;
    for axis in 0..D {
        reach += vector[axis] * N::lit(DIRECTION[axis]);
    }
    reach
}

/// Sorts by the first, equals by the second.
#[inline(never)]
pub(crate) fn sort_keyed(items: &mut [(u64, u32)]) {
    items.sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_order() {
        let ascending =
            [f64::NEG_INFINITY, -1.5, -f64::MIN_POSITIVE, -0.0, 0.0, 5e-324, 2.0, f64::INFINITY];
        let keys = ascending.map(order_of);
        assert!(keys.is_sorted_by(|a, b| a < b), "{keys:?}");
        assert!(order_of(f32::NAN) > order_of(f32::INFINITY), "NaN comes last");
    }
}
