//! The forward map and its derivatives for a vector of poses: no allocation in the loop.
//!
//! A point is carried from the tip to the base (`forward`), remembering in each joint's frame what the derivatives
//! need. A direction is carried back from the base to the tip (`gradient`), giving the derivative of `direction · p`
//! with respect to every parameter on the way: about as much work as the map itself. Every residual is such a
//! direction or three, so the 3 × parameters Jacobian of a pose is never formed.

use super::compliance;
use super::effects::{ColumnsWithEffects, EFFECT_SLOTS, ForwardWithEffects};
use super::turned::turned;
use crate::kinematics::chain::{Chain, Link};
use crate::kinematics::poses::Poses;
use crate::simd::{Lanes, PAD};
use pulp::Simd;

/// Vectors remembered for each joint: sin and cos of the turn, X, Y and z of the point, and x, z before beta.
const SLOTS: usize = 7;

/// Where things stand in the scratch of a chain, in vectors.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub(super) effects: usize,
    pub(super) tip: usize,
    /// of each parameter that adds to the angle of an encoder: its derivative
    pub(super) shapes: usize,
    pub(super) compliance: usize,
    /// the tip from the origin of the first axis, along the axes of the base frame
    pub(super) base: usize,
    pub(super) kept: usize,
    end: usize,
}

impl Layout {
    #[inline(always)]
    pub(super) fn of(chain: &Chain) -> Layout {
        let n = chain.links.len();
        let effects = n * SLOTS;
        let tip = effects + n * EFFECT_SLOTS;
        let shapes = tip + 3;
        let compliance = shapes + chain.columns.on_encoders;
        let base = compliance + if chain.carried.is_some() { n * compliance::SLOTS + compliance::MORE } else { 0 };
        let kept = base + if chain.base.is_some() { 3 } else { 0 };
        Layout { effects, tip, shapes, compliance, base, kept, end: kept + chain.turn_column() + 1 }
    }
}

/// Numbers of scratch that [`forward`] needs for a chain.
pub(crate) fn scratch_len(chain: &Chain) -> usize {
    Layout::of(chain).end * PAD
}

/// The part of the scratch from some vector on.
#[inline(always)]
pub(super) fn region<S: Simd>(scratch: &mut [f64], from: usize) -> &mut [f64] {
    let from = from * S::F64_LANES;
    let whole = (scratch.len() - from) / S::F64_LANES * S::F64_LANES;
    &mut scratch[from..from + whole]
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

/// Carries a point to the base; `turn` gives sine and cosine of each turn, the offset along the axis, and how far the link
/// is stretched.
#[inline(always)]
pub(super) fn carry<S: Simd>(
    simd: S,
    chain: &Chain,
    tip: [Lanes<S>; 3],
    scratch: &mut [f64],
    mut turn: impl FnMut(&mut [f64], usize, &Link) -> ((Lanes<S>, Lanes<S>), Lanes<S>, Option<Lanes<S>>),
) -> [Lanes<S>; 3] {
    let c = |value: f64| Lanes::splat(simd, value);
    let [mut x, mut y, mut z] = tip;
    for (i, link) in chain.links.iter().enumerate().rev() {
        let slot = i * SLOTS;
        let ((sin, cos), along, stretch) = turn(scratch, i, link);
        if let Some((cos_beta, sin_beta)) = link.beta {
            [x, z] = turned([x, z], c(sin_beta), c(cos_beta));
            x.store(scratch, slot + 5);
            z.store(scratch, slot + 6);
        }
        if !link.bare {
            [z, y] = turned([z, y], c(link.sin_alpha), c(link.cos_alpha));
            z.store(scratch, slot + 4);
            x = match stretch {
                None => x + c(link.a),
                Some(stretch) => stretch.mul_add(c(link.a), x),
            };
        }
        if !link.bare || link.slides {
            z = match stretch {
                None => z + along,
                Some(stretch) => stretch.mul_add(along, z),
            };
        }
        sin.store(scratch, slot);
        cos.store(scratch, slot + 1);
        x.store(scratch, slot + 2);
        y.store(scratch, slot + 3);
        [y, x] = turned([y, x], sin, cos);
    }
    [x, y, z]
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

/// Emits what joint `i` has: the derivatives with respect to its turn, alpha, a and d or beta.
#[inline(always)]
pub(super) fn place<S: Simd>(
    chain: &Chain,
    i: usize,
    [turn, alpha, a, fourth]: [Lanes<S>; 4],
    emit: &mut impl FnMut(usize, Lanes<S>),
) {
    if !chain.links[i].bare {
        emit(4 * i, -turn);
        emit(4 * i + 1, alpha);
        emit(4 * i + 2, a);
        emit(4 * i + 3, fourth);
    }
    if i + 1 == chain.links.len() {
        emit(chain.turn_column(), turn);
    }
}

/// Carries a direction through joint `i`; returns the derivatives with respect to its turn (of a bare last joint that
/// slides: its shift), alpha, a and d or beta.
#[inline(always)]
pub(super) fn through<S: Simd>(
    simd: S,
    link: &Link,
    i: usize,
    scratch: &[f64],
    direction: &mut [Lanes<S>; 3],
) -> [Lanes<S>; 4] {
    let c = |value: f64| Lanes::splat(simd, value);
    let at = |slot: usize| Lanes::load(simd, scratch, i * SLOTS + slot);
    let [mut gx, mut gy, mut gz] = *direction;
    let (sin, cos, x, y) = (at(0), at(1), at(2), at(3));
    [gx, gy] = turned([gx, gy], sin, cos);
    // direction · (z × p) = x gy - y gx
    let turn = x.mul_add(gy, -(y * gx));
    if link.bare {
        *direction = [gx, gy, gz];
        return [if link.slides { gz } else { turn }, c(0.0), c(0.0), c(0.0)];
    }
    let z = at(4);
    let (alpha, a, d) = (gz.mul_add(y, -(gy * z)), gx, gz);
    [gy, gz] = turned([gy, gz], c(link.sin_alpha), c(link.cos_alpha));
    let mut fourth = d;
    if let Some((cos_beta, sin_beta)) = link.beta {
        let (x, z) = (at(5), at(6));
        fourth = gx.mul_add(z, -(gz * x));
        [gz, gx] = turned([gz, gx], c(sin_beta), c(cos_beta));
    }
    *direction = [gx, gy, gz];
    [turn, alpha, a, fourth]
}
