//! Columns of numbers, laid out for vectors.

use super::lanes::{Lanes, padded};
use pulp::Simd;

/// Equally long columns of numbers, each padded with zeros to whole vectors.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    pub(crate) data: Vec<f64>,
    pub(crate) stride: usize,
    rows: usize,
}

impl Columns {
    /// Columns of zeros.
    pub fn zeros(columns: usize, rows: usize) -> Columns {
        let stride = padded(rows);
        Columns { data: vec![0.0; columns * stride], stride, rows }
    }

    /// Columns from row-major data of `columns` numbers a row.
    pub fn from_rows(row_major: &[f64], columns: usize) -> Columns {
        let mut result = Columns::zeros(columns, row_major.len() / columns);
        result.fill_from_rows(row_major, columns);
        result
    }

    pub(crate) fn fill_from_rows(&mut self, row_major: &[f64], columns: usize) {
        for (column, values) in self.data.chunks_exact_mut(self.stride.max(1)).take(columns).enumerate() {
            for (value, row) in values.iter_mut().zip(row_major.chunks_exact(columns)) {
                *value = row[column];
            }
        }
    }

    /// Some rows of row-major data of `columns` numbers a row, in the order given.
    pub(crate) fn gathered(row_major: &[f64], columns: usize, rows: &[usize]) -> Columns {
        let mut gathered = Columns::zeros(columns, rows.len());
        for j in 0..columns {
            for (value, &row) in gathered.column_mut(j).iter_mut().zip(rows) {
                *value = row_major[row * columns + j];
            }
        }
        gathered
    }

    /// Some rows, in the order given.
    pub(crate) fn picked(&self, rows: &[usize]) -> Columns {
        let mut picked = Columns::zeros(self.width(), rows.len());
        for column in 0..self.width() {
            for (value, &row) in picked.column_mut(column).iter_mut().zip(rows) {
                *value = self.column(column)[row];
            }
        }
        picked
    }

    /// Number of columns.
    #[inline(always)]
    pub fn width(&self) -> usize {
        self.data.len() / self.stride.max(1)
    }

    /// Number of rows, the padding left out.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Vector `k` of a column.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&self, simd: S, column: usize, k: usize) -> Lanes<S> {
        Lanes::load(simd, &self.data, column * (self.stride / S::F64_LANES) + k)
    }

    /// Replaces vector `k` of a column.
    #[inline(always)]
    pub(crate) fn store<S: Simd>(&mut self, column: usize, k: usize, value: Lanes<S>) {
        value.store(&mut self.data, column * (self.stride / S::F64_LANES) + k);
    }

    /// Number of rows, the padding included.
    pub fn padded_rows(&self) -> usize {
        self.stride
    }

    /// One column with its padding.
    #[inline(always)]
    pub fn column(&self, index: usize) -> &[f64] {
        &self.data[index * self.stride..][..self.stride]
    }

    /// One column with its padding, to write to.
    #[inline(always)]
    pub fn column_mut(&mut self, index: usize) -> &mut [f64] {
        &mut self.data[index * self.stride..][..self.stride]
    }
}
