//! Lengths of many rows.

use super::kernels::{LengthOp, VarianceOp, distances};
use super::run::Run;
use crate::arm::Seen;
use crate::artefacts::dimension::{Dimension, Unknowns};
use crate::artefacts::model::At;
use crate::artefacts::noise::{Noise, Weighing, normal};
use crate::artefacts::readings::{Again, Readings};
use crate::artefacts::residuals::{Unweighted, Whitened};
use crate::artefacts::stated::Rows;
use crate::artefacts::writer::Writer;
use crate::error::Result;
use crate::kinematics::batch::scratch_len;
use crate::kinematics::{Angles, Poses, Sample};
use crate::simd::Columns;
use crate::solver::BLOCK_ROWS;
use pulp::Arch;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Rows of two poses and a length, in runs of one probe each.
#[derive(Debug, Clone)]
pub(in crate::artefacts::kinds) struct Lengths {
    pub runs: Vec<Run>,
    /// the length, where it is not known exactly: what is added to that of every row
    dimensions: Vec<Dimension>,
    /// whether all lengths are one, of which nothing is known
    unknown: bool,
    rows: usize,
}

impl Lengths {
    /// Rows of an arm of `encoders` joints, whose second poses and lengths must be there. `length`: what is not known of
    /// all lengths together.
    pub fn new(rows: &Rows, encoders: usize, length: Option<Dimension>) -> Lengths {
        let second = rows.second.unwrap_or(Angles::cold(&[]));
        Lengths::between(rows.probe, rows.measured_mm.unwrap_or_default(), length, |own| {
            [rows.poses, second].map(|poses| Poses::gathered(poses, encoders, own))
        })
    }

    /// Rows by the probe and the length of each; `ends` gives both poses of some of the rows.
    pub fn between(
        probe_of: &[usize],
        length_mm: &[f64],
        length: Option<Dimension>,
        ends: impl Fn(&[usize]) -> [Poses; 2],
    ) -> Lengths {
        let probes = probe_of.iter().max().map_or(0, |&p| p + 1);
        let mut runs = Vec::new();
        for probe in 0..probes {
            let own: Vec<usize> = (0..probe_of.len()).filter(|&r| probe_of[r] == probe).collect();
            if own.is_empty() {
                continue;
            }
            let [from, to] = ends(&own);
            let lengths: Vec<f64> = own.iter().map(|&r| length_mm[r]).collect();
            runs.push(Run::new(probe, own, [from, to], &lengths));
        }
        let free = |length: &Dimension| length.is_free() && length_mm.iter().all(|&each| each == length.value);
        Lengths {
            runs,
            unknown: length.as_ref().is_some_and(free),
            dimensions: length.into_iter().collect(),
            rows: probe_of.len(),
        }
    }
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

    fn standings(&self) -> usize {
        self.rows
    }

    fn scale_free(&self) -> bool {
        self.unknown
    }

    fn growing(&self, at: At) -> Vec<f64> {
        at.dimensions.to_vec()
    }

    fn mirror_free(&self) -> bool {
        true
    }

    fn still_free(&self) -> bool {
        self.unknown
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        (0..probes).map(|p| self.runs.iter().any(|run| run.probe == p)).collect()
    }

    fn dimensions(&self) -> &[Dimension] {
        &self.dimensions
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

    fn weigh(&mut self, at: At, noise: Option<&Noise>, _: Weighing) {
        let model = at.model;
        let mut scratch = [vec![0.0; scratch_len(&model.chain)], vec![0.0; scratch_len(&model.chain)]];
        for run in &mut self.runs {
            run.weigh(|_| 1.0);
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
                run.weigh(|k| if variance.column(0)[k] > 0.0 { variance.column(0)[k].sqrt().recip() } else { 1.0 });
            }
        }
    }

    fn discount(&mut self, factors: Option<&[f64]>) {
        for run in &mut self.runs {
            run.discounted = factors.map(|factors| {
                let mut weight = run.weight.clone();
                weight.column_mut(0).iter_mut().zip(&run.rows).for_each(|(w, &row)| *w *= factors[row]);
                weight
            });
        }
    }

