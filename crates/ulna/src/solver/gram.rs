//! The normal equations, accumulated in tiles of four columns by four.
//!
//! They square the condition number. That is known and accepted where they are used: for steps on the way to the
//! minimum, whose gradient stays exact, never for rank or covariance.

use super::equations::{RowBlock, RowSink, vanished};
use crate::simd::Lanes;
use pulp::{Arch, Simd, WithSimd};

/// `[J r]ᵀ [J r]`, lower triangle, row-major.
#[derive(Debug, Clone)]
pub struct Gram {
    unknowns: usize,
    matrix: Vec<f64>,
}

impl Gram {
    /// All zero, for a number of unknowns.
    pub fn new(unknowns: usize) -> Gram {
        let side = unknowns + 1;
        Gram { unknowns, matrix: vec![0.0; side * side] }
    }

    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.matrix.fill(0.0);
    }

    /// `(JᵀJ)_ij`.
    #[inline]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        self.matrix[i * (self.unknowns + 1) + j]
    }

    /// `(Jᵀr)_i`.
    #[inline]
    pub fn gradient(&self, i: usize) -> f64 {
        self.at(self.unknowns, i)
    }

    /// `rᵀr`.
    #[inline]
    pub fn cost(&self) -> f64 {
        self.at(self.unknowns, self.unknowns)
    }
}

/// Smallest pivot of the unit-diagonal matrix of the columns that exist, 1 where they are orthogonal.
pub fn smallest_pivot(gram: &Gram, natural_scale: &[f64]) -> f64 {
    let norms: Vec<f64> = (0..gram.unknowns).map(|j| gram.at(j, j).sqrt()).collect();
    let gone = vanished(&norms, natural_scale);
    let kept: Vec<usize> = (0..gram.unknowns).filter(|&j| !gone[j]).collect();
    let n = kept.len();
    let unit = |i: usize, j: usize| gram.at(kept[i], kept[j]) / (norms[kept[i]] * norms[kept[j]]);
    let mut a: Vec<f64> = (0..n * n).map(|k| unit(k / n, k % n)).collect();
    cholesky(&mut a, n);
    // the root of a pivot that rounding made negative comes out negative, and what follows it means nothing
    let pivot = |i: usize| if a[i * n + i] > 0.0 { a[i * n + i].powi(2) } else { 0.0 };
    (0..n).map(pivot).fold(1.0, f64::min)
}

/// Upper Cholesky factor `A = UᵀU` in place, row-major, so that every inner loop runs along rows. A pivot that is not
/// positive comes out as (nearly) zero.
///
/// Some 25 unknowns are factored here every few microseconds; a general library's call costs more than the work.
pub(super) fn cholesky(a: &mut [f64], n: usize) {
    Arch::new().dispatch(CholeskyOp(&mut a[..n * n], n));
}

struct CholeskyOp<'a>(&'a mut [f64], usize);

impl WithSimd for CholeskyOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let CholeskyOp(a, n) = self;
        for k in 0..n {
            let (pivots, below) = a.split_at_mut((k + 1) * n);
            let pivot_row = &mut pivots[k * n + k..];
            let inverse = 1.0 / pivot_row[0].max(f64::MIN_POSITIVE).sqrt();
            pivot_row.iter_mut().for_each(|u| *u *= inverse);
            for (i, row) in below.chunks_exact_mut(n).enumerate() {
                let factor = pivot_row[i + 1];
                let target = &mut row[k + 1 + i..];
                for (value, u) in target.iter_mut().zip(&pivot_row[i + 1..]) {
                    *value -= factor * u;
                }
            }
        }
    }
}

/// The sum of squares alone.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cost(pub f64);

impl RowSink for Cost {
    fn fold(&mut self, block: &mut RowBlock) {
        let mut gram = Gram::new(0);
        block.targets.clear();
        gram.fold(block);
        self.0 += gram.cost();
    }
}

impl RowSink for Gram {
    fn fold(&mut self, block: &mut RowBlock) {
        Arch::new().dispatch(GramOp { gram: self, block });
    }
}

const TILE: usize = 4;

struct GramOp<'a> {
    gram: &'a mut Gram,
    block: &'a RowBlock,
}

impl WithSimd for GramOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let GramOp { gram, block } = self;
        let side = gram.unknowns + 1;
        let count = block.targets.len() + 1;
        let vectors = block.rows / S::F64_LANES;
        // beyond the last column the residual is taken again and its products are thrown away
        let locate = |i: usize| match block.targets.get(i) {
            Some(&pair) => pair,
            None => (block.residual, gram.unknowns),
        };
        for a in (0..count).step_by(TILE) {
            let left: [_; TILE] = std::array::from_fn(|i| locate(a + i));
            for b in (0..=a).step_by(TILE) {
                let right: [_; TILE] = std::array::from_fn(|j| locate(b + j));
                let mut sums = [[Lanes::splat(simd, 0.0); TILE]; TILE];
                for k in 0..vectors {
                    let l: [_; TILE] = std::array::from_fn(|i| block.columns.load(simd, left[i].0, k));
                    let r: [_; TILE] = std::array::from_fn(|j| block.columns.load(simd, right[j].0, k));
                    for i in 0..TILE {
                        for j in 0..TILE {
                            sums[i][j] = l[i].mul_add(r[j], sums[i][j]);
                        }
                    }
                }
                for i in 0..TILE.min(count - a) {
                    for j in 0..TILE.min(count - b) {
                        if b + j <= a + i {
                            let (high, low) = (left[i].1.max(right[j].1), left[i].1.min(right[j].1));
                            gram.matrix[high * side + low] += sums[i][j].sum();
                        }
                    }
                }
            }
        }
    }
}
