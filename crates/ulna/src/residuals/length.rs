//! `length`: two poses and the distance between their tips.
//!
//! ```text
//! r = w (‖p(q) - p(q')‖ - L)      ∂r = w u · (∂p(q) - ∂p(q'))      u = (p(q) - p(q')) / ‖p(q) - p(q')‖
//! ```

use super::{Considered, Model, Noise, Readings, Unknowns, Unweighted, Weighing, Writer};
use crate::error::Result;
use crate::kinematics::batch::{forward, gradient, gradient_between, scratch_len};
use crate::kinematics::{Chain, Poses};
use crate::simd::Columns;
use crate::simd::Lanes;
use crate::solver::BLOCK_ROWS;
use pulp::{Arch, Simd, WithSimd};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Rows of two poses and a length, in runs of one probe each.
#[derive(Debug, Clone)]
pub struct Lengths {
    runs: Vec<Run>,
    considered: Vec<Considered>,
    rows: usize,
}

#[derive(Debug, Clone)]
struct Run {
    probe: usize,
    /// which rows of the file
    rows: Vec<usize>,
    from: Poses,
    to: Poses,
    /// length and root of the weight; the weight of padding is zero
    length_mm: Columns,
    weight: Columns,
}

/// What one row of a file says.
#[derive(Debug, Clone, Copy)]
pub struct LengthRows<'a> {
    /// Row-major angles of the first pose, rad.
    pub q_rad: &'a [f64],
    /// Row-major angles of the second pose, rad.
    pub p_rad: &'a [f64],
    /// Which probe took each row.
    pub probe: &'a [usize],
    /// Calibrated distance of each row, mm.
    pub length_mm: &'a [f64],
}

impl Lengths {
    /// Rows of an arm of `encoders` joints. `u_mm` is the standard uncertainty of the length, common to all rows.
    pub fn new(name: &str, encoders: usize, data: LengthRows, u_mm: f64) -> Lengths {
        let probes = data.probe.iter().max().map_or(0, |&p| p + 1);
        let mut runs = Vec::new();
        for probe in 0..probes {
            let rows: Vec<usize> = (0..data.probe.len()).filter(|&r| data.probe[r] == probe).collect();
            if rows.is_empty() {
                continue;
            }
            let length: Vec<f64> = rows.iter().map(|&r| data.length_mm[r]).collect();
            runs.push(Run {
                probe,
                from: Poses::gathered(data.q_rad, encoders, &rows),
                to: Poses::gathered(data.p_rad, encoders, &rows),
                length_mm: Columns::from_rows(&length, 1),
                weight: ones(rows.len()),
                rows,
            });
        }
        let considered = Considered { name: format!("artefact.{name}.length"), u_mm };
        Lengths { runs, considered: if u_mm > 0.0 { vec![considered] } else { vec![] }, rows: data.probe.len() }
    }
}

/// Weight one for each row, zero for the padding.
fn ones(rows: usize) -> Columns {
    Columns::from_rows(&vec![1.0; rows], 1)
}

impl Readings for Lengths {
    fn len(&self) -> usize {
        self.rows
    }

    fn equations(&self) -> usize {
        self.rows
    }

    fn placement_unknowns(&self) -> usize {
        0
    }

    fn scale_free(&self) -> bool {
        false
    }

    fn mirror_free(&self) -> bool {
        true
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        (0..probes).map(|p| self.runs.iter().any(|run| run.probe == p)).collect()
    }

    fn considered(&self) -> &[Considered] {
        &self.considered
    }

    fn sin_cos_bytes(&self) -> usize {
        let encoders = self.runs.first().map_or(0, |run| run.from.encoders());
        self.rows * encoders * 2 * 2 * size_of::<f64>()
    }

    fn keep_sin_cos(&mut self) {
        for run in &mut self.runs {
            run.from.keep_sin_cos();
            run.to.keep_sin_cos();
        }
    }

    fn weigh(&mut self, model: &Model, noise: Option<&Noise>, _: Weighing) {
        let mut scratch = [vec![0.0; scratch_len(&model.chain)], vec![0.0; scratch_len(&model.chain)]];
        for run in &mut self.runs {
            let mut weight = ones(run.rows.len());
            if let Some(noise) = noise {
                let mut variance = Columns::zeros(1, run.rows.len());
                Arch::new().dispatch(VarianceOp {
                    chain: &model.chain,
                    tip: model.tips_mm[run.probe],
                    run,
                    noise,
                    variance: variance.column_mut(0),
                    scratch: &mut scratch,
                });
                for (w, v) in weight.column_mut(0).iter_mut().zip(variance.column(0)) {
                    *w = if *w > 0.0 && *v > 0.0 { v.sqrt().recip() } else { *w };
                }
            }
            run.weight = weight;
        }
    }

    fn weight_squared_sum(&self) -> f64 {
        let run_sum = |run: &Run| run.weight.column(0).iter().map(|w| w * w).sum::<f64>();
        self.runs.iter().map(run_sum).sum()
    }

    fn stream(&self, model: &Model, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        let joint_columns = model.chain.joint_parameter_count();
        let considered = self.considered.len();
        for run in &self.runs {
            let residual = joint_columns + 3 + considered;
            let parameter = |column: usize| match column {
                c if c < joint_columns => unknowns.parameters[c],
                c if c < joint_columns + 3 => unknowns.parameters[c + 3 * run.probe],
                c => unknowns.considered[c - joint_columns - 3],
            };
            let targets = (0..residual).filter_map(|c| Some((c, parameter(c)?)));
            out.layout(residual, targets.filter(|_| jacobian))?;
            let rows = run.length_mm.column(0).len();
            for start in (0..rows).step_by(BLOCK_ROWS) {
                out.block.rows = BLOCK_ROWS.min(rows - start);
                Arch::new().dispatch(LengthOp {
                    chain: &model.chain,
                    tip: model.tips_mm[run.probe],
                    run,
                    start,
                    jacobian,
                    considered: considered > 0,
                    out,
                });
                out.flush()?;
            }
        }
        Ok(())
    }

