//! Links that grow with temperature.

use super::effect::{Effect, FromStated};
use super::seen::{Lost, Unseen};
use super::stated::Stated;
use crate::arm::unit::Unit;
use crate::error::Result;

/// `a_i`, `d_i` and, of the last joint, the tip, scaled by `1 + ε_i (T_i - 20 °C)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// ε of the link after each joint, 1/K; the last is that of the probe (and of its link, if it has one).
    pub per_kelvin: Vec<f64>,
}

/// How many kelvin a workshop's temperature changes, in round figures.
const SOME_KELVIN: f64 = 10.0;
/// Temperatures closer than this are the same, K.
const STILL_K: f64 = 1e-3;
/// What is known of any engineering material: none expands by more than this, 1/K.
const MOST_PER_K: f64 = 3e-5;

impl Effect for Expansion {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.per_kelvin.len()
    }

    fn suffixes(&self, _: usize) -> Vec<String> {
        vec!["expansion".into()]
    }

    fn unit(&self) -> Unit {
        Unit::PerKelvin
    }

    fn values(&self) -> &[f64] {
        &self.per_kelvin
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.per_kelvin
    }

    fn moves_mm(&self, reach_mm: f64) -> f64 {
        reach_mm * SOME_KELVIN
    }

    fn known(&self, _: f64) -> f64 {
        MOST_PER_K
    }

    fn unseen(&self, lost: &Lost) -> Option<Unseen> {
        let as_warm = lost.seen.warmth_k.is_none_or(|(low, high)| high - low < STILL_K);
        as_warm.then(|| Unseen {
            cause: "temperature-still",
            because: "the temperature was the same in all readings: a warmer link cannot be told from a longer one"
                .into(),
            remedy:
                "take readings at other temperatures, or hold joint.*.expansion (at the material's, in the arm file)"
                    .into(),
        })
    }
}

impl FromStated for Expansion {
    const KIND: &'static str = "link-expansion";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        Ok(Expansion { per_kelvin: given.take("expansion_per_k", &[joints])? })
    }
}
