//! The weight of each touch for the stated noise: what the encoders' noise does at the tip, the seat's, and the feature's.

use super::whitening::Whitening;
use crate::artefacts::model::Model;
use crate::artefacts::noise::Noise;
use crate::artefacts::tile::{TILE, Tile};
use crate::artefacts::touches::Touches;
use crate::simd::Columns;
use nalgebra::{Matrix3, Vector3};

/// For the stated noise at these parameters; without noise every reading weighs one.
pub(super) fn for_noise(touches: &Touches, of_its_own: &[f64], model: &Model, noise: Option<&Noise>) -> Whitening {
    let Some(noise) = noise else {
        return Whitening::Same(1.0);
    };
    let count = touches.len();
    let own = |row: usize| noise.seat_mm.powi(2) + of_its_own[touches.feature[row]];
    if noise.encoder_rad.iter().all(|&sigma| sigma == 0.0) {
        let weight = |variance: f64| if variance > 0.0 { variance.sqrt().recip() } else { 1.0 };
        if of_its_own.iter().all(|&variance| variance == 0.0) {
            return Whitening::Same(weight(noise.seat_mm.powi(2)));
        }
        let each: Vec<f64> = (0..count).map(|row| weight(own(row))).collect();
        return Whitening::Round(Columns::from_rows(&each, 1));
    }
    let chain = &model.chain;
    let mut tile = Tile::new(touches, model, 3);
    let mut scratch = Vec::new();
    let mut whitening = Columns::zeros(6, count);
    for start in (0..count).step_by(TILE) {
        tile.fill(touches, chain, &Whitening::Same(1.0), start, &mut scratch);
        for i in 0..TILE.min(count - start) {
            let mut sigma = Matrix3::from_diagonal_element(own(start + i));
            for (encoder, s) in noise.encoder_rad.iter().enumerate() {
                let column = chain.encoder_column(encoder);
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

/// Lower triangle of `L⁻¹` with `Σ = L Lᵀ`, row by row. Where the stated noise leaves a direction without any, the
/// direction gets a millionth of the others' variance: a weight must stay finite.
fn whitener(sigma: Matrix3<f64>) -> [f64; 6] {
    let sigma = sigma + Matrix3::from_diagonal_element(1e-6 * sigma.trace() / 3.0);
    let inverse = sigma.cholesky().and_then(|c| c.l().try_inverse()).unwrap_or_else(Matrix3::identity);
    [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)].map(|at| inverse[at])
}
