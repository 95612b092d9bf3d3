//! What an arm does beyond its geometry, one file for each cause. All are off until an arm has them.
//!
//! ```text
//! turn_i = sign_i (q_i + Σ_k c_ik cos k q_i + s_ik sin k q_i + b_i/2 · s_i + Σ_k r_ik q_k) - theta0_i + κ_i M_i
//! a_i, d_i, tip → (1 + ε_i (T_i - 20 °C)) a_i, d_i, tip
//! p → (x, y, 0) + Rx(tilt_x) Ry(tilt_y) p
//! ```
//!
//! A further one is a file here and a row in `all.rs`. What adds to the angle of an encoder is then in the map and its
//! derivatives; what does not says in [`kinematics`](crate::kinematics) where it enters: in `plain.rs`, `chain.rs` and
//! `batch/kernel.rs`.

mod all;
mod backlash;
mod base;
mod compliance;
mod coupling;
mod effect;
mod expansion;
mod harmonics;
mod on_encoder;
mod seen;
mod stated;

pub use all::Effects;
pub use backlash::Backlash;
pub(crate) use base::Base;
pub use base::{BaseOffset, BaseTilt};
pub(crate) use compliance::check_mass;
pub use compliance::{Body, Compliance};
pub use coupling::Coupling;
pub use effect::{Effect, FromStated};
pub use expansion::Expansion;
pub use harmonics::Harmonics;
pub(crate) use on_encoder::{Encoder, EncoderLanes};
pub use seen::{Lost, Seen, Unseen};
pub use stated::{Array, Stated};
