//! `ulna._core.Arm`.

use crate::arrays::{Told, array1, array2, indices, rows, slice};
use crate::build::{self, Stateable};
use crate::errors::{UlnaError, raise};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use std::borrow::Cow;
use std::collections::BTreeMap;
use ulna::arm::Effects;
use ulna::kinematics::inverse::{Limits, postures_for_points};
use ulna::kinematics::{self, Angles, Chain, Poses, batch};
use ulna::simd::Columns;

/// Geometry of an arm and its probes, and what it does beyond its geometry. Immutable.
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
    #[pyo3(signature = (theta0_rad, alpha_rad, a_mm, d_mm, beta_rad, sign, hayati, probe_names, tips_mm,
                        full_last_link=false))]
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
        full_last_link: bool,
    ) -> PyResult<Arm> {
        let arrays = [&theta0_rad, &alpha_rad, &a_mm, &d_mm, &beta_rad, &sign].map(slice);
        let joints = build::joints(&arrays, &slice(&hayati), full_last_link)?;
        let probes = build::probes(probe_names, &rows(&tips_mm, 3, "the tips")?)?;
        let inner = match arrays[5].last() {
            Some(&last_sign) if !full_last_link => ulna::arm::Arm::new(joints, last_sign, probes),
            _ => ulna::arm::Arm::with_full_last_link(joints, probes),
        };
        Ok(Arm { inner: inner.map_err(raise)? })
    }

    fn with_effects(&self, effects: Vec<(String, BTreeMap<String, Stateable<'_>>)>) -> PyResult<Arm> {
        let stated = effects.iter().map(|(kind, arrays)| build::stated(kind, arrays));
        let effects = Effects::from_stated(stated, self.inner.encoders()).map_err(raise)?;
        Ok(Arm { inner: self.inner.with_effects(effects).map_err(raise)? })
    }

    /// Of each joint how far it slides at the most, mm; NaN of one that turns.
    fn with_slides(&self, slides_mm: PyReadonlyArray1<'_, f64>) -> PyResult<Arm> {
        let slides_mm: Vec<Option<f64>> = slice(&slides_mm).iter().map(|&mm| (!mm.is_nan()).then_some(mm)).collect();
        Ok(Arm { inner: self.inner.with_slides(&slides_mm).map_err(raise)? })
    }

    #[getter]
    fn joints(&self) -> usize {
        self.inner.encoders()
    }

    #[getter]
    fn signs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.inner.signs())
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

    #[pyo3(signature = (q_rad, probe=None, warmth_k=None, approach=None, payload=None))]
    fn tip<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: Option<Bound<'py, PyAny>>,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let read = Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?;
        let (poses, count) = (read.angles(), read.count);
        let chain = Chain::new(&self.inner);
        let mut out = vec![0.0; 3 * count];
        let one = match &probe {
            None => Some(0),
            Some(given) => given.extract::<usize>().ok(),
        };
        if let Some(probe) = one {
            let tip = self.probe(probe)?;
            py.detach(|| batch::tips_from_rows_mm(&chain, tip, poses, &mut out));
        } else if let Some(given) = probe {
            let each = indices(&given.extract::<PyReadonlyArray1<'_, i64>>()?, "probe")?;
            if each.len() != count {
                let message = format!("{} probe indices were given for {count} poses", each.len());
                return Err(UlnaError::new_err(message));
            }
            let tips = each.iter().map(|&p| self.probe(p)).collect::<PyResult<Vec<_>>>()?;
            py.detach(|| {
                let poses = Poses::new(poses, self.inner.encoders());
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

    #[pyo3(signature = (q_rad, probe=0, warmth_k=None, approach=None, payload=None))]
    fn tip_plain<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.probe(probe)?;
        let read = Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?;
        let (poses, n) = (read.angles(), self.inner.encoders());
        let tip = |row: usize| -> [f64; 3] { kinematics::tip_mm(&self.inner, probe, poses.pose(row, n)).coords.into() };
        let out = py.detach(|| (0..read.count).flat_map(tip).collect());
        array2(py, out, 3)
    }

    #[pyo3(signature = (q_rad, probe=0, warmth_k=None, approach=None, payload=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let tip = self.probe(probe)?;
        let read = Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?;
        let poses = read.angles();
        let (count, probes) = (self.inner.parameter_count(), self.inner.probes().len());
        let out = py.detach(|| {
            let mut out = vec![0.0; read.count * 3 * count];
            let chain = Chain::new(&self.inner);
            batch::for_each_derivative(&chain, tip, poses, |row, component, column, value| {
                if let Some(parameter) = chain.parameter_of(column, probe, probes) {
                    out[(3 * row + component) * count + parameter] = value;
                }
            });
            out
        });
        PyArray1::from_vec(py, out).reshape([read.count, 3, count])
    }

    #[pyo3(signature = (q_rad, probe=0, warmth_k=None, approach=None, payload=None))]
    fn encoder_jacobian<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.probe(probe)?;
        let read = Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?;
        let (poses, n) = (read.angles(), self.inner.encoders());
        let of_pose = |row: usize| {
            let jacobian = kinematics::encoder_jacobian(&self.inner, probe, poses.pose(row, n));
            jacobian.transpose().as_slice().to_vec()
        };
        let out = py.detach(|| (0..read.count).flat_map(of_pose).collect());
        PyArray1::from_vec(py, out).reshape([read.count, 3, n])
    }

    #[pyo3(signature = (q_rad, probe, columns, covariance, warmth_k=None, approach=None, payload=None))]
    #[allow(clippy::too_many_arguments)]
    fn tip_covariance<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        columns: PyReadonlyArray1<'py, i64>,
        covariance: PyReadonlyArray2<'py, f64>,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.probe(probe)?;
        let (read, columns) =
            (Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?, self.columns(&columns)?);
        let covariance = rows(&covariance, columns.len(), "the covariance")?;
        if covariance.len() != columns.len() * columns.len() {
            return Err(UlnaError::new_err("the covariance is not square"));
        }
        let poses = read.angles();
        let out =
            py.detach(|| ulna::kinematics::propagate::tip_covariance(&self.inner, probe, poses, &columns, &covariance));
        array2(py, out, 6)
    }

    #[pyo3(signature = (q_rad, probe, columns, directions, warmth_k=None, approach=None, payload=None))]
    #[allow(clippy::too_many_arguments)]
    fn direction_effect<'py>(
        &self,
        py: Python<'py>,
        q_rad: PyReadonlyArray2<'py, f64>,
        probe: usize,
        columns: PyReadonlyArray1<'py, i64>,
        directions: PyReadonlyArray2<'py, f64>,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.probe(probe)?;
        let (read, columns) =
            (Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?, self.columns(&columns)?);
        let directions = rows(&directions, columns.len(), "the directions")?;
        let poses = read.angles();
        let out = py
            .detach(|| ulna::kinematics::propagate::direction_effect(&self.inner, probe, poses, &columns, &directions));
        Ok(array1(py, &out))
    }

    #[pyo3(signature = (points_mm, limits_rad, seed, probe=0, tries=40, warmth_k=None, approach=None, payload=None))]
    #[allow(clippy::type_complexity, clippy::too_many_arguments)]
    fn pose_for_points<'py>(
        &self,
        py: Python<'py>,
        points_mm: PyReadonlyArray2<'py, f64>,
        limits_rad: PyReadonlyArray2<'py, f64>,
        seed: u64,
        probe: usize,
        tries: usize,
        warmth_k: Option<PyReadonlyArrayDyn<'py, f64>>,
        approach: Option<PyReadonlyArrayDyn<'py, f64>>,
        payload: Option<PyReadonlyArrayDyn<'py, f64>>,
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
        let told = Told::new(warmth_k.as_ref(), approach.as_ref(), payload.as_ref(), points.len() / 3, n)?;
        let wanted = (points.as_ref(), told.conditions());
        let watch = crate::watch::Watch::new(None);
        let found = py.detach(|| postures_for_points(&self.inner, probe, wanted, &limits, tries, seed, &watch));
        let Some(postures) = found else {
            return Err(watch.failure().unwrap_or_else(|| raise(ulna::Error::Interrupted)));
        };
        let reached = postures.chunks_exact(n).map(|q_rad| !q_rad[0].is_nan()).collect();
        Ok((array2(py, postures, n)?, PyArray1::from_vec(py, reached)))
    }

    #[pyo3(signature = (q_rad, probe=0, warmth_k=None, approach=None, payload=None))]
    fn check_jacobian(
        &self,
        q_rad: PyReadonlyArray2<'_, f64>,
        probe: usize,
        warmth_k: Option<PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<PyReadonlyArrayDyn<'_, f64>>,
        payload: Option<PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<f64> {
        self.probe(probe)?;
        let read = Read::new(self, &q_rad, warmth_k.as_ref(), approach.as_ref(), payload.as_ref())?;
        Ok(ulna::kinematics::propagate::check_jacobian(&self.inner, probe, read.angles()))
    }
}

/// Poses as they were handed over.
struct Read<'a> {
    q_rad: Cow<'a, [f64]>,
    told: Told<'a>,
    count: usize,
}

impl<'a> Read<'a> {
    fn new(
        arm: &Arm,
        q_rad: &'a PyReadonlyArray2<'_, f64>,
        warmth_k: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
        payload: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
    ) -> PyResult<Read<'a>> {
        let n = arm.inner.encoders();
        let q_rad = rows(q_rad, n, "the encoder angles")?;
        let count = q_rad.len() / n;
        Ok(Read { told: Told::new(warmth_k, approach, payload, count, n)?, q_rad, count })
    }

    fn angles(&self) -> Angles<'_> {
        Angles { q_rad: &self.q_rad, conditions: self.told.conditions() }
    }
}
