//! What one more measurement would be worth, of very many at once.

use super::blocks::{Candidates, cholesky_in_place, dot, solve_lower};
use crate::error::{Error, Result};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use rayon::prelude::*;

/// Blocks worked on together: their rows and products stay in the cache.
const TOGETHER: usize = 256;

/// By how much each candidate would lower the mean variance of what is asked for, given what is known: with `RᵀR` the
/// information at hand, `F` the directions asked for (rows of as many numbers as there are unknowns) and a candidate's rows `Z`,
///
/// `tr((I + W Wᵀ)⁻¹ W HᵀH Wᵀ) / rows of F`, where `W = Z R⁻¹` and `H = F R⁻¹`.
///
/// Only the triangle is ever solved with, the information is never formed; nor is `HᵀH`, in whose place its triangle `T`
/// stands: with `L Lᵀ = I + W Wᵀ` a gain is the sum of the squares of `L⁻¹ W Tᵀ`. `triangle` is row-major and upper.
///
/// # Errors
/// Shapes that do not agree, numbers that are not finite, a triangle that has a zero on its diagonal.
pub fn gains(candidates: &Candidates, triangle: &[f64], directions: &[f64]) -> Result<Vec<f64>> {
    let (n, each) = (candidates.unknowns, candidates.each);
    check(candidates, triangle, directions)?;
    let inverse = inverse_upper(triangle, n);
    let asked = directions.len() / n;
    let of_asked = product(MatRef::from_row_major_slice(directions, asked, n), inverse.as_ref());
    let least = of_asked.qr().thin_R().to_owned();
    // both products at once: R⁻ᵀ, and T R⁻ᵀ below it
    let height = n + least.nrows();
    let below = product(least.as_ref(), inverse.transpose());
    let both = Mat::from_fn(height, n, |i, j| if i < n { inverse[(j, i)] } else { below[(i - n, j)] });
    let mut gains = vec![0.0; candidates.count()];
    let together = candidates.rows.par_chunks(TOGETHER * each * n).zip(gains.par_chunks_mut(TOGETHER));
    let finite = together
        .map(|(rows, gains)| {
            // a row of a candidate is a column here, so that its numbers stand together
            let found = product(both.as_ref(), MatRef::from_column_major_slice(rows, n, rows.len() / n));
            let mut here =
                Here { found: &found, n, inner: vec![0.0; each * each], told: vec![0.0; each * (height - n)] };
            gains.iter_mut().enumerate().for_each(|(k, gain)| *gain = here.gain(k * each, each) / asked as f64);
            rows.iter().all(|value| value.is_finite())
        })
        .reduce(|| true, |a, b| a & b);
    if finite { Ok(gains) } else { Err(not_finite(candidates.rows)) }
}

/// The products of some candidates, and room to work in.
struct Here<'a> {
    /// A column for each row of a candidate: of `Wᵀ`, and of `T Wᵀ` below it.
    found: &'a Mat<f64>,
    n: usize,
    /// `I + W Wᵀ`, then its factor.
    inner: Vec<f64>,
    /// `W Tᵀ`, then `L⁻¹ W Tᵀ`.
    told: Vec<f64>,
}

impl Here<'_> {
    /// The gain, times the rows of F, of the candidate whose rows begin at `first`.
    fn gain(&mut self, first: usize, each: usize) -> f64 {
        let width = self.told.len() / each;
        for i in 0..each {
            let (seen, told) = self.found.col_as_slice(first + i).split_at(self.n);
            self.told[i * width..(i + 1) * width].copy_from_slice(told);
            for j in 0..=i {
                let other = &self.found.col_as_slice(first + j)[..self.n];
                self.inner[i * each + j] = dot(seen, other) + if i == j { 1.0 } else { 0.0 };
            }
        }
        // I + W Wᵀ is positive definite whatever W is
        if !cholesky_in_place(&mut self.inner, each) {
            return 0.0;
        }
        solve_lower(&self.inner, each, &mut self.told, width);
        dot(&self.told, &self.told)
    }
}

fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut out = Mat::zeros(a.nrows(), b.ncols());
    matmul(out.as_mut(), Accum::Replace, a, b, 1.0, Par::Seq);
    out
}

/// The inverse of an upper triangle, by back substitution column by column: whatever its columns' units are.
fn inverse_upper(triangle: &[f64], n: usize) -> Mat<f64> {
    let mut inverse = Mat::zeros(n, n);
    for column in 0..n {
        inverse[(column, column)] = 1.0 / triangle[column * n + column];
        for i in (0..column).rev() {
            let sum: f64 = (i + 1..=column).map(|k| triangle[i * n + k] * inverse[(k, column)]).sum();
            inverse[(i, column)] = -sum / triangle[i * n + i];
        }
    }
    inverse
}

