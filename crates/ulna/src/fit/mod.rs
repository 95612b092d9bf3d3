//! The way to the minimum, and all that is judged of it.

pub mod calibrate;
pub mod monte_carlo;
pub mod robust;
pub mod running;
pub mod solve;
pub mod symmetry;

mod judged;
mod scale;
mod scatter;
mod search;
mod settle;
mod signs;
mod way;
