//! The forward map and its derivatives for a vector of poses: no allocation in the loop.
//!
//! A point is carried from the tip to the base (`forward`), remembering in each joint's frame what the derivatives
//! need. A direction is carried back from the base to the tip (`gradient`), giving the derivative of `direction · p`
//! with respect to every parameter on the way: about as much work as the map itself. Every residual is such a
//! direction or three, so the 3 × parameters Jacobian of a pose is never formed.

use super::effects::{ColumnsWithEffects, ForwardWithEffects};
use super::steps::{Layout, carry, place, through};
use crate::kinematics::chain::Chain;
use crate::kinematics::poses::Poses;
use crate::simd::{Lanes, PAD};
use pulp::Simd;

/// Numbers of scratch that [`forward`] needs for a chain.
pub(crate) fn scratch_len(chain: &Chain) -> usize {
    Layout::of(chain).end * PAD
}

/// Carries the tip of vector `k` of poses to the base; leaves in `scratch` what [`gradient`] needs.
#[inline(always)]
pub(crate) fn forward<S: Simd>(
    simd: S,
    chain: &Chain,
    poses: &Poses,
    k: usize,
    tip: [Lanes<S>; 3],
    scratch: &mut [f64],
) -> [Lanes<S>; 3] {
    if chain.has_effects() {
        // apart, so that the plain map stays small
        return simd.vectorize(ForwardWithEffects { simd, chain, poses, k, tip, scratch });
    }
    carry(
        simd,
        chain,
        tip,
        scratch,
        #[inline(always)]
        |_, i, link| (poses.turn(simd, link, i, k), poses.along(simd, link, i, k), None),
    )
}

/// Carries a direction of the base frame to the tip after [`forward`] and emits the derivative of `direction · p` in each
/// of the columns of [`Chain`].
#[inline(always)]
pub(crate) fn gradient<S: Simd>(
    simd: S,
    chain: &Chain,
    scratch: &mut [f64],
    direction: [Lanes<S>; 3],
    mut emit: impl FnMut(usize, Lanes<S>),
) {
    if chain.has_effects() {
        let kept = simd.vectorize(ColumnsWithEffects { simd, chain, scratch, direction });
        return (0..=chain.turn_column()).for_each(|column| emit(column, Lanes::load(simd, kept, column)));
    }
    let mut g = direction;
    for (i, link) in chain.links.iter().enumerate() {
        let columns = through(simd, link, i, scratch, &mut g);
        place(chain, i, columns, &mut emit);
    }
    let first = chain.joint_parameter_count();
    g.into_iter().enumerate().for_each(|(axis, value)| emit(first + axis, value));
}

/// [`gradient`] of `direction · (p - p')` for two poses at once: the difference is emitted, written once.
#[inline(always)]
pub(crate) fn gradient_between<S: Simd>(
    simd: S,
    chain: &Chain,
    scratch: &mut [Vec<f64>; 2],
    direction: [Lanes<S>; 3],
    mut emit: impl FnMut(usize, Lanes<S>),
) {
    let [first, second] = scratch;
    if chain.has_effects() {
        let first = simd.vectorize(ColumnsWithEffects { simd, chain, scratch: first, direction });
        let second = simd.vectorize(ColumnsWithEffects { simd, chain, scratch: second, direction });
        let kept = |columns: &[f64], column| Lanes::load(simd, columns, column);
        let difference = |column| kept(first, column) - kept(second, column);
        return (0..=chain.turn_column()).for_each(|column| emit(column, difference(column)));
    }
    let (mut g, mut h) = (direction, direction);
    for (i, link) in chain.links.iter().enumerate() {
        let columns = through(simd, link, i, first, &mut g);
        let others = through(simd, link, i, second, &mut h);
        let difference = [0, 1, 2, 3].map(|k| columns[k] - others[k]);
        place(chain, i, difference, &mut emit);
    }
    let at = chain.joint_parameter_count();
    (0..3).for_each(|axis| emit(at + axis, g[axis] - h[axis]));
}
