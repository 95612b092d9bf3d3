//! `ulna._core.Arm`.

use crate::arrays::{array1, array2, indices, rows, slice};
use crate::errors::{UlnaError, raise};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use ulna::arm::{Joint, JointModel, Probe};
use ulna::inverse::{Limits, posture_for_point};
use ulna::kinematics::{self, Chain, Poses, batch};
use ulna::simd::Columns;

/// Geometry of an arm and its probes. Immutable.
#[pyclass(frozen, module = "ulna._core")]
#[derive(Clone)]
pub struct Arm {
    pub inner: ulna::arm::Arm,
}

impl Arm {
    fn probe(&self, probe: usize) -> PyResult<[f64; 3]> {
        let probes = self.inner.probes();
        let missing = || UlnaError::new_err(format!("probe {probe} does not exist; there are {}", probes.len()));
        Ok(probes.get(probe).ok_or_else(missing)?.tip_mm)
    }

    fn angles<'a>(&self, q_rad: &'a PyReadonlyArray2<'_, f64>) -> PyResult<std::borrow::Cow<'a, [f64]>> {
        rows(q_rad, self.inner.encoders(), "the encoder angles")
    }

    fn columns(&self, columns: &PyReadonlyArray1<'_, i64>) -> PyResult<Vec<usize>> {
        let columns = indices(columns, "parameter")?;
        let count = self.inner.parameter_count();
        match columns.iter().find(|&&c| c >= count) {
            Some(c) => Err(UlnaError::new_err(format!("parameter {c} does not exist; there are {count}"))),
            None => Ok(columns),
        }
    }
}

#[pymethods]
impl Arm {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        theta0_rad: PyReadonlyArray1<'_, f64>,
        alpha_rad: PyReadonlyArray1<'_, f64>,
        a_mm: PyReadonlyArray1<'_, f64>,
        d_mm: PyReadonlyArray1<'_, f64>,
        beta_rad: PyReadonlyArray1<'_, f64>,
        sign: PyReadonlyArray1<'_, f64>,
        hayati: PyReadonlyArray1<'_, bool>,
        probe_names: Vec<String>,
        tips_mm: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Arm> {
        let arrays = [&theta0_rad, &alpha_rad, &a_mm, &d_mm, &beta_rad, &sign].map(slice);
        let hayati = slice(&hayati);
        let n = hayati.len();
        let names = ["theta0_rad", "alpha_rad", "a_mm", "d_mm", "beta_rad", "sign"];
        for (name, array) in names.iter().zip(&arrays) {
            if array.len() != n {
                let message = format!("{name} has {} values, expected one for each of {n} joints", array.len());
                return Err(UlnaError::new_err(message));
            }
        }
        if n < 2 {
            return Err(raise(ulna::Error::TooFewJoints(n)));
        }
        for (name, array) in names.iter().zip(&arrays[..5]) {
            if array[n - 1] != 0.0 {
                let message =
                    format!("{name} of the last joint is {}; it carries the probe and must have 0", array[n - 1]);
                return Err(UlnaError::new_err(message));
            }
        }
        let joint = |i: usize| -> PyResult<Joint> {
            let (d_mm, beta_rad) = (arrays[3][i], arrays[4][i]);
            let (unused, value) = if hayati[i] { ("d", d_mm) } else { ("beta", beta_rad) };
            if value != 0.0 {
                let message =
                    format!("joint {} has {unused} = {value}, which its model does not use; expected 0", i + 1);
                return Err(UlnaError::new_err(message));
            }
            Ok(Joint {
                theta0_rad: arrays[0][i],
                alpha_rad: arrays[1][i],
                a_mm: arrays[2][i],
                d_mm,
                beta_rad,
                sign: arrays[5][i],
                model: if hayati[i] { JointModel::Hayati } else { JointModel::Dh },
            })
        };
        let joints = (0..n - 1).map(joint).collect::<PyResult<Vec<_>>>()?;
        let tips = rows(&tips_mm, 3, "the tips")?;
        if tips.len() != 3 * probe_names.len() {
            let message = format!("{} tips were given for {} probes", tips.len() / 3, probe_names.len());
            return Err(UlnaError::new_err(message));
        }
        let probes = probe_names
            .into_iter()
            .zip(tips.chunks_exact(3))
            .map(|(name, t)| Probe { name, tip_mm: [t[0], t[1], t[2]] });
        let inner = ulna::arm::Arm::new(joints, arrays[5][n - 1], probes.collect()).map_err(raise)?;
        Ok(Arm { inner })
    }

