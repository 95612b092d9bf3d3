//! The arm itself, its parameters in their order.

use super::effects::{Effect, Effects};
use super::joint::{Joint, JointModel};
use super::probe::Probe;
use super::unit::Unit;
use crate::error::{Error, Result};

/// An articulated arm with one probe or more.
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    joints: Vec<Joint>,
    /// the sign of a last joint that has no geometry of its own
    bare_last: Option<f64>,
    probes: Vec<Probe>,
    effects: Effects,
    /// of each encoder whose joint slides along its axis and does not turn: how far at the most, mm
    slides_mm: Vec<Option<f64>>,
}

impl Arm {
    /// An arm of `joints.len() + 1` encoders: the last joint has no geometry but its sign.
    ///
    /// # Errors
    /// No joint before the last, no probe, a sign that is not ±1, or a number that is not finite.
    pub fn new(joints: Vec<Joint>, last_sign: f64, probes: Vec<Probe>) -> Result<Arm> {
        let slides_mm = vec![None; joints.len() + 1];
        Arm { joints, bare_last: Some(last_sign), probes, effects: Effects::default(), slides_mm }.checked()
    }

    /// An arm of `joints.len()` encoders whose last joint has a link of its own, to which the probes are fixed: four
    /// parameters more than needed, as in some models of the literature (Gao 2009; Santolaria and Aguilar 2010).
    ///
    /// # Errors
    /// As [`Arm::new`].
    pub fn with_full_last_link(joints: Vec<Joint>, probes: Vec<Probe>) -> Result<Arm> {
        let slides_mm = vec![None; joints.len()];
        Arm { joints, bare_last: None, probes, effects: Effects::default(), slides_mm }.checked()
    }

    /// The same arm with other effects beyond its geometry.
    ///
    /// # Errors
    /// Another number of joints in them, or a number that is not finite.
    pub fn with_effects(&self, effects: Effects) -> Result<Arm> {
        Arm { effects, ..self.clone() }.checked()
    }

    /// The same arm with joints that slide along their axes and do not turn: of each encoder, how far from its zero at
    /// the most, mm; none of those that turn. The readings of such an encoder are mm, and its joint stands in
    /// `Rz(-theta0) · Tz(d + sign q) · Tx(a) · Rx(alpha)`.
    ///
    /// # Errors
    /// Another count, a joint of Hayati among them, a travel that is no positive number, or a coupling with one.
    pub fn with_slides(&self, slides_mm: &[Option<f64>]) -> Result<Arm> {
        if slides_mm.len() != self.encoders() {
            let what = "the joints that slide".into();
            return Err(Error::Shape { what, got: slides_mm.len(), expected: self.encoders() });
        }
        Arm { slides_mm: slides_mm.to_vec(), ..self.clone() }.checked()
    }

