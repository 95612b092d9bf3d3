//! Levenberg (1944) and Marquardt (1963), on columns scaled to unit norm, with the damping of Nielsen (1999).

use super::equations::{LeastSquares, vanished};
use super::gram::{Gram, cholesky};
use crate::error::Result;
use crate::monitor::{Monitor, Stage};

/// How a minimization ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Termination {
    /// The step would lower the cost by less than a part in 10¹².
    ConvergedCost,
    /// No unknown moves by more than rounding.
    ConvergedStep,
    /// The cost is nothing but rounding: the data are met exactly.
    Exact,
    /// Everything is held.
    NothingToFit,
    /// No step lowers the cost, yet the gradient does not vanish.
    NoProgress,
    /// The iterations ran out.
    MaxIterations,
    /// Ended at residuals far beyond what the size of the arm explains, and a search found nothing better; or, with
    /// readings that know no length, at an arm whose joints hardly move its tip.
    PoorMinimum,
    /// Every parameter is held, and residuals are far beyond what the size of the arm explains.
    HeldPoor,
    /// Reached, but every length of the arm is off its start by one factor that no drawing could be off by.
    OffScale,
}

impl Termination {
    /// The word for it in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Termination::ConvergedCost => "converged-cost",
            Termination::ConvergedStep => "converged-step",
            Termination::Exact => "exact",
            Termination::NothingToFit => "nothing-to-fit",
            Termination::NoProgress => "no-progress",
            Termination::MaxIterations => "max-iterations",
            Termination::PoorMinimum => "poor-minimum",
            Termination::HeldPoor => "held-poor",
            Termination::OffScale => "off-scale",
        }
    }

    /// Whether a minimum was reached that can be believed.
    pub fn converged(self) -> bool {
        !matches!(
            self,
            Termination::NoProgress
                | Termination::MaxIterations
                | Termination::PoorMinimum
                | Termination::HeldPoor
                | Termination::OffScale
        )
    }
}

/// What a minimization did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// How it ended.
    pub termination: Termination,
    /// Accepted steps.
    pub iterations: usize,
    /// Passes over the rows.
    pub evaluations: usize,
    /// Sum of squares at the start.
    pub cost_start: f64,
    /// Sum of squares at the end.
    pub cost: f64,
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest number of steps tried.
    pub max_iterations: usize,
    /// Relative reduction of the cost below which a step is not worth taking.
    pub cost_tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options { max_iterations: 200, cost_tolerance: 1e-12 }
    }
}

/// Damping relative to unit columns: at first, and never less. The floor is far above the rounding of a Gram matrix of
/// unit diagonal (1e-14), so the factorization cannot fail, and far below the square of a smallest singular value
/// of 6e-5, so that it does not slow the last steps.
const DAMPING_START: f64 = 1e-3;
const DAMPING_LEAST: f64 = 1e-12;
const DAMPING_MOST: f64 = 1e12;
/// Where only heavily damped steps are left, the minimum counts as reached if a full step promises less than this part
/// of the cost.
const STUCK_TOLERANCE: f64 = 1e-6;

