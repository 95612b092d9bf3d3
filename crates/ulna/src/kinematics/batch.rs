//! The forward map and its derivatives over many readings at once: columns of numbers, SIMD lanes, no allocation in the loop.
//!
//! A point is carried from the tip to the base (`forward`), remembering in each joint's frame what the derivatives
//! need. A direction is carried back from the base to the tip (`gradient`), giving the derivative of `direction · p`
//! with respect to every parameter on the way: about as much work as the map itself. Every residual is such a
//! direction or three, so the 3 × parameters Jacobian of a pose is never formed.

use super::chain::{Chain, Link};
use super::poses::Poses;
use crate::simd::{Columns, Lanes, PAD};
use pulp::{Arch, Simd, WithSimd};

/// Vectors remembered for each joint: sin and cos of the turn, X, Y and z of the point, and x, z before beta.
const SLOTS: usize = 7;

/// Numbers of scratch that [`forward`] needs for a chain.
pub(crate) fn scratch_len(chain: &Chain) -> usize {
    chain.links.len() * SLOTS * PAD
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
    let c = |value: f64| Lanes::splat(simd, value);
    let [mut x, mut y, mut z] = tip;
    for (i, link) in chain.links.iter().enumerate().rev() {
        let slot = i * SLOTS;
        if let Some((cos_beta, sin_beta)) = link.beta {
            let before = x;
            x = z.mul_add(c(sin_beta), before * c(cos_beta));
            z = before.neg_mul_add(c(sin_beta), z * c(cos_beta));
            x.store(scratch, slot + 5);
            z.store(scratch, slot + 6);
        }
        if i + 1 < chain.links.len() {
            let before = y;
            y = z.neg_mul_add(c(link.sin_alpha), before * c(link.cos_alpha));
            z = before.mul_add(c(link.sin_alpha), z * c(link.cos_alpha));
            z.store(scratch, slot + 4);
            x = x + c(link.a);
            z = z + c(link.d);
        }
        let (sin, cos) = poses.turn(simd, link, i, k);
        sin.store(scratch, slot);
        cos.store(scratch, slot + 1);
        x.store(scratch, slot + 2);
        y.store(scratch, slot + 3);
        let before = x;
        x = y.neg_mul_add(sin, before * cos);
        y = before.mul_add(sin, y * cos);
    }
    [x, y, z]
}

/// Carries a direction of the base frame to the tip after [`forward`] and emits, for each parameter of the joints
/// and then x, y, z of the tip, the derivative of `direction · p`; last, that with respect to the last joint's turn.
#[inline(always)]
pub(crate) fn gradient<S: Simd>(
    simd: S,
    chain: &Chain,
    scratch: &[f64],
    direction: [Lanes<S>; 3],
    mut emit: impl FnMut(usize, Lanes<S>),
) {
    let mut g = direction;
    for (i, link) in chain.links.iter().enumerate() {
        let columns = through(simd, link, i, scratch, &mut g, i + 1 == chain.links.len());
        for (k, value) in columns.into_iter().enumerate() {
            emit(4 * i + k, value);
        }
    }
}

/// [`gradient`] of `direction · (p - p')` for two poses at once: the difference is emitted, written once.
#[inline(always)]
pub(crate) fn gradient_between<S: Simd>(
    simd: S,
    chain: &Chain,
    scratch: [&[f64]; 2],
    direction: [Lanes<S>; 3],
    mut emit: impl FnMut(usize, Lanes<S>),
) {
    let (mut g, mut h) = (direction, direction);
    for (i, link) in chain.links.iter().enumerate() {
        let last = i + 1 == chain.links.len();
        let first = through(simd, link, i, scratch[0], &mut g, last);
        let second = through(simd, link, i, scratch[1], &mut h, last);
        for k in 0..4 {
            emit(4 * i + k, first[k] - second[k]);
        }
    }
}

