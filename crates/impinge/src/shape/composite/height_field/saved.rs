//! Conversion of height fields to and from the records of saved worlds.

use super::marks::Marks;
use super::{Diagonals, HeightField};
use crate::math::numbers::{Damage, NumberSource, Numbers, ensure};
use crate::math::{Real, Vector};
use crate::shape::ShapeError;
use crate::shape::saved::FieldRecord;

/// The diagonal rules, indexed by their numbers in saved data.
const DIAGONALS: [Diagonals; 3] = [Diagonals::Forward, Diagonals::Backward, Diagonals::Zigzag];

impl<N: Real, const D: usize> HeightField<N, D> {
    /// Returns the record of the field.
    pub(in crate::shape) fn record(&self) -> FieldRecord<N> {
        let (diagonals, marks) = self.marks.parts();
        let number = (0..).zip(DIAGONALS).find(|(_, known)| *known == diagonals);
        FieldRecord {
            // The number of parts fits 32 bits, so the number of columns fits too, except in a 2D
            // field of 2³² heights.
            columns: u32::try_from(self.grid.columns).unwrap_or(u32::MAX),
            heights: Numbers::of(self.grid.heights.iter().copied()),
            scale: Numbers::of(self.scale.iter().copied()),
            diagonals: number.map_or(0, |(number, _)| number),
            marks: marks.to_vec(),
            is_one_sided: self.is_one_sided,
            keeps_internal_edges: self.keeps_internal_edges,
        }
    }
}

impl<N: Real> FieldRecord<N> {
    /// Restores the field by `make`, the constructor of its dimension. An error if `make` fails, or
    /// the marks are damaged. The caller must rebuild the pyramid, which depends on the marks.
    pub(in crate::shape) fn make<const D: usize>(
        &self,
        make: impl FnOnce(Vec<N>, Vector<N, D>) -> Result<HeightField<N, D>, ShapeError>,
    ) -> Result<HeightField<N, D>, Damage> {
        let scale = self.scale.all(NumberSource::vector)?;
        let field = make(self.heights.clone().into_vec(), scale);
        let field = field.map_err(|error| Damage::found(&error))?;
        let diagonals = DIAGONALS.get(usize::from(self.diagonals)).copied();
        let diagonals = diagonals.ok_or(Damage("a height field has no such diagonals".into()))?;
        let is_for_each = self.marks.is_empty() || self.marks.len() == field.num_cells();
        ensure(is_for_each, "a height field has other marks than cells")?;
        let marks = Marks::of_parts(diagonals, self.marks.clone());
        let Self { is_one_sided, keeps_internal_edges, .. } = *self;
        Ok(HeightField { marks, is_one_sided, keeps_internal_edges, ..field })
    }
}
