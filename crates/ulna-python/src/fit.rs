//! `ulna._core.fit`, `identify`, `costs`, `whitened_rows`, `rows_of_fit`, `held_sensitivity` and `recalibrate`.

use crate::arm::Arm;
use crate::arrays::{array1, array2, indices, rows, slice};
use crate::errors::{UlnaError, raise};
use crate::fitted::{Fitted, Identifiability};
use crate::problem::Problem;
use crate::watch::Watch;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use ulna::fit::calibrate::{self, Options, Start};
use ulna::fit::monte_carlo::{self, Repeat};
use ulna::identify::identifiability::Known;

/// Indices of the parameters that are not held.
pub(crate) fn free(problem: &Problem, hold: &PyReadonlyArray1<'_, bool>) -> PyResult<Vec<usize>> {
    let hold = slice(hold);
    let expected = problem.inner.parameter_count();
    if hold.len() != expected {
        let message = format!("hold has {} values, expected one for each of {expected} parameters", hold.len());
        return Err(UlnaError::new_err(message));
    }
    Ok((0..expected).filter(|&j| !hold[j]).collect())
}

/// Runs work of the core without the GIL; an exception raised while watching wins over the core's own error.
fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Watch) -> ulna::Result<T> + Send,
) -> PyResult<T> {
    let watch = Watch::new(progress);
    match py.detach(|| work(&watch)) {
        Ok(done) => Ok(done),
        Err(error) => Err(watch.failure().unwrap_or_else(|| raise(error))),
    }
}

/// Calibrates.
#[pyfunction]
#[pyo3(signature = (problem, hold, start="given", max_iterations=200, seed=0, search_starts=2000,
                    known_length_mm=1.0, known_angle_rad=0.01, progress=None, unknown_signs=None,
                    from_parameters=None, poor_above_mm=None))]
#[allow(clippy::too_many_arguments)]
pub fn fit(
    py: Python<'_>,
    mut problem: PyRefMut<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
    start: &str,
    max_iterations: usize,
    seed: u64,
    search_starts: usize,
    known_length_mm: f64,
    known_angle_rad: f64,
    progress: Option<Py<PyAny>>,
    unknown_signs: Option<PyReadonlyArray1<'_, bool>>,
    from_parameters: Option<PyReadonlyArray1<'_, f64>>,
    poor_above_mm: Option<f64>,
) -> PyResult<Fitted> {
    let free = free(&problem, &hold)?;
    let options = Options {
        start: match start {
            "given" => Start::Given,
            "search" => Start::Search,
            other => {
                let message = format!("start {other:?}: expected \"given\" or \"search\"");
                return Err(UlnaError::new_err(message));
            }
        },
        max_iterations,
        seed,
        search_starts,
        unknown_signs: unknown_signs.map_or(Ok(0), |mask| bits(&slice(&mask), &problem))?,
        known: Known { length_mm: known_length_mm, angle_rad: known_angle_rad },
        poor_above_mm,
    };
    let inner = &mut problem.inner;
    let from = from_parameters.as_ref().map(slice);
    let inner = watched(py, progress, |watch| calibrate::fit_from(inner, &free, from.as_deref(), &options, watch))?;
    Ok(Fitted { inner })
}

/// A mask of joints as bits.
fn bits(mask: &[bool], problem: &Problem) -> PyResult<u64> {
    let expected = problem.inner.arm().encoders();
    if mask.len() != expected || expected > 64 {
        let message = format!("unknown_signs has {} values, expected one for each of {expected} joints", mask.len());
        return Err(UlnaError::new_err(message));
    }
    Ok(mask.iter().enumerate().map(|(i, &unknown)| u64::from(unknown) << i).sum())
}

/// The sum of squares, every reading weighing alike, at many sets of the free parameters.
#[pyfunction]
pub fn costs<'py>(
    py: Python<'py>,
    mut problem: PyRefMut<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
    parameters: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let free = free(&problem, &hold)?;
    let sets = rows(&parameters, free.len(), "the sets of free parameters")?;
    let inner = &mut problem.inner;
    let costs = watched(py, None, |watch| calibrate::costs(inner, &free, &sets, watch))?;
    Ok(array1(py, &costs))
}

