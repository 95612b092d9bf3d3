//! What is known of parameters before any reading. Knows no kinematics.

/// A parameter's value as known before, with its standard uncertainty: one more equation of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Index of the parameter.
    pub parameter: usize,
    /// Its value, in the parameter's unit.
    pub value: f64,
    /// The standard uncertainty of that.
    pub u: f64,
}
