//! The forward map and its derivatives of an arm with effects beyond its geometry, apart from the plain ones so that these
//! stay small.

use super::compliance;
use super::steps::{EFFECT_SLOTS, Layout, carry, place, region, through};
use crate::kinematics::chain::Chain;
use crate::kinematics::poses::{EncoderOf, Poses};
use crate::simd::Lanes;
use pulp::{NullaryFnOnce, Simd};

/// Which of the vectors remembered for each joint is what.
const WARMTH: usize = 0;
const STRETCH: usize = 1;
const ALONG: usize = 2;

/// [`forward`](super::kernel::forward) of an arm with effects.
pub(super) struct ForwardWithEffects<'a, S: Simd> {
    pub(super) simd: S,
    pub(super) chain: &'a Chain,
    pub(super) poses: &'a Poses,
    pub(super) k: usize,
    pub(super) tip: [Lanes<S>; 3],
    pub(super) scratch: &'a mut [f64],
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
                let along = poses.along(simd, link, i, k);
                own(scratch, i, WARMTH, poses.warmth(simd, i, k));
                own(scratch, i, STRETCH, stretch(i));
                own(scratch, i, ALONG, along);
                if link.slides {
                    // nothing adds to a turn that there is not
                    chain.columns.of_encoder(i).for_each(|parameter| c(0.0).store(scratch, layout.shapes + parameter));
                    return (poses.turn(simd, link, i, k), along, Some(stretch(i)));
                }
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
                (turn, along, Some(stretch(i)))
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

/// [`gradient`](super::kernel::gradient) of an arm with effects.
pub(super) struct ColumnsWithEffects<'a, S: Simd> {
    pub(super) simd: S,
    pub(super) chain: &'a Chain,
    pub(super) scratch: &'a mut [f64],
    pub(super) direction: [Lanes<S>; 3],
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
        let stretch = own(STRETCH);
        // a shift of a bare joint grows as its link would
        let turn = if link.bare && link.slides { turn * stretch } else { turn };
        let (along_d, fourth) = match link.beta {
            None => (fourth, fourth * stretch),
            Some(_) => (Lanes::splat(simd, 0.0), fourth),
        };
        if grows {
            let length = |value: f64| Lanes::splat(simd, value);
            let grown = match (link.bare, link.slides) {
                (true, false) => length(0.0),
                // the direction along the axis
                (true, true) => g[2] * own(ALONG),
                (false, _) => a.mul_add(length(link.a), along_d * own(ALONG)),
            };
            (own(WARMTH) * grown).store(kept, expansion + i);
        }
        place(chain, i, [turn, alpha, a * stretch, fourth], &mut |column, value| value.store(kept, column));
    }
    let own = |slot: usize| Lanes::load(simd, below, layout.effects + last * EFFECT_SLOTS + slot);
    let mut grown = Lanes::splat(simd, 0.0);
    for (axis, value) in g.into_iter().enumerate() {
        (value * own(STRETCH)).store(kept, joints + axis);
        grown = value.mul_add(Lanes::load(simd, below, layout.tip + axis), grown);
    }
    if grows {
        let link = Lanes::load(simd, kept, expansion + last);
        grown.mul_add(own(WARMTH), link).store(kept, expansion + last);
    }
    if let (Some(carried), Some(bending)) = (&chain.carried, &chain.effects.compliance) {
        let weight = region::<S>(below, layout.compliance);
        for (i, link) in chain.links.iter().enumerate() {
            let turn =
                if link.bare { Lanes::load(simd, kept, chain.turn_column()) } else { -Lanes::load(simd, kept, 4 * i) };
            // what slides gives way to no moment
            let turn = if link.slides { Lanes::splat(simd, 0.0) } else { turn };
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
