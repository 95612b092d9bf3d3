//! Equations on their way to the solver.

use super::model::Model;
use crate::error::{Error, Result};
use crate::kinematics::batch::scratch_len;
use crate::monitor::Monitor;
use crate::simd::Columns;
use crate::solver::{BLOCK_ROWS, RowBlock, RowSink};
use std::ops::Range;

/// Collects equations into blocks and hands full ones to a sink.
pub struct Writer<'a> {
    /// The block being filled.
    pub block: RowBlock,
    /// Scratch of the kernels.
    pub scratch: [Vec<f64>; 2],
    sink: &'a mut dyn RowSink,
    monitor: &'a dyn Monitor,
    rows_since_asked: usize,
    /// what the standings of the readings at hand are called: from a number on, or each by its own, from there
    first: u32,
    called: Vec<u32>,
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
                standing: vec![],
            },
            scratch: std::mem::take(&mut buffers.scratch),
            sink,
            monitor,
            rows_since_asked: 0,
            first: 0,
            called: vec![],
        }
    }

    /// Asks for the standing that each row tells of, and for as many rows as it tells: those that its placement takes are
    /// left out.
    pub fn ask_standings(&mut self) {
        self.block.standing = vec![RowBlock::NONE; BLOCK_ROWS];
    }

    /// Whether they are asked for.
    pub fn standings_asked(&self) -> bool {
        !self.block.standing.is_empty()
    }

    /// Counts standings from here on.
    pub fn count_from(&mut self, first: usize) {
        self.first = first as u32;
    }

    /// Streams readings whose standings are called so.
    pub fn calling(&mut self, names: &[u32], stream: impl FnOnce(&mut Writer<'a>) -> Result<()>) -> Result<()> {
        if self.standings_asked() {
            self.called = names.to_vec();
        }
        let streamed = stream(self);
        self.called.clear();
        streamed
    }

    /// Says which standing some rows of the block tell of, where that is asked.
    pub fn tell(&mut self, rows: Range<usize>, standing: impl Fn(usize) -> usize) {
        if !self.standings_asked() {
            return;
        }
        for (k, row) in rows.enumerate() {
            let number = standing(k);
            self.block.standing[row] = self.first + self.called.get(number).copied().unwrap_or(number as u32);
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
            self.block.standing.fill(RowBlock::NONE);
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
