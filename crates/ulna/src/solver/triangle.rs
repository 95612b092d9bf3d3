//! The triangular factor of all rows, by Householder reflections block after block.

use super::equations::{BLOCK_ROWS, RowBlock, RowSink};
use super::reflect::fold_into;
use crate::simd::Columns;
use faer::Mat;

/// `R` of `[J r] = Q R`, built while the rows stream by; never `JᵀJ`.
#[derive(Debug, Clone)]
pub struct Triangle {
    unknowns: usize,
    /// row-major, (unknowns + 1) square; below the diagonal zero
    top: Vec<f64>,
    work: Columns,
    order: Vec<usize>,
}

impl Triangle {
    /// Without rows, for a number of unknowns.
    pub fn new(unknowns: usize) -> Triangle {
        let side = unknowns + 1;
        Triangle {
            unknowns,
            top: vec![0.0; side * side],
            work: Columns::zeros(side, BLOCK_ROWS),
            order: (0..side).collect(),
        }
    }

    /// For how many unknowns it is.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Entry of R; column `unknowns` is `Qᵀr`.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.top[i * (self.unknowns + 1) + j]
    }

    /// The first `columns` rows and columns of R.
    pub fn leading(&self, columns: usize) -> Mat<f64> {
        Mat::from_fn(columns, columns, |i, j| if i <= j { self.at(i, j) } else { 0.0 })
    }

    /// Euclidean norm of each column of J.
    pub fn column_norms(&self) -> Vec<f64> {
        let norm = |j: usize| (0..=j).map(|i| self.at(i, j).powi(2)).sum::<f64>().sqrt();
        (0..self.unknowns).map(norm).collect()
    }
}

impl RowSink for Triangle {
    fn fold(&mut self, block: &mut RowBlock) {
        let rows = 0..block.rows;
        for j in 0..self.unknowns {
            self.work.column_mut(j)[rows.clone()].fill(0.0);
        }
        for &(column, target) in &block.targets {
            self.work.column_mut(target)[rows.clone()].copy_from_slice(&block.columns.column(column)[rows.clone()]);
        }
        let residual = &block.columns.column(block.residual)[rows.clone()];
        self.work.column_mut(self.unknowns)[rows.clone()].copy_from_slice(residual);
        fold_into(&mut self.top, self.unknowns + 1, &mut self.work, &self.order, rows);
    }
}
