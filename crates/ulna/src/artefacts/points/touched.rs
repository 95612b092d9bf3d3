//! Touches of an artefact's features, and where the artefact stands.

use super::features::{Features, Frame, Move, unknown};
use super::placement::{Placement, Touch};
use super::whitening::Whitening;
use crate::artefacts::dimension::Dimension;
use crate::artefacts::model::At;
use crate::artefacts::touches::{TouchRows, Touches};
use crate::simd::Columns;
use nalgebra::{Isometry3, Vector3};
use std::ops::Range;

/// Readings of the features of one artefact.
#[derive(Debug, Clone)]
pub struct Points {
    pub(super) features_mm: Vec<Vector3<f64>>,
    pub(super) frame: Frame,
    pub(super) touches: Touches,
    /// of each of the touches' standings
    pub(super) placements: Vec<Placement>,
    pub(super) whitening: Whitening,
    /// the same with what a loss makes of it
    pub(super) discounted: Option<Whitening>,
    pub(super) dimensions: Vec<Dimension>,
    pub(super) moves: Vec<Move>,
    /// variance that each feature adds to its own reading alone, mm²
    pub(super) of_its_own: Vec<f64>,
}

impl Points {
    /// Readings of an arm of `encoders` joints.
    pub fn new(features: &Features, encoders: usize, rows: TouchRows) -> Points {
        let mut counts = vec![0; features.coordinates_mm.len()];
        rows.feature.iter().for_each(|&f| counts[f] += 1);
        let (dimensions, moves, of_its_own) = unknown(features, &counts);
        let mut points = Points {
            features_mm: features.coordinates_mm.iter().map(|&f| f.into()).collect(),
            frame: features.frame,
            touches: Touches::new(rows, encoders, features.frame == Frame::Arm),
            placements: vec![],
            whitening: Whitening::Same(1.0),
            discounted: None,
            dimensions,
            moves,
            of_its_own,
        };
        points.place();
        points
    }

    /// What each standing can show.
    pub(super) fn place(&mut self) {
        let placement = |rows: &Range<usize>| {
            let touched: Vec<_> = self.touches.feature[rows.clone()].iter().map(|&f| self.features_mm[f]).collect();
            Placement::new(&touched)
        };
        self.placements = self.touches.standings.iter().map(placement).collect();
    }

    pub(super) fn weights(&self) -> &Whitening {
        self.discounted.as_ref().unwrap_or(&self.whitening)
    }

    /// The features with other dimensions.
    pub(super) fn features_at(&self, dimensions_mm: &[f64]) -> Vec<Vector3<f64>> {
        let mut features = self.features_mm.clone();
        for ((&(feature, direction), dimension), value) in self.moves.iter().zip(&self.dimensions).zip(dimensions_mm) {
            features[feature] += direction * (value - dimension.value_mm);
        }
        features
    }

    pub(super) fn touch(&self, p: &Columns, features_mm: &[Vector3<f64>], row: usize) -> Touch {
        Touch {
            p_mm: Vector3::new(p.column(0)[row], p.column(1)[row], p.column(2)[row]),
            feature_mm: features_mm[self.touches.feature[row]],
            whiten: self.weights().at(row),
        }
    }

    /// Where each placement stands.
    pub(super) fn placement_poses(&self, p: &Columns, features_mm: &[Vector3<f64>]) -> Vec<Isometry3<f64>> {
        if self.frame == Frame::Arm {
            return vec![Isometry3::identity(); self.placements.len()];
        }
        let isotropic = self.weights().is_isotropic();
        let pose = |(placement, rows): (&Placement, &Range<usize>)| {
            let touches: Vec<Touch> = rows.clone().map(|row| self.touch(p, features_mm, row)).collect();
            placement.pose(&touches, isotropic)
        };
        self.placements.iter().zip(&self.touches.standings).map(pose).collect()
    }

    /// Every touch with the pose that its artefact has.
    pub(super) fn placed_touches(&self, at: At) -> Vec<(Touch, Isometry3<f64>)> {
        let p = self.touches.tips(at.model);
        let features_mm = self.features_at(at.dimensions_mm);
        let poses = self.placement_poses(&p, &features_mm);
        let of = |(rows, pose): (&Range<usize>, &Isometry3<f64>)| {
            rows.clone().map(|row| (self.touch(&p, &features_mm, row), *pose)).collect::<Vec<_>>()
        };
        self.touches.standings.iter().zip(&poses).flat_map(of).collect()
    }
}
