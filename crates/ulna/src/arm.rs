//! An arm: joints from the base to the probe, and the probes it carries.
//!
//! `turn_i = sign_i * q_i - theta0_i`; see [`crate::kinematics`] for the map. Lengths are mm, angles rad, always.
//! The order of parameters is fixed: four for each joint but the last, then x, y, z of each probe.

use crate::error::{Error, Result};

/// How the step from one joint's frame to the next is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointModel {
    /// `Rz(turn) · Tz(d) · Tx(a) · Rx(alpha)` (Denavit and Hartenberg 1955).
    Dh,
    /// `Rz(turn) · Tx(a) · Rx(alpha) · Ry(beta)` (Hayati 1983), for an axis nearly parallel to the next.
    Hayati,
}

/// Geometry of one joint but the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Encoder reading at which the joint's turn is zero, rad (after the sign).
    pub theta0_rad: f64,
    /// Twist from this axis to the next, rad.
    pub alpha_rad: f64,
    /// Link length, mm (`l` in Cheng 2011).
    pub a_mm: f64,
    /// Offset along this axis, mm ([`JointModel::Dh`]); unused for Hayati.
    pub d_mm: f64,
    /// Second tilt of the next axis, rad ([`JointModel::Hayati`]); unused for DH.
    pub beta_rad: f64,
    /// +1 or -1: whether the encoder counts with the joint's axis or against it.
    pub sign: f64,
    /// How the four numbers are used.
    pub model: JointModel,
}

impl Joint {
    /// The joint's four parameters in the order of [`Arm::parameter_names`].
    pub fn parameters(&self) -> [f64; 4] {
        let last = match self.model {
            JointModel::Dh => self.d_mm,
            JointModel::Hayati => self.beta_rad,
        };
        [self.theta0_rad, self.alpha_rad, self.a_mm, last]
    }

    /// The same joint with other numbers, in the same order.
    pub fn with_parameters(&self, p: &[f64]) -> Joint {
        let mut joint = Joint { theta0_rad: p[0], alpha_rad: p[1], a_mm: p[2], ..*self };
        match self.model {
            JointModel::Dh => joint.d_mm = p[3],
            JointModel::Hayati => joint.beta_rad = p[3],
        }
        joint
    }
}

/// A probe: a name and the tip, a point that turns with the last joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name in files and parameter names.
    pub name: String,
    /// x, y, z of the tip in the frame of the last joint, mm.
    pub tip_mm: [f64; 3],
}

/// What a parameter is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// radian
    Rad,
    /// millimetre
    Mm,
}

impl Unit {
    /// `"rad"` or `"mm"`.
    pub fn as_str(self) -> &'static str {
        match self {
            Unit::Rad => "rad",
            Unit::Mm => "mm",
        }
    }
}

/// An articulated arm with one probe or more.
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    joints: Vec<Joint>,
    last_sign: f64,
    probes: Vec<Probe>,
}

impl Arm {
    /// An arm of `joints.len() + 1` encoders: the last joint has no geometry but its sign.
    ///
    /// # Errors
    /// No joint before the last, no probe, a sign that is not ±1, or a number that is not finite.
    pub fn new(joints: Vec<Joint>, last_sign: f64, probes: Vec<Probe>) -> Result<Arm> {
        if joints.is_empty() {
            return Err(Error::TooFewJoints(joints.len() + 1));
        }
        if probes.is_empty() {
            return Err(Error::NoProbe);
        }
        let arm = Arm { joints, last_sign, probes };
        for (i, sign) in arm.signs().enumerate() {
            if sign.abs() != 1.0 {
                return Err(Error::OutOfRange {
                    what: format!("the sign of joint {}", i + 1),
                    value: sign,
                    expected: "+1 or -1",
                });
            }
        }
        for (name, value) in arm.parameter_names().into_iter().zip(arm.parameters()) {
            if !value.is_finite() {
                return Err(Error::NotFinite { what: name, value });
            }
        }
        Ok(arm)
    }

    /// Number of encoders, n.
    pub fn encoders(&self) -> usize {
        self.joints.len() + 1
    }

    /// The joints with geometry: all but the last.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The probes in their order.
    pub fn probes(&self) -> &[Probe] {
        &self.probes
    }

