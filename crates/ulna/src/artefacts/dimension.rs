//! What is not known exactly of an artefact.

use crate::arm::Unit;

/// An instrument that is wrong by a larger part than this is no instrument.
const SCALE: f64 = 1e-3;

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
    /// How far a unit of it moves a tip at the most, mm.
    pub fn moves_mm(&self, reach_mm: f64) -> f64 {
        if self.unit == Unit::Mm { 1.0 } else { reach_mm }
    }

    /// How well it is known before any reading, where lengths and angles are known so well.
    pub fn known(&self, length_mm: f64, angle_rad: f64) -> f64 {
        match self.unit {
            Unit::Mm => length_mm,
            Unit::Rad => angle_rad,
            _ => SCALE,
        }
    }

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
