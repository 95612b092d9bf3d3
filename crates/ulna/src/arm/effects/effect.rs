//! What every effect owes: its parameters, what is known of them, why readings may not show them; and what one that adds
//! to an encoder's angle owes beside that.

use super::stated::Stated;
use crate::arm::Unit;
use crate::error::Result;
use crate::simd::Lanes;
use pulp::Simd;
use std::fmt::Debug;

/// The parameters of one cause, as many for each joint, joint after joint.
pub trait Effect: Debug + Send + Sync {
    /// The word by which a study asks for it, such as `"backlash"`.
    fn kind(&self) -> &'static str;

    /// The last parts of the names of a joint's parameters: `c1`, `s1` of `joint.3.c1`, `joint.3.s1`.
    fn suffixes(&self) -> Vec<String>;

    /// What they are all measured in.
    fn unit(&self) -> Unit;

    /// Their values.
    fn values(&self) -> &[f64];

    /// Their values, to be changed.
    fn values_mut(&mut self) -> &mut [f64];

    /// How far a unit of a parameter moves the tip of an arm of this reach at the most, in round figures, mm.
    fn moves_mm(&self, reach_mm: f64) -> f64;

    /// Standard uncertainty of a parameter before any reading, where the arm's angles are known to `angle_rad`.
    fn known(&self, angle_rad: f64) -> f64;

    /// What is not a parameter makes sense.
    ///
    /// # Errors
    /// A number out of its range, or another count of numbers than joints.
    fn check(&self) -> Result<()> {
        Ok(())
    }

    /// Whether it tells a base turned about the first axis from one that is not.
    fn sees_the_base_turn(&self) -> bool {
        false
    }

    /// Why parameters of it that take part in a lost direction had no chance to show in the readings.
    fn unseen(&self, _: &Lost) -> Option<Unseen> {
        None
    }
}

impl dyn Effect + '_ {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.values().len() / self.suffixes().len().max(1)
    }

    /// Names of all parameters, such as `joint.3.c1`.
    pub fn names(&self) -> Vec<String> {
        let suffixes = self.suffixes();
        let of_joint = |joint| suffixes.iter().map(move |suffix| format!("joint.{joint}.{suffix}"));
        (1..=self.joints()).flat_map(of_joint).collect()
    }
}

/// How an effect is made of numbers that have names.
pub trait FromStated: Effect + Sized {
    /// The word by which a study asks for it.
    const KIND: &'static str;

    /// Of an arm with so many joints.
    ///
    /// # Errors
    /// An array that is missing or has another shape, or a number out of its range.
    fn from_stated(given: &mut Stated, joints: usize) -> Result<Self>;
}

/// What a joint's encoder said at a pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Encoder {
    /// Its angle, rad.
    pub q_rad: f64,
    /// From which side it was approached: +1 where the angle had been rising, -1 where it had been falling, 0 unknown.
    pub approach: f64,
}

/// The same for a vector of poses; what nobody asks for is not computed.
pub(crate) trait EncoderLanes<S: Simd> {
    /// Sine and cosine of its angle.
    fn sin_cos(&self) -> (Lanes<S>, Lanes<S>);
    /// From which side it was approached.
    fn approach(&self) -> Lanes<S>;
}

/// An effect that adds to the angle of each encoder: `Σ parameter · shape`, the shapes known functions of what it said.
pub(crate) trait OnEncoder: Effect {
    /// Shapes of one joint, as many as suffixes.
    fn shapes(&self, at: Encoder) -> Vec<f64>;

    /// Their derivatives with respect to the encoder's angle.
    fn slopes(&self, at: Encoder) -> Vec<f64>;

    /// How many there are of each joint.
    fn shapes_of_joint(&self) -> usize;

    /// Calls `each` with number and values of each shape, for a vector of poses.
    fn shapes_in_lanes<S: Simd>(&self, simd: S, at: &impl EncoderLanes<S>, each: impl FnMut(usize, Lanes<S>))
    where
        Self: Sized;
}

/// What readings show of what effects depend on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Seen {
    /// Lowest and highest temperature above 20 °C, K, where it is known.
    pub warmth_k: Option<(f64, f64)>,
    /// Lowest and highest approach of each joint; empty where none is known.
    pub approach: Vec<(f64, f64)>,
}

impl Seen {
    /// The readings of both. Where one does not say how joints were approached it counts as 0.
    pub fn and(self, other: Seen) -> Seen {
        let widest = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        let joints = self.approach.len().max(other.approach.len());
        let of = |seen: &Seen, joint: usize| seen.approach.get(joint).copied().unwrap_or_default();
        Seen {
            approach: (0..joints).map(|joint| widest(of(&self, joint), of(&other, joint))).collect(),
            warmth_k: match (self.warmth_k, other.warmth_k) {
                (Some(one), Some(another)) => Some(widest(one, another)),
                (one, another) => one.or(another),
            },
        }
    }
}

/// A lost direction, as one effect sees it.
#[derive(Debug, Clone, Copy)]
pub struct Lost<'a> {
    /// Joints of which parameters of this effect take part.
    pub joints: &'a [usize],
    /// Whether a single parameter takes part, and no other.
    pub alone: bool,
    /// The last joint, where turning it moves no tip that was read with.
    pub hidden: Option<usize>,
    /// What the readings show.
    pub seen: &'a Seen,
}

/// Why a parameter did not show, and what would help.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The word for it in files.
    pub cause: &'static str,
    /// In words.
    pub because: String,
    /// What would help.
    pub remedy: String,
}
