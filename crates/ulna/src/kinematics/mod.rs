//! The forward map and its derivatives, twice: as the formula reads ([`tip_mm`], [`jacobian`]), and in [`batch`] over many
//! readings at once.
//!
//! ```text
//! turn_i = sign_i q_i - theta0_i                         and what the arm's effects add
//! p_base = T_1 T_2 … T_{n-1} Rz(turn_n) tip              or, with a full last link, T_1 … T_n tip
//! T_i    = Rz(turn_i) Tz(d_i) Tx(a_i) Rx(alpha_i)        Denavit-Hartenberg
//! T_i    = Rz(turn_i) Tx(a_i) Rx(alpha_i) Ry(beta_i)     Hayati
//! ```

pub mod batch;
mod chain;
mod conditions;
mod plain;
mod poses;

use crate::arm::Encoder;
pub use chain::Chain;
pub use conditions::Conditions;
pub use plain::{encoder_jacobian, frames, jacobian, tip_mm};
pub use poses::{Angles, Poses};

/// Encoder angles of one pose, and what was true at it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<'a> {
    /// One for each encoder, rad.
    pub q_rad: &'a [f64],
    /// Of this one pose.
    pub conditions: Conditions<'a>,
}

impl Pose<'_> {
    /// Temperature of a joint's link above 20 °C.
    pub fn warmth_k(&self, joint: usize) -> f64 {
        match self.conditions.warmth_k {
            [] => 0.0,
            [all] => *all,
            each => each[joint],
        }
    }

    /// What a joint's encoder said.
    pub(crate) fn encoder(&self, joint: usize) -> Encoder {
        let approach = self.conditions.approach.get(joint).copied().unwrap_or(0.0);
        Encoder { q_rad: self.q_rad[joint], approach }
    }
}

impl<'a, T: AsRef<[f64]> + ?Sized> From<&'a T> for Pose<'a> {
    fn from(q_rad: &'a T) -> Self {
        Pose { q_rad: q_rad.as_ref(), conditions: Conditions::default() }
    }
}

/// A pose of a reading, and the probe that took it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Index of the probe.
    pub probe: usize,
    /// Encoder angles, rad.
    pub q_rad: Vec<f64>,
    /// As in [`Conditions`].
    pub warmth_k: Vec<f64>,
    /// As in [`Conditions`].
    pub approach: Vec<f64>,
}

impl Sample {
    /// The pose alone.
    pub fn pose(&self) -> Pose<'_> {
        let conditions = Conditions { warmth_k: &self.warmth_k, approach: &self.approach };
        Pose { q_rad: &self.q_rad, conditions }
    }
}
