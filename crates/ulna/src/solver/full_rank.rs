//! What a triangle says where every column that exists is well determined: the same numbers as from its singular values,
//! in a tenth of the time.

use super::equations::vanished;
use super::triangle::Triangle;

/// A smallest singular value below this part of the largest is left to the singular values themselves: a hundredfold of
/// what counts as zero there.
const LEAST: f64 = 1e-7;

/// `J⁺` of the columns that exist, `J = Q R`: by the inverse of R.
#[derive(Debug, Clone)]
pub struct FullRank {
    unknowns: usize,
    /// unknowns whose columns exist
    kept: Vec<usize>,
    /// `R⁻¹` over the kept ones, row-major
    inverse: Vec<f64>,
}

impl FullRank {
    /// From the triangle of the first `unknowns` columns. None where a direction may not be determined: columns are scaled
    /// to unit norm, and `1 / (‖R‖ ‖R⁻¹‖)` in Frobenius norms, which no ratio of singular values is below, has to be
    /// large enough.
    pub fn of(triangle: &Triangle, unknowns: usize, natural_scale: &[f64]) -> Option<FullRank> {
        let norms = &triangle.column_norms()[..unknowns];
        let gone = vanished(norms, natural_scale);
        let kept: Vec<usize> = (0..unknowns).filter(|&j| !gone[j]).collect();
        // what a vanished column left in its row, others would have to be turned into: then R is no triangle any more
        let stray = |i: usize| gone[i] && (i + 1..unknowns).any(|j| !gone[j] && triangle.at(i, j) != 0.0);
        if (0..unknowns).any(stray) {
            return None;
        }
        let n = kept.len();
        let mut inverse = vec![0.0; n * n];
        for i in (0..n).rev() {
            let (above, below) = inverse.split_at_mut((i + 1) * n);
            let row = &mut above[i * n..];
            row[i] = 1.0;
            let scaled = |j: usize| triangle.at(kept[i], kept[j]) / norms[kept[j]];
            for (j, known) in (i + 1..n).zip(below.chunks_exact(n)) {
                let factor = scaled(j);
                row[j..].iter_mut().zip(&known[j..]).for_each(|(value, x)| *value -= factor * x);
            }
            let pivot = scaled(i);
            row[i..].iter_mut().for_each(|value| *value /= pivot);
        }
        let size = inverse.iter().map(|x| x * x).sum::<f64>().sqrt();
        // of unit columns, the triangle's own norm is the root of their number
        let determined = size * (n as f64).sqrt() * LEAST <= 1.0;
        for (row, &j) in inverse.chunks_exact_mut(n.max(1)).zip(&kept) {
            row.iter_mut().for_each(|x| *x /= norms[j]);
        }
        determined.then_some(FullRank { unknowns, kept, inverse })
    }

    /// The variance of each unknown where a row's is one: of `(JᵀJ)⁻¹`; NaN where the column vanished.
    pub fn variances(&self) -> Vec<f64> {
        let mut variances = vec![f64::NAN; self.unknowns];
        for (row, &j) in self.inverse.chunks_exact(self.kept.len().max(1)).zip(&self.kept) {
            variances[j] = row.iter().map(|x| x * x).sum();
        }
        variances
    }

    /// The same with what dimensions add that stand behind the unknowns in the triangle, known with `considered_u`.
    pub fn variances_considering(&self, triangle: &Triangle, considered_u: &[f64]) -> Vec<f64> {
        let mut variances = self.variances();
        for (c, u) in considered_u.iter().enumerate() {
            let sensitivity = self.solve(triangle, self.unknowns + c);
            variances.iter_mut().zip(sensitivity).for_each(|(variance, s)| *variance += (s * u).powi(2));
        }
        variances
    }

    /// `J⁺ b` for `b` given as a column of the triangle, over all unknowns.
    pub fn solve(&self, triangle: &Triangle, column: usize) -> Vec<f64> {
        let right: Vec<f64> = self.kept.iter().map(|&i| triangle.at(i, column)).collect();
        let mut solution = vec![0.0; self.unknowns];
        for (row, &j) in self.inverse.chunks_exact(self.kept.len().max(1)).zip(&self.kept) {
            solution[j] = row.iter().zip(&right).map(|(x, b)| x * b).sum();
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Columns, PAD};
    use crate::solver::decomposition::Decomposition;
    use crate::solver::{RowBlock, RowSink};

    /// A triangle of 40 rows of 6 unknowns and two more columns; `shape` changes the rows' entries.
    fn triangle(shape: impl Fn(usize, &mut [f64; 9])) -> Triangle {
        let mut triangle = Triangle::new(8);
        let rows = 40;
        let mut block = RowBlock {
            columns: Columns::zeros(9, rows),
            rows: rows.div_ceil(PAD) * PAD,
            targets: (0..8).map(|c| (c, c)).collect(),
            residual: 8,
            standing: vec![],
        };
        for row in 0..rows {
            let entry = |c: usize| ((row * 9 + c + 1).pow(2) as f64 * 0.754_877_666).fract() - 0.5;
            let mut entries = std::array::from_fn(entry);
            shape(row, &mut entries);
            (0..9).for_each(|c| block.columns.column_mut(c)[row] = entries[c]);
        }
        triangle.fold(&mut block);
        triangle
    }

    #[test]
    fn it_says_what_singular_values_say() {
        let scaled = triangle(|_, row| (0..6).for_each(|c| row[c] *= 10f64.powi(2 * c as i32 - 6)));
        // an unknown that nothing shows
        let still = triangle(|_, row| row[2] = 0.0);
        // columns that are nearly alike, told apart by a part in ten thousand
        let alike = triangle(|_, row| row[4] = row[1] + 1e-4 * row[4]);
        for triangle in [scaled, still, alike] {
            let natural: Vec<f64> = triangle.column_norms()[..6].iter().map(|norm| norm.max(1e-6)).collect();
            let quick = FullRank::of(&triangle, 6, &natural).unwrap();
            let slow = Decomposition::new(&triangle, 6, &natural, &[]);
            let covariance = slow.covariance();
            for (j, variance) in quick.variances().into_iter().enumerate() {
                let expected = covariance[7 * j];
                if slow.kept.contains(&j) {
                    assert!((variance - expected).abs() < 1e-10 * expected, "{j}: {variance} {expected}");
                } else {
                    assert!(variance.is_nan());
                }
            }
            let (quick, slow) = (quick.solve(&triangle, 7), slow.pseudo_solve(&triangle, 7));
            for (j, (a, b)) in quick.iter().zip(&slow).enumerate() {
                assert!((a - b).abs() <= 1e-9 * covariance[7 * j].sqrt(), "{j}: {a} {b}");
            }
        }
    }

    #[test]
    fn what_may_not_be_determined_is_left_to_them() {
        let natural = [1.0; 6];
        for least in [0.0, 1e-13, 1e-9] {
            let alike = triangle(|_, row| row[4] = row[1] + least * row[4]);
            assert!(FullRank::of(&alike, 6, &natural).is_none(), "{least}");
        }
        // a column of rounding, which is not scaled up to one
        let tiny = triangle(|_, row| row[2] *= 1e-13);
        assert!(FullRank::of(&tiny, 6, &natural).is_none());
        assert_eq!(Decomposition::new(&tiny, 6, &natural, &[]).rank, 5);
    }
}