/// Carries a direction through joint `i`; returns its four derivatives (of the last joint: x, y, z of the tip and the turn).
#[inline(always)]
fn through<S: Simd>(
    simd: S,
    link: &Link,
    i: usize,
    scratch: &[f64],
    direction: &mut [Lanes<S>; 3],
    last: bool,
) -> [Lanes<S>; 4] {
    let c = |value: f64| Lanes::splat(simd, value);
    let at = |slot: usize| Lanes::load(simd, scratch, i * SLOTS + slot);
    let [mut gx, mut gy, mut gz] = *direction;
    let (sin, cos, x, y) = (at(0), at(1), at(2), at(3));
    let before = gx;
    gx = gy.mul_add(sin, before * cos);
    gy = before.neg_mul_add(sin, gy * cos);
    // direction · (z × p) = x gy - y gx
    let turn = x.mul_add(gy, -(y * gx));
    if last {
        return [gx, gy, gz, turn];
    }
    let z = at(4);
    let (alpha, a, d) = (gz.mul_add(y, -(gy * z)), gx, gz);
    let before = gy;
    gy = gz.mul_add(c(link.sin_alpha), before * c(link.cos_alpha));
    gz = before.neg_mul_add(c(link.sin_alpha), gz * c(link.cos_alpha));
    let mut fourth = d;
    if let Some((cos_beta, sin_beta)) = link.beta {
        let (x, z) = (at(5), at(6));
        fourth = gx.mul_add(z, -(gz * x));
        let before = gx;
        gx = gz.neg_mul_add(c(sin_beta), before * c(cos_beta));
        gz = before.mul_add(c(sin_beta), gz * c(cos_beta));
    }
    *direction = [gx, gy, gz];
    [-turn, alpha, a, fourth]
}

/// Tip positions of all poses into `out` (three columns, mm, base frame); `tips` has the tip of each pose (three columns).
pub fn tips_mm(chain: &Chain, poses: &Poses, tips: &Columns, out: &mut Columns) {
    let mut scratch = vec![0.0; scratch_len(chain)];
    Arch::new().dispatch(TipsOp { chain, poses, tip: Tip::Each(tips), out, scratch: &mut scratch });
}

/// Tip positions of all poses with one probe into `out` (three columns, mm, base frame).
pub fn tips_of_probe_mm(chain: &Chain, poses: &Poses, tip_mm: [f64; 3], out: &mut Columns) {
    let mut scratch = vec![0.0; scratch_len(chain)];
    Arch::new().dispatch(TipsOp { chain, poses, tip: Tip::Same(tip_mm), out, scratch: &mut scratch });
}

/// Tip positions from row-major angles into row-major positions, one probe: the same, tile by tile in the cache.
pub fn tips_from_rows_mm(chain: &Chain, tip_mm: [f64; 3], q_rad: &[f64], out_mm: &mut [f64]) {
    const TILE: usize = 256;
    let n = chain.encoders();
    let mut poses = Poses { q_rad: Columns::zeros(n, TILE), sin_cos: None };
    let mut tile = Columns::zeros(3, TILE);
    let mut scratch = vec![0.0; scratch_len(chain)];
    for (q, out) in q_rad.chunks(TILE * n).zip(out_mm.chunks_mut(TILE * 3)) {
        poses.q_rad.fill_from_rows(q, n);
        Arch::new().dispatch(TipsOp {
            chain,
            poses: &poses,
            tip: Tip::Same(tip_mm),
            out: &mut tile,
            scratch: &mut scratch,
        });
        let (x, y, z) = (tile.column(0), tile.column(1), tile.column(2));
        for (row, p) in out.chunks_exact_mut(3).enumerate() {
            p.copy_from_slice(&[x[row], y[row], z[row]]);
        }
    }
}

/// Calls `each(row, component, column, value)` with ∂p/∂(joint parameters, tip, turn of the last joint) of every pose of
/// row-major angles, mm/rad and mm/mm.
pub fn for_each_derivative(
    chain: &Chain,
    tip_mm: [f64; 3],
    q_rad: &[f64],
    mut each: impl FnMut(usize, usize, usize, f64),
) {
    const TILE: usize = 64;
    let n = chain.encoders();
    let columns = chain.joint_parameter_count() + 4;
    let mut poses = Poses { q_rad: Columns::zeros(n, TILE), sin_cos: None };
    let mut tile = Columns::zeros(3 * columns, TILE);
    let mut scratch = vec![0.0; scratch_len(chain)];
    for (t, q) in q_rad.chunks(TILE * n).enumerate() {
        poses.q_rad.fill_from_rows(q, n);
        Arch::new().dispatch(DerivativesOp { chain, poses: &poses, tip_mm, tile: &mut tile, scratch: &mut scratch });
        for component in 0..3 {
            for column in 0..columns {
                let values = &tile.column(component * columns + column)[..q.len() / n];
                for (row, &value) in values.iter().enumerate() {
                    each(t * TILE + row, component, column, value);
                }
            }
        }
    }
}

