//! Directions that no reading sees, and the equations that keep them at their start.
//!
//! Some are known beforehand: an arm whose readings know no length may grow, an arm whose artefacts stand freely may be
//! lifted along its first axis. With residuals left, their columns do not vanish (growth makes the residuals grow),
//! and a fit would follow them: all lengths to zero, if nothing held the size. Others are found at the start
//! ([`crate::identify::families`]).

use super::groups::Problem;
use crate::arm::{JointModel, Unit};
use crate::kinematics::jacobian;
use nalgebra::{DMatrix, DVector};

/// Why a direction is pinned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The whole arm grows.
    Growth,
    /// The base moves along its first axis (the turn about it is a parameter of its own and has no column at all).
    Lift,
    /// A family of parameters that describes the same readings at the start.
    Family,
}

/// A direction over the unknowns, rad and mm, that changes nothing.
pub(crate) type Symmetry = (Kind, Vec<f64>);

/// One more equation that keeps a direction at its start. Nothing opposes it, so it is met exactly, whatever the noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// Why.
    pub kind: Kind,
    /// The direction over the unknowns, rad and mm.
    pub direction: Vec<f64>,
    /// The equation's coefficients, in the unit of a weighted residual per unknown.
    pub(crate) coefficients: Vec<f64>,
    pub(crate) start: Vec<f64>,
}

impl Pin {
    /// How far `x` is from the start along the pin.
    pub(crate) fn residual(&self, x: &[f64]) -> f64 {
        let moved = x.iter().zip(&self.start).zip(&self.coefficients);
        moved.map(|((x, start), c)| (x - start) * c).sum()
    }

    /// The direction at other parameters: a symmetry's goes with the arm.
    pub(crate) fn direction_at(&self, problem: &Problem, free: &[usize], parameters: &[f64]) -> Vec<f64> {
        let here = match self.kind {
            Kind::Growth => growth(problem, free, parameters),
            Kind::Lift => lift(problem, free, parameters),
            Kind::Family => None,
        };
        here.unwrap_or_else(|| self.direction.clone())
    }
}

/// The direction in which all lengths grow, over the unknowns: where no reading knows a length and none is held.
pub(crate) fn growth(problem: &Problem, free: &[usize], values: &[f64]) -> Option<Vec<f64>> {
    // where nothing tells places every length is lost by itself
    if !problem.scale_free() || !problem.tells_places() {
        return None;
    }
    let (arm, units) = (problem.arm(), problem.arm().parameter_units());
    let used = problem.probes_used();
    let (joints, geometry) = (arm.joint_parameter_count(), arm.geometry_count());
    let matters = |j: usize| j < joints || j < geometry && used[(j - joints) / 3];
    // d_1 only lifts the base and so does not hold the size
    let mut growth: Vec<f64> = (0..values.len())
        .map(|j| if j < geometry && units[j] == Unit::Mm && matters(j) && j != 3 { values[j] } else { 0.0 })
        .collect();
    for (dimension, grows) in problem.growing_dimensions(values) {
        growth[dimension] = grows;
    }
    // a length that is held, or known beforehand, holds the size
    let priors = problem.priors();
    let known = |j: usize| !free.contains(&j) || priors.iter().any(|prior| prior.parameter == j);
    if (0..values.len()).any(|j| growth[j] != 0.0 && known(j)) {
        return None;
    }
    let lengths = nalgebra::DVector::from_iterator(free.len(), free.iter().map(|&j| growth[j]));
    let norm = lengths.norm();
    (norm > 0.0).then(|| (lengths / norm).as_slice().to_vec())
}

/// Postures at which the lift is compared with what the parameters can do.
const POSTURES: usize = 40;

/// The combination of parameters that moves the base along its first axis, where artefacts stand freely and the first
/// joint has no d of its own to do it (a Hayati joint: the offsets of the next joints do).
pub(crate) fn lift(problem: &Problem, free: &[usize], parameters: &[f64]) -> Option<Vec<f64>> {
    if !problem.base_free() || problem.arm().joints()[0].model == JointModel::Dh {
        return None;
    }
    let arm = problem.arm_at(parameters).ok()?;
    let used = problem.probes_used();
    let probes: Vec<usize> = (0..used.len()).filter(|&p| used[p]).collect();
    let natural = problem.natural_scale();
    let base = problem.base_parameters();
    let of_geometry = |c: &usize| free[*c] < arm.geometry_count() && !base.contains(&free[*c]);
    let columns: Vec<usize> = (0..free.len()).filter(of_geometry).collect();
    let priors = problem.priors();
    if columns.iter().any(|&c| priors.iter().any(|prior| prior.parameter == free[c])) {
        return None;
    }
    // the turn of the base may help: it changes nothing either
    let mut a = DMatrix::zeros(3 * POSTURES, columns.len() + 1);
    let mut b = DVector::zeros(3 * POSTURES);
    for row in 0..POSTURES {
        // any postures do that are unlike each other: multiples of an irrational part of a turn
        let angle = |i: usize| ((row * arm.encoders() + i) as f64 * 0.618_033_988_749_895).fract() * 6.0 - 3.0;
        let q_rad: Vec<f64> = (0..arm.encoders()).map(angle).collect();
        let jacobian = jacobian(&arm, probes[row % probes.len()], &q_rad);
        for (k, &c) in columns.iter().enumerate() {
            let moved = jacobian.column(free[c]) / natural[free[c]];
            a.fixed_view_mut::<3, 1>(3 * row, k).copy_from(&moved);
        }
        let turn = jacobian.column(0) / natural[0];
        a.fixed_view_mut::<3, 1>(3 * row, columns.len()).copy_from(&turn);
        b[3 * row + 2] = 1.0;
    }
    let solution = a.clone().svd(true, true).solve(&b, 1e-9).ok()?;
    if (a * &solution - &b).norm() > 1e-7 * b.norm() {
        return None;
    }
    let mut direction = vec![0.0; free.len()];
    for (k, &c) in columns.iter().enumerate() {
        direction[c] = solution[k] / natural[free[c]];
    }
    Some(direction)
}
