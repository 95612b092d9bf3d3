//! Touches of features where the artefact stands: their residuals and derivatives.

use super::placement::Touch;
use super::touched::Points;
use crate::artefacts::model::At;
use crate::artefacts::placed::{Group, Scene};
use crate::artefacts::rows::MOST_OWN;
use crate::artefacts::stated::Frame;
use crate::artefacts::whitening::Whitening;
use crate::simd::Columns;
use nalgebra::{Isometry3, Vector3};

/// All touches, their artefact placed.
pub(super) struct Seen<'a> {
    points: &'a Points,
    group: &'a Group,
    /// tips of all touches, base frame
    p: Columns,
    features_mm: Vec<Vector3<f64>>,
    poses: Vec<Isometry3<f64>>,
    weights: &'a Whitening,
}

impl<'a> Seen<'a> {
    pub fn new(points: &'a Points, group: &'a Group, at: At) -> Seen<'a> {
        let p = group.touches.tips(at.model);
        let features_mm = points.features_at(&group.dimensions, at.dimensions);
        let poses = points.poses(&group.touches, &p, &features_mm);
        Seen { points, group, p, features_mm, poses, weights: points.weights() }
    }

    fn touch(&self, row: usize) -> Touch {
        Touch {
            p_mm: Vector3::new(self.p.column(0)[row], self.p.column(1)[row], self.p.column(2)[row]),
            feature_mm: self.features_mm[self.group.touches.feature[row]],
            whiten: self.weights.at(row),
        }
    }
}

impl Scene<3> for Seen<'_> {
    type Directions<'b>
        = &'b Whitening
    where
        Self: 'b;

    fn directions(&self) -> &Whitening {
        self.weights
    }

    fn undiscounted(self) -> Self {
        Seen { weights: &self.points.whitening, ..self }
    }

    fn unknowns(&self, standing: usize) -> usize {
        match self.points.frame {
            Frame::Free => self.points.placements[standing].unknowns(),
            Frame::Arm => 0,
        }
    }

    fn off_mm(&self, standing: usize, row: usize) -> Vector3<f64> {
        self.touch(row).residual(&self.poses[standing])
    }

    fn residual_mm(&self, standing: usize, row: usize) -> [f64; 3] {
        self.off_mm(standing, row).into()
    }

    fn residual(&self, standing: usize, row: usize) -> [f64; 3] {
        let touch = self.touch(row);
        (touch.whiten * touch.residual(&self.poses[standing])).into()
    }

    fn by_dimension(&self, standing: usize, row: usize, dimension: usize) -> [f64; 3] {
        let (feature, direction) = self.points.moves[dimension];
        if self.group.touches.feature[row] != feature {
            return [0.0; 3];
        }
        (-self.weights.at(row) * (self.poses[standing].rotation * direction)).into()
    }

    fn by_standing(&self, standing: usize, row: usize, own: &mut [[f64; 3]; MOST_OWN]) {
        let derivatives = self.points.placements[standing].derivatives(&self.poses[standing], &self.touch(row));
        own.iter_mut().zip(derivatives).for_each(|(own, derivative)| *own = derivative.into());
    }
}
