//! Starts tried one after the other until the minimum that explains the readings is found.
//!
//! A well-scaled Levenberg-Marquardt reaches it from about every third start with no knowledge of the zero offsets at
//! all (MODEL section 5), so some tens of starts are enough. They run on a thin selection of the readings.

use crate::arm::{JointModel, Unit};
use crate::artefacts::Weighing;
use crate::error::{Error, Result};
use crate::fit::symmetry::{Freedom, mirror_image};
use crate::kinematics::encoder_jacobian;
use crate::monitor::{Monitor, Stage};
use crate::problem::Problem;
use crate::problem::assembly::Assembly;
use crate::problem::pins::{Kind, Pin};
use crate::solver::LeastSquares;
use crate::solver::lm::{Options, minimize};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::PI;

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Searched {
    /// Best free parameters.
    pub x: Vec<f64>,
    /// Their cost on the thinned readings.
    pub cost: f64,
    /// How many starts were tried.
    pub starts: usize,
    /// Signs of the encoders there.
    pub signs: Vec<f64>,
}

/// How far zero offsets are thrown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Throw {
    /// Anywhere: nothing is known of them.
    Anywhere,
    /// Nearby first, then farther: the given start ended in a poor minimum.
    Widening,
}

impl Throw {
    /// How far at an attempt, rad.
    pub fn width(self, attempt: usize) -> f64 {
        match self {
            Throw::Anywhere => PI,
            Throw::Widening => [0.3, 0.6, 1.0, 1.5, 2.2, PI][attempt.min(59) / 10],
        }
    }
}

/// How to search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    pub throw: Throw,
    pub most_starts: usize,
    pub seed: u64,
    /// What the user calls poor: [`poor`].
    pub poor_above_mm: Option<f64>,
}

/// Readings used for a start, and iterations after which a start is given up.
const READINGS: usize = 200;
const ITERATIONS: usize = 60;
/// Starts that must agree on the best cost before it is believed, where the cost is not low enough by itself; and where
/// it is so high that a calibrated arm would not leave it.
const AGREEING: usize = 4;
const AGREEING_POOR: usize = 40;
/// Costs that differ by less than this part belong to the same minimum: starts are given up before the last digits.
const SAME_MINIMUM: f64 = 1e-4;

/// A start does better that leaves less by this part.
const BETTER: f64 = 0.01;

/// A minimum that leaves so small a part of what the next best of several leaves is the arm: no accident comes so near.
const FAR_BETTER: f64 = 1e-4;
const SEVERAL: usize = 10;

/// The start from which a fit to the readings ends best, as far as some of them tell.
pub(crate) fn search(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    given: &[f64],
    plan: Plan,
    monitor: &dyn Monitor,
) -> Result<Searched> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(plan.seed);
    let mut starts = 0;
    if !may_collapse(problem, pins) {
        let found = search_over(problem.for_search(READINGS), free, pins, given, plan, monitor, |thin, attempt, x| {
            throw(thin, free, plan.throw.width(attempt), x, &mut rng);
        })?;
        if !collapsed(problem, &at(problem, free, &found.x)) {
            return better_image(problem, free, pins, found, monitor);
        }
        starts = found.starts;
    }
    // where an arm that shrinks explains the readings, or nearly, starts end in one: the links keep their lengths while
    // zero offsets are sought
    let units = problem.arm().parameter_units();
    let joints = problem.arm().joint_parameter_count();
    let sought = |k: &usize| units[free[*k]] == Unit::Rad || free[*k] >= joints;
    let part: Vec<usize> = (0..free.len()).filter(sought).collect();
    let part_free: Vec<usize> = part.iter().map(|&k| free[k]).collect();
    let part_given: Vec<f64> = part.iter().map(|&k| given[k]).collect();
    let found =
        search_over(problem.for_search(READINGS), &part_free, &[], &part_given, plan, monitor, |thin, attempt, x| {
            throw(thin, &part_free, plan.throw.width(attempt), x, &mut rng);
        })?;
    let mut x = given.to_vec();
    for (&k, value) in part.iter().zip(found.x) {
        x[k] = value;
    }
    better_image(problem, free, pins, Searched { x, starts: starts + found.starts, ..found }, monitor)
}

/// All parameters, the free ones as they are here.
fn at(problem: &Problem, free: &[usize], x: &[f64]) -> Vec<f64> {
    let mut parameters = problem.parameters();
    free.iter().zip(x).for_each(|(&j, &value)| parameters[j] = value);
    parameters
}

