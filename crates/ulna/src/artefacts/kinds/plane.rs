//! `plane`: a flat touched with the ball tip.
//!
//! ```text
//! r = n·p(q) - c - D_tip/2        n towards the side that the ball is on: balls that differ tell, else the base's side
//! ```

use crate::artefacts::kind::Kind;
use crate::artefacts::shape::{Known, Shape};
use crate::artefacts::stated::Column;
use crate::artefacts::surface::Surface;
use crate::geometry::plane::Plane;

/// The kind; it has no dimension.
pub(super) const KIND: Kind = Kind {
    name: "plane",
    needs: &[Column::Placement, Column::Balls],
    takes: &[],
    dimensions: &[],
    readings: |statement| Ok(Surface::readings(Flat, &[], statement)),
};

/// A flat, touched from one side.
#[derive(Debug, Clone, Copy)]
struct Flat;

impl Shape<3> for Flat {
    type Figure = Plane;

    fn apart_mm(&self, _: &[f64], ball_radius_mm: f64, _: f64) -> f64 {
        ball_radius_mm
    }

    fn apart_by(&self, _: usize, _: f64) -> f64 {
        0.0
    }

    fn growing(&self, _: &[f64], _: &[f64]) -> Vec<f64> {
        vec![]
    }

    fn scale_free(&self, _: &[Known], balls_mm: &[f64]) -> bool {
        balls_mm.windows(2).all(|pair| pair[0] == pair[1])
    }
    fn still_free(&self, _: &[Known]) -> bool {
        true
    }
}
