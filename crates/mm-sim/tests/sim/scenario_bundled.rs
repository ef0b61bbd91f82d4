//! The bundled scenarios load, name themselves, and write out what a reader must not have to look up.

use mm_sim::scenario::{self, ControllerKind, Motion, Preset};

#[test]
fn every_bundled_scenario_loads_under_its_name() {
    let no_edits: &[String] = &[];
    for (name, text) in scenario::bundled() {
        let loaded = scenario::from_text(name, text, no_edits).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.name(), *name, "the file names itself");
        assert!(
            !loaded.file.description.is_empty() && !loaded.file.source.is_empty(),
            "{name} explains itself"
        );
        assert_eq!(loaded.file.robot.preset, Some(Preset::Thesis), "{name} names its robot");
        assert!(loaded.file.robot.file.is_none(), "{name} needs no other file");
        assert!(loaded.file.expect.max_error_m.is_some(), "{name} expects something");
        for key in ["\nduration_s = ", "\nplant_step_s = ", "\ncontrol_period_s = "] {
            assert!(text.contains(key), "{name} writes out {}", key.trim());
        }
        assert!(text.is_ascii() && text.ends_with('\n'), "{name} is plain text");
        assert!(!loaded.is_modified(), "{name} stands as it is");
    }
}

#[test]
fn bundled_names_load_with_and_without_the_suffix() {
    for spec in ["square", "square.toml"] {
        let loaded = scenario::load(spec, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.name(), "square", "loaded as {spec}");
        assert_eq!(loaded.source_name(), spec, "named as given");
        assert!(loaded.text().starts_with("name = \"square\""), "the text is the file's");
    }
}

/// The numbers of sections 5.6 to 5.8 as the scenarios give them.
#[test]
fn bundled_scenarios_carry_the_numbers_of_the_thesis() {
    let load = |name| scenario::load(name, &[]).unwrap_or_else(|error| panic!("{error}")).file;
    let durations = [
        ("sinusoid", 60.0),
        ("spiral", 60.0),
        ("square", 98.0),
        ("spiral-disturbed", 60.0),
        ("step-disturbed", 12.0),
        ("spiral-compare", 60.0),
        ("square-compare", 98.0),
    ];
    for (name, duration) in durations {
        let file = load(name);
        assert!((file.simulation.duration_s - duration).abs() < 1e-12, "{name} lasts {duration} s");
        assert_eq!(file.controller.kind, ControllerKind::Bfsmc, "{name} runs the default law");
    }
    let compare = load("square-compare");
    assert!((compare.plant.mass_scale - 1.25).abs() < 1e-12, "the plant is heavier");
    assert_eq!(compare.disturbance.len(), 1, "one disturbance on all joints");
    let Motion::Step { from_m, by_m, at_s } = load("step-disturbed").trajectory.motion else {
        panic!("step-disturbed is a step")
    };
    assert_eq!((from_m, by_m, at_s), ([0.56, 0.0, 0.5], [0.2, 0.1, 0.1], 1.0), "the step of section 5.6.2");
}
