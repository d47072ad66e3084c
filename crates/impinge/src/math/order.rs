//! Sort keys and sort functions with little machine code.

use super::{Real, Vector};

/// Maps a number to an integer. The integers have the total order of IEEE 754: negative zero is
/// below zero, and NaN is above infinity or, with a sign, below minus infinity.
pub(crate) fn order_of<N: Real>(value: N) -> u64 {
    const SIGN: u64 = 1 << 63;
    let bits = value.as_f64().to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}

/// Returns the dot product of a vector and a fixed direction that is perpendicular to no axis and
/// no diagonal. So positions on a grid rarely have equal results.
#[inline]
pub(crate) fn askew<N: Real, const D: usize>(vector: &Vector<N, D>) -> N {
    const DIRECTION: [f64; 3] = [1.0, 1.6875, 2.5625];
    let mut coordinate = N::ZERO;
    for axis in 0..D {
        coordinate += vector[axis] * N::lit(DIRECTION[axis]);
    }
    coordinate
}

/// The greatest length of a list that [`sort_few`] sorts by insertion.
const FEW: usize = 20;

/// Sorts a list that is usually short. The order of equal items is kept if there are at most
/// [`FEW`] items.
///
/// The sorts of the standard library are faster for long lists, but have forty times the machine
/// code, and are compiled for each type and key. This function uses insertion sort, and for more
/// than [`FEW`] items heapsort (Williams, "Algorithm 232: Heapsort", 1964): O(n log n) in the worst
/// case, in place.
pub(crate) fn sort_few<T>(items: &mut [T], is_less: impl Fn(&T, &T) -> bool) {
    let count = items.len();
    if count <= FEW {
        for next in 1..count {
            let mut at = next;
            while at > 0 && is_less(&items[at], &items[at - 1]) {
                items.swap(at - 1, at);
                at -= 1;
            }
        }
        return;
    }
    for step in (0..count + count / 2).rev() {
        // The first `count / 2` steps build the heap from the back. Each later step moves the
        // greatest item of the heap to the position behind the shrunk heap.
        let (mut at, end) = if step >= count {
            (step - count, count)
        } else {
            items.swap(0, step);
            (0, step)
        };
        while 2 * at + 1 < end {
            let (left, right) = (2 * at + 1, 2 * at + 2);
            let is_right = right < end && is_less(&items[left], &items[right]);
            let child = if is_right { right } else { left };
            if !is_less(&items[at], &items[child]) {
                break;
            }
            items.swap(at, child);
            at = child;
        }
    }
}

/// Sorts by the first number, and equal first numbers by the second.
#[inline(never)]
pub(crate) fn sort_keyed(items: &mut [(u64, u32)]) {
    items.sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_and_long_lists_are_sorted() {
        let mut state = 7_u32;
        for count in (0..50).chain([1000, 4097]) {
            for range in [3, 1 << 20] {
                let mut next = || {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (state >> 8) % range
                };
                let items: Vec<_> = (0..count).map(|at| (next(), at)).collect();
                let (mut sorted, mut expected) = (items.clone(), items);
                sort_few(&mut sorted, |a, b| a.0 < b.0);
                expected.sort_by_key(|item| item.0);
                let keys =
                    |items: &[(u32, usize)]| items.iter().map(|item| item.0).collect::<Vec<_>>();
                assert_eq!(keys(&sorted), keys(&expected), "{count} up to {range}");
                assert!(count > FEW || sorted == expected, "a short list is sorted stably");
                sorted.sort_unstable();
                expected.sort_unstable();
                assert_eq!(sorted, expected, "nothing is lost");
            }
        }
    }

    #[test]
    fn numbers_keep_their_order() {
        let ascending =
            [f64::NEG_INFINITY, -1.5, -f64::MIN_POSITIVE, -0.0, 0.0, 5e-324, 2.0, f64::INFINITY];
        let keys = ascending.map(order_of);
        assert!(keys.is_sorted_by(|a, b| a < b), "{keys:?}");
        assert!(order_of(f32::NAN) > order_of(f32::INFINITY), "NaN comes last");
    }
}
