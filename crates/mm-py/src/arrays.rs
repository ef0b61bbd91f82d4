//! Arrays of one state or many, without copies where their layout allows it.

use numpy::{
    IntoPyArray as _, PyArray1, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn,
    PyUntypedArrayMethods as _, get_array_module, ndarray::ArrayD,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use mm_model::{Configuration, Torque, Velocity};

/// Rows above which the interpreter is let go: some 50 us of work.
const MANY: usize = 64;

/// One row of `W` numbers, or many; borrowed from an array of float64 in C order, else a copy.
pub(crate) struct Rows<'py, const W: usize> {
    array: PyReadonlyArrayDyn<'py, f64>,
    /// Number of rows; none for one row without a dimension of its own.
    count: Option<usize>,
}

impl<'py, const W: usize> Rows<'py, W> {
    /// Takes anything that numpy makes an array of; `name` is the argument's.
    pub(crate) fn of(argument: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        let array = match argument.cast::<PyArrayDyn<f64>>() {
            Ok(array) if array.is_c_contiguous() => array.readonly(),
            _ => converted(argument, name)?.readonly(),
        };
        let count = match *array.shape() {
            [width] if width == W => None,
            [count, width] if width == W => Some(count),
            ref other => {
                return Err(PyValueError::new_err(format!(
                    "{name}: expected shape ({W},) or (k, {W}), got {}",
                    shape(other)
                )));
            }
        };
        Ok(Self { array, count })
    }

    /// The only row; many are refused.
    pub(crate) fn one(&self, name: &str) -> PyResult<[f64; W]> {
        match self.count {
            None => self.slice(name).and_then(|numbers| {
                numbers.try_into().map_err(|_| PyValueError::new_err(format!("{name}: expected {W} numbers")))
            }),
            Some(count) => {
                Err(PyValueError::new_err(format!("{name}: expected shape ({W},), got ({count}, {W})")))
            }
        }
    }

    fn slice(&self, name: &str) -> PyResult<&[f64]> {
        self.array.as_slice().map_err(|_| PyValueError::new_err(format!("{name}: not in C order")))
    }
}

fn shape(of: &[usize]) -> String {
    let numbers: Vec<String> = of.iter().map(ToString::to_string).collect();
    if numbers.len() == 1 { format!("({},)", numbers.concat()) } else { format!("({})", numbers.join(", ")) }
}

/// A copy as float64 in C order.
fn converted<'py>(argument: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = argument.py();
    let array = get_array_module(py)?.call_method1("ascontiguousarray", (argument, "float64"));
    let array = array.map_err(|error| {
        let refused =
            PyTypeError::new_err(format!("{name}: expected an array of numbers: {}", error.value(py)));
        refused.set_cause(py, Some(error));
        refused
    })?;
    // A scalar becomes one number of one dimension.
    array.cast_into().map_err(|_| PyTypeError::new_err(format!("{name}: expected an array of numbers")))
}

/// Rows of arguments side by side: how many, and whether they came as many.
pub(crate) fn together(counts: &[(Option<usize>, &str)]) -> PyResult<Option<usize>> {
    let mut all = None;
    for (count, name) in counts {
        match (all, count) {
            (_, None) => {}
            (None, Some(count)) => all = Some((*count, *name)),
            (Some((before, other)), Some(count)) if before != *count => {
                return Err(PyValueError::new_err(format!("{name} has {count} rows, {other} has {before}")));
            }
            _ => {}
        }
    }
    Ok(all.map(|(count, _)| count))
}

/// An argument and its name.
type Named<'a, 'py> = (&'a Bound<'py, PyAny>, &'a str);

/// Applies a function row by row. Single rows go with every row of the others.
///
/// `shape` is the one of a row's result.
pub(crate) fn map1<'py, const A: usize, const O: usize>(
    py: Python<'py>,
    a: Named<'_, 'py>,
    shape: &[usize],
    work: impl Fn(&[f64; A]) -> [f64; O] + Sync,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let rows = Rows::<A>::of(a.0, a.1)?;
    let numbers = rows.slice(a.1)?;
    filled(py, rows.count, shape, |out| {
        for (out, a) in out.as_chunks_mut::<O>().0.iter_mut().zip(numbers.as_chunks::<A>().0) {
            *out = work(a);
        }
    })
}