/// What these readings can and cannot determine at the problem's own arm, without fitting.
#[pyfunction]
#[pyo3(signature = (problem, hold, known_length_mm=1.0, known_angle_rad=0.01))]
pub fn identify(
    py: Python<'_>,
    mut problem: PyRefMut<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
    known_length_mm: f64,
    known_angle_rad: f64,
) -> PyResult<Identifiability> {
    let free = free(&problem, &hold)?;
    let known = Known { length_mm: known_length_mm, angle_rad: known_angle_rad };
    let inner = &mut problem.inner;
    let inner = watched(py, None, |watch| calibrate::identify(inner, &free, known, watch))?;
    Ok(Identifiability { inner })
}

/// Rows of the whitened Jacobian of which a placement explains nothing.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn whitened_rows<'py>(
    py: Python<'py>,
    mut problem: PyRefMut<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<i64>>)> {
    let free = free(&problem, &hold)?;
    let inner = &mut problem.inner;
    let found = watched(py, None, |watch| ulna::problem::whitened_rows(inner, &free, watch))?;
    let standing = PyArray1::from_iter(py, found.standing.iter().map(|&number| i64::from(number)));
    Ok((array2(py, found.rows, free.len())?, standing))
}

/// The same where a fit ended, weighed as it weighed them, with their residuals.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn rows_of_fit<'py>(
    py: Python<'py>,
    problem: PyRef<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
    fitted: &Fitted,
) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<i64>>)> {
    let free = free(&problem, &hold)?;
    let (inner, parameters) = (&problem.inner, &fitted.inner.solution.parameters);
    let found = watched(py, None, |watch| ulna::problem::rows_at(inner, &free, parameters, watch))?;
    let standing = PyArray1::from_iter(py, found.standing.iter().map(|&number| i64::from(number)));
    Ok((array2(py, found.rows, free.len())?, PyArray1::from_vec(py, found.residuals), standing))
}

/// How the free parameters follow held ones.
#[pyfunction]
pub fn held_sensitivity<'py>(
    py: Python<'py>,
    problem: PyRef<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
    fitted: &Fitted,
    held: PyReadonlyArray1<'_, i64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let free = free(&problem, &hold)?;
    let held = indices(&held, "parameter")?;
    let count = problem.inner.parameter_count();
    if let Some(wrong) = held.iter().find(|&&h| h >= count || free.contains(&h)) {
        return Err(UlnaError::new_err(format!("parameter {wrong} is not held")));
    }
    let (inner, solution) = (&problem.inner, &fitted.inner.solution);
    let sensitivity = watched(py, None, |watch| {
        calibrate::held_sensitivity(inner, &free, &solution.pins, &solution.parameters, &held, watch)
    })?;
    array2(py, sensitivity, held.len())
}

/// Calibrations repeated on new noise.
#[pyfunction]
#[pyo3(signature = (problem, hold, truth, runs, seed=0, threads=1, progress=None, uncertainties=true, first=0))]
#[allow(clippy::too_many_arguments, clippy::type_complexity)]
pub fn recalibrate<'py>(
    py: Python<'py>,
    problem: PyRef<'_, Problem>,
    hold: PyReadonlyArray1<'_, bool>,
    truth: &Arm,
    runs: usize,
    seed: u64,
    threads: usize,
    progress: Option<Py<PyAny>>,
    uncertainties: bool,
    first: usize,
) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<bool>>)> {
    let free = free(&problem, &hold)?;
    let inner = &problem.inner;
    let truth = &truth.inner;
    let done = watched(py, progress, |watch| {
        let repeat = Repeat { truth, first, runs, seed, threads, uncertainties };
        monte_carlo::recalibrate(inner, &free, &repeat, watch)
    })?;
    let count = inner.parameter_count();
    let parameters = done.iter().flat_map(|run| run.parameters.iter().copied()).collect();
    let u = done.iter().flat_map(|run| run.u.iter().copied()).collect();
    let converged = done.iter().map(|run| run.converged);
    Ok((array2(py, parameters, count)?, array2(py, u, count)?, PyArray1::from_iter(py, converged)))
}
