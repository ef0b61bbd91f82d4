//! `mmsim scenario`: what is there, and whether it is well-formed.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use clap::Args;

use super::run::prepare;
use super::{Exit, ScenarioCommand, complain, print};
use crate::scenario;
use crate::shell::command;

/// Runs one of the sub-commands.
pub(super) fn scenario(command: &ScenarioCommand) -> Exit {
    match command {
        ScenarioCommand::New(args) => new(args),
        ScenarioCommand::List => list(),
        ScenarioCommand::Show { name } => show(name),
        ScenarioCommand::Check { file } => match prepare(file, &[]) {
            Ok((loaded, _)) => {
                print(&format!("{}: `{}` is well-formed", loaded.source_name(), loaded.name()))
            }
            Err(exit) => exit,
        },
        ScenarioCommand::Schema => {
            print(&serde_json::to_string_pretty(&scenario::schema()).unwrap_or_default())
        }
    }
}

/// What `scenario new` takes.
#[derive(Debug, Clone, Args)]
pub(super) struct NewArgs {
    /// Name of the scenario. Default: that of the file.
    #[arg(long)]
    name: Option<String>,
    /// File to write, never over another; `-` for standard output. Default: the name with .toml.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Name of a scenario that was given none.
const NAMELESS: &str = "my-scenario";

/// Writes a scenario to begin with.
fn new(args: &NewArgs) -> Exit {
    let is_stdout = args.output.as_deref().is_some_and(|path| path.as_os_str() == "-");
    let of_file = args.output.as_deref().filter(|_| !is_stdout).and_then(Path::file_stem);
    let of_file = of_file.map(|stem| stem.to_string_lossy().into_owned());
    let name = args.name.clone().or(of_file).unwrap_or_else(|| NAMELESS.to_owned());
    let text = scenario::starter(&name);
    // A name can be one that no file may have.
    if let Err(error) = scenario::from_text("the new scenario", &text, &[]) {
        complain(&error);
        return Exit::Usage;
    }
    if is_stdout {
        return print(text.trim_end());
    }
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.toml")));
    write_new(
        &path,
        &text,
        &format!("runs with `{}`", command(["mmsim", "--scenario", &path.display().to_string()])),
    )
}

/// Writes a file that must not be there yet, and says what it is good for.
pub(super) fn write_new(path: &Path, text: &str, use_of_it: &str) -> Exit {
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    match written {
        Ok(()) => {
            complain(&format_args!("{} is written; it {use_of_it}", path.display()));
            Exit::Done
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            complain(&format_args!("error: {} is there already, and nothing is overwritten", path.display()));
            Exit::Usage
        }
        Err(error) => {
            complain(&format_args!("error: cannot write {}: {error}", path.display()));
            Exit::Failed
        }
    }
}

fn list() -> Exit {
    let width = scenario::bundled().iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, text): &(&str, &str)| {
        let description = scenario::from_text(name, text, &[])
            .map_or_else(|_| String::new(), |loaded| loaded.file.description.clone());
        format!("{name:width$}  {description}")
    };
    print(&scenario::bundled().iter().map(line).collect::<Vec<_>>().join("\n"))
}

fn show(name: &str) -> Exit {
    let wanted = name.strip_suffix(".toml").unwrap_or(name);
    if let Some((_, text)) = scenario::bundled().iter().find(|(bundled, _)| *bundled == wanted) {
        return print(text.trim_end());
    }
    match scenario::load(name, &[]) {
        Ok(loaded) => print(loaded.text().trim_end()),
        Err(error) => {
            complain(&error);
            Exit::Usage
        }
    }
}
