//! `ulna._core.choose`.

use crate::arrays::rows;
use crate::errors::{UlnaError, raise};
use crate::watch::Watch;
use numpy::{PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use ulna::design::{self, Candidates, Criterion, Task};

/// Chooses measurements by exchange.
#[pyfunction]
#[pyo3(signature = (candidates, count, criterion, directions=None, fixed=None, seed=0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn choose(
    py: Python<'_>,
    candidates: PyReadonlyArray3<'_, f64>,
    count: usize,
    criterion: &str,
    directions: Option<PyReadonlyArray2<'_, f64>>,
    fixed: Option<PyReadonlyArray2<'_, f64>>,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<usize>, Vec<f64>, usize)> {
    let (each, unknowns) = (candidates.shape()[1], candidates.shape()[2]);
    let numbers = candidates.as_slice().map_err(|_| UlnaError::new_err("the candidates' rows are not contiguous"))?;
    let directions =
        directions.as_ref().map_or(Ok(vec![]), |f| rows(f, unknowns, "directions").map(|f| f.into_owned()));
    let criterion = match criterion {
        "volume" => Criterion::Volume,
        "mean" => Criterion::Mean(directions?),
        "worst" => Criterion::Worst(directions?),
        "widest" => Criterion::Widest(directions?),
        other => {
            let message = format!("criterion {other:?}: expected \"volume\", \"mean\", \"worst\" or \"widest\"");
            return Err(UlnaError::new_err(message));
        }
    };
    let fixed = fixed.as_ref().map_or(Ok(vec![0.0; unknowns * unknowns]), |m| {
        rows(m, unknowns, "the information at hand").map(|m| m.into_owned())
    })?;
    let task = Task {
        candidates: Candidates { rows: numbers, each, unknowns },
        fixed: &fixed,
        criterion: &criterion,
        count,
        seed,
    };
    let watch = Watch::new(progress);
    match py.detach(|| design::choose(&task, &watch)) {
        Ok(found) => Ok((found.chosen, found.history, found.exchanges)),
        Err(error) => Err(watch.failure().unwrap_or_else(|| raise(error))),
    }
}
