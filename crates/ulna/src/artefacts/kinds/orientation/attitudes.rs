//! What an instrument saw of one target, and how it weighs.

use crate::artefacts::stated::Frame;
use crate::artefacts::whitening::Whitening;
use nalgebra::{Rotation3, Vector3};

/// What an instrument saw of one target, and how it weighs.
#[derive(Debug, Clone)]
pub(super) struct Attitudes {
    pub frame: Frame,
    /// how the target is mounted, as stated
    pub mount_rad: Vector3<f64>,
    /// which axis of it each dimension of the group is
    pub unknown: Vec<usize>,
    pub lever_mm: f64,
    /// R_m of each touch
    pub seen: Vec<Rotation3<f64>>,
    /// what each touch is uncertain by of its own, at the lever
    pub u_mm: Vec<f64>,
    pub whitening: Whitening,
    /// the same with what a loss makes of it
    pub discounted: Option<Whitening>,
}

impl Attitudes {
    pub fn new(
        frame: Frame,
        mount_rad: Vector3<f64>,
        unknown: Vec<usize>,
        lever_mm: f64,
        seen: Vec<Rotation3<f64>>,
        u_mm: Vec<f64>,
    ) -> Attitudes {
        let (whitening, discounted) = (Whitening::Same(1.0), None);
        Attitudes { frame, mount_rad, unknown, lever_mm, seen, u_mm, whitening, discounted }
    }

    pub fn weights(&self) -> &Whitening {
        self.discounted.as_ref().unwrap_or(&self.whitening)
    }

    /// How the target is mounted, with these dimensions: a rotation vector, rad.
    pub fn mount_at(&self, dimensions: &[f64]) -> Vector3<f64> {
        let mut mount_rad = self.mount_rad;
        self.unknown.iter().zip(dimensions).for_each(|(&axis, &value)| mount_rad[axis] = value);
        mount_rad
    }
}
