//! `mmsim scenario`: what is there, and whether it is well-formed.

use super::run::prepare;
use super::{Exit, ScenarioCommand, complain, print};
use crate::scenario;

/// Runs one of the sub-commands.
pub(super) fn scenario(command: &ScenarioCommand) -> Exit {
    match command {
        ScenarioCommand::List => list(),
        ScenarioCommand::Show { name } => show(name),
        ScenarioCommand::Check { file } => match prepare(file, &[]) {
            Ok((loaded, _)) => {
                print(&format!("{}: `{}` is well-formed", loaded.source_name(), loaded.name()));
                Exit::Done
            }
            Err(exit) => exit,
        },
        ScenarioCommand::Schema => {
            print(&serde_json::to_string_pretty(&scenario::schema()).unwrap_or_default());
            Exit::Done
        }
    }
}

fn list() -> Exit {
    let width = scenario::bundled().iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, text) in scenario::bundled() {
        let description = scenario::from_text(name, text, &[])
            .map_or_else(|_| String::new(), |loaded| loaded.file.description.clone());
        print(&format!("{name:width$}  {description}"));
    }
    Exit::Done
}

fn show(name: &str) -> Exit {
    let wanted = name.strip_suffix(".toml").unwrap_or(name);
    if let Some((_, text)) = scenario::bundled().iter().find(|(bundled, _)| *bundled == wanted) {
        print(text.trim_end());
        return Exit::Done;
    }
    match scenario::load(name, &[]) {
        Ok(loaded) => {
            print(loaded.text().trim_end());
            Exit::Done
        }
        Err(error) => {
            complain(&error);
            Exit::Usage
        }
    }
}
