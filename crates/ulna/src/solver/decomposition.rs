//! The singular value decomposition that every statement about rank and uncertainty rests on.
//!
//! Columns are scaled to unit norm first, columns that vanished are left out (they are not scaled up from rounding),
//! and R comes from Householder reflections of the rows, never from JᵀJ.

use super::equations::vanished;
use super::triangle::Triangle;
use faer::Mat;

/// Singular values below this part of the largest are zero.
pub const RANK_TOLERANCE: f64 = 1e-9;

/// An unknown with a smaller share of a unit null vector than this does not take part in it, but for rounding.
const LOST_SHARE: f64 = 1e-6;

/// `J = U S Vᵀ D` of the columns that exist.
#[derive(Debug, Clone)]
pub struct Decomposition {
    unknowns: usize,
    /// unknowns whose columns exist
    pub kept: Vec<usize>,
    /// norm of each kept column
    pub norms: Vec<f64>,
    /// singular values, descending
    pub singular_values: Vec<f64>,
    /// how many of them count
    pub rank: usize,
    /// the symmetries, orthonormal in scaled coordinates over the kept columns
    pub known: Vec<Vec<f64>>,
    u: Mat<f64>,
    v: Mat<f64>,
}

impl Decomposition {
    /// From the triangle of the first `unknowns` columns; `symmetries` are directions over the unknowns that are known to
    /// change nothing that could be measured, and are taken out.
    pub fn new(triangle: &Triangle, unknowns: usize, natural_scale: &[f64], symmetries: &[&[f64]]) -> Decomposition {
        let all_norms = &triangle.column_norms()[..unknowns];
        let gone = vanished(all_norms, natural_scale);
        let kept: Vec<usize> = (0..unknowns).filter(|&j| !gone[j]).collect();
        let norms: Vec<f64> = kept.iter().map(|&j| all_norms[j]).collect();
        let n = kept.len();
        let mut scaled =
            Mat::from_fn(unknowns, n, |i, j| if i <= kept[j] { triangle.at(i, kept[j]) / norms[j] } else { 0.0 });
        let scaled_symmetry = |direction: &&[f64]| (0..n).map(|j| direction[kept[j]] * norms[j]).collect();
        let known = orthonormal(symmetries.iter().map(scaled_symmetry).collect(), &[]);
        for direction in &known {
            let along = faer::Col::from_fn(n, |j| direction[j]);
            let image = &scaled * &along;
            scaled -= &image * along.transpose();
        }
        let (u, singular_values, v) = match scaled.thin_svd() {
            Ok(svd) => {
                let s = svd.S().column_vector();
                (svd.U().to_owned(), (0..n).map(|i| s[i]).collect(), svd.V().to_owned())
            }
            // only a matrix with NaN or infinity has no decomposition: nothing is determined
            Err(_) => (Mat::zeros(unknowns, n), vec![0.0; n], Mat::identity(n, n)),
        };
        let largest = singular_values.first().copied().unwrap_or(0.0);
        let rank = singular_values.iter().filter(|&&s| s > RANK_TOLERANCE * largest && s > 0.0).count();
        Decomposition { unknowns, kept, norms, singular_values, rank, known, u, v }
    }

    /// For each unknown, whether it takes part in a direction that is not determined.
    pub fn lost(&self) -> Vec<bool> {
        let mut lost = vec![true; self.unknowns];
        for (a, &unknown) in self.kept.iter().enumerate() {
            lost[unknown] = (self.rank..self.kept.len()).any(|i| self.v[(a, i)].abs() > LOST_SHARE);
        }
        lost
    }

    /// An orthonormal basis of what is lost beside the known symmetries, scaled coordinates, over the kept columns.
    pub fn null_vectors(&self) -> Vec<Vec<f64>> {
        let null = (self.rank..self.kept.len()).map(|i| self.vector(i)).collect();
        orthonormal(null, &self.known)
    }

