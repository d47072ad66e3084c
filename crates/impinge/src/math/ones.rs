//! Iteration over the set bits of a word.

/// An iterator over the positions of the set bits of a word, in ascending order. It ends before the
/// first position that is `BELOW` or more, so that the positions can index arrays of the length
/// `BELOW`.
#[derive(Clone)]
pub(crate) struct Ones<const BELOW: usize>(pub(crate) u32);

impl<const BELOW: usize> Iterator for Ones<BELOW> {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let bit = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (bit < BELOW).then_some(bit)
    }
}
