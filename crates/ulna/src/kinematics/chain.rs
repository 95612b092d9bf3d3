//! An arm's geometry as the kernels use it.

use crate::arm::{Arm, JointModel};

/// One joint's numbers as the kernels use them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Link {
    pub(crate) theta0: f64,
    pub(crate) sign: f64,
    pub(crate) cos_theta0: f64,
    pub(crate) sin_theta0: f64,
    pub(crate) cos_alpha: f64,
    pub(crate) sin_alpha: f64,
    pub(crate) a: f64,
    pub(crate) d: f64,
    /// cosine and sine of beta, for a Hayati joint
    pub(crate) beta: Option<(f64, f64)>,
}

/// An arm's geometry with its sines and cosines taken, ready for the kernels.
#[derive(Debug, Clone)]
pub struct Chain {
    pub(crate) links: Vec<Link>,
}

impl Chain {
    /// The chain of an arm, its probes left out.
    pub fn new(arm: &Arm) -> Chain {
        let links = arm.joints().iter().map(|j| Link {
            theta0: j.theta0_rad,
            sign: j.sign,
            cos_theta0: j.theta0_rad.cos(),
            sin_theta0: j.theta0_rad.sin(),
            cos_alpha: j.alpha_rad.cos(),
            sin_alpha: j.alpha_rad.sin(),
            a: j.a_mm,
            d: if j.model == JointModel::Dh { j.d_mm } else { 0.0 },
            beta: (j.model == JointModel::Hayati).then(|| (j.beta_rad.cos(), j.beta_rad.sin())),
        });
        let last = Link {
            theta0: 0.0,
            sign: arm.signs().last().unwrap_or(1.0),
            cos_theta0: 1.0,
            sin_theta0: 0.0,
            cos_alpha: 1.0,
            sin_alpha: 0.0,
            a: 0.0,
            d: 0.0,
            beta: None,
        };
        Chain { links: links.chain([last]).collect() }
    }

    /// Takes other numbers for the joints, four a joint in the order of [`Arm::parameters`].
    pub fn set_joint_parameters(&mut self, parameters: &[f64]) {
        for (link, p) in self.links.iter_mut().zip(parameters.chunks_exact(4)) {
            link.theta0 = p[0];
            (link.sin_theta0, link.cos_theta0) = p[0].sin_cos();
            (link.sin_alpha, link.cos_alpha) = p[1].sin_cos();
            link.a = p[2];
            match &mut link.beta {
                Some((cos_beta, sin_beta)) => (*sin_beta, *cos_beta) = p[3].sin_cos(),
                None => link.d = p[3],
            }
        }
    }

    /// Number of encoders.
    pub fn encoders(&self) -> usize {
        self.links.len()
    }

    /// Number of parameters of the joints.
    pub fn joint_parameter_count(&self) -> usize {
        4 * (self.links.len() - 1)
    }
}
