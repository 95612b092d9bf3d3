//! An arm of the core from arrays of Python: shapes are checked here, numbers in the core.

use crate::errors::{UlnaError, raise};
use numpy::{PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::borrow::Cow;
use ulna::arm::{Body, Harmonics, Joint, JointModel, Probe};

/// Joints with a link from theta0, alpha, a, d, beta and sign of every joint.
///
/// # Errors
/// Arrays of other lengths, or a number where the joint's model has none.
pub fn joints(arrays: &[Cow<'_, [f64]>; 6], hayati: &[bool], full_last_link: bool) -> PyResult<Vec<Joint>> {
    let n = hayati.len();
    let names = ["theta0_rad", "alpha_rad", "a_mm", "d_mm", "beta_rad", "sign"];
    for (name, array) in names.iter().zip(arrays) {
        if array.len() != n {
            let message = format!("{name} has {} values, expected one for each of {n} joints", array.len());
            return Err(UlnaError::new_err(message));
        }
    }
    if n < 2 {
        return Err(raise(ulna::Error::TooFewJoints(n)));
    }
    for (name, array) in names.iter().zip(&arrays[..5]).filter(|_| !full_last_link) {
        if array[n - 1] != 0.0 {
            let message = format!("{name} of the last joint is {}; it carries the probe and must have 0", array[n - 1]);
            return Err(UlnaError::new_err(message));
        }
    }
    let joint = |i: usize| -> PyResult<Joint> {
        let (d_mm, beta_rad) = (arrays[3][i], arrays[4][i]);
        let (unused, value) = if hayati[i] { ("d", d_mm) } else { ("beta", beta_rad) };
        if value != 0.0 {
            let message = format!("joint {} has {unused} = {value}, which its model does not use; expected 0", i + 1);
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
    (0..if full_last_link { n } else { n - 1 }).map(joint).collect()
}

/// Probes from names and row-major tips.
///
/// # Errors
/// Another number of tips.
pub fn probes(names: Vec<String>, tips_mm: &[f64]) -> PyResult<Vec<Probe>> {
    if tips_mm.len() != 3 * names.len() {
        let message = format!("{} tips were given for {} probes", tips_mm.len() / 3, names.len());
        return Err(UlnaError::new_err(message));
    }
    let tips = tips_mm.chunks_exact(3);
    Ok(names.into_iter().zip(tips).map(|(name, t)| Probe { name, tip_mm: [t[0], t[1], t[2]] }).collect())
}

/// Harmonics of `joints` encoders, from (joints, orders, 2) amplitudes.
///
/// # Errors
/// Another shape, or orders that do not ascend from 1.
pub fn harmonics(orders: Vec<u32>, rad: &PyReadonlyArray3<'_, f64>, joints: usize) -> PyResult<Harmonics> {
    if rad.shape() != [joints, orders.len(), 2] {
        let shape = rad.shape();
        let message = format!("harmonics_rad has the shape {shape:?}, expected ({joints}, {}, 2)", orders.len());
        return Err(UlnaError::new_err(message));
    }
    let ascend = orders.first() >= Some(&1) && orders.windows(2).all(|pair| pair[0] < pair[1]);
    if !ascend {
        return Err(UlnaError::new_err(format!(
            "the orders of harmonics are {orders:?}; expected 1 or more, ascending"
        )));
    }
    let flat: Vec<f64> = rad.as_array().iter().copied().collect();
    let amplitudes_rad = flat.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    Ok(Harmonics { orders, amplitudes_rad })
}

/// Bodies from masses and row-major centres.
///
/// # Errors
/// Another number of centres.
pub fn bodies(masses_kg: &[f64], centres_mm: &[f64]) -> PyResult<Vec<Body>> {
    if 3 * masses_kg.len() != centres_mm.len() {
        let message = format!("{} centres of mass were given for {} masses", centres_mm.len() / 3, masses_kg.len());
        return Err(UlnaError::new_err(message));
    }
    let body = |(&mass_kg, c): (&f64, &[f64])| Body { mass_kg, centre_mm: [c[0], c[1], c[2]] };
    Ok(masses_kg.iter().zip(centres_mm.chunks_exact(3)).map(body).collect())
}
