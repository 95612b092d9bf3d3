//! What an arm does beyond its geometry, one file for each cause. All are off until an arm has them.
//!
//! ```text
//! turn_i = sign_i (q_i + Σ_k c_ik cos k q_i + s_ik sin k q_i) - theta0_i + κ_i M_i
//! a_i, d_i, tip → (1 + ε_i (T_i - 20 °C)) a_i, d_i, tip
//! ```

mod all;
mod compliance;
mod effect;
mod expansion;
mod harmonics;

pub use all::Effects;
pub use compliance::{Body, Compliance};
pub use effect::Effect;
pub use expansion::Expansion;
pub use harmonics::Harmonics;
