//! `points`, `bar`, `seat`: the tip on a feature with known coordinates, of an artefact that stands somewhere.
//!
//! ```text
//! r = W (p(q) - (R f + t))       WᵀW = Σ⁻¹,  Σ = J_q Σ_encoder J_qᵀ + σ_seat² I
//! ```
//!
//! A seat is an artefact of one feature, a bar of two. With `frame = "arm"` R and t are known (none).

mod placement;
mod rows;
mod tile;
mod weigh;
mod whitening;

use super::length::normal;
use super::{Considered, Model, Noise, Readings, Unknowns, Unweighted, Weighing, Writer};
use crate::error::Result;
use crate::kinematics::Poses;
use crate::kinematics::batch::tips_mm;
use crate::simd::Columns;
use nalgebra::{Isometry3, Vector3};
use placement::{Placement, Touch};
use rand_xoshiro::Xoshiro256PlusPlus;
use whitening::Whitening;

/// Where an artefact's coordinates hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// In its own frame: each placement has an unknown pose.
    Free,
    /// In the arm's base frame.
    Arm,
}

/// Readings of the features of one artefact.
#[derive(Debug, Clone)]
pub struct Points {
    features_mm: Vec<Vector3<f64>>,
    frame: Frame,
    placements: Vec<Placement>,
    /// which row of the file each reading is; readings are sorted by placement and feature
    order: Vec<usize>,
    poses: Poses,
    probe: Vec<usize>,
    feature: Vec<usize>,
    /// what the tip is off by for reasons of its own, taken away before the residual (used by simulation)
    offset_mm: Option<Columns>,
    whitening: Whitening,
    considered: Vec<Considered>,
    /// for each considered dimension, the feature and the direction in which it would move, artefact frame
    considered_moves: Vec<(usize, Vector3<f64>)>,
}

/// What rows of a file say.
#[derive(Debug, Clone, Copy)]
pub struct PointRows<'a> {
    /// Row-major angles, rad.
    pub q_rad: &'a [f64],
    /// Which probe took each row.
    pub probe: &'a [usize],
    /// Which feature was touched.
    pub feature: &'a [usize],
    /// Which standing of the artefact: any labels.
    pub placement: &'a [i64],
}

/// An artefact's features: coordinates, and which of them are uncertain.
#[derive(Debug, Clone)]
pub struct Features<'a> {
    /// The artefact's name.
    pub name: &'a str,
    /// Coordinates, mm.
    pub coordinates_mm: &'a [[f64; 3]],
    /// Standard uncertainty of each feature's coordinates, mm; of a bar, that of its length.
    pub u_mm: f64,
    /// Where the coordinates hold.
    pub frame: Frame,
}

impl Points {
    /// Readings of an arm of `encoders` joints.
    pub fn new(features: &Features, encoders: usize, data: PointRows) -> Points {
        let features_mm: Vec<Vector3<f64>> = features.coordinates_mm.iter().map(|&f| f.into()).collect();
        let mut first_seen = std::collections::HashMap::new();
        let placement: Vec<usize> = data
            .placement
            .iter()
            .map(|&label| {
                let next = first_seen.len();
                let label = if features.frame == Frame::Arm { 0 } else { label };
                *first_seen.entry(label).or_insert(next)
            })
            .collect();
        let mut order: Vec<usize> = (0..data.feature.len()).collect();
        order.sort_by_key(|&r| (placement[r], data.feature[r], r));
        let feature: Vec<usize> = order.iter().map(|&r| data.feature[r]).collect();
        let of_placement: Vec<usize> = order.iter().map(|&r| placement[r]).collect();
        let mut placements = Vec::new();
        for rows in equal_runs(&of_placement) {
            let touched: Vec<_> = feature[rows.clone()].iter().map(|&f| features_mm[f]).collect();
            placements.push(Placement::new(rows, &touched));
        }
        let mut points = Points {
            features_mm,
            frame: features.frame,
            placements,
            poses: Poses::gathered(data.q_rad, encoders, &order),
            probe: order.iter().map(|&r| data.probe[r]).collect(),
            order,
            feature,
            offset_mm: None,
            whitening: Whitening::Same(1.0),
            considered: vec![],
            considered_moves: vec![],
        };
        points.consider(features);
        points
    }

