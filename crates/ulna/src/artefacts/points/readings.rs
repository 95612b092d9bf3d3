//! Touches of features as readings.

use super::features::Frame;
use super::placement::{Placement, Touch};
use super::rows;
use super::touched::Points;
use super::weigh;
use crate::arm::Seen;
use crate::artefacts::dimension::{Dimension, Unknowns};
use crate::artefacts::length::Lengths;
use crate::artefacts::model::At;
use crate::artefacts::noise::{Noise, Weighing, normal};
use crate::artefacts::readings::Readings;
use crate::artefacts::residuals::{Unweighted, Whitened, shared};
use crate::artefacts::writer::Writer;
use crate::error::Result;
use crate::kinematics::Sample;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::ops::Range;

impl Readings for Points {
    fn len(&self) -> usize {
        self.touches.len()
    }

    fn equations(&self) -> usize {
        3 * self.touches.len()
    }

    fn placement_unknowns(&self) -> usize {
        match self.frame {
            Frame::Free => self.placements.iter().map(Placement::unknowns).sum(),
            Frame::Arm => 0,
        }
    }

    fn scale_free(&self) -> bool {
        self.frame == Frame::Free && self.placements.iter().all(|p| p.span == 0)
    }

    fn mirror_free(&self) -> bool {
        self.frame == Frame::Free && self.placements.iter().all(|p| p.span < 3)
    }

    fn probes_used(&self, probes: usize) -> Vec<bool> {
        self.touches.probes_used(probes)
    }

    fn dimensions(&self) -> &[Dimension] {
        &self.dimensions
    }

    fn sin_cos_bytes(&self) -> usize {
        self.touches.sin_cos_bytes()
    }

    fn keep_sin_cos(&mut self) {
        self.touches.poses.keep_sin_cos();
    }

    fn weigh(&mut self, at: At, noise: Option<&Noise>, how: Weighing) {
        let full = weigh::for_noise(self, at.model, noise);
        self.whitening = match how {
            Weighing::Full => full,
            Weighing::Even => full.even(self.touches.len()),
        };
        self.discounted = None;
    }

    fn discount(&mut self, factors: Option<&[f64]>) {
        let sorted = |factors: &[f64]| self.touches.order.iter().map(|&row| factors[row]).collect::<Vec<_>>();
        self.discounted = factors.map(|factors| self.whitening.times(&sorted(factors)));
    }

    fn weight_squared_sum(&self) -> f64 {
        (0..self.touches.len()).map(|row| self.weights().at(row).norm_squared() / 3.0).sum()
    }

    fn stream(&self, at: At, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        rows::stream(self, at, unknowns, jacobian, out)
    }

    fn unweighted(&self, at: At) -> Unweighted {
        let mut residuals_mm = vec![0.0; 3 * self.touches.len()];
        let mut weights = vec![0.0; self.touches.len()];
        for ((touch, pose), &row) in self.placed_touches(at).iter().zip(&self.touches.order) {
            residuals_mm[3 * row..3 * row + 3].copy_from_slice(touch.residual(pose).as_slice());
            weights[row] = (touch.whiten.norm_squared() / 3.0).sqrt();
        }
        Unweighted { components: 3, residuals_mm, weights }
    }

    fn whitened(&self, at: At) -> Whitened {
        let mut placed = self.placed_touches(at);
        // without what a loss made of them
        placed.iter_mut().enumerate().for_each(|(row, (touch, _))| touch.whiten = self.whitening.at(row));
        let mut norms: Vec<f64> =
            placed.iter().map(|(touch, pose)| (touch.whiten * touch.residual(pose)).norm()).collect();
        let mut freedoms = vec![3.0; norms.len()];
        for (rows, placement) in self.touches.standings.iter().zip(&self.placements) {
            if self.frame == Frame::Free {
                let touches: Vec<Touch> = placed[rows.clone()].iter().map(|(touch, _)| *touch).collect();
                freedoms[rows.clone()].copy_from_slice(&placement.freedoms(&placed[rows.start].1, &touches));
                shared(&mut norms[rows.clone()], &mut freedoms[rows.clone()], 3);
            }
        }
        let filed = |values: Vec<f64>| self.touches.filed(values.into_iter());
        Whitened { norms: filed(norms), freedoms: filed(freedoms) }
    }

    fn samples(&self, most: usize) -> Vec<Sample> {
        self.touches.samples(most)
    }

    fn seen(&self) -> Seen {
        self.touches.poses.seen()
    }

