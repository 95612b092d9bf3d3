//! `cylinder`: a shaft, or a bore, of known or unknown diameter, touched on its surface.
//!
//! ```text
//! r = ‖(p(q) - c) × u‖ - (D + D_tip)/2      outside;      ‖(p(q) - c) × u‖ - (D - D_tip)/2      inside
//! ```
//!
//! with the axis c + t u, four unknowns of each standing: where it crosses a plane, and two tilts.

use crate::artefacts::kind::{Asked, Kind};
use crate::artefacts::shape::{Known, Shape, Touched};
use crate::artefacts::stated::Column;
use crate::artefacts::surface::Surface;
use crate::geometry::Contact;
use crate::geometry::line::{Axis, at_known_distances};

/// The kind; its dimension is its diameter.
pub(super) const KIND: Kind = Kind {
    name: "cylinder",
    needs: &[Column::Placement, Column::Balls],
    takes: &[Column::Inside],
    dimensions: &[Asked::length("diameter", true)],
    readings: |statement| {
        let diameter_mm = statement.size("diameter").map_or(0.0, |size| size.value);
        Ok(Surface::readings(Cylinder { inside: statement.stated.inside }, &[diameter_mm], statement))
    },
};

/// A cylinder, touched from one side.
#[derive(Debug, Clone, Copy)]
struct Cylinder {
    inside: bool,
}

impl Cylinder {
    /// A size of the cylinder with that of the ball: outside of it or inside.
    fn with_ball(self, size_mm: f64, ball_mm: f64) -> f64 {
        if self.inside { size_mm - ball_mm } else { size_mm + ball_mm }
    }
}

impl Shape<4> for Cylinder {
    type Standing = Axis;

    fn apart_mm(&self, sizes: &[f64], ball_radius_mm: f64, _: f64) -> f64 {
        self.with_ball(0.5 * sizes[0], ball_radius_mm)
    }

    fn apart_by(&self, _: usize, _: f64) -> f64 {
        0.5
    }

    fn place(&self, contacts: &[Contact]) -> Axis {
        at_known_distances(contacts)
    }

    fn touched(&self, axis: &Axis, contact: &Contact) -> Touched<4> {
        let (residual_mm, normal, along_mm) = axis.residual(contact);
        Touched { residual_mm, normal, own: axis.derivatives(&normal, along_mm) }
    }

    fn growing(&self, sizes: &[f64], balls_mm: &[f64]) -> Vec<f64> {
        vec![self.with_ball(sizes[0], balls_mm.first().copied().unwrap_or(0.0))]
    }

    fn scale_free(&self, sizes: &[Known], balls_mm: &[f64]) -> bool {
        sizes[0] == Known::Freely && balls_mm.windows(2).all(|pair| pair[0] == pair[1])
    }
}
