//! A closed loop that writes down what enters its controller.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use mm_control::{Measurement, Reference, WheelAngles};
use mm_link::Setup;
use mm_model::{Configuration, Velocity};
use mm_replay::{Entry, Full, Recording, Seen, Sink, Word};
use mm_sim::experiment::Experiment;
use mm_sim::hardware::Running;
use mm_sim::scenario;
use mm_sim::simulation::{Ending, Recorder, Sample};

/// Runs a scenario and records it in f32 and in f64.
pub(crate) fn record(name: &str, ticks: Option<u32>, paths: &[PathBuf; 2]) -> Result<()> {
    let loaded = scenario::load(name, &[])?;
    let Experiment::Closed(mut simulation) = Experiment::build(&loaded)? else { bail!("no controller") };
    let setup = super::setup::of(&loaded, &simulation)?;
    simulation.clock.log_every = 1;
    let choice = Choice::new(simulation.clock.ticks, ticks)?;
    let robot = simulation.plant.robot();
    let sensors = simulation.hardware.as_ref().filter(|_| simulation.stack.estimates());
    let [single, double] = paths;
    let mut tap = Tap {
        choice,
        tick: 0,
        // With faults or a supervisor the loop may see other inputs than the true state, and use other torques.
        is_whole: simulation.guard.is_none(),
        sensors: sensors.map(|hardware| Running::new(hardware, robot, &simulation.initial)),
        single: Track::new(name, super::setup::rounded(&setup)?, single)?,
        double: Track::new(name, setup, double)?,
    };
    let result = simulation.run(&mut tap)?;
    ensure!(
        matches!(result.ending, Ending::Finished | Ending::Stopped { .. }),
        "it ended: {:?}",
        result.ending
    );
    tap.single.sink.0.flush()?;
    Ok(tap.double.sink.0.flush()?)
}

/// Which ticks are recorded.
#[derive(Debug, Clone, Copy)]
struct Choice {
    all: u32,
    /// The first ticks, all of them.
    begin: u32,
    /// Length of a window, and from the begin of one to the next.
    window: u32,
    stride: u32,
}

/// Windows besides the begin.
const WINDOWS: u32 = 10;

impl Choice {
    fn new(all: u64, wanted: Option<u32>) -> Result<Self> {
        let all = u32::try_from(all)?;
        let wanted = wanted.unwrap_or(all).min(all);
        let begin = if wanted < all { wanted / 2 } else { all };
        let window = (wanted - begin) / WINDOWS;
        Ok(Self { all, begin, window, stride: ((all - begin) / WINDOWS).max(1) })
    }

    const fn count(&self) -> u32 {
        self.begin + WINDOWS * self.window
    }

    /// The windows stand at the ends of equal parts of the rest.
    const fn has(&self, tick: u32) -> bool {
        tick < self.begin
            || (tick - self.begin) % self.stride >= self.stride - self.window
                && tick - self.begin < WINDOWS * self.stride
    }

    const fn is_over(&self, tick: u32) -> bool {
        tick >= self.all
            || tick >= self.begin && (self.window == 0 || tick - self.begin >= WINDOWS * self.stride)
    }
}

/// A recording in one precision.
struct Track<T: Word> {
    name: String,
    setup: Setup<T>,
    recording: Option<Recording<T>>,
    sink: Written,
}

struct Written(BufWriter<File>);

impl Sink for Written {
    fn write(&mut self, bytes: &[u8]) -> Result<(), Full> {
        self.0.write_all(bytes).map_err(|_| Full)
    }
}

impl<T: Word> Track<T> {
    fn new(name: &str, setup: Setup<T>, path: &PathBuf) -> Result<Self> {
        let file = File::create(path).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { name: name.to_owned(), setup, recording: None, sink: Written(BufWriter::new(file)) })
    }

    fn add(&mut self, ticks: u32, entry: &Entry<f64>) -> Result<mm_control::Output<T, 3>> {
        let entry = rounded::<T>(entry);
        let recording = match &mut self.recording {
            Some(recording) => recording,
            none => {
                none.insert(Recording::begin(&self.name, &self.setup, &entry.seen, ticks, &mut self.sink)?)
            }
        };
        Ok(recording.add(&entry, &mut self.sink)?)
    }
}

/// Takes the inputs of the controller.
struct Tap<'a> {
    choice: Choice,
    tick: u32,
    /// Whether no tick was left out so far.
    is_whole: bool,
    /// The same sensors as in the loop.
    sensors: Option<Running<'a>>,
    single: Track<f32>,
    double: Track<f64>,
}

impl Recorder for Tap<'_> {
    type Error = anyhow::Error;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool> {
        let tick = self.tick;
        self.tick += 1;
        // Sensors go on whether or not they are recorded.
        let seen = match &mut self.sensors {
            Some(sensors) => Seen::Measured(sensors.measure(sample.state)),
            None => Seen::State(sample.state.q, sample.state.nu),
        };
        if !self.choice.has(tick) {
            self.is_whole = false;
            return Ok(!self.choice.is_over(tick));
        }
        let entry = Entry { tick, seen, reference: *sample.reference };
        self.single.add(self.choice.count(), &entry)?;
        let output = self.double.add(self.choice.count(), &entry)?;
        ensure!(
            !self.is_whole || sample.output == Some(&output),
            "tick {tick}: the recorded update is not the one in the loop"
        );
        Ok(!self.choice.is_over(tick + 1))
    }
}

/// What enters, in another precision.
fn rounded<T: Word>(entry: &Entry<f64>) -> Entry<T> {
    let q = |q: &Configuration<f64, 3>| Configuration {
        x: T::nearest(q.x),
        y: T::nearest(q.y),
        heading: T::nearest(q.heading),
        joints: q.joints.map(T::nearest),
    };
    let wheels = |wheels: WheelAngles<f64>| WheelAngles {
        right: T::nearest(wheels.right),
        left: T::nearest(wheels.left),
    };
    let seen = match &entry.seen {
        Seen::State(at, nu) => Seen::State(q(at), Velocity::from_channels(nu.channels().map(T::nearest))),
        Seen::Measured(measured) => {
            Seen::Measured(Measurement { q: q(&measured.q), wheels: measured.wheels.map(wheels) })
        }
    };
    let Reference { position, velocity, acceleration } = entry.reference;
    let reference = Reference {
        position: position.map(T::nearest),
        velocity: velocity.map(T::nearest),
        acceleration: acceleration.map(T::nearest),
    };
    Entry { tick: entry.tick, seen, reference }
}