    /// Of a bar, the length; of other artefacts with more than one feature, every coordinate of every feature.
    fn consider(&mut self, features: &Features) {
        if features.u_mm <= 0.0 {
            return;
        }
        let name = features.name;
        match (features.coordinates_mm.len(), self.frame) {
            (1, Frame::Free) => {}
            (2, Frame::Free) => {
                let along = (self.features_mm[1] - self.features_mm[0]).normalize();
                self.considered_moves.push((1, along));
                self.considered.push(Considered { name: format!("artefact.{name}.length"), u_mm: features.u_mm });
            }
            (count, _) => {
                for feature in 0..count {
                    for (axis, letter) in ["x", "y", "z"].iter().enumerate() {
                        self.considered_moves.push((feature, Vector3::ith(axis, 1.0)));
                        self.considered.push(Considered {
                            name: format!("artefact.{name}.feature.{}.{letter}", feature + 1),
                            u_mm: features.u_mm,
                        });
                    }
                }
            }
        }
    }

    /// Tips of all readings, base frame, mm.
    fn tips(&self, model: &Model) -> Columns {
        let mut p = Columns::zeros(3, self.order.len());
        tips_mm(&model.chain, &self.poses, &self.tip_of_each(model), &mut p);
        if let Some(offset) = &self.offset_mm {
            for j in 0..3 {
                for (value, o) in p.column_mut(j).iter_mut().zip(offset.column(j)) {
                    *value -= o;
                }
            }
        }
        p
    }

    fn tip_of_each(&self, model: &Model) -> Columns {
        let mut tips = Columns::zeros(3, self.order.len());
        for j in 0..3 {
            for (value, &probe) in tips.column_mut(j).iter_mut().zip(&self.probe) {
                *value = model.tips_mm[probe][j];
            }
        }
        tips
    }

    fn touch(&self, p: &Columns, row: usize) -> Touch {
        Touch {
            p_mm: Vector3::new(p.column(0)[row], p.column(1)[row], p.column(2)[row]),
            feature_mm: self.features_mm[self.feature[row]],
            whiten: self.whitening.at(row),
        }
    }

    /// Where each placement stands.
    fn placement_poses(&self, p: &Columns) -> Vec<Isometry3<f64>> {
        if self.frame == Frame::Arm {
            return vec![Isometry3::identity(); self.placements.len()];
        }
        let isotropic = self.whitening.is_isotropic();
        let pose = |placement: &Placement| {
            let touches: Vec<Touch> = placement.rows.clone().map(|row| self.touch(p, row)).collect();
            placement.pose(&touches, isotropic)
        };
        self.placements.iter().map(pose).collect()
    }
}

/// Maximal runs of equal values.
fn equal_runs(values: &[usize]) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for end in 1..=values.len() {
        if end == values.len() || values[end] != values[start] {
            runs.push(start..end);
            start = end;
        }
    }
    runs
}

impl Readings for Points {
    fn len(&self) -> usize {
        self.order.len()
    }

    fn equations(&self) -> usize {
        3 * self.order.len()
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
        (0..probes).map(|p| self.probe.contains(&p)).collect()
    }

    fn considered(&self) -> &[Considered] {
        &self.considered
    }

    fn sin_cos_bytes(&self) -> usize {
        self.order.len() * self.poses.encoders() * 2 * size_of::<f64>()
    }

    fn keep_sin_cos(&mut self) {
        self.poses.keep_sin_cos();
    }

