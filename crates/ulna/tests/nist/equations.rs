//! Equations of any model as the solver takes them, and what it makes of them.

use crate::dual::Dual;
use ulna::error::Result;
use ulna::monitor::Unwatched;
use ulna::simd::Columns;
use ulna::solver::covariance::covariance;
use ulna::solver::decomposition::Decomposition;
use ulna::solver::gram::Cost;
use ulna::solver::lm::{self, Options, Report};
use ulna::solver::triangle::Triangle;
use ulna::solver::{BLOCK_ROWS, LeastSquares, RowBlock, RowSink};

/// One residual for each row, as a function of the unknowns.
pub struct Equations<F: Fn(&[Dual], usize) -> Dual> {
    residual: F,
    rows: usize,
    natural_scale: Vec<f64>,
    least_cost: f64,
    negligible_cost: f64,
}

impl<F: Fn(&[Dual], usize) -> Dual> Equations<F> {
    /// rounding: of a residual that is met exactly. How far an unknown moves a residual at the most is what it did so far
    /// on the way down: nobody knows it beforehand.
    pub fn new(unknowns: usize, rows: usize, rounding: f64, residual: F) -> Equations<F> {
        let negligible_cost = rows as f64 * rounding * rounding;
        Equations {
            residual,
            rows,
            natural_scale: vec![f64::MIN_POSITIVE; unknowns],
            least_cost: f64::INFINITY,
            negligible_cost,
        }
    }

    /// Descends from `x`, which ends at the minimum.
    pub fn minimize(&mut self, x: &mut [f64], options: &Options) -> Report {
        lm::minimize(self, x, options, &Unwatched).unwrap()
    }

    /// The sum of squares, summed once more.
    pub fn cost(&mut self, x: &[f64]) -> f64 {
        let mut cost = Cost::default();
        self.rows(x, false, &mut cost).unwrap();
        cost.0
    }

    /// The standard deviation of each unknown, as a calibration states it without a stated noise: the scatter is that of
    /// the residuals. None where one of them moves no residual any more.
    pub fn deviations(&mut self, x: &[f64]) -> Option<Vec<f64>> {
        let n = x.len();
        let mut triangle = Triangle::new(n);
        self.rows(x, true, &mut triangle).unwrap();
        let decomposition = Decomposition::new(&triangle, n, &self.natural_scale, &[]);
        let variance = self.cost(x) / (self.rows - n) as f64;
        let covariance = covariance(&decomposition, &triangle, variance, &[]);
        (decomposition.rank == n).then(|| (0..n).map(|j| covariance[j * n + j].sqrt()).collect())
    }
}

impl<F: Fn(&[Dual], usize) -> Dual> LeastSquares for Equations<F> {
    fn unknowns(&self) -> usize {
        self.natural_scale.len()
    }

    fn natural_scale(&self) -> &[f64] {
        &self.natural_scale
    }

    fn negligible_cost(&self) -> f64 {
        self.negligible_cost
    }

    fn rows(&mut self, x: &[f64], jacobian: bool, sink: &mut dyn RowSink) -> Result<()> {
        let (n, unknowns) = (x.len(), Dual::unknowns(x));
        let (mut cost, mut steepest) = (0.0, self.natural_scale.clone());
        for first in (0..self.rows).step_by(BLOCK_ROWS) {
            let count = BLOCK_ROWS.min(self.rows - first);
            let mut columns = Columns::zeros(n + 1, count);
            for row in 0..count {
                let residual = (self.residual)(&unknowns, first + row);
                for (j, slope) in residual.slopes[..n].iter().enumerate() {
                    columns.column_mut(j)[row] = *slope;
                    steepest[j] = steepest[j].max(slope.abs());
                }
                cost += residual.value * residual.value;
                columns.column_mut(n)[row] = residual.value;
            }
            let targets = if jacobian { (0..n).map(|j| (j, j)).collect() } else { vec![] };
            let rows = columns.padded_rows();
            sink.fold(&mut RowBlock { columns, rows, targets, residual: n, standing: vec![] });
        }
        if cost <= self.least_cost {
            (self.least_cost, self.natural_scale) = (cost, steepest);
        }
        Ok(())
    }
}
