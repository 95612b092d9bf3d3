//! The way to the minimum: weigh, pin what cannot be seen, descend, notice a poor end and search on, weigh again.

use crate::artefacts::Weighing;
use crate::error::{Error, Result};
use crate::fit::search::{Plan, Throw, collapsed, is_zero_offset, poor, search};
use crate::fit::settle::Settling;
use crate::fit::signs;
use crate::identify::families::pins;
use crate::identify::identifiability::Known;
use crate::monitor::{Monitor, Unwatched};
use crate::problem::Problem;
use crate::problem::assembly::Assembly;
use crate::problem::pins::{Kind, Pin};
use crate::solver::LeastSquares;
use crate::solver::decomposition::Decomposition;
use crate::solver::gram::{Cost, Gram};
use crate::solver::lm::{self, Report, Termination, minimize, minimize_from};
use crate::solver::triangle::Triangle;

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
    pub undecided_signs: Vec<Vec<usize>>,
}

/// Above this many readings a fit starts from where a fit to some of them ends.
const MANY: usize = 20_000;
const PART: usize = 2_000;
/// A family of parameters that was pinned because the start could not tell its members apart is let go where that
/// lowers the cost by more than this many variances for each direction: noise does so in one case of fifty (F test). It
/// is let go as well where the readings tell its members apart better than a drawing does.
const SIGNIFICANT: f64 = 4.0;
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
    // what an arm does beyond its geometry is small: it is sought from where the geometry is found
    let geometry: Vec<usize> = free.iter().copied().filter(|&j| j < problem.arm().geometry_count()).collect();
    let (mut geometry_pins, gram) = pins(problem, &geometry, &start, monitor)?;
    let cost_start = gram.cost();
    let plan = |throw| Plan { throw, most_starts: options.search_starts, seed: options.seed };
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
        let mut first = Way::new(problem, &geometry, monitor, *options, &here, geometry_pins.clone());
        descended = Some(if from.is_some() { first.descend()? } else { first.first_descent(gram)? });
        here = first.parameters();
    }
    let whole_pins =
        if geometry.len() == free.len() { geometry_pins.clone() } else { pins(problem, free, &start, monitor)?.0 };
    let mut way = Way::new(problem, free, monitor, *options, &here, whole_pins);
    let mut report = match descended.filter(|_| geometry.len() == free.len()) {
        Some(report) => report,
        None => way.descend()?,
    };
    way.discount_outliers(&mut report)?;
    way.release(&mut report)?;
    if search_reason.is_none() && can_search && poor(way.problem, &way.parameters(), report.cost) {
        let found = search(way.problem, &geometry, &geometry_pins, &given, plan(Throw::Widening), monitor)?;
        (searched_starts, search_reason) = (found.starts, Some(SearchReason::PoorMinimum));
        let mut there = start.clone();
        place(&mut there, &found.x);
        let first = std::mem::replace(&mut way.x, free.iter().map(|&j| there[j]).collect());
        let mut second = way.descend()?;
        way.discount_outliers(&mut second)?;
        if second.cost < report.cost {
            report = second;
        } else {
            way.x = first;
        }
    }
    way.settle(&mut report)?;
    let sizeless = way.pins.iter().any(|p| p.kind == Kind::Growth);
    let collapsed = sizeless && collapsed(way.problem, &way.parameters());
    let ended = report.termination.converged() || search_reason.is_some();
    if collapsed || ended && !free.is_empty() && poor(way.problem, &way.parameters(), report.cost) {
        report.termination = Termination::PoorMinimum;
    }
    report.cost_start = cost_start;
    let (parameters, pins, factors) = (way.parameters(), way.pins, way.factors);
    Ok(Solution { parameters, report, searched_starts, search_reason, pins, factors, undecided_signs })
}

/// Forgets what an earlier fit left: its loss's weights, and the scatter by which priors are weighed.
pub(crate) fn prepare(problem: &mut Problem) {
    problem.discount(None);
    problem.set_unit(if problem.noise().is_some() { 1.0 } else { ASSUMED_SCATTER_MM });
}

/// A fit on its way.
struct Way<'a> {
    problem: &'a mut Problem,
    free: &'a [usize],
    monitor: &'a dyn Monitor,
    options: Options,
    /// all parameters, those that are not free as they stay
    start: Vec<f64>,
    pins: Vec<Pin>,
    /// where it is: the free parameters
    x: Vec<f64>,
    /// what a loss made of each reading last
    factors: Option<Vec<Vec<f64>>>,
}

