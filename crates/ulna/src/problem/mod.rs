//! The one assembly: an arm, readings, and what is free become a least-squares problem.

pub mod assembly;
pub mod pins;
pub mod priors;

mod add;
mod groups;
mod parameters;
mod rows;

pub use groups::Problem;
pub use rows::{WhitenedRows, considered_rows_at, rows_at, rows_beside, whitened_rows};
