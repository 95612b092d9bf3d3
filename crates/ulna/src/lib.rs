//! Ulna core
#![allow(missing_docs)]
pub mod arm;
pub mod calibrate;
pub mod causes;
pub mod covariance;
pub mod decomposition;
pub mod error;
pub mod identifiability;
pub mod inverse;
pub mod kinematics;
pub mod monitor;
pub mod monte_carlo;
pub mod numdiff;
pub mod problem;
pub mod residuals;
pub mod propagate;
mod search;
pub mod solver;
pub mod symmetry;
pub use error::{Error, Result};
