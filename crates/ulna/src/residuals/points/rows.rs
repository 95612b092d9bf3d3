//! The equations of touches: derivatives by vectors of readings, then placement by placement.

use super::placement::Placement;
use super::tile::{TILE, Tile};
use super::{Frame, Points};
use crate::error::Result;
use crate::residuals::{Model, Unknowns, Writer};
use crate::simd::{Columns, padded};
use crate::solver::reflect::fold_into;
use nalgebra::Isometry3;
use std::ops::Range;

/// Readings of one placement within a tile.
struct Segment<'a> {
    points: &'a Points,
    placement: &'a Placement,
    pose: &'a Isometry3<f64>,
    /// tips of all readings, base frame
    p: &'a Columns,
    rows: Range<usize>,
}

/// Streams all equations: see [`crate::residuals::Readings::stream`].
pub(super) fn stream(
    points: &Points,
    model: &Model,
    unknowns: &Unknowns,
    jacobian: bool,
    out: &mut Writer,
) -> Result<()> {
    let parameters = model.chain.joint_parameter_count() + 3 * model.tips_mm.len();
    let residual = parameters + points.considered.len();
    let unknown = |column: usize| match column {
        c if c < parameters => unknowns.parameters[c],
        c => unknowns.considered[c - parameters],
    };
    let targets = (0..residual).filter_map(|c| Some((c, unknown(c)?)));
    out.layout(residual, targets.filter(|_| jacobian))?;
    let p = points.tips(model);
    let poses = points.placement_poses(&p);
    let mut tile = Tile::new(points, model);
    let mut eliminated = Eliminated::default();
    let mut at = 0;
    for start in (0..points.order.len()).step_by(TILE) {
        let end = points.order.len().min(start + TILE);
        if jacobian {
            tile.fill(points, model, &points.whitening, start, &mut out.scratch[0]);
        }
        let mut row = start;
        while row < end {
            let placement = &points.placements[at];
            let segment =
                Segment { points, placement, pose: &poses[at], p: &p, rows: row..end.min(placement.rows.end) };
            let used = segment.write_residuals(out)?;
            if jacobian {
                segment.write_derivatives(out, &tile, start, &used);
            }
            if jacobian && points.frame == Frame::Free {
                if row == placement.rows.start {
                    eliminated.begin(placement.unknowns(), &out.block.targets, residual);
                }
                segment.write_local(out, &used);
                let pivots = placement.unknowns();
                fold_into(&mut eliminated.top, pivots, &mut out.block.columns, &eliminated.order, used);
            }
            row = segment.rows.end;
            if row == placement.rows.end {
                at += 1;
            }
        }
    }
    out.flush()
}

/// What of the placement being streamed has been folded away so far.
#[derive(Default)]
struct Eliminated {
    top: Vec<f64>,
    order: Vec<usize>,
}

impl Eliminated {
    fn begin(&mut self, unknowns: usize, targets: &[(usize, usize)], residual: usize) {
        self.order.clear();
        self.order.extend(residual + 1..residual + 1 + unknowns);
        self.order.extend(targets.iter().map(|&(column, _)| column));
        self.order.push(residual);
        self.top.clear();
        self.top.resize(unknowns * self.order.len(), 0.0);
    }
}

impl Segment<'_> {
    /// Makes room in the block and writes the whitened residuals, component after component; returns the rows used.
    fn write_residuals(&self, out: &mut Writer) -> Result<Range<usize>> {
        let m = self.rows.len();
        let length = padded(3 * m);
        out.reserve(length)?;
        let used = out.block.rows..out.block.rows + length;
        out.block.rows = used.end;
        let residual = &mut out.block.columns.column_mut(out.block.residual)[used.clone()];
        residual.fill(0.0);
        for (i, row) in self.rows.clone().enumerate() {
            let touch = self.points.touch(self.p, row);
            let whitened = touch.whiten * touch.residual(self.pose);
            for c in 0..3 {
                residual[c * m + i] = whitened[c];
            }
        }
        Ok(used)
    }

    /// Writes the derivatives with respect to the unknowns; the tile begins with reading `start`.
    fn write_derivatives(&self, out: &mut Writer, tile: &Tile, start: usize, used: &Range<usize>) {
        let Segment { points, rows, .. } = self;
        let m = rows.len();
        let in_tile = rows.start - start..rows.end - start;
        let joint_columns = tile.columns - 4;
        let block = &mut out.block;
        let parameters = block.residual - points.considered.len();
        for &(column, _) in &block.targets {
            let target = &mut block.columns.column_mut(column)[used.clone()];
            target.fill(0.0);
            if column < joint_columns {
                for c in 0..3 {
                    target[c * m..(c + 1) * m].copy_from_slice(&tile.values(c, column)[in_tile.clone()]);
                }
            } else if column < parameters {
                let (probe, axis) = ((column - joint_columns) / 3, (column - joint_columns) % 3);
                for i in (0..m).filter(|i| points.probe[rows.start + i] == probe) {
                    for c in 0..3 {
                        target[c * m + i] = tile.values(c, joint_columns + axis)[in_tile.start + i];
                    }
                }
            } else {
                let (feature, direction) = points.considered_moves[column - parameters];
                for i in (0..m).filter(|i| points.feature[rows.start + i] == feature) {
                    let moved = -points.whitening.at(rows.start + i) * (self.pose.rotation * direction);
                    for c in 0..3 {
                        target[c * m + i] = moved[c];
                    }
                }
            }
        }
    }

    /// Writes the placement's own columns behind the residual.
    fn write_local(&self, out: &mut Writer, used: &Range<usize>) {
        let m = self.rows.len();
        let first = out.block.residual + 1;
        for k in 0..self.placement.unknowns() {
            out.block.columns.column_mut(first + k)[used.clone()].fill(0.0);
        }
        for (i, row) in self.rows.clone().enumerate() {
            let touch = self.points.touch(self.p, row);
            for (k, derivative) in self.placement.derivatives(self.pose, &touch).into_iter().enumerate() {
                let column = &mut out.block.columns.column_mut(first + k)[used.clone()];
                for c in 0..3 {
                    column[c * m + i] = derivative[c];
                }
            }
        }
    }
}