impl<'a> Way<'a> {
    fn new(
        problem: &'a mut Problem,
        free: &'a [usize],
        monitor: &'a dyn Monitor,
        options: Options,
        here: &[f64],
        pins: Vec<Pin>,
    ) -> Way<'a> {
        let x = free.iter().map(|&j| here[j]).collect();
        Way { problem, free, monitor, options, start: here.to_vec(), pins, x, factors: None }
    }

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
        minimize(&mut assembly, &mut self.x, &self.options.of_lm(), self.monitor)
    }

    /// Descends from the start, where the normal equations without pins are known already.
    fn first_descent(&mut self, gram: Gram) -> Result<Report> {
        if self.problem.readings() > MANY {
            self.start_from_a_part(gram.cost())?;
        } else if self.pins.is_empty() {
            let mut assembly = Assembly::new(self.problem, self.free, &self.pins, self.monitor);
            return minimize_from(&mut assembly, &mut self.x, gram, &self.options.of_lm(), self.monitor);
        }
        self.descend()
    }

    /// Goes where a fit to a part of many readings ends, if that is better than the start: the whole is then passed over
    /// two or three times instead of seven.
    fn start_from_a_part(&mut self, cost_given: f64) -> Result<()> {
        let mut x = self.x.clone();
        let part = self.problem.thinned(PART);
        let mut assembly = Assembly::new(&part, self.free, &self.pins, self.monitor);
        minimize(&mut assembly, &mut x, &self.options.of_lm(), &Unwatched)?;
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
        let known = self.problem.equations() + self.problem.priors().len();
        let dof = known.saturating_sub(unknowns).max(1);
        let variance = if self.problem.noise().is_some() { 1.0 } else { released.cost / dof as f64 };
        let better = report.cost - released.cost > SIGNIFICANT * families as f64 * variance;
        if better || self.tells_apart(families, variance.sqrt())? {
            *report = added(*report, released);
        } else {
            (self.pins, self.x) = pinned;
        }
        Ok(())
    }

    /// Whether the readings determine, from where the fit is, the `families` directions that they see least, and better
    /// than an arm is known before. sigma: of a whitened residual.
    fn tells_apart(&mut self, families: usize, sigma: f64) -> Result<bool> {
        let parameters = self.parameters();
        let symmetries: Vec<Vec<f64>> =
            self.pins.iter().map(|pin| pin.direction_at(self.problem, self.free, &parameters)).collect();
        let mut assembly = Assembly::new(self.problem, self.free, &[], self.monitor);
        let mut triangle = Triangle::new(self.free.len());
        assembly.rows(&self.x, true, &mut triangle)?;
        let slices: Vec<&[f64]> = symmetries.iter().map(Vec::as_slice).collect();
        let seen = Decomposition::new(&triangle, self.free.len(), assembly.natural_scale(), &slices);
        let known = self.problem.known(self.options.known.length_mm, self.options.known.angle_rad);
        let known = |unknown: usize| known[self.free[unknown]];
        let least = seen.rank.saturating_sub(families)..seen.rank;
        let all_seen = seen.rank + symmetries.len() == seen.kept.len();
        let well = |i: usize| seen.u_along(i, sigma).iter().enumerate().all(|(unknown, u)| u.abs() <= known(unknown));
        Ok(all_seen && least.into_iter().all(well))
    }

    /// Where a loss is asked for: lets it weigh the readings, outliers less, until that changes nothing, all directions
    /// still alike.
    fn discount_outliers(&mut self, report: &mut Report) -> Result<()> {
        if self.problem.loss().is_some() { self.settle_by(report, Weighing::Even) } else { Ok(()) }
    }

    /// Takes the weights at the solution, now by direction, and goes on, until that changes nothing.
    fn settle(&mut self, report: &mut Report) -> Result<()> {
        self.settle_by(report, Weighing::Full)
    }

    fn settle_by(&mut self, report: &mut Report, how: Weighing) -> Result<()> {
        let Some(mut settling) = Settling::new(self.problem, self.free, self.pins.len(), how) else {
            return Ok(());
        };
        loop {
            settling.weigh(self.problem, &self.parameters(), report.cost);
            let before = self.x.clone();
            let again = self.descend()?;
            *report = added(*report, again);
            if let Some(settled) = settling.ended(&again, &before, &self.x) {
                self.factors = settling.factors;
                if !settled {
                    report.termination = Termination::MaxIterations;
                }
                return Ok(());
            }
        }
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
