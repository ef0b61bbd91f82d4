//! What the scripts of the page get: JSON that stands in the page as text and can end no element.

use serde::Serialize;

use super::colors::{Color, of_runs};
use super::plots::{ERROR_NORM, SECTIONS, Section, signals};
use super::series::{base64_of, encoded};
use crate::figures::Recording;
use crate::log::LogFile;

/// Points of a desired path at most.
const PATH_POINTS: usize = 2000;

/// Where signals come from: columns by the names of the log's fields.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Signals<'a> {
    Log(&'a LogFile),
    Recording(&'a Recording),
}

impl Signals<'_> {
    fn get(&self, name: &str) -> &[f64] {
        match self {
            Self::Log(log) => log.columns.get(name),
            Self::Recording(recording) => recording.named(name),
        }
    }

    /// The desired path: the whole of it where the log has it.
    fn desired_path(&self) -> Vec<[f64; 3]> {
        match self {
            Self::Log(log) if !log.reference.is_empty() => {
                log.reference.iter().map(|[_, x, y, z]| [*x, *y, *z]).collect()
            }
            _ => {
                let [x, y, z] =
                    ["reference_x_m", "reference_y_m", "reference_z_m"].map(|name| self.get(name));
                x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z]).collect()
            }
        }
    }

    /// Distance of the tip from its reference, m.
    fn error_norm(&self) -> Vec<f64> {
        let [x, y, z] = ["error_x_m", "error_y_m", "error_z_m"].map(|name| self.get(name));
        x.iter().zip(y).zip(z).map(|((x, y), z)| libm::sqrt(x * x + y * y + z * z)).collect()
    }
}

/// A run as the page has it.
#[derive(Debug, Serialize)]
pub(crate) struct Run {
    name: String,
    color: Option<Color>,
    law: String,
    samples: usize,
    begin_s: f64,
    end_s: f64,
    urdf: String,
    path: String,
    signals: serde_json::Map<String, serde_json::Value>,
}

impl Run {
    /// A run of a law under a name.
    pub(crate) fn new((name, law): (&str, &str), urdf: &str, signals_of: Signals<'_>) -> Self {
        let time = signals_of.get("t_s");
        let norm = signals_of.error_norm();
        let signal = |(name, is_logarithmic): (&str, bool)| {
            let values = if name == ERROR_NORM { &norm } else { signals_of.get(name) };
            encoded(time, values, is_logarithmic).map(|text| (name.to_owned(), text.into()))
        };
        let path = signals_of.desired_path();
        let stride = path.len().div_ceil(PATH_POINTS).max(1);
        Self {
            name: name.to_owned(),
            law: law.to_owned(),
            color: None,
            samples: time.len(),
            begin_s: time.first().copied().unwrap_or_default(),
            end_s: time.last().copied().unwrap_or_default(),
            urdf: urdf.to_owned(),
            path: base64_of(path.into_iter().step_by(stride).flatten()),
            signals: signals().into_iter().filter_map(signal).collect(),
        }
    }
}

/// Runs that are shown together.
#[derive(Debug, Serialize)]
pub(crate) struct Group {
    pub(super) title: String,
    pub(super) runs: Vec<Run>,
}

impl Group {
    /// Runs under a title, each with a colour.
    pub(crate) fn new(title: impl Into<String>, mut runs: Vec<Run>) -> Self {
        let laws: Vec<&str> = runs.iter().map(|run| run.law.as_str()).collect();
        for (color, run) in of_runs(&laws).into_iter().zip(&mut runs) {
            run.color = Some(color);
        }
        Self { title: title.into(), runs }
    }
}

#[derive(Serialize)]
struct Payload<'a> {
    sections: &'static [Section],
    groups: &'a [Group],
}

/// The groups as JSON in which no `<` stands, so that it can be the text of an element.
pub(super) fn json(groups: &[Group]) -> String {
    let text = serde_json::to_string(&Payload { sections: SECTIONS, groups }).unwrap_or_default();
    text.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::{Group, Run, Signals, json};
    use crate::log::LogFile;

    #[test]
    fn a_name_ends_no_element() {
        let log = LogFile::default();
        let run = Run::new(("</script><b>&", "bfsmc"), "<robot/>", Signals::Log(&log));
        let text = json(&[Group::new("<!--", vec![run])]);
        assert!(!text.contains('<'), "no element begins or ends: {text}");
        let back: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(back["groups"][0]["runs"][0]["name"], "</script><b>&", "and the name is the same");
    }
}
