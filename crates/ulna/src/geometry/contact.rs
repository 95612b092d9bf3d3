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
        let weights: f64 = contacts.iter().map(|contact| contact.weight.powi(2)).sum();
        let share = |contact: &Contact| contact.weight.powi(2) / weights;
        let mean_mm: Vector3<f64> = contacts.iter().map(|contact| contact.p_mm * share(contact)).sum();
        let apart_mm: f64 = contacts.iter().map(|contact| contact.apart_mm * share(contact)).sum();
        let scatter = contacts.iter().map(|contact| {
            let arm = contact.p_mm - mean_mm;
            arm * arm.transpose() * share(contact)
        });
        Spread { weights, mean_mm, apart_mm, scatter: scatter.sum() }
    }
}