/// Lengths do not tell an arm from its mirror image, but a search goes by them where it can: whichever of the two explains
/// the readings as they are.
pub(crate) fn better_image(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    found: Searched,
    monitor: &dyn Monitor,
) -> Result<Searched> {
    if problem.mirror_free() {
        return Ok(found);
    }
    let whole = as_they_are(problem, &found.signs);
    let is_free = whole.is_free(free);
    let parameters = at(&whole, free, &found.x);
    let Some(image) = mirror_image(whole.arm(), &parameters, Freedom::of(&whole, &is_free, true)) else {
        return Ok(found);
    };
    let (mut as_found, mut mirrored) = (found.x.clone(), free.iter().map(|&j| image[j]).collect::<Vec<_>>());
    let (cost, _) = descend(&whole, free, pins, &mut as_found, monitor)?;
    let (cost_mirrored, _) = descend(&whole, free, pins, &mut mirrored, monitor)?;
    Ok(Searched { x: if cost_mirrored < cost { mirrored } else { as_found }, ..found })
}

/// Whether a fit to some of the readings as they are ends lower from what a search found than from elsewhere.
pub(crate) fn does_better(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    found: &Searched,
    elsewhere: &[f64],
    monitor: &dyn Monitor,
) -> Result<bool> {
    let whole = as_they_are(problem, &found.signs);
    let ends = |x: &[f64]| descend(&whole, free, pins, &mut x.to_vec(), monitor);
    Ok(ends(&found.x)?.0 < (1.0 - BETTER) * ends(elsewhere)?.0)
}

/// Some of the readings, nothing made of them.
fn as_they_are(problem: &Problem, signs: &[f64]) -> Problem {
    let mut some = problem.thinned(READINGS);
    some.set_arm(some.arm().with_signs(signs));
    some.weigh(&some.parameters(), Weighing::Even);
    some
}

/// One start: the cost where it ends, and what of it is rounding.
fn descend(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    x: &mut [f64],
    monitor: &dyn Monitor,
) -> Result<(f64, f64)> {
    let options = Options { max_iterations: ITERATIONS, ..Options::default() };
    let mut assembly = Assembly::new(problem, free, pins, monitor);
    let cost = minimize(&mut assembly, x, &options, &Quiet(monitor))?.cost;
    Ok((cost, assembly.negligible_cost()))
}

/// Whether an arm whose tip does not move, or hardly, explains the readings: it is no arm.
pub(crate) fn may_collapse(problem: &Problem, pins: &[Pin]) -> bool {
    problem.still_free() || pins.iter().any(|p| p.kind == Kind::Growth)
}

/// Zero offsets thrown by up to `width`, rad.
pub(crate) fn throw(thin: &Problem, free: &[usize], width: f64, x: &mut [f64], rng: &mut Xoshiro256PlusPlus) {
    for (value, &j) in x.iter_mut().zip(free) {
        if is_zero_offset(thin, j) {
            *value += rng.random_range(-width..width);
        }
    }
}

/// The search over some parameters of thinned readings. `throw` makes a start of the given one, and may change the arm's
/// signs.
pub(crate) fn search_over(
    mut thin: Problem,
    free: &[usize],
    pins: &[Pin],
    given: &[f64],
    plan: Plan,
    monitor: &dyn Monitor,
    mut throw: impl FnMut(&mut Problem, usize, &mut [f64]),
) -> Result<Searched> {
    let mut x = given.to_vec();
    let (cost, negligible) = descend(&thin, free, pins, &mut x, monitor)?;
    let mut best = Searched { x, cost, starts: 1, signs: thin.arm().signs().collect() };
    let (mut agreeing, mut runner_up) = (1, f64::MAX);
    let dof = thin.equations() as f64 - thin.placement_unknowns() as f64 - free.len() as f64;
    let start = thin.parameters();
    for attempt in 0..plan.most_starts {
        if !monitor.progress(Stage::Search, attempt, plan.most_starts) {
            return Err(Error::Interrupted);
        }
        let mut x = given.to_vec();
        throw(&mut thin, attempt, &mut x);
        let (cost, _) = descend(&thin, free, pins, &mut x, monitor)?;
        best.starts += 1;
        let tie = SAME_MINIMUM * best.cost + negligible;
        if cost <= best.cost + tie {
            agreeing = if cost < best.cost - tie { 1 } else { agreeing + 1 };
        }
        if (cost - best.cost).abs() > tie {
            runner_up = runner_up.min(cost.max(best.cost));
        }
        if cost < best.cost {
            best = Searched { x, cost, signs: thin.arm().signs().collect(), ..best };
        }
        // the noise as stated, or rounding, explains it; or several starts found the same
        let explained = thin.noise().is_some() && dof > 0.0 && best.cost < EXPLAINED * dof;
        let is_poor = poor(&thin, &start, best.cost, free.len(), plan.poor_above_mm);
        let enough = if is_poor { AGREEING_POOR } else { AGREEING };
        let far_better = best.starts >= SEVERAL && best.cost < FAR_BETTER * runner_up;
        if explained || best.cost <= negligible || agreeing >= enough || far_better {
            break;
        }
    }
    Ok(best)
}

