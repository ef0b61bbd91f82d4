//! The gains of the law that runs come from `gains`, `gains_file` and `gains_for` in that order, and what an argument gives comes first.
//!
//! Law: what is meant for one law overrides what is meant for all, the scenario overrides the file, an argument overrides both; a
//! table for another law has no effect; a wrong name in any of them is reported where it stands, with the nearest known one.
//! Why: one scenario compares laws that need gains of their own, and a tuned file has to mean what it says.
//! Reference: the values written here; no tolerance.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::Folder;
use mm_sim::scenario::{self, Loaded, ScenarioError};

const TEXT: &str = "name = \"g\"\n[simulation]\nduration_s = 0.01\n[trajectory]\nkind = \"square\"\n[controller]\nkind = \"bfsmc\"\n\
    [controller.gains]\nobserver_bandwidth_1_s = 1.0\n";

fn load(folder: &Folder, text: &str, sets: &[&str]) -> Result<Loaded, ScenarioError> {
    folder.write("g.toml", text);
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scenario::load(folder.path("g.toml").to_str().expect("text"), &sets)
}

fn bandwidth(folder: &Folder, text: &str, sets: &[&str]) -> Option<f64> {
    let loaded = load(folder, text, sets).unwrap_or_else(|error| panic!("{error}"));
    loaded.file.controller.gains.observer_bandwidth_1_s
}

#[test]
fn what_is_meant_for_one_law_comes_before_what_is_meant_for_all() {
    let folder = Folder::new("gains-order");
    folder
        .write("tuned.toml", "[bfsmc]\nobserver_bandwidth_1_s = 2.0\n[bsmc]\nobserver_bandwidth_1_s = 9.0\n");
    let named = TEXT.replace("kind = \"bfsmc\"\n", "kind = \"bfsmc\"\ngains_file = \"tuned.toml\"\n");
    let own = "[controller.gains_for.bfsmc]\nobserver_bandwidth_1_s = 3.0\n";
    let other = "[controller.gains_for.bsmc-sat]\nobserver_bandwidth_1_s = 8.0\n";
    let path = folder.path("tuned.toml");
    let by_argument = format!("controller.gains_file={}", path.to_str().expect("text"));
    let all = format!("{named}{own}");
    let set = "controller.gains.observer_bandwidth_1_s=4";
    let set_for = "controller.gains_for.bfsmc.observer_bandwidth_1_s=5";
    for (what, text, sets, wanted) in [
        ("gains alone", TEXT, &[] as &[&str], 1.0),
        ("a file over them", &named, &[], 2.0),
        ("the scenario's own over the file", &all, &[], 3.0),
        ("the table of another law", &format!("{TEXT}{other}"), &[], 1.0),
        ("another law", &all, &["controller.kind=bsmc"], 9.0),
        ("a file by argument", &format!("{TEXT}{own}"), &[&by_argument], 2.0),
        ("an argument", &all, &[set], 4.0),
        ("two arguments", &all, &[set, set_for], 5.0),
        ("two arguments, the other way", &all, &[set_for, set], 5.0),
        ("an argument and a file by argument", &all, &[&by_argument, set], 2.0),
        ("an argument for the law after a file by argument", &all, &[&by_argument, set_for], 5.0),
        ("a file by argument after an argument for the law", &all, &[set_for, &by_argument], 2.0),
    ] {
        assert_eq!(bandwidth(&folder, text, sets), Some(wanted), "{what}");
    }
    let default =
        TEXT.replace("kind = \"bfsmc\"\n", "").replace("[controller.gains]\nobserver", "# observer");
    assert_eq!(bandwidth(&folder, &format!("{default}{own}"), &[]), Some(3.0), "the law that is the default");
}

/// Law: a scenario that was read stays what it is whatever becomes of the files that it names; what is named anew is read anew.
#[test]
fn files_are_read_once() {
    let folder = Folder::new("gains-once");
    let tuned = |value: u32| format!("[bfsmc]\nobserver_bandwidth_1_s = {value}.0\n");
    let points = |z: f64| format!("x_m,y_m,z_m\n0.4,0,0.4\n0.5,0.1,{z}\n0.6,0,0.4\n");
    folder.write("tuned.toml", &tuned(2));
    folder.write("points.csv", &points(0.4));
    folder.write("robot.toml", "base_mass_kg = 20.0\n");
    let named =
        TEXT.replace("kind = \"bfsmc\"\n", "kind = \"bfsmc\"\ngains_file = \"tuned.toml\"\n").replace(
            "kind = \"square\"",
            "kind = \"waypoints\"\nfile = \"points.csv\"\nspeed_m_s = 0.5\nacceleration_m_s2 = 1.0\njerk_m_s3 = 5.0\n[robot]\nfile = \"robot.toml\"",
        );
    let loaded = load(&folder, &named, &[]).unwrap_or_else(|error| panic!("{error}"));
    let edit = ["plant.mass_scale=1.1".to_owned()];
    let edited = || loaded.edited(&edit).unwrap_or_else(|error| panic!("{error}"));
    let before = edited();
    folder.write("tuned.toml", &tuned(3));
    folder.write("points.csv", &points(0.5));
    folder.write("robot.toml", "base_mass_kg = 30.0\n");
    let after = edited();
    assert_eq!(after.digest(), before.digest(), "the texts");
    assert_eq!(after.file, before.file, "and what they say");
    assert_ne!(
        load(&folder, &named, &edit.each_ref().map(String::as_str)).expect("a scenario").digest(),
        after.digest()
    );
    let anew = format!("controller.gains_file={}", folder.path("tuned.toml").display());
    let anew = loaded.edited(&[anew]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(anew.file.controller.gains.observer_bandwidth_1_s, Some(3.0), "named anew, read anew");
}

#[test]
fn a_wrong_name_is_reported_where_it_stands() {
    let folder = Folder::new("gains-errors");
    let named = TEXT.replace("kind = \"bfsmc\"\n", "kind = \"bfsmc\"\ngains_file = \"tuned.toml\"\n");
    for (tuned, text, parts) in [
        ("[bsmc_sat]\n", named.as_str(), &["tuned.toml:1:2", "unknown key", "`bsmc-sat`"] as &[&str]),
        ("[bsmc]\n\nswitching_gian = 1\n", &named, &["tuned.toml:3:1", "`switching_gain`"]),
        ("[bsmc]\nfuzzy_gain = [1, 2]\n", &named, &["tuned.toml:2:14", "array of 5 numbers"]),
        ("[bsmc\n", &named, &["tuned.toml:1", "not TOML"]),
        ("", &format!("{TEXT}[controller.gains_for.bfsm]\n"), &["g.toml:10:", "`bfsmc`"]),
        (
            "",
            &format!("{TEXT}[controller.gains_for.bsmc]\nfuzzy_gian = 1\n"),
            &["g.toml:11:1", "`fuzzy_gain`"],
        ),
        ("", &named.replace("tuned.toml", "none.toml"), &["g.toml:8:", "none.toml", "a file of gains"]),
    ] {
        folder.write("tuned.toml", tuned);
        let error = load(&folder, text, &[]).err().unwrap_or_else(|| panic!("accepted:\n{text}")).to_string();
        for part in parts {
            assert!(error.contains(part), "{part:?} is not in:\n{error}");
        }
    }
}
