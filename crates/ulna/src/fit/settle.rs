//! What depends on where a fit ends, taken there, and the fit continued, until nothing changes: weights by direction, what
//! a loss makes of outliers, the scatter by which priors are weighed.

use crate::artefacts::Weighing;
use crate::fit::robust::Standing;
use crate::problem::Problem;
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
/// Scatter of less than this part of the stated noise, or of the arm's reach, is none.
const LEAST_OF_NOISE: f64 = 1e-2;
const LEAST_OF_REACH: f64 = 1e-12;

/// The scatter below which residuals are rounding.
pub(crate) fn least_scatter(problem: &Problem) -> f64 {
    if problem.noise().is_some() { LEAST_OF_NOISE } else { LEAST_OF_REACH * problem.reach_mm() }
}

/// Rounds of weighing and fitting.
pub(crate) struct Settling {
    how: Weighing,
    loss: Option<Loss>,
    /// priors are weighed with the readings' scatter, which no noise states
    scatter_unknown: bool,
    degrees_of_freedom: f64,
    natural_scale: Vec<f64>,
    still: f64,
    round: usize,
    standing: Option<Standing>,
    /// the root of what each reading counts
    pub factors: Option<Vec<Vec<f64>>>,
}

impl Settling {
    /// None where nothing depends on where the fit ends.
    pub fn new(problem: &Problem, free: &[usize], pins: usize, how: Weighing) -> Option<Settling> {
        let loss = problem.loss();
        let priors = problem.priors();
        let counted = priors.iter().filter(|prior| free.contains(&prior.parameter)).count();
        let scatter_unknown = problem.noise().is_none() && counted > 0;
        let reweighs = how == Weighing::Full && problem.weighs_encoders();
        if free.is_empty() || !(reweighs || loss.is_some() || scatter_unknown) {
            return None;
        }
        let natural = problem.natural_scale();
        let gone = problem.base_parameters();
        let base =
            free.iter().filter(|j| gone.contains(j) && priors.iter().all(|prior| prior.parameter != **j)).count();
        let unknowns = problem.placement_unknowns() + free.len().saturating_sub(pins + base);
        Some(Settling {
            how,
            loss,
            scatter_unknown,
            degrees_of_freedom: (problem.equations() + counted).saturating_sub(unknowns).max(1) as f64,
            natural_scale: free.iter().map(|&j| natural[j]).collect(),
            still: STILL * problem.reach_mm(),
            round: 0,
            standing: None,
            factors: None,
        })
    }

    /// Weighs the readings at these parameters, where the cost is `cost`.
    pub fn weigh(&mut self, problem: &mut Problem, parameters: &[f64], cost: f64) {
        problem.weigh(parameters, self.how);
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
            if self.scatter_unknown {
                problem.set_unit(standing.pooled_scale(&whitened));
            }
            (self.standing, self.factors) = (Some(standing), Some(factors));
        } else if self.scatter_unknown {
            problem.set_unit((cost / self.degrees_of_freedom).sqrt().max(least_scatter(problem)));
        }
    }

    /// After a descent from `before` to `x`: whether it settled, if there is nothing more to do.
    pub fn ended(&mut self, descent: &Report, before: &[f64], x: &[f64]) -> Option<bool> {
        self.round += 1;
        if self.loss.is_none() && !self.scatter_unknown {
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
