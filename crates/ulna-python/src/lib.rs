//! The compiled core as `ulna._core`: arrays in, arrays out. What each thing means stands in `python/ulna/_core.pyi`.

mod arm;
mod arrays;
mod build;
mod design;
mod errors;
mod fit;
mod fitted;
mod problem;
mod running;
mod watch;

use pyo3::prelude::*;

/// Which instruction set the batch kernels run on.
#[pyfunction]
fn simd_level() -> &'static str {
    ulna::simd::simd_level()
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("UlnaError", module.py().get_type::<errors::UlnaError>())?;
    module.add_class::<arm::Arm>()?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<fitted::Fitted>()?;
    module.add_class::<fitted::Identifiability>()?;
    module.add_class::<running::Running>()?;
    module.add_function(wrap_pyfunction!(simd_level, module)?)?;
    module.add_function(wrap_pyfunction!(problem::kinds, module)?)?;
    module.add_function(wrap_pyfunction!(design::choose, module)?)?;
    module.add_function(wrap_pyfunction!(running::gains, module)?)?;
    module.add_function(wrap_pyfunction!(fit::fit, module)?)?;
    module.add_function(wrap_pyfunction!(fit::identify, module)?)?;
    module.add_function(wrap_pyfunction!(fit::costs, module)?)?;
    module.add_function(wrap_pyfunction!(fit::whitened_rows, module)?)?;
    module.add_function(wrap_pyfunction!(fit::rows_of_fit, module)?)?;
    module.add_function(wrap_pyfunction!(fit::held_sensitivity, module)?)?;
    module.add_function(wrap_pyfunction!(fit::recalibrate, module)?)?;
    Ok(())
}
