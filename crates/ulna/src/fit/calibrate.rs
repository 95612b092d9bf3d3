//! From readings to a calibrated arm: [`solve`], fold twins, judge what was determined and how well.

use crate::arm::Arm;
use crate::artefacts::{Unweighted, Weighing};
use crate::error::{Error, Result};
use crate::fit::judged::{Judged, decompose, judge};
use crate::fit::robust::Standing;
pub use crate::fit::scale::CommonFactor;
use crate::fit::scale::common_factor;
use crate::fit::scatter::at_minimum;
use crate::fit::solve::{ASSUMED_SCATTER_MM, prepare};
pub use crate::fit::solve::{Options, SearchReason, Solution, Start, Undecided, solve, solve_from};
use crate::fit::symmetry::{Freedom, fold};
use crate::identify::causes::Scene;
use crate::identify::families::pins;
use crate::identify::identifiability::{Identifiability, Known, Question, analyse};
use crate::monitor::{Monitor, Unwatched};
use crate::problem::Problem;
use crate::problem::assembly::Assembly;
use crate::problem::pins::Pin;
use crate::solver::LeastSquares;
use crate::solver::covariance::covariance;
use crate::solver::gram::Cost;
use crate::solver::lm::Termination;
use crate::solver::triangle::Triangle;

/// A calibrated arm, how it was found, and how well it is known.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The arm.
    pub arm: Arm,
    /// Names of all parameters: the arm's, and the fitted dimensions of artefacts.
    pub names: Vec<String>,
    /// Their values at the start.
    pub start: Vec<f64>,
    /// Where the fit ended.
    pub solution: Solution,
    /// Indices of the free parameters.
    pub free: Vec<usize>,
    /// Symmetries that brought the arm back near the nominal.
    pub folded: Vec<String>,
    /// By what all lengths are off their drawing, where one factor tells it.
    pub common_factor: Option<CommonFactor>,
    /// What the readings determine at the solution.
    pub identifiability: Identifiability,
    /// Over the free parameters, row-major; NaN where nothing is left to estimate the noise from.
    pub covariance: Vec<f64>,
    /// Scalar equations.
    pub observations: usize,
    /// Unknowns of placements.
    pub placement_unknowns: usize,
    /// Equations minus all that they determined: what is known beforehand takes none.
    pub degrees_of_freedom: f64,
    /// The variance of a whitened residual as the residuals show it, where noise is stated.
    pub chi2_per_dof: Option<f64>,
    /// Of a whitened residual, by which the covariance was made: 1 where noise is stated and the readings do not contradict it.
    pub variance: f64,
    /// Whether that was estimated from the residuals.
    pub estimated: bool,
    /// For each free parameter, what was known of it before: value and standard uncertainty.
    pub priors: Vec<Option<(f64, f64)>>,
    /// How far off each reading is, in units of the scatter of its group.
    pub standing: Standing,
    /// What the loss lets each reading count, group by group, 0 to 1; none without a loss.
    pub counted: Option<Vec<Vec<f64>>>,
    /// Residuals of each group at the start.
    pub residuals_start: Vec<Unweighted>,
    /// Residuals of each group at the end.
    pub residuals: Vec<Unweighted>,
    /// Root mean square of a reading's residual at the start, mm.
    pub rms_start_mm: f64,
    /// The same at the end.
    pub rms_mm: f64,
}

/// Poses looked at to name a cause.
const SAMPLE_POSES: usize = 60;

/// The sum of squares at many sets of the free parameters (row-major), placements where they fit best, every reading
/// weighing alike: what a search without derivatives asks for.
///
/// # Errors
/// No readings, or interrupted.
pub fn costs(problem: &mut Problem, free: &[usize], sets: &[f64], monitor: &dyn Monitor) -> Result<Vec<f64>> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    prepare(problem);
    problem.weigh(&problem.parameters(), Weighing::Even);
    let mut assembly = Assembly::new(problem, free, &[], monitor);
    let mut one = |x: &[f64]| {
        let mut cost = Cost::default();
        assembly.rows(x, false, &mut cost).map(|()| cost.0)
    };
    sets.chunks_exact(free.len().max(1)).map(&mut one).collect()
}

/// How the free parameters follow held ones, `-J⁺ ∂r/∂held`: row-major, one row a free parameter.
///
/// # Errors
/// Interrupted.
pub fn held_sensitivity(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    parameters: &[f64],
    held: &[usize],
    monitor: &dyn Monitor,
) -> Result<Vec<f64>> {
    let all: Vec<usize> = free.iter().chain(held).copied().collect();
    let x: Vec<f64> = all.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, &all, &[], monitor);
    let mut triangle = Triangle::new(all.len());
    assembly.rows(&x, true, &mut triangle)?;
    let natural_scale = &assembly.natural_scale()[..free.len()];
    let (decomposition, _) = decompose(problem, free, pins, parameters, &triangle, natural_scale);
    let mut sensitivity = vec![0.0; free.len() * held.len()];
    for k in 0..held.len() {
        for (j, value) in decomposition.pseudo_solve(&triangle, free.len() + k).into_iter().enumerate() {
            sensitivity[j * held.len() + k] = -value;
        }
    }
    Ok(sensitivity)
}

