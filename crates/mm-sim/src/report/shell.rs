//! The page around what is shown: styles, scripts, libraries, and the policy that lets nothing else run.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest as _, Sha256};

use super::payload::{Group, json};
use crate::VERSION;

/// Libraries, as they come; `vendor/README.md` has their versions and licences.
const UPLOT: &str = include_str!("vendor/uPlot.iife.min.js");
const UPLOT_STYLE: &str = include_str!("vendor/uPlot.min.css");
const THREE: &str = include_str!("vendor/three.min.js");
const LICENCES: &str = include_str!("vendor/LICENSES.txt");

const STYLE: &str = include_str!("assets/report.css");
/// Chooses the colours before anything is drawn.
const THEME: &str = include_str!("assets/theme.js");

/// The page's own script: one function, its parts in the order in which they build on each other.
const SCRIPT: &str = concat!(
    "(() => {\n'use strict';\n",
    include_str!("assets/data.js"),
    include_str!("assets/robot.js"),
    include_str!("assets/clock.js"),
    include_str!("assets/plots.js"),
    include_str!("assets/camera.js"),
    include_str!("assets/solid.js"),
    include_str!("assets/flat.js"),
    include_str!("assets/replay.js"),
    include_str!("assets/main.js"),
    "})();\n"
);

/// A part of the page: an identifier, a heading and what is below it.
pub(super) struct Part {
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    pub(super) body: Markup,
}

/// What a page shows.
pub(super) struct Page<'a> {
    pub(super) title: &'a str,
    pub(super) subtitle: String,
    pub(super) groups: &'a [Group],
    /// What stands above the replay.
    pub(super) notices: Vec<String>,
    /// What stands below the plots and what stands above them.
    pub(super) before: Vec<Part>,
    pub(super) after: Vec<Part>,
}

impl Page<'_> {
    /// The file.
    pub(super) fn to_html(&self) -> String {
        let scripts = [THEME, UPLOT, THREE, SCRIPT];
        let styles = [UPLOT_STYLE, STYLE];
        let policy = format!(
            "default-src 'none'; script-src {}; style-src {}; img-src data: blob:; base-uri 'none'; form-action 'none'",
            hashes(&scripts),
            hashes(&styles)
        );
        let own = [("replay", "Replay"), ("plots", "Plots")];
        let links = |parts: &[Part]| parts.iter().map(|part| (part.id, part.title)).collect::<Vec<_>>();
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(policy);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="generator" content=(format!("mmsim {VERSION}"));
                    meta name="color-scheme" content="light dark";
                    link rel="icon" href="data:,";
                    title { (self.title) " \u{b7} mmsim" }
                    @for style in styles { style { (PreEscaped(style)) } }
                    script { (PreEscaped(THEME)) }
                }
                body {
                    a.skip href="#replay" { "Skip to the replay" }
                    header {
                        div { h1 { (self.title) } p { (self.subtitle) } }
                        nav aria-label="Parts of the page" {
                            @for (id, title) in own.iter().take(1).copied().chain(links(&self.before)).chain(own.iter().skip(1).copied()).chain(links(&self.after)) {
                                a href={ "#" (id) } { (title) }
                            }
                        }
                        label.theme { "Colours " select #theme { option value="auto" { "as the system" } option value="light" { "light" } option value="dark" { "dark" } } }
                    }
                    main {
                        (notices(&self.notices))
                        noscript { p.notice { "Replay and plots need JavaScript; tables and texts are complete without it." } }
                        (replay(self.groups))
                        @for part in &self.before { (section(part)) }
                        section #plots aria-labelledby="plots-title" {
                            h2 #plots-title { "Plots" }
                            p.hint { "Drag across a plot to zoom all of them in time, double-click for the whole run, click to move the replay there. "
                                "With a plot in focus: " kbd { "+" } " " kbd { "-" } " " kbd { "\u{2190}" } " " kbd { "\u{2192}" } " " kbd { "0" } "." }
                            div #plot-list {}
                        }
                        @for part in &self.after { (section(part)) }
                        section #licences { details { summary { "Licences of the libraries in this file" } pre tabindex="0" { (LICENCES) } } }
                    }
                    (transport())
                    script type="application/json" id="data" { (PreEscaped(json(self.groups))) }
                    @for script in scripts.iter().skip(1) { script { (PreEscaped(script)) } }
                }
            }
        };
        page.into_string()
    }
}

/// What a reader should know, folded where it is long.
fn notices(texts: &[String]) -> Markup {
    html! {
        @if !texts.is_empty() {
            details.notice open[texts.len() < 3] {
                summary { (texts.len()) @if texts.len() == 1 { " note" } @else { " notes" } " on the runs" }
                ul { @for text in texts { li { (text) } } }
            }
        }
    }
}

fn section(part: &Part) -> Markup {
    let title = format!("{}-title", part.id);
    html! { section id=(part.id) aria-labelledby=(title) { h2 id=(title) { (part.title) } (part.body) } }
}

/// The scene and what is read beside it.
fn replay(groups: &[Group]) -> Markup {
    html! {
        section #replay aria-labelledby="replay-title" {
            div.row {
                h2 #replay-title { "Replay" }
                @if groups.len() > 1 {
                    label { "Experiment " select #group {
                        @for (number, group) in groups.iter().enumerate() { option value=(number) { (group.title) } }
                    } }
                }
            }
            div.stage {
                div.scene {
                    div #scene tabindex="0" role="application" aria-label="Robots, desired and actual paths. Arrow keys turn the view, plus and minus zoom, 0 shows all." {}
                    div.views role="group" aria-label="View" {
                        button type="button" data-view="space" { "3D" }
                        button type="button" data-view="above" { "top" }
                        button type="button" data-view="side" { "side" }
                        button type="button" id="follow" aria-pressed="false" { "follow" }
                        button type="button" id="webgl" aria-pressed="false" title="Draw with WebGL; without a graphics card a plain canvas is quicker" { "WebGL" }
                    }
                }
                div #readout aria-label="Runs at the time of the replay" {}
            }
        }
    }
}

/// Time and what is shown, at the lower edge of the window.
fn transport() -> Markup {
    html! {
        div #transport role="group" aria-label="Replay and what is shown" {
            button #play type="button" aria-label="Play" { "\u{25b6}" }
            input #time type="range" min="0" max="1" step="any" value="0" aria-label="Time of the replay";
            output #clock for="time" { "0.00 s" }
            div.options { label { "speed " select #speed {
                @for speed in ["0.1", "0.25", "0.5", "1", "2", "5", "10", "20"] { option value=(speed) selected[speed == "1"] { "\u{d7} " (speed) } }
            } }
            label title="The paths drawn with their distance from the desired path made larger" { "error " select #magnify {
                @for factor in ["1", "10", "100", "1000"] { option value=(factor) { "\u{d7} " (factor) } }
            } }
            button #whole type="button" { "whole run" }
            div #toggles role="group" aria-label="Curves shown" {} }
        }
    }
}

/// The sources of a policy that are these texts and nothing else.
fn hashes(texts: &[&str]) -> String {
    let hash = |text: &&str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())));
    texts.iter().map(hash).collect::<Vec<_>>().join(" ")
}
