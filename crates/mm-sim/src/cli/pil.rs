//! `mmsim pil`: the plant here, the controller on a microcontroller.

mod client;
mod inject;
mod machine;
mod report;
mod twin;
mod wire;

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use clap::Args;
use clap::error::ErrorKind;
use mm_link::{Kind, Ready, Scalar, Setup};

use super::recorder::RunRecorder;
use super::run::{Ran, complain_of, execute_with, log_path, prepare, with_causes};
use super::{CommandFactory as _, Common, Exit, complain, kinds, print};
use crate::experiment::{self, Experiment};
use crate::log::LogError;
use crate::scenario::Loaded;
use crate::simulation::{RunResult, Simulation};
use client::{Client, LinkError};
use inject::{Chances, Injector};
use machine::{MACHINES, Machine, image_sizes};
use report::{Cost, Firmware, Report, SCHEMA};
use twin::{Tally, Twin, in_precision, leave};
use wire::{Qemu, Serial, Wire, built_firmware};

/// What `mmsim pil` takes.
#[derive(Debug, Clone, Args)]
pub(super) struct PilArgs {
    #[command(flatten)]
    common: Common,
    /// Controller to use instead of the scenario's.
    #[arg(long, value_name = "KIND", value_parser = kinds())]
    controller: Option<String>,
    /// Where the controller runs: a machine in QEMU (qemu:cortex-m4, qemu:cortex-m3, qemu:cortex-m0, qemu:riscv32), or a
    /// board at a serial port (serial:/dev/ttyACM0).
    #[arg(long, value_name = "TARGET")]
    target: String,
    /// What the controller computes in.
    #[arg(long, value_name = "PRECISION", default_value = "f32", value_parser = ["f32", "f64"])]
    precision: String,
    /// Program for QEMU; by default the one that `cargo xtask pil` has built.
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    /// Speed of the serial port.
    #[arg(long, value_name = "BAUD", default_value_t = 115_200)]
    baud: u32,
    /// Time to simulate instead of the scenario's, s.
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// How long to wait for an answer before asking again.
    #[arg(long, value_name = "MS", default_value_t = 2000, value_parser = clap::value_parser!(u64).range(1..))]
    timeout_ms: u64,
    /// Damage frames on purpose: drop=0.01,corrupt=0.01,duplicate=0.01,delay=0.01, always the same for a seed.
    #[arg(long, value_name = "CHANCES")]
    inject: Option<Chances>,
}