/// What the readings can and cannot determine at the problem's own arm, without fitting.
///
/// # Errors
/// No readings, or interrupted.
pub fn identify(problem: &mut Problem, free: &[usize], known: Known, monitor: &dyn Monitor) -> Result<Identifiability> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let parameters = problem.parameters();
    prepare(problem);
    problem.weigh(&parameters, Weighing::Full);
    let (pins, _) = pins(problem, free, &parameters, monitor)?;
    let judged = judge(problem, free, &pins, &parameters, monitor)?;
    let sigma = if problem.noise().is_some() { 1.0 } else { ASSUMED_SCATTER_MM };
    Ok(identifiability(problem, problem.arm(), free, &pins, &judged, known, sigma))
}

fn identifiability(
    problem: &Problem,
    arm: &Arm,
    free: &[usize],
    pins: &[Pin],
    judged: &Judged,
    known: Known,
    sigma: f64,
) -> Identifiability {
    let samples = problem.samples(SAMPLE_POSES);
    analyse(
        &judged.decomposition,
        &Question {
            scene: Scene::new(problem, arm, free, &samples),
            names: &problem.parameter_names(),
            units: &problem.parameter_units(),
            priors: &priors_of(problem, free),
            start: problem.arm(),
            pins,
            symmetries: &judged.symmetries,
            known: &problem.known(known.length_mm, known.angle_rad),
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
    fit_from(problem, free, None, options, monitor)
}

/// [`fit`] from other parameters than the problem's own, which stay what is nominal.
///
/// # Errors
/// As [`fit`], or another number of parameters.
pub fn fit_from(
    problem: &mut Problem,
    free: &[usize],
    from: Option<&[f64]>,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Fitted> {
    let expected = problem.parameter_count();
    if let Some(from) = from.filter(|from| from.len() != expected) {
        return Err(Error::Shape { what: "the parameters to start from".into(), got: from.len(), expected });
    }
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let start = problem.parameters();
    check_count(problem, free)?;
    let (residuals_start, rms_start_mm) = problem.unweighted(&start);
    let mut solution = solve_from(problem, free, from, options, monitor)?;
    let is_free = problem.is_free(free);
    let folded = fold(
        problem.arm(),
        &solution.parameters,
        &start,
        Freedom::of(problem, &is_free, options.start == Start::Search),
    );
    solution.parameters = folded.parameters;
    if !folded.steps.is_empty() {
        // a mirror image has its weights mirrored too
        problem.weigh(&solution.parameters, Weighing::Full);
        problem.discount(solution.factors.as_deref());
    }
    let whitened = problem.whitened(&solution.parameters);
    // what the readings determine does not depend on what a loss made of some of them
    problem.discount(None);
    let mut judged = judge(problem, free, &solution.pins, &solution.parameters, monitor)?;
    for (unknown, &j) in free.iter().enumerate() {
        if !judged.decomposition.kept.contains(&unknown) {
            solution.parameters[j] = start[j];
        }
    }
    let arm = problem.arm_at(&solution.parameters)?;
    let priors = priors_of(problem, free);
    let observations = problem.equations();
    let placement_unknowns = problem.placement_unknowns();
    let stated = problem.noise().is_some();
    let (shown, standing) =
        at_minimum(problem, free, &solution.parameters, &solution.pins, &mut judged, &whitened, monitor)?;
    let considered = problem.considered_u(free);
    problem.discount(solution.factors.as_deref());
    let (residuals, rms_mm) = problem.unweighted(&solution.parameters);
    let identifiability =
        identifiability(problem, &arm, free, &solution.pins, &judged, options.known, shown.variance.sqrt());
    let clear = free.iter().zip(&identifiability.in_lost).filter(|(_, lost)| !**lost);
    let determined: Vec<usize> = clear.map(|(&j, _)| j).collect();
    let common_factor = common_factor(problem, &start, &solution.parameters, &determined, options.known);
    if solution.report.termination.converged() && common_factor.is_some_and(|common| common.contradicts) {
        solution.report.termination = Termination::OffScale;
    }
    Ok(Fitted {
        identifiability,
        common_factor,
        covariance: covariance(&judged.decomposition, &judged.triangle, shown.variance, &considered),
        counted: solution.factors.as_ref().map(|factors| squared(factors)),
        arm,
        names: problem.parameter_names(),
        start,
        free: free.to_vec(),
        folded: folded.steps,
        observations,
        placement_unknowns,
        degrees_of_freedom: shown.degrees_of_freedom,
        chi2_per_dof: shown.per_dof.filter(|_| stated),
        variance: shown.variance,
        estimated: shown.estimated,
        priors,
        standing,
        solution,
        residuals_start,
        residuals,
        rms_start_mm,
        rms_mm,
    })
}

fn squared(factors: &[Vec<f64>]) -> Vec<Vec<f64>> {
    factors.iter().map(|group| group.iter().map(|factor| factor * factor).collect()).collect()
}

/// For each free parameter, what was known of it before.
fn priors_of(problem: &Problem, free: &[usize]) -> Vec<Option<(f64, f64)>> {
    let priors = problem.priors();
    let of = |j: &usize| priors.iter().find(|prior| prior.parameter == *j).map(|prior| (prior.value, prior.u));
    free.iter().map(of).collect()
}

/// More equations than unknowns there must be; unknowns whose columns vanish do not count.
fn check_count(problem: &mut Problem, free: &[usize]) -> Result<()> {
    let known = priors_of(problem, free).iter().flatten().count();
    let observations = problem.equations() + known;
    let placement_unknowns = problem.placement_unknowns();
    if observations >= placement_unknowns + free.len() {
        return Ok(());
    }
    let parameters = problem.parameters();
    prepare(problem);
    problem.weigh(&parameters, Weighing::Full);
    let kept = judge(problem, free, &[], &parameters, &Unwatched)?.decomposition.kept.len();
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
