//! An arm of the core from arrays of Python: shapes are checked here, numbers in the core.

use crate::errors::{UlnaError, raise};
use numpy::{AllowTypeChange, PyArrayLikeDyn};
use pyo3::prelude::*;
use std::borrow::Cow;
use std::collections::BTreeMap;
use ulna::arm::{Array, Joint, JointModel, Probe, Stated};

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

/// Anything that NumPy can make numbers of.
pub type Stateable<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// An effect's arrays by name.
pub fn stated(kind: &str, arrays: &BTreeMap<String, Stateable<'_>>) -> Stated {
    let array = |given: &Stateable<'_>| {
        let view = given.as_array();
        Array { shape: view.shape().to_vec(), values: view.iter().copied().collect() }
    };
    Stated::new(kind, arrays.iter().map(|(name, given)| (name.clone(), array(given))))
}
