//! impinge for Python: the extension module `impinge._native`.
//!
//! Python passes shapes, arrays and limits. [`space`] dispatches on the scalar and the dimension; all code behind it is
//! generic. Arrays of the right type and layout are read without a copy. The interpreter is released while the
//! library computes ([`supervise`]), and columns become NumPy arrays without a copy ([`answer`]). A query about a
//! single element is a batch of one element without lists. For convex solids it takes less time than releasing the
//! interpreter, which is then not released.
//!
//! Arguments of other types (lists, rotations of SciPy, arrays of another dtype) are converted in Python, in
//! `impinge/_poses.py`. A query with a shape and an array of the right type does not run that code.
#![forbid(unsafe_code)]

mod answer;
mod checker;
mod error;
mod functions;
mod manager;
mod options;
mod pairs;
mod pictures;
mod points;
mod poses;
mod read_back;
mod recordings;
mod scene;
mod shapes;
mod side;
mod solid;
mod space;
mod supervise;
mod threads;
mod tiles;
mod turning;
mod vectors;
mod world;

use pyo3::prelude::*;

/// The library behind the package `impinge`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    threads::note_process(module)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<shapes::Shape>()?;
    module.add_class::<world::World>()?;
    module.add_class::<checker::NativeChecker>()?;
    module.add_class::<manager::Manager>()?;
    functions::add_to(module)?;
    tiles::add_to(module)?;
    module.add_function(wrap_pyfunction!(pictures::picture_of, module)?)?;
    module.add_function(wrap_pyfunction!(recordings::recording_page, module)?)?;
    scene::add_to(module)
}
