//! Table 5.2 of the thesis beside what runs of the same experiment gave.

use maud::{Markup, html};
use serde_json::Value;

use super::metrics::Column;
use crate::number::short;
use crate::reproduce::TABLE_5_2;

/// The scenario of Table 5.2.
const SCENARIO: &str = "square-compare";

/// What the thesis says of a scenario beside its runs; none for a scenario of our own.
pub(super) fn beside(scenario: &str, columns: &[Column<'_>]) -> Option<Markup> {
    match scenario {
        SCENARIO => Some(table(columns)),
        "spiral-compare" => Some(html! {
            p { "Section 5.7 of the thesis compares its laws on the spiral by figures only; its one table of numbers, Table 5.2, is that of "
                code { (SCENARIO) } "." }
        }),
        _ => None,
    }
}

fn itae(metrics: Option<&Value>) -> Option<[f64; 4]> {
    let itae = metrics?.get("itae_m_s2")?;
    let [x, y, z, sum] = ["x", "y", "z", "sum"].map(|axis| itae.get(axis).and_then(Value::as_f64));
    Some([x?, y?, z?, sum?])
}

fn table(columns: &[Column<'_>]) -> Markup {
    let ours: Vec<(&str, [f64; 4])> =
        columns.iter().filter_map(|(name, metrics)| Some((*name, itae(*metrics)?))).collect();
    let baseline = ours.iter().find(|(name, _)| *name == "bsmc").map(|(_, values)| *values);
    html! {
        div.wide tabindex="0" role="region" aria-label="Table 5.2 of the thesis" { table {
            caption {
                "Table 5.2 of the thesis and the same experiment here: ITAE in m s^2. ITAE falls as 1/(K c), and the thesis gives neither "
                "its gains nor the disturbance's amplitude: its sums and ours are not of the same controllers. What can be compared is by how much a law is below BSMC."
            }
            thead { tr {
                th scope="col" { "law" }
                @for axis in ["x", "y", "z", "sum"] { th scope="col" { "ITAE " (axis) } }
                @for axis in ["x", "y", "z", "sum"] { th scope="col" { "below BSMC, " (axis) } }
            } }
            tbody {
                tr.thesis {
                    th scope="row" { "the thesis, BSMC" }
                    @for row in TABLE_5_2 { td { (short(row.1)) } }
                    @for _ in TABLE_5_2 { td { "-" } }
                }
                tr.thesis {
                    th scope="row" { "the thesis, BFSMC" }
                    @for row in TABLE_5_2 { td { (short(row.2)) } }
                    @for row in TABLE_5_2 { td { (format!("{:.2} %", row.3)) } }
                }
                @for (name, values) in &ours {
                    tr {
                        th scope="row" { (name) }
                        @for value in values { td { (short(*value)) } }
                        @for (axis, value) in values.iter().enumerate() { td { (below(baseline, axis, *value, name)) } }
                    }
                }
            }
        } }
    }
}

fn below(baseline: Option<[f64; 4]>, axis: usize, value: f64, name: &str) -> String {
    let base = baseline.filter(|_| name != "bsmc").and_then(|values| values.get(axis).copied());
    base.filter(|base| *base > 0.0)
        .map_or_else(|| "-".to_owned(), |base| format!("{:.2} %", 100.0 * (base - value) / base))
}
