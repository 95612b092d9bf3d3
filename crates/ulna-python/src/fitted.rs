//! `ulna._core.Fitted` and `Identifiability`: what a fit found.

use crate::arm::Arm;
use crate::arrays::{array1, array2};
use crate::errors::UlnaError;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use ulna::artefacts::Unweighted;
use ulna::fit::calibrate::{self, SearchReason, Undecided};

/// What readings can and cannot determine.
#[pyclass(frozen, module = "ulna._core")]
#[derive(Clone)]
pub struct Identifiability {
    pub inner: ulna::identify::identifiability::Identifiability,
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
        let one = |lost: &ulna::identify::identifiability::LostDirection| {
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
        let one = |weak: &ulna::identify::identifiability::WeakDirection| {
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

    #[getter(from_prior)]
    fn known_from_prior(&self) -> Vec<String> {
        self.inner.from_prior.clone()
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
    pub inner: calibrate::Fitted,
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
    fn names(&self) -> Vec<String> {
        self.inner.names.clone()
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
    fn degrees_of_freedom(&self) -> f64 {
        self.inner.degrees_of_freedom
    }

    /// Of a whitened residual, by which the covariance was made.
    #[getter]
    fn variance(&self) -> f64 {
        self.inner.variance
    }

    /// Whether that was estimated from the residuals.
    #[getter]
    fn estimated(&self) -> bool {
        self.inner.estimated
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
            Some(SearchReason::Unexplained) => "unexplained",
            Some(SearchReason::OffScale) => "off-scale",
        }
    }

    /// Joints, counted from 1.
    #[getter]
    fn undecided_signs(&self) -> Vec<Vec<usize>> {
        self.inner.solution.undecided_signs.iter().map(from_one).collect()
    }

    /// Those of them with which the arm is the mirror image of what was found.
    #[getter]
    fn mirrored_signs(&self) -> Vec<Vec<usize>> {
        self.inner.solution.undecided_signs.iter().filter(|set| set.mirrored).map(from_one).collect()
    }

    #[getter]
    fn folded(&self) -> Vec<String> {
        self.inner.folded.clone()
    }

    #[getter]
    fn common_factor(&self) -> Option<f64> {
        self.inner.common_factor.map(|common| common.factor)
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

    #[getter]
    fn priors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let each = self.inner.priors.iter().flat_map(|prior| prior.map_or([f64::NAN; 2], |(value, u)| [value, u]));
        array2(py, each.collect(), 2)
    }

    #[getter]
    fn scales(&self) -> Vec<f64> {
        self.inner.standing.scales.clone()
    }

    fn lengths<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Self::group(&self.inner.residuals, group)?;
        Ok(array1(py, &self.inner.standing.lengths[group]))
    }

    fn outliers<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Bound<'py, PyArray1<bool>>> {
        Self::group(&self.inner.residuals, group)?;
        Ok(PyArray1::from_iter(py, self.inner.standing.outliers_of(group)))
    }

    fn counted<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        Self::group(&self.inner.residuals, group)?;
        Ok(self.inner.counted.as_ref().map(|counted| array1(py, &counted[group])))
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

fn from_one(set: &Undecided) -> Vec<usize> {
    set.joints.iter().map(|joint| joint + 1).collect()
}
