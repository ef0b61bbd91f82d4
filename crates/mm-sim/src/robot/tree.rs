//! A URDF as rigid bodies, with all joints at zero, in the frame of its root link.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use urdf_rs::{Inertial, Joint, JointType, Pose, Robot};

use super::place::{At, Problem};

/// Mass, centre of mass and inertia about it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lump {
    pub(super) mass: f64,
    pub(super) com: Vector3<f64>,
    pub(super) inertia: Matrix3<f64>,
}

impl Lump {
    /// Nothing at all.
    fn none() -> Self {
        Self { mass: 0.0, com: Vector3::zeros(), inertia: Matrix3::zeros() }
    }

    /// The two as one body.
    pub(super) fn and(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return Self { inertia: self.inertia + other.inertia, ..self };
        }
        let com = (self.com * self.mass + other.com * other.mass) / mass;
        let about = |lump: &Self| {
            let d = lump.com - com;
            lump.inertia + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * lump.mass
        };
        Self { mass, com, inertia: about(&self) + about(&other) }
    }
}

/// A joint that moves.
#[derive(Debug)]
pub(super) struct Moving<'a> {
    pub(super) joint: &'a Joint,
    /// Body that it is on, and body that it moves.
    pub(super) parent: usize,
    pub(super) body: usize,
    pub(super) origin: Vector3<f64>,
    pub(super) axis: Vector3<f64>,
}

/// A link in its body.
#[derive(Debug)]
pub(super) struct Placed<'a> {
    pub(super) link: &'a urdf_rs::Link,
    pub(super) body: usize,
    pub(super) pose: Isometry3<f64>,
    /// Whether no link hangs on it.
    pub(super) is_leaf: bool,
}

/// The bodies of a URDF; body 0 is that of the root.
#[derive(Debug)]
pub(super) struct Tree<'a> {
    pub(super) links: Vec<Placed<'a>>,
    pub(super) moving: Vec<Moving<'a>>,
}

impl<'a> Tree<'a> {
    /// Puts the links together; joints named in `fixed` count as fixed, at zero.
    pub(super) fn of(robot: &'a Robot, fixed: &[String]) -> Result<Self, Problem> {
        let is_child = |name: &str| robot.joints.iter().any(|joint| joint.child.link == name);
        let mut roots = robot.links.iter().filter(|link| !is_child(&link.name));
        let root = roots.next().ok_or_else(|| {
            Problem::new(
                At::Robot,
                "every link is the child of another",
                "one link that is no child, the base",
            )
        })?;
        if let Some(second) = roots.next() {
            return Err(Problem::link(
                &second.name,
                format!("not connected to `{}`", root.name),
                "a joint to it",
            ));
        }
        let mut tree = Self { links: Vec::new(), moving: Vec::new() };
        tree.links.push(Placed { link: root, body: 0, pose: Isometry3::identity(), is_leaf: true });
        let mut next = 0;
        while let Some(at) = tree.links.get_mut(next) {
            let (name, body, pose) = (at.link.name.as_str(), at.body, at.pose);
            let below: Vec<&Joint> = robot.joints.iter().filter(|joint| joint.parent.link == name).collect();
            at.is_leaf = below.is_empty();
            for joint in below {
                tree.hang(robot, joint, (body, pose), fixed)?;
            }
            next += 1;
        }
        match robot
            .joints
            .iter()
            .find(|joint| tree.links.iter().all(|placed| placed.link.name != joint.child.link))
        {
            Some(joint) => {
                Err(Problem::joint(&joint.name, "not connected to the base", "a chain of joints from it"))
            }
            None => Ok(tree),
        }
    }

    fn hang(
        &mut self,
        robot: &'a Robot,
        joint: &'a Joint,
        (parent, pose): (usize, Isometry3<f64>),
        fixed: &[String],
    ) -> Result<(), Problem> {
        let child = &joint.child.link;
        let link = robot.links.iter().find(|link| link.name == *child).ok_or_else(|| {
            let names = robot.links.iter().map(|link| link.name.as_str());
            let nearest = crate::scenario::nearest::nearest(child, names).map(str::to_owned);
            Problem {
                nearest,
                ..Problem::joint(&joint.name, format!("no link `{child}`"), "the name of a link")
            }
        })?;
        if self.links.iter().any(|placed| placed.link.name == *child) {
            return Err(Problem::joint(
                &joint.name,
                format!("`{child}` has a parent already"),
                "one joint to a link",
            ));
        }
        let pose = pose * isometry(&joint.origin);
        let body = match joint.joint_type {
            _ if fixed.contains(&joint.name) => parent,
            JointType::Fixed => parent,
            JointType::Revolute | JointType::Continuous => {
                let body = self.moving.len() + 1;
                let axis = pose.rotation * Vector3::from(joint.axis.xyz.0);
                let length = axis.norm();
                if !(length > 0.0) {
                    return Err(Problem::joint(&joint.name, "no axis", "the direction that it turns about"));
                }
                let origin = pose.translation.vector;
                self.moving.push(Moving { joint, parent, body, origin, axis: axis / length });
                body
            }
            _ => {
                return Err(Problem::joint(
                    &joint.name,
                    "of a type that the model does not have",
                    format!("`revolute`, `continuous` or `fixed`; --fix {} takes it as fixed", joint.name),
                ));
            }
        };
        if let Some(mimic) = joint.mimic.as_ref().filter(|_| body != parent) {
            let message = format!("moves with `{}`, which the model's joints cannot", mimic.joint);
            return Err(Problem::joint(&joint.name, message, format!("no `mimic`; or --fix {}", joint.name)));
        }
        self.links.push(Placed { link, body, pose, is_leaf: true });
        Ok(())
    }

    /// All links of a body as one.
    pub(super) fn lump(&self, body: usize) -> Lump {
        let links = self.links.iter().filter(|placed| placed.body == body);
        links.fold(Lump::none(), |sum, placed| sum.and(lump(&placed.link.inertial, &placed.pose)))
    }

    /// The joints that move on a body.
    pub(super) fn on(&self, body: usize) -> impl Iterator<Item = &Moving<'a>> {
        self.moving.iter().filter(move |moving| moving.parent == body)
    }
}

fn isometry(pose: &Pose) -> Isometry3<f64> {
    let ([x, y, z], [roll, pitch, yaw]) = (pose.xyz.0, pose.rpy.0);
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}

fn lump(inertial: &Inertial, link: &Isometry3<f64>) -> Lump {
    let pose = link * isometry(&inertial.origin);
    let i = &inertial.inertia;
    let own = Matrix3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz);
    let turn: Rotation3<f64> = pose.rotation.to_rotation_matrix();
    let turn = turn.matrix();
    Lump { mass: inertial.mass.value, com: pose.translation.vector, inertia: turn * own * turn.transpose() }
}
