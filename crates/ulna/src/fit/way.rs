//! A fit on its way: it descends, lets go of what was pinned, tries other starts, settles its weights.

use crate::arm::Unit;
use crate::artefacts::Weighing;
use crate::error::Result;
use crate::fit::settle::Settling;
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

/// Above this many readings a fit starts from where a fit to some of them ends.
const MANY: usize = 20_000;
const PART: usize = 2_000;
/// A family of parameters that was pinned because the start could not tell its members apart is let go where that
/// lowers the cost by more than this many variances for each direction: noise does so in one case of fifty (F test). It
/// is let go as well where the readings tell its members apart better than a drawing does.
const SIGNIFICANT: f64 = 4.0;
/// A family is far behind where the readings see its directions to this part of a radian, or of the reach: there its
/// members are told apart by straight lines, as uncertainties are.
const FAR: f64 = 0.1;
/// An arm has left its drawing where it is off by so many times what a drawing is known by.
pub(super) const OFF_DRAWING: f64 = 10.0;
/// Rounds of weighing may take so many times the steps of one descent, all together: one bad placement can keep each of
/// them from an end.
const SETTLING: usize = 5;

/// A fit on its way.
pub(crate) struct Way<'a> {
    pub problem: &'a mut Problem,
    free: &'a [usize],
    monitor: &'a dyn Monitor,
    how: lm::Options,
    /// what is known of an arm before
    known: Known,
    /// all parameters, those that are not free as they stay
    start: Vec<f64>,
    pub pins: Vec<Pin>,
    /// what the start could not tell
    pins_at_start: Vec<Pin>,
    /// where it is: the free parameters
    pub x: Vec<f64>,
    /// what a loss made of each reading last
    pub factors: Option<Vec<Vec<f64>>>,
}

