//! An arm: joints from the base to the probe, the probes it carries, and what it does beyond its geometry.
//!
//! `turn_i = sign_i * q_i - theta0_i`; see [`crate::kinematics`] for the map. Lengths are mm, angles rad, always.
//! The order of parameters is fixed: four for each joint but the last (for all of an arm with a full last link), then
//! x, y, z of each probe, then those of its [`effects`].

pub mod effects;

mod articulated;
mod joint;
mod probe;
mod unit;

pub use articulated::Arm;
#[cfg(test)]
pub(crate) use articulated::samples;
pub use effects::{
    Array, Backlash, BaseOffset, BaseTilt, Body, Compliance, Coupling, Effect, Effects, Expansion, Harmonics, Lost,
    Seen, Stated, Unseen,
};
pub use joint::{Joint, JointModel};
pub use probe::Probe;
pub use unit::Unit;
