//! Gravity's moments about the axes and what depends on them, for vectors of poses.
//!
//! The moment about axis i is `∂/∂turn_i` of `pull · S`, with S the mass times centre of all that the arm carries:
//! a point of many kilograms, carried to the base as the tip is. A tip that follows the moments by weights `w_i` follows a
//! parameter by the gradient of `Σ w_i M_i`: the derivative of `pull · S` along the turns w, differentiated once more, by
//! carrying S together with its tangent out and their adjoints back.

use super::turned::turned;
use crate::kinematics::carried::Carried;
use crate::kinematics::chain::{Chain, Link};
use crate::kinematics::poses::Poses;
use crate::simd::Lanes;
use pulp::Simd;

/// Vectors remembered for each joint.
pub(super) const SLOTS: usize = 17;
/// Sine and cosine of the turn; S before the turn (x, y), before the shift (z) and before beta (x, z).
const SIN: usize = 0;
const COS: usize = 1;
const BODY: usize = 2;
/// The pull, in the same frame as S before the turn.
const PULL: usize = 7;
const MOMENT: usize = 10;
/// As BODY, of the tangent.
const TANGENT: usize = 11;
const WEIGHT: usize = 16;

/// Vectors behind those of the joints: the mass of what each pose carries beside the arm's own, kg.
pub(super) const MORE: usize = 1;

/// Mass of what the poses carried beside the arm's own.
#[inline(always)]
fn carried_kg<S: Simd>(simd: S, chain: &Chain, region: &[f64]) -> Lanes<S> {
    Lanes::load(simd, region, chain.links.len() * SLOTS)
}

/// A vector of the region and joint `i`.
#[inline(always)]
fn load<S: Simd>(simd: S, region: &[f64], i: usize, slot: usize) -> Lanes<S> {
    Lanes::load(simd, region, i * SLOTS + slot)
}

/// Carries a vector from the next joint's frame in over beta and alpha; leaves at `of` what the derivatives need of it.
#[inline(always)]
fn before_tilts<S: Simd>(
    simd: S,
    link: &Link,
    [mut x, mut y, mut z]: [Lanes<S>; 3],
    region: &mut [f64],
    of: usize,
) -> [Lanes<S>; 3] {
    let c = |value: f64| Lanes::splat(simd, value);
    if let Some((cos_beta, sin_beta)) = link.beta {
        [x, z] = turned([x, z], c(sin_beta), c(cos_beta));
        x.store(region, of + 3);
        z.store(region, of + 4);
    }
    if !link.bare {
        [z, y] = turned([z, y], c(link.sin_alpha), c(link.cos_alpha));
        z.store(region, of + 2);
    }
    [x, y, z]
}

/// Carries all weight of vector `k` of poses to the base and the pull back out: leaves the moments in the region.
#[inline(always)]
pub(super) fn prepare<S: Simd>(simd: S, chain: &Chain, carried: &Carried, poses: &Poses, k: usize, region: &mut [f64]) {
    let c = |value: f64| Lanes::splat(simd, value);
    // what is carried hangs on the last joint, as the probe does
    let [load_kg, x, y, z] = poses.payload(simd, k).unwrap_or([c(0.0); 4]);
    load_kg.store(region, chain.links.len() * SLOTS);
    let [mut x, mut y, mut z] = [x, y, z].map(|centre| centre * load_kg);
    for (i, link) in chain.links.iter().enumerate().rev() {
        let slot = i * SLOTS;
        let body = carried.first_moments[i];
        let mass = load_kg + c(carried.masses[i]);
        (x, y, z) = (x + c(body[0]), y + c(body[1]), z + c(body[2]));
        [x, y, z] = before_tilts(simd, link, [x, y, z], region, slot + BODY);
        if !link.bare {
            x = mass.mul_add(c(link.a), x);
            z = mass.mul_add(poses.along(simd, link, i, k), z);
        } else if link.slides {
            z = mass.mul_add(poses.along(simd, link, i, k), z);
        }
        let (sin, cos) = poses.turn(simd, link, i, k);
        sin.store(region, slot + SIN);
        cos.store(region, slot + COS);
        x.store(region, slot + BODY);
        y.store(region, slot + BODY + 1);
        [y, x] = turned([y, x], sin, cos);
    }
    let [mut gx, mut gy, mut gz] = carried.pull.map(c);
    for (i, link) in chain.links.iter().enumerate() {
        let (sin, cos) = (load(simd, region, i, SIN), load(simd, region, i, COS));
        [gx, gy] = turned([gx, gy], sin, cos);
        let (x, y) = (load(simd, region, i, BODY), load(simd, region, i, BODY + 1));
        for (axis, g) in [gx, gy, gz].into_iter().enumerate() {
            g.store(region, i * SLOTS + PULL + axis);
        }
        x.mul_add(gy, -(y * gx)).store(region, i * SLOTS + MOMENT);
        if link.bare {
            continue;
        }
        [gy, gz] = turned([gy, gz], c(link.sin_alpha), c(link.cos_alpha));
        if let Some((cos_beta, sin_beta)) = link.beta {
            [gz, gx] = turned([gz, gx], c(sin_beta), c(cos_beta));
        }
    }
}

