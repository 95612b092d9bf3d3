//! What the equations of all placed artefacts share: derivatives out of a tile, and the elimination of a standing.

use super::dimension::Unknowns;
use super::model::Model;
use super::tile::Tile;
use super::writer::Writer;
use crate::error::Result;
use crate::simd::padded;
use crate::solver::RowBlock;
use crate::solver::reflect::fold_into;
use std::ops::Range;

/// The most unknowns that a standing has: those of a pose.
pub(super) const MOST_OWN: usize = 6;

/// Columns of a block of touches: the arm's parameters, the artefact's dimensions, the residual, the standing's unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    /// Where the dimensions begin.
    pub dimensions: usize,
    /// The residual.
    pub residual: usize,
}

impl Layout {
    pub fn new(model: &Model, dimensions: usize) -> Layout {
        let parameters = model.chain.parameter_columns() + 3 * (model.tips_mm.len() - 1);
        Layout { dimensions: parameters, residual: parameters + dimensions }
    }

    /// Which columns are of which unknown.
    pub fn targets(self, unknowns: &Unknowns) -> impl Iterator<Item = (usize, usize)> {
        let unknown = move |column: usize| match column {
            c if c < self.dimensions => unknowns.parameters[c],
            c => unknowns.dimensions[c - self.dimensions],
        };
        (0..self.residual).filter_map(move |c| Some((c, unknown(c)?)))
    }
}

/// Some readings of one standing within a tile, and where their equations go: component after component.
pub(super) struct Place<'a> {
    tile: &'a Tile,
    /// the first reading of the tile
    start: usize,
    /// the readings, counted in the tile
    in_tile: Range<usize>,
    /// their probes
    probe: &'a [usize],
    /// equations of each reading
    components: usize,
    /// rows of the block
    pub used: Range<usize>,
}

impl<'a> Place<'a> {
    /// Makes room for the equations of readings `rows` of a tile that begins at `start`.
    pub fn reserve(
        out: &mut Writer,
        tile: &'a Tile,
        start: usize,
        rows: Range<usize>,
        probe: &'a [usize],
        components: usize,
    ) -> Result<Place<'a>> {
        let length = padded(components * rows.len());
        out.reserve(length)?;
        let used = out.block.rows..out.block.rows + length;
        out.block.rows = used.end;
        let in_tile = rows.start - start..rows.end - start;
        Ok(Place { tile, start, in_tile, probe: &probe[rows], components, used })
    }

    /// The readings themselves.
    fn rows(&self) -> impl Iterator<Item = usize> {
        self.in_tile.clone().map(|row| self.start + row)
    }

    /// Writes a column, reading by reading.
    pub fn write<const C: usize>(&self, block: &mut RowBlock, column: usize, value: impl Fn(usize) -> [f64; C]) {
        let target = &mut block.columns.column_mut(column)[self.used.clone()];
        let count = self.in_tile.len();
        target[C * count..].fill(0.0);
        for (i, row) in self.rows().enumerate() {
            let values = value(row);
            (0..C).for_each(|c| target[c * count + i] = values[c]);
        }
    }

    /// Writes the columns of the standing's unknowns behind the residual.
    pub fn write_own<const C: usize>(
        &self,
        block: &mut RowBlock,
        unknowns: usize,
        values: impl Fn(usize, &mut [[f64; C]; MOST_OWN]),
    ) {
        let (first, count) = (block.residual + 1, self.in_tile.len());
        for k in 0..unknowns {
            block.columns.column_mut(first + k)[self.used.clone()][C * count..].fill(0.0);
        }
        let stride = block.columns.stride;
        let target = &mut block.columns.data[first * stride + self.used.start..];
        let mut own = [[0.0; C]; MOST_OWN];
        for (i, row) in self.rows().enumerate() {
            values(row, &mut own);
            for (k, derivative) in own[..unknowns].iter().enumerate() {
                (0..C).for_each(|c| target[k * stride + c * count + i] = derivative[c]);
            }
        }
    }

    /// Writes the derivatives with respect to the arm's parameters; clears the other targets' columns.
    pub fn write_parameters(&self, block: &mut RowBlock, model: &Model, layout: Layout) {
        let m = self.in_tile.len();
        let joints = model.chain.joint_parameter_count();
        let probes = model.tips_mm.len();
        for &(column, _) in &block.targets {
            let target = &mut block.columns.column_mut(column)[self.used.clone()];
            target.fill(0.0);
            let own_column = match column {
                c if c < joints => c,
                c if c < joints + 3 * probes => {
                    let (probe, axis) = ((c - joints) / 3, (c - joints) % 3);
                    for (i, _) in self.probe.iter().enumerate().filter(|(_, p)| **p == probe) {
                        for component in 0..self.components {
                            target[component * m + i] =
                                self.tile.values(component, joints + axis)[self.in_tile.start + i];
                        }
                    }
                    continue;
                }
                c if c < layout.dimensions => c - 3 * (probes - 1),
                _ => continue,
            };
            for component in 0..self.components {
                let values = &self.tile.values(component, own_column)[self.in_tile.clone()];
                target[component * m..(component + 1) * m].copy_from_slice(values);
            }
        }
    }
}

/// What of the standing being streamed has been folded away so far.
#[derive(Default)]
pub(super) struct Eliminated {
    top: Vec<f64>,
    order: Vec<usize>,
    pivots: usize,
    /// pivots that took a row, where rows are taken
    seen: usize,
}

impl Eliminated {
    /// Begins a standing of so many unknowns, whose columns stand behind the residual.
    pub fn begin(&mut self, unknowns: usize, block: &RowBlock) {
        (self.pivots, self.seen) = (unknowns, 0);
        self.order.clear();
        self.order.extend(block.residual + 1..block.residual + 1 + unknowns);
        self.order.extend(block.targets.iter().map(|&(column, _)| column));
        self.order.push(block.residual);
        self.top.clear();
        self.top.resize(unknowns * self.order.len(), 0.0);
    }

    /// The same, and the unknowns take a row each with them, the first of these that are left: it comes out as zero. Returns
    /// how many rows went.
    pub fn take_out(&mut self, block: &mut RowBlock, used: Range<usize>, rows: usize) -> usize {
        let width = self.order.len();
        fold_into(&mut self.top, self.seen, &mut block.columns, &self.order, used.clone());
        let mut gone = 0;
        while gone < rows {
            // an unknown that no row shows yet waits for one that does
            let shown =
                |&k: &usize| block.columns.column(self.order[k])[used.clone()].iter().any(|&value| value != 0.0);
            let Some(next) = (self.seen..self.pivots).find(shown) else { break };
            self.order.swap(self.seen, next);
            (0..self.seen).for_each(|row| self.top.swap(row * width + self.seen, row * width + next));
            let order = &self.order[self.seen..];
            let pivot = &mut self.top[self.seen * (width + 1)..(self.seen + 1) * width];
            self.seen += 1;
            for (value, &column) in pivot.iter_mut().zip(order) {
                *value = std::mem::take(&mut block.columns.column_mut(column)[used.start + gone]);
            }
            gone += 1;
            fold_into(pivot, 1, &mut block.columns, order, used.clone());
        }
        gone
    }

    /// Takes what the standing's unknowns explain out of some rows.
    pub fn fold(&mut self, block: &mut RowBlock, used: Range<usize>) {
        fold_into(&mut self.top, self.pivots, &mut block.columns, &self.order, used);
    }
}
