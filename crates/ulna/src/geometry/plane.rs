//! The plane whose distances from given points come closest to what they should be, all on one side of it.

use super::contact::{Contact, Spread};
use nalgebra::{Matrix3, Vector3};

/// A plane `n·(p - middle) = offset`, its normal towards the side that the contacts are on: contacts that are not alike
/// far apart tell it, else it is the side of the origin.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// Unit normal.
    pub normal: Vector3<f64>,
    /// Two directions along it.
    pub along: [Vector3<f64>; 2],
    /// The middle of the contacts, mm.
    pub middle_mm: Vector3<f64>,
    /// Distance of the plane from there, along the normal, mm.
    pub offset_mm: f64,
}

impl Plane {
    /// The plane with the least sum of squared weighted residuals.
    pub fn at_known_distances(contacts: &[Contact]) -> Plane {
        let spread = Spread::of(contacts);
        let mut pull = Vector3::zeros();
        for contact in contacts {
            let share = contact.weight.powi(2) / spread.weights;
            pull += (contact.p_mm - spread.mean_mm) * ((contact.apart_mm - spread.apart_mm) * share);
        }
        let normal = best_normal(spread.scatter, pull, spread.mean_mm);
        let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
        let along = [first, normal.cross(&first)];
        Plane { normal, along, middle_mm: spread.mean_mm, offset_mm: -spread.apart_mm }
    }

    /// How much farther a contact is than it should be, mm.
    pub fn residual_mm(&self, contact: &Contact) -> f64 {
        self.normal.dot(&(contact.p_mm - self.middle_mm)) - self.offset_mm - contact.apart_mm
    }

    /// Derivatives of a residual with respect to two tilts and the offset.
    pub fn derivatives(&self, contact: &Contact) -> [f64; 3] {
        let arm = contact.p_mm - self.middle_mm;
        [self.along[0].dot(&arm), self.along[1].dot(&arm), -1.0]
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
