//! Readings on their way into a problem.

use super::groups::Problem;
use crate::artefacts::{Rows, Stated, readings_of};
use crate::error::Result;

impl Problem {
    /// Adds readings of an artefact; returns the group's number.
    ///
    /// # Errors
    /// A kind that there is not; what a kind needs and lacks, or has no use for; shapes that do not agree, an unknown
    /// probe or feature, a value that is not finite or not of a size that it can have.
    pub fn add(&mut self, kind: &str, stated: &Stated, rows: &Rows) -> Result<usize> {
        let readings = readings_of(kind, stated, rows, self.arm())?;
        Ok(self.push(readings))
    }
}
