//! Least squares that knows no kinematics: a problem streams rows of its Jacobian and residual, a sink folds them.
//!
//! Rows come in blocks of columns ([`RowBlock`]) and are folded at once into what is needed, the normal equations
//! ([`gram::Gram`], for the steps on the way) or an orthogonal triangle ([`triangle::Triangle`], for every decision
//! about rank and for covariances), so that no Jacobian is ever stored whole.

pub mod covariance;
pub mod decomposition;
pub mod full_rank;
pub mod gram;
pub mod lm;
pub mod losses;
pub mod numdiff;
pub mod reflect;
pub mod tree;
pub mod triangle;

mod equations;

pub use equations::{BLOCK_ROWS, LeastSquares, RowBlock, RowSink};
