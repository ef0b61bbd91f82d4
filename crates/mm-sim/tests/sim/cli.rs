//! The command line gives what the interface promises: exit codes, tables, JSON, logs, bundled names.
//!
//! Law: results on standard output and nothing else there, everything else on standard error; the keys of the JSON summary, the
//! topics of the log and the names of files are fixed.
//! Why: people and programs rely on them.
//! Reference: the interface, whose keys are written out here; the `mcap` crate reads the logs. No tolerance: names and bits.

#![expect(clippy::panic, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::{Folder, complete_log};
use serde_json::Value;

/// Two seconds of the square.
const SHORT: [&str; 4] = ["--scenario", "square.toml", "--set", "simulation.duration_s=2"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SHORT.iter().chain(more).copied().collect()
}

/// Keys of an object with those of the objects in it, in order: `a`, `b.x`, ...
fn keys(value: &Value, prefix: &str, out: &mut Vec<String>) {
    let Value::Object(object) = value else { return };
    for (key, inner) in object {
        let path = format!("{prefix}{key}");
        keys(inner, &format!("{path}."), out);
        if !inner.is_object() {
            out.push(path);
        }
    }
}

/// Every number of a summary is finite, which JSON enforces; whatever is not defined is null and on this list.
fn nulls(value: &Value, prefix: &str, out: &mut Vec<String>) {
    match value {
        Value::Null => out.push(prefix.to_owned()),
        Value::Object(object) => object.iter().for_each(|(key, v)| nulls(v, &format!("{prefix}.{key}"), out)),
        Value::Array(list) => list.iter().for_each(|v| nulls(v, prefix, out)),
        _ => {}
    }
}

const KEYS: &str = "schema scenario controller duration_s plant_step_s control_period_s seed ended simulated_s \
    metrics.itae_m_s2.x metrics.itae_m_s2.y metrics.itae_m_s2.z metrics.itae_m_s2.sum \
    metrics.iae_m_s.x metrics.iae_m_s.y metrics.iae_m_s.z metrics.iae_m_s.sum \
    metrics.ise_m2_s.x metrics.ise_m2_s.y metrics.ise_m2_s.z metrics.ise_m2_s.sum \
    metrics.rmse_m.x metrics.rmse_m.y metrics.rmse_m.z metrics.rmse_m.norm metrics.max_error_m metrics.settling_time_s \
    metrics.torque_tv_n_m_per_s.right metrics.torque_tv_n_m_per_s.left metrics.torque_tv_n_m_per_s.joints \
    metrics.torque_tv_n_m_per_s.sum \
    metrics.peak_torque_n_m.right metrics.peak_torque_n_m.left metrics.peak_torque_n_m.joints \
    metrics.effort_n2_m2_s metrics.energy_j metrics.saturated_fraction metrics.max_speed_m_s \
    metrics.min_manipulability metrics.sliding_band metrics.joint_limit_crossings metrics.reaching_condition_met \
    monitors.lyapunov_max_j monitors.lyapunov_rate_max_w monitors.reaching_bound_max monitors.reaching_met_fraction \
    monitors.reaching_failed_fraction monitors.torque_limited.fraction monitors.torque_limited.first_s \
    monitors.torque_limited_fraction.right monitors.torque_limited_fraction.left \
    monitors.torque_limited_fraction.joints monitors.near_singular.fraction monitors.near_singular.first_s \
    monitors.speed_limited.fraction monitors.speed_limited.first_s monitors.joint_limited.fraction \
    monitors.joint_limited.first_s supervisor digest real_time_factor wall_s log warnings";

fn summary(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("not one JSON object ({error}):\n{text}"))
}

#[test]
fn a_run_prints_its_table_and_leaves_a_complete_log() {
    let folder = Folder::new("run");
    let ended = folder.expect(0, &SHORT);
    for part in ["square with bfsmc", "ITAE", "torque variation", "digest", "out/square.mcap"] {
        assert!(ended.stdout.contains(part), "{part:?} is not in the table:\n{}", ended.stdout);
    }
    assert!(
        ended.stderr.is_empty(),
        "nothing to complain of, and no progress off a terminal: {}",
        ended.stderr
    );
    let log = complete_log(&folder.path("out/square.mcap"));
    for (topic, count) in [
        ("/tf", 200),
        ("/joint_states", 200),
        ("/odom", 200),
        ("/control", 200),
        ("/reference", 1),
        ("/robot_description", 1),
    ] {
        assert_eq!(log.topics.get(topic), Some(&count), "messages on {topic}: {:?}", log.topics);
    }
    assert!(log.topics["/path"] >= 4, "the path twice a second: {:?}", log.topics);
    assert_eq!(log.result["outcome"], "finished", "how it ended");
    let logged = summary(&log.attachments["summary.json"]);
    let digest = logged["digest"].as_str().expect("a digest");
    assert!(ended.stdout.contains(digest), "the log's digest is the table's");
    assert_eq!(log.result["digest"], digest, "and the one of the outcome");
    assert!(log.attachments["scenario.toml"].contains("Appendix B"), "the scenario's text is in the log");
    folder.expect(0, &with(&["--out", "a/b"]));
    assert!(folder.path("a/b/square.mcap").is_file(), "--out makes the folders it names");
    let run = folder.expect(0, &[&["run"], SHORT.as_slice()].concat());
    assert!(run.stdout.contains(digest), "`run` is what no sub-command is");
}

