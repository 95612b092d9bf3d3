//! The normal equations, accumulated in tiles of four columns by four.
//!
//! They square the condition number. That is known and accepted where they are used: for steps on the way to the
//! minimum, whose gradient stays exact, never for rank or covariance.

use super::{RowBlock, RowSink};
use crate::kinematics::lanes::Lanes;
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
        Gram {
            unknowns,
            matrix: vec![0.0; side * side],
        }
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
            Some(&(column, target)) => (&block.columns.column(column)[..block.rows], target),
            None => (&block.columns.column(block.residual)[..block.rows], gram.unknowns),
        };
        for a in (0..count).step_by(TILE) {
            let left: [_; TILE] = std::array::from_fn(|i| locate(a + i));
            for b in (0..=a).step_by(TILE) {
                let right: [_; TILE] = std::array::from_fn(|j| locate(b + j));
                let mut sums = [[Lanes::splat(simd, 0.0); TILE]; TILE];
                for k in 0..vectors {
                    let l: [_; TILE] = std::array::from_fn(|i| Lanes::load(simd, left[i].0, k));
                    let r: [_; TILE] = std::array::from_fn(|j| Lanes::load(simd, right[j].0, k));
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
