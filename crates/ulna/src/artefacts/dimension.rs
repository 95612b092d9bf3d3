//! What is not known exactly of an artefact.

/// A dimension of an artefact that is not known exactly: common to all its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// What it is, as a parameter's name: `artefact.ball.diameter`.
    pub name: String,
    /// Its calibrated value, mm.
    pub value_mm: f64,
    /// The standard uncertainty of that, mm; 0 of a fitted dimension of which nothing is known.
    pub u_mm: f64,
    /// Whether it is an unknown of the fit (with its calibration as prior, where u is not 0), or stays at its value, and
    /// what is not known of it goes into the covariance.
    pub fitted: bool,
}

/// Which unknown each parameter and dimension is, if any.
#[derive(Debug, Clone, Default)]
pub struct Unknowns {
    /// For each parameter of the arm.
    pub parameters: Vec<Option<usize>>,
    /// For the dimensions of the readings at hand.
    pub dimensions: Vec<Option<usize>>,
}
