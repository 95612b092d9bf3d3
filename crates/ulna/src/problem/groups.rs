//! An arm, and groups of readings of artefacts.

use super::priors::Prior;
use crate::arm::{Arm, Seen, Unit};
use crate::artefacts::{
    At, Dimension, LEAST_NOISE, MOST_MM, Model, Noise, Readings, Unweighted, Weighing, Whitened, normal,
};
use crate::error::{Error, Result};
use crate::kinematics::Sample;
use crate::solver::losses::Loss;
use rand_xoshiro::Xoshiro256PlusPlus;

/// Readings of features of placed artefacts, to be explained by one arm.
///
/// Its parameters are the arm's, then the fitted dimensions of its artefacts.
#[derive(Debug)]
pub struct Problem {
    pub(super) arm: Arm,
    pub(super) noise: Option<Noise>,
    pub(super) groups: Vec<Box<dyn Readings>>,
    /// for each group's dimensions, which parameter each is
    pub(super) slots: Vec<Vec<Option<usize>>>,
    pub(super) stated_priors: Vec<Prior>,
    /// what a whitened residual of one stands for: priors are weighed with it
    pub(super) unit: f64,
    pub(super) loss: Option<Loss>,
}

impl Clone for Problem {
    fn clone(&self) -> Self {
        self.with_groups(self.groups.iter().map(|g| g.boxed()).collect())
    }
}

/// Sines and cosines of all readings are kept where they take no more than this.
const KEEP_BYTES: usize = 16 << 20;

impl Problem {
    /// No readings yet. Without noise every reading weighs one.
    ///
    /// # Errors
    /// A count of encoder deviations other than none or one for each encoder, or a negative one.
    pub fn new(arm: Arm, noise: Option<Noise>) -> Result<Problem> {
        check_size(&arm)?;
        if let Some(noise) = &noise {
            let given = noise.encoder_rad.len();
            if given != 0 && given != arm.encoders() {
                return Err(Error::Shape {
                    what: "noise of the encoders".into(),
                    got: given,
                    expected: arm.encoders(),
                });
            }
            for &value in noise.encoder_rad.iter().chain([&noise.seat_mm]) {
                if !(value == 0.0 || (LEAST_NOISE..=MOST_MM).contains(&value)) {
                    return Err(Error::OutOfRange {
                        what: "a standard deviation of the noise (rad or mm)".into(),
                        value,
                        expected: "zero, or a number from 1e-12 to 1e7",
                    });
                }
            }
        }
        // noise of nothing weighs nothing: the same as none
        let noise = noise.filter(|n| n.seat_mm > 0.0 || n.encoder_rad.iter().any(|&s| s > 0.0));
        Ok(Problem { arm, noise, groups: vec![], slots: vec![], stated_priors: vec![], unit: 1.0, loss: None })
    }

    pub(super) fn push(&mut self, mut group: Box<dyn Readings>) -> usize {
        let kept: usize = self.groups.iter().map(|g| g.sin_cos_bytes()).sum();
        if kept + group.sin_cos_bytes() <= KEEP_BYTES {
            group.keep_sin_cos();
        }
        let mut next = self.parameter_count();
        let slot = |dimension: &Dimension| {
            next += usize::from(dimension.fitted);
            dimension.fitted.then(|| next - 1)
        };
        let slots = group.dimensions().iter().map(slot).collect();
        self.slots.push(slots);
        self.groups.push(group);
        self.groups.len() - 1
    }

    /// Judges residuals by a loss that lets outliers count for less; none: by their squares.
    pub fn set_loss(&mut self, loss: Option<Loss>) {
        self.loss = loss;
    }

    /// The loss, if residuals are not judged by their squares.
    pub fn loss(&self) -> Option<Loss> {
        self.loss
    }

    /// The arm at its start values.
    pub fn arm(&self) -> &Arm {
        &self.arm
    }

    /// The same readings for another arm of the same structure.
    pub fn set_arm(&mut self, arm: Arm) {
        self.arm = arm;
    }

    /// What is stated of the noise.
    pub fn noise(&self) -> Option<&Noise> {
        self.noise.as_ref()
    }

    /// The groups of readings.
    pub fn groups(&self) -> &[Box<dyn Readings>] {
        &self.groups
    }

    /// For each group's dimensions, which parameter each is.
    pub(crate) fn slots(&self) -> &[Vec<Option<usize>>] {
        &self.slots
    }

