//! Every kind of picture shows what it says, of one run and of several, and stays a small, whole SVG.
//!
//! Laws: a picture is well-formed XML whose texts name quantities with units; curves stay on the canvas; what was desired is
//! dashed; the same recording gives the same bytes; chatter keeps its height; a recording has a value for each name, in order.
//! Why: pictures go into papers, data into other programs.
//! Reference: the XML reader `roxmltree`, and the samples themselves. No tolerance but half a unit of the file for rounding.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use mm_sim::experiment::Experiment;
use mm_sim::figures::{Axis, Curve, Graph, Group, Kind, Page, Panel, Recording, Run, Stroke};
use mm_sim::scenario;
use roxmltree::Document;

const KINDS: [Kind; 12] = [
    Kind::Position,
    Kind::Joints,
    Kind::JointTorques,
    Kind::BaseVelocity,
    Kind::WheelTorques,
    Kind::Errors,
    Kind::Path,
    Kind::Disturbance,
    Kind::BasePath,
    Kind::BaseWorldVelocity,
    Kind::TipVelocity,
    Kind::FromAbove,
];

fn recorded(name: &str, sets: &[&str]) -> Recording {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let loaded = scenario::load(name, &sets).unwrap_or_else(|error| panic!("{error}"));
    let experiment = Experiment::build(&loaded).unwrap_or_else(|error| panic!("{error}"));
    let mut recording = Recording::of(&experiment);
    let Ok(_) = experiment.run(&mut recording);
    recording
}

fn spiral(law: &str) -> Recording {
    recorded("spiral-compare", &[&format!("controller.kind={law}"), "simulation.duration_s=1.5"])
}

fn parsed(svg: &str) -> Document<'_> {
    Document::parse(svg).unwrap_or_else(|error| panic!("not well-formed: {error}"))
}

fn texts(document: &Document<'_>) -> Vec<String> {
    let all = document.descendants().filter(|node| node.has_tag_name("text"));
    all.filter_map(|node| node.text()).map(|text| text.trim().to_owned()).collect()
}

/// Points of all polylines, by stroke colour.
fn lines(document: &Document<'_>) -> Vec<(String, Vec<(f64, f64)>)> {
    let all = document.descendants().filter(|node| node.has_tag_name("polyline"));
    all.map(|node| {
        let points = node.attribute("points").expect("a line has points").split_whitespace();
        let point = |text: &str| {
            let (x, y) = text.split_once(',').expect("x,y");
            (x.parse().expect("a number"), y.parse().expect("a number"))
        };
        (node.attribute("stroke").expect("a line has a colour").to_owned(), points.map(point).collect())
    })
    .collect()
}

#[test]
fn every_kind_draws_one_run_and_several() {
    let (first, second) = (spiral("bsmc"), spiral("bfsmc"));
    let runs = [Run { name: "bsmc", data: &first }, Run { name: "bfsmc", data: &second }];
    for kind in KINDS {
        for runs in [&runs[..1], &runs[..]] {
            let what = format!("{kind:?} of {} run(s)", runs.len());
            let svg = kind.page("a < b & c", runs).to_svg().expect("a picture");
            let document = parsed(&svg);
            let texts = texts(&document);
            assert_eq!(texts.first().map(String::as_str), Some("a < b & c"), "{what}: the title, escaped");
            assert!(
                texts
                    .iter()
                    .any(|text| text.contains("(m") || text.contains("(rad") || text.contains("(N m)")),
                "{what}: units on the axes, among {texts:?}"
            );
            let root = document.root_element();
            let view: Vec<f64> = root
                .attribute("viewBox")
                .expect("a size")
                .split(' ')
                .map(|n| n.parse().expect("a number"))
                .collect();
            let lines = lines(&document);
            assert!(lines.len() > 3, "{what}: {} lines", lines.len());
            for (color, points) in lines {
                let inside = |&(x, y): &(f64, f64)| x >= 0.0 && x <= view[2] && y >= 0.0 && y <= view[3];
                assert!(points.iter().all(inside), "{what}: a line of {color} leaves the canvas");
            }
            assert!(svg.len() < 300_000, "{what}: {} bytes", svg.len());
            assert_eq!(svg, kind.page("a < b & c", runs).to_svg().expect("a picture"), "{what}: drawn twice");
        }
    }
}

