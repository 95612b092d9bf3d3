//! Tips and derivatives of many poses.

use super::kernel::{forward, gradient, scratch_len};
use crate::kinematics::chain::Chain;
use crate::kinematics::poses::{Angles, Poses};
use crate::simd::{Columns, Lanes};
use pulp::{Arch, Simd, WithSimd};

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
pub fn tips_from_rows_mm(chain: &Chain, tip_mm: [f64; 3], angles: Angles, out_mm: &mut [f64]) {
    const TILE: usize = 256;
    let mut poses = Poses::room(chain.encoders(), TILE);
    let mut tile = Columns::zeros(3, TILE);
    let mut scratch = vec![0.0; scratch_len(chain)];
    for (part, out) in angles.chunks(TILE, chain.encoders()).zip(out_mm.chunks_mut(TILE * 3)) {
        poses.fill(part);
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

/// Calls `each(row, component, column, value)` with ∂p by each of the columns of [`Chain`] for every pose, mm for each unit.
pub fn for_each_derivative(
    chain: &Chain,
    tip_mm: [f64; 3],
    angles: Angles,
    mut each: impl FnMut(usize, usize, usize, f64),
) {
    const TILE: usize = 64;
    let n = chain.encoders();
    let columns = chain.turn_column() + 1;
    let mut poses = Poses::room(n, TILE);
    let mut tile = Columns::zeros(3 * columns, TILE);
    let mut scratch = vec![0.0; scratch_len(chain)];
    for (t, part) in angles.chunks(TILE, n).enumerate() {
        poses.fill(part);
        Arch::new().dispatch(DerivativesOp { chain, poses: &poses, tip_mm, tile: &mut tile, scratch: &mut scratch });
        for component in 0..3 {
            for column in 0..columns {
                let values = &tile.column(component * columns + column)[..part.q_rad.len() / n];
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
        let columns = self.chain.turn_column() + 1;
        let tip = self.tip_mm.map(|t| Lanes::splat(simd, t));
        for k in 0..self.poses.q_rad.stride / S::F64_LANES {
            forward(simd, self.chain, self.poses, k, tip, self.scratch);
            for component in 0..3 {
                let axis = |j: usize| Lanes::splat(simd, if j == component { 1.0 } else { 0.0 });
                gradient(
                    simd,
                    self.chain,
                    self.scratch,
                    [axis(0), axis(1), axis(2)],
                    #[inline(always)]
                    |column, value| {
                        self.tile.store(component * columns + column, k, value);
                    },
                );
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
    use crate::arm::{
        Arm, Backlash, BaseOffset, BaseTilt, Body, Compliance, Coupling, Effects, Expansion, Harmonics, samples,
    };
    use crate::kinematics::conditions::Conditions;
    use crate::kinematics::plain::{jacobian, tip_mm};

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

    /// Table 2 of Cheng 2011, and the same with all effects.
    fn arms() -> [Arm; 2] {
        let plain = samples::table2(10.0);
        let wave = |i: usize| 0.01 * (i as f64 * 0.618).sin();
        let mut harmonics = Harmonics::zero(&[1, 3], 7);
        harmonics.amplitudes_rad.as_flattened_mut().iter_mut().enumerate().for_each(|(i, c)| *c = wave(i));
        let bodies = vec![Body { mass_kg: 1.5, centre_mm: [10.0, -20.0, 60.0] }; 7];
        let rad_per_nm = (0..7).map(wave).collect();
        let effects = Effects {
            harmonics: Some(harmonics),
            backlash: Some(Backlash { rad: (0..7).map(wave).collect() }),
            coupling: Some(Coupling {
                others: vec![vec![], vec![], vec![1], vec![], vec![3], vec![3, 4], vec![]],
                ratios: vec![1.0, -0.02, 0.9, -1.1],
            }),
            expansion: Some(Expansion { per_kelvin: (0..7).map(|i| 0.1 * wave(i)).collect() }),
            compliance: Some(Compliance { rad_per_nm, bodies, gravity: [0.1, 0.2, -1.0], payload_kg: 0.0 }),
            base_tilt: Some(BaseTilt { rad: [0.3, -0.2], joints: 7 }),
            base_offset: Some(BaseOffset { mm: [12.0, -7.0], joints: 7 }),
        };
        let bent = plain.with_effects(effects).unwrap();
        [plain, bent]
    }

    #[test]
    fn every_instruction_set_gives_the_formula() {
        let q_rad: Vec<f64> = (0..7 * 19).map(|i| (i as f64 * 0.618).fract() * 6.0 - 3.0).collect();
        let warmth_k: Vec<f64> = (0..19).map(|i| f64::from(i) - 4.0).collect();
        let approach: Vec<f64> = (0..7 * 19).map(|i| f64::from((i * 5 + i / 7) % 3 - 1)).collect();
        let payload: Vec<f64> =
            (0..4 * 19).map(|i| (f64::from(i) * 0.37).fract() * [2.0, 9.0, -30.0, 40.0][i as usize % 4]).collect();
        let conditions = Conditions { warmth_k: &warmth_k, approach: &approach, payload: &payload };
        let angles = Angles { q_rad: &q_rad, conditions };
        for (arm, &level) in arms().iter().flat_map(|arm| LEVELS.iter().map(move |level| (arm, level))) {
            let (chain, tip) = (Chain::new(arm), arm.probes()[0].tip_mm);
            let mut scratch = vec![0.0; scratch_len(&chain)];
            let mut kept = Poses::new(angles, 7);
            kept.keep_sin_cos();
            for poses in [&Poses::new(angles, 7), &kept] {
                let columns = chain.turn_column() + 1;
                let mut out = Columns::zeros(3, 19);
                let mut tile = Columns::zeros(3 * columns, 19);
                let tips = TipsOp { chain: &chain, poses, tip: Tip::Same(tip), out: &mut out, scratch: &mut scratch };
                if !level.run(tips) {
                    continue;
                }
                let derivatives =
                    DerivativesOp { chain: &chain, poses, tip_mm: tip, tile: &mut tile, scratch: &mut scratch };
                level.run(derivatives);
                for row in 0..19 {
                    let (p, j) = (tip_mm(arm, 0, angles.pose(row, 7)), jacobian(arm, 0, angles.pose(row, 7)));
                    for c in 0..3 {
                        assert!((out.column(c)[row] - p[c]).abs() < 1e-11, "{level:?}");
                        for k in 0..arm.parameter_count() {
                            let value = tile.column(c * columns + k)[row];
                            let size = 1.0 + j[(c, k)].abs() / 1e3;
                            assert!((value - j[(c, k)]).abs() < 3e-11 * size, "{level:?} {k}");
                        }
                    }
                }
            }
        }
    }
}
