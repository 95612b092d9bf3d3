//! The forward map and its derivatives, twice: as the formula reads ([`tip_mm`], [`jacobian`]), and in [`batch`] over many
//! readings at once.
//!
//! ```text
//! turn_i = sign_i q_i - theta0_i                         and what the arm's effects add
//! p_base = T_1 T_2 … T_{n-1} Rz(turn_n) tip              or, with a full last link, T_1 … T_n tip
//! T_i    = Rz(turn_i) Tz(d_i) Tx(a_i) Rx(alpha_i)        Denavit-Hartenberg
//! T_i    = Rz(turn_i) Tx(a_i) Rx(alpha_i) Ry(beta_i)     Hayati
//! ```

pub mod batch;
pub mod inverse;
pub mod propagate;

mod carried;
mod chain;
mod conditions;
mod plain;
mod pose;
mod poses;

pub use chain::Chain;
pub use conditions::{Conditions, PAYLOAD};
pub use plain::{encoder_jacobian, frames, jacobian, tip_mm};
pub use pose::{Pose, Sample};
pub use poses::{Angles, Poses};
