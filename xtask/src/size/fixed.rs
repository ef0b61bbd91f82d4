//! The same program with the controller in fixed point, beside the one in single precision, on processors without floating point.

use std::process::ExitCode;

use anyhow::{Context, Result, ensure};

use super::{PATIENCE, build, sections};
use crate::bench_targets;
use crate::parallel;
use crate::qemu::machine::{self, M0, M3, Machine};
use crate::table::{Table, grouped};

const MACHINES: [Machine; 2] = [M3, M0];

/// What the lines of a program begin with, and the switching term that they are of.
const TERMS: [(&str, &str); 2] =
    [("control", "table of knots"), ("control-integer-surface", "compiled integer surface")];

/// Scalars and the programs that count them.
const PROGRAMS: [(&str, &str); 2] = [("f32", "count-control"), ("Q32", "count-fixed")];

/// Counts and shows; nothing is kept.
pub(super) fn run(fallback: bool) -> Result<ExitCode> {
    machine::install_emulators(&MACHINES)?;
    let directory = build(fallback, &MACHINES, &PROGRAMS.map(|(_, program)| program))?;
    let mut table = Table::new(&[
        "bfsmc, supervised",
        "scalar",
        "switching term",
        "least",
        "mean",
        "most",
        "flash, B",
        "stack, B",
        "of setup, B",
    ]);
    let jobs: Vec<_> = MACHINES
        .iter()
        .flat_map(|machine| PROGRAMS.iter().map(move |(scalar, program)| (machine, *scalar, *program)))
        .collect();
    let rows = parallel::map(&jobs, |(machine, scalar, program)| -> Result<Vec<Vec<String>>> {
        let path = directory.join(machine.target).join("release").join(program);
        let flash = sections(&path)?.get("flash_bytes").copied().unwrap_or(0);
        let run = machine.count(&path, PATIENCE)?;
        ensure!(run.is_well, "{program} fails on the {}:\n{}", machine.processor, run.text);
        let counts = bench_targets::counts(&run.text)?;
        let line = |name: &str| {
            let found = counts.iter().find(|(other, _)| other == name).map(|(_, count)| count);
            found.with_context(|| format!("{program} does not print `{name}`"))
        };
        let stack = line("stack")?;
        TERMS
            .iter()
            .map(|(prefix, term)| {
                let count = line(&format!("{prefix}-cruise"))?;
                let mut row = vec![machine.processor.to_owned(), (*scalar).to_owned(), (*term).to_owned()];
                row.extend(["min", "mean", "max"].map(|name| grouped(count.number(name))));
                row.push(grouped(flash));
                row.extend(["update", "setup"].map(|name| grouped(stack.number(name))));
                Ok(row)
            })
            .collect()
    });
    for row in rows {
        row?.into_iter().for_each(|row| table.add(row));
    }
    table.print();
    println!("an update of the motion `cruise`, 100 of them; flash of the whole counting program");
    Ok(ExitCode::SUCCESS)
}
