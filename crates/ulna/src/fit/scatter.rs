//! How far readings scatter about a fit, and how many of them are left to tell.
//!
//! What is known beforehand pulls a fit as readings do, but it is no reading: a parameter with a prior costs the part of a
//! degree of freedom that the readings, not the prior, determine of it. With rows J of the readings and P of the priors,
//! both weighed, the readings' residuals are `(I - H) r`, `H = J (JᵀJ + PᵀP)⁺ Jᵀ`, and their sum of squares is expected to
//! be `s² (n - tr H)`, whatever the priors are (the trace is MacKay's number of well-determined parameters, 1992). What is
//! not known of the artefacts and is not fitted counts alike: its `u` is the prior of one more unknown.

use crate::artefacts::Whitened;
use crate::error::Result;
use crate::fit::judged::{Judged, judge};
use crate::fit::robust::Standing;
use crate::monitor::Monitor;
use crate::problem::Problem;
use crate::problem::pins::Pin;
use crate::problem::priors::Prior;
use crate::solver::decomposition::Decomposition;
use crate::solver::triangle::Triangle;
use crate::solver::{BLOCK_ROWS, RowBlock, RowSink};

/// Scatter of less than this part of the stated noise, or of the arm's reach, is none.
const LEAST_OF_NOISE: f64 = 1e-2;
const LEAST_OF_REACH: f64 = 1e-12;

/// The scatter below which residuals are rounding.
pub(crate) fn least_scatter(problem: &Problem) -> f64 {
    if problem.noise().is_some() { LEAST_OF_NOISE } else { LEAST_OF_REACH * problem.reach_mm() }
}

/// Chi² per degree of freedom beyond this many standard deviations from one contradicts the stated noise: chance does so in
/// one calibration of a hundred.
const CONTRADICTS: f64 = 2.576;
/// Readings that scatter by less than a tenth of the stated noise have none: they were made without, or are copies. They
/// say nothing of what readings with noise do, for which it was stated.
const WITHOUT_NOISE: f64 = 1e-2;

/// The variance of a whitened residual: as the residuals show it, but where noise is stated and they do not contradict it,
/// one.
pub(crate) fn believed(per_dof: f64, degrees_of_freedom: f64, stated: bool) -> f64 {
    if !stated {
        return per_dof;
    }
    if per_dof < WITHOUT_NOISE {
        return 1.0;
    }
    // the cube root of chi² is nearly normal (Wilson and Hilferty 1931)
    let spread = 2.0 / (9.0 * degrees_of_freedom);
    let off = (per_dof.cbrt() - (1.0 - spread)) / spread.sqrt();
    if off.abs() > CONTRADICTS { per_dof } else { 1.0 }
}

/// What is left of readings beside a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scatter {
    /// Sum of squares of their weighed residuals, the priors' own left out.
    pub cost: f64,
    /// Equations less what placements and parameters have taken of them: `n - tr H`.
    pub degrees_of_freedom: f64,
}

impl Scatter {
    /// Of readings weighed alike for all, at the minimum. `unit`: standard deviation of a weighed residual, by which what
    /// is known beforehand was weighed in `judged`.
    pub fn of(problem: &Problem, free: &[usize], judged: &Judged, parameters: &[f64], unit: f64) -> Scatter {
        let known = Known::of(problem, free, parameters);
        let equations = (problem.equations() - problem.placement_unknowns().min(problem.equations())) as f64;
        let scatter = if known.considered.is_empty() {
            known.left(&judged.triangle, &judged.decomposition, unit)
        } else {
            let (triangle, decomposition) = with_considered(&known.considered, free.len(), judged, unit);
            Known { priors: known.all(free.len()), considered: vec![] }.left(&triangle, &decomposition, unit)
        };
        Scatter { degrees_of_freedom: (equations - scatter.degrees_of_freedom).max(0.0), ..scatter }
    }

