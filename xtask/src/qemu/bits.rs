//! Recordings of the bundled scenarios, computed again on every machine.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};

use super::machine::{M0, M3, M4F, Machine, RISCV};
use super::programs::{Built, blesses};
use super::{Options, Verdict};
use crate::parallel;
use crate::shell::{cargo, command, output, root, run as run_command, target_directory};
use crate::table::grouped;

/// Ticks of a scenario unless all are asked for.
const TICKS: &str = "2000";

const PRECISIONS: [&str; 2] = ["f32", "f64"];

/// Seconds after which a machine hangs: a full run of one scenario on the slowest takes minutes.
const PATIENCE: Duration = Duration::from_secs(1800);

/// Machines and precisions, the slowest first, so that no core is idle at the end.
const JOBS: [(&Machine, &str); 8] = [
    (&M0, "f64"),
    (&M3, "f64"),
    (&RISCV, "f64"),
    (&M4F, "f64"),
    (&M0, "f32"),
    (&RISCV, "f32"),
    (&M3, "f32"),
    (&M4F, "f32"),
];

/// What the job works with and where it speaks.
pub(crate) struct Context<'a> {
    pub(crate) built: &'a Built,
    /// A line about the progress.
    pub(crate) say: &'a (dyn Fn(&str) + Sync),
}

/// Records on this machine, replays on the others.
pub(crate) fn run(options: &Options, context: &Context<'_>) -> Result<Vec<Verdict>> {
    let begin = Instant::now();
    let recorder = recorder()?;
    (context.say)(&format!("recorder built in {:.1} s", begin.elapsed().as_secs_f64()));
    let directory = target_directory()?.join("recordings");
    let chosen: Vec<String> = options.scenario.iter().cloned().collect();
    if !options.full {
        let lines = record(&recorder, &directory, Some(TICKS), &chosen, context)?;
        let mut verdicts = replay(&directory, &lines, context)?;
        if chosen.is_empty() {
            verdicts.push(kept(&lines)?);
        }
        verdicts.push(flipped(&directory, &lines, context)?);
        return Ok(verdicts);
    }
    // One scenario at a time: all ticks of all of them are too many to be kept.
    let all = output(command(&recorder).arg("--list"))?;
    let names = if chosen.is_empty() { all.lines().map(str::to_owned).collect() } else { chosen };
    let mut verdicts = Vec::new();
    for (i, name) in names.iter().enumerate() {
        (context.say)(&format!("{name}, {} of {}", i + 1, names.len()));
        let lines = record(&recorder, &directory, None, std::slice::from_ref(name), context)?;
        verdicts.extend(replay(&directory, &lines, context)?);
        std::fs::remove_dir_all(&directory)?;
    }
    Ok(verdicts)
}

/// Records scenarios, all where none is named; a line of each recording.
fn record(
    recorder: &Path,
    directory: &Path,
    ticks: Option<&str>,
    names: &[String],
    context: &Context<'_>,
) -> Result<Vec<String>> {
    let begin = Instant::now();
    let mut record = command(recorder);
    record.arg("--out").arg(directory).args(names);
    record.args(ticks.iter().flat_map(|ticks| ["--ticks", *ticks]));
    let lines: Vec<String> = output(&mut record)?.lines().map(str::to_owned).collect();
    ensure!(!lines.is_empty(), "nothing was recorded");
    for precision in PRECISIONS {
        let mut whole = std::fs::File::create(together(directory, precision))?;
        for line in of(&lines, precision) {
            let name = line.split(' ').next().unwrap_or_default();
            let part = directory.join(format!("{name}.{precision}"));
            let mut part =
                std::fs::File::open(&part).with_context(|| format!("no recording {}", part.display()))?;
            std::io::copy(&mut part, &mut whole)?;
        }
    }
    (context.say)(&format!(
        "{} scenarios recorded in two precisions in {:.1} s",
        lines.len() / PRECISIONS.len(),
        begin.elapsed().as_secs_f64()
    ));
    Ok(lines)
}

/// Replays what was recorded on all machines.
fn replay(directory: &Path, lines: &[String], context: &Context<'_>) -> Result<Vec<Verdict>> {
    let verdicts = parallel::map(&JOBS, |(machine, precision)| {
        let file = together(directory, precision);
        let run = machine.run(&context.built.digest(machine, precision), Some(&file), PATIENCE)?;
        let expected: Vec<&str> = of(lines, precision).collect();
        let (is_well, text) = judged(run.is_well, &run.text, &expected);
        let name = format!("digest {precision}");
        let verdict =
            Verdict { name, place: machine.processor, text, is_well, seconds: run.took.as_secs_f64() };
        (context.say)(&verdict.line());
        Ok(verdict)
    });
    verdicts.into_iter().collect()
}

