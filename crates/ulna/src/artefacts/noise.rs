//! What is random in a reading.

use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Standard deviations of what is random in a reading.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Noise {
    /// Of each encoder, rad; empty for none.
    pub encoder_rad: Vec<f64>,
    /// Of a touch, per coordinate, mm.
    pub seat_mm: f64,
}

/// How a reading's directions are weighed against each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weighing {
    /// All alike: at parameters that are far off, the directions of the encoders' noise are not known yet.
    Even,
    /// By the noise in each.
    Full,
}

/// A standard normal number.
pub(crate) fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    StandardNormal.sample(rng)
}