    /// The same problem with other readings of the same artefacts.
    pub(crate) fn with_groups(&self, groups: Vec<Box<dyn Readings>>) -> Problem {
        Problem {
            arm: self.arm.clone(),
            noise: self.noise.clone(),
            groups,
            slots: self.slots.clone(),
            stated_priors: self.stated_priors.clone(),
            unit: self.unit,
            loss: self.loss,
        }
    }

    /// Calls `each` with every group and where it is looked at.
    pub(super) fn for_each_at(&self, parameters: &[f64], mut each: impl FnMut(&dyn Readings, At)) {
        let mut model = Model::new(&self.arm);
        model.set_parameters(&parameters[..self.arm.parameter_count()]);
        for (group, dimensions) in self.groups.iter().zip(self.dimensions_at(parameters)) {
            each(group.as_ref(), At { model: &model, dimensions: &dimensions });
        }
    }

    /// About `most` of the readings, evenly chosen, every group represented.
    pub(crate) fn thinned(&self, most: usize) -> Problem {
        let thin = |group: &dyn Readings| {
            let part = (most * group.len()).div_ceil(self.readings().max(1));
            let mut thin = group.thinned(part.max(4));
            thin.keep_sin_cos();
            thin
        };
        self.with_groups(self.groups.iter().map(|g| thin(g.as_ref())).collect())
    }

    /// About `most` of the readings as a search for the arm wants them: as lengths where they can be told so, artefacts as
    /// they are calibrated.
    pub(crate) fn for_search(&self, most: usize) -> Problem {
        let mut searched = self.thinned(most);
        let groups = std::mem::take(&mut searched.groups);
        searched.slots.clear();
        for group in groups {
            searched.push(group.as_lengths().unwrap_or(group));
        }
        let arm_parameters = self.arm.parameter_count();
        searched.stated_priors.retain(|prior| prior.parameter < arm_parameters);
        searched.weigh(&searched.parameters(), Weighing::Even);
        searched
    }

    /// Number of readings.
    pub fn readings(&self) -> usize {
        self.groups.iter().map(|g| g.len()).sum()
    }

    /// Number of scalar equations.
    pub fn equations(&self) -> usize {
        self.groups.iter().map(|g| g.equations()).sum()
    }

    /// Unknowns of all placements.
    pub fn placement_unknowns(&self) -> usize {
        self.groups.iter().map(|g| g.placement_unknowns()).sum()
    }

    /// Whether the base frame is fixed by nothing: every artefact stands freely.
    pub fn base_free(&self) -> bool {
        self.groups.iter().all(|g| g.mirror_free() || g.placement_unknowns() > 0)
    }

    /// Whether the mirror image of the arm explains the readings as well: its joints turn, none slides.
    pub fn mirror_free(&self) -> bool {
        !self.arm.any_slides() && self.groups.iter().all(|g| g.mirror_free())
    }

    /// Whether a scaled arm explains the readings as well: no length is known, and what slides says one.
    pub fn scale_free(&self) -> bool {
        !self.arm.any_slides() && self.groups.iter().all(|g| g.scale_free())
    }

    /// Whether any reading tells where the tip is.
    pub fn tells_places(&self) -> bool {
        self.groups.iter().any(|g| g.tell_places())
    }

    /// Whether an arm whose tip never moves explains the readings as well.
    pub fn still_free(&self) -> bool {
        self.groups.iter().all(|g| g.still_free())
    }

    /// For each probe, whether a reading was taken with it.
    pub fn probes_used(&self) -> Vec<bool> {
        let mut used = vec![false; self.arm.probes().len()];
        for group in &self.groups {
            for (u, here) in used.iter_mut().zip(group.probes_used(self.arm.probes().len())) {
                *u |= here;
            }
        }
        used
    }

    /// About `most` of the poses of each group's readings.
    pub fn samples(&self, most: usize) -> Vec<Sample> {
        self.groups.iter().flat_map(|g| g.samples(most)).collect()
    }

    /// What the readings show of what the arm's effects depend on.
    pub fn seen(&self) -> Seen {
        self.groups.iter().map(|g| g.seen()).reduce(Seen::and).unwrap_or_default()
    }

    /// Longest reach with any probe, mm.
    pub fn reach_mm(&self) -> f64 {
        longest_reach_mm(&self.arm)
    }

    /// The same at other parameters.
    pub fn reach_at_mm(&self, parameters: &[f64]) -> f64 {
        self.arm_at(parameters).map_or(f64::MAX, |arm| longest_reach_mm(&arm))
    }

