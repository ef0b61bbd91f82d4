//! `include`: a scenario that continues another one, and what is said where it cannot.
//!
//! Law: tables are merged key by key, everything else of the including file replaces what is included; files are sought beside the
//! file that names them; whatever is wrong is placed in the file that it is in; no file includes itself, however indirectly.
//! Reference: files written out here. No tolerance.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_sim::experiment;
use mm_sim::scenario::{self, Loaded, Motion};

use crate::common::command::Folder;
use crate::common::scenario::GOOD;

/// Loads a file of the folder.
fn load(folder: &Folder, name: &str, sets: &[&str]) -> Result<Loaded, scenario::ScenarioError> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scenario::load(&folder.path(name).display().to_string(), &sets)
}

fn good(folder: &Folder, name: &str, sets: &[&str]) -> Loaded {
    load(folder, name, sets).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(folder: &Folder, name: &str, parts: &[&str]) {
    let shown = load(folder, name, &[]).err().unwrap_or_else(|| panic!("{name} is accepted")).to_string();
    for part in parts {
        assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
    }
}

#[test]
fn own_keys_lie_over_included_ones() {
    let folder = Folder::new("include");
    folder.write("base.toml", &format!("{GOOD}[[robot.link]]\nmass_kg = 5\n[[robot.link]]\nmass_kg = 7\n"));
    folder.write("more.toml", "[plant]\nmass_scale = 1.5\npayload_kg = 1\n");
    let own = "include = [\"base.toml\", \"more.toml\"]\nname = \"mine\"\n[simulation]\nduration_s = 3\n[plant]\nmass_scale = 2\n\
               [[robot.link]]\nlength_m = 0.6\n[[disturbance]]\non = \"joint2\"\nshape = \"step\"\namplitude_n_m = 1\n";
    folder.write("mine.toml", own);
    let loaded = good(&folder, "mine.toml", &["simulation.seed=7"]);
    let file = &loaded.file;
    assert_eq!(
        (loaded.name(), file.simulation.seed),
        ("mine", 7),
        "the name is its own, an edit lies over all"
    );
    assert!((file.simulation.duration_s - 3.0).abs() < 1e-12, "a key of a table replaces the included one");
    assert!((file.simulation.plant_step_s - 1e-3).abs() < 1e-12, "and leaves those beside it");
    assert_eq!((file.plant.mass_scale, file.plant.payload_kg), (2.0, 1.0), "of the second file too");
    let links: Vec<_> = file.robot.fields.link.iter().map(|link| (link.length_m, link.mass_kg)).collect();
    assert_eq!(links, [(Some(0.6), Some(5.0)), (None, Some(7.0))], "a link changes the fields that it gives");
    assert_eq!(file.disturbance.len(), 1, "disturbances are not added to those included");
    let again = loaded.edited(&["plant.payload_kg=3".to_owned()]).unwrap_or_else(|error| panic!("{error}"));
    assert!((again.file.plant.payload_kg - 3.0).abs() < 1e-12, "edited once more");
    assert_eq!(loaded.files().count(), 2, "both files go into a log");
}

#[test]
fn files_are_sought_beside_the_file_that_names_them() {
    let folder = Folder::new("include-folders");
    std::fs::create_dir_all(folder.path("parts/robots")).unwrap_or_else(|error| panic!("{error}"));
    folder.write(
        "parts/robots/heavy.toml",
        &scenario::robot_file_toml(&mm_model::RobotParams::thesis())
            .replace("base_mass_kg = 50.0", "base_mass_kg = 80.0"),
    );
    folder.write("parts/robot.toml", "[robot]\nfile = \"robots/heavy.toml\"\n");
    folder.write("mine.toml", "include = [\"square\", \"parts/robot.toml\"]\nname = \"mine\"\n");
    let loaded = good(&folder, "mine.toml", &[]);
    let robot = experiment::robot(&loaded).unwrap_or_else(|error| panic!("{error}"));
    assert!((robot.params().base_mass - 80.0).abs() < 1e-12, "the preset of the bundled scenario gave way");
    folder
        .write("mine.toml", "include = \"square\"\n[trajectory]\nkind = \"hold\"\npoint_m = [0.5, 0, 0.5]\n");
    let motion = good(&folder, "mine.toml", &[]).file.trajectory.motion;
    assert!(
        matches!(motion, Motion::Hold { .. }),
        "a motion of another kind leaves nothing of the old: {motion:?}"
    );
    folder.write("mine.toml", "include = \"square\"\n");
    let again = good(&folder, "mine.toml", &[]).snapshot().restore();
    assert!(again.is_ok_and(|again| again.name() == "square"), "a snapshot holds what is included");
}

#[test]
fn what_is_wrong_is_placed_in_its_file() {
    let folder = Folder::new("include-errors");
    folder.write("base.toml", &GOOD.replace("50.0", "-50.0"));
    folder.write("mine.toml", "include = \"base.toml\"\n[simulation]\nsed = 1\n");
    refused(
        &folder,
        "mine.toml",
        &["base.toml:10:16", "found -50.0", "mine.toml:3:1", "nearest known name is `seed`"],
    );
    folder.write("base.toml", "name = \n");
    refused(&folder, "mine.toml", &["base.toml:1:8", "not TOML"]);
    for (include, parts) in [
        ("\"base.tml\"", ["cannot read", "mine.toml:1:11", "base.tml"]),
        ("\"squar\"", ["cannot read", "the nearest known name is `square`", "mine.toml:1:11"]),
        ("[\"base.toml\", 3]", ["found a number", "mine.toml:1:25", "expected a file, or an array of files"]),
        ("true", ["found a truth value", "mine.toml:1:11", "expected a file"]),
    ] {
        folder.write("base.toml", GOOD);
        folder.write("mine.toml", &format!("include = {include}\n"));
        refused(&folder, "mine.toml", &parts);
    }
    let edited =
        scenario::load("square", &["include=base.toml".to_owned()]).err().map(|error| error.to_string());
    assert!(
        edited.is_some_and(|text| text.contains("--set:1:9") && text.contains("in a file alone")),
        "not by an edit"
    );
}

#[test]
fn no_file_includes_itself() {
    let folder = Folder::new("include-circle");
    folder.write("a.toml", "include = \"b.toml\"\n");
    folder.write("b.toml", "include = \"c.toml\"\n");
    for last in ["a.toml", "b.toml", "c.toml", "./../include-circle/b.toml"] {
        folder.write("c.toml", &format!("# last\ninclude = \"{last}\"\n"));
        refused(&folder, "a.toml", &["c.toml:2:11", last, "expected files that do not include themselves"]);
    }
    folder.write("c.toml", GOOD);
    folder.write("b.toml", "include = [\"c.toml\", \"c.toml\"]\n");
    assert_eq!(good(&folder, "a.toml", &[]).name(), "test", "twice the same is no circle");
}
