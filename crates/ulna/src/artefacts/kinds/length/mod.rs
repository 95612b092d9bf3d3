//! `length`: two poses and the distance between their tips.
//!
//! ```text
//! r = w (‖p(q) - p(q')‖ - L)      ∂r = w u · (∂p(q) - ∂p(q'))      u = (p(q) - p(q')) / ‖p(q) - p(q')‖
//! ```

mod kernels;
mod lengths;
mod run;
mod stated;

pub(super) use lengths::Lengths;
pub(super) use stated::KIND;
