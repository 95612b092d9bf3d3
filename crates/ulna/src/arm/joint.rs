//! One joint and the link after it.

/// How the step from one joint's frame to the next is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointModel {
    /// `Rz(turn) · Tz(d) · Tx(a) · Rx(alpha)` (Denavit and Hartenberg 1955).
    Dh,
    /// `Rz(turn) · Tx(a) · Rx(alpha) · Ry(beta)` (Hayati 1983), for an axis nearly parallel to the next.
    Hayati,
}

/// Geometry of one joint.
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
    /// A joint of Denavit and Hartenberg from a row of their table: theta0 and alpha in rad, a and d in mm; its encoder
    /// counts with its axis.
    pub const fn dh([theta0_rad, alpha_rad, a_mm, d_mm]: [f64; 4]) -> Joint {
        Joint { theta0_rad, alpha_rad, a_mm, d_mm, beta_rad: 0.0, sign: 1.0, model: JointModel::Dh }
    }

    /// The joint's four parameters in the order of [`super::Arm::parameter_names`].
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
