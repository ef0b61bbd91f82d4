//! `--set KEY=VALUE` and robot files: what they change, and what is said when they cannot.

#![expect(clippy::panic, clippy::unwrap_used, reason = "helpers of tests report like a test")]

use std::path::PathBuf;

use mm_sim::scenario::{self, ControllerKind, DisturbanceTarget, Loaded, PerAxis, ScenarioError, TipStart};

const PLAIN: &str = "name = \"p\"\n[simulation]\nduration_s = 1\n[trajectory]\nkind = \"square\"\n";

fn read(sets: &[&str]) -> Result<Loaded, ScenarioError> {
    scenario::from_text("p.toml", PLAIN, &owned(sets))
}

fn owned(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|set| (*set).to_owned()).collect()
}

fn good(sets: &[&str]) -> Loaded {
    read(sets).unwrap_or_else(|error| panic!("{error}"))
}

fn bad(sets: &[&str], parts: &[&str]) {
    let shown = read(sets).err().unwrap_or_else(|| panic!("{sets:?} accepted")).to_string();
    for part in parts {
        assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
    }
}

#[test]
fn values_are_toml_or_bare_words() {
    let file = good(&[
        "controller.kind=bsmc-sat",
        "description=two words, a = sign",
        "simulation.seed=18446744073709551615",
        "simulation.duration_s = 5",
        "controller.outer.position_gain_1_s=[1, 2, 3.5]",
        "trajectory.allow_unreachable=true",
    ])
    .file;
    assert_eq!(file.controller.kind, ControllerKind::BsmcSat, "a bare word");
    assert_eq!(file.description, "two words, a = sign", "only the first = separates");
    assert_eq!(file.simulation.seed, u64::MAX, "all 64 bits of the seed");
    assert!((file.simulation.duration_s - 5.0).abs() < 1e-12, "an integer, with blanks around it");
    assert_eq!(file.controller.outer.position_gain_1_s, Some(PerAxis::Each([1.0, 2.0, 3.5])), "an array");
    assert!(file.trajectory.allow_unreachable, "a truth value");
}

#[test]
fn numbers_keep_every_bit() {
    let value = 0.1 + f64::EPSILON;
    let file = good(&[&format!("plant.mass_scale={value:?}")]).file;
    assert_eq!(file.plant.mass_scale.to_bits(), value.to_bits(), "shortest digits come back to the bit");
}

#[test]
fn the_last_of_two_edits_holds() {
    let file = good(&["simulation.seed=1", "simulation.seed=2"]).file;
    assert_eq!(file.simulation.seed, 2, "edits apply in order");
    assert!(good(&["simulation.seed=1"]).is_modified() && !good(&[]).is_modified(), "an edit is noted");
}

#[test]
fn tables_and_entries_are_made() {
    let file = good(&["robot.link.1.mass_kg=6.5", "plant.friction.wheel_coulomb_n_m=1"]).file;
    let masses: Vec<Option<f64>> = file.robot.fields.link.iter().map(|link| link.mass_kg).collect();
    assert_eq!(masses, [None, Some(6.5)], "link 2 of the preset is changed, link 1 kept");
    let sets = owned(&["disturbance.0.amplitude_n_m=3"]);
    let file = scenario::load("square-compare", &sets).unwrap_or_else(|error| panic!("{error}")).file;
    assert_eq!(file.disturbance.first().and_then(|first| first.amplitude_n_m), Some(3.0), "an entry's key");
    let sets = owned(&["initial.joints_rad.1=0.5"]);
    let file = scenario::load("square", &sets).unwrap_or_else(|error| panic!("{error}")).file;
    assert_eq!(file.initial.joints_rad.map(|joints| joints[1]), Some(0.5), "an entry of an array");
}

#[test]
fn an_edit_displaces_what_it_excludes() {
    let sets = owned(&["initial.base_pose=[1, 2, 0]"]);
    let initial = scenario::load("square", &sets).unwrap_or_else(|error| panic!("{error}")).file.initial;
    assert_eq!((initial.base_pose, initial.tip), (Some([1.0, 2.0, 0.0]), None), "the pose replaces the tip");
    let initial = good(&["initial.tip=on-reference"]).file.initial;
    assert_eq!(initial.tip, Some(TipStart::OnReference), "set where the file has no table");
    bad(&["initial.base_pose=[1, 2, 0]", "initial.tip=on-reference"], &["given together with"]);
}

