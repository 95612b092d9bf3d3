//! The arm where readings are looked at.

use crate::arm::Arm;
use crate::kinematics::Chain;

/// The numbers of an arm as the residuals use them.
#[derive(Debug, Clone)]
pub struct Model {
    /// The joints, and what the arm does beyond its geometry.
    pub chain: Chain,
    /// The tip of each probe, mm.
    pub tips_mm: Vec<[f64; 3]>,
}

impl Model {
    /// From an arm.
    pub fn new(arm: &Arm) -> Model {
        Model { chain: Chain::new(arm), tips_mm: arm.probes().iter().map(|p| p.tip_mm).collect() }
    }

    /// Takes other parameters, in the arm's order.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let (joints, rest) = parameters.split_at(self.chain.joint_parameter_count());
        let (tips, effects) = rest.split_at(3 * self.tips_mm.len());
        self.chain.set_parameters(joints, effects);
        for (tip, p) in self.tips_mm.iter_mut().zip(tips.chunks_exact(3)) {
            tip.copy_from_slice(p);
        }
    }
}

/// Where readings are looked at: an arm's numbers, and those of the artefact's dimensions.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    /// The arm.
    pub model: &'a Model,
    /// The dimensions of the group's artefact, in the order of [`super::Readings::dimensions`].
    pub dimensions: &'a [f64],
}
