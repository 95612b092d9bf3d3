//! What is observed: readings of features of placed artefacts, one file for each kind of residual.
//!
//! A [`Readings`] streams its equations for given parameters. Placements are unknown and of no interest: each is put
//! where it fits best at these parameters, and its derivatives are eliminated before the rows reach the solver
//! (variable projection, Golub and Pereyra 1973, with Kaufman's Jacobian 1975).

pub mod length;
pub mod points;
pub mod surface;

mod dimension;
mod model;
mod noise;
mod readings;
mod residuals;
mod rows;
mod tile;
mod touches;
mod writer;

pub use dimension::{Dimension, Unknowns};
pub use model::{At, Model};
pub(crate) use noise::normal;
pub use noise::{Noise, Weighing};
pub use readings::Readings;
pub use residuals::{Unweighted, Whitened};
pub use touches::TouchRows;
pub use writer::{Buffers, Writer};
