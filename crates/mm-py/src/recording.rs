//! The samples of a run as columns, while the interpreter is asked now and then whether to go on.

use std::time::{Duration, Instant};

use mm_sim::log::{LogError, RunLog};
use mm_sim::simulation::{Recorder, Sample};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{of_configuration, of_torque, of_velocity, reshaped};
use crate::robot::of_force;

/// Names and widths of the columns, in their order.
const COLUMNS: [(&str, usize); 15] = [
    ("t", 0),
    ("q", 6),
    ("nu", 5),
    ("tau", 5),
    ("tip", 3),
    ("reference", 3),
    ("reference_velocity", 3),
    ("error", 3),
    ("nu_c", 5),
    ("sliding", 5),
    ("equivalent", 5),
    ("fuzzy", 5),
    ("learned", 5),
    ("disturbance", 5),
    ("saturated", 0),
];

/// How often the interpreter is asked.
const ASKED_EVERY: Duration = Duration::from_millis(50);

/// Takes the samples of a run.
pub(crate) struct Recording {
    columns: [Vec<f64>; COLUMNS.len()],
    pub(crate) log: Option<RunLog>,
    duration: f64,
    progress: Option<Py<PyAny>>,
    t: f64,
    asked: Instant,
    /// What the interpreter raised: an interrupt.
    pub(crate) raised: Option<PyErr>,
}

impl Recording {
    pub(crate) fn new(
        duration: f64,
        samples: usize,
        log: Option<RunLog>,
        progress: Option<Py<PyAny>>,
    ) -> Self {
        let room = |(_, width): (&str, usize)| Vec::with_capacity(samples.min(1 << 20) * width.max(1));
        Self {
            columns: COLUMNS.map(room),
            log,
            duration,
            progress,
            t: 0.0,
            asked: Instant::now(),
            raised: None,
        }
    }

    /// Asks the interpreter for interrupts and tells it how far the run is.
    fn ask(&mut self) -> bool {
        if self.asked.elapsed() < ASKED_EVERY {
            return true;
        }
        self.asked = Instant::now();
        let fraction = self.t / self.duration;
        let asked = Python::attach(|py| {
            py.check_signals()?;
            self.progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (fraction,)).map(|_| ()))
        });
        self.raised = asked.err();
        self.raised.is_none()
    }

    /// The columns as arrays.
    pub(crate) fn arrays<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = PyDict::new(py);
        for ((name, width), numbers) in COLUMNS.into_iter().zip(&mut self.columns) {
            let numbers = std::mem::take(numbers);
            let count = numbers.len() / width.max(1);
            let shape = if width == 0 { vec![count] } else { vec![count, width] };
            let array: Bound<'py, PyArrayDyn<f64>> = reshaped(py, numbers, &shape)?;
            if name == "saturated" {
                table.set_item(name, array.call_method1("astype", ("bool",))?)?;
            } else {
                table.set_item(name, array)?;
            }
        }
        Ok(table)
    }
}

impl Recorder for Recording {
    type Error = LogError;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, LogError> {
        self.t = sample.t;
        let (p, v) = (&sample.reference.position, &sample.reference.velocity);
        let e = sample.tip - p;
        let zero = [0.0; 5];
        let signals = sample.output.map(|output| &output.signals);
        let nu_c =
            signals.map_or_else(|| of_velocity(&sample.state.nu), |signals| of_velocity(&signals.nu_c));
        let rows: [&[f64]; COLUMNS.len()] = [
            &[sample.t],
            &of_configuration(&sample.state.q),
            &of_velocity(&sample.state.nu),
            &of_torque(sample.torque),
            &[sample.tip.x, sample.tip.y, sample.tip.z],
            &[p.x, p.y, p.z],
            &[v.x, v.y, v.z],
            &[e.x, e.y, e.z],
            &nu_c,
            &signals.map_or(zero, |signals| of_velocity(&signals.sliding)),
            &signals.map_or(zero, |signals| of_force(&signals.equivalent)),
            &signals.map_or(zero, |signals| of_force(&signals.fuzzy)),
            &signals.map_or(zero, |signals| of_force(&signals.learned)),
            &of_force(&sample.external),
            &[f64::from(u8::from(sample.saturated))],
        ];
        for (column, row) in self.columns.iter_mut().zip(rows) {
            column.extend_from_slice(row);
        }
        match &mut self.log {
            Some(log) => log.record(sample),
            None => Ok(true),
        }
    }

    fn goes_on(&mut self) -> bool {
        self.ask()
    }
}
