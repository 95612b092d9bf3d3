//! One pose.

/// Encoder angles of one pose, and how warm the arm was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<'a> {
    /// One for each encoder, rad.
    pub q_rad: &'a [f64],
    /// Temperature above 20 °C: of the arm, or of each joint's link; empty for 20 °C.
    pub warmth_k: &'a [f64],
}

impl Pose<'_> {
    /// Temperature of a joint's link above 20 °C.
    pub fn warmth_k(&self, joint: usize) -> f64 {
        match self.warmth_k {
            [] => 0.0,
            [all] => *all,
            each => each[joint],
        }
    }
}

impl<'a, T: AsRef<[f64]> + ?Sized> From<&'a T> for Pose<'a> {
    fn from(q_rad: &'a T) -> Self {
        Pose { q_rad: q_rad.as_ref(), warmth_k: &[] }
    }
}

/// A pose of a reading, and the probe that took it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Index of the probe.
    pub probe: usize,
    /// Encoder angles, rad.
    pub q_rad: Vec<f64>,
    /// As in [`Pose`].
    pub warmth_k: Vec<f64>,
}

impl Sample {
    /// The pose alone.
    pub fn pose(&self) -> Pose<'_> {
        Pose { q_rad: &self.q_rad, warmth_k: &self.warmth_k }
    }
}
