//! The equations of touches: derivatives by vectors of readings, then standing by standing.

use super::features::Frame;
use super::placement::Placement;
use super::touched::Points;
use crate::artefacts::dimension::Unknowns;
use crate::artefacts::model::At;
use crate::artefacts::rows::{Eliminated, Layout, Place};
use crate::artefacts::tile::{TILE, Tile};
use crate::artefacts::writer::Writer;
use crate::error::Result;
use crate::simd::{Columns, padded};
use nalgebra::{Isometry3, Vector3};
use std::ops::Range;

/// Readings of one standing within a tile.
struct Segment<'a> {
    points: &'a Points,
    placement: &'a Placement,
    pose: &'a Isometry3<f64>,
    /// tips of all readings, base frame
    p: &'a Columns,
    features_mm: &'a [Vector3<f64>],
    rows: Range<usize>,
}

/// Streams all equations: see [`crate::artefacts::Readings::stream`].
pub(super) fn stream(points: &Points, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
    let layout = Layout::new(at.model, points.dimensions.len());
    out.layout(layout.residual, layout.targets(unknowns).filter(|_| jacobian))?;
    let p = points.touches.tips(at.model);
    let features_mm = points.features_at(at.dimensions_mm);
    let poses = points.placement_poses(&p, &features_mm);
    let touches = &points.touches;
    let mut tile = Tile::new(touches, at.model, 3);
    let mut eliminated = Eliminated::default();
    let mut current = 0;
    for start in (0..touches.len()).step_by(TILE) {
        let end = touches.len().min(start + TILE);
        if jacobian {
            tile.fill(touches, &at.model.chain, points.weights(), start, &mut out.scratch[0]);
        }
        let mut row = start;
        while row < end {
            let (placement, standing) = (&points.placements[current], &touches.standings[current]);
            let rows = row..end.min(standing.end);
            let segment = Segment { points, placement, pose: &poses[current], p: &p, features_mm: &features_mm, rows };
            let used = segment.write_residuals(out)?;
            if jacobian {
                let place = Place {
                    tile: &tile,
                    in_tile: row - start..segment.rows.end - start,
                    probe: &touches.probe[segment.rows.clone()],
                    components: 3,
                    used: used.clone(),
                };
                place.write_parameters(&mut out.block, at.model, layout);
                segment.write_dimensions(out, layout, &used);
            }
            if jacobian && points.frame == Frame::Free {
                if row == standing.start {
                    eliminated.begin(placement.unknowns(), &out.block);
                }
                segment.write_local(out, &used);
                eliminated.fold(&mut out.block, used);
            }
            row = segment.rows.end;
            if row == standing.end {
                current += 1;
            }
        }
    }
    out.flush()
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
            let touch = self.points.touch(self.p, self.features_mm, row);
            let whitened = touch.whiten * touch.residual(self.pose);
            for c in 0..3 {
                residual[c * m + i] = whitened[c];
            }
        }
        Ok(used)
    }

    /// Writes the derivatives with respect to the artefact's dimensions.
    fn write_dimensions(&self, out: &mut Writer, layout: Layout, used: &Range<usize>) {
        let Segment { points, rows, .. } = self;
        let m = rows.len();
        let block = &mut out.block;
        for &(column, _) in block.targets.iter().filter(|(column, _)| *column >= layout.dimensions) {
            let target = &mut block.columns.column_mut(column)[used.clone()];
            let (feature, direction) = points.moves[column - layout.dimensions];
            for i in (0..m).filter(|i| points.touches.feature[rows.start + i] == feature) {
                let moved = -points.weights().at(rows.start + i) * (self.pose.rotation * direction);
                for c in 0..3 {
                    target[c * m + i] = moved[c];
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
            let touch = self.points.touch(self.p, self.features_mm, row);
            for (k, derivative) in self.placement.derivatives(self.pose, &touch).into_iter().enumerate() {
                let column = &mut out.block.columns.column_mut(first + k)[used.clone()];
                for c in 0..3 {
                    column[c * m + i] = derivative[c];
                }
            }
        }
    }
}