#[test]
fn json_is_one_object_with_the_promised_keys() {
    let folder = Folder::new("json");
    let ended = folder.expect(0, &with(&["--json"]));
    assert_eq!(ended.stdout.matches('\n').count(), 1, "one line");
    let value = summary(&ended.stdout);
    let mut found = Vec::new();
    keys(&value, "", &mut found);
    assert_eq!(found, KEYS.split_whitespace().collect::<Vec<_>>(), "keys, in the interface's order");
    assert_eq!(value["schema"], "mmsim.summary/1", "name of the format");
    let own = (&value["scenario"], &value["controller"], &value["seed"], &value["duration_s"]);
    assert_eq!(own, (&"square".into(), &"bfsmc".into(), &0.into(), &2.0.into()), "what was run");
    assert_eq!(value["log"], "./out/square.mcap", "where the log is");
    for (key, count) in [("sliding_band", 5), ("torque_tv_n_m_per_s", 3), ("peak_torque_n_m", 3)] {
        let metric = &value["metrics"][key];
        let list = if metric.is_array() { metric } else { &metric["joints"] };
        assert_eq!(list.as_array().map(Vec::len), Some(count), "numbers in {key}");
    }
    let digest = value["digest"].as_str().expect("a digest");
    assert!(digest.len() == 32 && digest.chars().all(|c| c.is_ascii_hexdigit()), "the digest {digest}");
    let mut undefined = Vec::new();
    nulls(&value, "", &mut undefined);
    let never = ["torque_limited", "near_singular", "speed_limited", "joint_limited"]
        .map(|what| format!(".monitors.{what}.first_s"));
    let absent = [&never[..], &[".supervisor".to_owned()]].concat();
    assert_eq!(
        undefined, absent,
        "all is defined in this run, but for when what never was began, and no supervisor"
    );
    let log = complete_log(&folder.path("out/square.mcap"));
    assert_eq!(summary(&log.attachments["summary.json"]), value, "the same summary in the log");
}

#[test]
fn no_log_and_quiet() {
    let folder = Folder::new("quiet");
    let value = summary(&folder.expect(0, &with(&["--json", "--no-log"])).stdout);
    assert!(value["log"].is_null(), "log is null with --no-log");
    assert!(!folder.path("out").exists(), "no log, no folder");
    let ended = folder.expect(0, &with(&["--quiet"]));
    assert!(ended.stdout.is_empty(), "--quiet says nothing:\n{}", ended.stdout);
    assert!(ended.stderr.is_empty(), "and complains of nothing:\n{}", ended.stderr);
    assert!(folder.path("out/square.mcap").is_file(), "but logs");
    let imposed = folder.expect(0, &["--scenario", "verify-straight", "--json", "--no-log"]);
    let value = summary(&imposed.stdout);
    assert_eq!(value["controller"], "none", "imposed velocities have no law");
    assert!(value["metrics"]["reaching_condition_met"].is_null(), "nor a reaching condition");
    assert!(value["monitors"].is_null(), "nor monitors");
}