    /// Residuals of every group at some parameters, and the root mean square of a reading's residual, mm.
    pub fn unweighted(&self, parameters: &[f64]) -> (Vec<Unweighted>, f64) {
        let mut groups: Vec<Unweighted> = Vec::new();
        self.for_each_at(parameters, |group, at| groups.push(group.unweighted(at)));
        let squares: f64 = groups.iter().flat_map(|g| &g.residuals_mm).map(|r| r * r).sum();
        let rms = (squares / self.readings().max(1) as f64).sqrt();
        (groups, rms)
    }

    /// Whether the stated noise makes weights depend on where the arm is.
    pub fn weighs_encoders(&self) -> bool {
        self.noise.as_ref().is_some_and(|noise| noise.encoder_rad.iter().any(|&sigma| sigma > 0.0))
    }

    /// Whether, moreover, some reading weighs its directions differently.
    pub fn weighs_directions(&self) -> bool {
        self.weighs_encoders() && self.groups.iter().any(|g| g.weighs_directions())
    }

    /// Weighs the readings for the stated noise at some parameters; what a loss made of them is forgotten.
    pub fn weigh(&mut self, parameters: &[f64], how: Weighing) {
        let mut model = Model::new(&self.arm);
        model.set_parameters(&parameters[..self.arm.parameter_count()]);
        let dimensions = self.dimensions_at(parameters);
        for (group, dimensions) in self.groups.iter_mut().zip(&dimensions) {
            group.weigh(At { model: &model, dimensions }, self.noise.as_ref(), how);
        }
    }

    /// Weighs other readings of the artefact of a group, as its own would be.
    pub(super) fn weigh_beside(&self, parameters: &[f64], group: usize, readings: &mut dyn Readings) {
        let mut model = Model::new(&self.arm);
        model.set_parameters(&parameters[..self.arm.parameter_count()]);
        let dimensions = self.dimensions_at(parameters).swap_remove(group);
        readings.weigh(At { model: &model, dimensions: &dimensions }, self.noise.as_ref(), Weighing::Full);
    }

    /// Residuals of every group as a loss judges them.
    pub fn whitened(&self, parameters: &[f64]) -> Vec<Whitened> {
        let mut groups = Vec::new();
        self.for_each_at(parameters, |group, at| groups.push(group.whitened(at)));
        groups
    }

    /// Weighs each reading of each group by a further factor; none: by one.
    pub(crate) fn discount(&mut self, factors: Option<&[Vec<f64>]>) {
        for (number, group) in self.groups.iter_mut().enumerate() {
            group.discount(factors.map(|factors| factors[number].as_slice()));
        }
    }

    /// The same readings, exact at these parameters, with new noise; priors and artefacts calibrated anew.
    pub fn redrawn(&self, truth: &[f64], noise: &Noise, rng: &mut Xoshiro256PlusPlus) -> Problem {
        let mut groups = Vec::new();
        self.for_each_at(truth, |group, at| groups.push(group.redrawn(at, noise, rng)));
        let mut drawn = self.with_groups(groups);
        for prior in &mut drawn.stated_priors {
            prior.value = truth[prior.parameter] + prior.u * normal(rng);
        }
        drawn
    }
}

fn longest_reach_mm(arm: &Arm) -> f64 {
    (0..arm.probes().len()).map(|p| arm.reach_mm(p)).fold(f64::MIN_POSITIVE, f64::max)
}

/// What no arm has: an angle of a thousand turns.
const MOST_RAD: f64 = 1e4;

fn check_size(arm: &Arm) -> Result<()> {
    let units = arm.parameter_units();
    for ((name, value), unit) in arm.parameter_names().into_iter().zip(arm.parameters()).zip(units) {
        let (most, expected) = match unit {
            Unit::Mm => (MOST_MM, "at most 10 km (1e7 mm)"),
            Unit::Rad => (MOST_RAD, "at most 10000 rad"),
            Unit::PerKelvin => (1.0, "at most 1/K"),
            Unit::RadPerNewtonMetre => (MOST_RAD, "at most 10000 rad/(N m)"),
            Unit::One => (MOST_MM, "at most 1e7"),
        };
        if value.abs() > most {
            return Err(Error::OutOfRange { what: format!("{name}, {},", unit.as_str()), value, expected });
        }
    }
    Ok(())
}