    /// An orthonormal basis of the `count` directions that the readings see least beside the known symmetries.
    pub fn least_seen(&self, count: usize) -> Vec<Vec<f64>> {
        let first = self.kept.len().saturating_sub(count + self.known.len());
        let last = (first..self.kept.len()).rev().map(|i| self.vector(i)).collect();
        let mut least = orthonormal(last, &self.known);
        least.truncate(count);
        least
    }

    /// A vector of scaled coordinates over the kept columns as physical ones over all unknowns.
    pub fn physical(&self, scaled: &[f64]) -> Vec<f64> {
        let mut direction = vec![0.0; self.unknowns];
        for ((&unknown, norm), v) in self.kept.iter().zip(&self.norms).zip(scaled) {
            direction[unknown] = v / norm;
        }
        direction
    }

    /// Singular vector `i` in scaled coordinates, over the kept columns.
    pub fn vector(&self, i: usize) -> Vec<f64> {
        (0..self.kept.len()).map(|j| self.v[(j, i)]).collect()
    }

    /// How far each unknown may be off along singular direction `i`, physical; sigma: of a whitened residual.
    pub fn u_along(&self, i: usize, sigma: f64) -> Vec<f64> {
        let factor = sigma / self.singular_values[i];
        self.physical(&self.vector(i)).into_iter().map(|step| factor * step).collect()
    }

    /// `J⁺ b` for `b` given as a column of the triangle: minimum norm in scaled coordinates, over all unknowns.
    pub fn pseudo_solve(&self, triangle: &Triangle, column: usize) -> Vec<f64> {
        let rows = self.unknowns.min(column + 1);
        let mut solution = vec![0.0; self.unknowns];
        for i in 0..self.rank {
            let dot: f64 = (0..rows).map(|r| self.u[(r, i)] * triangle.at(r, column)).sum();
            let factor = dot / self.singular_values[i];
            for (j, &unknown) in self.kept.iter().enumerate() {
                solution[unknown] += factor * self.v[(j, i)] / self.norms[j];
            }
        }
        solution
    }

    /// How much of a column's sum of squares the unknowns explain.
    pub fn explained(&self, triangle: &Triangle, column: usize) -> f64 {
        let rows = self.unknowns.min(column + 1);
        let along = |i: usize| (0..rows).map(|r| self.u[(r, i)] * triangle.at(r, column)).sum::<f64>();
        (0..self.rank).map(|i| along(i).powi(2)).sum()
    }

    /// The diagonal of `(JᵀJ)⁺`, over all unknowns.
    pub fn variances(&self) -> Vec<f64> {
        let mut variances = vec![0.0; self.unknowns];
        for (a, &unknown) in self.kept.iter().enumerate() {
            let part = |i: usize| (self.v[(a, i)] / (self.singular_values[i] * self.norms[a])).powi(2);
            variances[unknown] = (0..self.rank).map(part).sum();
        }
        variances
    }

    /// `(JᵀJ)⁺`, row-major over all unknowns.
    pub fn covariance(&self) -> Vec<f64> {
        let n = self.kept.len();
        let half = Mat::from_fn(n, self.rank, |j, i| self.v[(j, i)] / (self.singular_values[i] * self.norms[j]));
        let full = &half * half.transpose();
        let mut covariance = vec![0.0; self.unknowns * self.unknowns];
        for (a, &i) in self.kept.iter().enumerate() {
            for (b, &j) in self.kept.iter().enumerate() {
                covariance[i * self.unknowns + j] = full[(a, b)];
            }
        }
        covariance
    }
}

/// What is left of some vectors beside `others`, orthonormal (Gram and Schmidt, twice); dependent ones are dropped.
fn orthonormal(vectors: Vec<Vec<f64>>, others: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut v in vectors {
        let size = dot(&v, &v).sqrt();
        for _ in 0..2 {
            for other in others.iter().chain(&basis) {
                let along = dot(&v, other);
                v.iter_mut().zip(other).for_each(|(x, o)| *x -= along * o);
            }
        }
        let left = dot(&v, &v).sqrt();
        if left > 1e-3 * size {
            v.iter_mut().for_each(|x| *x /= left);
            basis.push(v);
        }
    }
    basis
}
