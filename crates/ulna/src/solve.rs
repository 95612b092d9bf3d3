//! The way to the minimum: weigh, pin what cannot be seen, descend, notice a poor end and search on, weigh again.

use crate::assembly::Assembly;
use crate::error::{Error, Result};
use crate::families::pins;
use crate::identifiability::Known;
use crate::monitor::{Monitor, Unwatched};
use crate::pins::{Kind, Pin};
use crate::problem::Problem;
use crate::residuals::Weighing;
use crate::search::{Plan, Throw, collapsed, is_zero_offset, poor, search};
use crate::solver::LeastSquares;
use crate::solver::gram::{Cost, Gram};
use crate::solver::lm::{self, Report, Termination, minimize, minimize_from};

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
        Options { start: Start::Given, max_iterations: 200, seed: 0, search_starts: 2000, known: Known::default() }
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
    /// Directions held at their start because the readings do not determine them.
    pub pins: Vec<Pin>,
}

/// Above this many readings a fit starts from where a fit to some of them ends.
const MANY: usize = 20_000;
const PART: usize = 2_000;
/// Weights depend on the arm; they are taken anew until the cost settles, at most so often.
const REWEIGHINGS: usize = 4;
/// A family of parameters that was pinned because the start could not tell its members apart is let go where that
/// lowers the cost by more than this many variances for each direction: noise does so in one case of fifty (F test).
const SIGNIFICANT: f64 = 4.0;

/// Finds the free parameters that explain the readings best.
///
/// # Errors
/// No readings, or interrupted.
pub fn solve(problem: &mut Problem, free: &[usize], options: &Options, monitor: &dyn Monitor) -> Result<Solution> {
    if problem.readings() == 0 {
        return Err(Error::NoReadings);
    }
    let start = problem.arm().parameters();
    problem.weigh(&start, Weighing::Even);
    let (pins, gram) = pins(problem, free, &start, monitor)?;
    let cost_start = gram.cost();
    let x = free.iter().map(|&j| start[j]).collect();
    let options_lm = lm::Options { max_iterations: options.max_iterations, ..lm::Options::default() };
    let mut way = Way { problem, free, monitor, options: options_lm, start, pins, x };
    let plan = |throw| Plan { throw, most_starts: options.search_starts, seed: options.seed };
    let given = way.x.clone();
    let (mut searched_starts, mut search_reason) = (0, None);

    let can_search = options.search_starts > 0 && free.iter().any(|&j| is_zero_offset(way.problem, j));

    let mut report = if options.start == Start::Search && can_search {
        let found = search(way.problem, free, &way.pins, &given, plan(Throw::Anywhere), monitor)?;
        (way.x, searched_starts, search_reason) = (found.x, found.starts, Some(SearchReason::Asked));
        way.descend()?
    } else {
        way.first_descent(gram)?
    };
    way.release(&mut report)?;
    if search_reason.is_none() && can_search && poor(way.problem, &way.parameters(), report.cost) {
        let found = search(way.problem, free, &way.pins, &given, plan(Throw::Widening), monitor)?;
        (searched_starts, search_reason) = (found.starts, Some(SearchReason::PoorMinimum));
        let first = std::mem::replace(&mut way.x, found.x);
        let second = way.descend()?;
        if second.cost < report.cost {
            report = second;
        } else {
            way.x = first;
        }
    }
    way.reweigh(&mut report)?;
    let sizeless = way.pins.iter().any(|p| p.kind == Kind::Growth);
    let collapsed = sizeless && collapsed(way.problem, &way.parameters());
    let ended = report.termination.converged() || search_reason.is_some();
    if collapsed || ended && !free.is_empty() && poor(way.problem, &way.parameters(), report.cost) {
        report.termination = Termination::PoorMinimum;
    }
    report.cost_start = cost_start;
    Ok(Solution { parameters: way.parameters(), report, searched_starts, search_reason, pins: way.pins })
}

