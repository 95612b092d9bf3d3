//! The forward map and its derivatives for a vector of poses: no allocation in the loop.
//!
//! A point is carried from the tip to the base (`forward`), remembering in each joint's frame what the derivatives
//! need. A direction is carried back from the base to the tip (`gradient`), giving the derivative of `direction · p`
//! with respect to every parameter on the way: about as much work as the map itself. Every residual is such a
//! direction or three, so the 3 × parameters Jacobian of a pose is never formed.

use super::compliance;
use super::turned::turned;
use crate::kinematics::chain::{Chain, Link};
use crate::kinematics::poses::{EncoderOf, Poses};
use crate::simd::{Lanes, PAD};
use pulp::{NullaryFnOnce, Simd};

/// Vectors remembered for each joint: sin and cos of the turn, X, Y and z of the point, and x, z before beta.
const SLOTS: usize = 7;
/// And of an arm with effects: warmth and stretch of the link.
const EFFECT_SLOTS: usize = 2;

/// Where things stand in the scratch of a chain, in vectors.
#[derive(Clone, Copy)]
struct Layout {
    effects: usize,
    tip: usize,
    /// of each parameter that adds to the angle of an encoder: its derivative
    shapes: usize,
    compliance: usize,
    /// the tip from the origin of the first axis, along the axes of the base frame
    base: usize,
    kept: usize,
    end: usize,
}

impl Layout {
    #[inline(always)]
    fn of(chain: &Chain) -> Layout {
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
fn region<S: Simd>(scratch: &mut [f64], from: usize) -> &mut [f64] {
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
        |_, i, link| (poses.turn(simd, link, i, k), None),
    )
}

/// [`forward`] of an arm with effects.
struct ForwardWithEffects<'a, S: Simd> {
    simd: S,
    chain: &'a Chain,
    poses: &'a Poses,
    k: usize,
    tip: [Lanes<S>; 3],
    scratch: &'a mut [f64],
}

impl<S: Simd> NullaryFnOnce for ForwardWithEffects<'_, S> {
    type Output = [Lanes<S>; 3];
    #[inline(always)]
    fn call(self) -> [Lanes<S>; 3] {
        let ForwardWithEffects { simd, chain, poses, k, tip, scratch } = self;
        let c = |value: f64| Lanes::splat(simd, value);
        let layout = Layout::of(chain);
        if let Some(carried) = &chain.carried {
            compliance::prepare(simd, chain, carried, poses, k, region::<S>(scratch, layout.compliance));
        }
        let last = chain.links.len() - 1;
        let stretch = |i: usize| {
            let epsilon = chain.effects.expansion.as_ref().map_or(0.0, |expansion| expansion.per_kelvin[i]);
            poses.warmth(simd, i, k).mul_add(c(epsilon), c(1.0))
        };
        let own = |scratch: &mut [f64], i: usize, slot: usize, value: Lanes<S>| {
            value.store(scratch, layout.effects + i * EFFECT_SLOTS + slot);
        };
        for (axis, value) in tip.into_iter().enumerate() {
            value.store(scratch, layout.tip + axis);
        }
        let stretched = tip.map(|value| value * stretch(last));
        let p = carry(
            simd,
            chain,
            stretched,
            scratch,
            #[inline(always)]
            |scratch, i, link| {
                let mut added = c(0.0);
                chain.effects.shapes_in_lanes(
                    simd,
                    i,
                    &EncoderOf { simd, poses, joint: i, k },
                    #[inline(always)]
                    |parameter, value, shape| {
                        shape.store(scratch, layout.shapes + parameter);
                        added = shape.mul_add(c(value), added);
                    },
                );
                added = added * c(link.sign);
                if let Some(compliance) = &chain.effects.compliance {
                    let moment = compliance::moment(simd, region::<S>(scratch, layout.compliance), i);
                    added = moment.mul_add(c(compliance.rad_per_nm[i]), added);
                }
                let (sin, cos) = poses.turn(simd, link, i, k);
                let (sin_added, cos_added) = added.sin_cos();
                let turn = (sin.mul_add(cos_added, cos * sin_added), sin.neg_mul_add(sin_added, cos * cos_added));
                own(scratch, i, 0, poses.warmth(simd, i, k));
                own(scratch, i, 1, stretch(i));
                (turn, Some(stretch(i)))
            },
        );
        let Some(base) = &chain.base else { return p };
        let from_base = [0, 1, 2].map(|row| {
            let along = |axis: usize| c(base.rotation[(row, axis)]);
            p[2].mul_add(along(2), p[1].mul_add(along(1), p[0] * along(0)))
        });
        (0..3).for_each(|axis| from_base[axis].store(scratch, layout.base + axis));
        [from_base[0] + c(base.offset[0]), from_base[1] + c(base.offset[1]), from_base[2]]
    }
}

