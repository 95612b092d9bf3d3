//! What makes a set of measurements good: a number of the covariance C, the smaller the better.

use super::blocks::{cholesky, dot, product, product_transposed, quotient_trace};
use faer::{Mat, Side};

/// What is made small. The rows F are directions in the candidates' coordinates, `unknowns` numbers each: `F C Fᵀ` is the
/// covariance of what they stand for.
#[derive(Debug, Clone, PartialEq)]
pub enum Criterion {
    /// `log det C`: the volume of the confidence ellipsoid (D).
    Volume,
    /// `tr(F C Fᵀ)` over the number of rows: the mean variance (A, and the mean of lengths or points).
    Mean(Vec<f64>),
    /// The largest diagonal entry of `F C Fᵀ`: the largest variance (G).
    Worst(Vec<f64>),
    /// The largest eigenvalue of `F C Fᵀ` (E).
    Widest(Vec<f64>),
}

/// The power with which a mean of variances or eigenvalues stands for the largest of them, to rank candidates.
const POWER: i32 = 12;

impl Criterion {
    /// Its value for a covariance; smaller is better.
    pub fn value(&self, c: &[f64], n: usize) -> f64 {
        match self {
            Criterion::Volume => {
                cholesky(c, n).map_or(f64::INFINITY, |l| (0..n).map(|i| 2.0 * l[i * n + i].ln()).sum())
            }
            Criterion::Mean(f) => variances(f, c, n).iter().sum::<f64>() / (f.len() / n) as f64,
            Criterion::Worst(f) => variances(f, c, n).into_iter().fold(0.0, f64::max),
            Criterion::Widest(f) => eigen(f, c, n).0.into_iter().fold(0.0, f64::max),
        }
    }

    /// Whether what a block adds is known exactly from [`Criterion::weight`].
    pub(super) fn exact(&self) -> bool {
        matches!(self, Criterion::Volume | Criterion::Mean(_))
    }

    /// `C B C`, where `tr(B C)` has the criterion's slope at C; none for the volume.
    pub(super) fn weight(&self, c: &[f64], n: usize) -> Option<Vec<f64>> {
        let weighted = match self {
            Criterion::Volume => return None,
            Criterion::Mean(f) => f.clone(),
            Criterion::Worst(f) => {
                let variances = variances(f, c, n);
                let most = variances.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
                let factors: Vec<f64> = variances.iter().map(|v| (v / most).powi(POWER - 1).sqrt()).collect();
                f.chunks_exact(n).zip(factors).flat_map(|(row, w)| row.iter().map(move |x| w * x)).collect()
            }
            Criterion::Widest(f) => {
                let (values, vectors) = eigen(f, c, n);
                let most = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
                let t = values.len();
                let factor = |e: usize| (values[e].max(0.0) / most).powi(POWER - 1).sqrt();
                let turned: Vec<f64> = (0..t * t).map(|k| factor(k / t) * vectors[(k % t, k / t)]).collect();
                product(&turned, f, t)
            }
        };
        let fc = product(&weighted, c, n);
        let mut sum = vec![0.0; n * n];
        for row in fc.chunks_exact(n) {
            for (&factor, target) in row.iter().zip(sum.chunks_exact_mut(n)) {
                target.iter_mut().zip(row).for_each(|(t, r)| *t += factor * r);
            }
        }
        Some(sum)
    }
}

/// What adding a block takes off the criterion (of its slope, where it has one): `log det(I + Z C Zᵀ)`, or
/// `tr((I + Z C Zᵀ)⁻¹ Z CBC Zᵀ)`.
pub(super) fn gain(c: &[f64], weight: Option<&[f64]>, z: &[f64], n: usize) -> f64 {
    let k = z.len() / n;
    if k == 1 {
        let seen = 1.0 + quadratic(c, z, n);
        return weight.map_or_else(|| seen.ln(), |weight| quadratic(weight, z, n) / seen);
    }
    let mut inner = product_transposed(&product(z, c, n), z, n);
    (0..k).for_each(|i| inner[i * k + i] += 1.0);
    let mut outer = weight.map(|weight| product_transposed(&product(z, weight, n), z, n));
    match &mut outer {
        None => cholesky(&inner, k).map_or(0.0, |l| (0..k).map(|i| 2.0 * l[i * k + i].ln()).sum()),
        Some(outer) => quotient_trace(&inner, outer, k).unwrap_or(0.0),
    }
}

/// `zᵀ C z`.
fn quadratic(c: &[f64], z: &[f64], n: usize) -> f64 {
    c.chunks_exact(n).zip(z).map(|(row, &factor)| factor * dot(row, z)).sum()
}

fn variances(f: &[f64], c: &[f64], n: usize) -> Vec<f64> {
    let fc = product(f, c, n);
    fc.chunks_exact(n).zip(f.chunks_exact(n)).map(|(a, b)| a.iter().zip(b).map(|(x, y)| x * y).sum()).collect()
}

/// Eigenvalues of `F C Fᵀ`, and its eigenvectors in columns.
fn eigen(f: &[f64], c: &[f64], n: usize) -> (Vec<f64>, Mat<f64>) {
    let t = f.len() / n;
    let matrix = product_transposed(&product(f, c, n), f, n);
    let matrix = Mat::from_fn(t, t, |i, j| matrix[i * t + j]);
    match matrix.self_adjoint_eigen(Side::Lower) {
        Ok(found) => ((0..t).map(|i| found.S().column_vector()[i]).collect(), found.U().to_owned()),
        Err(_) => (vec![f64::INFINITY; t], Mat::identity(t, t)),
    }
}