/// Minimizes from `x`, which holds the best point found at the end.
///
/// # Errors
/// [`crate::Error::Interrupted`]; `x` is then the best point so far.
pub fn minimize(
    problem: &mut dyn LeastSquares,
    x: &mut [f64],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Report> {
    let mut here = Gram::new(problem.unknowns());
    problem.rows(x, true, &mut here)?;
    minimize_from(problem, x, here, options, monitor)
}

/// [`minimize`] where the rows at `x` have been folded already.
///
/// # Errors
/// As there.
pub fn minimize_from(
    problem: &mut dyn LeastSquares,
    x: &mut [f64],
    mut here: Gram,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Report> {
    let n = problem.unknowns();
    let mut there = Gram::new(n);
    let mut report = Report {
        termination: Termination::MaxIterations,
        iterations: 0,
        evaluations: 1,
        cost_start: here.cost(),
        cost: here.cost(),
    };
    if n == 0 {
        report.termination = Termination::NothingToFit;
        return Ok(report);
    }
    let negligible = problem.negligible_cost();
    let mut scale = vec![0.0_f64; n];
    let mut trial = x.to_vec();
    let mut step = Step::new(n);
    let mut damping = DAMPING_START;
    let mut raise = 2.0;
    for tried in 0..options.max_iterations {
        if !monitor.progress(Stage::Fit, tried, options.max_iterations) {
            return Err(crate::Error::Interrupted);
        }
        if here.cost() <= negligible {
            report.termination = Termination::Exact;
            break;
        }
        update_scale(&mut scale, &here, problem.natural_scale());
        let predicted = step.solve(&here, &scale, damping);
        if predicted <= options.cost_tolerance * here.cost() {
            // a step that damping has shortened to nothing says nothing; what a full one would gain does
            let full = if damping <= DAMPING_START { predicted } else { step.solve(&here, &scale, DAMPING_LEAST) };
            let reached = full <= STUCK_TOLERANCE * here.cost();
            report.termination = if reached { Termination::ConvergedCost } else { Termination::NoProgress };
            break;
        }
        let mut largest_move = 0.0_f64;
        for j in 0..n {
            trial[j] = x[j] + step.delta[j];
            largest_move = largest_move.max((trial[j] - x[j]).abs() / (1.0 + x[j].abs()));
        }
        there.clear();
        problem.rows(&trial, true, &mut there)?;
        report.evaluations += 1;
        let gain = (here.cost() - there.cost()) / predicted;
        if gain > 0.0 {
            x.copy_from_slice(&trial);
            std::mem::swap(&mut here, &mut there);
            report.iterations += 1;
            report.cost = here.cost();
            let factor = (1.0 - (2.0 * gain - 1.0).powi(3)).clamp(if gain > 0.9 { 0.02 } else { 1.0 / 3.0 }, 2.0);
            damping = (damping * factor).max(DAMPING_LEAST);
            raise = 2.0;
        } else {
            damping *= raise;
            raise *= 2.0;
        }
        if largest_move <= 4.0 * f64::EPSILON {
            report.termination = Termination::ConvergedStep;
            break;
        }
        if damping > DAMPING_MOST {
            report.termination = Termination::NoProgress;
            break;
        }
    }
    if here.cost() <= negligible {
        report.termination = Termination::Exact;
    }
    Ok(report)
}

/// Largest norm each column has had (Moré 1978); 0 for a column that vanished.
fn update_scale(scale: &mut [f64], gram: &Gram, natural: &[f64]) {
    let norms: Vec<f64> = (0..scale.len()).map(|j| gram.at(j, j).sqrt()).collect();
    for ((s, norm), gone) in scale.iter_mut().zip(&norms).zip(vanished(&norms, natural)) {
        *s = if gone { 0.0 } else { norm.max(*s) };
    }
}

/// The damped step and what it needs.
struct Step {
    delta: Vec<f64>,
    active: Vec<usize>,
    factor: Vec<f64>,
    scaled: Vec<f64>,
}

impl Step {
    fn new(n: usize) -> Step {
        Step { delta: vec![0.0; n], active: Vec::with_capacity(n), factor: vec![0.0; n * n], scaled: vec![0.0; n] }
    }

    /// Solves `(D⁻¹ JᵀJ D⁻¹ + λ) (D δ) = -D⁻¹ Jᵀr` by Cholesky; returns the predicted reduction of the cost.
    fn solve(&mut self, gram: &Gram, scale: &[f64], damping: f64) -> f64 {
        self.delta.fill(0.0);
        self.active.clear();
        self.active.extend((0..scale.len()).filter(|&j| scale[j] > 0.0));
        let n = self.active.len();
        let a = &mut self.factor;
        for (i, &row) in self.active.iter().enumerate() {
            let inverse = 1.0 / scale[row];
            for (j, &column) in self.active.iter().enumerate().skip(i) {
                a[i * n + j] = gram.at(row, column) * inverse / scale[column];
            }
            a[i * n + i] += damping;
            self.scaled[i] = -gram.gradient(row) * inverse;
        }
        cholesky(a, n);
        for i in 0..n {
            let row = &a[i * n..(i + 1) * n];
            let value = self.scaled[i] / row[i];
            self.scaled[i] = value;
            for (later, u) in self.scaled[i + 1..n].iter_mut().zip(&row[i + 1..]) {
                *later -= u * value;
            }
        }
        for i in (0..n).rev() {
            let row = &a[i * n..(i + 1) * n];
            let known = self.scaled[i + 1..n].iter().zip(&row[i + 1..]);
            let dot: f64 = known.map(|(value, u)| u * value).sum();
            self.scaled[i] = (self.scaled[i] - dot) / row[i];
        }
        // cost(0) - model(δ) = λ|Dδ|² - δᵀJᵀr  with (JᵀJ + λD²)δ = -Jᵀr
        let mut predicted = 0.0;
        for (i, &j) in self.active.iter().enumerate() {
            self.delta[j] = self.scaled[i] / scale[j];
            predicted += damping * self.scaled[i].powi(2) - self.delta[j] * gram.gradient(j);
        }
        predicted
    }
}
