//! The one assembly: an arm, readings, and what is free become a least-squares problem.

use crate::arm::{Arm, JointModel, Unit};
use crate::error::{Error, Result};
use crate::residuals::length::{LengthRows, Lengths};
use crate::residuals::points::{Features, PointRows, Points};
use crate::residuals::{Model, Noise, Readings, Unweighted, Weighing};
use nalgebra::Vector3;

/// Readings of features of placed artefacts, to be explained by one arm.
#[derive(Debug)]
pub struct Problem {
    arm: Arm,
    noise: Option<Noise>,
    groups: Vec<Box<dyn Readings>>,
}

impl Clone for Problem {
    fn clone(&self) -> Self {
        Problem {
            arm: self.arm.clone(),
            noise: self.noise.clone(),
            groups: self.groups.iter().map(|g| g.boxed()).collect(),
        }
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
        Ok(Problem { arm, noise, groups: vec![] })
    }

    /// Adds rows of two poses and a length; returns the group's number.
    ///
    /// # Errors
    /// Shapes that do not agree, an unknown probe, a value that is not finite, a length that is not positive.
    pub fn add_lengths(&mut self, name: &str, rows: LengthRows, u_mm: f64) -> Result<usize> {
        let count = rows.length_mm.len();
        self.check_angles("first poses", rows.q_rad, count)?;
        self.check_angles("second poses", rows.p_rad, count)?;
        self.check_probes(rows.probe, count)?;
        for &value in rows.length_mm {
            if !(1e-6..=MOST_MM).contains(&value) {
                return Err(Error::OutOfRange {
                    what: format!("a length of artefact {name}, mm,"),
                    value,
                    expected: "a number from 1e-6 to 1e7",
                });
            }
        }
        check_uncertainty(name, u_mm)?;
        let group = Lengths::new(name, self.arm.encoders(), rows, u_mm);
        Ok(self.push(Box::new(group)))
    }

    /// Adds readings of an artefact's features; returns the group's number.
    ///
    /// # Errors
    /// Shapes that do not agree, an unknown probe or feature, a value that is not finite.
    pub fn add_points(&mut self, features: &Features, rows: PointRows) -> Result<usize> {
        let count = rows.feature.len();
        self.check_angles("poses", rows.q_rad, count)?;
        self.check_probes(rows.probe, count)?;
        for &index in rows.feature {
            if index >= features.coordinates_mm.len() {
                return Err(Error::NoSuch {
                    what: "feature",
                    index: index as i64,
                    count: features.coordinates_mm.len(),
                });
            }
        }
        for &value in features.coordinates_mm.iter().flatten() {
            if value.is_nan() || value.abs() > MOST_MM {
                return Err(Error::OutOfRange {
                    what: format!("a coordinate of artefact {}, mm,", features.name),
                    value,
                    expected: "a number from -1e7 to 1e7",
                });
            }
        }
        if rows.placement.len() != count {
            return Err(Error::Shape {
                what: "the placement labels".into(),
                got: rows.placement.len(),
                expected: count,
            });
        }
        check_uncertainty(features.name, features.u_mm)?;
        let group = Points::new(features, self.arm.encoders(), rows);
        Ok(self.push(Box::new(group)))
    }

    fn push(&mut self, mut group: Box<dyn Readings>) -> usize {
        let kept: usize = self.groups.iter().map(|g| g.sin_cos_bytes()).sum();
        if kept + group.sin_cos_bytes() <= KEEP_BYTES {
            group.keep_sin_cos();
        }
        self.groups.push(group);
        self.groups.len() - 1
    }

    fn check_angles(&self, what: &str, angles: &[f64], rows: usize) -> Result<()> {
        let expected = rows * self.arm.encoders();
        if angles.len() != expected {
            return Err(Error::Shape { what: format!("the {what}"), got: angles.len(), expected });
        }
        match angles.iter().find(|v| !v.is_finite()) {
            Some(&value) => Err(Error::NotFinite { what: format!("an angle of the {what}"), value }),
            None => Ok(()),
        }
    }

