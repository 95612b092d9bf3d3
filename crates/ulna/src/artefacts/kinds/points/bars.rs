//! Two features touched once each wherever the artefact stands: one length, told as such.
//!
//! Five of the six numbers say where the artefact is. What is left is `‖p(q) - p(q')‖ - L`, with the variance of the two
//! tips along the line between them: nothing has to be placed, nor eliminated. Exact where all directions weigh alike,
//! and else to first order in the residuals. They are reported as the touches that they are.

use super::apart::{Ends, apart};
use crate::arm::Seen;
use crate::artefacts::at_tips::{AT_ONCE, AtTips, whitener};
use crate::artefacts::dimension::{Dimension, Unknowns};
use crate::artefacts::kinds::length::Lengths;
use crate::artefacts::model::{At, Model};
use crate::artefacts::noise::{Noise, Weighing};
use crate::artefacts::readings::{Again, Readings};
use crate::artefacts::residuals::{Unweighted, Whitened};
use crate::artefacts::writer::Writer;
use crate::error::Result;
use crate::kinematics::Sample;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::SQRT_2;

/// Readings of one artefact of which every standing is such a length.
#[derive(Debug, Clone)]
pub(super) struct Bars {
    lengths: Lengths,
    /// which rows of the file the two touches of each length are
    ends: Vec<[u32; 2]>,
    weights: Weights,
}

/// How the touches weigh.
#[derive(Debug, Clone)]
enum Weights {
    /// all alike, in all directions: the root, 1/mm
    Alike(f64),
    /// each by the noise, for an arm with these numbers
    Noise(Box<(Model, Noise)>),
}

/// Degrees of freedom of a touch: both share the one of their length.
const FREEDOM: f64 = 0.5;

impl Bars {
    /// Lengths, each between the touches of two rows of the file.
    pub fn new(lengths: Lengths, ends: Vec<[u32; 2]>) -> Bars {
        let mut bars = Bars { lengths, ends, weights: Weights::Alike(1.0) };
        bars.weigh_alike(1.0);
        bars
    }

    fn weigh_alike(&mut self, weight: f64) {
        self.weights = Weights::Alike(weight);
        self.lengths.runs.iter_mut().for_each(|run| run.weigh(|_| weight / SQRT_2));
    }

    /// Weighs each length by the noise along it; returns the mean variance of the touches, as if of all directions.
    fn weigh_along(&mut self, model: &Model, noise: &Noise) -> f64 {
        let seat = noise.seat_mm.powi(2);
        let mut variances = 0.0;
        let mut tips = [AtTips::new(model), AtTips::new(model)];
        for run in &mut self.lengths.runs {
            for start in (0..run.rows.len()).step_by(AT_ONCE) {
                tips[0].look(model, &run.from, |_| run.probe, Some(noise), start);
                tips[1].look(model, &run.to, |_| run.probe, Some(noise), start);
                for i in 0..AT_ONCE.min(run.rows.len() - start) {
                    let between = tips[0].p_mm(i) - tips[1].p_mm(i);
                    let sigma = [0, 1].map(|end: usize| tips[end].covariance(i, seat));
                    let along = between.dot(&((sigma[0] + sigma[1]) * between)) / between.norm_squared();
                    // of tips at one place no direction is more the line's than another
                    let variance = if along > 0.0 { along } else { (sigma[0] + sigma[1]).trace() / 3.0 };
                    run.weight.column_mut(0)[start + i] = variance.sqrt().recip();
                    variances += sigma.iter().map(|sigma| 3.0 / squared(&whitener(sigma))).sum::<f64>();
                }
            }
            run.discounted = None;
        }
        variances / self.len().max(1) as f64
    }
}

