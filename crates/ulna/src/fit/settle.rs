//! What depends on where a fit ends, taken there, and the fit continued, until nothing changes: weights by direction, what
//! a loss makes of outliers, the scatter by which priors are weighed.

use crate::artefacts::Weighing;
use crate::error::Result;
use crate::fit::judged::judge;
use crate::fit::robust::Standing;
use crate::fit::scatter::{Scatter, believed, least_scatter};
use crate::monitor::Monitor;
use crate::problem::Problem;
use crate::problem::pins::Pin;
use crate::solver::lm::Report;
use crate::solver::losses::Loss;

/// Weights by direction change little: they are taken anew at most so often.
const REWEIGHINGS: usize = 4;
/// Rounds of a loss or of priors, which go on until the parameters stand still: thirty as a rule, hundreds where a loss
/// hesitates over a few readings.
const ROUNDS: usize = 500;
/// Rounds in which outliers pull as with Huber's loss, whose minimum is the only one, before a loss lets go of them. From
/// then on the scatter stays as it was found (an MM-estimate, Yohai 1987), and the rounds end.
const GENTLE_ROUNDS: usize = 12;
/// What a reading counts that counts for nothing: a placement of nothing but such readings must still stand somewhere.
const NOTHING: f64 = 1e-12;
/// Parameters stand still that move no tip by more than this part of the reach: a nanometre for each metre.
const STILL: f64 = 1e-9;
/// What is known beforehand is weighed anew where the scatter has changed by more than this part.
const ANEW: f64 = 1e-3;

/// Rounds of weighing and fitting.
pub(crate) struct Settling<'a> {
    how: Weighing,
    loss: Option<Loss>,
    free: &'a [usize],
    pins: &'a [Pin],
    /// parameters are known beforehand, and weighed with the scatter that the readings show
    priors: bool,
    degrees_of_freedom: f64,
    /// the scatter with which these were counted
    counted_at: f64,
    natural_scale: Vec<f64>,
    still: f64,
    round: usize,
    standing: Option<Standing>,
    /// the root of what each reading counts
    pub factors: Option<Vec<Vec<f64>>>,
}

impl<'a> Settling<'a> {
    /// None where nothing depends on where the fit ends.
    pub fn new(problem: &Problem, free: &'a [usize], pins: &'a [Pin], how: Weighing) -> Option<Settling<'a>> {
        let loss = problem.loss();
        let known = problem.priors();
        let priors = known.iter().any(|prior| free.contains(&prior.parameter));
        let reweighs = how == Weighing::Full && problem.weighs_encoders();
        if free.is_empty() || !(reweighs || loss.is_some() || priors) {
            return None;
        }
        let natural = problem.natural_scale();
        let gone = problem.base_parameters();
        let base = free.iter().filter(|j| gone.contains(j) && known.iter().all(|prior| prior.parameter != **j)).count();
        let unknowns = problem.placement_unknowns() + free.len().saturating_sub(pins.len() + base);
        Some(Settling {
            how,
            loss,
            free,
            pins,
            priors,
            degrees_of_freedom: problem.equations().saturating_sub(unknowns).max(1) as f64,
            counted_at: f64::NAN,
            natural_scale: free.iter().map(|&j| natural[j]).collect(),
            still: STILL * problem.reach_mm(),
            round: 0,
            standing: None,
            factors: None,
        })
    }

    /// Weighs the readings at these parameters, and what is known beforehand by how far they scatter.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn weigh(&mut self, problem: &mut Problem, parameters: &[f64], monitor: &dyn Monitor) -> Result<()> {
        problem.weigh(parameters, self.how);
        let scatter = if self.priors { self.count(problem, parameters, monitor)? } else { None };
        if let Some(loss) = self.loss {
            // placements stand where the readings that count put them
            problem.discount(self.factors.as_deref());
            let whitened = problem.whitened(parameters);
            let fitted = self.degrees_of_freedom;
            let standing = match &self.standing {
                Some(standing) if self.round >= GENTLE_ROUNDS => standing.again(&whitened, fitted),
                _ => Standing::of(&whitened, fitted, least_scatter(problem)),
            };
            let loss = if self.round < GENTLE_ROUNDS { Loss::Huber } else { loss };
            let mut factors = standing.weights(loss);
            factors.iter_mut().flatten().for_each(|weight| *weight = weight.max(NOTHING).sqrt());
            problem.discount(Some(&factors));
            if self.priors && problem.noise().is_none() {
                problem.set_unit(standing.pooled_scale(&whitened));
            }
            (self.standing, self.factors) = (Some(standing), Some(factors));
        } else if let Some(per_dof) = scatter.and_then(Scatter::per_dof) {
            let variance = believed(per_dof, self.degrees_of_freedom, problem.noise().is_some());
            problem.set_unit(variance.sqrt().max(least_scatter(problem)));
        }
        Ok(())
    }

    /// How far all readings scatter, each counting as stated, and how many degrees of freedom they have beside what is known
    /// beforehand; with a loss only where that may have changed.
    fn count(&mut self, problem: &Problem, parameters: &[f64], monitor: &dyn Monitor) -> Result<Option<Scatter>> {
        let unit = problem.unit();
        if self.loss.is_some() && (unit / self.counted_at - 1.0).abs() <= ANEW {
            return Ok(None);
        }
        let judged = judge(problem, self.free, self.pins, parameters, monitor)?;
        let scatter = Scatter::of(problem, self.free, &judged, parameters, unit);
        (self.degrees_of_freedom, self.counted_at) = (scatter.degrees_of_freedom.max(1.0), unit);
        Ok(Some(scatter))
    }

    /// After a descent from `before` to `x`: whether it settled, if there is nothing more to do.
    pub fn ended(&mut self, descent: &Report, before: &[f64], x: &[f64]) -> Option<bool> {
        self.round += 1;
        if self.loss.is_none() && !self.priors {
            let settled = descent.iterations == 0 || descent.cost_start - descent.cost < 1e-6 * descent.cost;
            return (settled || self.round >= REWEIGHINGS).then_some(true);
        }
        let moved = before.iter().zip(x).zip(&self.natural_scale).map(|((b, x), scale)| (x - b).abs() * scale);
        let still = moved.fold(0.0, f64::max) <= self.still;
        if still && (self.loss.is_none() || self.round > GENTLE_ROUNDS) {
            return Some(true);
        }
        (self.round >= ROUNDS).then_some(false)
    }
}
