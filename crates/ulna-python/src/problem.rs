//! `ulna._core.Problem`.

use crate::arm::Arm;
use crate::arrays::{Told, array1, indices, rows, slice};
use crate::errors::{UlnaError, raise};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use std::borrow::Cow;
use ulna::artefacts::length::LengthRows;
use ulna::artefacts::points::{Features, Frame, Uncertainty};
use ulna::artefacts::surface::Side;
use ulna::artefacts::{Noise, TouchRows};
use ulna::kinematics::Angles;
use ulna::problem::BallArtefact;
use ulna::problem::priors::Prior;
use ulna::solver::losses::Loss;

/// Readings of features of placed artefacts, to be explained by one arm.
#[pyclass(module = "ulna._core")]
pub struct Problem {
    pub inner: ulna::problem::Problem,
}

/// Touches as they were handed over.
struct Touched<'a> {
    q_rad: Cow<'a, [f64]>,
    told: Told<'a>,
    probe: Vec<usize>,
    feature: Vec<usize>,
    placement: Cow<'a, [i64]>,
}

impl<'a> Touched<'a> {
    fn new(
        encoders: usize,
        q_rad: &'a PyReadonlyArray2<'_, f64>,
        (warmth_k, approach): (Option<&'a PyReadonlyArrayDyn<'_, f64>>, Option<&'a PyReadonlyArrayDyn<'_, f64>>),
        probe: &PyReadonlyArray1<'_, i64>,
        feature: Option<&PyReadonlyArray1<'_, i64>>,
        placement: &'a PyReadonlyArray1<'_, i64>,
    ) -> PyResult<Touched<'a>> {
        let q_rad = rows(q_rad, encoders, "the poses")?;
        let count = q_rad.len() / encoders;
        Ok(Touched {
            told: Told::new(warmth_k, approach, count, encoders)?,
            probe: indices(probe, "probe")?,
            feature: feature.map_or_else(|| Ok(vec![0; count]), |feature| indices(feature, "feature"))?,
            placement: slice(placement),
            q_rad,
        })
    }

    fn rows(&self) -> TouchRows<'_> {
        TouchRows {
            poses: Angles { q_rad: &self.q_rad, conditions: self.told.conditions() },
            probe: &self.probe,
            feature: &self.feature,
            placement: &self.placement,
        }
    }
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

    #[pyo3(signature = (artefact, q_rad, p_rad, probe, length_mm, length_u_mm=0.0, fitted=false, warmth_k=None,
                        approach=None, p_approach=None))]
    #[allow(clippy::too_many_arguments)]
    fn add_lengths(
        &mut self,
        artefact: &str,
        q_rad: PyReadonlyArray2<'_, f64>,
        p_rad: PyReadonlyArray2<'_, f64>,
        probe: PyReadonlyArray1<'_, i64>,
        length_mm: PyReadonlyArray1<'_, f64>,
        length_u_mm: f64,
        fitted: bool,
        warmth_k: Option<PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<PyReadonlyArrayDyn<'_, f64>>,
        p_approach: Option<PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<usize> {
        let n = self.inner.arm().encoders();
        let (q_rad, p_rad) = (rows(&q_rad, n, "the first poses")?, rows(&p_rad, n, "the second poses")?);
        let first = Told::new(warmth_k.as_ref(), approach.as_ref(), q_rad.len() / n, n)?;
        let second = Told::new(warmth_k.as_ref(), p_approach.as_ref(), p_rad.len() / n, n)?;
        let data = LengthRows {
            from: Angles { q_rad: &q_rad, conditions: first.conditions() },
            to: Angles { q_rad: &p_rad, conditions: second.conditions() },
            probe: &indices(&probe, "probe")?,
            length_mm: &slice(&length_mm),
        };
        self.inner.add_lengths(artefact, data, length_u_mm, fitted).map_err(raise)
    }

    #[pyo3(signature = (artefact, features_mm, frame, q_rad, probe, feature, placement, u_mm=None, labels=None,
                        fitted=false, warmth_k=None, approach=None))]
    #[allow(clippy::too_many_arguments)]
    fn add_points(
        &mut self,
        artefact: &str,
        features_mm: PyReadonlyArray2<'_, f64>,
        frame: &str,
        q_rad: PyReadonlyArray2<'_, f64>,
        probe: PyReadonlyArray1<'_, i64>,
        feature: PyReadonlyArray1<'_, i64>,
        placement: PyReadonlyArray1<'_, i64>,
        u_mm: Option<Bound<'_, PyAny>>,
        labels: Option<Vec<String>>,
        fitted: bool,
        warmth_k: Option<PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<usize> {
        let coordinates = rows(&features_mm, 3, "the features")?;
        let coordinates: Vec<[f64; 3]> = coordinates.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
        let count = coordinates.len();
        let labels = labels.unwrap_or_else(|| (1..=count).map(|k| k.to_string()).collect());
        let one = u_mm.as_ref().map_or(Some(0.0), |u| u.extract::<f64>().ok());
        let each = match (one, &u_mm) {
            (None, Some(u)) => u.extract::<PyReadonlyArray1<'_, f64>>()?.as_array().to_vec(),
            (one, _) => vec![one.unwrap_or(0.0); count],
        };
        let features = Features {
            name: artefact,
            labels: &labels,
            coordinates_mm: &coordinates,
            // one number for a bar is that of its length
            u: match one {
                Some(0.0) => Uncertainty::None,
                Some(u) if count == 2 && frame == "free" => Uncertainty::Length(u),
                _ => Uncertainty::Each(&each),
            },
            fitted,
            frame: match frame {
                "free" => Frame::Free,
                "arm" => Frame::Arm,
                other => {
                    let message = format!("frame {other:?} of artefact {artefact}: expected \"free\" or \"arm\"");
                    return Err(UlnaError::new_err(message));
                }
            },
        };
        let n = self.inner.arm().encoders();
        let touched =
            Touched::new(n, &q_rad, (warmth_k.as_ref(), approach.as_ref()), &probe, Some(&feature), &placement)?;
        self.inner.add_points(&features, touched.rows()).map_err(raise)
    }

    #[pyo3(signature = (artefact, diameter_mm, balls_mm, q_rad, probe, placement, diameter_u_mm=0.0, fitted=false,
                        inside=false, warmth_k=None, approach=None))]
    #[allow(clippy::too_many_arguments)]
    fn add_sphere(
        &mut self,
        artefact: &str,
        diameter_mm: f64,
        balls_mm: PyReadonlyArray1<'_, f64>,
        q_rad: PyReadonlyArray2<'_, f64>,
        probe: PyReadonlyArray1<'_, i64>,
        placement: PyReadonlyArray1<'_, i64>,
        diameter_u_mm: f64,
        fitted: bool,
        inside: bool,
        warmth_k: Option<PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<usize> {
        let ball = BallArtefact {
            name: artefact,
            diameter_mm,
            u_mm: diameter_u_mm,
            fitted,
            side: if inside { Side::Inside } else { Side::Outside },
            balls_mm: &slice(&balls_mm),
        };
        let n = self.inner.arm().encoders();
        let touched = Touched::new(n, &q_rad, (warmth_k.as_ref(), approach.as_ref()), &probe, None, &placement)?;
        self.inner.add_sphere(&ball, touched.rows()).map_err(raise)
    }

    #[pyo3(signature = (balls_mm, q_rad, probe, placement, warmth_k=None, approach=None))]
    fn add_plane(
        &mut self,
        balls_mm: PyReadonlyArray1<'_, f64>,
        q_rad: PyReadonlyArray2<'_, f64>,
        probe: PyReadonlyArray1<'_, i64>,
        placement: PyReadonlyArray1<'_, i64>,
        warmth_k: Option<PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<usize> {
        let n = self.inner.arm().encoders();
        let touched = Touched::new(n, &q_rad, (warmth_k.as_ref(), approach.as_ref()), &probe, None, &placement)?;
        self.inner.add_plane(&slice(&balls_mm), touched.rows()).map_err(raise)
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
