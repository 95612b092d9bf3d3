//! Lengths and their derivatives, for vectors of rows.

use super::run::Run;
use crate::artefacts::model::Model;
use crate::artefacts::noise::Noise;
use crate::artefacts::writer::Writer;
use crate::kinematics::Chain;
use crate::kinematics::batch::{forward, gradient, gradient_between, scratch_len};
use crate::simd::{Columns, Lanes};
use pulp::{Arch, Simd, WithSimd};

/// Both tips of vector `k`: distance, and direction from the second to the first.
#[inline(always)]
fn between<S: Simd>(
    simd: S,
    chain: &Chain,
    run: &Run,
    k: usize,
    tip: [f64; 3],
    scratch: &mut [Vec<f64>; 2],
) -> (Lanes<S>, [Lanes<S>; 3]) {
    let tip = tip.map(|t| Lanes::splat(simd, t));
    let p = forward(simd, chain, &run.from, k, tip, &mut scratch[0]);
    let q = forward(simd, chain, &run.to, k, tip, &mut scratch[1]);
    let delta = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let squared = delta[2].mul_add(delta[2], delta[1].mul_add(delta[1], delta[0] * delta[0]));
    let distance = squared.sqrt();
    let inverse = distance.reciprocal_or_zero();
    (distance, delta.map(|d| d * inverse))
}

/// The distance of each row's tips, mm.
pub(super) fn distances(model: &Model, run: &Run) -> Columns {
    let mut distances = Columns::zeros(1, run.rows.len());
    let mut scratch = [0, 1].map(|_| vec![0.0; scratch_len(&model.chain)]);
    let (chain, tip) = (&model.chain, model.tips_mm[run.probe]);
    Arch::new().dispatch(DistanceOp { chain, tip, run, out: distances.column_mut(0), scratch: &mut scratch });
    distances
}

struct DistanceOp<'a> {
    chain: &'a Chain,
    tip: [f64; 3],
    run: &'a Run,
    out: &'a mut [f64],
    scratch: &'a mut [Vec<f64>; 2],
}

impl WithSimd for DistanceOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for k in 0..self.out.len() / S::F64_LANES {
            let (distance, _) = between(simd, self.chain, self.run, k, self.tip, self.scratch);
            distance.store(self.out, k);
        }
    }
}

pub(super) struct LengthOp<'a, 'b> {
    pub chain: &'a Chain,
    pub tip: [f64; 3],
    pub run: &'a Run,
    pub start: usize,
    /// to the stated lengths
    pub added_mm: f64,
    pub jacobian: bool,
    pub dimension: bool,
    pub out: &'a mut Writer<'b>,
}

impl WithSimd for LengthOp<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let block = &mut self.out.block;
        let scratch = &mut self.out.scratch;
        for v in 0..block.rows / S::F64_LANES {
            let k = self.start / S::F64_LANES + v;
            let (distance, u) = between(simd, self.chain, self.run, k, self.tip, scratch);
            let weight = self.run.weights().load(simd, 0, k);
            let length = self.run.length_mm.load(simd, 0, k) + Lanes::splat(simd, self.added_mm);
            block.columns.store(block.residual, v, (distance - length) * weight);
            if !self.jacobian {
                continue;
            }
            let parameters = self.chain.parameter_columns();
            let direction = u.map(|x| x * weight);
            gradient_between(
                simd,
                self.chain,
                scratch,
                direction,
                #[inline(always)]
                |column, value| {
                    if column < parameters {
                        block.columns.store(column, v, value);
                    }
                },
            );
            if self.dimension {
                block.columns.store(parameters, v, -weight);
            }
        }
    }
}

pub(super) struct VarianceOp<'a> {
    pub chain: &'a Chain,
    pub tip: [f64; 3],
    pub run: &'a Run,
    pub noise: &'a Noise,
    pub variance: &'a mut [f64],
    pub scratch: &'a mut [Vec<f64>; 2],
}

impl WithSimd for VarianceOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut along = vec![Lanes::splat(simd, 0.0); self.noise.encoder_rad.len()];
        for k in 0..self.variance.len() / S::F64_LANES {
            let (_, u) = between(simd, self.chain, self.run, k, self.tip, self.scratch);
            let mut variance = Lanes::splat(simd, 2.0 * self.noise.seat_mm.powi(2));
            for scratch in self.scratch.iter_mut() {
                gradient(
                    simd,
                    self.chain,
                    scratch,
                    u,
                    #[inline(always)]
                    |column, per_rad| {
                        if let Some(own) = self.chain.encoder_of(column).and_then(|encoder| along.get_mut(encoder)) {
                            *own = per_rad;
                        }
                    },
                );
                if along.is_empty() {
                    continue;
                }
                self.chain.by_encoders_in_lanes(simd, &mut along);
                for (&along, &sigma) in along.iter().zip(&self.noise.encoder_rad) {
                    let moved = along * Lanes::splat(simd, sigma);
                    variance = moved.mul_add(moved, variance);
                }
            }
            variance.store(self.variance, k);
        }
    }
}
