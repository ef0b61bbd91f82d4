//! Tuning gives the same file for the same seed on any number of threads, and a scenario that names the file runs as was said.
//!
//! Law: the file depends on the scenario, the laws and the seed alone; with it a run gives the digest and the metrics that its
//! comments name; the gains are never worse than the defaults within the bounds; a failure leaves no file.
//! Why: the gains of a comparison are worth something only if anybody can find them again.
//! Reference: single runs of the command. Tolerance: none for digests and files, the last bit for numbers read from JSON.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use std::process::Command;
use std::time::{Duration, Instant};

use crate::common::command::{Folder, ended};
use mm_control::LawKind;
use serde_json::Value;

/// Half a second of the square with a heavy plant, and six runs to tune it.
const TEXT: &str = "name = \"short\"\n[simulation]\nduration_s = 0.5\n[plant]\nmass_scale = 1.25\n\
    [trajectory]\nkind = \"square\"\nstart_ramp_s = 0.2\n[controller.gains]\nswitching_gain = [1, 1, 1, 1, 1]\n\
    [tune]\nparticles = 3\niterations = 2\nseed = 4\n";

fn folder(test: &str) -> Folder {
    let folder = Folder::new(test);
    folder.write("short.toml", TEXT);
    folder
}

fn tune(folder: &Folder, more: &[&str]) -> String {
    let ended = folder.expect(0, &[&["tune", "--scenario", "short.toml"], more].concat());
    let is_warning = |line: &str| line.contains("those that the scenario gives only");
    assert!(ended.stderr.lines().all(is_warning), "no error, no progress off a terminal: {}", ended.stderr);
    ended.stdout
}

/// The comments above a law's table, in one line.
fn comments(text: &str, law: &str) -> String {
    let above = text.split_once(&format!("\n[{law}]\n")).expect("a table for the law").0;
    let mut lines: Vec<&str> = above.lines().rev().take_while(|line| line.starts_with('#')).collect();
    lines.reverse();
    lines.iter().map(|line| line.trim_start_matches('#')).collect()
}

fn number_after(text: &str, what: &str) -> f64 {
    let rest = text.split_once(what).unwrap_or_else(|| panic!("{what:?} is not in {text}")).1.trim_start();
    let digits = rest.split([' ', ',']).next().unwrap_or_default();
    digits.trim_end_matches('.').parse().unwrap_or_else(|e| panic!("{digits:?} after {what:?}: {e}"))
}

#[test]
fn a_run_with_the_tuned_gains_gives_what_was_said() {
    let folder = folder("tune-again");
    let table = tune(&folder, &["--controller", "bsmc-sat,bfsmc", "-o", "gains.toml"]);
    assert!(
        ["bsmc-sat", "as given", "gains in gains.toml"].iter().all(|part| table.contains(part)),
        "what was gained:\n{table}"
    );
    let text = std::fs::read_to_string(folder.path("gains.toml")).expect("a file of gains");
    for part in [
        "mmsim tune --scenario short.toml --controller bsmc-sat,bfsmc\n",
        "3 particles x 2 iterations = 6 runs a law, seed 4",
    ] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
    folder.write(
        "named.toml",
        &TEXT.replace("[controller.gains]", "[controller]\ngains_file = \"gains.toml\"\n[controller.gains]"),
    );
    for law in ["bsmc-sat", "bfsmc"] {
        let said = comments(&text, law);
        for args in [
            &["--scenario", "short.toml", "--set", "controller.gains_file=gains.toml"] as &[&str],
            &["--scenario", "named.toml"],
        ] {
            let args = [args, &["--controller", law, "--no-log", "--json"]].concat();
            let summary: Value = serde_json::from_str(&folder.expect(0, &args).stdout).expect("a summary");
            let digest = summary["digest"].as_str().expect("a digest");
            assert!(said.contains(&format!("digest {digest}.")), "{law}: {digest} is not in {said}");
            let m = &summary["metrics"];
            for (what, value) in [
                ("ITAE sum", &m["itae_m_s2"]["sum"]),
                ("torque variation sum", &m["torque_tv_n_m_per_s"]["sum"]),
                ("effort", &m["effort_n2_m2_s"]),
                ("RMS error", &m["rmse_m"]["norm"]),
                ("largest error", &m["max_error_m"]),
            ] {
                let (value, wanted) = (value.as_f64().expect("a number"), number_after(&said, what));
                // The JSON reader may be off by the last bit, unlike what it reads.
                assert!((value - wanted).abs() <= 1e-15 * wanted, "{law}: {what} is {value}, said: {said}");
            }
            let [itae, variation, effort] =
                ["ITAE sum", "torque variation sum", "effort"].map(|what| number_after(&said, what));
            let cost = itae + 1e-4 * variation + 1e-9 * effort;
            assert_eq!(Some(number_after(&said, "Cost")), Some(cost), "the cost of {law}");
        }
        assert!(
            number_after(&said, "Cost") <= number_after(&said, "default gains"),
            "no worse than the defaults, where the swarm starts: {said}"
        );
    }
}