/// A fit on its way.
struct Way<'a> {
    problem: &'a mut Problem,
    free: &'a [usize],
    monitor: &'a dyn Monitor,
    options: lm::Options,
    /// all parameters at the start
    start: Vec<f64>,
    pins: Vec<Pin>,
    /// where it is: the free parameters
    x: Vec<f64>,
}

impl Way<'_> {
    fn parameters(&self) -> Vec<f64> {
        let mut parameters = self.start.clone();
        for (&j, &value) in self.free.iter().zip(&self.x) {
            parameters[j] = value;
        }
        parameters
    }

    /// Descends from where it is.
    fn descend(&mut self) -> Result<Report> {
        let mut assembly = Assembly::new(self.problem, self.free, &self.pins, self.monitor);
        minimize(&mut assembly, &mut self.x, &self.options, self.monitor)
    }

    /// Descends from the start, where the normal equations without pins are known already.
    fn first_descent(&mut self, gram: Gram) -> Result<Report> {
        if self.problem.readings() > MANY {
            self.start_from_a_part(gram.cost())?;
        } else if self.pins.is_empty() {
            let mut assembly = Assembly::new(self.problem, self.free, &self.pins, self.monitor);
            return minimize_from(&mut assembly, &mut self.x, gram, &self.options, self.monitor);
        }
        self.descend()
    }

    /// Goes where a fit to a part of many readings ends, if that is better than the start: the whole is then passed over
    /// two or three times instead of seven.
    fn start_from_a_part(&mut self, cost_given: f64) -> Result<()> {
        let mut x = self.x.clone();
        let part = self.problem.thinned(PART);
        let mut assembly = Assembly::new(&part, self.free, &self.pins, self.monitor);
        minimize(&mut assembly, &mut x, &self.options, &Unwatched)?;
        let mut cost = Cost::default();
        Assembly::new(self.problem, self.free, &self.pins, self.monitor).rows(&x, false, &mut cost)?;
        if cost.0 < cost_given {
            self.x = x;
        }
        Ok(())
    }

    /// Lets go of what was pinned only because the start could not tell, where the readings can: a probe taken for
    /// straight may turn out not to be.
    fn release(&mut self, report: &mut Report) -> Result<()> {
        let kept: Vec<Pin> = self.pins.iter().filter(|p| p.kind != Kind::Family).cloned().collect();
        let families = self.pins.len() - kept.len();
        if families == 0 || report.termination == Termination::Exact {
            return Ok(());
        }
        let pinned = (std::mem::replace(&mut self.pins, kept), self.x.clone());
        let released = self.descend()?;
        let unknowns = self.problem.placement_unknowns() + self.free.len();
        let dof = self.problem.equations().saturating_sub(unknowns).max(1);
        let variance = if self.problem.noise().is_some() { 1.0 } else { released.cost / dof as f64 };
        if report.cost - released.cost > SIGNIFICANT * families as f64 * variance {
            *report = added(*report, released);
        } else {
            (self.pins, self.x) = pinned;
        }
        Ok(())
    }

    /// Takes the weights at the solution, now by direction, and goes on, until that changes nothing.
    fn reweigh(&mut self, report: &mut Report) -> Result<()> {
        if !self.problem.weighs_encoders() || self.free.is_empty() {
            return Ok(());
        }
        for _ in 0..REWEIGHINGS {
            self.problem.weigh(&self.parameters(), Weighing::Full);
            let again = self.descend()?;
            *report = added(*report, again);
            if again.iterations == 0 || again.cost_start - again.cost < 1e-6 * again.cost {
                break;
            }
        }
        Ok(())
    }
}

/// What two descents did, one after the other.
fn added(first: Report, second: Report) -> Report {
    Report {
        iterations: first.iterations + second.iterations,
        evaluations: first.evaluations + second.evaluations,
        cost_start: first.cost_start,
        ..second
    }
}
