//! What the encoders' noise does at many tips, by vectors of poses.

use super::model::Model;
use super::noise::Noise;
use crate::kinematics::batch::{forward, gradient, scratch_len};
use crate::kinematics::{Chain, Poses};
use crate::simd::{Lanes, PAD};
use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};

/// Poses looked at together.
pub(super) const AT_ONCE: usize = 64;

/// Tips of some poses, and their covariances.
pub(super) struct AtTips {
    /// the probe's tip of each pose, mm
    probe_mm: [[f64; AT_ONCE]; 3],
    p_mm: [[f64; AT_ONCE]; 3],
    /// xx, yx, yy, zx, zy, zz
    sigma: [[f64; AT_ONCE]; 6],
    /// of each encoder, how far its noise moves the tip along x and y
    moved: Vec<f64>,
    scratch: Vec<f64>,
}

impl AtTips {
    pub fn new(model: &Model) -> AtTips {
        AtTips {
            probe_mm: [[0.0; AT_ONCE]; 3],
            p_mm: [[0.0; AT_ONCE]; 3],
            sigma: [[0.0; AT_ONCE]; 6],
            moved: vec![0.0; 2 * PAD * model.chain.encoders()],
            scratch: vec![0.0; scratch_len(&model.chain)],
        }
    }

    /// Looks at poses `start..`, a multiple of the vectors' length, taken with these probes; without noise at tips alone.
    pub fn look(
        &mut self,
        model: &Model,
        poses: &Poses,
        probe: impl Fn(usize) -> usize,
        noise: Option<&Noise>,
        start: usize,
    ) {
        let rows = AT_ONCE.min(poses.q_rad().rows() - start);
        for i in 0..rows {
            let tip_mm = model.tips_mm[probe(start + i)];
            (0..3).for_each(|j| self.probe_mm[j][i] = tip_mm[j]);
        }
        let encoder_rad = noise.map_or(&[][..], |noise| &noise.encoder_rad);
        Arch::new().dispatch(LookOp { chain: &model.chain, poses, encoder_rad, start, rows, at: self });
    }

    /// A tip, base frame, mm.
    pub fn p_mm(&self, i: usize) -> Vector3<f64> {
        Vector3::new(self.p_mm[0][i], self.p_mm[1][i], self.p_mm[2][i])
    }

    /// Covariance of a tip for the encoders' noise, and for `variance` in every direction.
    pub fn covariance(&self, i: usize, variance: f64) -> Matrix3<f64> {
        let at = |k: usize| self.sigma[k][i];
        with_its_own(&Matrix3::new(at(0), at(1), at(3), at(1), at(2), at(4), at(3), at(4), at(5)), variance)
    }
}

/// A covariance for the encoders' noise, and for `variance` in every direction. Where the stated noise leaves a direction
/// without any, the direction gets a millionth of the others' variance: a weight must stay finite.
pub(super) fn with_its_own(sigma: &Matrix3<f64>, variance: f64) -> Matrix3<f64> {
    let trace = sigma.trace() + 3.0 * variance;
    let floor = if trace > 0.0 { 1e-6 * trace / 3.0 } else { 1.0 };
    sigma + Matrix3::from_diagonal_element(variance + floor)
}

/// Lower triangle of `L⁻¹` with `Σ = L Lᵀ`, row by row.
pub(super) fn whitener(sigma: &Matrix3<f64>) -> [f64; 6] {
    let l00 = sigma[(0, 0)].sqrt();
    let (l10, l20) = (sigma[(1, 0)] / l00, sigma[(2, 0)] / l00);
    let l11 = (sigma[(1, 1)] - l10 * l10).sqrt();
    let l21 = (sigma[(2, 1)] - l20 * l10) / l11;
    let l22 = (sigma[(2, 2)] - l20 * l20 - l21 * l21).sqrt();
    let (i00, i11, i22) = (l00.recip(), l11.recip(), l22.recip());
    [i00, -l10 * i00 * i11, i11, (l10 * l21 - l20 * l11) * i00 * i11 * i22, -l21 * i11 * i22, i22]
}

struct LookOp<'a> {
    chain: &'a Chain,
    poses: &'a Poses,
    encoder_rad: &'a [f64],
    start: usize,
    rows: usize,
    at: &'a mut AtTips,
}

impl WithSimd for LookOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let LookOp { chain, poses, encoder_rad, start, rows, at } = self;
        let AtTips { probe_mm, p_mm, sigma, moved, scratch } = at;
        let n = encoder_rad.len();
        let mut along = vec![Lanes::splat(simd, 0.0); n];
        for v in 0..rows.div_ceil(S::F64_LANES) {
            let k = start / S::F64_LANES + v;
            let tip = [0, 1, 2].map(|j| Lanes::load(simd, &probe_mm[j], v));
            let p = forward(simd, chain, poses, k, tip, scratch);
            (0..3).for_each(|j| p[j].store(&mut p_mm[j], v));
            if n == 0 {
                continue;
            }
            let mut sums = [Lanes::splat(simd, 0.0); 6];
            for component in 0..3 {
                let axis = |j: usize| Lanes::splat(simd, if j == component { 1.0 } else { 0.0 });
                gradient(
                    simd,
                    chain,
                    scratch,
                    [axis(0), axis(1), axis(2)],
                    #[inline(always)]
                    |column, per_rad| {
                        if let Some(encoder) = chain.encoder_of(column) {
                            along[encoder] = per_rad;
                        }
                    },
                );
                chain.by_encoders_in_lanes(simd, &mut along);
                let first = component * (component + 1) / 2;
                for (encoder, (&along, &sigma)) in along.iter().zip(encoder_rad).enumerate() {
                    let along = along * Lanes::splat(simd, sigma);
                    for other in 0..component {
                        let known = Lanes::load(simd, moved, other * n + encoder);
                        sums[first + other] = known.mul_add(along, sums[first + other]);
                    }
                    sums[first + component] = along.mul_add(along, sums[first + component]);
                    if component < 2 {
                        along.store(moved, component * n + encoder);
                    }
                }
            }
            (0..6).for_each(|k| sums[k].store(&mut sigma[k], v));
        }
    }
}
