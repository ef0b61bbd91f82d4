//! The arm: three links in one upright plane.

use mm_model::Real;
use nalgebra::{Rotation3, Vector3};
use urdf_rs::JointType;

use super::{Assembly, ROUNDING, TOLERANCE, effort, note_friction, up};
use crate::robot::import::{ImportOptions, Imported};
use crate::robot::place::Problem;
use crate::robot::tree::{Lump, Moving};
use crate::scenario::nearest::nearest;

/// How far the foot of link 1 is put below what is on it, where the file has no room for a foot, m.
const FOOT_M: f64 = 0.01;

/// Angle of the model's joint over that of the file's: `sign u + offset`.
#[derive(Debug, Clone, Copy)]
struct Angle {
    sign: f64,
    offset: f64,
}

impl Assembly<'_> {
    /// Fills in what the arm is; `ground` is below the middle of the axle.
    pub(super) fn arm(
        &self,
        options: &ImportOptions,
        ground: Vector3<f64>,
        imported: &mut Imported,
    ) -> Result<(), Problem> {
        let [yaw, shoulder, elbow] = self.joints;
        let angle = self.plane()?;
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), -angle[0].offset);
        // From here on in the plane of the arm: x ahead, z up, links at y = 0.
        let level = |point: Vector3<f64>| turn * (point - yaw.origin);
        let tip = level(self.tip(options)?);
        let points = [level(shoulder.origin), level(elbow.origin), tip];
        self.check_plane(ground, points)?;
        let lumps = self.joints.map(|joint| {
            let lump = self.tree.lump(joint.body);
            let inertia = turn.matrix() * lump.inertia * turn.matrix().transpose();
            Lump { com: level(lump.com), inertia, ..lump }
        });
        let foot = foot(points[0].z, lumps[0].com.z, yaw, &mut imported.notes);
        let starts = [Vector3::new(0.0, 0.0, foot), points[0], points[1]];
        let mut slope = 0.0;
        for index in 0..3 {
            let (start, end, joint) = (starts[index], points[index], self.joints[index]);
            let along = if index == 0 { up() } else { Vector3::new(end.x - start.x, 0.0, end.z - start.z) };
            let length = if index == 0 { end.z - start.z } else { along.norm() };
            if !(length > TOLERANCE) {
                let message = format!("a link of length {length}");
                return Err(Problem::link(
                    &joint.joint.child.link,
                    message,
                    "some distance to the next joint or the tip",
                ));
            }
            let along = if index == 0 { along } else { along / length };
            imported.params.links[index] =
                link((start, along, length), &lumps[index], joint, &mut imported.notes)?;
            let mut angle = angle[index];
            if index > 0 {
                let own = Real::atan2(along.z, along.x);
                angle.offset = wrapped(own - slope);
                slope = own;
            }
            limits(index, joint, angle, imported);
        }
        let p = &mut imported.params;
        p.arm_offset = yaw.origin.x - ground.x;
        p.mount_height = yaw.origin.z + foot - ground.z;
        let ranges = p.limits.joints;
        for (angle, (lo, hi)) in p.rest_posture.iter_mut().zip(ranges) {
            *angle = angle.clamp(lo.min(hi), hi.max(lo));
        }
        Ok(())
    }

    /// The signs of the joints, and the offset of the first, which turns x into the plane of the arm.
    fn plane(&self) -> Result<[Angle; 3], Problem> {
        let [yaw, shoulder, elbow] = self.joints;
        let name = |moving: &Moving<'_>| moving.joint.name.clone();
        if yaw.axis.z.abs() < 1.0 - TOLERANCE {
            let message = "the first joint of the arm does not turn about the vertical";
            return Err(Problem::joint(&name(yaw), message, "a yaw joint, its axis along z of the base"));
        }
        if shoulder.axis.z.abs() > TOLERANCE {
            return Err(Problem::joint(
                &name(shoulder),
                "its axis is not level",
                "a pitch joint, its axis across the vertical",
            ));
        }
        let across = shoulder.axis.dot(&elbow.axis);
        if across.abs() < 1.0 - TOLERANCE {
            let message = format!("its axis is not parallel to that of `{}`", name(shoulder));
            return Err(Problem::joint(&name(elbow), message, "two pitch joints with one direction"));
        }
        // The model's pitch joints turn about -y: positive raises the link.
        let sign = if shoulder.axis.y <= 0.0 { 1.0 } else { -1.0 };
        let offset = Real::atan2(sign * shoulder.axis.x, -sign * shoulder.axis.y);
        let first =
            Angle { sign: yaw.axis.z.signum(), offset: if offset.abs() < TOLERANCE { 0.0 } else { offset } };
        let pitch = |sign| Angle { sign, offset: 0.0 };
        Ok([first, pitch(sign), pitch(sign * across.signum())])
    }

    /// Where the tip is.
    fn tip(&self, options: &ImportOptions) -> Result<Vector3<f64>, Problem> {
        let last = self.joints[2];
        let own = &last.joint.child.link;
        let links: Vec<_> = self.tree.links.iter().filter(|placed| placed.body == last.body).collect();
        let names = || links.iter().map(|placed| placed.link.name.as_str()).filter(|name| name != own);
        if let Some(wanted) = &options.tip {
            return links
                .iter()
                .find(|placed| placed.link.name == *wanted)
                .map(|placed| placed.pose.translation.vector)
                .ok_or_else(|| {
                    let nearest = nearest(wanted, names()).map(str::to_owned);
                    let problem = Problem::link(
                        own,
                        format!("no link `{wanted}` is fixed to it"),
                        "the name of one that is",
                    );
                    Problem { nearest, ..problem }
                });
        }
        let leaves: Vec<_> =
            links.iter().filter(|placed| placed.is_leaf && placed.link.name != *own).collect();
        match leaves.as_slice() {
            [tip] => Ok(tip.pose.translation.vector),
            [] => Err(Problem::link(own, "no frame at the tip", "a link that is fixed to it, at the tip")),
            _ => {
                let listed = leaves
                    .iter()
                    .map(|placed| format!("`{}`", placed.link.name))
                    .collect::<Vec<_>>()
                    .join(", ");
                Err(Problem::link(
                    own,
                    format!("{} frames could be the tip", leaves.len()),
                    format!("--tip with one of {listed}"),
                ))
            }
        }
    }

    /// Whether the arm stands over the middle of the axle and keeps to its plane.
    fn check_plane(&self, ground: Vector3<f64>, points: [Vector3<f64>; 3]) -> Result<(), Problem> {
        let [yaw, shoulder, elbow] = self.joints;
        let aside = yaw.origin.y - ground.y;
        if aside.abs() > TOLERANCE {
            let message = format!("{aside:.4} m to the left of the middle of the axle");
            return Err(Problem::joint(
                &yaw.joint.name,
                message,
                "the arm's yaw axis straight ahead of the axle's middle",
            ));
        }
        if points[0].x.abs() > TOLERANCE {
            let message = format!("{:.4} m off the axis of `{}`", points[0].x, yaw.joint.name);
            return Err(Problem::joint(
                &shoulder.joint.name,
                message,
                "the first pitch axis to meet the yaw axis",
            ));
        }
        for (name, point) in [
            (&shoulder.joint.name, points[0]),
            (&elbow.joint.name, points[1]),
            (&elbow.joint.name, points[2]),
        ] {
            if point.y.abs() > TOLERANCE {
                let message = format!("the arm is {:.4} m out of its plane", point.y);
                return Err(Problem::joint(
                    name,
                    message,
                    "yaw axis, pitch joints and tip in one upright plane",
                ));
            }
        }
        Ok(())
    }
}

