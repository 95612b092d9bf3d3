//! From readings to a calibrated arm: weigh, fit, notice a poor minimum, fold twins, judge what was determined.

use crate::arm::Arm;
use crate::covariance::covariance;
use crate::decomposition::Decomposition;
use crate::error::{Error, Result};
use crate::identifiability::{Context, Identifiability, Known, analyse};
use crate::monitor::{Monitor, Unwatched};
use crate::problem::{Assembly, Problem};
use crate::residuals::Unweighted;
use crate::search::{Plan, Throw, search};
use crate::solver::LeastSquares;
use crate::solver::lm::{self, Report, Termination, minimize};
use crate::solver::triangle::Triangle;
use crate::symmetry::{Freedom, fold};

/// What is known of the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// The arm's own values are near enough.
    #[default]
    Given,
    /// The zero offsets are unknown: find them.
    Search,
}

/// How to calibrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Where to start.
    pub start: Start,
    /// Most steps of one fit.
    pub max_iterations: usize,
    /// Seed of a search.
    pub seed: u64,
    /// Most starts of a search.
    pub search_starts: usize,
    /// What is known before.
    pub known: Known,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            start: Start::Given,
            max_iterations: 200,
            seed: 0,
            search_starts: 400,
            known: Known::default(),
        }
    }
}

/// Why starts were searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchReason {
    /// The study asked for it.
    Asked,
    /// The given start ended in a poor minimum.
    PoorMinimum,
}

/// Where the fit ended, without judgement.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// All parameters of the arm.
    pub parameters: Vec<f64>,
    /// How it ended.
    pub report: Report,
    /// Starts tried, 0 without a search.
    pub searched_starts: usize,
    /// Why they were.
    pub search_reason: Option<SearchReason>,
}

/// A calibrated arm, how it was found, and how well it is known.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The arm.
    pub arm: Arm,
    /// Parameters at the start.
    pub start: Vec<f64>,
    /// Where the fit ended.
    pub solution: Solution,
    /// Indices of the free parameters.
    pub free: Vec<usize>,
    /// Symmetries that brought the arm back near the nominal.
    pub folded: Vec<String>,
    /// What the readings determine at the solution.
    pub identifiability: Identifiability,
    /// Over the free parameters, row-major; NaN where nothing is left to estimate the noise from.
    pub covariance: Vec<f64>,
    /// Scalar equations.
    pub observations: usize,
    /// Unknowns of placements.
    pub placement_unknowns: usize,
    /// Equations minus all that was determined.
    pub degrees_of_freedom: usize,
    /// Cost over degrees of freedom, where noise is stated.
    pub chi2_per_dof: Option<f64>,
    /// Residuals of each group at the start.
    pub residuals_start: Vec<Unweighted>,
    /// Residuals of each group at the end.
    pub residuals: Vec<Unweighted>,
    /// Root mean square of a reading's residual at the start, mm.
    pub rms_start_mm: f64,
    /// The same at the end.
    pub rms_mm: f64,
}

/// Residuals beyond this part of the arm's reach are not what a calibrated arm leaves.
const POOR: f64 = 1e-3;
/// Weights depend on the arm; they are settled once they change its parameters by less than this part of their uncertainty.
const REWEIGHINGS: usize = 4;
/// Scatter of a reading taken for granted before there is a fit to show it, mm.
const ASSUMED_SCATTER_MM: f64 = 0.02;
/// Poses looked at to name a cause.
const SAMPLE_POSES: usize = 60;

