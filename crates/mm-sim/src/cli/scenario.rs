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
                print(&format!("{}: `{}` is well-formed", loaded.source_name(), loaded.name()))
            }
            Err(exit) => exit,
        },
        ScenarioCommand::Schema => {
            print(&serde_json::to_string_pretty(&scenario::schema()).unwrap_or_default())
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
