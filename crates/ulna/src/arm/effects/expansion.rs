//! Links that grow with temperature.

use super::effect::Effect;
use crate::arm::unit::Unit;

/// `a_i`, `d_i` and, of the last joint, the tip, scaled by `1 + ε_i (T_i - 20 °C)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// ε of the link after each joint, 1/K; the last is that of the probe (and of its link, if it has one).
    pub per_kelvin: Vec<f64>,
}

impl Effect for Expansion {
    fn names(&self) -> Vec<String> {
        (1..=self.per_kelvin.len()).map(|joint| format!("joint.{joint}.expansion")).collect()
    }

    fn unit(&self) -> Unit {
        Unit::PerKelvin
    }

    fn values(&self) -> Vec<f64> {
        self.per_kelvin.clone()
    }

    fn set(&mut self, values: &[f64]) {
        self.per_kelvin.copy_from_slice(values);
    }

    fn joints(&self) -> usize {
        self.per_kelvin.len()
    }
}
