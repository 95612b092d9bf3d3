//! Which measurements to take: a subset of candidates chosen by exchange, each a block of rows of a whitened Jacobian.
//!
//! Knows no kinematics and no names. Rows are expected in coordinates in which the candidates' mean information is about
//! the identity and undetermined directions are gone, so that a Cholesky factor of the information loses no digits.
//!
//! The exchange is Fedorov's (1972) on a shortlist (Cook and Nachtsheim 1980): all candidates are ranked by what they would
//! add to the set as it is; then, one after the other, each chosen one gives way to the best of the shortlist, the inverse
//! of the information following by updates of rank k; until a whole round changes nothing.

mod abreast;
mod blocks;
mod criterion;
mod exchange;
mod gains;
#[cfg(test)]
mod samples;

pub use blocks::Candidates;
pub use criterion::Criterion;
pub use exchange::{Chosen, Task, choose};
pub use gains::gains;
