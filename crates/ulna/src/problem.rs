//! The one assembly: an arm, readings, and what is free become a least-squares problem.

use crate::arm::{Arm, Unit};
use crate::error::{Error, Result};
use crate::monitor::Monitor;
use crate::residuals::length::{LengthRows, Lengths};
use crate::residuals::points::{Features, PointRows, Points};
use crate::residuals::{Buffers, Model, Noise, Readings, Unknowns, Unweighted, Writer};
use crate::solver::{LeastSquares, RowSink};
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
                if !(value.is_finite() && value >= 0.0) {
                    return Err(Error::OutOfRange {
                        what: "a standard deviation of the noise".into(),
                        value,
                        expected: "a number not below zero",
                    });
                }
            }
        }
        // noise of nothing weighs nothing: the same as none
        let noise = noise.filter(|n| n.seat_mm > 0.0 || n.encoder_rad.iter().any(|&s| s > 0.0));
        Ok(Problem {
            arm,
            noise,
            groups: vec![],
        })
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
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::OutOfRange {
                    what: format!("a length of artefact {name}, mm,"),
                    value,
                    expected: "a positive number",
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
            if !value.is_finite() {
                return Err(Error::NotFinite {
                    what: format!("a coordinate of artefact {}", features.name),
                    value,
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
            return Err(Error::Shape {
                what: format!("the {what}"),
                got: angles.len(),
                expected,
            });
        }
        match angles.iter().find(|v| !v.is_finite()) {
            Some(&value) => Err(Error::NotFinite {
                what: format!("an angle of the {what}"),
                value,
            }),
            None => Ok(()),
        }
    }

    fn check_probes(&self, probe: &[usize], rows: usize) -> Result<()> {
        if probe.len() != rows {
            return Err(Error::Shape {
                what: "the probe indices".into(),
                got: probe.len(),
                expected: rows,
            });
        }
        let count = self.arm.probes().len();
        match probe.iter().find(|&&p| p >= count) {
            Some(&p) => Err(Error::NoSuch {
                what: "probe",
                index: p as i64,
                count,
            }),
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
        Problem {
            arm: self.arm.clone(),
            noise: self.noise.clone(),
            groups,
        }
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
        let probes = 0..self.arm.probes().len();
        probes.map(|p| self.arm.reach_mm(p)).fold(f64::MIN_POSITIVE, f64::max)
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

    /// Weighs the readings for the stated noise at some parameters.
    pub fn weigh(&mut self, parameters: &[f64]) {
        let mut model = Model::new(&self.arm);
        model.set_parameters(parameters);
        for group in &mut self.groups {
            group.weigh(&model, self.noise.as_ref());
        }
    }
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

/// The free parameters of a problem as unknowns of a least-squares problem.
pub struct Assembly<'a> {
    problem: &'a Problem,
    monitor: &'a dyn Monitor,
    /// indices of the free parameters
    free: Vec<usize>,
    parameters: Vec<f64>,
    model: Model,
    unknowns: Vec<Unknowns>,
    considered: usize,
    natural_scale: Vec<f64>,
    negligible_cost: f64,
    gauge: Option<ScaleGauge>,
    buffers: Buffers,
}

/// Keeps the size of an arm whose readings know no length: one more equation along the direction of growth.
struct ScaleGauge {
    /// unit vector over the unknowns
    direction: Vec<f64>,
    start: Vec<f64>,
    weight: f64,
}

impl<'a> Assembly<'a> {
    /// With the free parameters given by index. The readings must have been weighed.
    pub fn new(problem: &'a Problem, free: &[usize], monitor: &'a dyn Monitor) -> Assembly<'a> {
        let units = problem.arm.parameter_units();
        let reach = problem.reach_mm();
        let mut of_parameter = vec![None; problem.arm.parameter_count()];
        for (unknown, &parameter) in free.iter().enumerate() {
            of_parameter[parameter] = Some(unknown);
        }
        let mut considered = 0;
        let group_unknowns = |group: &Box<dyn Readings>| {
            let first = free.len() + considered;
            considered += group.considered().len();
            Unknowns {
                parameters: of_parameter.clone(),
                considered: (first..free.len() + considered).map(Some).collect(),
            }
        };
        let unknowns = problem.groups.iter().map(group_unknowns).collect();
        let weight_squared: f64 = problem.groups.iter().map(|g| g.weight_squared_sum()).sum();
        let rounding = 32.0 * f64::EPSILON * reach;
        let start = problem.arm.parameters();
        Assembly {
            problem,
            monitor,
            natural_scale: free
                .iter()
                .map(|&j| if units[j] == Unit::Rad { reach } else { 1.0 })
                .collect(),
            gauge: scale_direction(problem, free).map(|direction| ScaleGauge {
                direction,
                start: free.iter().map(|&j| start[j]).collect(),
                weight: weight_squared.sqrt(),
            }),
            free: free.to_vec(),
            model: Model::new(&problem.arm),
            parameters: start,
            unknowns,
            considered,
            negligible_cost: weight_squared * rounding * rounding,
            buffers: Buffers::default(),
        }
    }

    /// The readings' own equations at `x`, the considered dimensions as further unknowns behind the free ones.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn considered_rows(&mut self, x: &[f64], sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, true, true, sink)
    }

    /// Number of considered dimensions.
    pub fn considered(&self) -> usize {
        self.considered
    }

    /// Unit direction over the unknowns in which the arm only grows, where the readings know no length.
    pub fn scale_direction(&self) -> Option<&[f64]> {
        self.gauge.as_ref().map(|g| g.direction.as_slice())
    }

    fn stream(&mut self, x: &[f64], jacobian: bool, considered: bool, sink: &mut dyn RowSink) -> Result<()> {
        for (&j, &value) in self.free.iter().zip(x) {
            self.parameters[j] = value;
        }
        self.model.set_parameters(&self.parameters);
        // joints and tips, considered dimensions, residual, placement
        let columns = self.parameters.len() + self.considered + 1 + 6;
        let mut out = Writer::new(&mut self.buffers, columns, &self.model, sink, self.monitor);
        let mut streamed = Ok(());
        for (group, unknowns) in self.problem.groups.iter().zip(&mut self.unknowns) {
            let kept = (!considered).then(|| std::mem::take(&mut unknowns.considered));
            unknowns.considered.resize(group.considered().len(), None);
            streamed = group.stream(&self.model, unknowns, jacobian, &mut out);
            if let Some(kept) = kept {
                unknowns.considered = kept;
            }
            if streamed.is_err() {
                break;
            }
        }
        let finished = out.finish(&mut self.buffers);
        streamed.and(finished)
    }
}

/// The direction in which all lengths grow, over the unknowns: where no reading knows a length and none is held.
fn scale_direction(problem: &Problem, free: &[usize]) -> Option<Vec<f64>> {
    if !problem.scale_free() || problem.groups.is_empty() {
        return None;
    }
    let units = problem.arm.parameter_units();
    let values = problem.arm.parameters();
    let used = problem.probes_used();
    let joints = problem.arm.joint_parameter_count();
    let matters = |j: usize| j < joints || used[(j - joints) / 3];
    // d_1 only lifts the base and so does not hold the size
    let holds = |j: &usize| units[*j] == Unit::Mm && matters(*j) && *j != 3 && values[*j] != 0.0 && !free.contains(j);
    if (0..values.len()).any(|j| holds(&j)) {
        return None;
    }
    let grows = |&j: &usize| if units[j] == Unit::Mm && matters(j) && j != 3 { values[j] } else { 0.0 };
    let lengths = nalgebra::DVector::from_iterator(free.len(), free.iter().map(grows));
    let norm = lengths.norm();
    (norm > 0.0).then(|| (lengths / norm).as_slice().to_vec())
}

impl LeastSquares for Assembly<'_> {
    fn unknowns(&self) -> usize {
        self.free.len()
    }

    fn natural_scale(&self) -> &[f64] {
        &self.natural_scale
    }

    fn negligible_cost(&self) -> f64 {
        self.negligible_cost
    }

    fn rows(&mut self, x: &[f64], jacobian: bool, sink: &mut dyn RowSink) -> Result<()> {
        self.stream(x, jacobian, false, sink)?;
        if let Some(gauge) = &self.gauge {
            let moved = x.iter().zip(&gauge.start).zip(&gauge.direction);
            let residual: f64 = moved.map(|((x, start), d)| (x - start) * d).sum();
            let columns = gauge.direction.len() + 1;
            let mut block = single_row(gauge.direction.iter().chain([&residual]).map(|v| v * gauge.weight), columns);
            if !jacobian {
                block.targets.clear();
            }
            sink.fold(&mut block);
        }
        Ok(())
    }
}

/// A block of one equation, its last column the residual.
fn single_row(values: impl Iterator<Item = f64>, columns: usize) -> crate::solver::RowBlock {
    let mut block = crate::solver::RowBlock {
        columns: crate::kinematics::batch::Columns::zeros(columns, 1),
        rows: crate::kinematics::lanes::PAD,
        targets: (0..columns - 1).map(|c| (c, c)).collect(),
        residual: columns - 1,
    };
    for (column, value) in values.enumerate() {
        block.columns.column_mut(column)[0] = value;
    }
    block
}

/// A tip's distance from the last axis, mm.
pub(crate) fn off_axis_mm(tip_mm: [f64; 3]) -> f64 {
    Vector3::from(tip_mm).xy().norm()
}
