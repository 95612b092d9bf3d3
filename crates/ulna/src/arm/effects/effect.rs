//! What every effect owes: its parameters, what is known of them, why readings may not show them.

use super::seen::{Lost, Unseen};
use super::stated::Stated;
use crate::arm::unit::Unit;
use crate::error::Result;
use std::fmt::Debug;

/// The parameters of one cause, joint after joint.
pub trait Effect: Debug + Send + Sync {
    /// The word by which a study asks for it, such as `"backlash"`.
    fn kind(&self) -> &'static str;

    /// Number of joints that it was stated for.
    fn joints(&self) -> usize;

    /// The last parts of the names of a joint's parameters: `c1`, `s1` of `joint.3.c1`, `joint.3.s1`.
    fn suffixes(&self, joint: usize) -> Vec<String>;

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

    /// Whether it is small beside the geometry, which can be found first without it.
    fn is_small(&self) -> bool {
        true
    }

    /// Whether it says where the arm stands and nothing of the arm: readings that see the arm from nowhere but itself do not
    /// see it.
    fn of_base(&self) -> bool {
        false
    }

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
    /// Names of all parameters, such as `joint.3.c1`.
    pub fn names(&self) -> Vec<String> {
        let of_joint = |joint| {
            let suffixes = self.suffixes(joint).into_iter();
            suffixes.map(move |suffix| format!("joint.{}.{suffix}", joint + 1))
        };
        (0..self.joints()).flat_map(of_joint).collect()
    }

    /// The joint that one of its values belongs to.
    pub fn joint_of(&self, value: usize) -> usize {
        let mut behind = 0;
        let behind_joint = |&joint: &usize| {
            behind += self.suffixes(joint).len();
            value < behind
        };
        (0..self.joints()).find(behind_joint).unwrap_or_default()
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
