//! Programs: built, run, compared with what they printed before, and looked into.

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result};

use super::machine::{M0, M4F, MACHINES, Machine};
use super::{Verdict, symbols};
use crate::parallel;
use crate::shell::{root, run as run_command};
use crate::targets::Compiler;

/// A program that prints the same on all machines.
struct Program {
    name: &'static str,
    /// Its folder in `firmware/`.
    folder: &'static str,
    profile: &'static str,
}

const PROGRAMS: [Program; 3] = [
    // Measured, and proven to be free of panics: linked as a user would.
    Program { name: "control-tick", folder: "tick", profile: "release" },
    Program { name: "fuzzy-only", folder: "fuzzy-only", profile: "quick" },
    Program { name: "fault", folder: "fault", profile: "quick" },
];

/// The programs that compare bits, by precision.
const DIGESTS: [Program; 2] = [
    Program { name: "digest-f32", folder: "digest", profile: "quick" },
    Program { name: "digest-f64", folder: "digest", profile: "quick" },
];

/// Seconds after which a machine hangs.
const PATIENCE: Duration = Duration::from_secs(60);

/// Where the programs are.
pub(crate) struct Built {
    directory: PathBuf,
}

impl Built {
    fn path(&self, machine: &Machine, program: &Program) -> PathBuf {
        self.directory.join(machine.target).join(program.profile).join(program.name)
    }

    /// The program that compares bits.
    pub(crate) fn digest(&self, machine: &Machine, precision: &str) -> PathBuf {
        let [single, double] = &DIGESTS;
        self.path(machine, if precision == "f32" { single } else { double })
    }
}

/// Builds all programs for all machines.
pub(crate) fn build(fallback: bool) -> Result<Built> {
    let mut directory = None;
    for profile in ["release", "quick"] {
        let mut compiler = Compiler::find(fallback)?;
        let target = compiler.directory.join("firmware");
        compiler.cargo.current_dir(root().join("firmware")).env("CARGO_TARGET_DIR", &target);
        compiler.cargo.args(["--quiet", "--locked", "--profile", profile]);
        for program in PROGRAMS.iter().chain(&DIGESTS).filter(|program| program.profile == profile) {
            compiler.cargo.args(["--bin", program.name]);
        }
        for machine in &MACHINES {
            compiler.cargo.args(["--target", machine.target]);
        }
        run_command(&mut compiler.cargo)?;
        directory = Some(target);
    }
    Ok(Built { directory: directory.context("no profile")? })
}

/// Runs all programs on all machines and compares what they print with what is kept beside them.
pub(crate) fn run(built: &Built) -> Result<Vec<Verdict>> {
    let jobs: Vec<(&Program, &Machine)> =
        PROGRAMS.iter().flat_map(|program| MACHINES.iter().map(move |machine| (program, machine))).collect();
    let runs =
        parallel::map(&jobs, |(program, machine)| machine.run(&built.path(machine, program), None, PATIENCE));
    let mut verdicts = Vec::new();
    for ((program, machine), run) in jobs.iter().zip(runs) {
        let run = run?;
        let path = root().join("firmware").join(program.folder).join("expected.txt");
        // The first of the machines blesses, the others have to agree.
        if blesses() && run.is_well && machine.target == MACHINES[0].target {
            std::fs::write(&path, &run.text)?;
        }
        let expected = std::fs::read_to_string(&path).unwrap_or_default();
        let (is_well, text) = judged(run.is_well, &run.text, &expected);
        let seconds = run.took.as_secs_f64();
        verdicts.push(Verdict {
            name: program.name.to_owned(),
            place: machine.processor,
            text,
            is_well,
            seconds,
        });
    }
    Ok(verdicts)
}

/// Whether what programs print is to be kept.
pub(crate) fn blesses() -> bool {
    std::env::var("MMSIM_BLESS").is_ok_and(|value| value == "1")
}

/// Whether a program ended well and printed what it should, and what is to be said of it.
fn judged(is_well: bool, text: &str, expected: &str) -> (bool, String) {
    if is_well && text == expected {
        return (true, "same output".to_owned());
    }
    let mut theirs = expected.lines();
    for line in text.lines() {
        match theirs.next() {
            Some(other) if other == line => {}
            Some(other) => return (false, format!("prints `{line}`, expected `{other}`\n{text}")),
            None => return (false, format!("prints a line more: `{line}`\n{text}")),
        }
    }
    match theirs.next() {
        Some(missing) => (false, format!("does not print `{missing}`\n{text}")),
        None => (false, format!("fails\n{text}")),
    }
}

/// Looks for what must not be in the programs.
pub(crate) fn inspect(built: &Built) -> Result<Vec<Verdict>> {
    let [tick, fuzzy, _] = &PROGRAMS;
    let mut verdicts = Vec::new();
    for machine in &MACHINES {
        let program = built.path(machine, tick);
        verdicts.push(without(&program, tick, machine, "panics", symbols::is_panic)?);
        verdicts.push(without(&program, tick, machine, "allocation", symbols::is_allocator)?);
    }
    let program = built.path(&M4F, tick);
    verdicts.push(without(&program, tick, &M4F, "double precision", symbols::is_double)?);
    verdicts.push(without(&built.path(&M0, fuzzy), fuzzy, &M0, "floating point", symbols::is_float)?);
    Ok(verdicts)
}

fn without(
    path: &Path,
    program: &Program,
    machine: &Machine,
    what: &str,
    is_meant: fn(&str) -> bool,
) -> Result<Verdict> {
    let found: Vec<String> = symbols::of(path)?.into_iter().filter(|name| is_meant(name)).collect();
    let text = match found.as_slice() {
        [] => format!("without {what}"),
        some => format!("not without {what}: {}", some.join(", ")),
    };
    let name = program.name.to_owned();
    Ok(Verdict { name, place: machine.processor, text, is_well: found.is_empty(), seconds: 0.0 })
}

#[cfg(test)]
mod tests {
    use super::judged;

    #[test]
    fn the_first_line_that_differs_is_told() {
        assert_eq!(judged(true, "a\nb\n", "a\nb\n"), (true, "same output".to_owned()), "the same");
        let begins = |text: &str, expected: &str, is_well: bool| {
            let (well, told) = judged(is_well, text, expected);
            assert!(!well, "{told}");
            told.lines().next().unwrap_or_default().to_owned()
        };
        assert_eq!(begins("a\nc\n", "a\nb\n", true), "prints `c`, expected `b`", "another line");
        assert_eq!(begins("a\nb\nc\n", "a\nb\n", true), "prints a line more: `c`", "a line more");
        assert_eq!(begins("a\n", "a\nb\n", true), "does not print `b`", "a line less");
        assert_eq!(begins("a\n", "a\n", false), "fails", "a failure");
    }
}
