//! `sphere`: a ball, or a hollow sphere, of known or unknown diameter, touched on its surface.
//!
//! ```text
//! r = ‖p(q) - c‖ - (D + D_tip)/2      outside;      ‖p(q) - c‖ - (D - D_tip)/2      inside
//! ```

use crate::artefacts::kind::{Asked, Kind};
use crate::artefacts::round::Round;
use crate::artefacts::stated::Column;
use crate::geometry::point::Centre;

/// The kind; its dimension is its diameter.
pub(super) const KIND: Kind = Kind {
    name: "sphere",
    needs: &[Column::Placement, Column::Balls],
    takes: &[Column::Inside],
    dimensions: &[Asked::length("diameter", true)],
    readings: |statement| Ok(Round::<Centre>::readings(statement)),
};