/// The same of two arguments.
pub(crate) fn map2<'py, const A: usize, const B: usize, const O: usize>(
    py: Python<'py>,
    (a, b): (Named<'_, 'py>, Named<'_, 'py>),
    shape: &[usize],
    work: impl Fn(&[f64; A], &[f64; B]) -> [f64; O] + Sync,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let (first, second) = (Rows::<A>::of(a.0, a.1)?, Rows::<B>::of(b.0, b.1)?);
    let count = together(&[(first.count, a.1), (second.count, b.1)])?;
    let (x, y) = (first.slice(a.1)?, second.slice(b.1)?);
    filled(py, count, shape, |out| {
        let rows = cycled::<A>(x, first.count).zip(cycled::<B>(y, second.count));
        for (out, (a, b)) in out.as_chunks_mut::<O>().0.iter_mut().zip(rows) {
            *out = work(a, b);
        }
    })
}

/// The same of three arguments.
pub(crate) fn map3<'py, const A: usize, const B: usize, const C: usize, const O: usize>(
    py: Python<'py>,
    (a, b, c): (Named<'_, 'py>, Named<'_, 'py>, Named<'_, 'py>),
    shape: &[usize],
    work: impl Fn(&[f64; A], &[f64; B], &[f64; C]) -> [f64; O] + Sync,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let (first, second) = (Rows::<A>::of(a.0, a.1)?, Rows::<B>::of(b.0, b.1)?);
    let third = Rows::<C>::of(c.0, c.1)?;
    let count = together(&[(first.count, a.1), (second.count, b.1), (third.count, c.1)])?;
    let (x, y, z) = (first.slice(a.1)?, second.slice(b.1)?, third.slice(c.1)?);
    filled(py, count, shape, |out| {
        let rows =
            cycled::<A>(x, first.count).zip(cycled::<B>(y, second.count)).zip(cycled::<C>(z, third.count));
        for (out, ((a, b), c)) in out.as_chunks_mut::<O>().0.iter_mut().zip(rows) {
            *out = work(a, b, c);
        }
    })
}

/// The rows of many, or the only one again and again.
fn cycled<const W: usize>(numbers: &[f64], count: Option<usize>) -> impl Iterator<Item = &[f64; W]> {
    let rows = numbers.as_chunks::<W>().0;
    let again = if count.is_none() { usize::MAX } else { 1 };
    std::iter::repeat_n(rows, again).flatten()
}

/// An array of results, filled without the interpreter where it is long.
fn filled<'py>(
    py: Python<'py>,
    count: Option<usize>,
    shape: &[usize],
    fill: impl FnOnce(&mut [f64]) + Send,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let shape: Vec<usize> = count.into_iter().chain(shape.iter().copied()).collect();
    let array = PyArrayDyn::<f64>::zeros(py, shape, false);
    {
        let mut writable = array.readwrite();
        let numbers = writable.as_slice_mut().map_err(|error| PyValueError::new_err(error.to_string()))?;
        if count.is_some_and(|count| count > MANY) {
            py.detach(|| fill(numbers));
        } else {
            fill(numbers);
        }
    }
    Ok(array)
}

/// A new array of one dimension.
pub(crate) fn vector(py: Python<'_>, numbers: impl IntoIterator<Item = f64>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_iter(py, numbers)
}

/// Many numbers as an array of a shape.
pub(crate) fn reshaped<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let array = ArrayD::from_shape_vec(shape.to_vec(), numbers);
    Ok(array.map_err(|error| PyValueError::new_err(error.to_string()))?.into_pyarray(py))
}

pub(crate) const fn configuration(&[x, y, heading, a, b, c]: &[f64; 6]) -> Configuration<f64, 3> {
    Configuration { x, y, heading, joints: [a, b, c] }
}

pub(crate) const fn velocity(&[forward, yaw_rate, a, b, c]: &[f64; 5]) -> Velocity<f64, 3> {
    Velocity { forward, yaw_rate, joints: [a, b, c] }
}

pub(crate) const fn torque(&[right, left, a, b, c]: &[f64; 5]) -> Torque<f64, 3> {
    Torque { right, left, joints: [a, b, c] }
}

pub(crate) const fn of_torque(torque: &Torque<f64, 3>) -> [f64; 5] {
    let [a, b, c] = torque.joints;
    [torque.right, torque.left, a, b, c]
}

pub(crate) const fn of_velocity(nu: &Velocity<f64, 3>) -> [f64; 5] {
    let [a, b, c] = nu.joints;
    [nu.forward, nu.yaw_rate, a, b, c]
}

pub(crate) const fn of_configuration(q: &Configuration<f64, 3>) -> [f64; 6] {
    let [a, b, c] = q.joints;
    [q.x, q.y, q.heading, a, b, c]
}
