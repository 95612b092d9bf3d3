//! `ulna._core.Problem`.

use crate::arm::Arm;
use crate::arrays::{indices, rows, slice};
use crate::errors::{UlnaError, raise};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use ulna::residuals::Noise;
use ulna::residuals::length::LengthRows;
use ulna::residuals::points::{Features, Frame, PointRows};

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

    #[pyo3(signature = (artefact, q_rad, p_rad, probe, length_mm, length_u_mm=0.0))]
    fn add_lengths(
        &mut self,
        artefact: &str,
        q_rad: PyReadonlyArray2<'_, f64>,
        p_rad: PyReadonlyArray2<'_, f64>,
        probe: PyReadonlyArray1<'_, i64>,
        length_mm: PyReadonlyArray1<'_, f64>,
        length_u_mm: f64,
    ) -> PyResult<usize> {
        let n = self.inner.arm().encoders();
        let data = LengthRows {
            q_rad: &rows(&q_rad, n, "the first poses")?,
            p_rad: &rows(&p_rad, n, "the second poses")?,
            probe: &indices(&probe, "probe")?,
            length_mm: &slice(&length_mm),
        };
        self.inner.add_lengths(artefact, data, length_u_mm).map_err(raise)
    }

    #[pyo3(signature = (artefact, features_mm, frame, q_rad, probe, feature, placement, feature_u_mm=0.0))]
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
        feature_u_mm: f64,
    ) -> PyResult<usize> {
        let n = self.inner.arm().encoders();
        let coordinates = rows(&features_mm, 3, "the features")?;
        let coordinates: Vec<[f64; 3]> = coordinates.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
        let features = Features {
            name: artefact,
            coordinates_mm: &coordinates,
            u_mm: feature_u_mm,
            frame: match frame {
                "free" => Frame::Free,
                "arm" => Frame::Arm,
                other => {
                    let message = format!("frame {other:?} of artefact {artefact}: expected \"free\" or \"arm\"");
                    return Err(UlnaError::new_err(message));
                }
            },
        };
        let data = PointRows {
            q_rad: &rows(&q_rad, n, "the poses")?,
            probe: &indices(&probe, "probe")?,
            feature: &indices(&feature, "feature")?,
            placement: &slice(&placement),
        };
        self.inner.add_points(&features, data).map_err(raise)
    }

    #[getter]
    fn arm(&self) -> Arm {
        Arm { inner: self.inner.arm().clone() }
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
