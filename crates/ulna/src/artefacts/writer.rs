//! Equations on their way to the solver.

use super::model::Model;
use crate::error::{Error, Result};
use crate::kinematics::batch::scratch_len;
use crate::monitor::Monitor;
use crate::simd::Columns;
use crate::solver::{BLOCK_ROWS, RowBlock, RowSink};

/// Collects equations into blocks and hands full ones to a sink.
pub struct Writer<'a> {
    /// The block being filled.
    pub block: RowBlock,
    /// Scratch of the kernels.
    pub scratch: [Vec<f64>; 2],
    sink: &'a mut dyn RowSink,
    monitor: &'a dyn Monitor,
    rows_since_asked: usize,
}

/// Buffers that outlive a [`Writer`].
#[derive(Debug, Default)]
pub struct Buffers {
    columns: Columns,
    targets: Vec<(usize, usize)>,
    scratch: [Vec<f64>; 2],
    capacity: usize,
}

impl<'a> Writer<'a> {
    /// A writer of rows with at most `columns` columns, on borrowed buffers.
    pub fn new(
        buffers: &mut Buffers,
        columns: usize,
        model: &Model,
        sink: &'a mut dyn RowSink,
        monitor: &'a dyn Monitor,
    ) -> Writer<'a> {
        if buffers.capacity < columns {
            buffers.columns = Columns::zeros(columns, BLOCK_ROWS);
            buffers.capacity = columns;
        }
        let need = scratch_len(&model.chain);
        for scratch in &mut buffers.scratch {
            scratch.resize(need, 0.0);
        }
        Writer {
            block: RowBlock {
                columns: std::mem::take(&mut buffers.columns),
                rows: 0,
                targets: std::mem::take(&mut buffers.targets),
                residual: 0,
            },
            scratch: std::mem::take(&mut buffers.scratch),
            sink,
            monitor,
            rows_since_asked: 0,
        }
    }

    /// Gives the buffers back.
    pub fn finish(mut self, buffers: &mut Buffers) -> Result<()> {
        let result = self.flush();
        buffers.columns = self.block.columns;
        buffers.targets = self.block.targets;
        buffers.scratch = self.scratch;
        result
    }

    /// Starts rows of another layout.
    pub fn layout(&mut self, residual: usize, targets: impl Iterator<Item = (usize, usize)>) -> Result<()> {
        self.flush()?;
        self.block.residual = residual;
        self.block.targets.clear();
        self.block.targets.extend(targets);
        Ok(())
    }

    /// Hands the block to the sink.
    pub fn flush(&mut self) -> Result<()> {
        if self.block.rows > 0 {
            self.sink.fold(&mut self.block);
            self.rows_since_asked += self.block.rows;
            self.block.rows = 0;
            if self.rows_since_asked >= ROWS_BETWEEN_QUESTIONS {
                self.rows_since_asked = 0;
                if !self.monitor.keep_going() {
                    return Err(Error::Interrupted);
                }
            }
        }
        Ok(())
    }

    /// Makes room for `rows` more in the block.
    pub fn reserve(&mut self, rows: usize) -> Result<()> {
        if self.block.rows + rows > BLOCK_ROWS {
            self.flush()?;
        }
        Ok(())
    }
}

/// A millisecond of work or less.
const ROWS_BETWEEN_QUESTIONS: usize = 1 << 15;
