//! `ulna._core.Problem`.

use crate::arm::Arm;
use crate::arrays::{Told, array1, indices, rows, slice};
use crate::errors::{UlnaError, raise};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use ulna::artefacts::{Frame, KINDS, Noise, Rows, Size, Stated};
use ulna::kinematics::Angles;
use ulna::problem::priors::Prior;
use ulna::solver::losses::Loss;

/// Readings of features of placed artefacts, to be explained by one arm.
#[pyclass(module = "ulna._core")]
pub struct Problem {
    pub inner: ulna::problem::Problem,
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (arm, encoder_u_rad=None, seat_u_mm=None))]
    fn new(arm: &Arm, encoder_u_rad: Option<PyReadonlyArray1<'_, f64>>, seat_u_mm: Option<f64>) -> PyResult<Problem> {
        let noise = (encoder_u_rad.is_some() || seat_u_mm.is_some()).then(|| Noise {
            encoder_rad: encoder_u_rad.map(|u| slice(&u).into_owned()).unwrap_or_default(),
            seat_mm: seat_u_mm.unwrap_or(0.0),
        });
        let inner = ulna::problem::Problem::new(arm.inner.clone(), noise).map_err(raise)?;
        Ok(Problem { inner })
    }

    #[pyo3(signature = (kind, artefact, *, q_rad, probe, placement=None, feature=None, p_rad=None, measured_mm=None,
                        features_mm=None, labels=None, feature_u_mm=None, features_fitted=false, frame=None,
                        dimensions=vec![], inside=false, balls_mm=None, rotation_rad=None, rotation_u_rad=None,
                        warmth_k=None, approach=None, p_approach=None,
                        payload=None))]
    #[allow(clippy::too_many_arguments)]
    fn add(
        &mut self,
        kind: &str,
        artefact: &str,
        q_rad: PyReadonlyArray2<'_, f64>,
        probe: PyReadonlyArray1<'_, i64>,
        placement: Option<PyReadonlyArray1<'_, i64>>,
        feature: Option<PyReadonlyArray1<'_, i64>>,
        p_rad: Option<PyReadonlyArray2<'_, f64>>,
        measured_mm: Option<PyReadonlyArray1<'_, f64>>,
        features_mm: Option<PyReadonlyArray2<'_, f64>>,
        labels: Option<Vec<String>>,
        feature_u_mm: Option<PyReadonlyArray1<'_, f64>>,
        features_fitted: bool,
        frame: Option<&str>,
        dimensions: Vec<(String, f64, f64, bool)>,
        inside: bool,
        balls_mm: Option<PyReadonlyArray1<'_, f64>>,
        rotation_rad: Option<PyReadonlyArray2<'_, f64>>,
        rotation_u_rad: Option<PyReadonlyArray1<'_, f64>>,
        warmth_k: Option<PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<PyReadonlyArrayDyn<'_, f64>>,
        p_approach: Option<PyReadonlyArrayDyn<'_, f64>>,
        payload: Option<PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<usize> {
        let n = self.inner.arm().encoders();
        let q_rad = rows(&q_rad, n, "the poses")?;
        let p_rad = p_rad.as_ref().map(|p_rad| rows(p_rad, n, "the second poses")).transpose()?;
        let feature = feature.as_ref().map(|feature| indices(feature, "feature")).transpose()?;
        let features = features_mm.as_ref().map(|features| rows(features, 3, "the features")).transpose()?;
        let features = features.as_ref().map(|features| features.as_chunks::<3>().0);
        let (placement, measured_mm) = (placement.as_ref().map(slice), measured_mm.as_ref().map(slice));
        let rotation = rotation_rad.as_ref().map(|rotation| rows(rotation, 3, "the orientations")).transpose()?;
        let rotation_u_rad = rotation_u_rad.as_ref().map(slice);
        let (feature_u_mm, balls_mm) = (feature_u_mm.as_ref().map(slice), balls_mm.as_ref().map(slice));
        let mut sizes = Vec::with_capacity(dimensions.len());
        for (name, value, u, fitted) in &dimensions {
            sizes.push(Size { name, value: *value, u: *u, fitted: *fitted });
        }
        let stated = Stated {
            name: artefact,
            dimensions: &sizes,
            features_mm: features,
            labels: labels.as_deref(),
            feature_u_mm: feature_u_mm.as_deref(),
            features_fitted,
            frame: frame.map(|frame| frame_of(frame, artefact)).transpose()?,
            inside,
            balls_mm: balls_mm.as_deref(),
        };
        let told = Told::new(warmth_k.as_ref(), approach.as_ref(), payload.as_ref(), q_rad.len() / n, n)?;
        let second = p_rad.as_ref().map(|p_rad| {
            let told = Told::new(warmth_k.as_ref(), p_approach.as_ref(), payload.as_ref(), p_rad.len() / n, n)?;
            PyResult::Ok((p_rad, told))
        });
        let second = second.transpose()?;
        let rows = Rows {
            poses: Angles { q_rad: &q_rad, conditions: told.conditions() },
            probe: &indices(&probe, "probe")?,
            second: second.as_ref().map(|(q_rad, told)| Angles { q_rad, conditions: told.conditions() }),
            feature: feature.as_deref(),
            placement: placement.as_deref(),
            measured_mm: measured_mm.as_deref(),
            rotation_rad: rotation.as_ref().map(|each| each.as_chunks::<3>().0),
            rotation_u_rad: rotation_u_rad.as_deref(),
        };
        self.inner.add(kind, &stated, &rows).map_err(raise)
    }

    fn add_prior(&mut self, parameter: usize, value: f64, u: f64) -> PyResult<()> {
        self.inner.add_prior(Prior { parameter, value, u }).map_err(raise)
    }

    fn set_loss(&mut self, name: &str) -> PyResult<()> {
        let loss = match name {
            "none" => None,
            other => Some(Loss::named(other).ok_or_else(|| {
                UlnaError::new_err(format!("loss {other:?}: expected \"none\", \"huber\", \"cauchy\" or \"tukey\""))
            })?),
        };
        self.inner.set_loss(loss);
        Ok(())
    }

    #[getter]
    fn arm(&self) -> Arm {
        Arm { inner: self.inner.arm().clone() }
    }

    #[getter]
    fn parameter_names(&self) -> Vec<String> {
        self.inner.parameter_names()
    }

    #[getter]
    fn parameter_units(&self) -> Vec<&'static str> {
        self.inner.parameter_units().into_iter().map(|u| u.as_str()).collect()
    }

    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(py, &self.inner.parameters())
    }

    fn with_arm(&self, arm: &Arm) -> PyResult<Problem> {
        if arm.inner.parameter_names() != self.inner.arm().parameter_names() {
            return Err(UlnaError::new_err("the other arm has other joints or probes"));
        }
        let mut inner = self.inner.clone();
        inner.set_arm(arm.inner.clone());
        Ok(Problem { inner })
    }
}

fn frame_of(frame: &str, artefact: &str) -> PyResult<Frame> {
    match frame {
        "free" => Ok(Frame::Free),
        "arm" => Ok(Frame::Arm),
        other => {
            let message = format!("frame {other:?} of artefact {artefact}: expected \"free\" or \"arm\"");
            Err(UlnaError::new_err(message))
        }
    }
}

/// The kinds of artefacts that [`Problem::add`] knows.
#[pyfunction]
pub fn kinds(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for kind in KINDS {
        let one = PyDict::new(py);
        one.set_item("needs", kind.needs.iter().map(|column| column.name()).collect::<Vec<_>>())?;
        one.set_item("takes", kind.takes.iter().map(|column| column.name()).collect::<Vec<_>>())?;
        let dimensions = PyDict::new(py);
        for asked in kind.dimensions {
            dimensions.set_item(asked.name, (asked.unit.as_str(), asked.needed))?;
        }
        one.set_item("dimensions", dimensions)?;
        all.set_item(kind.name, one)?;
    }
    Ok(all)
}
