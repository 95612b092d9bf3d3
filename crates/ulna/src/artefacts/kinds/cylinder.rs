//! `cylinder`: a shaft, or a bore, of known or unknown diameter, touched on its surface.
//!
//! ```text
//! r = ‖(p(q) - c) × u‖ - (D + D_tip)/2      outside;      ‖(p(q) - c) × u‖ - (D - D_tip)/2      inside
//! ```
//!
//! with the axis c + t u, four unknowns of each standing: where it crosses a plane, and two tilts.

use crate::artefacts::kind::{Asked, Kind};
use crate::artefacts::round::Round;
use crate::artefacts::stated::Column;
use crate::geometry::line::Axis;

/// The kind; its dimension is its diameter.
pub(super) const KIND: Kind = Kind {
    name: "cylinder",
    needs: &[Column::Placement, Column::Balls],
    takes: &[Column::Inside],
    dimensions: &[Asked::length("diameter", true)],
    readings: |statement| Ok(Round::<Axis>::readings(statement)),
};
