//! The table of metrics: a row each, a column for each run, and how far each is from the first.

use maud::{Markup, html};
use serde_json::Value;

use crate::number::short;

/// A metric: its name, its unit, where it is in the summary's metrics, what it is multiplied by, and whether less is better.
struct Metric(&'static str, &'static str, &'static str, f64, bool);

const METRICS: [Metric; 29] = [
    Metric("ITAE x", "m s^2", "/itae_m_s2/x", 1.0, true),
    Metric("ITAE y", "m s^2", "/itae_m_s2/y", 1.0, true),
    Metric("ITAE z", "m s^2", "/itae_m_s2/z", 1.0, true),
    Metric("ITAE, sum", "m s^2", "/itae_m_s2/sum", 1.0, true),
    Metric("IAE, sum", "m s", "/iae_m_s/sum", 1.0, true),
    Metric("ISE, sum", "m^2 s", "/ise_m2_s/sum", 1.0, true),
    Metric("RMS error x", "mm", "/rmse_m/x", 1e3, true),
    Metric("RMS error y", "mm", "/rmse_m/y", 1e3, true),
    Metric("RMS error z", "mm", "/rmse_m/z", 1e3, true),
    Metric("RMS error", "mm", "/rmse_m/norm", 1e3, true),
    Metric("largest error", "mm", "/max_error_m", 1e3, true),
    Metric("within 10 mm from", "s", "/settling_time_s", 1.0, true),
    Metric("torque variation, joint 1", "N m/s", "/torque_tv_n_m_per_s/joints/0", 1.0, true),
    Metric("torque variation, joint 2", "N m/s", "/torque_tv_n_m_per_s/joints/1", 1.0, true),
    Metric("torque variation, joint 3", "N m/s", "/torque_tv_n_m_per_s/joints/2", 1.0, true),
    Metric("torque variation, right wheel", "N m/s", "/torque_tv_n_m_per_s/right", 1.0, true),
    Metric("torque variation, left wheel", "N m/s", "/torque_tv_n_m_per_s/left", 1.0, true),
    Metric("torque variation, sum", "N m/s", "/torque_tv_n_m_per_s/sum", 1.0, true),
    Metric("peak torque, joint 1", "N m", "/peak_torque_n_m/joints/0", 1.0, true),
    Metric("peak torque, joint 2", "N m", "/peak_torque_n_m/joints/1", 1.0, true),
    Metric("peak torque, joint 3", "N m", "/peak_torque_n_m/joints/2", 1.0, true),
    Metric("peak torque, right wheel", "N m", "/peak_torque_n_m/right", 1.0, true),
    Metric("peak torque, left wheel", "N m", "/peak_torque_n_m/left", 1.0, true),
    Metric("effort", "N^2 m^2 s", "/effort_n2_m2_s", 1.0, true),
    Metric("energy", "J", "/energy_j", 1.0, true),
    Metric("periods with a limited torque", "%", "/saturated_fraction", 100.0, true),
    Metric("largest speed of the base", "m/s", "/max_speed_m_s", 1.0, false),
    Metric("least manipulability", "", "/min_manipulability", 1.0, false),
    Metric("joint limits crossed", "times", "/joint_limit_crossings", 1.0, true),
];

/// The metrics that say most, shown beside the replay.
pub(super) const IN_SHORT: [&str; 4] = ["ITAE, sum", "RMS error", "largest error", "torque variation, sum"];

impl Metric {
    fn of(&self, metrics: Option<&Value>) -> Option<f64> {
        metrics?.pointer(self.2)?.as_f64().map(|value| value * self.3)
    }
}

/// A run in the table: its name, and its metrics if it reached its end.
pub(super) type Column<'a> = (&'a str, Option<&'a Value>);

/// The table of some runs.
pub(super) fn table(columns: &[Column<'_>]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label="Metrics of the runs" { table {
            caption {
                "Errors are those of the true tip, actual minus desired, at every control period."
                @if columns.len() > 1 { " Percentages: difference from the first run. " b { "Bold" } ": the best of the row." }
            }
            thead { tr {
                th scope="col" { "metric" }
                @for (name, _) in columns { th scope="col" { (name) } }
                th scope="col" { "unit" }
            } }
            tbody {
                @for metric in &METRICS { (row(metric, columns)) }
                tr {
                    th scope="row" { "reaching condition" }
                    @for (_, metrics) in columns { td { (reaching(*metrics)) } }
                    td {}
                }
            }
        } }
    }
}