#[test]
fn compare_gives_the_improvement_only_of_bfsmc_over_bsmc() {
    let folder = Folder::new("compare");
    let compare = |controllers: &str| {
        let args = [&["compare"], SHORT.as_slice(), &["--controllers", controllers, "--json"]].concat();
        summary(&folder.expect(0, &args).stdout)
    };
    let both = compare("bsmc,bfsmc");
    let mut top: Vec<&String> = both.as_object().expect("an object").keys().collect();
    top.sort();
    assert_eq!(top, ["improvement_percent", "runs"], "keys of a comparison");
    let itae = |i: usize| both["runs"][i]["metrics"]["itae_m_s2"]["sum"].as_f64().expect("a number");
    let percent = (itae(0) - itae(1)) / itae(0) * 100.0;
    let given = both["improvement_percent"]["sum"].as_f64().expect("a number");
    assert!((given - percent).abs() < 1e-9, "improvement {given}, recomputed {percent}");
    for (i, kind) in ["bsmc", "bfsmc"].into_iter().enumerate() {
        let run = &both["runs"][i];
        assert_eq!(run["controller"], kind, "in the order asked for");
        let mut found = Vec::new();
        keys(run, "", &mut found);
        assert_eq!(found, KEYS.split_whitespace().collect::<Vec<_>>(), "a run is a summary");
        let log = complete_log(&folder.path(run["log"].as_str().expect("a log")));
        assert_eq!(
            log.result["digest"],
            *run["digest"].as_str().expect("a digest"),
            "each run has its own log"
        );
    }
    for others in ["bsmc,bsmc-sat", "bfsmc,bfsmc-thesis", "bfsmc"] {
        let value = compare(others);
        assert!(value.get("improvement_percent").is_none(), "{others} has no improvement");
    }
    let table =
        folder.expect(0, &[&["compare"], SHORT.as_slice(), &["--controllers", "bsmc,bfsmc"]].concat());
    assert!(table.stdout.contains("bfsmc below bsmc by"), "the improvement:\n{}", table.stdout);
}

#[test]
fn the_seed_matters_to_noise_alone() {
    let folder = Folder::new("seed");
    let noise = "disturbance=[{on=\"joint2\", shape=\"noise\", amplitude_n_m=5.0}]";
    let digest = |seed: &str, more: &[&str]| {
        let args = with(&[&["--no-log", "--json", "--seed", seed], more].concat());
        let value = summary(&folder.expect(0, &args).stdout);
        assert_eq!(value["seed"].to_string(), seed, "the seed in the summary");
        value["digest"].to_string()
    };
    assert_eq!(digest("1", &[]), digest("2", &[]), "nothing random, no difference");
    assert_eq!(digest("1", &["--set", noise]), digest("1", &["--set", noise]), "one seed, one run");
    assert_ne!(digest("1", &["--set", noise]), digest("2", &["--set", noise]), "two seeds, two runs");
    assert_eq!(digest("18446744073709551615", &[]), digest("0", &[]), "all of 64 bits are a seed");
}

#[test]
fn a_file_comes_before_a_bundled_scenario_of_its_name() {
    let folder = Folder::new("names");
    let name = |spec: &str| {
        let args = ["--scenario", spec, "--set", "simulation.duration_s=0.01", "--json", "--no-log"];
        summary(&folder.expect(0, &args).stdout)["scenario"].as_str().map(str::to_owned)
    };
    assert_eq!(name("square"), Some("square".to_owned()), "bundled");
    assert_eq!(name("square.toml"), Some("square".to_owned()), "bundled, with the ending");
    let own = "name = \"mine\"\n[simulation]\nduration_s = 1\n[trajectory]\nkind = \"hold\"\n";
    folder.write("square.toml", own);
    assert_eq!(name("square.toml"), Some("mine".to_owned()), "the file first");
    assert_eq!(name("./square.toml"), Some("mine".to_owned()), "the file, with a folder");
    assert_eq!(name("square"), Some("square".to_owned()), "no file of this name: the bundled one");
    folder.expect(2, &["--scenario", "./spiral.toml"]);
}

#[test]
fn scenario_lists_shows_checks_and_describes() {
    let folder = Folder::new("scenario");
    let list = folder.expect(0, &["scenario", "list"]).stdout;
    for (name, text) in mm_sim::scenario::bundled() {
        assert!(list.lines().any(|line| line.split_whitespace().next() == Some(*name)), "{name} is listed");
        let shown = folder.expect(0, &["scenario", "show", name]).stdout;
        assert_eq!(shown, *text, "{name} is shown to the byte");
    }
    folder
        .write("good.toml", "name = \"g\"\n[simulation]\nduration_s = 1\n[trajectory]\nkind = \"spiral\"\n");
    folder.expect(0, &["scenario", "check", "good.toml"]);
    assert!(!folder.path("out").exists(), "checking runs nothing");
    let schema = summary(&folder.expect(0, &["scenario", "schema"]).stdout);
    assert_eq!(schema["title"], "mmsim scenario", "the schema of scenario files");
    assert!(schema["$schema"].as_str().is_some_and(|uri| uri.contains("json-schema.org")), "a JSON Schema");
    for help in [&["--help"], &["--version"]] {
        let ended = folder.expect(0, help);
        assert!(!ended.stdout.is_empty() && ended.stderr.is_empty(), "{help:?} goes to standard output");
    }
}