    fn checked_slides(&self) -> Result<()> {
        for (i, most_mm) in self.slides_mm.iter().enumerate() {
            let Some(value) = *most_mm else { continue };
            let refused = |expected: &'static str| {
                let what = format!("the travel of joint {}, mm,", i + 1);
                Err(Error::OutOfRange { what, value, expected })
            };
            if !(value > 0.0 && value.is_finite()) {
                return refused("a positive number");
            }
            if self.joints.get(i).is_some_and(|joint| joint.model == JointModel::Hayati) {
                return refused("none of a Hayati joint, which turns");
            }
            let coupling = self.effects.coupling.as_ref();
            let coupled = |(one, other, _): (usize, usize, f64)| one == i || other == i;
            if coupling.is_some_and(|coupling| coupling.pairs().any(coupled)) {
                return refused("none of a coupled joint, which turns");
            }
        }
        Ok(())
    }

    /// Whether a joint slides along its axis and does not turn.
    pub fn slides(&self, encoder: usize) -> bool {
        self.slides_mm[encoder].is_some()
    }

    /// Whether any does: then its readings know a length, and the arm is told from its mirror image.
    pub fn any_slides(&self) -> bool {
        self.slides_mm.iter().any(Option::is_some)
    }

    fn checked(self) -> Result<Arm> {
        if self.encoders() < 2 {
            return Err(Error::TooFewJoints(self.encoders()));
        }
        if self.probes.is_empty() {
            return Err(Error::NoProbe);
        }
        for (i, sign) in self.signs().enumerate() {
            if sign.abs() != 1.0 {
                return Err(Error::OutOfRange {
                    what: format!("the sign of joint {}", i + 1),
                    value: sign,
                    expected: "+1 or -1",
                });
            }
        }
        self.effects.check(self.encoders())?;
        self.checked_slides()?;
        for (name, value) in self.parameter_names().into_iter().zip(self.parameters()) {
            if !value.is_finite() {
                return Err(Error::NotFinite { what: name, value });
            }
        }
        Ok(self)
    }

    /// Number of encoders, n.
    pub fn encoders(&self) -> usize {
        self.joints.len() + usize::from(self.bare_last.is_some())
    }

    /// Whether the last joint has a link of its own.
    pub fn has_full_last_link(&self) -> bool {
        self.bare_last.is_none()
    }

    /// The joints with geometry: all but a bare last one.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The probes in their order.
    pub fn probes(&self) -> &[Probe] {
        &self.probes
    }

    /// The sign of every encoder, the last included.
    pub fn signs(&self) -> impl Iterator<Item = f64> + '_ {
        self.joints.iter().map(|j| j.sign).chain(self.bare_last)
    }

    /// The same arm with other signs, one for each encoder, each +1 or -1.
    pub fn with_signs(&self, signs: &[f64]) -> Arm {
        let mut arm = self.clone();
        arm.joints.iter_mut().zip(signs).for_each(|(joint, &sign)| joint.sign = sign);
        if let (Some(last), Some(&sign)) = (&mut arm.bare_last, signs.last()) {
            *last = sign;
        }
        arm
    }

    /// What the arm does beyond its geometry.
    pub fn effects(&self) -> &Effects {
        &self.effects
    }

    /// Number of parameters of the joints' geometry, 4(n-1), or 4n with a full last link.
    pub fn joint_parameter_count(&self) -> usize {
        4 * self.joints.len()
    }

    /// Number of parameters of joints and probes: where those of the effects begin.
    pub fn geometry_count(&self) -> usize {
        self.joint_parameter_count() + 3 * self.probes.len()
    }

    /// Number of all parameters.
    pub fn parameter_count(&self) -> usize {
        self.geometry_count() + self.effects.count()
    }

    /// Index of the first of a probe's three parameters.
    pub fn tip_offset(&self, probe: usize) -> usize {
        self.joint_parameter_count() + 3 * probe
    }

    /// `joint.1.theta0 … probe.bent.z`, in the order of [`Arm::parameters`].
    pub fn parameter_names(&self) -> Vec<String> {
        let mut names = Vec::with_capacity(self.parameter_count());
        for (i, joint) in self.joints.iter().enumerate() {
            let fourth = match joint.model {
                JointModel::Dh => "d",
                JointModel::Hayati => "beta",
            };
            names.extend(["theta0", "alpha", "a", fourth].map(|p| format!("joint.{}.{p}", i + 1)));
        }
        for probe in &self.probes {
            names.extend(["x", "y", "z"].map(|axis| format!("probe.{}.{axis}", probe.name)));
        }
        names.extend(self.effects.all().flat_map(|effect| effect.names()));
        names
    }

    /// The unit of each parameter.
    pub fn parameter_units(&self) -> Vec<Unit> {
        let mut units = Vec::with_capacity(self.parameter_count());
        for joint in &self.joints {
            units.extend([Unit::Rad, Unit::Rad, Unit::Mm]);
            units.push(match joint.model {
                JointModel::Dh => Unit::Mm,
                JointModel::Hayati => Unit::Rad,
            });
        }
        units.resize(self.geometry_count(), Unit::Mm);
        for effect in self.effects.all() {
            units.resize(units.len() + effect.values().len(), effect.unit());
        }
        units
    }

    /// How far a unit of each parameter moves the tip of an arm of some reach at the most, in round figures, mm.
    pub fn moves_mm(&self, reach_mm: f64) -> Vec<f64> {
        self.of_each(1.0, reach_mm, |effect| effect.moves_mm(reach_mm))
    }

    /// Standard uncertainty of each parameter before any reading, where lengths and angles are known so well.
    pub fn known(&self, length_mm: f64, angle_rad: f64) -> Vec<f64> {
        self.of_each(length_mm, angle_rad, |effect| effect.known(angle_rad))
    }

    /// A number for each parameter: of lengths and angles of the geometry, and of every effect.
    fn of_each(&self, length: f64, angle: f64, of: impl Fn(&dyn Effect) -> f64) -> Vec<f64> {
        let of_geometry = |unit: &Unit| if *unit == Unit::Rad { angle } else { length };
        let mut each: Vec<f64> = self.parameter_units()[..self.geometry_count()].iter().map(of_geometry).collect();
        for effect in self.effects.all() {
            each.resize(each.len() + effect.values().len(), of(effect));
        }
        each
    }

    /// All parameters, in [`Arm::parameter_units`].
    pub fn parameters(&self) -> Vec<f64> {
        let joints = self.joints.iter().flat_map(Joint::parameters);
        let tips = self.probes.iter().flat_map(|p| p.tip_mm);
        joints.chain(tips).chain(self.effects.all().flat_map(|effect| effect.values()).copied()).collect()
    }

    /// The same arm with other numbers.
    ///
    /// # Errors
    /// Another count of parameters, or a value that is not finite.
    pub fn with_parameters(&self, parameters: &[f64]) -> Result<Arm> {
        if parameters.len() != self.parameter_count() {
            return Err(Error::Shape {
                what: "the parameter vector".into(),
                got: parameters.len(),
                expected: self.parameter_count(),
            });
        }
        let mut arm = self.clone();
        let (geometry, effects) = parameters.split_at(self.geometry_count());
        let (joints, tips) = geometry.split_at(self.joint_parameter_count());
        for (joint, p) in arm.joints.iter_mut().zip(joints.chunks_exact(4)) {
            *joint = joint.with_parameters(p);
        }
        for (probe, tip) in arm.probes.iter_mut().zip(tips.chunks_exact(3)) {
            probe.tip_mm.copy_from_slice(tip);
        }
        arm.effects.set(effects);
        arm.checked()
    }

    /// The effect that a parameter is of, and which of its values it is; none for those of the geometry.
    pub(crate) fn effect_of(&self, parameter: usize) -> Option<(&dyn Effect, usize)> {
        let mut value = parameter.checked_sub(self.geometry_count())?;
        for effect in self.effects.all() {
            let count = effect.values().len();
            if value < count {
                return Some((effect, value));
            }
            value -= count;
        }
        None
    }

    /// The joint that a parameter belongs to, counted from 0; none for a probe's tip.
    pub fn joint_of(&self, parameter: usize) -> Option<usize> {
        if parameter < self.joint_parameter_count() {
            return Some(parameter / 4);
        }
        self.effect_of(parameter).map(|(effect, value)| effect.joint_of(value))
    }

    /// Sum of the lengths of all links, of what slides and of the tip, mm: nothing is farther from the base.
    pub fn reach_mm(&self, probe: usize) -> f64 {
        let links: f64 = self.joints.iter().map(|j| j.a_mm.hypot(j.d_mm)).sum();
        let beside = self.effects.base_offset.as_ref().map_or(0.0, |base| base.mm[0].hypot(base.mm[1]));
        let slides: f64 = self.slides_mm.iter().flatten().sum();
        beside + links + slides + self.probes[probe].tip_mm.iter().map(|t| t * t).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
pub(crate) mod samples {
    use super::*;

    /// Table 2 of Cheng 2011 (assumed truth) with a probe at r, theta0 = 0, h = 200.
    pub fn table2(r: f64) -> Arm {
        let h = std::f64::consts::FRAC_PI_2;
        arm(
            &[
                [0.0, -h, 40.0, 250.0],
                [2.2689, h, -40.0, 0.0],
                [0.0, -h, 30.0, 450.0],
                [2.2689, h, -30.0, 0.0],
                [0.0, -h, 30.0, 450.0],
                [2.2689, h, -30.0, 0.0],
            ],
            [r, 0.0, 200.0],
        )
    }

    /// A DH arm with all signs +1 and one probe named `bent`.
    pub fn arm(dh: &[[f64; 4]], tip_mm: [f64; 3]) -> Arm {
        let probe = Probe { name: "bent".into(), tip_mm };
        Arm::new(dh.iter().copied().map(Joint::dh).collect(), 1.0, vec![probe]).unwrap()
    }
}
