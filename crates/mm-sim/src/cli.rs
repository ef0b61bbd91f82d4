//! The command line: `mmsim`.

mod compare;
mod examples;
mod fis;
mod interrupt;
mod log;
mod pil;
mod plot;
mod progress;
mod recorder;
mod report;
mod reproduce;
mod robot;
mod run;
mod scenario;
mod shells;
mod sparkline;
mod sweep;
mod table;
mod tune;

use std::ffi::OsString;
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand};
use mm_control::LawKind;

/// Exit codes of the command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// The run failed: it diverged, was interrupted, or could not be written.
    Failed = 1,
    /// Bad usage or bad input.
    Usage = 2,
    /// Finished, but the scenario's `[expect]` was missed.
    Missed = 3,
}

/// Simulate robust trajectory tracking of a mobile manipulator.
#[derive(Debug, Parser)]
#[command(name = "mmsim", version, args_conflicts_with_subcommands = true, max_term_width = 110)]
#[command(after_help = examples::MMSIM)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: RunArgs,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run one scenario (what `mmsim --scenario` does too).
    #[command(after_help = examples::RUN)]
    Run(RunArgs),
    /// Run one scenario with several controllers and compare them in one table.
    #[command(after_help = examples::COMPARE)]
    Compare(CompareArgs),
    /// Run all experiments of the thesis: its figures, and its numbers beside ours.
    #[command(after_help = examples::REPRODUCE)]
    Reproduce(ReproduceArgs),
    /// Run many random samples of one scenario: statistics, failures and how to run each again.
    #[command(after_help = examples::SWEEP)]
    Sweep(sweep::SweepArgs),
    /// Search for the gains that cost least on a scenario and write them as TOML.
    #[command(after_help = examples::TUNE)]
    Tune(tune::TuneArgs),
    /// Run a scenario with the controller on a microcontroller, and compare it with the one here, bit for bit.
    #[command(after_help = examples::PIL)]
    Pil(pil::PilArgs),
    /// Show logs side by side: one HTML file with tables, plots and a 3D replay that opens from disk.
    #[command(after_help = examples::REPORT)]
    Report(report::ReportArgs),
    /// Draw figures of logs as SVG or PNG.
    #[command(after_help = examples::PLOT)]
    Plot(plot::PlotArgs),
    /// Begin, list, show and check scenario files, or print their JSON schema.
    #[command(subcommand, after_help = examples::SCENARIO)]
    Scenario(ScenarioCommand),
    /// Evaluate, check, draw and compile fuzzy systems from .fis and .fcl files.
    #[command(subcommand)]
    Fis(fis::FisCommand),
    /// Say what is in a log, and make a whole one of what a killed run left.
    #[command(subcommand, after_help = examples::LOG)]
    Log(log::LogCommand),
    /// Take a robot from a URDF, or write one.
    #[command(subcommand, after_help = examples::ROBOT)]
    Robot(robot::RobotCommand),
    /// Print the completions of a shell.
    #[command(after_help = examples::COMPLETIONS)]
    Completions {
        /// The shell.
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
    /// Print the manual page, or write those of all commands to a folder.
    #[command(after_help = examples::MAN)]
    Man {
        /// Folder for one page a command.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// What `run` and `compare` share.
#[derive(Debug, Clone, Args)]
struct Common {
    /// A scenario file, or the name of a bundled scenario.
    #[arg(long, value_name = "FILE|NAME")]
    scenario: Option<String>,
    /// Set a key of the scenario, by its dotted path; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of everything random in the scenario.
    #[arg(long, allow_hyphen_values = true)]
    seed: Option<u64>,
    /// Folder for the log; `-` writes it to standard output, and nothing else there.
    #[arg(long, value_name = "DIR", default_value = "./out")]
    out: PathBuf,
    /// Write no log.
    #[arg(long)]
    no_log: bool,
    /// Print the summary as JSON on standard output, and nothing else there.
    #[arg(long)]
    json: bool,
    /// No progress, no table.
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Clone, Args)]
struct RunArgs {
    #[command(flatten)]
    common: Common,
    /// Controller to use instead of the scenario's.
    #[arg(long, value_name = "KIND", value_parser = kinds())]
    controller: Option<String>,
    /// Serve the run to viewers (Foxglove, Lichtblick) while it goes on, gains to be changed included; it begins with the first viewer.
    /// In builds with the feature `live`.
    #[arg(long)]
    live: bool,
    /// Where viewers connect. Nobody is asked for a password: whoever reaches the address can turn the gains, on loopback every program and
    /// web page of this machine.
    #[arg(long, value_name = "IP:PORT", default_value = "127.0.0.1:8765", requires = "live")]
    live_address: SocketAddr,
    /// Simulated seconds per second; `inf` for as fast as it goes.
    #[arg(long, value_name = "X", default_value = "1", requires = "live", value_parser = speed)]
    live_speed: f64,
}

/// A number that is not too small, or infinity.
fn speed(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().map_err(|error| error.to_string())?;
    if number >= 1e-3 { Ok(number) } else { Err("must be 0.001 or more".to_owned()) }
}

#[derive(Debug, Clone, Args)]
struct CompareArgs {
    #[command(flatten)]
    common: Common,
    /// Controllers to compare, separated by commas.
    #[arg(long, value_name = "KIND,...", value_delimiter = ',', required = true, value_parser = kinds())]
    controllers: Vec<String>,
}

#[derive(Debug, Clone, Args)]
struct ReproduceArgs {
    /// Folder for figures, data and tables.
    #[arg(long, value_name = "DIR", default_value = "./out/reproduce")]
    out: PathBuf,
    /// Threads; as many as there are cores by default. The result does not depend on it.
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Set a key of every scenario, by its dotted path; repeatable. Then it is no longer the thesis's experiment.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print the report as JSON on standard output, and nothing else there.
    #[arg(long)]
    json: bool,
    /// No progress, no table.
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum ScenarioCommand {
    /// Write a commented scenario to begin with, which runs as it is.
    #[command(after_help = examples::SCENARIO_NEW)]
    New(scenario::NewArgs),
    /// List the bundled scenarios.
    #[command(after_help = "Example:\n  mmsim scenario list")]
    List,
    /// Print a bundled scenario.
    #[command(after_help = "Example:\n  mmsim scenario show square > mine.toml")]
    Show {
        /// Its name.
        name: String,
    },
    /// Check a scenario file without running it.
    #[command(after_help = "Example:\n  mmsim scenario check mine.toml")]
    Check {
        /// The file, or the name of a bundled scenario.
        file: String,
    },
    /// Print the JSON schema of scenario files.
    #[command(after_help = "Example:\n  mmsim scenario schema > scenario.schema.json")]
    Schema,
}

/// The controllers that a run can be given by name.
fn kinds() -> PossibleValuesParser {
    LawKind::ALL.map(LawKind::name).into_iter().chain(["none"]).collect::<Vec<_>>().into()
}

/// A scenario's name; without one, a usage error.
fn needs_scenario(name: Option<&str>) -> Result<&str, clap::Error> {
    name.ok_or_else(|| {
        Cli::command().error(
            ErrorKind::MissingRequiredArgument,
            "name a scenario: --scenario FILE, or the name of a bundled one (`mmsim scenario list`)",
        )
    })
}

impl Common {
    /// The scenario's name; without one, a usage error.
    fn scenario(&self) -> Result<&str, clap::Error> {
        needs_scenario(self.scenario.as_deref())
    }

    /// Whether the log goes to standard output.
    fn logs_to_stdout(&self) -> bool {
        !self.no_log && self.out.as_os_str() == "-"
    }

    /// Refuses `--out -` where standard output is needed for something else.
    fn refuse_stdout(&self, why: &str) -> Result<(), clap::Error> {
        if self.logs_to_stdout() {
            let message = format!("--out - {why}; name a folder, or take --no-log");
            return Err(Cli::command().error(ErrorKind::ArgumentConflict, message));
        }
        Ok(())
    }

    /// The edits of the scenario that the options stand for.
    fn sets(&self, controller: Option<&str>) -> Vec<String> {
        let mut sets = self.set.clone();
        sets.extend(controller.map(|kind| format!("controller.kind=\"{kind}\"")));
        sets.extend(self.seed.map(|seed| format!("simulation.seed={seed}")));
        sets
    }
}

/// Runs the command with the given arguments, the first being its name, and says how to exit.
///
/// Results go to standard output, everything else to standard error.
pub fn main_with<I, A>(args: I) -> Exit
where
    I: IntoIterator<Item = A>,
    A: Into<OsString> + Clone,
{
    let args = fis::shield_numbers(args.into_iter().map(Into::into).collect());
    let outcome = Cli::try_parse_from(args).and_then(|cli| match cli.command {
        None => run::run(&cli.run),
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Compare(args)) => compare::compare(&args),
        Some(Command::Reproduce(args)) => Ok(reproduce::reproduce(&args)),
        Some(Command::Sweep(args)) => sweep::sweep(&args),
        Some(Command::Tune(args)) => tune::tune(&args),
        Some(Command::Pil(args)) => pil::pil(&args),
        Some(Command::Report(args)) => Ok(report::report(&args)),
        Some(Command::Plot(args)) => Ok(plot::plot(&args)),
        Some(Command::Scenario(command)) => Ok(scenario::scenario(&command)),
        Some(Command::Fis(command)) => Ok(fis::fis(&command)),
        Some(Command::Log(command)) => Ok(log::log(&command)),
        Some(Command::Robot(command)) => Ok(robot::robot(&command)),
        Some(Command::Completions { shell }) => Ok(shells::completions(shell)),
        Some(Command::Man { out }) => Ok(shells::man(out.as_deref())),
    });
    outcome.unwrap_or_else(|error| {
        let _ = error.print();
        if let Some(scenario) = meant_as_scenario(&error) {
            complain(&format_args!(
                "help: a scenario is given with `{}`",
                crate::shell::command(["mmsim", "--scenario", &scenario])
            ));
        }
        // `--help` and `--version` come this way too, and are no mistake.
        if error.use_stderr() { Exit::Usage } else { Exit::Done }
    })
}

/// The argument that no command expects, if it is a scenario: bundled, or a file that there is.
fn meant_as_scenario(error: &clap::Error) -> Option<String> {
    use clap::error::{ContextKind, ContextValue};
    let value = [ContextKind::InvalidSubcommand, ContextKind::InvalidArg]
        .into_iter()
        .find_map(|kind| error.get(kind))?;
    let ContextValue::String(word) = value else { return None };
    let name = word.strip_suffix(".toml").unwrap_or(word);
    let is_bundled = crate::scenario::bundled().iter().any(|(bundled, _)| *bundled == name);
    (is_bundled || word.ends_with(".toml") && std::path::Path::new(word).is_file()).then(|| word.clone())
}

/// Writes a result to standard output, as a line; a reader that has gone away is no failure, a full disk is.
fn print(text: &str) -> Exit {
    print_bytes(format!("{text}\n").as_bytes())
}

/// The same with nothing added.
fn print_bytes(bytes: &[u8]) -> Exit {
    use std::io::Write as _;
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(&format_args!("error: cannot write the result: {error}"));
            Exit::Failed
        }
        _ => Exit::Done,
    }
}

/// Writes a message to standard error.
fn complain(text: &dyn core::fmt::Display) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
