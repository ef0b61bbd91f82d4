//! From the text of a URDF to the parameters of a robot.

use mm_model::{Robot, RobotParams};

use super::assemble::Assembly;
use super::elements;
use super::place::{At, Problem, UrdfError};
use super::tree::Tree;
use crate::scenario::nearest::nearest;

/// What a URDF leaves open.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ImportOptions {
    /// The link whose origin is the tip. Default: the one link without children that is fixed to the last.
    pub tip: Option<String>,
    /// Radius of the wheels, m. Default: that of their cylinders or spheres.
    pub wheel_radius_m: Option<f64>,
    /// Joints that are taken as fixed, at zero.
    pub fixed: Vec<String>,
}

/// A robot from a URDF.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Its parameters, which make a robot.
    pub params: RobotParams<f64, 3>,
    /// What the model has no place for, and what the file left open, a sentence each.
    pub notes: Vec<String>,
}

/// Reads the text of a URDF; `name` stands for the file in messages.
///
/// # Errors
/// A text that is no URDF; a robot that is not a base on two wheels with a yaw-pitch-pitch arm, by the joint or link that does not fit.
pub fn import(name: &str, text: &str, options: &ImportOptions) -> Result<Imported, UrdfError> {
    read(text, options).map_err(|problem| UrdfError::new(name, text, problem))
}

fn read(text: &str, options: &ImportOptions) -> Result<Imported, Problem> {
    let document = roxmltree::Document::parse(text).map_err(|error| {
        let at = At::Byte(byte_of(text, error.pos()));
        Problem::new(at, format!("not XML: {error}"), "a URDF")
    })?;
    let root = document.root_element();
    if !root.has_tag_name("robot") {
        let at = At::Byte(root.range().start);
        return Err(Problem::new(
            at,
            format!("found `<{}>`", root.tag_name().name()),
            "`<robot>`, the root of a URDF",
        ));
    }
    if let Some(macros) = document.descendants().find(|node| node.tag_name().namespace().is_some()) {
        let at = At::Byte(macros.range().start);
        return Err(Problem::new(at, "a macro", "a URDF without them, as `xacro FILE` makes it"));
    }
    elements::check(&document)?;
    let robot = urdf_rs::read_from_string(text).map_err(|error| {
        Problem::new(At::Robot, format!("not a URDF: {error}"), "links, joints and numbers as URDF has them")
    })?;
    for name in &options.fixed {
        if robot.joints.iter().all(|joint| joint.name != *name) {
            let nearest =
                nearest(name, robot.joints.iter().map(|joint| joint.name.as_str())).map(str::to_owned);
            let problem = Problem::new(At::Robot, format!("no joint `{name}` to fix"), "the name of a joint");
            return Err(Problem { nearest, ..problem });
        }
    }
    let tree = Tree::of(&robot, &options.fixed)?;
    let imported = Assembly::of(&tree)?.measure(options)?;
    Robot::try_new(imported.params).map_err(|error| {
        Problem::new(
            At::Robot,
            error.to_string(),
            "a robot whose every joint moves some inertia in every posture",
        )
    })?;
    Ok(imported)
}

/// The byte at a line and column, both from one.
fn byte_of(text: &str, position: roxmltree::TextPos) -> usize {
    let line = (position.row as usize).saturating_sub(1);
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let rest = text.get(start..).unwrap_or_default();
    start + rest.chars().take((position.col as usize).saturating_sub(1)).map(char::len_utf8).sum::<usize>()
}