struct DerivativesOp<'a> {
    chain: &'a Chain,
    poses: &'a Poses,
    tip_mm: [f64; 3],
    tile: &'a mut Columns,
    scratch: &'a mut [f64],
}

impl WithSimd for DerivativesOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let columns = self.chain.joint_parameter_count() + 4;
        let tip = self.tip_mm.map(|t| Lanes::splat(simd, t));
        for k in 0..self.poses.q_rad.stride / S::F64_LANES {
            forward(simd, self.chain, self.poses, k, tip, self.scratch);
            for component in 0..3 {
                let axis = |j: usize| Lanes::splat(simd, if j == component { 1.0 } else { 0.0 });
                gradient(simd, self.chain, self.scratch, [axis(0), axis(1), axis(2)], |column, value| {
                    self.tile.store(component * columns + column, k, value);
                });
            }
        }
    }
}

#[derive(Clone, Copy)]
enum Tip<'a> {
    Same([f64; 3]),
    Each(&'a Columns),
}

struct TipsOp<'a> {
    chain: &'a Chain,
    poses: &'a Poses,
    tip: Tip<'a>,
    out: &'a mut Columns,
    scratch: &'a mut [f64],
}

impl WithSimd for TipsOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for k in 0..self.poses.q_rad.stride / S::F64_LANES {
            let tip = match self.tip {
                Tip::Same(tip) => tip.map(|t| Lanes::splat(simd, t)),
                Tip::Each(tips) => [0, 1, 2].map(|j| tips.load(simd, j, k)),
            };
            let p = forward(simd, self.chain, self.poses, k, tip, self.scratch);
            for (j, value) in p.into_iter().enumerate() {
                self.out.store(j, k, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::samples;
    use crate::kinematics::{jacobian, tip_mm};

    /// Runs one of the kernels on an instruction set, if the machine has it.
    #[derive(Clone, Copy, Debug)]
    enum Level {
        Detected,
        #[cfg(target_arch = "x86_64")]
        Avx2,
        Scalar,
    }

    const LEVELS: &[Level] = &[
        Level::Detected,
        #[cfg(target_arch = "x86_64")]
        Level::Avx2,
        Level::Scalar,
    ];

    impl Level {
        fn run(self, op: impl WithSimd<Output = ()>) -> bool {
            match self {
                Level::Detected => Arch::new().dispatch(op),
                #[cfg(target_arch = "x86_64")]
                Level::Avx2 => match pulp::x86::V3::try_new() {
                    Some(simd) => Simd::vectorize(simd, op),
                    None => return false,
                },
                Level::Scalar => op.with_simd(pulp::Scalar::new()),
            }
            true
        }
    }

    #[test]
    fn every_instruction_set_gives_the_formula() {
        let arm = samples::table2(10.0);
        let q_rad: Vec<f64> = (0..7 * 19).map(|i| (i as f64 * 0.618).fract() * 6.0 - 3.0).collect();
        let (chain, tip) = (Chain::new(&arm), arm.probes()[0].tip_mm);
        let mut scratch = vec![0.0; scratch_len(&chain)];
        let mut kept = Poses::from_rows(&q_rad, 7);
        kept.keep_sin_cos();
        for &level in LEVELS {
            for poses in [&Poses::from_rows(&q_rad, 7), &kept] {
                let mut out = Columns::zeros(3, 19);
                let mut tile = Columns::zeros(3 * 28, 19);
                let tips = TipsOp { chain: &chain, poses, tip: Tip::Same(tip), out: &mut out, scratch: &mut scratch };
                if !level.run(tips) {
                    continue;
                }
                let derivatives =
                    DerivativesOp { chain: &chain, poses, tip_mm: tip, tile: &mut tile, scratch: &mut scratch };
                level.run(derivatives);
                for (row, q) in q_rad.chunks_exact(7).enumerate() {
                    let (p, j) = (tip_mm(&arm, 0, q), jacobian(&arm, 0, q));
                    for c in 0..3 {
                        assert!((out.column(c)[row] - p[c]).abs() < 1e-11, "{level:?}");
                        for k in 0..27 {
                            assert!((tile.column(c * 28 + k)[row] - j[(c, k)]).abs() < 1e-11, "{level:?} {k}");
                        }
                    }
                }
            }
        }
    }
}
