//! Output columns of the query for the nearest pair of each configuration.

use crate::batch::BatchError;
use crate::chunks::Cut;
use crate::math::Real;

/// Output columns of [`Checker::nearest`](super::Checker::nearest). Each may be empty.
///
/// ```
/// use impinge::checker::NearestColumns;
///
/// let mut distance = [0.0_f64; 100];
/// let wanted = NearestColumns { distance: &mut distance, ..Default::default() };
/// assert!(wanted.pair.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct NearestColumns<'a, N: Real> {
    /// The distance of the nearest pair: zero if the pair touches, infinite if there is no pair
    /// within the limit, NaN for a configuration that is not finite.
    pub distance: &'a mut [N],
    /// The nearest pair, with the indices of [`Checker::first_pairs`](super::Checker::first_pairs);
    /// [`NO_PAIR`](super::NO_PAIR) if no pair is within the limit or the configuration is not
    /// finite.
    pub pair: &'a mut [[u32; 2]],
}

impl<N: Real> NearestColumns<'_, N> {
    /// Checks that each column has either `needed` slots or none.
    pub(super) const fn check(&self, needed: usize) -> Result<(), BatchError> {
        let (distances, pairs) = (self.distance.len(), self.pair.len());
        if distances != 0 && distances != needed {
            return Err(BatchError::Length { argument: "distance", given: distances, needed });
        }
        if pairs != 0 && pairs != needed {
            return Err(BatchError::Length { argument: "pair", given: pairs, needed });
        }
        Ok(())
    }

    /// Writes the result of one configuration to the columns that are not empty.
    pub(super) fn put(&mut self, slot: usize, distance: N, pair: [u32; 2]) {
        if let Some(element) = self.distance.get_mut(slot) {
            *element = distance;
        }
        if let Some(element) = self.pair.get_mut(slot) {
            *element = pair;
        }
    }
}

impl<N: Real> Cut for NearestColumns<'_, N> {
    fn cut(self, at: usize) -> (Self, Self) {
        let (distance, pair) = (self.distance.cut(at), self.pair.cut(at));
        let front = Self { distance: distance.0, pair: pair.0 };
        (front, Self { distance: distance.1, pair: pair.1 })
    }
}
