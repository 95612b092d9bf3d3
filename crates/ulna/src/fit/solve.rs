//! The way to the minimum: weigh, pin what cannot be seen, descend, notice a poor end and search on, weigh again.

use crate::artefacts::Weighing;
use crate::error::{Error, Result};
use crate::fit::search::{
    Plan, Throw, collapsed, does_better, is_zero_offset, may_collapse, off_scale, poor, search, unexplained,
};
use crate::fit::signs;
pub use crate::fit::signs::Undecided;
use crate::fit::way::Way;
use crate::identify::families::pins;
use crate::identify::identifiability::Known;
use crate::monitor::Monitor;
use crate::problem::Problem;
use crate::problem::pins::Pin;
use crate::solver::lm::{self, Report, Termination};

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
    /// Joints whose encoder signs are not known either, a bit each: find them.
    pub unknown_signs: u64,
    /// What is known before.
    pub known: Known,
    /// Root mean square of the residuals from which on a minimum is poor, mm; `None`: the stated noise says, or a part of
    /// the reach.
    pub poor_above_mm: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            start: Start::Given,
            max_iterations: 200,
            seed: 0,
            search_starts: 2000,
            unknown_signs: 0,
            known: Known::default(),
            poor_above_mm: None,
        }
    }
}

impl Options {
    fn of_lm(&self) -> lm::Options {
        lm::Options { max_iterations: self.max_iterations, ..lm::Options::default() }
    }
}

/// Why starts were searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchReason {
    /// The study asked for it.
    Asked,
    /// The given start ended in a poor minimum.
    PoorMinimum,
    /// The stated noise did not explain what the given start left.
    Unexplained,
    /// No noise was stated, and the arm was of quite another size than the given one.
    OffScale,
}

/// Where the fit ended, without judgement.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// All parameters of the problem.
    pub parameters: Vec<f64>,
    /// How it ended.
    pub report: Report,
    /// Starts tried, 0 without a search.
    pub searched_starts: usize,
    /// Why they were.
    pub search_reason: Option<SearchReason>,
    /// Directions held at their start because the readings do not determine them.
    pub pins: Vec<Pin>,
    /// What a loss makes of each reading, group by group: the root of what it counts.
    pub factors: Option<Vec<Vec<f64>>>,
    /// Sets of joints that may all count the other way: the readings and the nominal arm do not tell.
    pub undecided_signs: Vec<Undecided>,
}

/// Scatter of a reading taken for granted before there is a fit to show it, mm.
pub(crate) const ASSUMED_SCATTER_MM: f64 = 0.02;

/// Finds the free parameters that explain the readings best. Signs that were found stay with the problem's arm.
///
/// # Errors
/// No readings, or interrupted.
pub fn solve(problem: &mut Problem, free: &[usize], options: &Options, monitor: &dyn Monitor) -> Result<Solution> {
    solve_from(problem, free, None, options, monitor)
}

