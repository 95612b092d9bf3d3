//! A flat.
//!
//! ```text
//! r = n·p(q) - c - D_tip/2        n towards the side that the ball is on: balls that differ tell, else the base's side
//! ```

use super::shape::{Contact, Shape, Touched};
use crate::artefacts::dimension::Dimension;
use nalgebra::{Matrix3, Vector3};

/// A plane; it has no dimension.
#[derive(Debug, Clone, Copy)]
pub struct Plane;

/// Where a plane stands.
#[derive(Debug, Clone, Copy)]
pub struct Lying {
    normal: Vector3<f64>,
    /// two directions along it
    along: [Vector3<f64>; 2],
    /// the middle of the touches
    middle: Vector3<f64>,
    /// distance of the plane from there, along the normal
    offset: f64,
}

impl Lying {
    fn new(normal: Vector3<f64>, middle: Vector3<f64>, offset: f64) -> Lying {
        let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
        Lying { normal, along: [first, normal.cross(&first)], middle, offset }
    }

    fn residual(&self, contact: &Contact) -> f64 {
        self.normal.dot(&(contact.p_mm - self.middle)) - self.offset - contact.radius_mm
    }

    /// Derivatives of a residual with respect to two tilts and the offset.
    fn local(&self, contact: &Contact) -> [f64; 3] {
        let arm = contact.p_mm - self.middle;
        [self.along[0].dot(&arm), self.along[1].dot(&arm), -1.0]
    }
}

impl Shape for Plane {
    type Standing = Lying;

    fn place(&self, contacts: &[Contact], _: &[f64]) -> Lying {
        let weights: f64 = contacts.iter().map(|contact| contact.weight.powi(2)).sum();
        let share = |contact: &Contact| contact.weight.powi(2) / weights;
        let middle: Vector3<f64> = contacts.iter().map(|contact| contact.p_mm * share(contact)).sum();
        let radius: f64 = contacts.iter().map(|contact| contact.radius_mm * share(contact)).sum();
        let (mut scatter, mut pull) = (Matrix3::zeros(), Vector3::zeros());
        for contact in contacts {
            let arm = contact.p_mm - middle;
            scatter += arm * arm.transpose() * share(contact);
            pull += arm * ((contact.radius_mm - radius) * share(contact));
        }
        Lying::new(best_normal(scatter, pull, middle), middle, -radius)
    }

    fn touched(&self, lying: &Lying, contact: &Contact, _: &[f64]) -> Touched {
        Touched { residual_mm: lying.residual(contact), normal: lying.normal, local: lying.local(contact) }
    }

    fn by_dimensions(&self) -> &[f64] {
        &[]
    }

    fn growing(&self, _: &[f64], _: &[f64]) -> Vec<f64> {
        vec![]
    }

    fn scale_free(&self, _: &[Dimension], balls_mm: &[f64]) -> bool {
        balls_mm.windows(2).all(|pair| pair[0] == pair[1])
    }
}

/// The unit vector n with the least `nᵀ S n - 2 b·n`: balls that differ pull it by b.
///
/// With no pull it is the eigenvector of the smallest eigenvalue, either way; else `(S - λ) n = b` with λ below that
/// eigenvalue and |n| = 1, whose one root is found by Newton's method (Moré and Sorensen 1983).
fn best_normal(scatter: Matrix3<f64>, pull: Vector3<f64>, middle: Vector3<f64>) -> Vector3<f64> {
    let eigen = scatter.symmetric_eigen();
    let (smallest, least) = eigen.eigenvalues.argmin();
    let above: Vector3<f64> = eigen.eigenvalues.map(|value| value - least);
    let along = eigen.eigenvectors.transpose() * pull;
    let upright: Vector3<f64> = eigen.eigenvectors.column(smallest).into();
    // the same plane either way: touched from the side that the arm's base is on, as most are
    let upright = if upright.dot(&middle) > 0.0 { -upright } else { upright };
    // nothing pulls it over to one side: the tilt that the pull makes
    let tilt = Vector3::from_fn(|k, _| if k == smallest { 0.0 } else { along[k] / above[k].max(f64::MIN_POSITIVE) });
    if along[smallest].abs() <= f64::EPSILON * along.norm() && tilt.norm() < 1.0 || pull == Vector3::zeros() {
        let across = eigen.eigenvectors * tilt;
        return across + upright * (1.0 - tilt.norm_squared()).max(0.0).sqrt();
    }
    let normal = |mu: f64| Vector3::from_fn(|k, _| along[k] / (above[k] + mu));
    let mut mu = along[smallest].abs().max(f64::MIN_POSITIVE);
    for _ in 0..100 {
        let n = normal(mu);
        let length = n.norm();
        // Newton on 1/|n(μ)| - 1, which is nearly linear and is approached from one side
        let slope: f64 = (0..3).map(|k| n[k] * n[k] / (above[k] + mu)).sum();
        let step = (length - 1.0) / length * (length * length * length) / slope;
        let next = mu + step;
        if next <= mu * (1.0 + 4.0 * f64::EPSILON) {
            break;
        }
        mu = next;
    }
    (eigen.eigenvectors * normal(mu)).normalize()
}
