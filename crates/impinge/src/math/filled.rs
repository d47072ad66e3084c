//! Arrays built by a function of the index, or of the elements of another array.
//!
//! If the function panics, [`core::array::from_fn`] and `map` drop the elements built so far. For
//! numbers this is useless. The code for it consists of five nested functions for each closure, and
//! was a tenth of all code to compile.

/// Returns the array whose element at each index is the value of a function at this index.
#[inline(always)]
pub(crate) fn filled<T: Copy, const L: usize>(mut value: impl FnMut(usize) -> T) -> [T; L] {
    let mut all = [value(0); L];
    let mut index = 1;
    while index < L {
        all[index] = value(index);
        index += 1;
    }
    all
}

/// The method `map` for arrays of `Copy` types, without code that drops elements.
pub(crate) trait Mapped<T, const L: usize> {
    /// Returns the array of the values of a function at the elements of this array.
    fn mapped<U: Copy>(self, value: impl FnMut(T) -> U) -> [U; L];
}

impl<T: Copy, const L: usize> Mapped<T, L> for [T; L] {
    #[inline(always)]
    fn mapped<U: Copy>(self, mut value: impl FnMut(T) -> U) -> [U; L] {
        filled(
            #[inline(always)]
            |index| value(self[index]),
        )
    }
}