/// Finds the free parameters that explain the readings best.
///
/// # Errors
/// No readings, fewer equations than unknowns, or interrupted.
pub fn solve(problem: &mut Problem, free: &[usize], options: &Options, monitor: &dyn Monitor) -> Result<Solution> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let start = problem.arm().parameters();
    problem.weigh(&start);
    let mut x: Vec<f64> = free.iter().map(|&j| start[j]).collect();
    let lm_options = lm::Options {
        max_iterations: options.max_iterations,
        ..lm::Options::default()
    };
    let mut searched_starts = 0;
    let mut search_reason = None;
    let plan = |throw| Plan {
        throw,
        most_starts: options.search_starts,
        seed: options.seed,
    };
    if options.start == Start::Search && !free.is_empty() {
        let found = search(problem, free, &x, plan(Throw::Anywhere), monitor)?;
        (x, searched_starts, search_reason) = (found.x, found.starts, Some(SearchReason::Asked));
    }
    let mut report = descend(problem, free, &mut x, &lm_options, monitor)?;
    if search_reason.is_none() && !free.is_empty() && poor(problem, &report) {
        let given: Vec<f64> = free.iter().map(|&j| start[j]).collect();
        let found = search(problem, free, &given, plan(Throw::Widening), monitor)?;
        (searched_starts, search_reason) = (found.starts, Some(SearchReason::PoorMinimum));
        let mut other = found.x;
        let second = descend(problem, free, &mut other, &lm_options, monitor)?;
        if second.cost < report.cost {
            let cost_start = report.cost_start;
            x = other;
            report = Report { cost_start, ..second };
        }
    }
    for _ in 0..REWEIGHINGS {
        if !problem.noise().is_some_and(|n| n.encoder_rad.iter().any(|&s| s > 0.0)) {
            break;
        }
        problem.weigh(&filled(&start, free, &x));
        let cost_start = report.cost_start;
        let again = descend(problem, free, &mut x, &lm_options, monitor)?;
        let settled = again.iterations == 0 || again.cost_start - again.cost < 1e-6 * again.cost;
        report = Report {
            cost_start,
            iterations: report.iterations + again.iterations,
            evaluations: report.evaluations + again.evaluations,
            ..again
        };
        if settled {
            break;
        }
    }
    if search_reason.is_some() && poor(problem, &report) {
        report.termination = Termination::PoorMinimum;
    }
    Ok(Solution {
        parameters: filled(&start, free, &x),
        report,
        searched_starts,
        search_reason,
    })
}

fn descend(problem: &Problem, free: &[usize], x: &mut [f64], options: &lm::Options, monitor: &dyn Monitor) -> Result<Report> {
    minimize(&mut Assembly::new(problem, free, monitor), x, options, monitor)
}

/// Whether a cost is beyond what any calibrated arm leaves.
fn poor(problem: &Problem, report: &Report) -> bool {
    let weights: f64 = problem.groups().iter().map(|g| g.weight_squared_sum()).sum();
    (report.cost / weights).sqrt() > POOR * problem.reach_mm()
}

/// All parameters, the free ones replaced.
fn filled(start: &[f64], free: &[usize], x: &[f64]) -> Vec<f64> {
    let mut parameters = start.to_vec();
    for (&j, &value) in free.iter().zip(x) {
        parameters[j] = value;
    }
    parameters
}

/// What was found at one set of parameters: the triangle of all rows and its decomposition.
struct Judged {
    triangle: Triangle,
    decomposition: Decomposition,
    symmetry: Option<Vec<f64>>,
}

fn judge(problem: &Problem, free: &[usize], parameters: &[f64], monitor: &dyn Monitor) -> Result<Judged> {
    let x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, free, monitor);
    let mut triangle = Triangle::new(free.len() + assembly.considered());
    assembly.considered_rows(&x, &mut triangle)?;
    let symmetry = assembly.scale_direction().map(<[f64]>::to_vec);
    let decomposition = Decomposition::new(&triangle, free.len(), assembly.natural_scale(), symmetry.as_deref());
    Ok(Judged {
        triangle,
        decomposition,
        symmetry,
    })
}

/// What the readings can and cannot determine at the problem's own arm, without fitting.
///
/// # Errors
/// No readings, or interrupted.
pub fn identify(problem: &mut Problem, free: &[usize], known: Known, monitor: &dyn Monitor) -> Result<Identifiability> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let parameters = problem.arm().parameters();
    problem.weigh(&parameters);
    let judged = judge(problem, free, &parameters, monitor)?;
    let sigma = if problem.noise().is_some() { 1.0 } else { ASSUMED_SCATTER_MM };
    Ok(identifiability(problem, problem.arm(), free, &judged, known, sigma))
}

fn identifiability(problem: &Problem, arm: &Arm, free: &[usize], judged: &Judged, known: Known, sigma: f64) -> Identifiability {
    analyse(
        &judged.decomposition,
        &Context {
            arm,
            free,
            poses: &problem.sample_poses(SAMPLE_POSES),
            probes_used: &problem.probes_used(),
            symmetry: judged.symmetry.as_deref(),
            known,
            sigma,
        },
    )
}

