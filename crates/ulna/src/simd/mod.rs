//! Vectors of doubles, on whatever the machine has: AVX-512, AVX2, NEON or none. Knows no kinematics.

mod columns;
mod lanes;
mod level;

pub use columns::Columns;
pub(crate) use lanes::{Lanes, PAD, padded};
pub use level::simd_level;
