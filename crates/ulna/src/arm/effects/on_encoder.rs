//! What an effect owes that adds to the angle of an encoder.

use super::effect::Effect;
use crate::simd::Lanes;
use pulp::Simd;
use std::ops::Range;

/// What a joint's encoder said at a pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Encoder<'a> {
    /// Its angle, rad.
    pub q_rad: f64,
    /// Those of all encoders.
    pub all_rad: &'a [f64],
    /// From which side it was approached: +1 where the angle had been rising, -1 where it had been falling, 0 unknown.
    pub approach: f64,
}

/// The same for a vector of poses; what nobody asks for is not computed.
pub(crate) trait EncoderLanes<S: Simd> {
    /// Sine and cosine of its angle.
    fn sin_cos(&self) -> (Lanes<S>, Lanes<S>);
    /// From which side it was approached.
    fn approach(&self) -> Lanes<S>;
    /// The angle of some joint's encoder, rad.
    fn angle(&self, joint: usize) -> Lanes<S>;
}

/// An effect that adds to the angle of each encoder: `Σ parameter · shape`, the shapes known functions of what it said.
pub(crate) trait OnEncoder: Effect {
    /// Shapes of one joint, as many as suffixes.
    fn shapes(&self, joint: usize, at: Encoder) -> Vec<f64>;

    /// Their derivatives with respect to the joint's own encoder's angle.
    fn slopes(&self, joint: usize, at: Encoder) -> Vec<f64>;

    /// Which of its values are a joint's.
    fn of_joint(&self, joint: usize) -> Range<usize>;

    /// Calls `each` with number among the joint's own and values of each shape, for a vector of poses.
    fn shapes_in_lanes<S: Simd>(
        &self,
        simd: S,
        joint: usize,
        at: &impl EncoderLanes<S>,
        each: impl FnMut(usize, Lanes<S>),
    ) where
        Self: Sized;
}
