//! `ulna._core.fit`, `identify`, `recalibrate` and what they return.

use crate::arm::Arm;
use crate::arrays::{array1, array2, indices, slice};
use crate::errors::{UlnaError, raise};
use crate::problem::Problem;
use crate::watch::Watch;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use ulna::calibrate::{self, Options, SearchReason, Start};
use ulna::identifiability::Known;
use ulna::monte_carlo::{self, Repeat};
use ulna::residuals::Unweighted;

/// What readings can and cannot determine.
#[pyclass(frozen, module = "ulna._core")]
#[derive(Clone)]
pub struct Identifiability {
    inner: ulna::identifiability::Identifiability,
}

fn weights<'py>(py: Python<'py>, combination: &[(String, f64)]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, weight) in combination {
        dict.set_item(name, weight)?;
    }
    Ok(dict)
}

#[pymethods]
impl Identifiability {
    #[getter]
    fn parameters(&self) -> usize {
        self.inner.names.len()
    }

    #[getter]
    fn determined(&self) -> usize {
        self.inner.determined
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.inner.names.clone()
    }

    #[getter]
    fn singular_values(&self) -> Vec<f64> {
        self.inner.singular_values.clone()
    }

    #[getter]
    fn condition(&self) -> f64 {
        self.inner.condition
    }

    #[getter]
    fn lost<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |lost: &ulna::identifiability::LostDirection| {
            let dict = PyDict::new(py);
            dict.set_item("combination", weights(py, &lost.combination)?)?;
            dict.set_item("cause", lost.because.cause.as_str())?;
            dict.set_item("because", &lost.because.because)?;
            dict.set_item("remedy", &lost.because.remedy)?;
            dict.set_item("frame", lost.because.is_frame())?;
            Ok(dict)
        };
        self.inner.lost.iter().map(one).collect()
    }

    #[getter]
    fn weak<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |weak: &ulna::identifiability::WeakDirection| {
            let dict = PyDict::new(py);
            dict.set_item("combination", weights(py, &weak.combination)?)?;
            dict.set_item("u", weak.u)?;
            dict.set_item("unit", weak.unit.as_str())?;
            dict.set_item("because", &weak.because)?;
            dict.set_item("remedy", &weak.remedy)?;
            Ok(dict)
        };
        self.inner.weak.iter().map(one).collect()
    }

    #[getter]
    fn not_determined(&self) -> Vec<String> {
        let named = self.inner.names.iter().zip(&self.inner.in_lost);
        named.filter(|(_, lost)| **lost).map(|(name, _)| name.clone()).collect()
    }
}

/// What a fit found and how it ended.
#[pyclass(frozen, module = "ulna._core")]
pub struct Fitted {
    inner: calibrate::Fitted,
}

impl Fitted {
    fn group(groups: &[Unweighted], group: usize) -> PyResult<&Unweighted> {
        let missing = || UlnaError::new_err(format!("group {group} does not exist; there are {}", groups.len()));
        groups.get(group).ok_or_else(missing)
    }
}

#[pymethods]
impl Fitted {
    #[getter]
    fn arm(&self) -> Arm {
        Arm { inner: self.inner.arm.clone() }
    }

    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(py, &self.inner.start)
    }

    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(py, &self.inner.solution.parameters)
    }

    #[getter]
    fn termination(&self) -> &'static str {
        self.inner.solution.report.termination.as_str()
    }

    #[getter]
    fn converged(&self) -> bool {
        self.inner.solution.report.termination.converged()
    }

    #[getter]
    fn iterations(&self) -> usize {
        self.inner.solution.report.iterations
    }

    #[getter]
    fn evaluations(&self) -> usize {
        self.inner.solution.report.evaluations
    }

    #[getter]
    fn cost_start(&self) -> f64 {
        self.inner.solution.report.cost_start
    }

    #[getter]
    fn cost(&self) -> f64 {
        self.inner.solution.report.cost
    }

    #[getter]
    fn rms_start_mm(&self) -> f64 {
        self.inner.rms_start_mm
    }

    #[getter]
    fn rms_mm(&self) -> f64 {
        self.inner.rms_mm
    }

    #[getter]
    fn observations(&self) -> usize {
        self.inner.observations
    }

    #[getter]
    fn placement_unknowns(&self) -> usize {
        self.inner.placement_unknowns
    }

    #[getter]
    fn degrees_of_freedom(&self) -> usize {
        self.inner.degrees_of_freedom
    }

    #[getter]
    fn chi2_per_dof(&self) -> Option<f64> {
        self.inner.chi2_per_dof
    }

    #[getter]
    fn searched_starts(&self) -> usize {
        self.inner.solution.searched_starts
    }

    #[getter]
    fn search_reason(&self) -> &'static str {
        match self.inner.solution.search_reason {
            None => "",
            Some(SearchReason::Asked) => "asked",
            Some(SearchReason::PoorMinimum) => "poor-minimum",
        }
    }

    #[getter]
    fn folded(&self) -> Vec<String> {
        self.inner.folded.clone()
    }

    #[getter]
    fn identifiability(&self) -> Identifiability {
        Identifiability { inner: self.inner.identifiability.clone() }
    }

    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(py, self.inner.covariance.clone(), self.inner.free.len())
    }

    #[getter]
    fn covariance_columns<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        PyArray1::from_iter(py, self.inner.free.iter().map(|&j| j as i64))
    }

    fn residuals<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let group = Self::group(&self.inner.residuals, group)?;
        array2(py, group.residuals_mm.clone(), group.components)
    }

    fn residuals_start<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let group = Self::group(&self.inner.residuals_start, group)?;
        array2(py, group.residuals_mm.clone(), group.components)
    }

    fn weights<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(array1(py, &Self::group(&self.inner.residuals, group)?.weights))
    }
}

/// Indices of the parameters that are not held.
fn free(problem: &Problem, hold: &PyReadonlyArray1<'_, bool>) -> PyResult<Vec<usize>> {
    let hold = slice(hold);
    let expected = problem.inner.arm().parameter_count();
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
                    known_length_mm=1.0, known_angle_rad=0.01, progress=None))]
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
        known: Known { length_mm: known_length_mm, angle_rad: known_angle_rad },
    };
    let inner = &mut problem.inner;
    let inner = watched(py, progress, |watch| calibrate::fit(inner, &free, &options, watch))?;
    Ok(Fitted { inner })
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
    let count = problem.inner.arm().parameter_count();
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
#[pyo3(signature = (problem, hold, truth, runs, seed=0, threads=1, progress=None, uncertainties=true))]
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
) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<bool>>)> {
    let free = free(&problem, &hold)?;
    let inner = &problem.inner;
    let truth = &truth.inner;
    let done = watched(py, progress, |watch| {
        let repeat = Repeat { truth, runs, seed, threads, uncertainties };
        monte_carlo::recalibrate(inner, &free, &repeat, watch)
    })?;
    let count = inner.arm().parameter_count();
    let parameters = done.iter().flat_map(|run| run.parameters.iter().copied()).collect();
    let u = done.iter().flat_map(|run| run.u.iter().copied()).collect();
    let converged = done.iter().map(|run| run.converged);
    Ok((array2(py, parameters, count)?, array2(py, u, count)?, PyArray1::from_iter(py, converged)))
}