#[test]
fn bad_edits_name_the_argument() {
    bad(&["simulation.duration_s"], &["--> --set:1:1", "KEY=VALUE", "given over p.toml"]);
    bad(&["=3"], &["--> --set:1:1", "not a dotted key"]);
    bad(&["simulation..seed=3"], &["not a dotted key", "simulation..seed=3"]);
    bad(&["name.first=3"], &["`name`: found a string, which has no key `first`"]);
    bad(&["simulation.duration_s=-1"], &["--> --set:1:23", "found -1", "expected a number above 0"]);
    bad(&["simulation.duration=3"], &["--> --set:1:1", "the nearest known name is `duration_s`"]);
    bad(&["plant.mass_scale=nan"], &["--> --set:1:18", "not a finite number"]);
    bad(&["simulation.duration_s="], &["expected a number above 0"]);
    bad(&["robot.link.3.mass_kg=1"], &["found 4 entries"]);
    bad(&["robot.link.99999999.mass_kg=1"], &["no entry 99999999"]);
    bad(&["robot.link.x.mass_kg=1"], &["`robot.link`"]);
    bad(&["controller.kind=bfsm"], &["found a string, bfsm", "the nearest known name is `bfsmc`"]);
    bad(&["simulation.seed=-1"], &["a whole number of at least 0"]);
    bad(&["simulation.seed=1.5"], &["a whole number of at least 0"]);
    bad(&["simulation.seed=99999999999999999999"], &["a whole number of at least 0"]);
}

#[test]
fn later_stages_point_at_the_place() {
    let loaded = good(&["robot.link.1.mass_kg=6.5"]);
    let shown = loaded.problem("robot.link.1.mass_kg", "too heavy", "at most 6 kg").to_string();
    assert!(shown.contains("--> --set:1:22") && shown.contains("too heavy"), "at the value: {shown}");
    let shown = loaded.problem("simulation.log_rate_hz", "m", "e").to_string();
    assert!(shown.contains("--> p.toml:2:1"), "at the nearest table: {shown}");
    let shown = loaded.problem("controller.gains.fuzzy_gain", "m", "e").to_string();
    assert!(shown.contains("--> p.toml:1:1"), "at the file: {shown}");
}

/// A folder for one test's files, emptied first.
fn folder(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

#[test]
fn robot_files_are_found_beside_the_scenario_and_overridden() {
    let folder = folder("robot_file");
    let robot = "base_mass_kg = 40.0\ntrack_width_m = 0.3\n[[link]]\nmass_kg = 3.0\nlength_m = 0.4\n";
    std::fs::write(folder.join("r.toml"), robot).unwrap();
    let text =
        format!("{PLAIN}[robot]\nfile = \"r.toml\"\ntrack_width_m = 0.25\n[[robot.link]]\nmass_kg = 5\n");
    let path = folder.join("s.toml");
    std::fs::write(&path, text).unwrap();
    let spec = path.to_str().unwrap();
    let loaded = scenario::load(spec, &[]).unwrap_or_else(|error| panic!("{error}"));
    let fields = &loaded.file.robot.fields;
    assert_eq!(fields.base_mass_kg, Some(40.0), "from the robot file");
    assert_eq!(fields.track_width_m, Some(0.25), "the scenario's key overrides the file's");
    let link = fields.link.first().copied().unwrap_or_default();
    assert_eq!((link.mass_kg, link.length_m), (Some(5.0), Some(0.4)), "a link is overridden field by field");
    let shown = loaded.problem("robot.base_mass_kg", "m", "e").to_string();
    assert!(shown.contains("r.toml:1:16"), "a problem in the robot file names it: {shown}");

    std::fs::write(folder.join("r.toml"), "base_mas_kg = 40.0\nwheel_radius_m = 0\n").unwrap();
    let shown = scenario::load(spec, &[]).err().unwrap_or_else(|| panic!("accepted")).to_string();
    for part in ["r.toml:1:1", "`base_mass_kg`", "r.toml:2:18", "found 0"] {
        assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
    }
    std::fs::remove_file(folder.join("r.toml")).unwrap();
    let shown = scenario::load(spec, &[]).err().unwrap_or_else(|| panic!("accepted")).to_string();
    assert!(shown.contains("s.toml:7:8") && shown.contains("r.toml"), "the missing file is named: {shown}");
}

#[test]
fn a_table_is_added_as_a_whole() {
    let torque = |number: usize, joint: &str| {
        format!("disturbance.{number}={{on=\"{joint}\", shape=\"step\", amplitude_n_m=1}}")
    };
    for sets in [[torque(0, "joint1"), torque(1, "joint2")], [torque(1, "joint2"), torque(0, "joint1")]] {
        let loaded = scenario::load("square", &sets).unwrap_or_else(|error| panic!("{error}"));
        let on: Vec<_> = loaded.file.disturbance.iter().map(|one| one.on).collect();
        assert_eq!(on, [DisturbanceTarget::Joint1, DisturbanceTarget::Joint2], "the array of {sets:?}");
    }
    let loaded = scenario::load("square-compare", &[torque(1, "joint3")]);
    let count = loaded.unwrap_or_else(|error| panic!("{error}")).file.disturbance.len();
    assert_eq!(count, 2, "beside the one of the file");
}

#[test]
fn a_file_comes_before_a_bundled_scenario() {
    let folder = folder("file_first");
    let path = folder.join("square");
    std::fs::write(&path, PLAIN).unwrap();
    let loaded = scenario::load(path.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.name(), "p", "the file, not the bundled square");
    let shown = scenario::load(folder.to_str().unwrap(), &[]).err().map(|error| error.to_string());
    assert!(shown.is_some_and(|shown| shown.contains("it is a folder")), "a folder is no scenario");
}
