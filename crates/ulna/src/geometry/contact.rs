//! Points with the distances that they should have, and how they are spread.

use nalgebra::{Matrix3, Vector3};

/// A point that should be at some distance from a figure.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Where it is, mm.
    pub p_mm: Vector3<f64>,
    /// How far it should be from the figure, mm.
    pub apart_mm: f64,
    /// Root of its weight, 1/mm.
    pub weight: f64,
}

/// How some contacts lie, weighed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spread {
    /// sum of the weights
    pub weights: f64,
    pub mean_mm: Vector3<f64>,
    /// mean of how far they should be apart
    pub apart_mm: f64,
    /// mean squares about the mean, mm²
    pub scatter: Matrix3<f64>,
}

impl Spread {
    pub fn of(contacts: &[Contact]) -> Spread {
        let (mut weights, mut mean_mm, mut apart_mm) = (0.0, Vector3::zeros(), 0.0);
        for contact in contacts {
            let weight = contact.weight * contact.weight;
            weights += weight;
            mean_mm += contact.p_mm * weight;
            apart_mm += contact.apart_mm * weight;
        }
        mean_mm /= weights;
        let mut scatter = Matrix3::zeros();
        for contact in contacts {
            let arm = (contact.p_mm - mean_mm) * contact.weight;
            scatter += arm * arm.transpose();
        }
        Spread { weights, mean_mm, apart_mm: apart_mm / weights, scatter: scatter / weights }
    }

    /// The direction in which the contacts scatter least.
    pub fn thinnest(&self) -> Vector3<f64> {
        let eigen = self.scatter.symmetric_eigen();
        eigen.eigenvectors.column(eigen.eigenvalues.imin()).into()
    }
}