fn check(candidates: &Candidates, triangle: &[f64], directions: &[f64]) -> Result<()> {
    let n = candidates.unknowns;
    if candidates.each * n == 0 {
        let got = candidates.each.min(n);
        return Err(Error::Shape { what: "the rows of a candidate, or their columns,".into(), got, expected: 1 });
    }
    let shapes = [
        ("the candidates' rows", candidates.rows.len(), candidates.count() * candidates.each * n),
        ("the triangle of the information at hand", triangle.len(), n * n),
        ("the directions asked for", directions.len(), (directions.len() / n.max(1)).max(1) * n),
    ];
    if let Some(&(what, got, expected)) = shapes.iter().find(|(_, got, expected)| got != expected) {
        return Err(Error::Shape { what: what.into(), got, expected });
    }
    if triangle.iter().chain(directions).any(|value| !value.is_finite()) {
        return Err(not_finite(&[triangle, directions].concat()));
    }
    if (0..n).any(|k| triangle[k * n + k] == 0.0) {
        return Err(Error::OutOfRange {
            what: "a diagonal entry of the triangle of the information at hand".into(),
            value: 0.0,
            expected: "another number than zero (something known beforehand of every unknown)",
        });
    }
    Ok(())
}

/// Some number is not; which.
fn not_finite(numbers: &[f64]) -> Error {
    let value = numbers.iter().copied().find(|value| !value.is_finite()).unwrap_or(f64::NAN);
    Error::NotFinite { what: "a number of the candidates or of what is known".into(), value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::blocks::inverse;
    use crate::design::samples::{information, some};

    /// The plain version: the mean variance before and after, from inverses of whole information matrices.
    #[test]
    fn a_gain_is_what_the_mean_variance_loses() {
        let n = 6;
        let triangle: Vec<f64> = some(n * n, 0.4)
            .iter()
            .enumerate()
            .map(|(k, &v)| {
                if k / n > k % n {
                    0.0
                } else if k / n == k % n {
                    1.0 + v.abs()
                } else {
                    v
                }
            })
            .collect();
        let directions = some(7 * n, 2.1);
        let at_hand = information(&triangle, n);
        let mean = |m: &[f64]| {
            let c = inverse(m, n).unwrap();
            let variance = |f: &[f64]| -> f64 { (0..n * n).map(|k| f[k / n] * c[k] * f[k % n]).sum() };
            directions.chunks_exact(n).map(variance).sum::<f64>() / 7.0
        };
        for each in 1..4 {
            let rows = some(600 * each * n, 0.9);
            let candidates = Candidates { rows: &rows, each, unknowns: n };
            let found = gains(&candidates, &triangle, &directions).unwrap();
            assert_eq!(found.len(), 600);
            for (k, gain) in found.iter().enumerate() {
                let with: Vec<f64> =
                    information(candidates.block(k), n).iter().zip(&at_hand).map(|(a, b)| a + b).collect();
                let expected = mean(&at_hand) - mean(&with);
                assert!((gain - expected).abs() < 1e-11 * mean(&at_hand), "{gain} {expected}");
            }
        }
    }

    #[test]
    fn what_cannot_be_asked_is_refused() {
        let (rows, triangle) = (some(12, 1.0), [1.0, 0.5, 0.0, 2.0]);
        let candidates = Candidates { rows: &rows, each: 1, unknowns: 2 };
        assert!(gains(&candidates, &triangle, &[1.0, 0.0]).is_ok());
        assert!(gains(&Candidates { each: 0, ..candidates }, &triangle, &[1.0, 0.0]).is_err());
        assert!(gains(&candidates, &triangle[..3], &[1.0, 0.0]).is_err());
        assert!(gains(&candidates, &triangle, &[]).is_err());
        assert!(gains(&candidates, &[1.0, 0.5, 0.0, 0.0], &[1.0, 0.0]).is_err());
        assert!(gains(&candidates, &triangle, &[f64::NAN, 0.0]).is_err());
        let broken: Vec<f64> = rows.iter().enumerate().map(|(k, &v)| if k == 7 { f64::INFINITY } else { v }).collect();
        assert!(gains(&Candidates { rows: &broken, ..candidates }, &triangle, &[1.0, 0.0]).is_err());
    }
}