/// Gravity's moment about axis `i`, N m.
#[inline(always)]
pub(super) fn moment<S: Simd>(simd: S, region: &[f64], i: usize) -> Lanes<S> {
    load(simd, region, i, MOMENT)
}

/// Remembers how far the tip follows the moment about axis `i`.
#[inline(always)]
pub(super) fn weigh<S: Simd>(region: &mut [f64], i: usize, weight: Lanes<S>) {
    weight.store(region, i * SLOTS + WEIGHT);
}

/// Calls `each` with joint i and the derivatives of `Σ w M` with respect to its turn (of a bare last joint that slides:
/// its shift), alpha, a and d or beta.
#[inline(always)]
pub(super) fn derivatives<S: Simd>(
    simd: S,
    chain: &Chain,
    carried: &Carried,
    region: &mut [f64],
    mut each: impl FnMut(usize, [Lanes<S>; 4]),
) {
    let c = |value: f64| Lanes::splat(simd, value);
    let (zero, load_kg) = (c(0.0), carried_kg(simd, chain, region));
    // the tangent of S along the turns w, carried to the base
    let [mut x, mut y, mut z] = [zero; 3];
    for (i, link) in chain.links.iter().enumerate().rev() {
        let slot = i * SLOTS;
        [x, y, z] = before_tilts(simd, link, [x, y, z], region, slot + TANGENT);
        if !link.bare {
            y.store(region, slot + TANGENT + 1);
        }
        let w = load(simd, region, i, WEIGHT);
        // what joint i adds, still before its turn: w z × S
        let (turned_x, turned_y) =
            (load(simd, region, i, BODY + 1).neg_mul_add(w, x), load(simd, region, i, BODY).mul_add(w, y));
        // of the frame after the turn are x and y; the link's own y stays as it is
        turned_x.store(region, slot + TANGENT);
        let (sin, cos) = (load(simd, region, i, SIN), load(simd, region, i, COS));
        [y, x] = turned([turned_y, turned_x], sin, cos);
    }
    // the adjoint of S, carried back out; that of the tangent is the pull
    let [mut hx, mut hy, mut hz] = [zero; 3];
    for (i, link) in chain.links.iter().enumerate() {
        let at = |slot: usize| load(simd, region, i, slot);
        let (sin, cos, w) = (at(SIN), at(COS), at(WEIGHT));
        [hx, hy] = turned([hx, hy], sin, cos);
        let (x, y, link_y) = (at(BODY), at(BODY + 1), at(TANGENT + 1));
        let (gx, gy, gz) = (at(PULL), at(PULL + 1), at(PULL + 2));
        let turned_x = at(TANGENT);
        let turned_y = x.mul_add(w, if link.bare { zero } else { link_y });
        let turn = x.mul_add(hy, -(y * hx)) + turned_x.mul_add(gy, -(turned_y * gx));
        hx = gy.mul_add(w, hx);
        hy = gx.neg_mul_add(w, hy);
        let mass = load_kg + c(carried.masses[i]);
        if link.bare {
            each(i, [if link.slides { hz * mass } else { turn }, zero, zero, zero]);
            continue;
        }
        let (z, link_z) = (at(BODY + 2), at(TANGENT + 2));
        let alpha = hz.mul_add(y, -(hy * z)) + gz.mul_add(link_y, -(gy * link_z));
        let (a, d) = (hx * mass, hz * mass);
        [hy, hz] = turned([hy, hz], c(link.sin_alpha), c(link.cos_alpha));
        let mut fourth = d;
        if let Some((cos_beta, sin_beta)) = link.beta {
            // the pull in the frame between alpha and beta
            let between = gz.mul_add(c(link.cos_alpha), -(gy * c(link.sin_alpha)));
            let (x, z) = (at(BODY + 3), at(BODY + 4));
            let (tangent_x, tangent_z) = (at(TANGENT + 3), at(TANGENT + 4));
            fourth = hx.mul_add(z, -(hz * x)) + gx.mul_add(tangent_z, -(between * tangent_x));
            [hz, hx] = turned([hz, hx], c(sin_beta), c(cos_beta));
        }
        each(i, [turn, alpha, a, fourth]);
    }
}
