//! What an arm carries, as the kernels use it.

use crate::arm::Compliance;

/// Masses and centres.
#[derive(Debug, Clone)]
pub(super) struct Carried {
    /// mass times centre of the body that moves with each joint, kg mm
    pub(super) first_moments: Vec<[f64; 3]>,
    /// mass of all that moves with each joint, kg
    pub(super) masses: Vec<f64>,
    /// gravity, N m for each kg mm
    pub(super) pull: [f64; 3],
}

impl Carried {
    pub(super) fn new(compliance: &Compliance) -> Carried {
        let bodies = &compliance.bodies;
        let beyond = |i: usize| bodies[i..].iter().map(|body| body.mass_kg).sum();
        Carried {
            first_moments: bodies.iter().map(|body| body.centre_mm.map(|c| c * body.mass_kg)).collect(),
            masses: (0..bodies.len()).map(beyond).collect(),
            pull: compliance.pull(),
        }
    }
}