    /// The sign of every encoder, the last included.
    pub fn signs(&self) -> impl Iterator<Item = f64> + '_ {
        self.joints.iter().map(|j| j.sign).chain(std::iter::once(self.last_sign))
    }

    /// Number of parameters of the joints, 4(n-1).
    pub fn joint_parameter_count(&self) -> usize {
        4 * self.joints.len()
    }

    /// Number of all parameters, 4(n-1) + 3 for each probe.
    pub fn parameter_count(&self) -> usize {
        self.joint_parameter_count() + 3 * self.probes.len()
    }

    /// Index of the first of a probe's three parameters.
    pub fn tip_offset(&self, probe: usize) -> usize {
        self.joint_parameter_count() + 3 * probe
    }

    /// `joint.1.theta0 … probe.bent.z`, in the order of [`Arm::parameters`].
    pub fn parameter_names(&self) -> Vec<String> {
        let mut names = Vec::with_capacity(self.parameter_count());
        for (i, joint) in self.joints.iter().enumerate() {
            let fourth = match joint.model {
                JointModel::Dh => "d",
                JointModel::Hayati => "beta",
            };
            names.extend(["theta0", "alpha", "a", fourth].map(|p| format!("joint.{}.{p}", i + 1)));
        }
        for probe in &self.probes {
            names.extend(["x", "y", "z"].map(|axis| format!("probe.{}.{axis}", probe.name)));
        }
        names
    }

    /// The unit of each parameter.
    pub fn parameter_units(&self) -> Vec<Unit> {
        let mut units = Vec::with_capacity(self.parameter_count());
        for joint in &self.joints {
            units.extend([Unit::Rad, Unit::Rad, Unit::Mm]);
            units.push(match joint.model {
                JointModel::Dh => Unit::Mm,
                JointModel::Hayati => Unit::Rad,
            });
        }
        units.resize(self.parameter_count(), Unit::Mm);
        units
    }

    /// All parameters, rad and mm.
    pub fn parameters(&self) -> Vec<f64> {
        let joints = self.joints.iter().flat_map(Joint::parameters);
        let tips = self.probes.iter().flat_map(|p| p.tip_mm);
        joints.chain(tips).collect()
    }

    /// The same arm with other numbers.
    ///
    /// # Errors
    /// Another count of parameters, or a value that is not finite.
    pub fn with_parameters(&self, parameters: &[f64]) -> Result<Arm> {
        if parameters.len() != self.parameter_count() {
            return Err(Error::Shape {
                what: "the parameter vector".into(),
                got: parameters.len(),
                expected: self.parameter_count(),
            });
        }
        let (joints, tips) = parameters.split_at(self.joint_parameter_count());
        let joints = self.joints.iter().zip(joints.chunks_exact(4));
        let probes = self.probes.iter().zip(tips.chunks_exact(3));
        Arm::new(
            joints.map(|(j, p)| j.with_parameters(p)).collect(),
            self.last_sign,
            probes.map(|(probe, t)| Probe { name: probe.name.clone(), tip_mm: [t[0], t[1], t[2]] }).collect(),
        )
    }

    /// Sum of the lengths of all links and the tip, mm: nothing is farther from the base.
    pub fn reach_mm(&self, probe: usize) -> f64 {
        let links: f64 = self.joints.iter().map(|j| j.a_mm.hypot(j.d_mm)).sum();
        links + self.probes[probe].tip_mm.iter().map(|t| t * t).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
pub(crate) mod samples {
    use super::*;

    /// Table 2 of Cheng 2011 (assumed truth) with a probe at r, theta0 = 0, h = 200.
    pub fn table2(r: f64) -> Arm {
        let h = std::f64::consts::FRAC_PI_2;
        arm(
            &[
                [0.0, -h, 40.0, 250.0],
                [2.2689, h, -40.0, 0.0],
                [0.0, -h, 30.0, 450.0],
                [2.2689, h, -30.0, 0.0],
                [0.0, -h, 30.0, 450.0],
                [2.2689, h, -30.0, 0.0],
            ],
            [r, 0.0, 200.0],
        )
    }

    /// A DH arm with all signs +1 and one probe named `bent`.
    pub fn arm(dh: &[[f64; 4]], tip_mm: [f64; 3]) -> Arm {
        let joint = |p: &[f64; 4]| Joint {
            theta0_rad: p[0],
            alpha_rad: p[1],
            a_mm: p[2],
            d_mm: p[3],
            beta_rad: 0.0,
            sign: 1.0,
            model: JointModel::Dh,
        };
        let probe = Probe { name: "bent".into(), tip_mm };
        Arm::new(dh.iter().map(joint).collect(), 1.0, vec![probe]).unwrap()
    }
}
