//! A scenario to break, and what has to be said of it then.

use mm_sim::scenario::{self, Loaded, ScenarioError};

/// A scenario to break: the lines are counted in the tests below.
pub(crate) const GOOD: &str = r#"name = "test"

[simulation]
duration_s = 2
plant_step_s = 0.001
control_period_s = 0.001

[robot]
preset = "thesis"
base_mass_kg = 50.0

[trajectory]
kind = "circle"
center_m = [0.0, 0.0, 0.5]
radius_m = 1.0
speed_m_s = -0.3

[[disturbance]]
on = "joint1"
shape = "sine"
amplitude_n_m = 10.0
frequency_rad_s = 2.0
"#;

pub(crate) fn read(text: &str, sets: &[&str]) -> Result<Loaded, ScenarioError> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scenario::from_text("my.toml", text, &sets)
}

/// Replaces one piece of the good scenario.
pub(crate) fn broken(from: &str, to: &str) -> String {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} is in the scenario once");
    GOOD.replace(from, to)
}

/// The rendered error, after checking its first problem's key and place and that it says all of `parts`.
pub(crate) fn fails(text: &str, sets: &[&str], key: &str, place: &str, parts: &[&str]) -> ScenarioError {
    let error = read(text, sets).err().unwrap_or_else(|| panic!("accepted, though {key} is wrong"));
    let shown = error.to_string();
    assert!(shown.is_ascii(), "plain text:\n{shown}");
    let problem = error.problems().first().unwrap_or_else(|| panic!("no problem in {shown}"));
    assert_eq!(problem.key(), key, "the key in:\n{shown}");
    let (name, line, column) = error.location(problem).unwrap_or_else(|| panic!("no place in {shown}"));
    assert_eq!(format!("{name}:{line}:{column}"), place, "the place in:\n{shown}");
    for part in [&format!("--> {place}"), key].iter().chain(parts) {
        assert!(shown.contains(*part), "{part:?} is not in:\n{shown}");
    }
    error
}