/// [`solve`] from other parameters than the problem's own, which stay what is nominal: where a search of another kind
/// ended, say.
///
/// # Errors
/// As [`solve`].
pub fn solve_from(
    problem: &mut Problem,
    free: &[usize],
    from: Option<&[f64]>,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Solution> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let start = problem.parameters();
    prepare(problem);
    problem.weigh(&start, Weighing::Even);
    // most of what an arm does beyond its geometry is small: it is sought from where the geometry is found
    let arm = problem.arm();
    let is_large = |j: usize| arm.effect_of(j).map_or(j < arm.geometry_count(), |(effect, _)| !effect.is_small());
    let geometry: Vec<usize> = free.iter().copied().filter(|&j| is_large(j)).collect();
    let (mut geometry_pins, gram) = pins(problem, &geometry, &start, monitor)?;
    let cost_start = gram.cost();
    let plan = |throw| Plan {
        throw,
        most_starts: options.search_starts,
        seed: options.seed,
        poor_above_mm: options.poor_above_mm,
    };
    let can_collapse = may_collapse(problem, &geometry_pins);
    let is_poor = |problem: &Problem, parameters: &[f64], cost: f64| {
        poor(problem, parameters, cost, free.len(), options.poor_above_mm)
            || (can_collapse || unexplained(problem, cost, free.len())) && collapsed(problem, parameters)
    };
    let given: Vec<f64> = geometry.iter().map(|&j| start[j]).collect();
    let (mut searched_starts, mut search_reason, mut undecided_signs) = (0, None, vec![]);
    let can_search = options.search_starts > 0 && geometry.iter().any(|&j| is_zero_offset(problem, j));

    let mut here = start.clone();
    if let Some(from) = from {
        free.iter().for_each(|&j| here[j] = from[j]);
    }
    let place = |here: &mut Vec<f64>, x: &[f64]| geometry.iter().zip(x).for_each(|(&j, &value)| here[j] = value);
    let mut descended = None;
    if options.unknown_signs != 0 && can_search {
        let found = signs::search(problem, &geometry, &given, options.unknown_signs, plan(Throw::Anywhere), monitor)?;
        problem.set_arm(problem.arm().with_signs(&found.signs));
        place(&mut here, &found.x);
        (searched_starts, search_reason) = (found.starts, Some(SearchReason::Asked));
        undecided_signs = found.undecided;
        geometry_pins = pins(problem, &geometry, &start, monitor)?.0;
    } else if options.start == Start::Search && can_search {
        let found = search(problem, &geometry, &geometry_pins, &given, plan(Throw::Anywhere), monitor)?;
        place(&mut here, &found.x);
        (searched_starts, search_reason) = (found.starts, Some(SearchReason::Asked));
    } else {
        let mut first =
            Way::new(problem, &geometry, monitor, (options.of_lm(), options.known), &here, geometry_pins.clone());
        descended = Some(if from.is_some() { first.descend()? } else { first.first_descent(gram)? });
        here = first.parameters();
    }
    let whole_pins =
        if geometry.len() == free.len() { geometry_pins.clone() } else { pins(problem, free, &start, monitor)?.0 };
    let mut way = Way::new(problem, free, monitor, (options.of_lm(), options.known), &here, whole_pins);
    let mut report = match descended.filter(|_| geometry.len() == free.len()) {
        Some(report) => report,
        None => way.descend()?,
    };
    way.discount_outliers(&mut report)?;
    way.release(&mut report)?;
    let doubt = match (is_poor(way.problem, &way.parameters(), report.cost), way.problem.loss()) {
        (true, _) => Some(SearchReason::PoorMinimum),
        (false, None) if unexplained(way.problem, report.cost, free.len()) => Some(SearchReason::Unexplained),
        (false, None) if off_scale(way.problem, &way.parameters()) => Some(SearchReason::OffScale),
        _ => None,
    };
    if let Some(reason) = doubt.filter(|_| search_reason.is_none() && can_search) {
        let found = search(way.problem, &geometry, &geometry_pins, &given, plan(Throw::Widening), monitor)?;
        (searched_starts, search_reason) = (found.starts, Some(reason));
        let here = way.parameters();
        let x: Vec<f64> = geometry.iter().map(|&j| here[j]).collect();
        let go_on = reason == SearchReason::PoorMinimum
            || does_better(way.problem, &geometry, &geometry_pins, &found, &x, monitor)?;
        if go_on {
            let mut there = start.clone();
            place(&mut there, &found.x);
            way.try_from(&there, &mut report, |problem, parameters, cost| !is_poor(problem, parameters, cost))?;
        }
    }
    way.settle(&mut report)?;
    let ended = report.termination.converged() || search_reason.is_some();
    if ended && is_poor(way.problem, &way.parameters(), report.cost) {
        report.termination = if free.is_empty() { Termination::HeldPoor } else { Termination::PoorMinimum };
    }
    report.cost_start = cost_start;
    let (mut parameters, pins, factors) = (way.parameters(), way.pins, way.factors);
    if !undecided_signs.is_empty() {
        // the search had outliers in, and did without what is small
        let signs: Vec<f64> = problem.arm().signs().collect();
        let twin = signs::nearest(problem, free, &signs, &parameters, options.unknown_signs, true);
        if twin.signs != signs {
            problem.set_arm(problem.arm().with_signs(&twin.signs));
            parameters = twin.parameters;
            problem.weigh(&parameters, Weighing::Full);
            problem.discount(factors.as_deref());
        }
        undecided_signs = twin.undecided;
    }
    Ok(Solution { parameters, report, searched_starts, search_reason, pins, factors, undecided_signs })
}

/// Forgets what an earlier fit left: its loss's weights, and the scatter by which priors are weighed.
pub(crate) fn prepare(problem: &mut Problem) {
    problem.discount(None);
    problem.set_unit(if problem.noise().is_some() { 1.0 } else { ASSUMED_SCATTER_MM });
}
