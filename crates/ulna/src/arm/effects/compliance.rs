//! Joints that give way to the weight of what they carry.

use super::effect::{Effect, FromStated};
use super::seen::{Lost, Unseen};
use super::stated::Stated;
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
    /// Mass of the heaviest load that a pose may say beside them, kg.
    pub payload_kg: f64,
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
/// A joint that gives way by more than this for a newton metre is broken, rad.
const MOST_RAD_PER_NM: f64 = 1e-3;

/// A mass that an arm may carry.
///
/// # Errors
/// Less than nothing, or more than a thousand tonnes.
pub(crate) fn check_mass(mass_kg: f64, what: &str) -> Result<()> {
    if (0.0..=1e6).contains(&mass_kg) {
        return Ok(());
    }
    Err(Error::OutOfRange { what: what.into(), value: mass_kg, expected: "a number from 0 to 1e6" })
}

impl Compliance {
    /// Gravity as a vector that makes N m of kg mm.
    pub(crate) fn pull(&self) -> [f64; 3] {
        let norm = self.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        self.gravity.map(|g| NM_PER_KG_MM * g / norm)
    }
}

impl Effect for Compliance {
    fn kind(&self) -> &'static str {
        Self::KIND
    }

    fn joints(&self) -> usize {
        self.rad_per_nm.len()
    }

    fn suffixes(&self, _: usize) -> Vec<String> {
        vec!["compliance".into()]
    }

    fn unit(&self) -> Unit {
        Unit::RadPerNewtonMetre
    }

    fn values(&self) -> &[f64] {
        &self.rad_per_nm
    }

    fn values_mut(&mut self) -> &mut [f64] {
        &mut self.rad_per_nm
    }

    /// By the largest moment that gravity could make about any axis of an arm with this reach.
    fn moves_mm(&self, reach_mm: f64) -> f64 {
        let mass: f64 = self.bodies.iter().map(|body| body.mass_kg).sum();
        reach_mm * (NM_PER_KG_MM * (mass + self.payload_kg) * reach_mm).max(f64::MIN_POSITIVE)
    }

    fn known(&self, _: f64) -> f64 {
        MOST_RAD_PER_NM
    }

    fn check(&self) -> Result<()> {
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
        check_mass(self.payload_kg, "the mass of the heaviest load, kg,")?;
        for (i, body) in self.bodies.iter().enumerate() {
            check_mass(body.mass_kg, &format!("the mass of joint {}, kg,", i + 1))?;
            if let Some(&value) = body.centre_mm.iter().find(|c| !c.is_finite()) {
                return Err(Error::NotFinite { what: format!("the centre of mass of joint {}", i + 1), value });
            }
        }
        Ok(())
    }

    /// Gravity that pulls another way than along the first axis does.
    fn sees_the_base_turn(&self) -> bool {
        self.gravity[0].hypot(self.gravity[1]) > UPRIGHT * self.gravity[2].abs()
    }

    fn unseen(&self, lost: &Lost) -> Option<Unseen> {
        let &joint = lost.joints.first().filter(|joint| lost.alone && lost.hidden != Some(**joint))?;
        let name = joint + 1;
        Some(Unseen {
            cause: "no-moment",
            because: format!(
                "gravity makes no moment about the axis of joint {name}: it is upright, or carries no stated mass"
            ),
            remedy: format!("hold joint.{name}.compliance: nothing depends on it while the arm stands so"),
        })
    }
}

impl FromStated for Compliance {
    const KIND: &'static str = "compliance";

    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self> {
        let rad_per_nm = given.take("compliance_rad_per_nm", &[joints])?;
        let masses_kg = given.take("masses_kg", &[joints])?;
        let centres_mm = given.take("centres_mm", &[joints, 3])?;
        let gravity = given.take("gravity", &[3])?;
        let payload_kg = given.take("payload_kg", &[1])?[0];
        let body = |(&mass_kg, c): (&f64, &[f64])| Body { mass_kg, centre_mm: [c[0], c[1], c[2]] };
        let bodies = masses_kg.iter().zip(centres_mm.chunks_exact(3)).map(body).collect();
        Ok(Compliance { rad_per_nm, bodies, gravity: [gravity[0], gravity[1], gravity[2]], payload_kg })
    }
}
