//! `mmsim robot`: robots from and to URDF.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use mm_model::RobotParams;

use super::{Exit, complain, examples, print};
use crate::experiment;
use crate::robot::{self, ImportOptions};
use crate::scenario;
use crate::whole;

/// What `robot` does.
#[derive(Debug, Subcommand)]
pub(super) enum RobotCommand {
    /// Make a robot file from a URDF of a two-wheeled base with a yaw-pitch-pitch arm; says what the model has no place for.
    #[command(after_help = examples::ROBOT_IMPORT)]
    Import(ImportArgs),
    /// Write a robot as URDF, for viewers and other simulators.
    #[command(after_help = examples::ROBOT_EXPORT)]
    Export(ExportArgs),
}

/// What `robot import` takes.
#[derive(Debug, Clone, Args)]
pub(super) struct ImportArgs {
    /// The URDF.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// File for the robot. Default: standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The link whose origin is the tip. Default: the one link without children that is fixed to the last.
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
    /// Radius of the wheels. Default: that of their cylinders or spheres.
    #[arg(long, value_name = "R", value_parser = length, allow_negative_numbers = true)]
    wheel_radius_m: Option<f64>,
    /// Take a joint as fixed, at zero; repeatable.
    #[arg(long, value_name = "JOINT")]
    fix: Vec<String>,
}

/// What `robot export` takes.
#[derive(Debug, Clone, Args)]
pub(super) struct ExportArgs {
    /// A robot file, or the preset `thesis`.
    #[arg(long, value_name = "FILE|thesis", default_value = THESIS)]
    robot: String,
    /// File for the URDF. Default: standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A finite length above zero.
fn length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length: &f64| length.is_finite() && *length > 0.0);
    length.ok_or_else(|| "expected a length in metres above zero".to_owned())
}

/// The preset robot.
const THESIS: &str = "thesis";

/// Runs one of the sub-commands.
pub(super) fn robot(command: &RobotCommand) -> Exit {
    match command {
        RobotCommand::Import(args) => import(args),
        RobotCommand::Export(args) => export(args),
    }
}

fn import(args: &ImportArgs) -> Exit {
    let name = args.file.display().to_string();
    let text = match std::fs::read_to_string(&args.file) {
        Ok(text) => text,
        Err(error) => {
            complain(&format_args!("error: cannot read the URDF {name}: {error}"));
            return Exit::Usage;
        }
    };
    let options =
        ImportOptions { tip: args.tip.clone(), wheel_radius_m: args.wheel_radius_m, fixed: args.fix.clone() };
    match robot::import(&name, &text, &options) {
        Ok(imported) => {
            let mut out = format!("# From {} by `mmsim robot import`.\n", plain(&name));
            for note in &imported.notes {
                complain(&format_args!("note: {name}: {note}"));
                out.push_str(&format!("# {}\n", plain(note)));
            }
            out.push('\n');
            out.push_str(&scenario::robot_file_toml(&imported.params));
            write(args.output.as_deref(), &out)
        }
        Err(error) => {
            complain(&error);
            Exit::Usage
        }
    }
}

/// A text that stays on its line.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}

fn export(args: &ExportArgs) -> Exit {
    let params = match params(&args.robot) {
        Ok(params) => params,
        Err(exit) => return exit,
    };
    for left in robot::left_out(&params) {
        complain(&format_args!("note: {left}"));
    }
    write(args.output.as_deref(), &robot::export(&params))
}

/// The parameters of a robot file or the preset.
fn params(robot: &str) -> Result<RobotParams<f64, 3>, Exit> {
    if robot == THESIS && !Path::new(robot).exists() {
        return Ok(RobotParams::thesis());
    }
    if !Path::new(robot).is_file() {
        complain(&format_args!(
            "error: there is no robot file {robot}; expected a file, or `{THESIS}` for the preset"
        ));
        return Err(Exit::Usage);
    }
    // A scenario around it, as there is no robot without one.
    let sets = [format!("robot.file={}", toml::Value::from(robot))];
    let loaded = scenario::from_text(
        "the robot",
        scenario::starter("robot").replace("preset = \"thesis\"", "").as_str(),
        &sets,
    );
    let built = loaded.and_then(|loaded| experiment::robot(&loaded));
    built.map(|robot| *robot.params()).map_err(|error| {
        complain(&error);
        Exit::Usage
    })
}

/// Writes a result to a file, or to standard output.
fn write(output: Option<&Path>, text: &str) -> Exit {
    let Some(path) = output.filter(|path| path.as_os_str() != "-") else { return print(text.trim_end()) };
    match whole::write(path, |file| file.write_all(text.as_bytes())) {
        Ok(()) => Exit::Done,
        Err(error) => {
            complain(&format_args!("error: cannot write {}: {error}", path.display()));
            Exit::Failed
        }
    }
}