    fn weigh(&mut self, model: &Model, noise: Option<&Noise>, how: Weighing) {
        let full = weigh::for_noise(self, model, noise);
        self.whitening = match how {
            Weighing::Full => full,
            Weighing::Even => full.even(self.order.len()),
        };
    }

    fn weight_squared_sum(&self) -> f64 {
        (0..self.order.len()).map(|row| self.whitening.at(row).norm_squared() / 3.0).sum()
    }

    fn stream(&self, model: &Model, unknowns: &Unknowns, jacobian: bool, out: &mut Writer) -> Result<()> {
        rows::stream(self, model, unknowns, jacobian, out)
    }

    fn unweighted(&self, model: &Model) -> Unweighted {
        let p = self.tips(model);
        let poses = self.placement_poses(&p);
        let mut residuals_mm = vec![0.0; 3 * self.order.len()];
        let mut weights = vec![0.0; self.order.len()];
        for (placement, pose) in self.placements.iter().zip(&poses) {
            for row in placement.rows.clone() {
                let touch = self.touch(&p, row);
                let at = self.order[row];
                residuals_mm[3 * at..3 * at + 3].copy_from_slice(touch.residual(pose).as_slice());
                weights[at] = (touch.whiten.norm_squared() / 3.0).sqrt();
            }
        }
        Unweighted { components: 3, residuals_mm, weights }
    }

    fn sample_poses(&self, most: usize) -> Vec<(usize, Vec<f64>)> {
        let step = self.order.len().div_ceil(most.max(1)).max(1);
        let rows = (0..self.order.len()).step_by(step);
        rows.map(|row| (self.probe[row], self.poses.pose(row))).collect()
    }

    fn redrawn(&self, truth: &Model, noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Box<dyn Readings> {
        let mut drawn = self.clone();
        let p = self.tips(truth);
        let poses = self.placement_poses(&p);
        for (considered, (feature, direction)) in self.considered.iter().zip(&self.considered_moves) {
            drawn.features_mm[*feature] += direction * (considered.u_mm * normal(rng));
        }
        let mut offset = self.offset_mm.clone().unwrap_or_else(|| Columns::zeros(3, self.order.len()));
        for (placement, pose) in self.placements.iter().zip(&poses) {
            for row in placement.rows.clone() {
                let residual = self.touch(&p, row).residual(pose);
                for j in 0..3 {
                    offset.column_mut(j)[row] += residual[j] + noise.seat_mm * normal(rng);
                }
            }
        }
        drawn.offset_mm = Some(offset);
        drawn.poses.add_noise(&noise.encoder_rad, rng);
        Box::new(drawn)
    }

    fn thinned(&self, most: usize) -> Box<dyn Readings> {
        let mut picked = Vec::new();
        let mut placements = Vec::new();
        for placement in &self.placements {
            let rows = placement.rows.len();
            let share = (most * rows).div_ceil(self.order.len()).clamp(4.min(rows), rows);
            let begin = picked.len();
            picked.extend((0..share).map(|i| placement.rows.start + i * (rows - 1) / (share - 1).max(1)));
            let touched: Vec<_> = picked[begin..].iter().map(|&row| self.features_mm[self.feature[row]]).collect();
            placements.push(Placement::new(begin..picked.len(), &touched));
        }
        Box::new(Points {
            features_mm: self.features_mm.clone(),
            frame: self.frame,
            placements,
            order: (0..picked.len()).collect(),
            poses: self.poses.picked(&picked),
            probe: picked.iter().map(|&row| self.probe[row]).collect(),
            feature: picked.iter().map(|&row| self.feature[row]).collect(),
            offset_mm: self.offset_mm.as_ref().map(|o| o.picked(&picked)),
            whitening: self.whitening.picked(&picked),
            considered: self.considered.clone(),
            considered_moves: self.considered_moves.clone(),
        })
    }

    fn boxed(&self) -> Box<dyn Readings> {
        Box::new(self.clone())
    }
}