/// Calibrates: [`solve`], then folds twins, restores what cannot be determined, and judges the rest.
///
/// With nothing free it evaluates: placements are put where they fit best, the arm stays.
///
/// # Errors
/// As [`solve`].
pub fn fit(problem: &mut Problem, free: &[usize], options: &Options, monitor: &dyn Monitor) -> Result<Fitted> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let start = problem.arm().parameters();
    check_count(problem, free)?;
    let (residuals_start, rms_start_mm) = problem.unweighted(&start);
    let mut solution = solve(problem, free, options, monitor)?;
    let mut is_free = vec![false; start.len()];
    free.iter().for_each(|&j| is_free[j] = true);
    let folded = fold(
        problem.arm(),
        &solution.parameters,
        &start,
        Freedom {
            free: &is_free,
            base_free: problem.base_free(),
            mirror_free: problem.mirror_free(),
        },
    );
    solution.parameters = folded.parameters;
    let mut judged = judge(problem, free, &solution.parameters, monitor)?;
    for (unknown, &j) in free.iter().enumerate() {
        if !judged.decomposition.kept.contains(&unknown) {
            solution.parameters[j] = start[j];
        }
    }
    if judged.decomposition.rank < judged.decomposition.kept.len() && judged.symmetry.is_none() {
        judged = polish(problem, free, &mut solution, judged, monitor)?;
    }
    let arm = problem.arm().with_parameters(&solution.parameters)?;
    let observations = problem.equations();
    let placement_unknowns = problem.placement_unknowns();
    let degrees_of_freedom = observations.saturating_sub(placement_unknowns + judged.decomposition.rank);
    let per_dof = (degrees_of_freedom > 0).then(|| solution.report.cost / degrees_of_freedom as f64);
    let stated = problem.noise().is_some();
    let variance = if stated { 1.0 } else { per_dof.unwrap_or(f64::NAN) };
    let considered: Vec<f64> = problem.groups().iter().flat_map(|g| g.considered()).map(|c| c.u_mm).collect();
    let (residuals, rms_mm) = problem.unweighted(&solution.parameters);
    Ok(Fitted {
        identifiability: identifiability(problem, &arm, free, &judged, options.known, variance.sqrt()),
        covariance: covariance(&judged.decomposition, &judged.triangle, variance, &considered),
        arm,
        start,
        solution,
        free: free.to_vec(),
        folded: folded.steps,
        observations,
        placement_unknowns,
        degrees_of_freedom,
        chi2_per_dof: per_dof.filter(|_| stated),
        residuals_start,
        residuals,
        rms_start_mm,
        rms_mm,
    })
}

/// More equations than unknowns there must be; unknowns whose columns vanish do not count.
fn check_count(problem: &mut Problem, free: &[usize]) -> Result<()> {
    let observations = problem.equations();
    let placement_unknowns = problem.placement_unknowns();
    if observations >= placement_unknowns + free.len() {
        return Ok(());
    }
    let parameters = problem.arm().parameters();
    problem.weigh(&parameters);
    let kept = judge(problem, free, &parameters, &Unwatched)?.decomposition.kept.len();
    let unknowns = placement_unknowns + kept;
    if observations >= unknowns {
        return Ok(());
    }
    Err(Error::TooFewObservations {
        observations,
        unknowns,
        parameters: kept,
        placement_unknowns,
        missing: (unknowns - observations).div_ceil(observations.div_ceil(problem.readings()).max(1)),
    })
}

/// Gauss-Newton steps of least norm on the determined directions only: where a family of parameters describes the same
/// readings, damping alone would leave its members' last digits undecided.
fn polish(problem: &Problem, free: &[usize], solution: &mut Solution, judged: Judged, monitor: &dyn Monitor) -> Result<Judged> {
    let mut best = judged;
    for _ in 0..5 {
        let step = best.decomposition.pseudo_solve(&best.triangle, free.len() + considered_count(problem));
        let mut parameters = solution.parameters.clone();
        for (&j, s) in free.iter().zip(&step) {
            parameters[j] -= s;
        }
        let next = judge(problem, free, &parameters, monitor)?;
        let column = free.len() + considered_count(problem);
        let cost = |j: &Judged| (0..=column).map(|i| j.triangle.at(i, column).powi(2)).sum::<f64>();
        if cost(&next) >= cost(&best) {
            break;
        }
        solution.report.cost = cost(&next);
        solution.parameters = parameters;
        best = next;
    }
    Ok(best)
}

fn considered_count(problem: &Problem) -> usize {
    problem.groups().iter().map(|g| g.considered().len()).sum()
}
