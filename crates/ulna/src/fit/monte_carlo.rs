//! Calibrations repeated on new noise: what the uncertainties say, checked against the truth.

use crate::arm::Arm;
use crate::artefacts::Weighing;
use crate::error::{Error, Result};
use crate::fit::calibrate::{Options, fit_from};
use crate::fit::judged::{judge, triangle_at};
use crate::fit::solve::prepare;
use crate::identify::families::pins;
use crate::monitor::{Monitor, Stage, Unwatched};
use crate::problem::Problem;
use crate::problem::assembly::Assembly;
use crate::problem::pins::Pin;
use crate::seeds::mix;
use crate::solver::covariance::covariance;
use crate::solver::full_rank::FullRank;
use crate::solver::lm::{self, Report, minimize};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// One calibration on its own noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// All parameters.
    pub parameters: Vec<f64>,
    /// Standard uncertainty of each; NaN where held or not determined.
    pub u: Vec<f64>,
    /// Whether the fit converged.
    pub converged: bool,
}

/// What is repeated.
#[derive(Debug, Clone, Copy)]
pub struct Repeat<'a> {
    /// The arm that the readings are exact for before noise is added.
    pub truth: &'a Arm,
    /// The number of the first calibration: of work that is cut, where this piece begins.
    pub first: usize,
    /// How many calibrations.
    pub runs: usize,
    /// Seed; run k draws from (seed, k), however the work is cut.
    pub seed: u64,
    /// Threads to use.
    pub threads: usize,
    /// Whether uncertainties are asked for as well.
    pub uncertainties: bool,
}