    #[getter]
    fn joints(&self) -> usize {
        self.inner.encoders()
    }

    #[getter]
    fn probe_names(&self) -> Vec<String> {
        self.inner.probes().iter().map(|p| p.name.clone()).collect()
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

    fn with_parameters(&self, parameters: PyReadonlyArray1<'_, f64>) -> PyResult<Arm> {
        let inner = self.inner.with_parameters(&slice(&parameters)).map_err(raise)?;
        Ok(Arm { inner })
    }

    #[pyo3(signature = (probe=0))]
    fn reach_mm(&self, probe: usize) -> PyResult<f64> {
        self.probe(probe)?;
        Ok(self.inner.reach_mm(probe))
    }

    #[pyo3(signature = (q_rad, probe=None))]
    fn tip<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let q = self.angles(&q_rad)?;
        let chain = Chain::new(&self.inner);
        let count = q.len() / self.inner.encoders();
        let mut out = vec![0.0; 3 * count];
        let one = match &probe {
            None => Some(0),
            Some(given) => given.extract::<usize>().ok(),
        };
        if let Some(probe) = one {
            let tip = self.probe(probe)?;
            py.detach(|| batch::tips_from_rows_mm(&chain, tip, &q, &mut out));
        } else if let Some(given) = probe {
            let each = indices(&given.extract::<PyReadonlyArray1<'_, i64>>()?, "probe")?;
            if each.len() != count {
                let message = format!("{} probe indices were given for {count} poses", each.len());
                return Err(UlnaError::new_err(message));
            }
            let tips = each.iter().map(|&p| self.probe(p)).collect::<PyResult<Vec<_>>>()?;
            py.detach(|| {
                let poses = Poses::from_rows(&q, self.inner.encoders());
                let tips = Columns::from_rows(tips.as_flattened(), 3);
                let mut columns = Columns::zeros(3, count);
                batch::tips_mm(&chain, &poses, &tips, &mut columns);
                for (row, p) in out.chunks_exact_mut(3).enumerate() {
                    p.copy_from_slice(&[0, 1, 2].map(|j| columns.column(j)[row]));
                }
            });
        }
        array2(py, out, 3)
    }

    #[pyo3(signature = (q_rad, probe=0))]
    fn tip_plain<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.probe(probe)?;
        let q = self.angles(&q_rad)?;
        let tip = |pose: &[f64]| -> [f64; 3] { kinematics::tip_mm(&self.inner, probe, pose).coords.into() };
        let out = py.detach(|| q.chunks_exact(self.inner.encoders()).flat_map(tip).collect());
        array2(py, out, 3)
    }

