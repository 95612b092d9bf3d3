//! Eccentric encoders: an error that repeats with the encoder's turn.

use super::effect::Effect;
use crate::arm::unit::Unit;

/// `q_i + Σ_k c_ik cos k q_i + s_ik sin k q_i` in place of each encoder angle `q_i`.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonics {
    /// The orders k, ascending from 1.
    pub orders: Vec<u32>,
    /// Cosine and sine amplitude, rad: for each joint, for each order.
    pub amplitudes_rad: Vec<[f64; 2]>,
}

impl Harmonics {
    /// Of `joints` encoders, all amplitudes zero.
    pub fn zero(orders: &[u32], joints: usize) -> Harmonics {
        Harmonics { orders: orders.to_vec(), amplitudes_rad: vec![[0.0; 2]; orders.len() * joints] }
    }

    /// Order and amplitudes of one joint.
    pub fn of_joint(&self, joint: usize) -> impl Iterator<Item = (u32, [f64; 2])> + '_ {
        let own = &self.amplitudes_rad[joint * self.orders.len()..][..self.orders.len()];
        self.orders.iter().copied().zip(own.iter().copied())
    }

    /// What is added to a joint's encoder angle, rad.
    pub fn added_rad(&self, joint: usize, q_rad: f64) -> f64 {
        self.of_joint(joint)
            .map(|(k, [c, s])| c * (f64::from(k) * q_rad).cos() + s * (f64::from(k) * q_rad).sin())
            .sum()
    }

    /// Derivative of [`Self::added_rad`] with respect to the encoder angle.
    pub fn slope(&self, joint: usize, q_rad: f64) -> f64 {
        let of = |(k, [c, s]): (u32, [f64; 2])| {
            let k = f64::from(k);
            k * (s * (k * q_rad).cos() - c * (k * q_rad).sin())
        };
        self.of_joint(joint).map(of).sum()
    }
}

impl Effect for Harmonics {
    fn names(&self) -> Vec<String> {
        let each = |joint: usize| {
            self.orders.iter().flat_map(move |k| ["c", "s"].map(|part| format!("joint.{}.{part}{k}", joint + 1)))
        };
        (0..self.joints()).flat_map(each).collect()
    }

    fn unit(&self) -> Unit {
        Unit::Rad
    }

    fn values(&self) -> Vec<f64> {
        self.amplitudes_rad.as_flattened().to_vec()
    }

    fn set(&mut self, values: &[f64]) {
        self.amplitudes_rad.as_flattened_mut().copy_from_slice(values);
    }

    fn joints(&self) -> usize {
        self.amplitudes_rad.len() / self.orders.len().max(1)
    }
}