/// Calibrates `runs` times on readings that are exact for `truth` plus newly drawn noise. Each fit starts at the truth:
/// what is asked is where calibrations end, not whether they find the way. What the readings do not determine stays as
/// the problem's own arm has it.
///
/// # Errors
/// No stated noise, or interrupted.
pub fn recalibrate(problem: &Problem, free: &[usize], repeat: &Repeat, monitor: &dyn Monitor) -> Result<Vec<Run>> {
    let noise = problem.noise().ok_or(Error::NoNoise)?;
    let mut problem = problem.clone();
    problem.set_arm(based_on(&problem, repeat.truth)?);
    let truth = truth_of(&problem, repeat.truth)?;
    prepare(&mut problem);
    // directions of the noise are known at the truth; where a fit takes them anew, it takes them from its own end
    problem.weigh(&truth, if problem.weighs_directions() { Weighing::Even } else { Weighing::Full });
    let (pins, _) = pins(&problem, free, &truth, monitor)?;
    let (problem, pins, truth) = (&problem, pins.as_slice(), truth.as_slice());
    let done = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let one = |run: usize| -> Result<Run> {
        if stopped.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(mix(repeat.seed, run as u64));
        let mut drawn = problem.redrawn(truth, noise, &mut rng);
        let run = match drawn.loss() {
            None => recalibrated(&mut drawn, free, pins, truth, repeat.uncertainties)?,
            Some(_) => refitted(&mut drawn, free, truth)?,
        };
        if !monitor.progress(Stage::MonteCarlo, done.fetch_add(1, Ordering::Relaxed), repeat.runs) {
            stopped.store(true, Ordering::Relaxed);
        }
        Ok(run)
    };
    let pieces = repeat.first..repeat.first + repeat.runs;
    if repeat.threads <= 1 {
        return pieces.map(one).collect();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(repeat.threads).build() {
        Ok(pool) => pool.install(|| pieces.into_par_iter().map(one).collect()),
        Err(_) => pieces.map(one).collect(),
    }
}

/// The problem's arm with the truth's base: which way the base looks is a matter of choice, and what is left of the
/// readings' own residuals is told in the truth's.
fn based_on(problem: &Problem, truth: &Arm) -> Result<Arm> {
    let (mut parameters, theirs) = (problem.arm().parameters(), truth.parameters());
    for j in problem.base_parameters() {
        parameters[j] = theirs[j];
    }
    problem.arm().with_parameters(&parameters)
}

/// The truth's parameters, artefacts as they are calibrated.
fn truth_of(problem: &Problem, truth: &Arm) -> Result<Vec<f64>> {
    let own = problem.parameters();
    let mut parameters = truth.parameters();
    if parameters.len() != problem.arm().parameter_count() {
        return Err(Error::Shape {
            what: "the true arm's parameters".into(),
            got: parameters.len(),
            expected: problem.arm().parameter_count(),
        });
    }
    parameters.extend(&own[parameters.len()..]);
    Ok(parameters)
}

/// One calibration by squares: the weights settle in one round.
fn recalibrated(drawn: &mut Problem, free: &[usize], pins: &[Pin], truth: &[f64], uncertain: bool) -> Result<Run> {
    let mut from = drawn.parameters();
    free.iter().for_each(|&j| from[j] = truth[j]);
    let (mut parameters, mut report) = descend(drawn, free, pins, &from)?;
    if drawn.weighs_directions() {
        drawn.weigh(&parameters, Weighing::Full);
        (parameters, report) = descend(drawn, free, pins, &parameters)?;
    }
    let u = if uncertain { uncertainties(drawn, free, pins, &parameters)? } else { vec![f64::NAN; parameters.len()] };
    Ok(Run { parameters, u, converged: report.termination.converged() })
}

/// One calibration with a loss: the whole fit, as a study has it.
fn refitted(drawn: &mut Problem, free: &[usize], truth: &[f64]) -> Result<Run> {
    let fitted = fit_from(drawn, free, Some(truth), &Options { search_starts: 0, ..Options::default() }, &Unwatched)?;
    let mut u = vec![f64::NAN; fitted.start.len()];
    for (unknown, &j) in free.iter().enumerate() {
        if !fitted.identifiability.in_lost[unknown] {
            u[j] = fitted.covariance[unknown * free.len() + unknown].sqrt();
        }
    }
    let converged = fitted.solution.report.termination.converged();
    Ok(Run { parameters: fitted.solution.parameters, u, converged })
}

/// One fit from some parameters, weights as they are: all parameters, and how it ended.
fn descend(problem: &Problem, free: &[usize], pins: &[Pin], from: &[f64]) -> Result<(Vec<f64>, Report)> {
    let mut parameters = from.to_vec();
    let mut x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, free, pins, &Unwatched);
    let report = minimize(&mut assembly, &mut x, &lm::Options::default(), &Unwatched)?;
    for (&j, value) in free.iter().zip(x) {
        parameters[j] = value;
    }
    Ok((parameters, report))
}

/// Standard uncertainty of every parameter; NaN where held or not determined.
fn uncertainties(problem: &Problem, free: &[usize], pins: &[Pin], parameters: &[f64]) -> Result<Vec<f64>> {
    let (triangle, natural_scale) = triangle_at(problem, free, parameters, &Unwatched)?;
    let considered = problem.considered_u(free);
    let inverse = if pins.is_empty() { FullRank::of(&triangle, free.len(), &natural_scale) } else { None };
    let variances = match inverse {
        Some(inverse) => inverse.variances_considering(&triangle, &considered),
        None => judged_variances(problem, free, pins, parameters, &considered)?,
    };
    let mut u = vec![f64::NAN; parameters.len()];
    free.iter().zip(variances).for_each(|(&j, variance)| u[j] = variance.sqrt());
    Ok(u)
}

/// The variances of the free parameters from singular values; NaN where not determined.
fn judged_variances(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    parameters: &[f64],
    considered: &[f64],
) -> Result<Vec<f64>> {
    let judged = judge(problem, free, pins, parameters, &Unwatched)?;
    let covariance = covariance(&judged.decomposition, &judged.triangle, 1.0, considered);
    let lost = judged.decomposition.lost();
    let variance = |unknown: usize| if lost[unknown] { f64::NAN } else { covariance[unknown * (free.len() + 1)] };
    Ok((0..free.len()).map(variance).collect())
}
