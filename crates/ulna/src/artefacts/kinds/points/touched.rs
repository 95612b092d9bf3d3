//! An artefact's features, and how their touches weigh.

use super::features::Move;
use super::placement::{Placement, Touch};
use crate::artefacts::dimension::Dimension;
use crate::artefacts::placed::Group;
use crate::artefacts::stated::Frame;
use crate::artefacts::touches::Touches;
use crate::artefacts::whitening::Whitening;
use crate::simd::Columns;
use nalgebra::{Isometry3, Vector3};
use std::ops::Range;

/// What is read at the features of one artefact.
#[derive(Debug, Clone)]
pub(super) struct Points {
    pub features_mm: Vec<Vector3<f64>>,
    pub frame: Frame,
    /// of each of the touches' standings
    pub placements: Vec<Placement>,
    pub whitening: Whitening,
    /// the same with what a loss makes of it
    pub discounted: Option<Whitening>,
    /// what each dimension moves
    pub moves: Vec<Move>,
    /// variance that each feature adds to its own reading alone, mm²
    pub of_its_own: Vec<f64>,
}

impl Points {
    /// Features that were touched so.
    pub fn new(
        features_mm: Vec<Vector3<f64>>,
        frame: Frame,
        moves: Vec<Move>,
        of_its_own: Vec<f64>,
        touches: &Touches,
    ) -> Points {
        let (whitening, discounted) = (Whitening::Same(1.0), None);
        let mut points = Points { features_mm, frame, placements: vec![], whitening, discounted, moves, of_its_own };
        points.place(touches);
        points
    }

    /// What each standing can show.
    pub fn place(&mut self, touches: &Touches) {
        let placement = |rows: &Range<usize>| {
            let touched: Vec<_> = touches.feature[rows.clone()].iter().map(|&f| self.features_mm[f]).collect();
            Placement::new(&touched)
        };
        self.placements = touches.standings.iter().map(placement).collect();
    }

    pub fn weights(&self) -> &Whitening {
        self.discounted.as_ref().unwrap_or(&self.whitening)
    }

    /// The features with other dimensions.
    pub fn features_at(&self, dimensions: &[Dimension], values: &[f64]) -> Vec<Vector3<f64>> {
        let mut features = self.features_mm.clone();
        for ((&(feature, direction), dimension), value) in self.moves.iter().zip(dimensions).zip(values) {
            features[feature] += direction * (value - dimension.value);
        }
        features
    }

    /// Where each placement stands, for tips and features as they are.
    pub fn poses(&self, touches: &Touches, p: &Columns, features_mm: &[Vector3<f64>]) -> Vec<Isometry3<f64>> {
        if self.frame == Frame::Arm {
            return vec![Isometry3::identity(); self.placements.len()];
        }
        let weights = self.weights();
        let touch = |row: usize| Touch {
            p_mm: Vector3::new(p.column(0)[row], p.column(1)[row], p.column(2)[row]),
            feature_mm: features_mm[touches.feature[row]],
            whiten: weights.at(row),
        };
        let mut of_one = Vec::new();
        let mut pose = |(placement, rows): (&Placement, &Range<usize>)| {
            of_one.clear();
            of_one.extend(rows.clone().map(touch));
            placement.pose(&of_one, weights.is_isotropic())
        };
        self.placements.iter().zip(&touches.standings).map(&mut pose).collect()
    }

    /// Whether the artefact is two features whose distance nobody knows.
    pub fn of_unknown_length(&self, group: &Group) -> bool {
        self.features_mm.len() == 2 && matches!(&group.dimensions[..], [length] if length.is_free())
    }
}
