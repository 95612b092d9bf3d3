//! Rows of two poses and a length that one probe took.

use crate::artefacts::model::Model;
use crate::kinematics::Poses;
use crate::kinematics::batch::tips_of_probe_mm;
use crate::simd::Columns;

/// Rows of one probe.
#[derive(Debug, Clone)]
pub(super) struct Run {
    pub probe: usize,
    /// which rows of the file
    pub rows: Vec<usize>,
    pub from: Poses,
    pub to: Poses,
    /// length and root of the weight; the weight of padding is zero
    pub length_mm: Columns,
    pub weight: Columns,
    /// the same with what a loss makes of it
    pub discounted: Option<Columns>,
}

impl Run {
    pub fn weights(&self) -> &Columns {
        self.discounted.as_ref().unwrap_or(&self.weight)
    }

    pub fn tips(&self, model: &Model, poses: &Poses) -> Columns {
        let mut out = Columns::zeros(3, self.rows.len());
        tips_of_probe_mm(&model.chain, poses, model.tips_mm[self.probe], &mut out);
        out
    }

    pub fn distances(&self, model: &Model) -> Vec<f64> {
        let (from, to) = (self.tips(model, &self.from), self.tips(model, &self.to));
        let squared = |k: usize, j: usize| (from.column(j)[k] - to.column(j)[k]).powi(2);
        (0..self.rows.len()).map(|k| (0..3).map(|j| squared(k, j)).sum::<f64>().sqrt()).collect()
    }
}