/// Sum of squares.
fn squared(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

impl Readings for Bars {
    fn len(&self) -> usize {
        2 * self.ends.len()
    }

    fn equations(&self) -> usize {
        3 * self.len()
    }

    fn placement_unknowns(&self) -> usize {
        5 * self.ends.len()
    }

    fn standings(&self) -> usize {
        self.ends.len()
    }

    fn scale_free(&self) -> bool {
        self.lengths.scale_free()
    }

    fn growing(&self, at: At) -> Vec<f64> {
        self.lengths.growing(at)
    }

    fn mirror_free(&self) -> bool {
        true
    }

    fn still_free(&self) -> bool {
        self.lengths.still_free()
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        self.lengths.probes_used(probes)
    }

    fn dimensions(&self) -> &[Dimension] {
        self.lengths.dimensions()
    }

    fn sin_cos_bytes(&self) -> usize {
        self.lengths.sin_cos_bytes()
    }

    fn keep_sin_cos(&mut self) {
        self.lengths.keep_sin_cos();
    }

    fn weigh(&mut self, at: At, noise: Option<&Noise>, how: Weighing) {
        let by_encoders = noise.filter(|noise| noise.encoder_rad.iter().any(|&sigma| sigma > 0.0));
        let Some(noise) = by_encoders else {
            return self.weigh_alike(noise.map_or(1.0, |noise| noise.seat_mm.recip()));
        };
        let variance = self.weigh_along(at.model, noise);
        match how {
            Weighing::Full => self.weights = Weights::Noise(Box::new((at.model.clone(), noise.clone()))),
            Weighing::Even => self.weigh_alike(variance.sqrt().recip()),
        }
    }

    fn weighs_directions(&self) -> bool {
        false
    }

    fn discount(&mut self, factors: Option<&[f64]>) {
        // both touches of a length are as far off as it is, and count alike
        let of_length = |factors: &[f64]| self.ends.iter().map(|&[from, _]| factors[from as usize]).collect::<Vec<_>>();
        let factors = factors.map(of_length);
        self.lengths.discount(factors.as_deref());
    }

    fn weight_squared_sum(&self) -> f64 {
        // a touch has half the variance of the length
        4.0 * self.lengths.weight_squared_sum()
    }

    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        self.lengths.stream(at, unknowns, jacobian, out)
    }

    fn unweighted(&self, at: At) -> Unweighted {
        let mut residuals_mm = vec![0.0; self.equations()];
        let mut weights = vec![0.0; self.len()];
        let added_mm = self.lengths.added_mm(at);
        let mut tips = [AtTips::new(at.model), AtTips::new(at.model)];
        for run in &self.lengths.runs {
            for start in (0..run.rows.len()).step_by(AT_ONCE) {
                let mut look = |model: &Model, noise: Option<&Noise>| {
                    tips[0].look(model, &run.from, |_| run.probe, noise, start);
                    tips[1].look(model, &run.to, |_| run.probe, noise, start);
                };
                if let Weights::Noise(weighed) = &self.weights {
                    look(&weighed.0, Some(&weighed.1));
                }
                look(at.model, None);
                for k in start..run.rows.len().min(start + AT_ONCE) {
                    let factor = run.weights().column(0)[k] / run.weight.column(0)[k];
                    let (sigma, weight) = match &self.weights {
                        Weights::Alike(weight) => (None, [*weight; 2]),
                        Weights::Noise(weighed) => {
                            let seat = weighed.1.seat_mm.powi(2);
                            let sigma = [0, 1].map(|end: usize| tips[end].covariance(k - start, seat));
                            let weight = sigma.each_ref().map(|sigma| (squared(&whitener(sigma)) / 3.0).sqrt());
                            (Some(sigma), weight)
                        }
                    };
                    let off = apart(&Ends {
                        p_mm: [0, 1].map(|end: usize| tips[end].p_mm(k - start)),
                        length_mm: run.length_mm.column(0)[k] + added_mm,
                        sigma,
                    });
                    for ((row, off), weight) in self.ends[run.rows[k]].into_iter().zip(off).zip(weight) {
                        let row = row as usize;
                        residuals_mm[3 * row..3 * row + 3].copy_from_slice(off.as_slice());
                        weights[row] = factor * weight;
                    }
                }
            }
        }
        Unweighted { components: 3, residuals_mm, weights }
    }

    fn whitened(&self, at: At) -> Whitened {
        let mut norms = vec![0.0; self.len()];
        for (ends, norm) in self.ends.iter().zip(self.lengths.whitened(at).norms) {
            ends.iter().for_each(|&row| norms[row as usize] = norm / SQRT_2);
        }
        Whitened { freedoms: vec![FREEDOM; norms.len()], norms }
    }

    fn samples(&self, most: usize) -> Vec<Sample> {
        self.lengths.samples(most)
    }

    fn seen(&self) -> Seen {
        self.lengths.seen()
    }

    fn taken_anew(&self, again: &Again, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let lengths = self.lengths.drawn(again, rng);
        Box::new(Bars { lengths, ends: self.ends.clone(), weights: self.weights.clone() })
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        // a bar is one reading in all but its name
        let lengths = self.lengths.part(most);
        let ends = (0..lengths.len() as u32).map(|k| [2 * k, 2 * k + 1]).collect();
        Box::new(Bars { lengths, ends, weights: self.weights.clone() })
    }

    fn as_lengths(&self) -> Option<Box<dyn Readings>> {
        Some(Box::new(self.lengths.exact()))
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}
