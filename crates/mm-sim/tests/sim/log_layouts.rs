//! The layouts for viewers name what a log has.
//!
//! Law: every topic and field in `layouts/` is one that the writer registers. Why: a viewer shows an empty panel for a wrong name and
//! says nothing. Reference: the lists of the writer itself. No tolerance.

#![expect(clippy::panic, reason = "a helper that cannot go on is a failed test")]

use mm_sim::log::{control_field_names, topics};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

fn layout(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../layouts").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn check_field(topic: &str, field: &str) {
    assert_eq!(topic, "/control", "plots are of the flat message");
    assert!(control_field_names().any(|known| known == field), "{topic} has no field {field}");
}

fn topic_names() -> BTreeSet<&'static str> {
    topics().map(|(topic, _)| topic).collect()
}

#[test]
fn foxglove_and_lichtblick() {
    let layout: Value = serde_json::from_str(&layout("foxglove.json")).expect("JSON");
    let panels = layout["configById"].as_object().expect("panels");
    let mut curves = 0;
    for (id, panel) in panels {
        for path in panel["paths"].as_array().into_iter().flatten() {
            let (topic, field) = path["value"].as_str().and_then(|p| p.split_once('.')).expect("topic.field");
            check_field(topic, field);
            curves += 1;
        }
        for topic in panel["topics"].as_object().into_iter().flat_map(|topics| topics.keys()) {
            assert!(topic_names().contains(topic.as_str()), "{id}: {topic}");
        }
        assert!(layout["layout"].to_string().contains(&format!("\"{id}\"")), "{id} has a place");
    }
    assert!(curves >= 15, "{curves} curves");
    let scene = &panels["3D!robot"]["topics"];
    for topic in ["/robot_description", "/reference", "/path", "/disturbance"] {
        assert_eq!(scene[topic]["visible"], true, "{topic} is shown");
    }
}

#[test]
fn plotjuggler() {
    let text = layout("plotjuggler.xml");
    let layout = roxmltree::Document::parse(&text).expect("XML");
    let curves: Vec<&str> = layout
        .descendants()
        .filter(|n| n.has_tag_name("curve"))
        .filter_map(|n| n.attribute("name"))
        .collect();
    assert!(curves.len() >= 15, "{curves:?}");
    for curve in curves {
        let (topic, field) = curve.rsplit_once('/').expect("topic/field");
        check_field(topic, field);
    }
}

/// The texts between quotes of a part of a program.
fn quoted(text: &str) -> Vec<&str> {
    text.split('"').skip(1).step_by(2).collect()
}

#[test]
fn rerun() {
    let program = layout("show_in_rerun.py");
    let line = |begin: &str| {
        let found = program.lines().find(|line| line.trim_start().starts_with(begin));
        found.unwrap_or_else(|| panic!("a line that begins with {begin}"))
    };
    for topic in quoted(line("topics = ")).into_iter().chain(quoted(line("COLORS = "))) {
        assert!(topic_names().contains(topic), "{topic}");
    }
    let five = quoted(line("five = "));
    let logged = quoted(line("PLOTTED = "));
    let mut curves = 0;
    for plot in program.lines().filter(|line| line.trim_start().starts_with("plot(")) {
        let texts = quoted(plot);
        let (Some(prefix), Some(suffix)) = (texts.get(1), texts.last()) else { panic!("{plot}") };
        assert!(logged.contains(prefix), "{prefix} is logged");
        let names = if plot.contains("five") { five.as_slice() } else { &texts[2..texts.len() - 1] };
        for name in names {
            check_field("/control", &format!("{prefix}{name}{suffix}"));
            curves += 1;
        }
    }
    assert_eq!(curves, 13, "three errors, five torques, five disturbances");
}