#[test]
fn the_file_depends_on_the_seed_and_not_on_the_threads() {
    let folder = folder("tune-jobs");
    let one = tune(&folder, &["--controller", "bfsmc", "--jobs", "1"]);
    assert_eq!(tune(&folder, &["--controller", "bfsmc", "--jobs", "3"]), one, "3 threads");
    let seeded = tune(&folder, &["--controller", "bfsmc", "--seed", "5"]);
    assert!(seeded.contains("--seed 5\n") && seeded.contains("seed 5,"), "the seed is said:\n{seeded}");
    let table = |text: &str| text.split_once("[bfsmc]").map(|(_, gains)| gains.to_owned());
    assert_ne!(table(&seeded), table(&one), "another seed, other gains");
    let both = tune(&folder, &["--controller", "bsmc,bfsmc"]);
    assert_eq!(table(&both), table(&one), "whatever else is tuned");
}

#[test]
fn all_laws_are_tuned_into_one_file() {
    let folder = folder("tune-all");
    let sets = ["--set", "tune.particles=1", "--set", "tune.iterations=1", "--set", "tune.bounds=[0.5, 2]"];
    tune(&folder, &[&["--controller", "all", "--output", "all.toml", "--quiet"], sets.as_slice()].concat());
    let text = std::fs::read_to_string(folder.path("all.toml")).expect("a file of gains");
    for law in LawKind::ALL {
        let said = comments(&text, law.name());
        assert_eq!(
            Some(number_after(&said, "Cost")),
            Some(number_after(&said, "default gains")),
            "one particle, once, is the default: {said}"
        );
        folder.expect(
            0,
            &[
                "--scenario",
                "short.toml",
                "--controller",
                law.name(),
                "--no-log",
                "--quiet",
                "--set",
                "controller.gains_file=all.toml",
            ],
        );
    }
    let left = std::fs::read_dir(folder.path(".")).expect("a folder").count();
    assert_eq!(left, 2, "the scenario and the gains, and nothing beside them");
}

