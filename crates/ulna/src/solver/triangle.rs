//! The triangular factor of all rows, by Householder reflections block after block.

use super::equations::{BLOCK_ROWS, RowBlock, RowSink};
use super::reflect::fold_into;
use crate::simd::{Columns, padded};
use faer::Mat;

/// `R` of `[J r] = Q R`, built while the rows stream by; never `JᵀJ`.
#[derive(Debug, Clone)]
pub struct Triangle {
    unknowns: usize,
    /// row-major, (unknowns + 1) square; below the diagonal zero
    top: Vec<f64>,
    fold: Folding,
}

/// What folding needs beside the triangle.
#[derive(Debug, Clone)]
pub(super) struct Folding {
    work: Columns,
    order: Vec<usize>,
}

impl Folding {
    pub fn new(side: usize) -> Folding {
        Folding { work: Columns::zeros(side, BLOCK_ROWS), order: (0..side).collect() }
    }

    /// Makes `upper` the triangle of both, each row-major and square.
    pub fn both(&mut self, upper: &mut [f64], lower: &[f64]) {
        let side = self.order.len();
        for first in (0..side).step_by(BLOCK_ROWS) {
            let rows = (side - first).min(BLOCK_ROWS);
            for j in 0..side {
                let column = &mut self.work.column_mut(j)[..padded(rows)];
                column.fill(0.0);
                (0..rows).for_each(|i| column[i] = lower[(first + i) * side + j]);
            }
            fold_into(upper, side, &mut self.work, &self.order, 0..padded(rows));
        }
    }
}

impl Triangle {
    /// Without rows, for a number of unknowns.
    pub fn new(unknowns: usize) -> Triangle {
        let side = unknowns + 1;
        Triangle { unknowns, top: vec![0.0; side * side], fold: Folding::new(side) }
    }

    /// From its entries, row-major, (unknowns + 1) square.
    pub(super) fn of_entries(unknowns: usize, entries: Vec<f64>) -> Triangle {
        Triangle { top: entries, ..Triangle::new(unknowns) }
    }

    /// Folds in the rows of another triangle of as many unknowns.
    pub fn fold_triangle(&mut self, other: &Triangle) {
        debug_assert_eq!(self.unknowns, other.unknowns);
        self.fold.both(&mut self.top, &other.top);
    }

    /// Row-major, (unknowns + 1) square; below the diagonal zero.
    pub(super) fn entries(&self) -> &[f64] {
        &self.top
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
        let work = &mut self.fold.work;
        for j in 0..self.unknowns {
            work.column_mut(j)[rows.clone()].fill(0.0);
        }
        for &(column, target) in &block.targets {
            work.column_mut(target)[rows.clone()].copy_from_slice(&block.columns.column(column)[rows.clone()]);
        }
        let residual = &block.columns.column(block.residual)[rows.clone()];
        work.column_mut(self.unknowns)[rows.clone()].copy_from_slice(residual);
        fold_into(&mut self.top, self.unknowns + 1, work, &self.fold.order, rows);
    }
}
