//! Derivatives of touches, by vectors of readings.

use super::Points;
use super::whitening::Whitening;
use crate::kinematics::Chain;
use crate::kinematics::batch::{forward, gradient, scratch_len};
use crate::residuals::Model;
use crate::simd::{Columns, padded};
use pulp::{Arch, Simd, WithSimd};

/// Readings whose derivatives are computed together.
pub(super) const TILE: usize = 32;

/// Whitened derivatives of some readings.
pub(super) struct Tile {
    /// the tip of each reading, mm
    tips: Columns,
    /// for each component, the joints' parameters, x, y, z of the tip, and the last joint's turn
    values: Columns,
    pub columns: usize,
}

impl Tile {
    pub fn new(points: &Points, model: &Model) -> Tile {
        let columns = model.chain.joint_parameter_count() + 4;
        Tile { tips: points.tip_of_each(model), values: Columns::zeros(3 * columns, TILE), columns }
    }

    /// Takes the derivatives of readings `start..`.
    pub fn fill(
        &mut self,
        points: &Points,
        model: &Model,
        whitening: &Whitening,
        start: usize,
        scratch: &mut Vec<f64>,
    ) {
        scratch.resize(scratch_len(&model.chain), 0.0);
        Arch::new().dispatch(TileOp { chain: &model.chain, points, whitening, start, tile: self, scratch });
    }

    /// One derivative of one component, for the readings of the tile.
    pub fn values(&self, component: usize, column: usize) -> &[f64] {
        self.values.column(component * self.columns + column)
    }
}

struct TileOp<'a> {
    chain: &'a Chain,
    points: &'a Points,
    whitening: &'a Whitening,
    start: usize,
    tile: &'a mut Tile,
    scratch: &'a mut [f64],
}

impl WithSimd for TileOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let rows = TILE.min(padded(self.points.order.len()) - self.start);
        let columns = self.tile.columns;
        for v in 0..rows / S::F64_LANES {
            let k = self.start / S::F64_LANES + v;
            let tip = [0, 1, 2].map(|j| self.tile.tips.load(simd, j, k));
            forward(simd, self.chain, &self.points.poses, k, tip, self.scratch);
            for component in 0..3 {
                let direction = self.whitening.direction(simd, component, k);
                gradient(simd, self.chain, self.scratch, direction, |column, value| {
                    self.tile.values.store(component * columns + column, v, value);
                });
            }
        }
    }
}
