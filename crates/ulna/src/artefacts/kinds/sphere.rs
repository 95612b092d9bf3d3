//! `sphere`: a ball, or a hollow sphere, of known or unknown diameter, touched on its surface.
//!
//! ```text
//! r = ‖p(q) - c‖ - (D + D_tip)/2      outside;      ‖p(q) - c‖ - (D - D_tip)/2      inside
//! ```

use crate::artefacts::kind::{Asked, Kind};
use crate::artefacts::shape::{Known, Shape, Touched};
use crate::artefacts::stated::Column;
use crate::artefacts::surface::Surface;
use crate::geometry::Contact;
use crate::geometry::point::{Centre, at_known_distances};

/// The kind; its dimension is its diameter.
pub(super) const KIND: Kind = Kind {
    name: "sphere",
    needs: &[Column::Placement, Column::Balls],
    takes: &[Column::Inside],
    dimensions: &[Asked::length("diameter", true)],
    readings: |statement| {
        let diameter_mm = statement.size("diameter").map_or(0.0, |size| size.value);
        Ok(Surface::readings(Sphere { inside: statement.stated.inside }, &[diameter_mm], statement))
    },
};

/// A sphere, touched from one side.
#[derive(Debug, Clone, Copy)]
struct Sphere {
    inside: bool,
}

impl Sphere {
    /// A size of the sphere with that of the ball: outside of it or inside.
    fn with_ball(self, size_mm: f64, ball_mm: f64) -> f64 {
        if self.inside { size_mm - ball_mm } else { size_mm + ball_mm }
    }
}

impl Shape<3> for Sphere {
    type Standing = Centre;

    fn apart_mm(&self, sizes: &[f64], ball_radius_mm: f64, _: f64) -> f64 {
        self.with_ball(0.5 * sizes[0], ball_radius_mm)
    }

    fn apart_by(&self, _: usize, _: f64) -> f64 {
        0.5
    }

    fn place(&self, contacts: &[Contact]) -> Centre {
        at_known_distances(contacts)
    }

    fn touched(&self, centre: &Centre, contact: &Contact) -> Touched<3> {
        let (residual_mm, normal) = centre.residual(contact);
        Touched { residual_mm, normal, own: (-normal).into() }
    }

    fn growing(&self, sizes: &[f64], balls_mm: &[f64]) -> Vec<f64> {
        vec![self.with_ball(sizes[0], balls_mm.first().copied().unwrap_or(0.0))]
    }

    fn scale_free(&self, sizes: &[Known], balls_mm: &[f64]) -> bool {
        sizes[0] == Known::Freely && balls_mm.windows(2).all(|pair| pair[0] == pair[1])
    }
}