/// Whether a machine computed the same, and what is to be said of it.
fn judged(is_well: bool, text: &str, expected: &[&str]) -> (bool, String) {
    let (stack, lines): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with("stack="));
    if is_well && lines == expected {
        let ticks: u64 = lines.iter().filter_map(|line| number(line, "ticks=")).sum();
        return (true, format!("{} ticks, same bits; {}", grouped(ticks), stack.join(" ")));
    }
    // The last line says why it ended.
    let last = lines.iter().find(|line| !expected.contains(line)).unwrap_or(&"it ends too early");
    (false, format!("{last}\n{text}"))
}

/// Whether the digests are those that are kept.
fn kept(lines: &[String]) -> Result<Verdict> {
    let path = root().join("firmware/digest/expected.txt");
    let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
    if blesses() {
        std::fs::write(&path, &text)?;
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let other = lines.iter().find(|line| !expected.lines().any(|known| known == line.as_str()));
    let is_well = text == expected;
    let text = match other {
        _ if is_well => "the digests that are kept".to_owned(),
        Some(line) => format!("`{line}` is not among firmware/digest/expected.txt; MMSIM_BLESS=1 keeps it"),
        None => "firmware/digest/expected.txt knows more; MMSIM_BLESS=1 keeps what there is".to_owned(),
    };
    Ok(Verdict { name: "digest".to_owned(), place: "this machine", text, is_well, seconds: 0.0 })
}

/// Whether a machine finds a bit that was flipped: the lowest of the last torque of a recording.
fn flipped(directory: &Path, lines: &[String], context: &Context<'_>) -> Result<Verdict> {
    let name = lines.first().and_then(|line| line.split(' ').next()).context("nothing was recorded")?;
    let mut bytes = std::fs::read(directory.join(format!("{name}.f32")))?;
    // Behind it there are the outcomes, four bytes.
    let at = bytes.len().checked_sub(8).context("an empty recording")?;
    if let Some(byte) = bytes.get_mut(at) {
        *byte ^= 1;
    }
    let path = directory.join("flipped.f32");
    std::fs::write(&path, bytes)?;
    let run = M3.run(&context.built.digest(&M3, "f32"), Some(&path), PATIENCE)?;
    let found = run.text.lines().find(|line| line.contains(": torque: torque[4] is 0x"));
    let is_well = !run.is_well && found.is_some();
    let text = found.map_or(run.text.clone(), |line| format!("flipped bit found: {line}"));
    let verdict = Verdict {
        name: "digest f32".to_owned(),
        place: M3.processor,
        text,
        is_well,
        seconds: run.took.as_secs_f64(),
    };
    (context.say)(&verdict.line());
    Ok(verdict)
}

/// The recordings of a precision, one after the other.
fn together(directory: &Path, precision: &str) -> PathBuf {
    directory.join(format!("together.{precision}"))
}

/// The lines of a precision.
fn of<'a>(lines: &'a [String], precision: &'a str) -> impl Iterator<Item = &'a str> {
    lines.iter().map(String::as_str).filter(move |line| line.split(' ').nth(1) == Some(precision))
}

/// The number behind a key.
fn number(line: &str, key: &str) -> Option<u64> {
    line.split(' ').find_map(|word| word.strip_prefix(key))?.parse().ok()
}

/// The program that records.
fn recorder() -> Result<PathBuf> {
    // Of the whole workspace, so that features and with them all objects are those of the test steps.
    let mut cargo = cargo(&["build", "--workspace", "--quiet", "--locked"]);
    run_command(cargo.args(["--profile", "testrelease", "--example", "record"]))?;
    Ok(target_directory()?.join("testrelease/examples/record"))
}

#[cfg(test)]
mod tests {
    use super::judged;

    #[test]
    fn other_digests_differences_and_silence_are_told() {
        let lines = ["a f32 ticks=1500 digest=01", "b f32 ticks=600 digest=02"];
        let (is_well, text) =
            judged(true, "a f32 ticks=1500 digest=01\nb f32 ticks=600 digest=02\nstack=9 of 16\n", &lines);
        assert_eq!((is_well, text.as_str()), (true, "2,100 ticks, same bits; stack=9 of 16"), "the same");
        let told = |text: &str| {
            let (is_well, told) = judged(false, text, &lines);
            assert!(!is_well, "{told}");
            told.lines().next().unwrap_or_default().to_owned()
        };
        assert_eq!(
            told("a f32 ticks=1500 digest=01\nb f32: tick 7: it\n"),
            "b f32: tick 7: it",
            "a difference"
        );
        assert_eq!(told("a f32 ticks=1500 digest=01\n"), "it ends too early", "silence");
        assert_eq!(told("a f32 ticks=1500 digest=03\n"), "a f32 ticks=1500 digest=03", "another digest");
    }
}
