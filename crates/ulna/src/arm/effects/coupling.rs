//! Joints that turn with other joints' encoders too, as where a controller shows what a motor does and not what a joint does.

use super::effect::{Effect, FromStated};
use super::on_encoder::{Encoder, EncoderLanes, OnEncoder};
use super::stated::Stated;
use crate::arm::unit::Unit;
use crate::error::{Error, Result};
use crate::simd::Lanes;
use pulp::Simd;
use std::f64::consts::PI;
use std::ops::Range;

/// `q_i + Σ_k r_ik q_k` in place of each encoder angle `q_i`: a parallelogram's elbow that a robot's controller shows
/// against the ground, a wrist whose shafts run through each other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Coupling {
    /// Of each joint, the joints whose encoders turn it too.
    pub others: Vec<Vec<usize>>,
    /// r of each of these, joint after joint.
    pub ratios: Vec<f64>,
}

/// Of a ratio, before anybody has measured: gears have teeth, belts slip.
const KNOWN: f64 = 0.01;

impl Coupling {
    /// Every pair: a joint, one whose encoder turns it too, and the ratio.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let each = self.others.iter().enumerate().flat_map(|(joint, others)| others.iter().map(move |&k| (joint, k)));
        each.zip(&self.ratios).map(|((joint, other), &ratio)| (joint, other, ratio))
    }
}

impl Effect for Coupling {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.others.len()
    }

    fn suffixes(&self, joint: usize) -> Vec<String> {
        self.others[joint].iter().map(|other| format!("coupling{}", other + 1)).collect()
    }

    fn unit(&self) -> Unit {
        Unit::One
    }

    fn values(&self) -> &[f64] {
        &self.ratios
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.ratios
    }

    /// By half a turn of the other joint.
    fn moves_mm(&self, reach_mm: f64) -> f64 {
        PI * reach_mm
    }

    fn known(&self, _: f64) -> f64 {
        KNOWN
    }

    fn is_small(&self) -> bool {
        false
    }

    fn check(&self) -> Result<()> {
        let joints = self.others.len();
        for (joint, others) in self.others.iter().enumerate() {
            for (at, &other) in others.iter().enumerate() {
                if other >= joints || other == joint || others[..at].contains(&other) {
                    return Err(Error::OutOfRange {
                        what: format!("a joint that joint {} turns with", joint + 1),
                        value: (other + 1) as f64,
                        expected: "the number of another joint of the arm, once",
                    });
                }
            }
        }
        Ok(())
    }
}

impl FromStated for Coupling {
    const KIND: &'static str = "coupling";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        let ratios = given.take_list("ratios")?;
        let numbers = given.take("joints", &[ratios.len(), 2])?;
        let mut others = vec![vec![]; joints];
        let mut last = 0;
        for pair in numbers.chunks_exact(2) {
            let place = |value: f64| (value.fract() == 0.0 && value >= 0.0).then_some(value as usize);
            match (place(pair[0]), place(pair[1])) {
                (Some(joint), Some(other)) if (last..joints).contains(&joint) => {
                    others[joint].push(other);
                    last = joint;
                }
                _ => {
                    return Err(Error::OutOfRange {
                        what: "a joint of a coupling".into(),
                        value: pair[0],
                        expected: "joints of the arm counted from 0, in their order",
                    });
                }
            }
        }
        Ok(Coupling { others, ratios })
    }
}

impl OnEncoder for Coupling {
    fn of_joint(&self, joint: usize) -> Range<usize> {
        let first = self.others[..joint].iter().map(Vec::len).sum();
        first..first + self.others[joint].len()
    }

    fn shapes(&self, joint: usize, at: Encoder) -> Vec<f64> {
        self.others[joint].iter().map(|&other| at.all_rad[other]).collect()
    }

    fn slopes(&self, joint: usize, _: Encoder) -> Vec<f64> {
        vec![0.0; self.others[joint].len()]
    }

    #[inline(always)]
    fn shapes_in_lanes<S: Simd>(
        &self,
        _: S,
        joint: usize,
        at: &impl EncoderLanes<S>,
        mut each: impl FnMut(usize, Lanes<S>),
    ) {
        for (number, &other) in self.others[joint].iter().enumerate() {
            each(number, at.angle(other));
        }
    }
}
