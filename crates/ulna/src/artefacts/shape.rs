//! What a shape owes whose touches give one number each: how far the tip is from it.

use crate::geometry::Contact;
use nalgebra::Vector3;

/// What a shape of `U` unknowns makes of a touch where it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touched<const U: usize> {
    /// distance of the tip from the figure, less what it should be
    pub residual_mm: f64,
    /// its derivative with respect to the tip: a unit vector
    pub normal: Vector3<f64>,
    /// its derivatives with respect to the standing's unknowns
    pub own: [f64; U],
}

/// What a fit may do with a size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Known {
    /// nothing: it stays at this value
    Held(f64),
    /// move it within its uncertainty
    Within,
    /// move it anywhere
    Freely,
}

/// A shape: a figure with `U` unknowns of a standing (a point, a plane), from which tips are so far apart as its sizes, the
/// ball and what was measured say. Its sizes are the dimensions of its kind, in their order.
pub(super) trait Shape<const U: usize>: std::fmt::Debug + Clone + Send + Sync + 'static {
    /// Where the figure stands.
    type Standing;

    /// How far a tip with a ball of this radius, or of which this was measured, should be from the figure, mm.
    fn apart_mm(&self, sizes: &[f64], ball_radius_mm: f64, measured_mm: f64) -> f64;

    /// Its derivative with respect to a size.
    fn apart_by(&self, size: usize, measured_mm: f64) -> f64;

    /// The standing with the least sum of squared weighted residuals.
    fn place(&self, contacts: &[Contact]) -> Self::Standing;

    /// What is read there.
    fn touched(&self, standing: &Self::Standing, contact: &Contact) -> Touched<U>;

    /// How fast each size grows with the arm where no length is known.
    fn growing(&self, sizes: &[f64], balls_mm: &[f64]) -> Vec<f64>;

    /// Whether nothing about it, touched with these balls, is a known length.
    fn scale_free(&self, sizes: &[Known], balls_mm: &[f64]) -> bool;
}
