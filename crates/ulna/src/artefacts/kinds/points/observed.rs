//! Touches of features as readings: three numbers each.

use super::lengths::pairs;
use super::placement::Placement;
use super::scene::Seen;
use super::touched::Points;
use super::weigh::for_noise;
use crate::artefacts::model::At;
use crate::artefacts::noise::{Noise, Weighing};
use crate::artefacts::placed::{Group, Observed};
use crate::artefacts::readings::Readings;
use crate::artefacts::stated::Frame;
use crate::artefacts::touches::Touches;

impl Observed<3> for Points {
    type Scene<'a> = Seen<'a>;

    fn scene<'a>(&'a self, group: &'a Group, at: At<'a>) -> Seen<'a> {
        Seen::new(self, group, at)
    }

    fn placement_unknowns(&self, _: &Group, standing: usize) -> usize {
        match self.frame {
            Frame::Free => self.placements[standing].unknowns(),
            Frame::Arm => 0,
        }
    }

    fn scale_free(&self, group: &Group) -> bool {
        let alone = |placement: &Placement| placement.span == 0;
        self.frame == Frame::Free && (self.placements.iter().all(alone) || self.of_unknown_length(group))
    }

    fn growing(&self, group: &Group, at: At) -> Vec<f64> {
        if self.of_unknown_length(group) { at.dimensions.to_vec() } else { vec![0.0; at.dimensions.len()] }
    }

    fn mirror_free(&self) -> bool {
        self.frame == Frame::Free && self.placements.iter().all(|placement| placement.span < 3)
    }

    fn still_free(&self, group: &Group) -> bool {
        self.scale_free(group)
    }

    fn weigh(&mut self, group: &Group, at: At, noise: Option<&Noise>, how: Weighing) {
        let full = for_noise(&group.touches, &self.of_its_own, at.model, noise);
        self.whitening = full.weighed(how, group.touches.len());
    }

    fn discount(&mut self, factors: Option<Vec<f64>>) {
        self.discounted = factors.map(|factors| self.whitening.times(&factors));
    }

    fn weight(&self, row: usize) -> f64 {
        self.weights().weight(row)
    }

    fn variance_mm2(&self, group: &Group, row: usize, noise: &Noise) -> f64 {
        noise.seat_mm.powi(2) + self.of_its_own[group.touches.feature[row]]
    }

    fn recalibrate(&mut self, group: &Group, truth: &[f64], calibrated: &[f64]) {
        self.features_mm = self.features_at(&group.dimensions, truth);
        for ((&(feature, direction), value), truth) in self.moves.iter().zip(calibrated).zip(truth) {
            self.features_mm[feature] += direction * (value - truth);
        }
    }

    fn picked(&self, touches: &Touches, rows: &[usize]) -> Points {
        let mut picked = Points {
            placements: vec![],
            whitening: self.whitening.picked(rows),
            discounted: self.discounted.as_ref().map(|weights| weights.picked(rows)),
            features_mm: self.features_mm.clone(),
            moves: self.moves.clone(),
            of_its_own: self.of_its_own.clone(),
            frame: self.frame,
        };
        picked.place(touches);
        picked
    }

    fn as_lengths(&self, group: &Group) -> Option<Box<dyn Readings>> {
        pairs(self, group)
    }
}