/// Carries a point to the base; `turn` gives sine and cosine of each turn, and how far the link is stretched.
#[inline(always)]
fn carry<S: Simd>(
    simd: S,
    chain: &Chain,
    tip: [Lanes<S>; 3],
    scratch: &mut [f64],
    mut turn: impl FnMut(&mut [f64], usize, &Link) -> ((Lanes<S>, Lanes<S>), Option<Lanes<S>>),
) -> [Lanes<S>; 3] {
    let c = |value: f64| Lanes::splat(simd, value);
    let [mut x, mut y, mut z] = tip;
    for (i, link) in chain.links.iter().enumerate().rev() {
        let slot = i * SLOTS;
        let ((sin, cos), stretch) = turn(scratch, i, link);
        if let Some((cos_beta, sin_beta)) = link.beta {
            [x, z] = turned([x, z], c(sin_beta), c(cos_beta));
            x.store(scratch, slot + 5);
            z.store(scratch, slot + 6);
        }
        if !link.bare {
            [z, y] = turned([z, y], c(link.sin_alpha), c(link.cos_alpha));
            z.store(scratch, slot + 4);
            (x, z) = match stretch {
                None => (x + c(link.a), z + c(link.d)),
                Some(stretch) => (stretch.mul_add(c(link.a), x), stretch.mul_add(c(link.d), z)),
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
fn place<S: Simd>(
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

struct ColumnsWithEffects<'a, S: Simd> {
    simd: S,
    chain: &'a Chain,
    scratch: &'a mut [f64],
    direction: [Lanes<S>; 3],
}

impl<'a, S: Simd> NullaryFnOnce for ColumnsWithEffects<'a, S> {
    type Output = &'a mut [f64];
    #[inline(always)]
    fn call(self) -> &'a mut [f64] {
        columns_with_effects(self.simd, self.chain, self.scratch, self.direction)
    }
}

/// All columns of the derivative of `direction · p`, those of the effects too, in the part of the scratch returned.
#[inline(always)]
fn columns_with_effects<'a, S: Simd>(
    simd: S,
    chain: &Chain,
    scratch: &'a mut [f64],
    direction: [Lanes<S>; 3],
) -> &'a mut [f64] {
    let layout = Layout::of(chain);
    let joints = chain.joint_parameter_count();
    let last = chain.links.len() - 1;
    let effect = chain.effect_column();
    let (expansion, compliant) = (effect + chain.columns.expansion, effect + chain.columns.compliance);
    let grows = chain.effects.expansion.is_some();
    let (below, kept) = scratch.split_at_mut(layout.kept * S::F64_LANES);
    let kept = region::<S>(kept, 0);
    let mut g = direction;
    if let Some(base) = &chain.base {
        let p = [0, 1, 2].map(|axis| Lanes::load(simd, below, layout.base + axis));
        let c = |value: f64| Lanes::splat(simd, value);
        if chain.effects.base_tilt.is_some() {
            // g · (axis × p) = axis · (p × g)
            let moment = [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                p[j].neg_mul_add(g[i], p[i] * g[j])
            });
            for (k, axis) in base.axes.iter().enumerate() {
                let about = moment[2].mul_add(c(axis[2]), moment[1].mul_add(c(axis[1]), moment[0] * c(axis[0])));
                about.store(kept, effect + chain.columns.base_tilt + k);
            }
        }
        if chain.effects.base_offset.is_some() {
            (0..2).for_each(|k| g[k].store(kept, effect + chain.columns.base_offset + k));
        }
        g = [0, 1, 2].map(|axis| {
            let along = |row: usize| c(base.rotation[(row, axis)]);
            g[2].mul_add(along(2), g[1].mul_add(along(1), g[0] * along(0)))
        });
    }
    for (i, link) in chain.links.iter().enumerate() {
        let [turn, alpha, a, fourth] = through(simd, link, i, below, &mut g);
        let own = |slot: usize| Lanes::load(simd, below, layout.effects + i * EFFECT_SLOTS + slot);
        let signed = turn * Lanes::splat(simd, link.sign);
        for parameter in chain.columns.of_encoder(i) {
            (signed * Lanes::load(simd, below, layout.shapes + parameter)).store(kept, effect + parameter);
        }
        let stretch = own(1);
        let (along_d, fourth) = match link.beta {
            None => (fourth, fourth * stretch),
            Some(_) => (Lanes::splat(simd, 0.0), fourth),
        };
        if grows {
            let length = |value: f64| Lanes::splat(simd, value);
            let grown = if link.bare { length(0.0) } else { a.mul_add(length(link.a), along_d * length(link.d)) };
            (own(0) * grown).store(kept, expansion + i);
        }
        place(chain, i, [turn, alpha, a * stretch, fourth], &mut |column, value| value.store(kept, column));
    }
    let own = |slot: usize| Lanes::load(simd, below, layout.effects + last * EFFECT_SLOTS + slot);
    let mut grown = Lanes::splat(simd, 0.0);
    for (axis, value) in g.into_iter().enumerate() {
        (value * own(1)).store(kept, joints + axis);
        grown = value.mul_add(Lanes::load(simd, below, layout.tip + axis), grown);
    }
    if grows {
        let link = Lanes::load(simd, kept, expansion + last);
        grown.mul_add(own(0), link).store(kept, expansion + last);
    }
    if let (Some(carried), Some(bending)) = (&chain.carried, &chain.effects.compliance) {
        let weight = region::<S>(below, layout.compliance);
        for (i, link) in chain.links.iter().enumerate() {
            let turn =
                if link.bare { Lanes::load(simd, kept, chain.turn_column()) } else { -Lanes::load(simd, kept, 4 * i) };
            (turn * compliance::moment(simd, weight, i)).store(kept, compliant + i);
            compliance::weigh(weight, i, turn * Lanes::splat(simd, bending.rad_per_nm[i]));
        }
        compliance::derivatives(
            simd,
            chain,
            carried,
            weight,
            #[inline(always)]
            |i, added| {
                place(chain, i, added, &mut |column, value| {
                    (Lanes::load(simd, kept, column) + value).store(kept, column);
                });
            },
        );
    }
    kept
}

/// Carries a direction through joint `i`; returns the derivatives with respect to its turn, alpha, a and d or beta.
#[inline(always)]
fn through<S: Simd>(simd: S, link: &Link, i: usize, scratch: &[f64], direction: &mut [Lanes<S>; 3]) -> [Lanes<S>; 4] {
    let c = |value: f64| Lanes::splat(simd, value);
    let at = |slot: usize| Lanes::load(simd, scratch, i * SLOTS + slot);
    let [mut gx, mut gy, mut gz] = *direction;
    let (sin, cos, x, y) = (at(0), at(1), at(2), at(3));
    [gx, gy] = turned([gx, gy], sin, cos);
    // direction · (z × p) = x gy - y gx
    let turn = x.mul_add(gy, -(y * gx));
    if link.bare {
        *direction = [gx, gy, gz];
        return [turn, c(0.0), c(0.0), c(0.0)];
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
