//! The programs of `firmware/` on emulated microcontrollers: what they print, and every bit that the controller computes.
//!
//! Each program is built for each machine and run; what it prints has to be what is kept beside it, on all machines alike. The
//! program `digest` gets recordings of the bundled scenarios, made here, computes them again and compares.

mod bits;
pub(crate) mod machine;
mod programs;
mod symbols;

use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use serde_json::{Map, Value, json};

/// One verdict of the job.
#[derive(Debug)]
pub(crate) struct Verdict {
    /// What was run or looked at, and where.
    name: String,
    place: &'static str,
    /// What was found; the first line in the table, all of it where something is wrong.
    text: String,
    is_well: bool,
    seconds: f64,
}

/// What the job was asked for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Options {
    /// All ticks of the scenarios instead of some.
    pub(crate) full: bool,
    /// Debian's compiler.
    pub(crate) fallback: bool,
    /// JSON instead of lines.
    pub(crate) json: bool,
    /// Only this scenario.
    pub(crate) scenario: Option<String>,
}

/// Builds and runs all programs on all machines.
pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let begin = Instant::now();
    machine::install_emulators(&machine::MACHINES)?;
    let say = |text: &str| {
        if !options.json {
            println!("{text}");
        }
    };
    let built = programs::build(options.fallback)?;
    say(&format!("programs built for {} machines in {}", machine::MACHINES.len(), seconds(begin)));
    let mut verdicts = programs::run(&built)?;
    verdicts.extend(programs::inspect(&built)?);
    for verdict in &verdicts {
        say(&verdict.line());
    }
    verdicts.extend(bits::run(options, &bits::Context { built: &built, say: &say })?);
    let failed = verdicts.iter().filter(|verdict| !verdict.is_well).count();
    if options.json {
        let entries = verdicts.iter().map(Verdict::described).collect::<Vec<_>>();
        println!(
            "{}",
            json!({ "seconds": begin.elapsed().as_secs_f64(), "failed": failed, "verdicts": entries })
        );
    }
    for verdict in verdicts.iter().filter(|verdict| !verdict.is_well) {
        eprintln!("{} on {}:\n{}", verdict.name, verdict.place, verdict.text.trim_end());
    }
    say(&format!("{} of {} well, {}", verdicts.len() - failed, verdicts.len(), seconds(begin)));
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

impl Verdict {
    fn line(&self) -> String {
        let first = self.text.lines().next().unwrap_or_default();
        let verdict = if self.is_well { "ok" } else { "FAILED" };
        format!("{:<13} {:<12} {verdict:<7}{:>6.1} s  {first}", self.name, self.place, self.seconds)
    }

    fn described(&self) -> Value {
        let mut entry = Map::new();
        entry.insert("name".to_owned(), self.name.clone().into());
        entry.insert("machine".to_owned(), self.place.into());
        entry.insert("ok".to_owned(), self.is_well.into());
        entry.insert("seconds".to_owned(), self.seconds.into());
        entry.insert("text".to_owned(), self.text.clone().into());
        Value::Object(entry)
    }
}

fn seconds(begin: Instant) -> String {
    format!("{:.1} s", begin.elapsed().as_secs_f64())
}
