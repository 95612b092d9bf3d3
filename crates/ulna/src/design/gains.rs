//! What one more measurement would be worth, of very many at once.

use super::abreast::{Abreast, Question};
use super::blocks::Candidates;
use crate::error::{Error, Result};
use crate::simd::PAD;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use rayon::prelude::*;

/// Candidates that one thread takes: a whole number of vectors.
const TOGETHER: usize = 16 * PAD;
/// Directions whose singular value is below this part of the largest add less than rounding to a mean of squares.
const UNSEEN: f64 = 1e-9;

/// By how much each candidate would lower the mean variance of what is asked for, given what is known: with `RᵀR` the
/// information at hand, `F` the directions asked for (rows of as many numbers as there are unknowns) and a candidate's rows `Z`,
///
/// `tr((I + W Wᵀ)⁻¹ W HᵀH Wᵀ) / rows of F`, where `W = Z R⁻¹` and `H = F R⁻¹`.
///
/// Only the triangle is ever solved with, the information is never formed; nor is `HᵀH`. An orthogonal matrix behind `R⁻¹`
/// changes nothing of this, so the unknowns are turned by the `V` of `H = U S Vᵀ`: with `W = Z R⁻¹ V`, the one product that a
/// candidate needs, and `L Lᵀ = I + W Wᵀ` a gain is the sum of the squares of `L⁻¹ W S`. `triangle` is row-major and upper.
///
/// # Errors
/// Shapes that do not agree, numbers that are not finite, a triangle that has a zero on its diagonal.
pub fn gains(candidates: &Candidates, triangle: &[f64], directions: &[f64]) -> Result<Vec<f64>> {
    let (n, each) = (candidates.unknowns, candidates.each);
    check(candidates, triangle, directions)?;
    let inverse = inverse_upper(triangle, n);
    let asked = directions.len() / n;
    let of_asked = product(MatRef::from_row_major_slice(directions, asked, n), inverse.as_ref());
    let Ok(turned) = of_asked.qr().thin_R().svd() else {
        return Err(not_finite(&[f64::INFINITY]));
    };
    let size = turned.S().column_vector();
    let seen = (0..size.nrows()).take_while(|&k| size[k] > UNSEEN * size[0]);
    let map = product(inverse.as_ref(), turned.V());
    let question = Question::new(each, n, |i, j| map[(i, j)], seen.map(|k| size[k]).collect());
    let mut gains = vec![0.0; candidates.count()];
    let together = candidates.rows.par_chunks(TOGETHER * each * n).zip(gains.par_chunks_mut(TOGETHER));
    let finite = together
        .map_init(
            || Abreast::new(&question),
            |abreast, (rows, gains)| {
                let some = rows.chunks(PAD * each * n).zip(gains.chunks_mut(PAD));
                some.fold(true, |finite, (rows, gains)| abreast.gains(rows, gains) & finite)
            },
        )
        .reduce(|| true, |a, b| a & b);
    if !finite {
        return Err(not_finite(candidates.rows));
    }
    gains.iter_mut().for_each(|gain| *gain /= asked as f64);
    Ok(gains)
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
        let at_hand = information(&triangle, n);
        // fewer directions than unknowns and more, each number of rows that tiles differ by, and a vector that is not full
        for (asked, each) in (1..10).map(|each| (7, each)).chain([(2, 3), (1, 13)]) {
            let directions = some(asked * n, 2.1);
            let mean = |m: &[f64]| {
                let c = inverse(m, n).unwrap();
                let variance = |f: &[f64]| -> f64 { (0..n * n).map(|k| f[k / n] * c[k] * f[k % n]).sum() };
                directions.chunks_exact(n).map(variance).sum::<f64>() / asked as f64
            };
            let rows = some(603 * each * n, 0.9);
            let candidates = Candidates { rows: &rows, each, unknowns: n };
            let found = gains(&candidates, &triangle, &directions).unwrap();
            assert_eq!(found.len(), 603);
            for (k, gain) in found.iter().enumerate() {
                let with: Vec<f64> =
                    information(candidates.block(k), n).iter().zip(&at_hand).map(|(a, b)| a + b).collect();
                let expected = mean(&at_hand) - mean(&with);
                assert!((gain - expected).abs() < 1e-11 * mean(&at_hand), "{each}: {gain} {expected}");
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
