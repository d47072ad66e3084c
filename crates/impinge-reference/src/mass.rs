//! Mass, centre and inertia by counting sample points: no formula for any shape is used.

use crate::random::Random;

/// Integrals over a body of density one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass<const D: usize> {
    /// The area in 2D, the volume in 3D.
    pub measure: f64,
    /// The centre of mass.
    pub center: [f64; D],
    /// The second moments about the centre: the integral of the product of coordinates i and j.
    pub seconds: [[f64; D]; D],
}

impl<const D: usize> Mass<D> {
    /// Returns the inertia tensor about the centre. In 2D this is the upper left part of the tensor
    /// of a thin plate: its trace is the moment of inertia.
    #[must_use]
    pub fn inertia(&self) -> [[f64; D]; D] {
        let trace: f64 = (0..D).map(|axis| self.seconds[axis][axis]).sum();
        let diagonal = |row, column| if row == column { trace } else { 0.0 };
        std::array::from_fn(|row| {
            std::array::from_fn(|column| diagonal(row, column) - self.seconds[row][column])
        })
    }
}

/// Estimates the integrals over a body within a box. The box is divided into `cells` along each
/// axis, and one random point of each cell is tested.
///
/// Only cells that the surface crosses add an error to the measure. If no tested point is inside,
/// the centre and the moments are NaN. For a body that fills about half of the box, the relative
/// error of the measure is about `cells` to the power of −(D + 1) / 2.
pub fn counted<const D: usize>(
    low: &[f64; D],
    high: &[f64; D],
    cells: usize,
    random: &mut Random,
    mut is_inside: impl FnMut(&[f64; D]) -> bool,
) -> Mass<D> {
    let size: [f64; D] = std::array::from_fn(|axis| (high[axis] - low[axis]) / cells as f64);
    let cell: f64 = size.iter().product();
    let (mut count, mut sum, mut products) = (0.0, [0.0; D], [[0.0; D]; D]);
    let total = (0..D).fold(1, |total, _| total * cells);
    for index in 0..total {
        let mut rest = index;
        // Coordinates are relative to the low corner of the box, which keeps rounding errors small.
        let place: [f64; D] = std::array::from_fn(|axis| {
            let step = rest % cells;
            rest /= cells;
            (step as f64 + random.share()) * size[axis]
        });
        if is_inside(&std::array::from_fn(|axis| low[axis] + place[axis])) {
            count += 1.0;
            for row in 0..D {
                sum[row] += place[row];
                (0..D).for_each(|column| products[row][column] += place[row] * place[column]);
            }
        }
    }
    let mean = sum.map(|x| x / count);
    let second = |row: usize, column: usize| {
        (products[row][column] - count * mean[row] * mean[column]) * cell
    };
    Mass {
        measure: count * cell,
        center: std::array::from_fn(|axis| low[axis] + mean[axis]),
        seconds: std::array::from_fn(|row| std::array::from_fn(|column| second(row, column))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_in_a_box_is_counted_exactly() {
        let is_inside = |p: &[f64; 2]| p[0] < 4.0 && p[1] < 1.0;
        let found = counted(&[2.0, -1.0], &[6.0, 3.0], 64, &mut Random::new(1), is_inside);
        assert_eq!(found.measure, 4.0, "whole cells");
        assert!((found.center[0] - 3.0).abs() < 1e-2 && found.center[1].abs() < 1e-2, "{found:?}");
        let [[x, xy], [_, y]] = found.inertia();
        assert!((x + y - 4.0 * 8.0 / 12.0).abs() < 3e-2 && xy.abs() < 3e-2, "{found:?}");
    }

    #[test]
    fn a_ball_is_counted_nearly() {
        let is_inside = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>() < 1.0;
        let found = counted(&[-1.0; 3], &[1.0; 3], 40, &mut Random::new(1), is_inside);
        let volume = std::f64::consts::PI * 4.0 / 3.0;
        assert!((found.measure / volume - 1.0).abs() < 4e-3, "{found:?}");
        let inertia = found.inertia();
        for axis in 0..3 {
            assert!((inertia[axis][axis] / (0.4 * volume) - 1.0).abs() < 1e-2, "{found:?}");
            assert!(inertia[axis][(axis + 1) % 3].abs() < 1e-2, "{found:?}");
        }
    }
}
