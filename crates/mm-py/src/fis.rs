//! `mmsim.Fis` and `mmsim.Table`.

use std::path::PathBuf;

use mm_control::fuzzy::Sampling;
use mm_fis::compile::{Language, Origin, Request, Table as Compiled, quantized};
use mm_fis::{Accuracy, System, bundled_text, write_fis};
use numpy::{PyArrayDyn, PyArrayMethods as _, PyUntypedArrayMethods as _, get_array_module};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::reshaped;
use crate::errors::{self, FuzzyError};

/// Samples of an output set where an exact centroid is not to be had.
const SAMPLES: u32 = 2001;

/// A fuzzy system: Mamdani or Sugeno, from a ``.fis`` or FCL file.
///
/// Examples
/// --------
/// >>> import mmsim
/// >>> fis = mmsim.Fis.thesis()
/// >>> float(fis.evaluate(0.0))
/// 0.0
#[pyclass(module = "mmsim", frozen)]
#[derive(Debug, Clone)]
pub(crate) struct Fis {
    system: System,
}

/// Reads a text; problems carry their places.
fn read(py: Python<'_>, name: &str, text: &str) -> PyResult<Fis> {
    let document = mm_fis::read(name, text).map_err(|error| {
        let refused = FuzzyError::new_err(
            error
                .problems()
                .iter()
                .map(|problem| format!("{name}: {problem}"))
                .collect::<Vec<_>>()
                .join("\n"),
        );
        let value = refused.value(py);
        let placed = error.problems().first().map_or(Ok(()), |problem| {
            value.setattr("file", name)?;
            value.setattr("line", problem.line())?;
            value.setattr("column", problem.column())
        });
        placed.err().unwrap_or(refused)
    })?;
    if !document.notes.is_empty() {
        let notes: Vec<String> = document.notes.iter().map(|note| format!("{name}: {note}")).collect();
        py.import("warnings")?.call_method1("warn", (notes.join("\n"),))?;
    }
    Ok(Fis { system: document.system })
}

/// Numbers of any shape, the last axis of width `inputs` where there are several; the shape of the result.
fn rows(x: &Bound<'_, PyAny>, inputs: usize, outputs: usize) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let array = get_array_module(x.py())?.call_method1("asarray", (x, "float64"))?;
    let array =
        array.cast_into::<PyArrayDyn<f64>>().map_err(|_| PyTypeError::new_err("x: expected numbers"))?;
    let mut shape = array.shape().to_vec();
    if inputs > 1 && shape.pop() != Some(inputs) {
        return Err(PyValueError::new_err(format!("x: expected a last axis of {inputs} inputs")));
    }
    if outputs > 1 {
        shape.push(outputs);
    }
    // The transposed order of another layout is undone.
    let array = get_array_module(x.py())?.call_method1("ascontiguousarray", (array,))?;
    Ok((array.cast_into::<PyArrayDyn<f64>>()?.to_vec()?, shape))
}

#[pymethods]
impl Fis {
    /// The rule base of the thesis's Appendix C, as printed.
    #[staticmethod]
    fn thesis(py: Python<'_>) -> PyResult<Self> {
        read(py, "thesis.fis", bundled_text("thesis").unwrap_or_default())
    }

    /// The rule base of ``bfsmc``: continuous, odd, never against the sliding variable.
    #[staticmethod]
    fn smooth(py: Python<'_>) -> PyResult<Self> {
        read(py, "smooth.fis", bundled_text("smooth").unwrap_or_default())
    }

