//! Figures that tips are so far from: a point, a line, a plane.

use crate::geometry::Contact;
use crate::geometry::line::{self, Axis};
use crate::geometry::plane::Plane;
use crate::geometry::point::{self, Centre};
use nalgebra::Vector3;

/// What a figure of `U` unknowns makes of a touch where it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touched<const U: usize> {
    /// distance of the tip from the figure, less what it should be
    pub residual_mm: f64,
    /// its derivative with respect to the tip: a unit vector
    pub normal: Vector3<f64>,
    /// its derivatives with respect to the standing's unknowns
    pub own: [f64; U],
}

/// A figure with `U` unknowns, where it stands.
pub(super) trait Figure<const U: usize>: std::fmt::Debug + Clone + Send + Sync + 'static {
    /// With the least sum of squared weighted residuals.
    fn nearest(contacts: &[Contact]) -> Self;

    /// What is read of it.
    fn touched(&self, contact: &Contact) -> Touched<U>;
}

impl Figure<3> for Centre {
    fn nearest(contacts: &[Contact]) -> Centre {
        point::at_known_distances(contacts)
    }

    fn touched(&self, contact: &Contact) -> Touched<3> {
        let (residual_mm, normal) = self.residual(contact);
        Touched { residual_mm, normal, own: (-normal).into() }
    }
}

impl Figure<4> for Axis {
    fn nearest(contacts: &[Contact]) -> Axis {
        line::at_known_distances(contacts)
    }

    fn touched(&self, contact: &Contact) -> Touched<4> {
        let (residual_mm, normal, along_mm) = self.residual(contact);
        Touched { residual_mm, normal, own: self.derivatives(&normal, along_mm) }
    }
}

impl Figure<3> for Plane {
    fn nearest(contacts: &[Contact]) -> Plane {
        Plane::at_known_distances(contacts)
    }

    fn touched(&self, contact: &Contact) -> Touched<3> {
        Touched { residual_mm: self.residual_mm(contact), normal: self.normal, own: self.derivatives(contact) }
    }
}
