//! The file of budgets: what was measured last, and what must never be exceeded.
//!
//! `[TARGET.update]` keeps the numbers, `[TARGET.limits]` the largest that are allowed.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::{Context, Result};
use toml::{Table, Value};

use super::Numbers;
use crate::table::grouped;

/// How far a number may be from the one that is kept, in percent.
const DRIFT: u64 = 2;

/// What is wrong with the numbers, a line each.
pub(super) fn problems(budgets: &Table, all: &BTreeMap<&'static str, Numbers>) -> Result<Vec<String>> {
    let mut problems = Vec::new();
    for (target, numbers) in all {
        for (name, &number) in numbers {
            let kept = entry(budgets, target, "update", name)?;
            match kept {
                None => {
                    problems.push(format!("{target}: {name} is {}, and nothing is kept", grouped(number)));
                }
                Some(kept) if number.abs_diff(kept) * 100 > kept * DRIFT => problems.push(format!(
                    "{target}: {name} is {}, {} {} than the {} that is kept ({:+.1} %)",
                    grouped(number),
                    grouped(number.abs_diff(kept)),
                    if number > kept { "more" } else { "less" },
                    grouped(kept),
                    percent(number, kept),
                )),
                Some(_) => {}
            }
            if let Some(limit) = entry(budgets, target, "limits", name)?
                && number > limit
            {
                problems.push(format!("{target}: {name} is {}, limit {}", grouped(number), grouped(limit)));
            }
        }
    }
    Ok(problems)
}

#[expect(clippy::cast_precision_loss, reason = "shown with one decimal")]
fn percent(number: u64, kept: u64) -> f64 {
    (number as f64 / kept.max(1) as f64 - 1.0) * 100.0
}

fn entry(budgets: &Table, target: &str, part: &str, name: &str) -> Result<Option<u64>> {
    let value = budgets.get(target).and_then(|table| table.get(part)).and_then(|table| table.get(name));
    let number = |value: &Value| value.as_integer().and_then(|number| u64::try_from(number).ok());
    value
        .map(|value| {
            number(value).with_context(|| format!("budget.toml: {target}.{part}.{name} is no count"))
        })
        .transpose()
}

/// The text with the numbers kept in it; the rest, comments and limits, stays.
pub(super) fn blessed(text: &str, all: &BTreeMap<&'static str, Numbers>) -> String {
    let mut out = String::new();
    let mut skipping = false;
    for line in text.lines() {
        if line.starts_with('[') {
            let target = line.strip_prefix('[').and_then(|line| line.strip_suffix(".update]"));
            skipping = target.is_some_and(|target| all.contains_key(target));
        }
        if !skipping {
            out += line;
            out.push('\n');
        }
    }
    let mut out = out.trim_end().to_owned();
    out.push('\n');
    for (target, numbers) in all {
        let _ = write!(out, "\n[{target}.update]\n");
        for (name, number) in numbers {
            let _ = writeln!(out, "{name} = {number}");
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{blessed, problems};
    use std::collections::BTreeMap;

    const TEXT: &str =
        "# Limits.\n[m0.limits]\nflash_bytes = 1000\n\n[m0.update]\nflash_bytes = 500\nold = 1\n";

    fn measured(flash: u64) -> BTreeMap<&'static str, super::Numbers> {
        BTreeMap::from([("m0", BTreeMap::from([("flash_bytes", flash)]))])
    }

    fn found(text: &str, flash: u64) -> Vec<String> {
        problems(&toml::from_str(text).expect("proper"), &measured(flash)).expect("counts")
    }

    #[test]
    fn two_percent_are_let_through_and_more_is_told() {
        assert!(found(TEXT, 510).is_empty() && found(TEXT, 490).is_empty(), "2 % either way");
        assert_eq!(
            found(TEXT, 511),
            ["m0: flash_bytes is 511, 11 more than the 500 that is kept (+2.2 %)"],
            "more"
        );
        assert_eq!(
            found(TEXT, 400),
            ["m0: flash_bytes is 400, 100 less than the 500 that is kept (-20.0 %)"],
            "less is told too: what is kept is what is true"
        );
    }

    #[test]
    fn a_limit_holds_whatever_is_kept() {
        let text = blessed(TEXT, &measured(1001));
        assert_eq!(found(&text, 1001), ["m0: flash_bytes is 1,001, limit 1,000"], "{text}");
        assert!(text.starts_with("# Limits.\n[m0.limits]\nflash_bytes = 1000\n"), "the rest stays: {text}");
        assert!(!text.contains("old"), "what is measured no more goes: {text}");
    }

    #[test]
    fn what_is_not_kept_is_a_problem() {
        assert_eq!(found("", 7), ["m0: flash_bytes is 7, and nothing is kept"], "an empty file");
    }
}
