//! Candidates as blocks of rows, and what a block does to an inverse.

/// All candidates: `count` blocks of `each` rows over `unknowns` columns, row-major.
#[derive(Debug, Clone, Copy)]
pub struct Candidates<'a> {
    /// The numbers, whitened: information of a block is `ZᵀZ`.
    pub rows: &'a [f64],
    /// Rows of a block.
    pub each: usize,
    /// Columns.
    pub unknowns: usize,
}

impl<'a> Candidates<'a> {
    /// How many blocks there are.
    pub fn count(&self) -> usize {
        self.rows.len() / (self.each * self.unknowns).max(1)
    }

    /// The rows of one.
    pub fn block(&self, number: usize) -> &'a [f64] {
        let size = self.each * self.unknowns;
        &self.rows[number * size..(number + 1) * size]
    }
}

/// `A B` of row-major matrices, `inner` columns in A and rows in B.
pub(super) fn product(a: &[f64], b: &[f64], inner: usize) -> Vec<f64> {
    let (rows, width) = (a.len() / inner.max(1), b.len() / inner.max(1));
    let mut out = vec![0.0; rows * width];
    for (row, target) in a.chunks_exact(inner.max(1)).zip(out.chunks_exact_mut(width.max(1))) {
        // whole rows at a time: sums of a row would not be taken by vectors
        for (&factor, values) in row.iter().zip(b.chunks_exact(width.max(1))) {
            target.iter_mut().zip(values).for_each(|(t, v)| *t += factor * v);
        }
    }
    out
}

/// `A Bᵀ`, both with `width` columns.
pub(super) fn product_transposed(a: &[f64], b: &[f64], width: usize) -> Vec<f64> {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(p, q)| p * q).sum::<f64>();
    a.chunks_exact(width).flat_map(|x| b.chunks_exact(width).map(move |y| dot(x, y))).collect()
}

/// The lower Cholesky factor of a small matrix; none where it is not positive definite.
pub(super) fn cholesky(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut l = matrix.to_vec();
    for j in 0..n {
        for i in j..n {
            let dot: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let given = l[i * n + j];
            let value = given - dot;
            if i > j {
                l[i * n + j] = value / l[j * n + j];
            } else if value > LEAST_PIVOT * given.abs() {
                l[j * n + j] = value.sqrt();
            } else {
                return None;
            }
        }
        l[j * n + j + 1..(j + 1) * n].fill(0.0);
    }
    Some(l)
}

/// A pivot below this part of the diagonal is rounding: the information has no inverse.
pub(super) const LEAST_PIVOT: f64 = 1e-11;

/// `L⁻¹ B` in place, B row-major of `width` columns.
pub(super) fn solve_lower(l: &[f64], n: usize, b: &mut [f64], width: usize) {
    for i in 0..n {
        let (above, below) = b.split_at_mut(i * width);
        let row = &mut below[..width];
        for k in 0..i {
            let factor = l[i * n + k];
            row.iter_mut().zip(&above[k * width..(k + 1) * width]).for_each(|(r, a)| *r -= factor * a);
        }
        row.iter_mut().for_each(|r| *r /= l[i * n + i]);
    }
}

/// `tr(A⁻¹ B)` of a positive definite A and a symmetric B, which is overwritten, of k rows; none where A is not.
pub(super) fn quotient_trace(a: &[f64], b: &mut [f64], k: usize) -> Option<f64> {
    if k == 1 {
        return Some(b[0] / a[0]);
    }
    let l = cholesky(a, k)?;
    // tr(L⁻¹ B L⁻ᵀ): B is symmetric, so the second solve takes the transposed of the first
    solve_lower(&l, k, b, k);
    let mut turned: Vec<f64> = (0..k * k).map(|i| b[i % k * k + i / k]).collect();
    solve_lower(&l, k, &mut turned, k);
    Some((0..k).map(|i| turned[i * k + i]).sum())
}

/// `aᵀ b`, four sums at a time.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(others.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in fours.zip(others) {
        (0..4).for_each(|i| sums[i] += x[i] * y[i]);
    }
    rest + sums.iter().sum::<f64>()
}

/// The inverse of a positive definite matrix; none where it is not.
pub(super) fn inverse(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let l = cholesky(matrix, n)?;
    let mut half = vec![0.0; n * n];
    (0..n).for_each(|i| half[i * n + i] = 1.0);
    solve_lower(&l, n, &mut half, n);
    let transposed: Vec<f64> = (0..n * n).map(|k| half[k % n * n + k / n]).collect();
    Some(product(&transposed, &half, n))
}

/// The inverse after a block is added (`sign` 1) or taken away (-1), by Woodbury:
/// `C ∓ C Zᵀ (I ± Z C Zᵀ)⁻¹ Z C`. None where what is left would have no inverse.
pub(super) fn updated(c: &[f64], z: &[f64], n: usize, sign: f64) -> Option<Vec<f64>> {
    let k = z.len() / n;
    let mut zc = product(z, c, n);
    let mut inner = product_transposed(&zc, z, n);
    inner.iter_mut().for_each(|value| *value *= sign);
    (0..k).for_each(|i| inner[i * k + i] += 1.0);
    if sign < 0.0 && (0..k).any(|i| inner[i * k + i] < LEAST_LEFT) {
        return None;
    }
    let l = cholesky(&inner, k)?;
    solve_lower(&l, k, &mut zc, n);
    let mut next = c.to_vec();
    for row in zc.chunks_exact(n) {
        for (&factor, target) in row.iter().zip(next.chunks_exact_mut(n)) {
            target.iter_mut().zip(row).for_each(|(t, r)| *t -= sign * factor * r);
        }
    }
    Some(next)
}

/// What may be left of a direction's information when a block goes, so that updates keep their digits.
const LEAST_LEFT: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::samples::{information, some};

    #[test]
    fn an_update_equals_the_inverse_computed_anew() {
        let n = 5;
        for k in 1..4 {
            let (rows, z) = (some(12 * n, 0.3), some(k * n, 1.7));
            let both = [rows.clone(), z.clone()].concat();
            let (without, with) = (information(&rows, n), information(&both, n));
            let (c, expected) = (inverse(&without, n).unwrap(), inverse(&with, n).unwrap());
            let added = updated(&c, &z, n, 1.0).unwrap();
            let back = updated(&added, &z, n, -1.0).unwrap();
            for i in 0..n * n {
                assert!((added[i] - expected[i]).abs() < 1e-12, "{} {}", added[i], expected[i]);
                assert!((back[i] - c[i]).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn what_holds_a_direction_alone_cannot_go() {
        let rows = [1.0, 0.0, 0.0, 1.0];
        let c = inverse(&information(&rows, 2), 2).unwrap();
        assert!(updated(&c, &rows[..2], 2, -1.0).is_none());
        assert!(inverse(&information(&rows[..2], 2), 2).is_none());
    }
}
