//! `ulna._core.Running` and `gains`.

use crate::arrays::{array1, array2, rows, slice};
use crate::errors::{UlnaError, raise};
use crate::fit::free;
use crate::problem::Problem;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use ulna::design::{self, Candidates};
use ulna::fit::running;
use ulna::identify::identifiability::Known;
use ulna::monitor::Unwatched;

/// What is known while readings still come.
#[pyclass(module = "ulna._core")]
pub struct Running {
    inner: running::Running,
}

#[pymethods]
impl Running {
    #[new]
    #[pyo3(signature = (problem, hold, parameters=None, sigma=None))]
    fn new(
        py: Python<'_>,
        problem: PyRef<'_, Problem>,
        hold: PyReadonlyArray1<'_, bool>,
        parameters: Option<PyReadonlyArray1<'_, f64>>,
        sigma: Option<f64>,
    ) -> PyResult<Running> {
        let free = free(&problem, &hold)?;
        let own = problem.inner.parameters();
        let parameters = parameters.as_ref().map_or(own.clone(), |given| slice(given).into_owned());
        if parameters.len() != own.len() {
            let message = format!("parameters has {} values, expected {}", parameters.len(), own.len());
            return Err(UlnaError::new_err(message));
        }
        let problem = &problem.inner;
        let inner = py.detach(|| running::Running::new(problem, &free, &parameters, sigma, &Unwatched));
        Ok(Running { inner: inner.map_err(raise)? })
    }

    #[getter]
    fn leaves(&self) -> usize {
        self.inner.leaves()
    }

    fn put(&mut self, py: Python<'_>, leaf: usize, group: usize, readings: PyRef<'_, Problem>) -> PyResult<bool> {
        let [readings] = readings.inner.groups() else {
            return Err(UlnaError::new_err("the readings of one standing are one group"));
        };
        let inner = &mut self.inner;
        py.detach(|| inner.put(leaf, group, readings.as_ref(), &Unwatched)).map_err(raise)
    }

    fn empty(&mut self, leaf: usize) {
        self.inner.empty(leaf);
    }

    #[allow(clippy::type_complexity)]
    fn so_far<'py>(
        &mut self,
        py: Python<'py>,
    ) -> PyResult<(usize, Bound<'py, PyArray1<bool>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>)> {
        let inner = &mut self.inner;
        let found = py.detach(|| inner.so_far());
        let covariance = array2(py, found.covariance, found.step.len())?;
        Ok((found.determined, PyArray1::from_vec(py, found.lost), covariance, array1(py, &found.step)))
    }

    #[pyo3(signature = (known_length_mm, known_angle_rad, without=None))]
    #[allow(clippy::type_complexity)]
    fn with_drawing<'py>(
        &mut self,
        py: Python<'py>,
        known_length_mm: f64,
        known_angle_rad: f64,
        without: Option<usize>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>)> {
        let inner = &mut self.inner;
        let known = Known { length_mm: known_length_mm, angle_rad: known_angle_rad };
        let found = py.detach(|| inner.with_drawing(known, without));
        let count = self.inner.free().len();
        Ok((array2(py, found.covariance, count)?, array2(py, found.triangle, count)?))
    }
}

/// By how much each candidate would lower the mean variance of what is asked for.
#[pyfunction]
pub fn gains<'py>(
    py: Python<'py>,
    candidates: PyReadonlyArray3<'py, f64>,
    triangle: PyReadonlyArray2<'py, f64>,
    directions: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (each, unknowns) = (candidates.shape()[1], candidates.shape()[2]);
    let numbers = candidates.as_slice().map_err(|_| UlnaError::new_err("the candidates' rows are not contiguous"))?;
    let triangle = rows(&triangle, unknowns, "the triangle of what is known")?;
    let directions = rows(&directions, unknowns, "directions")?;
    let candidates = Candidates { rows: numbers, each, unknowns };
    let gains = py.detach(|| design::gains(&candidates, &triangle, &directions)).map_err(raise)?;
    Ok(array1(py, &gains))
}
