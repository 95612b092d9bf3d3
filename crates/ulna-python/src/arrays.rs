//! NumPy arrays as the slices the core takes.

use crate::errors::{UlnaError, raise};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use std::borrow::Cow;
use ulna::kinematics::{Conditions, PAYLOAD};

/// A one-dimensional array as a slice, copied where it is not contiguous.
pub fn slice<'a, T: numpy::Element + Copy>(array: &'a PyReadonlyArray1<'_, T>) -> Cow<'a, [T]> {
    match array.as_slice() {
        Ok(slice) => Cow::Borrowed(slice),
        Err(_) => Cow::Owned(array.as_array().iter().copied().collect()),
    }
}

/// A two-dimensional array as row-major numbers, copied where it is not contiguous.
///
/// # Errors
/// Another number of columns than expected.
pub fn rows<'a>(array: &'a PyReadonlyArray2<'_, f64>, columns: usize, what: &str) -> PyResult<Cow<'a, [f64]>> {
    let view = array.as_array();
    if view.ncols() != columns {
        let message = format!("{what} have {} columns, expected {columns}", view.ncols());
        return Err(UlnaError::new_err(message));
    }
    Ok(match view.to_slice() {
        Some(slice) => Cow::Borrowed(slice),
        None => Cow::Owned(view.iter().copied().collect()),
    })
}

/// What was true at poses beside their angles, as it was handed over.
pub struct Told<'a> {
    warmth_k: Cow<'a, [f64]>,
    approach: Cow<'a, [f64]>,
    payload: Cow<'a, [f64]>,
}

impl<'a> Told<'a> {
    /// Temperatures above 20 °C of `count` poses, one each or one for each joint, and from which side each joint was
    /// approached, and what was carried: mass, kg, and its centre, mm, of each; none: empty.
    ///
    /// # Errors
    /// Another shape, an approach other than -1, 0 or +1, or a payload that no arm carries.
    pub fn new(
        warmth_k: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
        approach: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
        payload: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
        count: usize,
        joints: usize,
    ) -> PyResult<Told<'a>> {
        let of_joints = format!("({count}, {joints})");
        let either = format!("({count},) or {of_joints}");
        let told = Told {
            warmth_k: shaped(warmth_k, &[&[count], &[count, joints]], "the temperatures", &either)?,
            approach: shaped(approach, &[&[count, joints]], "the approaches", &of_joints)?,
            payload: shaped(payload, &[&[count, PAYLOAD]], "the payloads", &format!("({count}, {PAYLOAD})"))?,
        };
        told.conditions().check("poses", count, joints).map_err(raise)?;
        Ok(told)
    }

    /// For the core.
    pub fn conditions(&self) -> Conditions<'_> {
        Conditions { warmth_k: &self.warmth_k, approach: &self.approach, payload: &self.payload }
    }
}

fn shaped<'a>(
    array: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
    shapes: &[&[usize]],
    what: &str,
    expected: &str,
) -> PyResult<Cow<'a, [f64]>> {
    let Some(array) = array else { return Ok(Cow::Borrowed(&[])) };
    let view = array.as_array();
    if !shapes.contains(&view.shape()) {
        return Err(UlnaError::new_err(format!("{what} have the shape {:?}, expected {expected}", view.shape())));
    }
    Ok(match view.to_slice() {
        Some(slice) => Cow::Borrowed(slice),
        None => Cow::Owned(view.iter().copied().collect()),
    })
}

/// Indices that are not negative.
///
/// # Errors
/// A negative one.
pub fn indices(array: &PyReadonlyArray1<'_, i64>, what: &str) -> PyResult<Vec<usize>> {
    let index = |&value: &i64| {
        usize::try_from(value).map_err(|_| UlnaError::new_err(format!("{what} {value}: an index cannot be negative")))
    };
    array.as_array().iter().map(index).collect()
}

/// A new one-dimensional array.
pub fn array1<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, values)
}

/// A new two-dimensional array from row-major numbers.
///
/// # Errors
/// Memory.
pub fn array2(py: Python<'_>, values: Vec<f64>, columns: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let rows = values.len().checked_div(columns).unwrap_or(0);
    PyArray1::from_vec(py, values).reshape([rows, columns])
}