    /// A system from a ``.fis`` or ``.fcl`` file.
    ///
    /// Raises
    /// ------
    /// FuzzyError
    ///     All problems of the file; ``line`` and ``column`` are those of the first.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        read(py, &path.display().to_string(), &std::fs::read_to_string(&path)?)
    }

    /// A system from its text; the ending of ``name`` says in which language.
    #[staticmethod]
    #[pyo3(signature = (text, name = "system.fis"))]
    fn from_text(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        read(py, name, text)
    }

    /// Outputs for inputs.
    ///
    /// Parameters
    /// ----------
    /// x : array_like
    ///     Any shape for a system of one input; else the inputs are the last axis.
    /// points : int, optional
    ///     Samples of an output set, as other tools take them; exact where it is not given.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     The shape of ``x`` without the axis of inputs; several outputs are the last axis.
    #[pyo3(signature = (x, *, points = None))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        points: Option<u32>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (inputs, outputs) = (self.system.inputs.len(), self.system.outputs.len());
        let (numbers, shape) = rows(x, inputs, outputs)?;
        let accuracy = points.map_or_else(
            || self.system.best_accuracy(SAMPLES),
            |points| Accuracy::Sampled(Sampling::Ends(points)),
        );
        let results = py.detach(|| {
            self.system.with_engine(accuracy, |engine| {
                let mut workspace = vec![0.0; engine.workspace_len()];
                let mut results = vec![0.0; numbers.len() / inputs.max(1) * outputs];
                for (row, result) in numbers.chunks_exact(inputs).zip(results.chunks_exact_mut(outputs)) {
                    let _met = engine.infer(row, result, &mut workspace)?;
                }
                Ok(results)
            })?
        });
        reshaped(py, results.map_err(|error: mm_control::fuzzy::FuzzyError| errors::fuzzy(&error))?, &shape)
    }

    /// A table for machines without floating point, of a system of one input or two.
    ///
    /// Parameters
    /// ----------
    /// bits : int
    ///     Bits of a knot, 8 to 16.
    /// output : int
    ///     Which output, from 0.
    /// bound : float, optional
    ///     Largest error, in output units.
    ///
    /// Returns
    /// -------
    /// Table
    #[pyo3(signature = (bits = 16, *, output = 0, bound = None, max_knots = 16_384))]
    fn compile(
        &self,
        py: Python<'_>,
        bits: u32,
        output: usize,
        bound: Option<f64>,
        max_knots: usize,
    ) -> PyResult<Table> {
        let request = Request { bound, bits, input_bits: 10, max_knots };
        let compiled = py.detach(|| Compiled::compile(&self.system, output, &request));
        compiled.map(|table| Table { table, bits }).map_err(|error| errors::fuzzy(&error))
    }

    /// The system as the text of a ``.fis`` file.
    fn to_fis(&self) -> String {
        write_fis(&self.system)
    }

    /// Name of the system.
    #[getter]
    fn name(&self) -> &str {
        &self.system.name
    }

    /// Names of the inputs and their ranges, a dict.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        ranges(py, &self.system.inputs)
    }

    /// Names of the outputs and their ranges, a dict.
    #[getter]
    fn outputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        ranges(py, &self.system.outputs)
    }

    fn __repr__(&self) -> String {
        let System { name, inputs, outputs, rules, .. } = &self.system;
        format!("Fis({name:?}, {} inputs, {} outputs, {} rules)", inputs.len(), outputs.len(), rules.len())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        (slf.get_type().getattr("from_text")?, (slf.get().to_fis(),)).into_pyobject(slf.py())
    }
}

fn ranges<'py>(py: Python<'py>, variables: &[mm_fis::Variable]) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    for variable in variables {
        table.set_item(&variable.name, variable.range)?;
    }
    Ok(table)
}

/// A compiled surface: what ``Fis.compile`` makes.
///
/// Attributes
/// ----------
/// bytes : int
///     Size in flash.
/// error : float
///     Largest error over all inputs, in output units.
#[pyclass(module = "mmsim", frozen)]
#[derive(Debug, Clone)]
pub(crate) struct Table {
    table: Compiled,
    bits: u32,
}

#[pymethods]
impl Table {
    /// Outputs in whole numbers, shown in the unit of the output: the bits of the microcontroller.
    fn evaluate<'py>(&self, py: Python<'py>, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let ranges = self.table.input_ranges();
        let (numbers, shape) = rows(x, ranges.len(), 1)?;
        let result = |row: &[f64]| {
            let fixed: Vec<i16> = ranges.iter().zip(row).map(|(range, x)| quantized(*range, *x)).collect();
            self.table.evaluate(&fixed)
        };
        reshaped(py, numbers.chunks_exact(ranges.len()).map(result).collect(), &shape)
    }

    /// The table as a constant over the types of ``mm_control::fuzzy::fixed``.
    #[pyo3(signature = (name = "TABLE"))]
    fn to_rust(&self, name: &str) -> String {
        self.written(Language::Rust, name)
    }

    /// The table as a C99 header with an inline function.
    #[pyo3(signature = (name = "TABLE"))]
    fn to_c(&self, name: &str) -> String {
        self.written(Language::C, name)
    }

    #[getter]
    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    #[getter]
    const fn error(&self) -> f64 {
        self.table.error()
    }

    fn __repr__(&self) -> String {
        format!("Table(bits={}, bytes={}, error={:.3e})", self.bits, self.table.bytes(), self.table.error())
    }
}

impl Table {
    fn written(&self, language: Language, name: &str) -> String {
        let command = format!("mmsim.Fis(...).compile(bits={})", self.bits);
        self.table.written(language, &Origin { name, command: &command })
    }
}
