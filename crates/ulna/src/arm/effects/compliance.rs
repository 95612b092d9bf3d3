//! Joints that give way to the weight of what they carry.

use super::effect::Effect;
use crate::arm::unit::Unit;
use crate::error::{Error, Result};

/// `κ_i M_i` added to each turn, with `M_i` the gravity moment about axis i of all that moves with joint i.
///
/// The moments are those of the arm before it gives way.
#[derive(Debug, Clone, PartialEq)]
pub struct Compliance {
    /// κ of each joint, rad/(N m).
    pub rad_per_nm: Vec<f64>,
    /// What hangs on each joint: its link; of the last joint, the probe.
    pub bodies: Vec<Body>,
    /// Where gravity pulls, base frame; of any length but zero.
    pub gravity: [f64; 3],
}

/// A rigid body that moves with a joint.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Body {
    /// kg
    pub mass_kg: f64,
    /// Centre of mass in the frame after the link (that of the next joint; of the last joint, the probe's), mm.
    pub centre_mm: [f64; 3],
}

/// Standard acceleration of free fall, m/s² (3rd CGPM 1901), times metres in a millimetre: N m for each kg mm.
const NM_PER_KG_MM: f64 = 9.80665e-3;

/// An axis this much out of plumb is upright, rad.
const UPRIGHT: f64 = 1e-9;

impl Compliance {
    /// Gravity as a vector that makes N m of kg mm.
    pub(crate) fn pull(&self) -> [f64; 3] {
        let norm = self.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        self.gravity.map(|g| NM_PER_KG_MM * g / norm)
    }

    /// Whether gravity pulls another way than along the first axis.
    pub(crate) fn leans(&self) -> bool {
        self.gravity[0].hypot(self.gravity[1]) > UPRIGHT * self.gravity[2].abs()
    }

    /// Largest moment that gravity could make about any axis of an arm with this reach, N m.
    pub(crate) fn most_nm(&self, reach_mm: f64) -> f64 {
        let mass: f64 = self.bodies.iter().map(|body| body.mass_kg).sum();
        NM_PER_KG_MM * mass * reach_mm
    }

    pub(super) fn check(&self) -> Result<()> {
        if self.bodies.len() != self.rad_per_nm.len() {
            return Err(Error::Shape {
                what: "the masses".into(),
                got: self.bodies.len(),
                expected: self.rad_per_nm.len(),
            });
        }
        let length = self.gravity.iter().map(|g| g * g).sum::<f64>();
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::OutOfRange {
                what: "the length of the direction of gravity".into(),
                value: length.sqrt(),
                expected: "a positive number",
            });
        }
        for (i, body) in self.bodies.iter().enumerate() {
            if !(0.0..=1e6).contains(&body.mass_kg) {
                return Err(Error::OutOfRange {
                    what: format!("the mass of joint {}, kg,", i + 1),
                    value: body.mass_kg,
                    expected: "a number from 0 to 1e6",
                });
            }
            if let Some(&value) = body.centre_mm.iter().find(|c| !c.is_finite()) {
                return Err(Error::NotFinite { what: format!("the centre of mass of joint {}", i + 1), value });
            }
        }
        Ok(())
    }
}

impl Effect for Compliance {
    fn names(&self) -> Vec<String> {
        (1..=self.rad_per_nm.len()).map(|joint| format!("joint.{joint}.compliance")).collect()
    }

    fn unit(&self) -> Unit {
        Unit::RadPerNewtonMetre
    }

    fn values(&self) -> Vec<f64> {
        self.rad_per_nm.clone()
    }

    fn set(&mut self, values: &[f64]) {
        self.rad_per_nm.copy_from_slice(values);
    }

    fn joints(&self) -> usize {
        self.rad_per_nm.len()
    }
}