impl<'a> Way<'a> {
    pub fn new(
        problem: &'a mut Problem,
        free: &'a [usize],
        monitor: &'a dyn Monitor,
        (how, known): (lm::Options, Known),
        here: &[f64],
        pins: Vec<Pin>,
    ) -> Way<'a> {
        let x = free.iter().map(|&j| here[j]).collect();
        Way {
            problem,
            free,
            monitor,
            how,
            known,
            start: here.to_vec(),
            pins_at_start: pins.clone(),
            pins,
            x,
            factors: None,
        }
    }

    pub fn parameters(&self) -> Vec<f64> {
        let mut parameters = self.start.clone();
        for (&j, &value) in self.free.iter().zip(&self.x) {
            parameters[j] = value;
        }
        parameters
    }

    /// Descends from where it is.
    pub fn descend(&mut self) -> Result<Report> {
        let mut assembly = Assembly::new(self.problem, self.free, &self.pins, self.monitor);
        minimize(&mut assembly, &mut self.x, &self.how, self.monitor)
    }

    /// Goes where a fit from other parameters ends, if that leaves less, or if that is good and where it is is not.
    pub fn try_from(
        &mut self,
        there: &[f64],
        report: &mut Report,
        good: impl Fn(&Problem, &[f64], f64) -> bool,
    ) -> Result<()> {
        let first_good = good(self.problem, &self.parameters(), report.cost);
        let first = (self.x.clone(), self.pins.clone());
        self.x = self.free.iter().map(|&j| there[j]).collect();
        self.pins = self.pins_at_start.clone();
        let mut second = self.descend()?;
        self.discount_outliers(&mut second)?;
        self.release(&mut second)?;
        let second_good = good(self.problem, &self.parameters(), second.cost);
        let better = if second_good == first_good { second.cost < report.cost } else { second_good };
        if better {
            *report = second;
        } else {
            (self.x, self.pins) = first;
        }
        Ok(())
    }

    /// Descends from the start, where the normal equations without pins are known already.
    pub fn first_descent(&mut self, gram: Gram) -> Result<Report> {
        if self.problem.readings() > MANY {
            self.start_from_a_part(gram.cost())?;
        } else if self.pins.is_empty() {
            let mut assembly = Assembly::new(self.problem, self.free, &self.pins, self.monitor);
            return minimize_from(&mut assembly, &mut self.x, gram, &self.how, self.monitor);
        }
        self.descend()
    }

    /// Goes where a fit to a part of many readings ends, if that is better than the start: the whole is then passed over
    /// two or three times instead of seven.
    fn start_from_a_part(&mut self, cost_given: f64) -> Result<()> {
        let mut x = self.x.clone();
        let part = self.problem.thinned(PART);
        let mut assembly = Assembly::new(&part, self.free, &self.pins, self.monitor);
        minimize(&mut assembly, &mut x, &self.how, &Unwatched)?;
        let mut cost = Cost::default();
        Assembly::new(self.problem, self.free, &self.pins, self.monitor).rows(&x, false, &mut cost)?;
        if cost.0 < cost_given {
            self.x = x;
        }
        Ok(())
    }

    /// Lets go of what was pinned only because the start could not tell, where the readings can: a probe taken for
    /// straight may turn out not to be. What they cannot tell there either stays pinned.
    pub fn release(&mut self, report: &mut Report) -> Result<()> {
        let lasting: Vec<Pin> = self.pins.iter().filter(|p| p.kind != Kind::Family).cloned().collect();
        let families = self.pins.len() - lasting.len();
        if families == 0 || report.termination == Termination::Exact {
            return Ok(());
        }
        let pinned = (std::mem::replace(&mut self.pins, lasting), self.x.clone());
        let mut released = self.descend()?;
        let (still, _) = pins(self.problem, self.free, &self.parameters(), self.monitor)?;
        if still.len() > self.pins.len() {
            self.pins = still;
            released = added(released, self.descend()?);
        }
        let let_go = pinned.0.len().saturating_sub(self.pins.len());
        if let_go > 0 && self.left_behind(let_go, report.cost, released.cost)? {
            *report = added(*report, released);
        } else {
            (self.pins, self.x) = pinned;
        }
        Ok(())
    }

    /// Whether the fit has left so many families behind: the cost fell, or the directions that the readings see least are
    /// seen well enough where it is.
    fn left_behind(&mut self, let_go: usize, cost_pinned: f64, cost: f64) -> Result<bool> {
        let unknowns = self.problem.placement_unknowns() + self.free.len();
        let known = self.problem.equations() + self.problem.priors().len();
        let dof = known.saturating_sub(unknowns).max(1);
        let per_dof = cost / dof as f64;
        let variance = if self.problem.noise().is_some() { 1.0 } else { per_dof };
        Ok(cost_pinned - cost > SIGNIFICANT * let_go as f64 * variance
            || self.tells_apart(let_go, per_dof.max(variance).sqrt())?)
    }

    /// Whether the readings determine, from where the fit is, the `let_go` directions that they see least: better than an
    /// arm is known before, or so well that it is far from where they are a family: a tip r off the last axis, known to σ,
    /// is seen to turn about it with u = σ / r. sigma: of a whitened residual.
    fn tells_apart(&mut self, let_go: usize, sigma: f64) -> Result<bool> {
        let parameters = self.parameters();
        let symmetries: Vec<Vec<f64>> =
            self.pins.iter().map(|pin| pin.direction_at(self.problem, self.free, &parameters)).collect();
        let mut assembly = Assembly::new(self.problem, self.free, &[], self.monitor);
        let mut triangle = Triangle::new(self.free.len());
        assembly.rows(&self.x, true, &mut triangle)?;
        let slices: Vec<&[f64]> = symmetries.iter().map(Vec::as_slice).collect();
        let seen = Decomposition::new(&triangle, self.free.len(), assembly.natural_scale(), &slices);
        let known = self.problem.known(self.known.length_mm, self.known.angle_rad);
        let units = self.problem.parameter_units();
        let reach_mm = self.problem.reach_mm();
        let natural = |unknown: usize| match units[self.free[unknown]] {
            Unit::Rad => FAR,
            Unit::Mm => FAR * reach_mm,
            _ => 0.0,
        };
        let well = |unknown: usize| natural(unknown).max(known[self.free[unknown]]);
        let least = seen.rank.saturating_sub(let_go)..seen.rank;
        let all_seen = seen.rank + symmetries.len() == seen.kept.len();
        let clear = |i: usize| seen.u_along(i, sigma).iter().enumerate().all(|(unknown, u)| u.abs() <= well(unknown));
        Ok(all_seen && least.into_iter().all(clear))
    }

    /// Where a loss is asked for: lets it weigh the readings, outliers less, until that changes nothing, all directions
    /// still alike.
    pub fn discount_outliers(&mut self, report: &mut Report) -> Result<()> {
        if self.problem.loss().is_some() { self.settle_by(report, Weighing::Even) } else { Ok(()) }
    }

    /// Takes the weights at the solution, now by direction, and goes on, until that changes nothing.
    pub fn settle(&mut self, report: &mut Report) -> Result<()> {
        self.settle_by(report, Weighing::Full)
    }

    fn settle_by(&mut self, report: &mut Report, how: Weighing) -> Result<()> {
        let pins = self.pins.clone();
        let Some(mut settling) = Settling::new(self.problem, self.free, &pins, how) else {
            return Ok(());
        };
        let most_steps = report.iterations + SETTLING * self.how.max_iterations;
        loop {
            settling.weigh(self.problem, &self.parameters(), self.monitor)?;
            let before = self.x.clone();
            let again = self.descend()?;
            *report = added(*report, again);
            let lost = (report.iterations >= most_steps).then_some(false);
            if let Some(settled) = settling.ended(&again, &before, &self.x).or(lost) {
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
