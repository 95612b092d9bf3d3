//! Eccentric encoders: an error that repeats with the encoder's turn.

use super::effect::{Effect, FromStated};
use super::on_encoder::{Encoder, EncoderLanes, OnEncoder};
use super::stated::Stated;
use crate::arm::unit::Unit;
use crate::error::{Error, Result};
use crate::simd::Lanes;
use pulp::Simd;
use std::ops::Range;

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
}

impl Effect for Harmonics {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.amplitudes_rad.len() / self.orders.len().max(1)
    }

    fn suffixes(&self, _: usize) -> Vec<String> {
        self.orders.iter().flat_map(|k| ["c", "s"].map(|part| format!("{part}{k}"))).collect()
    }

    fn unit(&self) -> Unit {
        Unit::Rad
    }

    fn values(&self) -> &[f64] {
        self.amplitudes_rad.as_flattened()
    }

    fn values_mut(&mut self) -> &mut [f64] {
        self.amplitudes_rad.as_flattened_mut()
    }

    fn moves_mm(&self, reach_mm: f64) -> f64 {
        reach_mm
    }

    fn known(&self, angle_rad: f64) -> f64 {
        angle_rad
    }

    fn check(&self) -> Result<()> {
        let ascend = self.orders.first() >= Some(&1) && self.orders.windows(2).all(|pair| pair[0] < pair[1]);
        if ascend { Ok(()) } else { Err(Error::Orders(self.orders.clone())) }
    }
}

impl FromStated for Harmonics {
    const KIND: &'static str = "encoder-harmonics";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        let order = |value: f64| {
            let whole = value.fract() == 0.0 && (1.0..=1e6).contains(&value);
            let expected = "a whole number from 1 to 1e6";
            let slip = || Error::OutOfRange { what: "an order of harmonics".into(), value, expected };
            whole.then_some(value as u32).ok_or_else(slip)
        };
        let orders: Vec<u32> = given.take_list("orders")?.into_iter().map(order).collect::<Result<_>>()?;
        let amplitudes_rad = given.take("amplitudes_rad", &[joints, orders.len(), 2])?;
        let amplitudes_rad = amplitudes_rad.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        Ok(Harmonics { orders, amplitudes_rad })
    }
}

impl OnEncoder for Harmonics {
    fn shapes(&self, _: usize, at: Encoder) -> Vec<f64> {
        self.orders.iter().flat_map(|&k| [(f64::from(k) * at.q_rad).cos(), (f64::from(k) * at.q_rad).sin()]).collect()
    }

    fn slopes(&self, _: usize, at: Encoder) -> Vec<f64> {
        let each = |&k: &u32| {
            let k = f64::from(k);
            [-k * (k * at.q_rad).sin(), k * (k * at.q_rad).cos()]
        };
        self.orders.iter().flat_map(each).collect()
    }

    fn of_joint(&self, joint: usize) -> Range<usize> {
        let each = 2 * self.orders.len();
        joint * each..(joint + 1) * each
    }

    /// cos kq and sin kq from cos q and sin q, order by order.
    #[inline(always)]
    fn shapes_in_lanes<S: Simd>(
        &self,
        _: S,
        _: usize,
        at: &impl EncoderLanes<S>,
        mut each: impl FnMut(usize, Lanes<S>),
    ) {
        let (sin_q, cos_q) = at.sin_cos();
        let (mut sin, mut cos, mut order) = (sin_q, cos_q, 1);
        for (number, &k) in self.orders.iter().enumerate() {
            while order < k {
                (sin, cos) = (sin.mul_add(cos_q, cos * sin_q), sin.neg_mul_add(sin_q, cos * cos_q));
                order += 1;
            }
            each(2 * number, cos);
            each(2 * number + 1, sin);
        }
    }
}
