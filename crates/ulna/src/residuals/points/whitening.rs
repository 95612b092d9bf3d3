//! Weights of touches: the inverse root of each reading's covariance.

use super::Points;
use super::rows::{TILE, Tile};
use crate::residuals::{Model, Noise};
use crate::simd::{Columns, Lanes};
use nalgebra::{Matrix3, Vector3};
use pulp::Simd;

/// `W` with `WᵀW = Σ⁻¹`, lower triangular.
#[derive(Debug, Clone)]
pub(super) enum Whitening {
    /// The same in all directions, for all readings.
    Same(f64),
    /// Row by row of the triangle: six columns.
    Each(Columns),
}

impl Whitening {
    /// For the stated noise at these parameters; without noise every reading weighs one.
    pub fn for_noise(points: &Points, model: &Model, noise: Option<&Noise>) -> Whitening {
        let Some(noise) = noise else {
            return Whitening::Same(1.0);
        };
        if noise.encoder_rad.iter().all(|&sigma| sigma == 0.0) {
            return Whitening::Same(if noise.seat_mm > 0.0 { noise.seat_mm.recip() } else { 1.0 });
        }
        let count = points.order.len();
        let joint_columns = model.chain.joint_parameter_count();
        let mut tile = Tile::new(points, model);
        let mut scratch = Vec::new();
        let mut whitening = Columns::zeros(6, count);
        for start in (0..count).step_by(TILE) {
            tile.fill(points, model, &Whitening::Same(1.0), start, &mut scratch);
            for i in 0..TILE.min(count - start) {
                let mut sigma = Matrix3::from_diagonal_element(noise.seat_mm.powi(2));
                for (encoder, s) in noise.encoder_rad.iter().enumerate() {
                    let last = 4 * encoder >= joint_columns;
                    let column = if last { joint_columns + 3 } else { 4 * encoder };
                    let moved = Vector3::from_fn(|c, _| s * tile.values(c, column)[i]);
                    sigma += moved * moved.transpose();
                }
                for (k, value) in whitener(sigma).into_iter().enumerate() {
                    whitening.column_mut(k)[start + i] = value;
                }
            }
        }
        Whitening::Each(whitening)
    }

    /// One weight for all: that of the mean variance of `count` readings.
    pub fn even(self, count: usize) -> Whitening {
        let variance = |row: usize| 3.0 / self.at(row).norm_squared();
        let mean = (0..count).map(variance).sum::<f64>() / count.max(1) as f64;
        Whitening::Same(mean.sqrt().recip())
    }

    /// `W` of one reading.
    pub fn at(&self, row: usize) -> Matrix3<f64> {
        match self {
            Whitening::Same(w) => Matrix3::from_diagonal_element(*w),
            Whitening::Each(w) => {
                let at = |k: usize| w.column(k)[row];
                Matrix3::new(at(0), 0.0, 0.0, at(1), at(2), 0.0, at(3), at(4), at(5))
            }
        }
    }

    /// Row `component` of `W` for vector `k` of readings: the direction whose residual it weighs.
    #[inline(always)]
    pub fn direction<S: Simd>(&self, simd: S, component: usize, k: usize) -> [Lanes<S>; 3] {
        let mut direction = [Lanes::splat(simd, 0.0); 3];
        match self {
            Whitening::Same(w) => direction[component] = Lanes::splat(simd, *w),
            Whitening::Each(w) => {
                let row = component * (component + 1) / 2;
                for (j, value) in direction.iter_mut().enumerate().take(component + 1) {
                    *value = w.load(simd, row + j, k);
                }
            }
        }
        direction
    }

    /// Whether all directions and readings weigh alike.
    pub fn is_isotropic(&self) -> bool {
        matches!(self, Whitening::Same(_))
    }

    /// Those of some readings.
    pub fn picked(&self, rows: &[usize]) -> Whitening {
        match self {
            Whitening::Same(w) => Whitening::Same(*w),
            Whitening::Each(w) => Whitening::Each(w.picked(rows)),
        }
    }
}

/// Lower triangle of `L⁻¹` with `Σ = L Lᵀ`, row by row. Where the stated noise leaves a direction without any, the
/// direction gets a millionth of the others' variance: a weight must stay finite.
fn whitener(sigma: Matrix3<f64>) -> [f64; 6] {
    let sigma = sigma + Matrix3::from_diagonal_element(1e-6 * sigma.trace() / 3.0);
    let inverse = sigma.cholesky().and_then(|c| c.l().try_inverse()).unwrap_or_else(Matrix3::identity);
    [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)].map(|at| inverse[at])
}
