//! Derivatives of touches along given directions, by vectors of readings.

use super::model::Model;
use super::touches::Touches;
use crate::kinematics::batch::{forward, gradient, scratch_len};
use crate::kinematics::{Chain, Poses};
use crate::simd::{Columns, Lanes, padded};
use pulp::{Arch, Simd, WithSimd};

/// Readings whose derivatives are computed together.
pub(super) const TILE: usize = 32;

/// Along which directions of the base frame the derivatives of each reading are asked for.
pub(super) trait Directions {
    /// How many.
    const COUNT: usize;

    /// The points that move, from the tip, in the probe's frame, mm: the derivatives along the directions of all of them
    /// are added up. The tip alone tells where it is; three points tell how the last link is turned.
    const POINTS_MM: &'static [[f64; 3]] = &[[0.0; 3]];

    /// Number `component` at a point for vector `k` of readings.
    fn direction<S: Simd>(&self, simd: S, point: usize, component: usize, k: usize) -> [Lanes<S>; 3];
}

impl<D: Directions> Directions for &D {
    const COUNT: usize = D::COUNT;
    const POINTS_MM: &'static [[f64; 3]] = D::POINTS_MM;

    #[inline(always)]
    fn direction<S: Simd>(&self, simd: S, point: usize, component: usize, k: usize) -> [Lanes<S>; 3] {
        (**self).direction(simd, point, component, k)
    }
}

/// Derivatives of some readings.
pub(super) struct Tile {
    /// the tip of each reading, mm
    tips: Columns,
    /// for each direction, the columns of a chain
    values: Columns,
    columns: usize,
}

impl Tile {
    pub fn new(touches: &Touches, model: &Model, directions: usize) -> Tile {
        let columns = model.chain.turn_column() + 1;
        Tile { tips: touches.tip_of_each(model), values: Columns::zeros(directions * columns, TILE), columns }
    }

    /// Takes the derivatives of readings `start..`.
    pub fn fill<D: Directions>(
        &mut self,
        touches: &Touches,
        chain: &Chain,
        directions: &D,
        start: usize,
        scratch: &mut Vec<f64>,
    ) {
        scratch.resize(scratch_len(chain), 0.0);
        Arch::new().dispatch(TileOp { chain, poses: &touches.poses, directions, start, tile: self, scratch });
    }

    /// One derivative along one direction, for the readings of the tile.
    pub fn values(&self, direction: usize, column: usize) -> &[f64] {
        self.values.column(direction * self.columns + column)
    }
}

struct TileOp<'a, D> {
    chain: &'a Chain,
    poses: &'a Poses,
    directions: &'a D,
    start: usize,
    tile: &'a mut Tile,
    scratch: &'a mut [f64],
}

impl<D: Directions> WithSimd for TileOp<'_, D> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let rows = TILE.min(padded(self.poses.q_rad().rows()) - self.start);
        let columns = self.tile.columns;
        for v in 0..rows / S::F64_LANES {
            let k = self.start / S::F64_LANES + v;
            for (point, from_tip) in D::POINTS_MM.iter().enumerate() {
                let at = |j: usize| self.tile.tips.load(simd, j, k) + Lanes::splat(simd, from_tip[j]);
                let tip = [at(0), at(1), at(2)];
                forward(simd, self.chain, self.poses, k, tip, self.scratch);
                for component in 0..D::COUNT {
                    let direction = self.directions.direction(simd, point, component, k);
                    let values = &mut self.tile.values;
                    gradient(
                        simd,
                        self.chain,
                        self.scratch,
                        direction,
                        #[inline(always)]
                        |column, value| {
                            let column = component * columns + column;
                            let before = if point == 0 { None } else { Some(values.load(simd, column, v)) };
                            values.store(column, v, before.map_or(value, |before| before + value));
                        },
                    );
                }
            }
        }
    }
}
