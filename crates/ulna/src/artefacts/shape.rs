//! What a shape owes whose touches give one number each: how far the tip should be from a figure.

use super::figure::Figure;

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
    /// What stands somewhere.
    type Figure: Figure<U>;

    /// How far a tip with a ball of this radius, or of which this was measured, should be from the figure, mm.
    fn apart_mm(&self, sizes: &[f64], ball_radius_mm: f64, measured_mm: f64) -> f64;

    /// Its derivative with respect to a size.
    fn apart_by(&self, size: usize, measured_mm: f64) -> f64;

    /// How fast each size grows with the arm where no length is known.
    fn growing(&self, sizes: &[f64], balls_mm: &[f64]) -> Vec<f64>;

    /// Whether nothing about it, touched with these balls, is a known length.
    fn scale_free(&self, sizes: &[Known], balls_mm: &[f64]) -> bool;

    /// Whether a tip that never moves meets it: whatever is touched passes through such a tip.
    fn still_free(&self, sizes: &[Known]) -> bool;
}
