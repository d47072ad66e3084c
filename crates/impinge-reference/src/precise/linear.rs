//! Small systems of linear equations.

use super::number::Quad;

/// Solves a square system of linear equations by elimination with full pivoting. Each row ends with
/// the right side.
///
/// If the rows are dependent to about 26 digits, the undetermined unknowns are zero.
pub(super) fn solve(mut rows: Vec<Vec<Quad>>) -> Vec<Quad> {
    let count = rows.len();
    let mut columns: Vec<usize> = (0..count).collect();
    let mut largest = 0.0_f64;
    let mut rank = 0;
    while rank < count {
        let (i, j, pivot) = pivot(&rows, rank);
        largest = largest.max(pivot);
        let independent = pivot > 1e-26 * largest;
        if !independent {
            break;
        }
        rows.swap(rank, i);
        columns.swap(rank, j);
        rows.iter_mut().for_each(|row| row.swap(rank, j));
        eliminate(&mut rows, rank);
        rank += 1;
    }
    let mut solution = vec![Quad::ZERO; count];
    for k in (0..rank).rev() {
        let known = (k + 1..rank)
            .fold(Quad::ZERO, |sum, other| sum + rows[k][other] * solution[columns[other]]);
        solution[columns[k]] = (rows[k][count] - known) / rows[k][k];
    }
    solution
}

/// Returns the row, the column and the magnitude of the largest remaining entry.
fn pivot(rows: &[Vec<Quad>], rank: usize) -> (usize, usize, f64) {
    let mut best = (rank, rank, 0.0);
    for (i, row) in rows.iter().enumerate().skip(rank) {
        for (j, entry) in row.iter().enumerate().take(rows.len()).skip(rank) {
            let magnitude = entry.to_f64().abs();
            if magnitude > best.2 {
                best = (i, j, magnitude);
            }
        }
    }
    best
}

/// Subtracts multiples of the pivot row from the rows below it.
fn eliminate(rows: &mut [Vec<Quad>], rank: usize) {
    let (done, below) = rows.split_at_mut(rank + 1);
    let pivot_row = &done[rank];
    for row in below {
        let factor = row[rank] / pivot_row[rank];
        for (entry, above) in row.iter_mut().zip(pivot_row).skip(rank) {
            *entry -= factor * *above;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(rows: &[&[f64]]) -> Vec<Vec<Quad>> {
        rows.iter().map(|row| row.iter().map(|&x| Quad::new(x)).collect()).collect()
    }

    #[test]
    fn two_unknowns_by_hand() {
        let found = solve(system(&[&[0.0, 2.0, 6.0], &[4.0, 1.0, 11.0]]));
        assert_eq!(found.iter().map(|x| x.to_f64()).collect::<Vec<_>>(), [2.0, 3.0]);
    }

    #[test]
    fn what_nothing_determines_is_zero() {
        let found = solve(system(&[&[1.0, 1.0, 3.0], &[2.0, 2.0, 6.0]]));
        let sum = (found[0] + found[1]).to_f64();
        assert!(sum == 3.0 && found.contains(&Quad::ZERO), "{found:?}");
    }
}