    fn weight_squared_sum(&self) -> f64 {
        let run_sum = |run: &Run| run.weights().column(0).iter().map(|w| w * w).sum::<f64>();
        self.runs.iter().map(run_sum).sum()
    }

    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        let model = at.model;
        let probes = model.tips_mm.len();
        let parameters = model.chain.parameter_columns();
        let residual = parameters + self.dimensions.len();
        for run in &self.runs {
            let unknown = |column: usize| match model.chain.parameter_of(column, run.probe, probes) {
                Some(parameter) => unknowns.parameters[parameter],
                None => unknowns.dimensions[column - parameters],
            };
            let targets = (0..residual).filter_map(|c| Some((c, unknown(c)?)));
            out.layout(residual, targets.filter(|_| jacobian))?;
            let rows = run.length_mm.column(0).len();
            for start in (0..rows).step_by(BLOCK_ROWS) {
                out.block.rows = BLOCK_ROWS.min(rows - start);
                Arch::new().dispatch(LengthOp {
                    chain: &model.chain,
                    tip: model.tips_mm[run.probe],
                    run,
                    start,
                    added_mm: self.added_mm(at),
                    jacobian,
                    dimension: !self.dimensions.is_empty(),
                    out,
                });
                let block = out.block.rows;
                out.tell(0..block.min(run.rows.len() - start), |k| run.rows[start + k]);
                out.flush()?;
            }
        }
        Ok(())
    }

    fn unweighted(&self, at: At) -> Unweighted {
        let mut residuals_mm = vec![0.0; self.rows];
        let mut weights = vec![0.0; self.rows];
        for run in &self.runs {
            let distance = distances(at.model, run);
            for (k, &row) in run.rows.iter().enumerate() {
                residuals_mm[row] = distance.column(0)[k] - run.length_mm.column(0)[k] - self.added_mm(at);
                weights[row] = run.weights().column(0)[k];
            }
        }
        Unweighted { components: 1, residuals_mm, weights }
    }

    fn whitened(&self, at: At) -> Whitened {
        let mut norms = self.unweighted(at).residuals_mm;
        for run in &self.runs {
            for (&row, weight) in run.rows.iter().zip(run.weight.column(0)) {
                norms[row] = (norms[row] * weight).abs();
            }
        }
        Whitened { norms, freedoms: vec![1.0; self.rows] }
    }

    fn samples(&self, most: usize) -> Vec<Sample> {
        let step = (2 * self.rows).div_ceil(most.max(1)).max(1);
        let run_poses = |run: &Run| {
            let poses = (0..run.rows.len()).step_by(step);
            poses.flat_map(|k| [run.from.sample(k, run.probe), run.to.sample(k, run.probe)]).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(run_poses).collect()
    }

    fn seen(&self) -> Seen {
        self.runs.iter().flat_map(|run| [run.from.seen(), run.to.seen()]).reduce(Seen::and).unwrap_or_default()
    }

    fn taken_anew(&self, again: &Again, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        Box::new(self.drawn(again, rng))
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        Box::new(self.part(most))
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}

impl Lengths {
    /// See [`Readings::taken_anew`].
    pub fn drawn(&self, again: &Again, rng: &mut Xoshiro256PlusPlus) -> Lengths {
        let Again { truth, calibrated, noise } = *again;
        let mut drawn = self.clone();
        // the length is what it is; its calibration is another
        let error =
            calibrated.first().zip(truth.dimensions.first()).map_or(0.0, |(calibrated, truth)| calibrated - truth);
        drawn.dimensions.iter_mut().zip(calibrated).for_each(|(dimension, &value)| dimension.value = value);
        for run in &mut drawn.runs {
            let from = run.tips(truth.model, &run.from);
            let to = run.tips(truth.model, &run.to);
            for k in 0..run.rows.len() {
                let distance = (0..3)
                    .map(|j| {
                        let seats = noise.seat_mm * (normal(rng) - normal(rng));
                        (from.column(j)[k] - to.column(j)[k] + seats).powi(2)
                    })
                    .sum::<f64>()
                    .sqrt();
                run.length_mm.column_mut(0)[k] = distance + error;
            }
            run.from.add_noise(&noise.encoder_rad, rng);
            run.to.add_noise(&noise.encoder_rad, rng);
        }
        drawn
    }

    /// About `most` of these rows, evenly chosen.
    pub fn part(&self, most: usize) -> Lengths {
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
                discounted: run.discounted.as_ref().map(|weight| weight.picked(&picked)),
            });
        }
        let mut next = 0;
        for run in &mut runs {
            run.rows = (next..next + run.rows.len()).collect();
            next += run.rows.len();
        }
        Lengths { runs, dimensions: self.dimensions.clone(), unknown: self.unknown, rows: next }
    }

    /// The same, their length known exactly as it is calibrated.
    pub fn exact(&self) -> Lengths {
        Lengths { dimensions: vec![], unknown: false, ..self.clone() }
    }

    /// What the length's dimension adds to the length of every row.
    pub fn added_mm(&self, at: At) -> f64 {
        let dimension = self.dimensions.first().zip(at.dimensions.first());
        dimension.map_or(0.0, |(dimension, value)| value - dimension.value)
    }
}
