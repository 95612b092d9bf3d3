//! What the start cannot tell apart: families of parameters that describe the same readings there, such as the
//! directions of the last axis under a probe that lies on it.

use crate::error::Result;
use crate::monitor::Monitor;
use crate::problem::Problem;
use crate::problem::assembly::Assembly;
use crate::problem::pins::{Kind, Pin, growth, lift};
use crate::solver::LeastSquares;
use crate::solver::decomposition::Decomposition;
use crate::solver::gram::{Gram, smallest_pivot};
use crate::solver::triangle::Triangle;

/// A pivot of the unit-diagonal normal equations below this calls for a look at the singular values.
const SUSPICIOUS_PIVOT: f64 = 1e-10;

/// The directions that the readings do not determine at some parameters, to be pinned where the problem's own arm has
/// them; and the normal equations there.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn pins(problem: &Problem, free: &[usize], parameters: &[f64], monitor: &dyn Monitor) -> Result<(Vec<Pin>, Gram)> {
    let own = problem.parameters();
    let start: Vec<f64> = free.iter().map(|&j| own[j]).collect();
    let here: Vec<f64> = free.iter().map(|&j| parameters[j]).collect();
    let mut assembly = Assembly::new(problem, free, &[], monitor);
    let weights: f64 = problem.groups().iter().map(|g| g.weight_squared_sum()).sum();
    let mut pins = Vec::new();
    for (kind, direction) in
        [(Kind::Growth, growth(problem, free, parameters)), (Kind::Lift, lift(problem, free, parameters))]
    {
        let Some(direction) = direction else { continue };
        // orthogonal to the direction when unknowns are measured by what they move
        let natural = assembly.natural_scale();
        let size = direction.iter().zip(natural).map(|(d, n)| (d * n).powi(2)).sum::<f64>().sqrt();
        let coefficient = |(d, n): (&f64, &f64)| d * n * n / size * weights.sqrt();
        let coefficients = direction.iter().zip(natural).map(coefficient).collect();
        pins.push(Pin { kind, direction, coefficients, start: start.clone() });
    }
    let mut gram = Gram::new(free.len());
    assembly.rows(&here, true, &mut gram)?;
    if smallest_pivot(&gram, assembly.natural_scale()) > SUSPICIOUS_PIVOT {
        return Ok((pins, gram));
    }
    let mut triangle = Triangle::new(free.len());
    assembly.rows(&here, true, &mut triangle)?;
    let symmetries: Vec<&[f64]> = pins.iter().map(|p| p.direction.as_slice()).collect();
    let decomposition = Decomposition::new(&triangle, free.len(), assembly.natural_scale(), &symmetries);
    for vector in decomposition.null_vectors() {
        let mut pin = Pin {
            kind: Kind::Family,
            direction: vec![0.0; free.len()],
            coefficients: vec![0.0; free.len()],
            start: start.clone(),
        };
        for ((&unknown, norm), v) in decomposition.kept.iter().zip(&decomposition.norms).zip(&vector) {
            pin.direction[unknown] = v / norm;
            pin.coefficients[unknown] = v * norm;
        }
        pins.push(pin);
    }
    Ok((pins, gram))
}
