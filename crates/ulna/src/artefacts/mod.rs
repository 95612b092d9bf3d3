//! What is observed: readings of artefacts, one file or folder for each kind ([`KINDS`]).
//!
//! A [`Readings`] streams its equations for given parameters. Placements are unknown and of no interest: each is put
//! where it fits best at these parameters, and its derivatives are eliminated before the rows reach the solver
//! (variable projection, Golub and Pereyra 1973, with Kaufman's Jacobian 1975).
//!
//! To add a kind: one file in `kinds/` with its formula, what it needs and how its readings are made; its line and its row
//! in `kinds.rs`; its entry in `tests/artefact_contract.rs`, which fails in words until it is there.

mod at_tips;
mod checks;
mod dimension;
mod figure;
mod kind;
mod kinds;
mod model;
mod noise;
mod parts;
mod placed;
mod readings;
mod residuals;
mod round;
mod rows;
mod shape;
mod standings;
mod stated;
mod surface;
mod tile;
mod touches;
mod whitening;
mod writer;

pub(crate) use checks::{LEAST_NOISE, MOST_MM};
pub use dimension::{Dimension, Unknowns};
pub use kind::{Asked, Kind};
pub use kinds::{KINDS, readings_of};
pub use model::{At, Model};
pub(crate) use noise::normal;
pub use noise::{Noise, Weighing};
pub use readings::{Again, Readings};
pub use residuals::{Unweighted, Whitened};
pub use stated::{Column, Frame, Rows, Size, Stated};
pub use writer::{Buffers, Writer};