    fn redrawn(&self, truth: At, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let mut drawn = self.clone();
        let features_mm = self.features_at(truth.dimensions_mm);
        // the artefact is what it is; its calibration is drawn anew
        drawn.features_mm = features_mm;
        for (k, &(feature, direction)) in self.moves.iter().enumerate() {
            let calibrated = truth.dimensions_mm[k] + self.dimensions[k].u_mm * normal(rng);
            drawn.features_mm[feature] += direction * (calibrated - truth.dimensions_mm[k]);
            drawn.dimensions[k].value_mm = calibrated;
        }
        let placed = self.placed_touches(truth);
        let residuals = placed.iter().zip(&self.touches.feature).map(|((touch, pose), &feature)| {
            (touch.residual(pose), (noise.seat_mm.powi(2) + self.of_its_own[feature]).sqrt())
        });
        drawn.touches.redraw(residuals, &noise.encoder_rad, rng);
        Box::new(drawn)
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let (touches, picked) = self.touches.thinned(most);
        let mut thin = Points {
            features_mm: self.features_mm.clone(),
            frame: self.frame,
            touches,
            placements: vec![],
            whitening: self.whitening.picked(&picked),
            discounted: self.discounted.as_ref().map(|w| w.picked(&picked)),
            dimensions: self.dimensions.clone(),
            moves: self.moves.clone(),
            of_its_own: self.of_its_own.clone(),
        };
        thin.place();
        Box::new(thin)
    }

    fn as_lengths(&self) -> Option<Box<dyn Readings>> {
        let told = self.frame == Frame::Free && self.placements.iter().all(|placement| placement.span > 0);
        let pairs: Vec<(usize, usize)> = self.touches.standings.iter().flat_map(|rows| self.pairs(rows)).collect();
        if !told || pairs.is_empty() {
            return None;
        }
        Some(Box::new(self.lengths_between(&pairs, "pairs", 0.0, false)))
    }

    fn lengths_alone(&self) -> Option<Box<dyn Readings>> {
        let (feature, probe) = (&self.touches.feature, &self.touches.probe);
        let a_bar = |rows: &Range<usize>| {
            let (a, b) = (rows.start, rows.start + 1);
            rows.len() == 2 && feature[a] != feature[b] && probe[a] == probe[b]
        };
        let two_features = self.frame == Frame::Free && self.features_mm.len() == 2;
        let known = self.of_its_own.iter().all(|&variance| variance == 0.0) && self.dimensions.len() <= 1;
        let apart = self.placements.iter().all(|placement| placement.span > 0);
        if !(two_features && known && apart && self.touches.standings.iter().all(a_bar)) {
            return None;
        }
        let (name, u_mm, fitted) = match self.dimensions.first() {
            None => ("", 0.0, false),
            Some(length) => {
                let name = length.name.strip_prefix("artefact.")?.strip_suffix(".length")?;
                (name, length.u_mm, length.fitted)
            }
        };
        let pairs: Vec<(usize, usize)> =
            self.touches.standings.iter().map(|rows| (rows.start, rows.start + 1)).collect();
        Some(Box::new(self.lengths_between(&pairs, name, u_mm, fitted)))
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}

impl Points {
    /// Pairs of touches as lengths between them.
    fn lengths_between(&self, pairs: &[(usize, usize)], name: &str, u_mm: f64, fitted: bool) -> Lengths {
        let feature = |row: usize| self.features_mm[self.touches.feature[row]];
        let probe: Vec<usize> = pairs.iter().map(|&(from, _)| self.touches.probe[from]).collect();
        let length_mm: Vec<f64> = pairs.iter().map(|&(from, to)| (feature(from) - feature(to)).norm()).collect();
        Lengths::between(name, &probe, &length_mm, (u_mm, fitted), |rows| {
            let end = |row_of: fn(&(usize, usize)) -> usize| {
                self.touches.poses.picked(&rows.iter().map(|&row| row_of(&pairs[row])).collect::<Vec<_>>())
            };
            [end(|pair| pair.0), end(|pair| pair.1)]
        })
    }

    /// Touches of one standing in pairs at different features, with one probe each: every touch with three others at most,
    /// as many as hold a body of points together.
    fn pairs(&self, rows: &Range<usize>) -> Vec<(usize, usize)> {
        let apart = |a: usize, b: usize| {
            let same = self.touches.feature[a] == self.touches.feature[b];
            !same && self.touches.probe[a] == self.touches.probe[b]
        };
        let half = rows.len() / 2;
        let partners = |a: usize| {
            let others = (0..rows.len()).map(move |k| rows.start + (a - rows.start + half + k) % rows.len());
            others.filter(move |&b| b > a && apart(a, b)).take(3).map(move |b| (a, b)).collect::<Vec<_>>()
        };
        rows.clone().flat_map(partners).collect()
    }
}
