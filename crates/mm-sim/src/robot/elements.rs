//! The elements of a URDF one by one, before they are put together: names that are there once, numbers that are numbers.

use std::collections::BTreeSet;

use roxmltree::{Attribute, Document, Node};

use super::place::{At, Problem};

/// Attributes of numbers: element, attribute, how many.
const NUMBERS: [(&str, &str, usize); 22] = [
    ("mass", "value", 1),
    ("inertia", "ixx", 1),
    ("inertia", "ixy", 1),
    ("inertia", "ixz", 1),
    ("inertia", "iyy", 1),
    ("inertia", "iyz", 1),
    ("inertia", "izz", 1),
    ("origin", "xyz", 3),
    ("origin", "rpy", 3),
    ("axis", "xyz", 3),
    ("limit", "lower", 1),
    ("limit", "upper", 1),
    ("limit", "effort", 1),
    ("limit", "velocity", 1),
    ("cylinder", "radius", 1),
    ("cylinder", "length", 1),
    ("capsule", "radius", 1),
    ("capsule", "length", 1),
    ("sphere", "radius", 1),
    ("box", "size", 3),
    ("dynamics", "damping", 1),
    ("dynamics", "friction", 1),
];

/// Those of them that are not negative.
const NOT_NEGATIVE: [(&str, &str); 4] =
    [("mass", "value"), ("inertia", "ixx"), ("inertia", "iyy"), ("inertia", "izz")];

/// Looks at the links and joints of a robot.
pub(super) fn check(document: &Document<'_>) -> Result<(), Problem> {
    let mut seen = BTreeSet::new();
    for part in document.root_element().children().filter(|node| is_one_of(node, &["link", "joint"])) {
        let tag = part.tag_name().name();
        let wanted: &[&str] = if tag == "joint" { &["name", "type"] } else { &["name"] };
        if let Some(missing) = wanted.iter().find(|name| part.attribute(**name).is_none()) {
            let at = At::Byte(part.range().start);
            let name = part.attribute("name").map_or_else(String::new, |name| format!(" `{name}`"));
            return Err(Problem::new(
                at,
                format!("{tag}{name} without a {missing}"),
                format!("{missing}=\"...\""),
            ));
        }
        let name = part.attribute("name").unwrap_or_default();
        if !seen.insert((tag, name)) {
            let at = At::Byte(part.range().start);
            return Err(Problem::new(at, format!("a second {tag} `{name}`"), "a name of its own"));
        }
        for node in part.descendants() {
            for attribute in node.attributes() {
                check_number((tag, name), &node, &attribute)?;
            }
        }
    }
    Ok(())
}

fn is_one_of(node: &Node<'_, '_>, tags: &[&str]) -> bool {
    tags.iter().any(|tag| node.has_tag_name(*tag))
}

fn check_number(
    (tag, name): (&str, &str),
    node: &Node<'_, '_>,
    attribute: &Attribute<'_, '_>,
) -> Result<(), Problem> {
    let place = (node.tag_name().name(), attribute.name());
    let Some((_, _, count)) = NUMBERS.iter().find(|(element, name, _)| (*element, *name) == place) else {
        return Ok(());
    };
    let text = attribute.value();
    let numbers: Vec<f64> =
        text.split_whitespace().map_while(|word| word.parse().ok()).filter(|x: &f64| x.is_finite()).collect();
    let is_well = numbers.len() == *count && text.split_whitespace().count() == *count;
    let expected = match (count, NOT_NEGATIVE.contains(&place)) {
        (1, false) if is_well => return Ok(()),
        (1, true) if is_well && numbers.iter().all(|number| *number >= 0.0) => return Ok(()),
        (3, _) if is_well => return Ok(()),
        (3, _) => "three finite numbers",
        (_, true) => "a finite number, zero or above",
        _ => "a finite number",
    };
    let at = At::Byte(attribute.range_value().start);
    let message = format!("{tag} `{name}`: {} = \"{text}\" of `<{}>`", attribute.name(), place.0);
    Err(Problem::new(at, message, expected))
}