#[test]
fn what_cannot_be_tuned_is_said_and_leaves_no_file() {
    let folder = folder("tune-errors");
    let with = |more: &[&'static str]| [&["tune", "--scenario", "short.toml"], more].concat();
    for (code, args, part) in [
        (2, with(&["--controller", "none"]), "none"),
        (2, with(&[]), "--controller"),
        (2, with(&["--controller", "bsmc,all"]), "named twice"),
        (2, with(&["--controller", "bsmc", "--set", "tune.bounds=[2, 1]"]), "lo below hi"),
        (2, with(&["--controller", "bsmc", "--set", "tune.particles=0"]), "at least 1"),
        (2, with(&["--controller", "bsmc", "--method", "grid"]), "pso"),
        (1, with(&["--controller", "bsmc", "-o", "no/such/gains.toml"]), "no/such/gains.toml"),
        (2, vec!["tune", "--scenario", "verify-straight", "--controller", "bsmc"], "imposed velocities"),
        (
            1,
            with(&["--controller", "bsmc", "-o", "gains.toml", "--set", "initial.base_pose=[50, 0, 0]"]),
            "no gains within the bounds",
        ),
    ] {
        let ended = folder.expect(code, &args);
        assert!(ended.stderr.contains(part), "{part:?} with {args:?} is not in:\n{}", ended.stderr);
        assert!(ended.stdout.is_empty(), "{args:?} gives no result:\n{}", ended.stdout);
    }
    let left: Vec<_> = std::fs::read_dir(folder.path(".")).expect("a folder").collect();
    assert_eq!(left.len(), 1, "the scenario alone: {left:?}");
}

#[test]
fn the_worst_version_counts() {
    let folder = folder("tune-also");
    let once = ["--controller", "bfsmc", "--set", "tune.particles=1", "--set", "tune.iterations=1"];
    let cost =
        |more: &[&str]| number_after(&comments(&tune(&folder, &[&once, more].concat()), "bfsmc"), "Cost");
    let alone = cost(&[]);
    let heavy = cost(&["--set", "plant.mass_scale=1.5"]);
    assert!(heavy > alone, "a plant that is off costs more: {heavy} against {alone}");
    let also = "tune.also=[[\"plant.mass_scale=1.5\"], [\"plant.mass_scale=1.0\"]]";
    let text = tune(&folder, &[once.as_slice(), &["--set", also]].concat());
    let said = comments(&text, "bfsmc");
    assert_eq!(Some(number_after(&said, "Cost")), Some(heavy), "the worst of the three");
    assert!(
        text.contains("its versions with plant.mass_scale=1.5; plant.mass_scale=1.0."),
        "they are said:\n{text}"
    );
    let bad = "tune.also=[[\"plant.mass_scal=1.5\"]]";
    let ended =
        folder.expect(2, &["tune", "--scenario", "short.toml", "--controller", "bfsmc", "--set", bad]);
    assert!(ended.stderr.contains("`mass_scale`"), "the nearest key:\n{}", ended.stderr);
}

/// The digest of a short run of the fuzzy law.
fn digest(folder: &Folder, sets: &[&str]) -> String {
    let args = ["--scenario", "short.toml", "--controller", "bfsmc", "--no-log", "--json"];
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let args: Vec<&str> = args.into_iter().chain(sets).collect();
    let summary: Value = serde_json::from_str(&folder.expect(0, &args).stdout).expect("a summary");
    summary["digest"].as_str().expect("a digest").to_owned()
}

/// Law: candidates come before gains that arguments give for the law, be it by a file or one by one; the table, given as a last argument,
/// runs as was said. Two searches whose candidates differ have to differ.
#[test]
fn candidates_come_before_gains_that_arguments_give() {
    let folder = folder("tune-over");
    // One gain that is tuned and one that is not, which the written table has to keep.
    folder.write("other.toml", "[bfsmc]\nobserver_bandwidth_1_s = 3.0\nlearning_limit = [2, 2, 2, 2, 2]\nmisprints = { sign = false }\n");
    let mut digests = Vec::new();
    for set in ["controller.gains_file=other.toml", "controller.gains_for.bfsmc.observer_bandwidth_1_s=3"] {
        for bounds in ["tune.bounds=[0.4, 0.5]", "tune.bounds=[0.6, 0.7]"] {
            let once = ["--set", "tune.particles=1", "--set", "tune.iterations=1"];
            let more = ["--controller", "bfsmc", "--set", set, "--set", bounds];
            let text = tune(&folder, &[more.as_slice(), &once].concat());
            folder.write("tuned.toml", &text);
            let keeps = text.contains("\nlearning_limit = [2,2,2,2,2]\nmisprints = {sign = false}\n");
            assert_eq!(keeps, set.ends_with("other.toml"), "what is not tuned, of the file:\n{text}");
            let again = digest(&folder, &[set, "controller.gains_file=tuned.toml"]);
            let said = comments(&text, "bfsmc");
            assert!(said.contains(&format!("digest {again}.")), "{set}, {bounds}: {again} is not in {said}");
            let as_given = digest(&folder, &[set]);
            assert_ne!(again, as_given, "the candidate is another controller");
            digests.push(again);
        }
    }
    digests.sort();
    digests.dedup();
    assert_eq!(digests.len(), 4, "each candidate is one of its own: {digests:?}");
}

#[test]
fn gains_that_are_worse_than_those_given_are_warned_of() {
    let folder = folder("tune-worse");
    let once = ["--set", "tune.particles=1", "--set", "tune.iterations=1"];
    let bounds = ["--set", "tune.bounds=[1e-3, 2e-3]"];
    let args = ["tune", "--scenario", "short.toml", "--controller", "ctc"];
    let ended = folder.expect(0, &[args.as_slice(), &once, &bounds].concat());
    assert!(ended.stderr.contains("warning: ctc: the tuned gains cost"), "a warning:\n{}", ended.stderr);
    let said = comments(&ended.stdout, "ctc");
    let given = number_after(&said, "as given");
    assert!(given < number_after(&said, "Cost"), "{said}");
    assert!((given - number_after(&said, "default gains")).abs() <= 0.0, "none are given: {said}");
}

/// A law that no gains bring to the end, between two that are tuned.
#[test]
fn a_law_that_fails_takes_nothing_from_the_others() {
    let folder = folder("tune-partly");
    let sets = ["--set", "tune.particles=1", "--set", "tune.iterations=1", "--set", "tune.bounds=[1e4, 2e4]"];
    let args = ["tune", "--scenario", "short.toml", "--controller", "bsmc,bfsmc,ctc", "-o", "gains.toml"];
    let ended = folder.expect(1, &[args.as_slice(), &sets].concat());
    let text = std::fs::read_to_string(folder.path("gains.toml")).expect("a file of gains");
    for part in ["\n[bsmc]\n", "# No gains for bfsmc: no gains within the bounds", "\n[ctc]\n"] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}\n{}", ended.stderr);
    }
}

#[test]
fn an_interrupt_keeps_the_laws_that_were_tuned() {
    let folder = folder("tune-interrupted");
    let sets = ["--set", "tune.particles=20", "--set", "tune.iterations=3"];
    let args = ["tune", "--scenario", "short.toml", "--controller", "all", "-o", "gains.toml"];
    let mut child = folder.command(&[args.as_slice(), &sets].concat()).spawn().expect("the binary starts");
    let begin = Instant::now();
    while !folder.path("gains.toml").exists() && begin.elapsed() < Duration::from_secs(120) {
        assert!(child.try_wait().expect("a child").is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is there");
    assert!(sent.success(), "the signal was sent");
    let ended = ended(child.wait_with_output().expect("it ends"));
    assert_eq!(ended.code, 1, "an interrupted tuning failed:\n{}", ended.stderr);
    let text = std::fs::read_to_string(folder.path("gains.toml")).expect("a file of gains");
    assert!(text.contains("\n[bsmc]\n") && text.contains(": interrupted.\n"), "what was done:\n{text}");
}