/// Whether the joints of an arm hardly move its tip any more, compared with the problem's own arm: readings of seats that
/// know no length are met exactly by a tip that nothing moves.
pub(crate) fn collapsed(problem: &Problem, parameters: &[f64]) -> bool {
    mobility(problem, parameters) < COLLAPSED * mobility(problem, &problem.parameters())
}

/// Whether no noise is stated and the joints move the tip quite otherwise than those of the arm as it is given: the
/// readings of a small artefact are met a little by arms of other sizes as well, and nothing says how well they should.
pub(crate) fn off_scale(problem: &Problem, parameters: &[f64]) -> bool {
    let size = mobility(problem, parameters) / mobility(problem, &problem.parameters());
    problem.noise().is_none() && !(1.0 - OFF_SCALE..1.0 / (1.0 - OFF_SCALE)).contains(&size)
}

/// A drawing is within reason where its arm is of the same size but for this part.
const OFF_SCALE: f64 = 0.2;
/// An arm whose joints move its tip by less than this part of what they did before has collapsed.
const COLLAPSED: f64 = 0.3;

/// How far the tip moves with its joints, mm/rad, root mean square over some of the readings.
fn mobility(problem: &Problem, parameters: &[f64]) -> f64 {
    let Ok(arm) = problem.arm_at(parameters) else {
        return 0.0;
    };
    let poses = problem.samples(40);
    let moved = poses.iter().map(|pose| encoder_jacobian(&arm, pose.probe, pose.pose()).norm_squared());
    (moved.sum::<f64>() / poses.len().max(1) as f64).sqrt()
}

/// Whether a parameter is the zero offset of a joint: what a search throws.
pub(crate) fn is_zero_offset(problem: &Problem, parameter: usize) -> bool {
    let arm = problem.arm();
    // of a joint that slides it is a twist, as a drawing tells it
    parameter < arm.joint_parameter_count() && parameter.is_multiple_of(4) && !arm.slides(parameter / 4)
}

/// Chi² per degree of freedom up to which the stated noise explains what is left.
const EXPLAINED: f64 = 3.0;
/// Residuals beyond this part of the arm's reach are not what a calibrated arm leaves, where nothing is stated of them;
/// nor are residuals a hundred times the stated noise.
const POOR: f64 = 1e-3;
const POOR_NOISE: f64 = 100.0;

/// Whether a cost is beyond what any calibrated arm leaves. What the user states decides: `above_mm`, the root mean
/// square from which on a fit is poor, or else a noise that explains the cost. A part of the reach is a guess for those
/// who stated neither, or whose noise explains nothing. The reach is the shorter of that at the start and that at these
/// parameters: either may be absurd. unknowns: how many parameters were fitted, without those of placements.
pub(crate) fn poor(problem: &Problem, parameters: &[f64], cost: f64, unknowns: usize, above_mm: Option<f64>) -> bool {
    let weights: f64 = problem.groups().iter().map(|g| g.weight_squared_sum()).sum();
    let rms_mm = (cost / weights).sqrt();
    if let Some(above_mm) = above_mm {
        return rms_mm > above_mm;
    }
    let stated = problem.noise().is_some();
    if stated && !unexplained(problem, cost, unknowns) {
        return false;
    }
    let equations = problem.equations().saturating_sub(problem.placement_unknowns());
    let reach_mm = own_reach_mm(problem, parameters).min(own_reach_mm(problem, &problem.parameters()));
    stated && cost > POOR_NOISE.powi(2) * equations.max(1) as f64 || rms_mm > POOR * reach_mm
}

/// How far the arm reaches, mm, without what only lifts its base.
fn own_reach_mm(problem: &Problem, parameters: &[f64]) -> f64 {
    let mut own = parameters.to_vec();
    if problem.base_free() && problem.arm().joints()[0].model == JointModel::Dh {
        own[3] = 0.0;
    }
    problem.reach_at_mm(&own)
}

/// Whether a noise is stated and does not explain a cost: another start may do better.
pub(crate) fn unexplained(problem: &Problem, cost: f64, unknowns: usize) -> bool {
    let dof = problem.equations().saturating_sub(problem.placement_unknowns() + unknowns);
    problem.noise().is_some() && cost > EXPLAINED * dof as f64
}

/// Lets a fit be interrupted without reporting each of its steps.
struct Quiet<'a>(&'a dyn Monitor);

impl Monitor for Quiet<'_> {
    fn progress(&self, _: Stage, _: usize, _: usize) -> bool {
        true
    }

    fn keep_going(&self) -> bool {
        self.0.keep_going()
    }
}
