//! What a shape of a surface owes.

use crate::artefacts::dimension::Dimension;
use nalgebra::Vector3;

/// Unknowns of a standing: a centre, or two tilts and a distance.
pub(super) const UNKNOWNS: usize = 3;

/// A ball tip on a surface.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// The ball's centre, base frame, mm.
    pub p_mm: Vector3<f64>,
    /// The ball's radius, mm.
    pub radius_mm: f64,
    /// Root of the weight, 1/mm.
    pub weight: f64,
}

/// What a shape makes of a touch where it stands.
#[derive(Debug, Clone, Copy)]
pub struct Touched {
    /// Distance from the surface less the ball's radius, mm.
    pub residual_mm: f64,
    /// Its derivative with respect to the ball's centre: the normal.
    pub normal: Vector3<f64>,
    /// Its derivatives with respect to the standing's unknowns.
    pub local: [f64; UNKNOWNS],
}

/// A shape of a surface.
pub trait Shape: std::fmt::Debug + Clone + Send + Sync + 'static {
    /// Where it stands.
    type Standing: Clone + std::fmt::Debug;

    /// The standing with the least sum of squared weighted residuals.
    fn place(&self, contacts: &[Contact], dimensions_mm: &[f64]) -> Self::Standing;

    /// What is read there.
    fn touched(&self, standing: &Self::Standing, contact: &Contact, dimensions_mm: &[f64]) -> Touched;

    /// Derivative of a residual with respect to each dimension.
    fn by_dimensions(&self) -> &[f64];

    /// How fast each dimension grows with the arm where no length is known, mm.
    fn growing(&self, dimensions_mm: &[f64], balls_mm: &[f64]) -> Vec<f64>;

    /// Whether nothing about it, touched with these balls, is a known length.
    fn scale_free(&self, dimensions: &[Dimension], balls_mm: &[f64]) -> bool;
}
