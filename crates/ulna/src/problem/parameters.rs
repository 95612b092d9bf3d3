//! A problem's parameters: the arm's, then the fitted dimensions of its artefacts; and what is known of them before.

use super::groups::Problem;
use super::priors::Prior;
use crate::arm::{Arm, JointModel, Unit};
use crate::artefacts::{Dimension, LEAST_NOISE, MOST_MM};
use crate::error::{Error, Result};

impl Problem {
    /// Number of parameters: the arm's, and the fitted dimensions.
    pub fn parameter_count(&self) -> usize {
        self.arm.parameter_count() + self.slots.iter().flatten().flatten().count()
    }

    fn fitted_dimensions(&self) -> impl Iterator<Item = &Dimension> {
        self.groups.iter().flat_map(|g| g.dimensions()).filter(|dimension| dimension.fitted)
    }

    /// Their names.
    pub fn parameter_names(&self) -> Vec<String> {
        let mut names = self.arm.parameter_names();
        names.extend(self.fitted_dimensions().map(|dimension| dimension.name.clone()));
        names
    }

    /// Their units.
    pub fn parameter_units(&self) -> Vec<Unit> {
        let mut units = self.arm.parameter_units();
        units.extend(self.fitted_dimensions().map(|dimension| dimension.unit));
        units
    }

    /// Their values at the start.
    pub fn parameters(&self) -> Vec<f64> {
        let mut parameters = self.arm.parameters();
        parameters.extend(self.fitted_dimensions().map(|dimension| dimension.value));
        parameters
    }

    /// How far a unit of each moves a tip at the most, mm.
    pub fn natural_scale(&self) -> Vec<f64> {
        let reach = self.reach_mm();
        let mut scale = self.arm.moves_mm(reach);
        scale.extend(self.fitted_dimensions().map(|dimension| dimension.moves_mm(reach)));
        scale
    }

    /// Standard uncertainty of each before any reading, where lengths and angles are known so well.
    pub fn known(&self, length_mm: f64, angle_rad: f64) -> Vec<f64> {
        let mut known = self.arm.known(length_mm, angle_rad);
        known.extend(self.fitted_dimensions().map(|dimension| dimension.known(length_mm, angle_rad)));
        known
    }

    /// For each parameter, whether it is among the free ones.
    pub(crate) fn is_free(&self, free: &[usize]) -> Vec<bool> {
        let mut is_free = vec![false; self.parameter_count()];
        free.iter().for_each(|&j| is_free[j] = true);
        is_free
    }

    /// What is known of parameters before any reading: as stated, and of fitted dimensions by their calibration.
    pub fn priors(&self) -> Vec<Prior> {
        let mut priors = self.stated_priors.clone();
        for (group, slots) in self.groups.iter().zip(&self.slots) {
            for (dimension, slot) in group.dimensions().iter().zip(slots) {
                let Some(parameter) = *slot else { continue };
                if dimension.u > 0.0 && priors.iter().all(|prior| prior.parameter != parameter) {
                    priors.push(Prior { parameter, value: dimension.value, u: dimension.u });
                }
            }
        }
        priors
    }

    /// Standard uncertainty of each dimension that is considered where these parameters are free: known with an
    /// uncertainty, and not fitted.
    pub(crate) fn considered_u(&self, free: &[usize]) -> Vec<f64> {
        let of_groups = self.groups.iter().zip(&self.slots);
        let dimensions = of_groups.flat_map(|(group, slots)| group.dimensions().iter().zip(slots));
        let considered = dimensions.filter(|(_, slot)| slot.is_none_or(|parameter| !free.contains(&parameter)));
        considered.map(|(dimension, _)| dimension.u).collect()
    }

    /// What a whitened residual of one stands for, by which priors are weighed: one where noise is stated, else the scatter
    /// of the readings as it is known so far, mm.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    pub(crate) fn set_unit(&mut self, unit: f64) {
        self.unit = unit;
    }

    /// The dimensions of every group at some parameters.
    pub(crate) fn dimensions_at(&self, parameters: &[f64]) -> Vec<Vec<f64>> {
        let value = |(dimension, slot): (&Dimension, &Option<usize>)| {
            slot.map_or(dimension.value, |parameter| parameters[parameter])
        };
        let of_groups = self.groups.iter().zip(&self.slots);
        of_groups.map(|(group, slots)| group.dimensions().iter().zip(slots).map(value).collect()).collect()
    }

    /// The arm at some parameters of the problem.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn arm_at(&self, parameters: &[f64]) -> Result<Arm> {
        self.arm.with_parameters(&parameters[..self.arm.parameter_count()])
    }

    /// Parameters that only move the base frame, where nothing fixes it: theta0 of joint 1, and d of a DH joint 1.
    pub fn base_parameters(&self) -> Vec<usize> {
        if !self.base_free() {
            return vec![];
        }
        // such as gravity that leans, by how joints give way
        let seen = self.arm.effects().all().any(|effect| effect.sees_the_base_turn());
        let turn = (!seen).then_some(0);
        let lift = (self.arm.joints()[0].model == JointModel::Dh).then_some(3);
        let of_base = |&j: &usize| self.arm.effect_of(j).is_some_and(|(effect, _)| effect.of_base());
        let stands = (self.arm.geometry_count()..self.arm.parameter_count()).filter(of_base);
        turn.into_iter().chain(lift).chain(stands).collect()
    }

    /// How fast every fitted dimension grows with the arm, where no length is known: parameter and how much.
    pub(crate) fn growing_dimensions(&self, parameters: &[f64]) -> Vec<(usize, f64)> {
        let mut growing = Vec::new();
        let mut slots = self.slots.iter();
        self.for_each_at(parameters, |group, at| {
            let own = slots.next().into_iter().flatten().zip(group.growing(at));
            growing.extend(own.filter_map(|(slot, growth)| Some(((*slot)?, growth))));
        });
        growing
    }

    /// States what is known of a parameter before: its number in [`Problem::parameter_names`].
    ///
    /// # Errors
    /// No such parameter, or a number that is not finite or not positive.
    pub fn add_prior(&mut self, prior: Prior) -> Result<()> {
        let count = self.parameter_count();
        if prior.parameter >= count {
            return Err(Error::NoSuch { what: "parameter", index: prior.parameter as i64, count });
        }
        let name = || self.parameter_names().swap_remove(prior.parameter);
        if !prior.value.is_finite() {
            return Err(Error::NotFinite { what: format!("the prior of {}", name()), value: prior.value });
        }
        if !(LEAST_NOISE..=MOST_MM).contains(&prior.u) {
            return Err(Error::OutOfRange {
                what: format!("the standard deviation of the prior of {}", name()),
                value: prior.u,
                expected: "a number from 1e-12 to 1e7",
            });
        }
        self.stated_priors.retain(|stated| stated.parameter != prior.parameter);
        self.stated_priors.push(prior);
        Ok(())
    }
}
