//! Python bindings: `import mmsim`.
//!
//! A shell for now: the module carries the version of the stack, and the rest of the interface grows on it.

/// The Python module `mmsim`.
#[pyo3::pymodule]
mod mmsim {
    use pyo3::prelude::*;

    /// Adds the version of the linked stack as `mmsim.__version__`.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", mm_sim::VERSION)
    }
}