#[test]
fn what_was_desired_is_dashed_and_in_the_legend() {
    let run = spiral("bfsmc");
    let svg = Kind::Position.page("", &[Run { name: "bfsmc", data: &run }]).to_svg().expect("a picture");
    let document = parsed(&svg);
    let texts = texts(&document);
    for name in ["tip", "desired", "tip x (m)", "tip z (m)", "time (s)"] {
        assert!(texts.iter().any(|text| text == name), "{name:?} is among {texts:?}");
    }
    let lines = lines(&document);
    let of = |color: &str| lines.iter().filter(|(found, _)| found == color).count();
    // A dash is a line of its own: three panels and the legend.
    assert!(of("#000000") > 100, "{} dashes", of("#000000"));
    assert_eq!(of("#0072B2"), 4, "one solid line in each panel and in the legend");
}

#[test]
fn imposed_motions_are_compared_with_the_closed_form() {
    let run = recorded("verify-joint2", &[]);
    let runs = [Run { name: "none", data: &run }];
    let page = Kind::TipVelocity.page("", &runs);
    let [Panel::Graph(x), _, Panel::Graph(z)] = &page.panels[..] else { panic!("three graphs") };
    for graph in [x, z] {
        let [tip, closed] = &graph.curves[..] else { panic!("two curves") };
        assert_eq!(closed.name, "closed form", "no controller, no wish");
        for (a, b) in tip.points.iter().zip(&closed.points) {
            // J nu of the integrated motion against that of the closed form: see the scenario's [expect].
            assert!((a[1] - b[1]).abs() < 1e-9, "{a:?} against {b:?}");
        }
    }
}

#[test]
fn compared_errors_are_the_largest_of_each_window() {
    let (first, second) = (spiral("bsmc"), spiral("bfsmc"));
    let runs = [Run { name: "bsmc", data: &first }, Run { name: "bfsmc", data: &second }];
    let page = Kind::Position.page("", &runs);
    let Some(Panel::Graph(z)) = page.panels.last() else { panic!("a graph") };
    for (curve, run) in z.curves.iter().zip(&runs) {
        for [middle, worst] in &curve.points {
            let inside = run.data.time().iter().zip(run.data.column(Group::Error, 2));
            let largest = inside
                .filter(|(t, _)| **t >= middle - 0.25 && **t < middle + 0.25)
                .map(|(_, e)| e.abs() * 1e3)
                .fold(0.0, f64::max);
            assert_eq!(worst.to_bits(), largest.to_bits(), "{} at {middle} s", run.name);
        }
        assert_eq!(curve.points.len(), 3, "windows of half a second");
    }
}

#[test]
fn a_relay_fills_its_panel() {
    let points = (0..20_000).map(|i| [f64::from(i) * 0.001, if i % 2 == 0 { 30.0 } else { -30.0 }]).collect();
    let stroke = Stroke::of_law("bsmc").thin();
    let curves = vec![Curve { name: "relay".to_owned(), stroke, points }];
    let graph = Graph { title: String::new(), x: Axis::new("t"), y: Axis::new("tau"), is_map: false, curves };
    let page = Page { title: String::new(), columns: 1, panels: vec![Panel::Graph(graph)] };
    let svg = page.to_svg().expect("a picture");
    assert!(svg.len() < 60_000, "{} bytes for 20,000 points", svg.len());
    let document = parsed(&svg);
    let longest = lines(&document).into_iter().map(|(_, points)| points).max_by_key(Vec::len).expect("lines");
    let turns = longest.windows(2).filter(|pair| (pair[0].1 - pair[1].1).abs() > 400.0).count();
    assert!(turns > 640, "{turns} strokes from top to bottom over some 640 pixels");
}

#[test]
fn data_have_a_name_and_a_value_for_each_column() {
    let run = recorded("square", &["simulation.duration_s=0.2"]);
    let mut csv = Vec::new();
    run.write_csv(&mut csv).expect("memory takes it");
    let text = String::from_utf8(csv).expect("text");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(header, Recording::names().collect::<Vec<_>>(), "the names of all columns");
    assert_eq!(header[..4], ["t_s", "x_m", "y_m", "heading_rad"], "time and pose first");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|value| value.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 20, "100 samples a second");
    let at = |name: &str| header.iter().position(|other| *other == name).expect("a column");
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(row.len(), header.len(), "row {number}");
        for side in ["x", "y", "z"] {
            let [tip, reference, error] =
                ["tip_S_m", "reference_S_m", "error_S_m"].map(|name| row[at(&name.replace('S', side))]);
            // Seven digits of numbers below 1.
            assert!((tip - reference - error).abs() < 2e-7, "{side} in row {number}");
        }
    }
    assert_eq!(run.column(Group::Tip, 3), [0.0; 0], "there is no fourth direction");
}