    fn unweighted(&self, model: &Model) -> Unweighted {
        let mut residuals_mm = vec![0.0; self.rows];
        let mut weights = vec![0.0; self.rows];
        for run in &self.runs {
            let distance = run.distances(model);
            for (k, &row) in run.rows.iter().enumerate() {
                residuals_mm[row] = distance[k] - run.length_mm.column(0)[k];
                weights[row] = run.weight.column(0)[k];
            }
        }
        Unweighted { components: 1, residuals_mm, weights }
    }

    fn sample_poses(&self, most: usize) -> Vec<(usize, Vec<f64>)> {
        let step = (2 * self.rows).div_ceil(most.max(1)).max(1);
        let run_poses = |run: &Run| {
            let poses = (0..run.rows.len()).step_by(step);
            poses.flat_map(|k| [(run.probe, run.from.pose(k)), (run.probe, run.to.pose(k))]).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(run_poses).collect()
    }

    fn redrawn(&self, truth: &Model, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let mut drawn = self.clone();
        let artefact_error = self.considered.first().map_or(0.0, |c| c.u_mm * normal(rng));
        for run in &mut drawn.runs {
            let from = run.tips(truth, &run.from);
            let to = run.tips(truth, &run.to);
            for k in 0..run.rows.len() {
                let distance = (0..3)
                    .map(|j| {
                        let seats = noise.seat_mm * (normal(rng) - normal(rng));
                        (from.column(j)[k] - to.column(j)[k] + seats).powi(2)
                    })
                    .sum::<f64>()
                    .sqrt();
                run.length_mm.column_mut(0)[k] = distance + artefact_error;
            }
            run.from.add_noise(&noise.encoder_rad, rng);
            run.to.add_noise(&noise.encoder_rad, rng);
        }
        Box::new(drawn)
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let keep = most.min(self.rows);
        let mut runs = Vec::new();
        for run in &self.runs {
            let count = (keep * run.rows.len()).div_ceil(self.rows.max(1)).min(run.rows.len());
            let picked: Vec<usize> = (0..count).map(|i| i * run.rows.len() / count).collect();
            runs.push(Run {
                probe: run.probe,
                rows: (0..picked.len()).collect(),
                from: run.from.picked(&picked),
                to: run.to.picked(&picked),
                length_mm: run.length_mm.picked(&picked),
                weight: run.weight.picked(&picked),
            });
        }
        let mut next = 0;
        for run in &mut runs {
            run.rows = (next..next + run.rows.len()).collect();
            next += run.rows.len();
        }
        Box::new(Lengths { runs, considered: self.considered.clone(), rows: next })
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}

pub(super) fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    StandardNormal.sample(rng)
}

impl Run {
    fn tips(&self, model: &Model, poses: &Poses) -> Columns {
        let mut out = Columns::zeros(3, self.rows.len());
        crate::kinematics::batch::tips_of_probe_mm(&model.chain, poses, model.tips_mm[self.probe], &mut out);
        out
    }

    fn distances(&self, model: &Model) -> Vec<f64> {
        let (from, to) = (self.tips(model, &self.from), self.tips(model, &self.to));
        let squared = |k: usize, j: usize| (from.column(j)[k] - to.column(j)[k]).powi(2);
        (0..self.rows.len()).map(|k| (0..3).map(|j| squared(k, j)).sum::<f64>().sqrt()).collect()
    }
}

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

struct LengthOp<'a, 'b> {
    chain: &'a Chain,
    tip: [f64; 3],
    run: &'a Run,
    start: usize,
    jacobian: bool,
    considered: bool,
    out: &'a mut Writer<'b>,
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
            let weight = self.run.weight.load(simd, 0, k);
            let length = self.run.length_mm.load(simd, 0, k);
            block.columns.store(block.residual, v, (distance - length) * weight);
            if !self.jacobian {
                continue;
            }
            let last_turn = self.chain.joint_parameter_count() + 3;
            let direction = u.map(|x| x * weight);
            let scratch = [scratch[0].as_slice(), scratch[1].as_slice()];
            gradient_between(simd, self.chain, scratch, direction, |column, value| {
                if column < last_turn {
                    block.columns.store(column, v, value);
                }
            });
            if self.considered {
                block.columns.store(last_turn, v, -weight);
            }
        }
    }
}

struct VarianceOp<'a> {
    chain: &'a Chain,
    tip: [f64; 3],
    run: &'a Run,
    noise: &'a Noise,
    variance: &'a mut [f64],
    scratch: &'a mut [Vec<f64>; 2],
}

impl WithSimd for VarianceOp<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let joint_columns = self.chain.joint_parameter_count();
        for k in 0..self.variance.len() / S::F64_LANES {
            let (_, u) = between(simd, self.chain, self.run, k, self.tip, self.scratch);
            let mut variance = Lanes::splat(simd, 2.0 * self.noise.seat_mm.powi(2));
            for scratch in self.scratch.iter() {
                gradient(simd, self.chain, scratch, u, |column, per_rad| {
                    let encoder = match column {
                        c if c < joint_columns && c % 4 == 0 => c / 4,
                        c if c == joint_columns + 3 => joint_columns / 4,
                        _ => return,
                    };
                    if let Some(&sigma) = self.noise.encoder_rad.get(encoder) {
                        let moved = per_rad * Lanes::splat(simd, sigma);
                        variance = moved.mul_add(moved, variance);
                    }
                });
            }
            variance.store(self.variance, k);
        }
    }
}
