//! The one thing that a joint and its link do to any vector, point or direction, inwards or outwards.

use crate::simd::Lanes;
use pulp::Simd;

/// Two coordinates of a vector in axes turned by an angle from the first towards the second; with the two named the other
/// way round, in axes turned back.
#[inline(always)]
pub(super) fn turned<S: Simd>([a, b]: [Lanes<S>; 2], sin: Lanes<S>, cos: Lanes<S>) -> [Lanes<S>; 2] {
    [b.mul_add(sin, a * cos), a.neg_mul_add(sin, b * cos)]
}
