//! Equations on their way: blocks of rows, what streams them and what takes them.

use crate::error::Result;
use crate::simd::{Columns, padded};

/// Rows in a block.
pub const BLOCK_ROWS: usize = 256;

/// A batch of equations in columns: derivatives, then the residual, then local unknowns to be eliminated.
#[derive(Debug, Clone)]
pub struct RowBlock {
    /// All columns, [`BLOCK_ROWS`] long; those of rows not in use are stale.
    pub columns: Columns,
    /// Rows in use, a multiple of the vector length; surplus rows are zero.
    pub rows: usize,
    /// Which column holds the derivative with respect to which unknown.
    pub targets: Vec<(usize, usize)>,
    /// Which column holds the residual.
    pub residual: usize,
    /// Which standing of an artefact each row tells of, [`RowBlock::NONE`] for rows that tell nothing; empty where nobody
    /// asked.
    pub standing: Vec<u32>,
}

impl RowBlock {
    /// No standing.
    pub const NONE: u32 = u32::MAX;

    /// Few equations in so many unknowns, each of the derivatives and then the residual; no local unknowns.
    pub fn of_rows(rows: &[Vec<f64>], unknowns: usize) -> RowBlock {
        let mut block = RowBlock {
            columns: Columns::zeros(unknowns + 1, rows.len()),
            rows: padded(rows.len()),
            targets: (0..unknowns).map(|c| (c, c)).collect(),
            residual: unknowns,
            standing: vec![],
        };
        for (k, row) in rows.iter().enumerate() {
            row.iter().enumerate().for_each(|(column, &value)| block.columns.column_mut(column)[k] = value);
        }
        block
    }
}

/// Takes blocks of equations.
pub trait RowSink {
    /// Folds the rows of a block in. The sink may overwrite the block.
    fn fold(&mut self, block: &mut RowBlock);
}

/// A sum of squares to be made small.
pub trait LeastSquares {
    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// For each unknown, how far a unit of it moves a residual at the most, in the residual's unit.
    ///
    /// A column that is smaller than this by ten decades is zero up to rounding: that direction does not exist.
    fn natural_scale(&self) -> &[f64];

    /// A cost that is nothing but rounding.
    fn negligible_cost(&self) -> f64;

    /// Streams every row at `x` into the sink; without the Jacobian the targets are empty.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    fn rows(&mut self, x: &[f64], jacobian: bool, sink: &mut dyn RowSink) -> Result<()>;
}

/// Which columns exist: norms against their natural scale, relative to the largest of these ratios.
pub(crate) fn vanished(norms: &[f64], natural_scale: &[f64]) -> Vec<bool> {
    let ratio = |(norm, scale): (&f64, &f64)| norm / scale;
    let largest = norms.iter().zip(natural_scale).map(ratio).fold(0.0, f64::max);
    let small = |pair| ratio(pair) <= VANISHED * largest;
    norms.iter().zip(natural_scale).map(small).collect()
}

/// Ten decades below its natural size a column is rounding.
const VANISHED: f64 = 1e-10;
