//! The weight of each touch for the stated noise: what the encoders' noise does at the tip, the seat's, and the feature's.

use crate::artefacts::at_tips::{AT_ONCE, AtTips, whitener};
use crate::artefacts::model::Model;
use crate::artefacts::noise::Noise;
use crate::artefacts::touches::Touches;
use crate::artefacts::whitening::Whitening;
use crate::simd::Columns;

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
    let mut tips = AtTips::new(model);
    let mut whitening = Columns::zeros(6, count);
    for start in (0..count).step_by(AT_ONCE) {
        tips.look(model, &touches.poses, |row| touches.probe[row], Some(noise), start);
        for row in start..count.min(start + AT_ONCE) {
            for (k, value) in whitener(&tips.covariance(row - start, own(row))).into_iter().enumerate() {
                whitening.column_mut(k)[row] = value;
            }
        }
    }
    Whitening::Each(whitening)
}
