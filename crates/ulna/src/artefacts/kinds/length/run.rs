//! Rows of two poses and a length that one probe took.

use crate::artefacts::model::Model;
use crate::kinematics::Poses;
use crate::kinematics::batch::tips_of_probe_mm;
use crate::simd::Columns;

/// Rows of one probe.
#[derive(Debug, Clone)]
pub(in crate::artefacts::kinds) struct Run {
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
    /// Rows of the file between whose poses these lengths are, each weighing one.
    pub fn new(probe: usize, rows: Vec<usize>, [from, to]: [Poses; 2], length_mm: &[f64]) -> Run {
        let mut weight = Columns::zeros(1, rows.len());
        weight.column_mut(0)[..rows.len()].fill(1.0);
        Run { probe, rows, from, to, length_mm: Columns::from_rows(length_mm, 1), weight, discounted: None }
    }

    /// Weighs each row by itself.
    pub fn weigh(&mut self, weight: impl Fn(usize) -> f64) {
        let rows = self.rows.len();
        self.weight.column_mut(0)[..rows].iter_mut().enumerate().for_each(|(k, w)| *w = weight(k));
        self.discounted = None;
    }

    pub fn weights(&self) -> &Columns {
        self.discounted.as_ref().unwrap_or(&self.weight)
    }

    pub fn tips(&self, model: &Model, poses: &Poses) -> Columns {
        let mut out = Columns::zeros(3, self.rows.len());
        tips_of_probe_mm(&model.chain, poses, model.tips_mm[self.probe], &mut out);
        out
    }
}
