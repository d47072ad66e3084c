//! Iteration over the set bits of a word.

/// Yields the positions of the set bits in ascending order; ends at the first position that is not
/// below `BELOW`.
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
