//! What stands below the help of each command.

pub(super) const MMSIM: &str = "Examples:
  mmsim --scenario square.toml
  mmsim --scenario square --controller bsmc --set plant.mass_scale=1.25 --json
  mmsim compare --scenario square-compare --controllers bsmc,bsmc-sat,bfsmc-thesis,bfsmc
  mmsim sweep --scenario square-compare --samples 1000
  mmsim tune --scenario square-compare --controller bfsmc -o gains.toml
  mmsim report out/square.mcap
  mmsim plot out/square.mcap -o square.svg
  mmsim pil --scenario square-compare --target qemu:cortex-m4
  mmsim fis eval thesis -0.5 0.25
  mmsim scenario new -o mine.toml
  mmsim robot import robot.urdf -o robot.toml

Exit codes: 0 done, 1 the run failed, 2 bad usage or input, 3 the scenario's [expect] was missed;
with --set, --seed or --controller it is another experiment, and a bound that it misses is a warning";

pub(super) const RUN: &str = "Examples:
  mmsim run --scenario square.toml                              summary, and the log out/square.mcap
  mmsim run --scenario square --controller bsmc --json          the summary as JSON
  mmsim run --scenario square --set plant.payload_kg=2 --no-log
  mmsim run --scenario square --out - > square.mcap             the log alone on standard output
  mmsim run --scenario square --live                            watched in Foxglove or Lichtblick while it goes on";

pub(super) const LOG: &str = "Examples:
  mmsim log info out/square.mcap
  mmsim log recover out/square.mcap";

pub(super) const LOG_INFO: &str = "Examples:
  mmsim log info out/square.mcap               is it whole, what ran, how it ended, what is in it
  mmsim log info out/square.mcap --json

Exit codes: 0 whole, 1 unreadable, 2 bad usage, 3 readable, but torn or damaged";

pub(super) const LOG_RECOVER: &str = "Examples:
  mmsim log recover out/square.mcap            what a killed run left, in out/square.recovered.mcap
  mmsim log recover torn.mcap -o whole.mcap

Exit codes: 0 the log was whole, or every record that was complete in it is in the new one; 1 nothing could be read, or the new log not
written; 2 bad usage; 3 recovered, but without records that are damaged";

pub(super) const COMPARE: &str = "Examples:
  mmsim compare --scenario square-compare --controllers bsmc,bfsmc
  mmsim compare --scenario mine.toml --controllers bfsmc,pid,lqr --no-log --json";

pub(super) const REPRODUCE: &str = "Examples:
  mmsim reproduce                      figures and report in out/reproduce
  mmsim reproduce --jobs 2 --json";

pub(super) const SWEEP: &str = "Examples:
  mmsim sweep --scenario square-realistic --samples 1000
  mmsim sweep --scenario mine.toml --samples 100 --set sweep.mass=0.2 --fresh";

pub(super) const TUNE: &str = "Examples:
  mmsim tune --scenario square-compare --controller bfsmc -o gains.toml
  mmsim tune --scenario mine.toml --controller bsmc,pid --set tune.iterations=20
  mmsim --scenario mine.toml --set controller.gains_file=gains.toml     runs with them";

pub(super) const PIL: &str = "Examples:
  mmsim pil --scenario square-compare --target qemu:cortex-m4 --seconds 2
  mmsim pil --scenario square --target serial:/dev/ttyACM0 --inject drop=0.01";

pub(super) const REPORT: &str = "Examples:
  mmsim report out/square.mcap                       report.html beside the log
  mmsim report out/bsmc.mcap out/bfsmc.mcap --out .  both side by side";

pub(super) const PLOT: &str = "Examples:
  mmsim plot out/square.mcap -o square.svg
  mmsim plot out/bsmc.mcap out/bfsmc.mcap -o both.png";

pub(super) const SCENARIO: &str = "Examples:
  mmsim scenario new -o mine.toml
  mmsim scenario check mine.toml
  mmsim scenario show square > mine.toml";

pub(super) const SCENARIO_NEW: &str = "Examples:
  mmsim scenario new                         writes my-scenario.toml
  mmsim scenario new --name lift             writes lift.toml
  mmsim scenario new --name lift -o -        to standard output";

pub(super) const COMPLETIONS: &str = "Examples:
  mmsim completions bash > ~/.local/share/bash-completion/completions/mmsim
  mmsim completions zsh > ~/.zfunc/_mmsim          with fpath+=~/.zfunc before compinit
  mmsim completions fish > ~/.config/fish/completions/mmsim.fish";

pub(super) const MAN: &str = "Examples:
  mmsim man | man -l -
  mmsim man --out ~/.local/share/man/man1";

pub(super) const ROBOT: &str = "Examples:
  mmsim robot import robot.urdf -o robot.toml
  mmsim robot export --robot robot.toml -o robot.urdf";

pub(super) const ROBOT_IMPORT: &str = "Examples:
  mmsim robot import robot.urdf -o robot.toml
  mmsim robot import robot.urdf --tip tool0 --fix wrist_joint --wheel-radius-m 0.1
  mmsim --scenario square --set robot.file=robot.toml     runs with it";

pub(super) const ROBOT_EXPORT: &str = "Examples:
  mmsim robot export -o thesis.urdf                       the robot of the thesis
  mmsim robot export --robot robot.toml -o robot.urdf";

#[cfg(test)]
mod tests {
    use clap::{CommandFactory as _, Parser as _};

    use super::super::Cli;

    /// Law: every example below a help is a command line that is understood. Reference: the parser itself.
    #[test]
    fn every_example_is_understood() {
        fn lines(command: &clap::Command, found: &mut Vec<String>) {
            let below = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            found.extend(below.lines().filter_map(|line| line.strip_prefix("  ")).map(str::to_owned));
            command.get_subcommands().for_each(|command| lines(command, found));
        }
        let mut found = Vec::new();
        lines(&Cli::command(), &mut found);
        let mut tried = 0;
        for line in found {
            let Some(from) = line.find("mmsim ") else { continue };
            let part = &line[from..];
            let end =
                ["   ", " > ", " | "].iter().filter_map(|end| part.find(end)).min().unwrap_or(part.len());
            let words = part[..end].split_whitespace().map(Into::into).collect();
            if let Err(error) = Cli::try_parse_from(super::super::fis::shield_numbers(words)) {
                panic!("{line}: {error}");
            }
            tried += 1;
        }
        assert!(tried > 40, "{tried} examples");
    }
}