    #[pyo3(signature = (q_rad, probe=0))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let (tip, q) = (self.probe(probe)?, self.angles(&q_rad)?);
        let count = self.inner.parameter_count();
        let out = py.detach(|| {
            let mut out = vec![0.0; q.len() / self.inner.encoders() * 3 * count];
            batch::for_each_derivative(&Chain::new(&self.inner), tip, &q, |row, component, column, value| {
                let joints = self.inner.joint_parameter_count();
                let column = if column < joints { column } else { column - joints + self.inner.tip_offset(probe) };
                if column < self.inner.tip_offset(probe) + 3 {
                    out[(3 * row + component) * count + column] = value;
                }
            });
            out
        });
        PyArray1::from_vec(py, out).reshape([q.len() / self.inner.encoders(), 3, count])
    }

    #[pyo3(signature = (q_rad, probe=0))]
    fn encoder_jacobian<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let (tip, q) = (self.probe(probe)?, self.angles(&q_rad)?);
        let n = self.inner.encoders();
        let signs: Vec<f64> = self.inner.signs().collect();
        let joints = self.inner.joint_parameter_count();
        let out = py.detach(|| {
            let mut out = vec![0.0; q.len() * 3];
            batch::for_each_derivative(&Chain::new(&self.inner), tip, &q, |row, component, column, value| {
                let (encoder, value) = match column {
                    c if c < joints && c % 4 == 0 => (c / 4, -signs[c / 4] * value),
                    c if c == joints + 3 => (n - 1, signs[n - 1] * value),
                    _ => return,
                };
                out[(3 * row + component) * n + encoder] = value;
            });
            out
        });
        PyArray1::from_vec(py, out).reshape([q.len() / n, 3, n])
    }

    fn tip_covariance<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        columns: PyReadonlyArray1<'py, i64>,
        covariance: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.probe(probe)?;
        let (q, columns) = (self.angles(&q_rad)?, self.columns(&columns)?);
        let covariance = rows(&covariance, columns.len(), "the covariance")?;
        if covariance.len() != columns.len() * columns.len() {
            return Err(UlnaError::new_err("the covariance is not square"));
        }
        let out = py.detach(|| ulna::propagate::tip_covariance(&self.inner, probe, &q, &columns, &covariance));
        array2(py, out, 6)
    }

    fn direction_effect<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        columns: PyReadonlyArray1<'py, i64>,
        directions: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.probe(probe)?;
        let (q, columns) = (self.angles(&q_rad)?, self.columns(&columns)?);
        let directions = rows(&directions, columns.len(), "the directions")?;
        let out = py.detach(|| ulna::propagate::direction_effect(&self.inner, probe, &q, &columns, &directions));
        Ok(array1(py, &out))
    }

    #[pyo3(signature = (points_mm, limits_rad, seed, probe=0, tries=40))]
    #[allow(clippy::type_complexity)]
    fn pose_for_points<'py>(
        &self,
        py: Python<'py>,
        points_mm: PyReadonlyArray2<'py, f64>,
        limits_rad: PyReadonlyArray2<'py, f64>,
        seed: u64,
        probe: usize,
        tries: usize,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<bool>>)> {
        self.probe(probe)?;
        let points = rows(&points_mm, 3, "the points")?;
        let limits = rows(&limits_rad, 2, "the limits")?;
        let n = self.inner.encoders();
        if limits.len() != 2 * n {
            let message = format!("{} limits were given for {n} joints", limits.len() / 2);
            return Err(UlnaError::new_err(message));
        }
        let limits = Limits { range_rad: limits.chunks_exact(2).map(|l| (l[0], l[1])).collect() };
        let mut postures = vec![f64::NAN; points.len() / 3 * n];
        let mut reached = vec![false; points.len() / 3];
        let watch = crate::watch::Watch::new(None);
        let finished = py.detach(|| {
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
            for (k, point) in points.chunks_exact(3).enumerate() {
                let point = nalgebra::Point3::new(point[0], point[1], point[2]);
                if let Some(q) = posture_for_point(&self.inner, probe, point, &limits, tries, &mut rng) {
                    postures[k * n..(k + 1) * n].copy_from_slice(&q);
                    reached[k] = true;
                }
                if !ulna::monitor::Monitor::keep_going(&watch) {
                    return false;
                }
            }
            true
        });
        if !finished {
            return Err(watch.failure().unwrap_or_else(|| raise(ulna::Error::Interrupted)));
        }
        Ok((array2(py, postures, n)?, PyArray1::from_vec(py, reached)))
    }

    #[pyo3(signature = (q_rad, probe=0))]
    fn check_jacobian(&self, q_rad: PyReadonlyArray2<'_, f64>, probe: usize) -> PyResult<f64> {
        self.probe(probe)?;
        let q = self.angles(&q_rad)?;
        Ok(ulna::propagate::check_jacobian(&self.inner, probe, &q))
    }
}