    /// Sum of squares for each degree of freedom; none where none is left.
    pub fn per_dof(self) -> Option<f64> {
        (self.degrees_of_freedom >= LEAST_FREEDOM).then(|| self.cost / self.degrees_of_freedom)
    }
}

/// Less freedom than this is rounding of none.
const LEAST_FREEDOM: f64 = 1e-3;

/// What the residuals of a fit show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shown {
    /// Equations less what placements and parameters have taken of them.
    pub degrees_of_freedom: f64,
    /// Sum of squares for each; with a loss, of what it makes of residuals. None where none is left.
    pub per_dof: Option<f64>,
    /// The variance of a whitened residual; NaN where nothing tells.
    pub variance: f64,
    /// Whether the residuals told it.
    pub estimated: bool,
}

impl Shown {
    fn of(scatter: Scatter, stated: bool) -> Shown {
        let per_dof = scatter.per_dof();
        let variance = match per_dof {
            Some(per_dof) => believed(per_dof, scatter.degrees_of_freedom, stated),
            None if stated => 1.0,
            None => f64::NAN,
        };
        let estimated = !stated || variance != 1.0;
        Shown { degrees_of_freedom: scatter.degrees_of_freedom, per_dof, variance, estimated }
    }
}

/// Rounds in which the scatter and what it makes of priors follow each other, and when they have met.
const ROUNDS: usize = 50;
const MET: f64 = 1e-9;

/// With a loss, beyond this share of fitted parameters among the equations nobody can tell outliers from readings that the fit
/// has not followed: in simulations 95 % intervals then hold the truth less than 92 times in 100.
const MOST_FITTED: f64 = 0.4;

/// The scatter at the end of a fit, and how each reading stands; `judged` is then what the readings determine, what is known
/// beforehand weighed by that scatter.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(crate) fn at_minimum(
    problem: &mut Problem,
    free: &[usize],
    parameters: &[f64],
    pins: &[Pin],
    judged: &mut Judged,
    whitened: &[Whitened],
    monitor: &dyn Monitor,
) -> Result<(Shown, Standing)> {
    let stated = problem.noise().is_some();
    let (least, mut unit) = (least_scatter(problem), problem.unit());
    let priors = problem.priors().iter().any(|prior| free.contains(&prior.parameter));
    let known_before = priors || problem.considered_u(free).iter().any(|u| *u > 0.0);
    let mut shown = Shown::of(Scatter::of(problem, free, judged, parameters, unit), stated);
    let standing = Standing::of(whitened, shown.degrees_of_freedom, least);
    if let (Some(loss), Some(_)) = (problem.loss(), shown.per_dof) {
        let told = Standing::fitted(whitened, shown.degrees_of_freedom) <= MOST_FITTED;
        let seen = standing.variance(whitened, loss, shown.degrees_of_freedom);
        let variance = if stated && seen < WITHOUT_NOISE { 1.0 } else { seen };
        shown = Shown {
            per_dof: Some(variance),
            variance: if told { variance } else { f64::NAN },
            estimated: true,
            ..shown
        };
    }
    for _ in 0..ROUNDS {
        let next = shown.variance.sqrt().max(least);
        if next.is_nan() || !known_before || (next / unit - 1.0).abs() <= MET {
            break;
        }
        unit = next;
        if priors {
            problem.set_unit(unit);
            *judged = judge(problem, free, pins, parameters, monitor)?;
        }
        if problem.loss().is_some() {
            break;
        }
        shown = Shown::of(Scatter::of(problem, free, judged, parameters, unit), stated);
    }
    Ok((shown, standing))
}

/// What is known beside the readings, over the free parameters and the considered dimensions behind them.
struct Known {
    /// unknown, standard uncertainty, how far the minimum is from the value
    priors: Vec<(usize, f64, f64)>,
    /// columns of dimensions that are known with an uncertainty and not fitted, in the triangle, and that
    considered: Vec<(usize, f64)>,
}

