//! Which joint of a URDF is which of the model, and what that makes its parameters.

mod arm;
mod base;

use nalgebra::Vector3;

use super::import::{ImportOptions, Imported};
use super::place::{At, Problem};
use super::tree::{Moving, Tree};

/// Lengths, m, and angles, rad, up to which the model may differ from the file; common files round right angles to 1.57.
const TOLERANCE: f64 = 2e-3;

/// Differences that are not worth a word, m, rad, kg m^2.
const ROUNDING: f64 = 1e-6;

/// The two wheels and the three joints.
#[derive(Debug)]
pub(super) struct Assembly<'a> {
    tree: &'a Tree<'a>,
    right: &'a Moving<'a>,
    left: &'a Moving<'a>,
    joints: [&'a Moving<'a>; 3],
}

impl<'a> Assembly<'a> {
    /// Finds them.
    pub(super) fn of(tree: &'a Tree<'a>) -> Result<Self, Problem> {
        let is_wheel = |moving: &&Moving<'_>| {
            moving.axis.y.abs() > 1.0 - TOLERANCE && tree.on(moving.body).next().is_none()
        };
        let wheels: Vec<&Moving<'_>> = tree.on(0).filter(is_wheel).collect();
        let (right, left) = match wheels.as_slice() {
            [one, other] if one.origin.y < other.origin.y => (*one, *other),
            [one, other] => (*other, *one),
            [_, _, third, ..] => {
                return Err(Problem::joint(
                    &third.joint.name,
                    format!("one wheel of {}", wheels.len()),
                    format!("two driven wheels; --fix {} takes one as fixed", third.joint.name),
                ));
            }
            _ => {
                let message = format!("{} wheels", wheels.len());
                return Err(Problem::new(
                    At::Robot,
                    message,
                    "two joints of the base that turn about its y axis, the wheels",
                ));
            }
        };
        let joints = chain(tree, [right.body, left.body])?;
        Ok(Self { tree, right, left, joints })
    }

    /// The parameters of the robot.
    pub(super) fn measure(&self, options: &ImportOptions) -> Result<Imported, Problem> {
        let mut imported = Imported { params: mm_model::RobotParams::thesis(), notes: Vec::new() };
        let axle = self.base(options, &mut imported)?;
        self.arm(options, axle, &mut imported)?;
        imported
            .notes
            .push("a URDF has neither gravity nor rest posture: 9.81 m/s^2 and the preset's".to_owned());
        Ok(imported)
    }
}

/// The joints of the arm, base to tip.
fn chain<'a>(tree: &'a Tree<'a>, wheels: [usize; 2]) -> Result<[&'a Moving<'a>; 3], Problem> {
    let mut found: Vec<&Moving<'_>> = Vec::new();
    let mut body = 0;
    loop {
        let mut next = tree.on(body).filter(|moving| !wheels.contains(&moving.body));
        let Some(joint) = next.next() else { break };
        if let Some(second) = next.next() {
            let message = format!("moves beside `{}`", joint.joint.name);
            let expected = format!("one arm in a row; --fix {} takes it as fixed", second.joint.name);
            return Err(Problem::joint(&second.joint.name, message, expected));
        }
        found.push(joint);
        body = joint.body;
    }
    match found.as_slice() {
        [first, second, third] => Ok([first, second, third]),
        [_, _, _, fourth, ..] => {
            let message = format!("the fourth of {} joints in a row", found.len());
            let expected =
                format!("three, a yaw and two pitches; --fix {} takes it as fixed", fourth.joint.name);
            Err(Problem::joint(&fourth.joint.name, message, expected))
        }
        _ => {
            let message = format!("an arm of {} joints", found.len());
            Err(Problem::new(At::Robot, message, "three joints in a row that move, a yaw and two pitches"))
        }
    }
}

/// The largest torque of joints, if the file says it.
fn effort(moving: &Moving<'_>) -> Option<f64> {
    Some(moving.joint.limit.effort).filter(|effort| *effort > 0.0 && effort.is_finite())
}

/// Notes the friction of a joint, which belongs to the plant.
fn note_friction(moving: &Moving<'_>, notes: &mut Vec<String>) {
    let Some(dynamics) = moving.joint.dynamics.as_ref() else { return };
    if dynamics.damping > 0.0 || dynamics.friction > 0.0 {
        notes.push(format!(
            "joint `{}`: damping {} and friction {} are the plant's, `[plant.friction]` of a scenario",
            moving.joint.name, dynamics.damping, dynamics.friction
        ));
    }
}

/// Upwards.
const fn up() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, 1.0)
}
