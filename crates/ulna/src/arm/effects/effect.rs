//! What a cause has to say.

use crate::arm::unit::Unit;

/// The parameters of one cause, joint after joint.
pub trait Effect {
    /// Names such as `joint.3.c1`.
    fn names(&self) -> Vec<String>;
    /// What they are all measured in.
    fn unit(&self) -> Unit;
    /// Their values.
    fn values(&self) -> Vec<f64>;
    /// Takes other values.
    fn set(&mut self, values: &[f64]);
    /// Number of joints.
    fn joints(&self) -> usize;
}
