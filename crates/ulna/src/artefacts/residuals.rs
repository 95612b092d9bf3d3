//! Residuals as a person reads them, and as a loss judges them.

/// Residuals of a group of readings in the order they were given.
#[derive(Debug, Clone, PartialEq)]
pub struct Unweighted {
    /// Numbers of one reading: 3 for a point, 1 for a length or a surface.
    pub components: usize,
    /// Row-major, mm: tip minus the feature's place, distance minus length, or distance from the surface.
    pub residuals_mm: Vec<f64>,
    /// Root of the weight of each reading, 1/mm: equal in effect where it differs by direction.
    pub weights: Vec<f64>,
}

/// How far each reading is off, in units of its stated noise (mm where none is stated), a loss's weights left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Whitened {
    /// Norm of each reading's whitened residual, in the order they were given.
    pub norms: Vec<f64>,
    /// How many degrees of freedom it has: its equations less what its placement takes of them.
    pub freedoms: Vec<f64>,
}

/// A placement that takes more than this part of its readings' equations tells no reading from another.
const FOLLOWS: f64 = 0.5;

/// Where a placement follows its few readings so closely that it could make any of them look wrong, all are judged as one:
/// they share what is left of them. (A bar touched once at each end is one length, and neither end is worse.)
pub(super) fn shared(norms: &mut [f64], freedoms: &mut [f64], components: usize) {
    let count = norms.len() as f64;
    let left = freedoms.iter().sum::<f64>() / count;
    if left < FOLLOWS * components as f64 {
        let norm = (norms.iter().map(|norm| norm * norm).sum::<f64>() / count).sqrt();
        norms.fill(norm);
        freedoms.fill(left);
    }
}