impl Known {
    fn of(problem: &Problem, free: &[usize], parameters: &[f64]) -> Known {
        let unknown = |parameter: usize| free.iter().position(|&j| j == parameter);
        let prior =
            |prior: &Prior| Some((unknown(prior.parameter)?, prior.u, parameters[prior.parameter] - prior.value));
        let considered = problem.considered_u(free).into_iter().enumerate().filter(|(_, u)| *u > 0.0);
        Known {
            priors: problem.priors().iter().filter_map(prior).collect(),
            considered: considered.map(|(c, u)| (free.len() + c, u)).collect(),
        }
    }

    /// The considered dimensions as unknowns behind `free` others, each with its prior.
    fn all(&self, free: usize) -> Vec<(usize, f64, f64)> {
        let behind = self.considered.iter().enumerate().map(|(k, &(_, u))| (free + k, u, 0.0));
        self.priors.iter().copied().chain(behind).collect()
    }

    /// Sum of squares of the readings at the minimum over all unknowns of a triangle, and how many of them readings alone
    /// determine.
    fn left(&self, triangle: &Triangle, decomposition: &Decomposition, unit: f64) -> Scatter {
        let residual = triangle.unknowns();
        let step = decomposition.pseudo_solve(triangle, residual);
        let total: f64 = (0..=residual).map(|row| triangle.at(row, residual).powi(2)).sum();
        let explained: f64 = decomposition.explained(triangle, residual);
        let variances = if self.priors.is_empty() { vec![] } else { decomposition.variances() };
        let (mut of_priors, mut told) = (0.0, 0.0);
        for &(unknown, u, off) in &self.priors {
            let weight = (unit / u).powi(2);
            of_priors += weight * (off - step[unknown]).powi(2);
            told += weight * variances[unknown];
        }
        let cost = (total - explained - of_priors).max(0.0);
        Scatter { cost, degrees_of_freedom: decomposition.rank as f64 - told }
    }
}

/// The triangle of free parameters and considered dimensions, these with their priors, and its decomposition.
fn with_considered(considered: &[(usize, f64)], free: usize, judged: &Judged, unit: f64) -> (Triangle, Decomposition) {
    let old = &judged.triangle;
    let unknowns = free + considered.len();
    let columns: Vec<usize> = (0..free).chain(considered.iter().map(|&(c, _)| c)).chain([old.unknowns()]).collect();
    let of_readings = (0..=old.unknowns()).map(|row| columns.iter().map(|&c| old.at(row, c)).collect());
    let of_priors = considered.iter().enumerate().map(|(k, &(_, u))| {
        let mut row = vec![0.0; unknowns + 1];
        row[free + k] = unit / u;
        row
    });
    let rows: Vec<Vec<f64>> = of_readings.chain(of_priors).collect();
    let mut triangle = Triangle::new(unknowns);
    for rows in rows.chunks(BLOCK_ROWS) {
        triangle.fold(&mut RowBlock::of_rows(rows, unknowns));
    }
    // what vanished without them has been judged: every other column is there
    let norms = triangle.column_norms();
    let gone = |j: &usize| *j < free && !judged.decomposition.kept.contains(j);
    let natural_scale: Vec<f64> =
        (0..unknowns).map(|j| if gone(&j) { f64::MAX } else { norms[j].max(f64::MIN_POSITIVE) }).collect();
    let behind = |direction: &Vec<f64>| direction.iter().copied().chain(considered.iter().map(|_| 0.0)).collect();
    let symmetries: Vec<Vec<f64>> = judged.symmetries.iter().map(|(_, direction)| behind(direction)).collect();
    let slices: Vec<&[f64]> = symmetries.iter().map(Vec::as_slice).collect();
    let decomposition = Decomposition::new(&triangle, unknowns, &natural_scale, &slices);
    (triangle, decomposition)
}
