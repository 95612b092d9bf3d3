//! Play between a joint and its encoder: it depends on the side from which a pose was approached where the arm stops.

use super::effect::{Effect, FromStated};
use super::on_encoder::{Encoder, EncoderLanes, OnEncoder};
use super::seen::{Lost, Unseen};
use super::stated::Stated;
use crate::arm::unit::Unit;
use crate::error::Result;
use crate::simd::Lanes;
use pulp::Simd;
use std::ops::Range;

/// `q_i + b_i/2 · s_i` in place of each encoder angle `q_i`, with `s_i` the [approach](crate::kinematics::Conditions).
#[derive(Debug, Clone, PartialEq)]
pub struct Backlash {
    /// b of each joint: the full width of the hysteresis, rad.
    pub rad: Vec<f64>,
}

impl Effect for Backlash {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.rad.len()
    }

    fn suffixes(&self, _: usize) -> Vec<String> {
        vec!["backlash".into()]
    }

    fn unit(&self) -> Unit {
        Unit::Rad
    }

    fn values(&self) -> &[f64] {
        &self.rad
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.rad
    }

    fn moves_mm(&self, reach_mm: f64) -> f64 {
        0.5 * reach_mm
    }

    fn known(&self, angle_rad: f64) -> f64 {
        angle_rad
    }

    fn unseen(&self, lost: &Lost) -> Option<Unseen> {
        let approach = |joint: usize| lost.seen.approach.get(joint).copied().unwrap_or_default();
        let shown = |joint: &usize| lost.hidden != Some(*joint);
        let one_sided = |joint: &usize| approach(*joint).0 == approach(*joint).1;
        let Some(&joint) = lost.joints.iter().filter(|joint| shown(joint)).find(|joint| one_sided(joint)) else {
            // nothing but the first joint turns all that a standing is measured with
            return (lost.alone && lost.joints == [0] && shown(&0)).then(|| Unseen {
                cause: "approach-one-sided",
                because:
                    "joint 1 was approached from one side alone wherever the artefact stood: what its backlash does \
                          looks like the artefact turned about the first axis"
                        .into(),
                remedy:
                    "take readings with joint 1 approached from both sides while the artefact stands still (at the \
                         two ends of a length), or hold joint.1.backlash"
                        .into(),
            });
        };
        let name = joint + 1;
        Some(if approach(joint).0 == 0.0 {
            Unseen {
                cause: "approach-unknown",
                because: format!("the readings do not say from which side joint {name} was approached"),
                remedy: format!(
                    "state with each reading how joint {name} was approached (+1 where its encoder angle had been \
                     rising, -1 where it had been falling), or hold joint.{name}.backlash"
                ),
            }
        } else {
            Unseen {
                cause: "approach-one-sided",
                because: format!(
                    "joint {name} was always approached from the same side: its backlash cannot be told from a shift of \
                     its zero"
                ),
                remedy: format!(
                    "take readings with joint {name} approached from both sides, or hold joint.{name}.backlash"
                ),
            }
        })
    }
}

impl FromStated for Backlash {
    const KIND: &'static str = "backlash";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        Ok(Backlash { rad: given.take("backlash_rad", &[joints])? })
    }
}

impl OnEncoder for Backlash {
    fn shapes(&self, _: usize, at: Encoder) -> Vec<f64> {
        vec![0.5 * at.approach]
    }

    fn slopes(&self, _: usize, _: Encoder) -> Vec<f64> {
        vec![0.0]
    }

    fn of_joint(&self, joint: usize) -> Range<usize> {
        joint..joint + 1
    }

    #[inline(always)]
    fn shapes_in_lanes<S: Simd>(
        &self,
        simd: S,
        _: usize,
        at: &impl EncoderLanes<S>,
        mut each: impl FnMut(usize, Lanes<S>),
    ) {
        each(0, at.approach() * Lanes::splat(simd, 0.5));
    }
}
