//! Orientations as readings: three numbers each.

use super::attitudes::Attitudes;
use super::directions::Turns;
use super::scene::Seen;
use crate::artefacts::at_tips::{whitener, with_its_own};
use crate::artefacts::model::At;
use crate::artefacts::noise::{Noise, Weighing};
use crate::artefacts::placed::{Group, Observed};
use crate::artefacts::stated::Frame;
use crate::artefacts::tile::{TILE, Tile};
use crate::artefacts::touches::Touches;
use crate::artefacts::whitening::Whitening;
use crate::simd::Columns;
use nalgebra::{DMatrix, Matrix3};

impl Observed<3> for Attitudes {
    type Scene<'a> = Seen<'a>;

    fn scene<'a>(&'a self, group: &'a Group, at: At<'a>) -> Seen<'a> {
        Seen::new(self, group, at)
    }

    fn placement_unknowns(&self, _: &Group, _: usize) -> usize {
        match self.frame {
            Frame::Free => 3,
            Frame::Arm => 0,
        }
    }

    fn scale_free(&self, _: &Group) -> bool {
        true
    }

    fn tell_places(&self) -> bool {
        false
    }

    fn growing(&self, _: &Group, at: At) -> Vec<f64> {
        vec![0.0; at.dimensions.len()]
    }

    fn mirror_free(&self) -> bool {
        false
    }

    fn still_free(&self, _: &Group) -> bool {
        true
    }

    fn weigh(&mut self, group: &Group, at: At, noise: Option<&Noise>, how: Weighing) {
        let Some(noise) = noise else {
            self.whitening = Whitening::Same(1.0);
            return;
        };
        let full = if noise.encoder_rad.iter().all(|&sigma| sigma == 0.0) {
            let weight = |&u_mm: &f64| if u_mm > 0.0 { u_mm.recip() } else { 1.0 };
            Whitening::Round(Columns::from_rows(&self.u_mm.iter().map(weight).collect::<Vec<_>>(), 1))
        } else {
            let mut whitening = Columns::zeros(6, group.touches.len());
            for (row, sigma) in by_encoders(self, group, at, &noise.encoder_rad).iter().enumerate() {
                let covariance = with_its_own(sigma, self.u_mm[row].powi(2));
                for (k, value) in whitener(&covariance).into_iter().enumerate() {
                    whitening.column_mut(k)[row] = value;
                }
            }
            Whitening::Each(whitening)
        };
        self.whitening = full.weighed(how, group.touches.len());
    }

    fn discount(&mut self, factors: Option<Vec<f64>>) {
        self.discounted = factors.map(|factors| self.whitening.times(&factors));
    }

    fn weight(&self, row: usize) -> f64 {
        self.weights().weight(row)
    }

    /// The instrument's: a seat holds no target.
    fn variance_mm2(&self, _: &Group, row: usize, _: &Noise) -> f64 {
        self.u_mm[row].powi(2)
    }

    fn picked(&self, _: &Touches, rows: &[usize]) -> Attitudes {
        Attitudes {
            unknown: self.unknown.clone(),
            seen: rows.iter().map(|&row| self.seen[row]).collect(),
            u_mm: rows.iter().map(|&row| self.u_mm[row]).collect(),
            whitening: self.whitening.picked(rows),
            discounted: self.discounted.as_ref().map(|weights| weights.picked(rows)),
            ..*self
        }
    }
}

/// What the encoders' noise does to each residual, mm².
fn by_encoders(attitudes: &Attitudes, group: &Group, at: At, encoder_rad: &[f64]) -> Vec<Matrix3<f64>> {
    let chain = &at.model.chain;
    let turns = Turns::new(Seen::new(attitudes, group, at).rows(|_| Matrix3::identity()));
    let mut tile = Tile::new(&group.touches, at.model, 3);
    let mut scratch = Vec::new();
    let mut found = Vec::with_capacity(group.touches.len());
    for start in (0..group.touches.len()).step_by(TILE) {
        tile.fill(&group.touches, chain, &turns, start, &mut scratch);
        for i in 0..TILE.min(group.touches.len() - start) {
            let mut moved = DMatrix::zeros(3, encoder_rad.len());
            for component in 0..3 {
                let by_turn = |encoder: usize| tile.values(component, chain.encoder_column(encoder))[i];
                let mut along: Vec<f64> = (0..encoder_rad.len()).map(by_turn).collect();
                chain.by_encoders(&mut along, |own, of_other, ratio| own + of_other * ratio);
                let noisy = along.iter().zip(encoder_rad).map(|(along, sigma)| along * sigma);
                noisy.enumerate().for_each(|(encoder, value)| moved[(component, encoder)] = value);
            }
            let covariance = &moved * moved.transpose();
            found.push(covariance.fixed_view::<3, 3>(0, 0).into());
        }
    }
    found
}
