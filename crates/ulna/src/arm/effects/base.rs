//! Where the first axis stands in a frame that somebody stated: the base of a robot, marks on a table.
//!
//! ```text
//! p = (x, y, 0) + Rx(tilt_x) Ry(tilt_y) p_first
//! ```
//!
//! The turn about the first axis and the height along it are the first joint's own.

use super::effect::{Effect, FromStated};
use super::stated::Stated;
use crate::arm::unit::Unit;
use crate::error::Result;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// Turns the first axis about x, then about the y that has turned along.
#[derive(Debug, Clone, PartialEq)]
pub struct BaseTilt {
    /// About x and about y, rad.
    pub rad: [f64; 2],
    /// Of the arm.
    pub joints: usize,
}

/// Moves the first axis along x and y of the stated frame.
#[derive(Debug, Clone, PartialEq)]
pub struct BaseOffset {
    /// mm
    pub mm: [f64; 2],
    /// Of the arm.
    pub joints: usize,
}

impl BaseTilt {
    /// From the frame of the first axis to the stated one.
    pub fn rotation(&self) -> Rotation3<f64> {
        let [x, y] = self.rad;
        Rotation3::from_axis_angle(&Vector3::x_axis(), x) * Rotation3::from_axis_angle(&Vector3::y_axis(), y)
    }

    /// The axes that it turns about, stated frame.
    pub(crate) fn axes(&self) -> [Vector3<f64>; 2] {
        let x = Rotation3::from_axis_angle(&Vector3::x_axis(), self.rad[0]);
        [Vector3::x(), x * Vector3::y()]
    }
}

/// Where the first axis stands in the stated frame, for the maps.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Base {
    /// to the stated frame
    pub rotation: Matrix3<f64>,
    /// that it turns about, stated frame
    pub axes: [Vector3<f64>; 2],
    /// mm
    pub offset: [f64; 2],
}

impl Base {
    /// None where the first axis is z of the stated frame.
    pub fn of(tilt: Option<&BaseTilt>, offset: Option<&BaseOffset>) -> Option<Base> {
        (tilt.is_some() || offset.is_some()).then(|| Base {
            rotation: tilt.map_or_else(Rotation3::identity, BaseTilt::rotation).into_inner(),
            axes: tilt.map_or([Vector3::x(), Vector3::y()], BaseTilt::axes),
            offset: offset.map_or([0.0; 2], |offset| offset.mm),
        })
    }

    /// The pose of the frame of the first axis in the stated frame.
    pub fn pose(&self) -> Isometry3<f64> {
        let [x, y] = self.offset;
        let rotation = Rotation3::from_matrix_unchecked(self.rotation);
        Isometry3::from_parts(Translation3::new(x, y, 0.0), UnitQuaternion::from_rotation_matrix(&rotation))
    }
}

impl Effect for BaseTilt {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.joints
    }

    fn suffixes(&self, joint: usize) -> Vec<String> {
        if joint == 0 { vec!["tilt_x".into(), "tilt_y".into()] } else { vec![] }
    }

    fn unit(&self) -> Unit {
        Unit::Rad
    }

    fn values(&self) -> &[f64] {
        &self.rad
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.rad
    }

    fn moves_mm(&self, reach_mm: f64) -> f64 {
        reach_mm
    }

    fn known(&self, angle_rad: f64) -> f64 {
        angle_rad
    }

    fn of_base(&self) -> bool {
        true
    }
}

impl Effect for BaseOffset {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.joints
    }

    fn suffixes(&self, joint: usize) -> Vec<String> {
        if joint == 0 { vec!["base_x".into(), "base_y".into()] } else { vec![] }
    }

    fn unit(&self) -> Unit {
        Unit::Mm
    }

    fn values(&self) -> &[f64] {
        &self.mm
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.mm
    }

    fn moves_mm(&self, _: f64) -> f64 {
        1.0
    }

    /// A robot is bolted down to a millimetre.
    fn known(&self, _: f64) -> f64 {
        1.0
    }

    fn of_base(&self) -> bool {
        true
    }
}

impl FromStated for BaseTilt {
    const KIND: &'static str = "base-tilt";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        let rad = given.take("tilt_rad", &[2])?;
        Ok(BaseTilt { rad: [rad[0], rad[1]], joints })
    }
}

impl FromStated for BaseOffset {
    const KIND: &'static str = "base-offset";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        let mm = given.take("offset_mm", &[2])?;
        Ok(BaseOffset { mm: [mm[0], mm[1]], joints })
    }
}
