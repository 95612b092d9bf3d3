//! What is not known exactly of an artefact.

use crate::arm::Unit;

/// A dimension of an artefact that is not known exactly: common to all its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// What it is, as a parameter's name: `artefact.ball.diameter`.
    pub name: String,
    /// What it is measured in.
    pub unit: Unit,
    /// Its calibrated value.
    pub value: f64,
    /// The standard uncertainty of that; 0 of a fitted dimension of which nothing is known.
    pub u: f64,
    /// Whether it is an unknown of the fit (with its calibration as prior, where u is not 0), or stays at its value, and
    /// what is not known of it goes into the covariance.
    pub fitted: bool,
}

impl Dimension {
    /// Whether it is an unknown of which nothing is known.
    pub fn is_free(&self) -> bool {
        self.fitted && self.u == 0.0
    }
}

/// Which unknown each parameter and dimension is, if any.
#[derive(Debug, Clone, Default)]
pub struct Unknowns {
    /// For each parameter of the arm.
    pub parameters: Vec<Option<usize>>,
    /// For the dimensions of the readings at hand.
    pub dimensions: Vec<Option<usize>>,
}