fn row(metric: &Metric, columns: &[Column<'_>]) -> Markup {
    let values: Vec<Option<f64>> = columns.iter().map(|(_, metrics)| metric.of(*metrics)).collect();
    let first = values.first().copied().flatten();
    let best = values.iter().flatten().copied().reduce(f64::min);
    let is_best = |value: f64| metric.4 && values.len() > 1 && best.is_some_and(|best| value <= best);
    let are_alike = values.windows(2).all(|pair| pair.first() == pair.last());
    html! {
        tr {
            th scope="row" { (metric.0) }
            @for (number, value) in values.iter().enumerate() {
                td {
                    @match value {
                        Some(value) if is_best(*value) && !are_alike => b { (short(*value)) },
                        Some(value) => (short(*value)),
                        None => "-",
                    }
                    @if number > 0 { @if let Some(text) = difference(first, *value) { " " small { (text) } } }
                }
            }
            td.unit { (metric.1) }
        }
    }
}

/// How far a value is from the first run's, in percent; where it is several times as large, that.
fn difference(first: Option<f64>, value: Option<f64>) -> Option<String> {
    let ratio = value? / first?;
    if !ratio.is_finite() || ratio < 0.0 {
        None
    } else if ratio >= 10.0 {
        Some(format!("x {}", short(ratio)))
    } else if (ratio - 1.0).abs() < 5e-5 {
        Some("=".to_owned())
    } else {
        Some(format!("{:+.1} %", 100.0 * (ratio - 1.0)))
    }
}

fn reaching(metrics: Option<&Value>) -> &'static str {
    match metrics.and_then(|metrics| metrics.get("reaching_condition_met")).map(Value::as_bool) {
        Some(Some(true)) => "met",
        Some(Some(false)) => "not met",
        Some(None) => "does not apply",
        None => "-",
    }
}

/// The few metrics that say most: name, value, unit.
pub(super) fn in_short(metrics: Option<&Value>) -> Vec<(&'static str, String, &'static str)> {
    let chosen = METRICS.iter().filter(|metric| IN_SHORT.contains(&metric.0));
    let text = |metric: &Metric| metric.of(metrics).map_or_else(|| "-".to_owned(), short);
    chosen.map(|metric| (metric.0, text(metric), metric.1)).collect()
}

#[cfg(test)]
mod tests {
    use super::{METRICS, difference, table};
    use serde_json::json;

    #[test]
    fn differences_are_from_the_first() {
        assert_eq!(difference(Some(2.0), Some(1.0)).as_deref(), Some("-50.0 %"), "half");
        assert_eq!(difference(Some(2.0), Some(2.0)).as_deref(), Some("="), "the same");
        assert_eq!(difference(Some(2.0), Some(50.0)).as_deref(), Some("x 25.00"), "far off");
        assert_eq!(difference(Some(0.0), Some(1.0)), None, "nothing to compare with");
        assert_eq!(difference(None, Some(1.0)), None, "the first did not finish");
    }

    #[test]
    fn a_run_without_summary_has_dashes_and_names_are_escaped() {
        let metrics = json!({"max_error_m": 0.0025});
        let text = table(&[("<i>", Some(&metrics)), ("b", None)]).into_string();
        assert!(text.contains("&lt;i&gt;") && !text.contains("<i>"), "escaped");
        assert!(text.contains("2.500") && text.contains("-"), "a number and a dash");
        assert_eq!(text.matches("<tr>").count(), METRICS.len() + 2, "a row each");
    }
}
