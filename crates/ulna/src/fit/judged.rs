//! What the readings say at one set of parameters: the triangle of all rows, and what of it is determined.

use crate::error::Result;
use crate::monitor::Monitor;
use crate::problem::Problem;
use crate::problem::assembly::Assembly;
use crate::problem::pins::{Kind, Pin, Symmetry};
use crate::solver::LeastSquares;
use crate::solver::decomposition::Decomposition;
use crate::solver::triangle::Triangle;

/// What was found at one set of parameters: the triangle of all rows and its decomposition.
pub(crate) struct Judged {
    /// of the free parameters, the considered dimensions behind them
    pub triangle: Triangle,
    pub decomposition: Decomposition,
    /// what was taken out
    pub symmetries: Vec<Symmetry>,
}

pub(crate) fn judge(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    parameters: &[f64],
    monitor: &dyn Monitor,
) -> Result<Judged> {
    let (triangle, natural_scale) = triangle_at(problem, free, parameters, monitor)?;
    let (decomposition, symmetries) = decompose(problem, free, pins, parameters, &triangle, &natural_scale);
    Ok(Judged { triangle, decomposition, symmetries })
}

/// The triangle of all rows at some parameters, the considered dimensions behind the free ones; and the free ones' natural
/// scale.
pub(crate) fn triangle_at(
    problem: &Problem,
    free: &[usize],
    parameters: &[f64],
    monitor: &dyn Monitor,
) -> Result<(Triangle, Vec<f64>)> {
    let x: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, free, &[], monitor);
    let mut triangle = Triangle::new(free.len() + assembly.considered());
    assembly.considered_rows(&x, &mut triangle)?;
    Ok((triangle, assembly.natural_scale().to_vec()))
}

/// The decomposition with everything taken out that is pinned, as it is at these parameters: a symmetry goes with the
/// arm, and of a family that the start could not tell apart, what the readings see least here.
pub(crate) fn decompose(
    problem: &Problem,
    free: &[usize],
    pins: &[Pin],
    parameters: &[f64],
    triangle: &Triangle,
    natural_scale: &[f64],
) -> (Decomposition, Vec<Symmetry>) {
    let lasting = pins.iter().filter(|p| p.kind != Kind::Family);
    let mut symmetries: Vec<Symmetry> = lasting.map(|p| (p.kind, p.direction_at(problem, free, parameters))).collect();
    let with = |symmetries: &[Symmetry]| {
        let slices: Vec<&[f64]> = symmetries.iter().map(|(_, direction)| direction.as_slice()).collect();
        Decomposition::new(triangle, free.len(), natural_scale, &slices)
    };
    let seen = with(&symmetries);
    let families = pins.len() - symmetries.len();
    if families == 0 {
        return (seen, symmetries);
    }
    symmetries.extend(seen.least_seen(families).iter().map(|v| (Kind::Family, seen.physical(v))));
    (with(&symmetries), symmetries)
}
