//! A point carried in over one joint, a direction carried out over it, and where in the scratch they leave what they need:
//! the steps of the map and its derivatives, with effects and without.

use super::compliance;
use super::turned::turned;
use crate::kinematics::chain::{Chain, Link};
use crate::simd::Lanes;
use pulp::Simd;

/// Vectors remembered for each joint: sin and cos of the turn, X, Y and z of the point, and x, z before beta.
const SLOTS: usize = 7;
/// And of an arm with effects: warmth and stretch of the link, and the offset along the axis.
pub(super) const EFFECT_SLOTS: usize = 3;

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
    pub(super) end: usize,
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

/// The part of the scratch from some vector on.
#[inline(always)]
pub(super) fn region<S: Simd>(scratch: &mut [f64], from: usize) -> &mut [f64] {
    let from = from * S::F64_LANES;
    let whole = (scratch.len() - from) / S::F64_LANES * S::F64_LANES;
    &mut scratch[from..from + whole]
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