/// Height of the foot of link 1 over the origin of its joint, which may be anywhere on its axis.
fn foot(next: f64, com: f64, yaw: &Moving<'_>, notes: &mut Vec<String>) -> f64 {
    if next > TOLERANCE && com >= 0.0 {
        return 0.0;
    }
    let foot = next.min(com) - FOOT_M;
    notes.push(format!(
        "the foot of link 1 is {:.4} m below joint `{}`, so that the link stands on it",
        -foot, yaw.joint.name
    ));
    foot
}

/// A link that starts at a point and goes along a direction, both in the plane of the arm.
fn link(
    (start, along, length): (Vector3<f64>, Vector3<f64>, f64),
    lump: &Lump,
    joint: &Moving<'_>,
    notes: &mut Vec<String>,
) -> Result<mm_model::Link<f64>, Problem> {
    let name = &joint.joint.child.link;
    if !(lump.mass > 0.0) {
        return Err(Problem::link(name, "no mass", "`<inertial>` with the mass of the link"));
    }
    let from_start = lump.com - start;
    let com = from_start.dot(&along);
    if com < -TOLERANCE {
        let message = format!("its centre of mass is {:.4} m behind its joint", -com);
        return Err(Problem::link(name, message, "one ahead of the joint, along the link"));
    }
    let aside = (from_start - along * com).norm();
    if aside > ROUNDING {
        notes.push(format!(
            "link `{name}`: its centre of mass is {aside:.4} m off the link: the model has it on the link"
        ));
    }
    let pitch = Vector3::y();
    let normal = along.cross(&pitch);
    let about = |axis: &Vector3<f64>| axis.dot(&(lump.inertia * axis));
    let product = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(&(lump.inertia * b)).abs();
    let largest = product(&along, &pitch).max(product(&along, &normal)).max(product(&pitch, &normal));
    if largest > ROUNDING {
        notes.push(format!("link `{name}`: products of inertia up to {largest:.2e} kg m^2 are left out"));
    }
    Ok(mm_model::Link {
        length,
        mass: lump.mass,
        com: com.max(0.0),
        axial_inertia: about(&along),
        pitch_inertia: about(&pitch),
        normal_inertia: about(&normal),
    })
}

/// Fills in the range and the torque of a joint.
fn limits(index: usize, moving: &Moving<'_>, Angle { sign, offset }: Angle, imported: &mut Imported) {
    let Imported { params, notes } = imported;
    let (name, limit) = (&moving.joint.name, &moving.joint.limit);
    if sign < 0.0 || offset.abs() > ROUNDING {
        let minus = if sign < 0.0 { "-" } else { "" };
        notes.push(format!(
            "joint `{name}` at angle u is joint {} of the model at {minus}u + {offset:.4} rad",
            index + 1
        ));
    }
    let is_limited = matches!(moving.joint.joint_type, JointType::Revolute) && limit.lower < limit.upper;
    params.limits.joints[index] = if is_limited && limit.lower.is_finite() && limit.upper.is_finite() {
        let ends = [sign * limit.lower + offset, sign * limit.upper + offset];
        (ends[0].min(ends[1]), ends[0].max(ends[1]))
    } else {
        notes.push(format!("joint `{name}` has no range: -pi to pi, beyond which crossings are counted"));
        (-core::f64::consts::PI, core::f64::consts::PI)
    };
    match effort(moving) {
        Some(torque) => params.limits.joint_torque[index] = torque,
        None => notes.push(format!(
            "no effort of joint `{name}`: {} N m, the preset's",
            params.limits.joint_torque[index]
        )),
    }
    note_friction(moving, notes);
}

/// The angle within half a turn of zero.
fn wrapped(angle: f64) -> f64 {
    let turn = 2.0 * core::f64::consts::PI;
    angle - turn * (angle / turn).round()
}
