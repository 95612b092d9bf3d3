//! One pose, and one of a reading.

use super::conditions::{Conditions, PAYLOAD};
use crate::arm::effects::{Body, Encoder};

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

    /// What the last joint carried beside the arm's own masses.
    pub(crate) fn payload(&self) -> Body {
        match self.conditions.payload.first_chunk::<PAYLOAD>() {
            None => Body::default(),
            Some(&[mass_kg, x, y, z]) => Body { mass_kg, centre_mm: [x, y, z] },
        }
    }

    /// What a joint's encoder said.
    pub(crate) fn encoder(&self, joint: usize) -> Encoder<'_> {
        let approach = self.conditions.approach.get(joint).copied().unwrap_or(0.0);
        Encoder { q_rad: self.q_rad[joint], all_rad: self.q_rad, approach }
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
    /// As in [`Conditions`].
    pub payload: Vec<f64>,
}

impl Sample {
    /// The pose alone.
    pub fn pose(&self) -> Pose<'_> {
        let conditions = Conditions { warmth_k: &self.warmth_k, approach: &self.approach, payload: &self.payload };
        Pose { q_rad: &self.q_rad, conditions }
    }
}