    fn check_probes(&self, probe: &[usize], rows: usize) -> Result<()> {
        if probe.len() != rows {
            return Err(Error::Shape { what: "the probe indices".into(), got: probe.len(), expected: rows });
        }
        let count = self.arm.probes().len();
        match probe.iter().find(|&&p| p >= count) {
            Some(&p) => Err(Error::NoSuch { what: "probe", index: p as i64, count }),
            None => Ok(()),
        }
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

    /// The same problem with other readings.
    pub(crate) fn with_groups(&self, groups: Vec<Box<dyn Readings>>) -> Problem {
        Problem { arm: self.arm.clone(), noise: self.noise.clone(), groups }
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

    /// Parameters that only move the base frame, where nothing fixes it: theta0 of joint 1, and d of a DH joint 1.
    pub fn base_parameters(&self) -> Vec<usize> {
        match (self.base_free(), self.arm.joints()[0].model) {
            (false, _) => vec![],
            (true, JointModel::Dh) => vec![0, 3],
            (true, JointModel::Hayati) => vec![0],
        }
    }

    /// Whether the mirror image of the arm explains the readings as well.
    pub fn mirror_free(&self) -> bool {
        self.groups.iter().all(|g| g.mirror_free())
    }

    /// Whether a scaled arm explains the readings as well: no length is known.
    pub fn scale_free(&self) -> bool {
        self.groups.iter().all(|g| g.scale_free())
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

    /// About `most` of the poses of the readings: probe and angles.
    pub fn sample_poses(&self, most: usize) -> Vec<(usize, Vec<f64>)> {
        self.groups.iter().flat_map(|g| g.sample_poses(most)).collect()
    }

    /// Longest reach with any probe, mm.
    pub fn reach_mm(&self) -> f64 {
        longest_reach_mm(&self.arm)
    }

    /// The same at other parameters.
    pub fn reach_at_mm(&self, parameters: &[f64]) -> f64 {
        self.arm.with_parameters(parameters).map_or(f64::MAX, |arm| longest_reach_mm(&arm))
    }

    /// Residuals of every group at some parameters, and the root mean square of a reading's residual, mm.
    pub fn unweighted(&self, parameters: &[f64]) -> (Vec<Unweighted>, f64) {
        let mut model = Model::new(&self.arm);
        model.set_parameters(parameters);
        let groups: Vec<Unweighted> = self.groups.iter().map(|g| g.unweighted(&model)).collect();
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
        self.weighs_encoders() && self.groups.iter().any(|g| g.equations() > g.len())
    }

    /// Weighs the readings for the stated noise at some parameters.
    pub fn weigh(&mut self, parameters: &[f64], how: Weighing) {
        let mut model = Model::new(&self.arm);
        model.set_parameters(parameters);
        for group in &mut self.groups {
            group.weigh(&model, self.noise.as_ref(), how);
        }
    }
}

fn longest_reach_mm(arm: &Arm) -> f64 {
    (0..arm.probes().len()).map(|p| arm.reach_mm(p)).fold(f64::MIN_POSITIVE, f64::max)
}

/// What no arm has: a link of ten kilometres, an angle of a thousand turns.
const MOST_MM: f64 = 1e7;
const MOST_RAD: f64 = 1e4;
/// What no noise is: less than this is a slip, and its weights would not fit into a number.
const LEAST_NOISE: f64 = 1e-12;

fn check_size(arm: &Arm) -> Result<()> {
    let units = arm.parameter_units();
    for ((name, value), unit) in arm.parameter_names().into_iter().zip(arm.parameters()).zip(units) {
        let (most, expected) = match unit {
            Unit::Mm => (MOST_MM, "at most 10 km (1e7 mm)"),
            Unit::Rad => (MOST_RAD, "at most 10000 rad"),
        };
        if value.abs() > most {
            return Err(Error::OutOfRange { what: format!("{name}, {},", unit.as_str()), value, expected });
        }
    }
    Ok(())
}

fn check_uncertainty(name: &str, u_mm: f64) -> Result<()> {
    if u_mm.is_finite() && u_mm >= 0.0 {
        return Ok(());
    }
    Err(Error::OutOfRange {
        what: format!("the uncertainty of artefact {name}"),
        value: u_mm,
        expected: "a number not below zero",
    })
}

/// A tip's distance from the last axis, mm.
pub(crate) fn off_axis_mm(tip_mm: [f64; 3]) -> f64 {
    Vector3::from(tip_mm).xy().norm()
}
