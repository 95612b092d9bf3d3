//! The kind, and what only it knows of its statement.

use super::lengths::Lengths;
use crate::artefacts::checks::check_within;
use crate::artefacts::kind::{Asked, Kind};
use crate::artefacts::stated::Column;

/// The kind; its dimension is what is uncertain of the length, common to all rows.
pub(in crate::artefacts::kinds) const KIND: Kind = Kind {
    name: "length",
    needs: &[Column::SecondPose, Column::Measured],
    takes: &[],
    dimensions: &[Asked::length("length", false)],
    readings: |statement| {
        let what = format!("a length of artefact {}, mm,", statement.stated.name);
        for &length_mm in statement.rows.measured_mm.unwrap_or_default() {
            check_within(&what, length_mm, (1e-6, 1e7))?;
        }
        Ok(Box::new(Lengths::new(statement.rows, statement.arm.encoders(), statement.dimension("length"))))
    },
};
