//! Touches of artefacts that stand somewhere: sorted by standing, so that each can be placed and eliminated by itself.

use super::model::Model;
use super::noise::normal;
use super::standings::Standings;
use super::stated::Rows;
use crate::kinematics::batch::tips_mm;
use crate::kinematics::{Poses, Sample};
use crate::simd::Columns;
use nalgebra::Vector3;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::ops::Range;

/// Touches, standing by standing.
#[derive(Debug, Clone)]
pub(super) struct Touches {
    /// which row of the file each touch is
    pub order: Vec<usize>,
    pub poses: Poses,
    pub probe: Vec<usize>,
    pub feature: Vec<usize>,
    /// the touches of each standing
    pub standings: Vec<Range<usize>>,
    /// what each tip is off by for reasons of its own, base frame, mm (used by simulation)
    offset_mm: Option<Columns>,
}

impl Touches {
    /// Rows of a file by standing; `number` says what each is called here.
    pub fn new(rows: &Rows, encoders: usize, standings: Standings, number: impl Fn(usize) -> usize) -> Touches {
        let order = &standings.order;
        Touches {
            poses: Poses::gathered(rows.poses, encoders, order),
            probe: order.iter().map(|&r| rows.probe[r]).collect(),
            feature: order.iter().map(|&r| rows.feature.map_or(0, |feature| feature[r])).collect(),
            order: order.iter().map(|&r| number(r)).collect(),
            standings: standings.each,
            offset_mm: None,
        }
    }

    /// Number of touches.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Points of the last link where each touch was taken, so far from the tip in the probe's frame: base frame, mm.
    pub fn points(&self, model: &Model, from_tip_mm: [f64; 3]) -> Columns {
        let mut places = self.tip_of_each(model);
        for (j, &away) in from_tip_mm.iter().enumerate() {
            places.column_mut(j).iter_mut().for_each(|value| *value += away);
        }
        let mut p = Columns::zeros(3, self.len());
        tips_mm(&model.chain, &self.poses, &places, &mut p);
        p
    }

    /// What a touch is off by for reasons of its own, base frame, mm.
    pub fn offset_mm(&self, row: usize) -> Vector3<f64> {
        let Some(offset) = &self.offset_mm else { return Vector3::zeros() };
        Vector3::from([0, 1, 2].map(|j| offset.column(j)[row]))
    }

    /// Tips of all touches, base frame, mm.
    pub fn tips(&self, model: &Model) -> Columns {
        let mut p = self.points(model, [0.0; 3]);
        if let Some(offset) = &self.offset_mm {
            for j in 0..3 {
                p.column_mut(j).iter_mut().zip(offset.column(j)).for_each(|(value, off)| *value -= off);
            }
        }
        p
    }

    /// Takes `residual` of each touch away from its tip, which is then where it should be, and adds noise of a deviation
    /// for each touch; and noise of the encoders.
    pub fn redraw(
        &mut self,
        residuals: impl Iterator<Item = (Vector3<f64>, f64)>,
        encoder_rad: &[f64],
        rng: &mut Xoshiro256PlusPlus,
    ) {
        let mut offset = self.offset_mm.take().unwrap_or_else(|| Columns::zeros(3, self.len()));
        for (row, (residual, sigma)) in residuals.enumerate() {
            for j in 0..3 {
                offset.column_mut(j)[row] += residual[j] + sigma * normal(rng);
            }
        }
        self.offset_mm = Some(offset);
        self.poses.add_noise(encoder_rad, rng);
    }

    /// The probe's tip of each touch, mm.
    pub fn tip_of_each(&self, model: &Model) -> Columns {
        let mut tips = Columns::zeros(3, self.len());
        for j in 0..3 {
            for (value, &probe) in tips.column_mut(j).iter_mut().zip(&self.probe) {
                *value = model.tips_mm[probe][j];
            }
        }
        tips
    }

    /// For each probe, whether it took any.
    pub fn probes_used(&self, probes: usize) -> Vec<bool> {
        (0..probes).map(|p| self.probe.contains(&p)).collect()
    }

    /// Bytes that keeping sines and cosines would take.
    pub fn sin_cos_bytes(&self) -> usize {
        self.len() * self.poses.encoders() * 2 * size_of::<f64>()
    }

    /// About `most` of the poses.
    pub fn samples(&self, most: usize) -> Vec<Sample> {
        let step = self.len().div_ceil(most.max(1)).max(1);
        (0..self.len()).step_by(step).map(|row| self.poses.sample(row, self.probe[row])).collect()
    }

    /// About `most` of the touches, some of every standing, and which they were.
    pub fn thinned(&self, most: usize) -> (Touches, Vec<usize>) {
        let mut picked = Vec::new();
        let mut standings = Vec::new();
        for standing in &self.standings {
            let rows = standing.len();
            let share = (most * rows).div_ceil(self.len()).clamp(4.min(rows), rows);
            let begin = picked.len();
            picked.extend((0..share).map(|i| standing.start + i * (rows - 1) / (share - 1).max(1)));
            standings.push(begin..picked.len());
        }
        let thin = Touches {
            order: (0..picked.len()).collect(),
            poses: self.poses.picked(&picked),
            probe: picked.iter().map(|&row| self.probe[row]).collect(),
            feature: picked.iter().map(|&row| self.feature[row]).collect(),
            standings,
            offset_mm: self.offset_mm.as_ref().map(|offset| offset.picked(&picked)),
        };
        (thin, picked)
    }

    /// Numbers in the order of the file, from numbers in the order of the touches.
    pub fn filed(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut filed = vec![0.0; self.len()];
        self.order.iter().zip(values).for_each(|(&row, value)| filed[row] = value);
        filed
    }
}