/// Where the controller runs.
enum Target {
    Qemu(&'static Machine),
    Serial(String),
}

impl Target {
    fn parse(text: &str) -> Option<Self> {
        match text.split_once(':')? {
            ("qemu", name) => MACHINES.iter().find(|machine| machine.name == name).map(Self::Qemu),
            ("serial", port) if !port.is_empty() => Some(Self::Serial(port.to_owned())),
            _ => None,
        }
    }
}

/// Runs plant and log here and the controller on a target.
pub(super) fn pil(args: &PilArgs) -> Result<Exit, clap::Error> {
    let spec = args.common.scenario()?;
    args.common.refuse_stdout("leaves no room for the report")?;
    let usage = |message: String| super::Cli::command().error(ErrorKind::InvalidValue, message);
    let target = Target::parse(&args.target).ok_or_else(|| {
        let known: Vec<_> = MACHINES.iter().map(|machine| format!("qemu:{}", machine.name)).collect();
        usage(format!("no target `{}`: one of {}, or serial:PORT", args.target, known.join(", ")))
    })?;
    let mut sets = args.common.sets(args.controller.as_deref());
    sets.extend(args.seconds.map(|seconds| format!("simulation.duration_s={seconds:?}")));
    let prepared = match prepare(spec, &sets) {
        Ok(prepared) => prepared,
        Err(exit) => return Ok(exit),
    };
    let Experiment::Closed(simulation) = &prepared.1 else {
        complain(&format_args!("error: {spec}: imposed velocities have no controller to run on a target"));
        return Ok(Exit::Usage);
    };
    let setup = match experiment::setup(&prepared.0, simulation) {
        Ok(setup) => setup,
        Err(error) => {
            complain(&error);
            return Ok(Exit::Usage);
        }
    };
    let done = if args.precision == "f64" {
        compare::<f64>(args, (&target, &prepared), simulation, &setup)
    } else {
        compare::<f32>(args, (&target, &prepared), simulation, &setup)
    };
    Ok(done.unwrap_or_else(|exit| exit))
}

/// A failure in words.
fn failed(error: &dyn std::error::Error) -> Exit {
    complain(&format_args!("error: {}", with_causes(error)));
    Exit::Failed
}

/// Connects, runs, compares and reports.
fn compare<T: Scalar>(
    args: &PilArgs,
    (target, prepared): (&Target, &(Loaded, Experiment)),
    simulation: &Simulation,
    setup: &Setup<f64>,
) -> Result<Exit, Exit> {
    let setup: Setup<T> = in_precision(setup).map_err(|error| failed(&error))?;
    let stack = setup.build().map_err(|error| failed(&error))?;
    let (wire, image) = connect(args, target)?;
    let patience = Duration::from_millis(args.timeout_ms);
    let mut client = Client::new(wire, session(), patience);
    let ready = introduce(&mut client, &setup).map_err(|error| failed(&error))?;
    client.injector = args.inject.map(|chances| Injector::new(chances, prepared.0.file.simulation.seed));
    let mut twin = Twin::new(&mut client, stack, &setup);
    let common = &args.common;
    let path = (!common.no_log).then(|| log_path(&common.out, prepared.0.name()));
    let run = |recorder: &mut RunRecorder| -> Result<RunResult, LogError> {
        simulation.run_with(recorder, &mut twin)
    };
    let Ran { summary, exit, .. } = execute_with(prepared, path, !(common.quiet || common.json), run)?;
    let Twin { tally, failed: link_error, .. } = twin;
    let injected = client.injector.take().map(|injector| injector.injected);
    let target_frames = client.ask((Kind::Query, Kind::Report), ("a query", 0), &()).ok();
    let target_frames = target_frames.map(|report: mm_link::Report| report.counters);
    leave(&mut client);
    let is_emulated = matches!(target, Target::Qemu(_));
    let Tally { ticks, equal, first, unsupervised, .. } = tally.clone();
    complain_of(&summary, exit, "");
    let report = Report {
        schema: SCHEMA,
        target: args.target.clone(),
        precision: if size_of::<T>() == 4 { "f32" } else { "f64" },
        ticks,
        equal_ticks: equal,
        first_difference: first,
        supervised_periods: unsupervised,
        frames: client.frames,
        target_frames,
        injected,
        cost: Cost::of(&tally, &ready, is_emulated),
        firmware: Firmware {
            target: ready.target.as_str().to_owned(),
            version: ready.version.as_str().to_owned(),
            flash_bytes: image.map(|(flash, _)| flash),
            ram_bytes: image.map(|(_, ram)| ram),
        },
        link_error: link_error.as_ref().map(|error| with_causes(error)),
        digest: summary.digest.clone(),
        summary,
    };
    Ok(conclude(common, &report, exit))
}

/// Prints the report and says how to exit.
fn conclude(common: &Common, report: &Report, exit: Exit) -> Exit {
    if let Some(error) = &report.link_error {
        complain(&format_args!("error: after {} ticks: {error}", report.ticks));
    }
    let printed = if common.json {
        print(&serde_json::to_string(report).unwrap_or_default())
    } else if common.quiet {
        Exit::Done
    } else {
        print(&report.text())
    };
    let equal = if report.is_good() { Exit::Done } else { Exit::Failed };
    exit.max(printed).max(equal)
}

/// A wire, and the bytes of flash and of static RAM of the program at its end.
type Connection = (Box<dyn Wire>, Option<(u64, u64)>);

/// Opens the wire, with the sizes of the program at its end where they are known.
fn connect(args: &PilArgs, target: &Target) -> Result<Connection, Exit> {
    match target {
        Target::Serial(port) => {
            let serial = Serial::open(port, args.baud).map_err(|error| {
                complain(&format_args!("error: cannot open {port}: {error}"));
                Exit::Failed
            })?;
            Ok((Box::new(serial), None))
        }
        Target::Qemu(machine) => {
            let firmware = firmware(args, machine)?;
            let image = std::fs::read(&firmware).ok().and_then(|elf| image_sizes(&elf));
            let qemu = Qemu::start(machine, &firmware).map_err(|error| failed(&error))?;
            Ok((Box::new(qemu), image))
        }
    }
}

fn firmware(args: &PilArgs, machine: &Machine) -> Result<PathBuf, Exit> {
    let found = match &args.firmware {
        Some(path) if path.is_file() => Ok(path.clone()),
        Some(path) => Err(path.clone()),
        None => built_firmware(machine),
    };
    found.map_err(|path| {
        complain(&format_args!(
            "error: no firmware at {}: `cargo xtask pil --build` builds it, --firmware names another",
            Path::display(&path)
        ));
        Exit::Usage
    })
}

/// Finds out who is there and sets it up.
fn introduce<T: Scalar>(client: &mut Client, setup: &Setup<T>) -> Result<Ready, LinkError> {
    client.clear()?;
    let ready = client.ask((Kind::Hello, Kind::Ready), ("a greeting", 0), &())?;
    client.ask::<_, ()>((T::SETUP, Kind::Done), ("the setup", 0), setup)?;
    Ok(ready)
}

/// A number that the target has not seen: it takes another session's frames for what they are.
fn session() -> u16 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    // Never 0, which is where a target begins.
    u16::try_from(now.as_millis() % 65_521).unwrap_or(0) + 1
}
