//! Numbers of an effect as they come from outside: arrays that have names.

use crate::error::{Error, Result};
use std::collections::BTreeMap;

/// An array of any shape, row-major.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Its lengths.
    pub shape: Vec<usize>,
    /// As many as the shape says.
    pub values: Vec<f64>,
}

/// What is stated of one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Stated {
    kind: String,
    arrays: BTreeMap<String, Array>,
}

impl Stated {
    /// Arrays by name, of an effect by the word that a study has for it.
    pub fn new(kind: &str, arrays: impl IntoIterator<Item = (String, Array)>) -> Stated {
        Stated { kind: kind.into(), arrays: arrays.into_iter().collect() }
    }

    /// The word that a study has for the effect.
    pub fn kind(&self) -> &str {
        &self.kind
    }

    /// Takes an array out, of any length.
    ///
    /// # Errors
    /// There is none of that name, or it has more dimensions than one.
    pub(super) fn take_list(&mut self, name: &str) -> Result<Vec<f64>> {
        let length = self.arrays.get(name).map_or(0, |array| array.values.len());
        self.take(name, &[length])
    }

    /// Takes an array out.
    ///
    /// # Errors
    /// There is none of that name, or it has another shape.
    pub(super) fn take(&mut self, name: &str, shape: &[usize]) -> Result<Vec<f64>> {
        let what = || format!("{name} of effect {:?}", self.kind);
        let Some(array) = self.arrays.remove(name) else {
            return Err(Error::Missing { what: what() });
        };
        if array.shape != shape {
            return Err(Error::Dimensions { what: what(), got: array.shape, expected: shape.to_vec() });
        }
        Ok(array.values)
    }

    /// Nothing is left.
    ///
    /// # Errors
    /// An array that nobody took.
    pub(super) fn finish(self) -> Result<()> {
        match self.arrays.into_keys().next() {
            None => Ok(()),
            Some(name) => Err(Error::Unknown { what: format!("effect {:?}", self.kind), name }),
        }
    }
}
