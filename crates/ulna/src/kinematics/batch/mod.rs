//! The forward map and its derivatives over many readings at once: columns of numbers, in SIMD lanes.

mod compliance;
mod effects;
mod kernel;
mod steps;
mod sweep;
mod turned;

pub(crate) use kernel::{forward, gradient, gradient_between, scratch_len};
pub use sweep::{for_each_derivative, tips_from_rows_mm, tips_mm, tips_of_probe_mm};
