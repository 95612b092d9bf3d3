//! `distance`: how far the tip is from an unknown fixed point, as an instrument reads it: a draw wire, a telescoping bar, a
//! laser tracer.
//!
//! ```text
//! r = ‖p(q) - c‖ - (offset + scale · reading)
//! ```
//!
//! with c of each standing; offset and scale are the instrument's, each held, uncertain or fitted.

use crate::arm::Unit;
use crate::artefacts::kind::{Asked, Kind, Statement};
use crate::artefacts::readings::Readings;
use crate::artefacts::shape::{Known, Shape};
use crate::artefacts::stated::Column;
use crate::artefacts::surface::Surface;
use crate::error::Result;
use crate::geometry::point::Centre;

/// The kind; not stated, the offset is 0 and the scale 1.
pub(super) const KIND: Kind = Kind {
    name: "distance",
    needs: &[Column::Placement, Column::Measured],
    takes: &[],
    dimensions: &[
        Asked {
            name: "offset",
            unit: Unit::Mm,
            needed: false,
            range: (-1e7, 1e7),
            expected: "a number from -1e7 to 1e7",
        },
        Asked {
            name: "scale",
            unit: Unit::One,
            needed: false,
            range: (1e-3, 1e3),
            expected: "a number from 1e-3 to 1e3",
        },
    ],
    readings,
};

fn readings(statement: &Statement) -> Result<Box<dyn Readings>> {
    let (offset, scale) = (statement.size("offset"), statement.size("scale"));
    let sizes = [offset.map_or(0.0, |size| size.value), scale.map_or(1.0, |size| size.value)];
    // an offset that is to be found may begin anywhere
    if !offset.is_some_and(|size| size.fitted) {
        for (row, &reading) in statement.rows.measured_mm.unwrap_or_default().iter().enumerate() {
            let apart_mm = Instrument.apart_mm(&sizes, 0.0, reading);
            if apart_mm <= 0.0 {
                let why = format!("its reading {} is {reading} mm, which makes a distance of {apart_mm} mm", row + 1);
                return Err(statement.contradiction(why));
            }
        }
    }
    Ok(Surface::readings(Instrument, &sizes, statement))
}

/// What measures.
#[derive(Debug, Clone, Copy)]
struct Instrument;

impl Shape<3> for Instrument {
    type Figure = Centre;

    fn apart_mm(&self, sizes: &[f64], _: f64, measured_mm: f64) -> f64 {
        sizes[0] + sizes[1] * measured_mm
    }

    fn apart_by(&self, size: usize, measured_mm: f64) -> f64 {
        [1.0, measured_mm][size]
    }

    fn growing(&self, sizes: &[f64], _: &[f64]) -> Vec<f64> {
        sizes.to_vec()
    }

    fn scale_free(&self, sizes: &[Known], _: &[f64]) -> bool {
        sizes[1] == Known::Freely && [Known::Freely, Known::Held(0.0)].contains(&sizes[0])
    }
    /// An instrument whose scale may vanish measures nothing but its offset.
    fn still_free(&self, sizes: &[Known]) -> bool {
        sizes[1] == Known::Freely
    }
}
