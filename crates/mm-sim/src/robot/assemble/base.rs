//! The base with its wheels.

use nalgebra::Vector3;
use urdf_rs::Geometry;

use super::{Assembly, ROUNDING, TOLERANCE, effort, note_friction};
use crate::robot::import::{ImportOptions, Imported};
use crate::robot::place::Problem;
use crate::robot::tree::Moving;

impl Assembly<'_> {
    /// Fills in what the base is, and returns the point on the ground below the middle of the axle.
    pub(super) fn base(
        &self,
        options: &ImportOptions,
        imported: &mut Imported,
    ) -> Result<Vector3<f64>, Problem> {
        let (right, left) = (self.right, self.left);
        let apart = left.origin - right.origin;
        if apart.x.abs() > TOLERANCE || apart.z.abs() > TOLERANCE || apart.y <= TOLERANCE {
            let message = format!("{:.4} m ahead of and {:.4} m above the other wheel", apart.x, apart.z);
            return Err(Problem::joint(&left.joint.name, message, "both on one axle along y"));
        }
        let radius = match options.wheel_radius_m {
            Some(radius) => radius,
            None => {
                let radii = [self.radius(right)?, self.radius(left)?];
                if (radii[0] - radii[1]).abs() > TOLERANCE {
                    let message = format!("the wheels have radii of {} and {} m", radii[0], radii[1]);
                    return Err(Problem::joint(&left.joint.name, message, "wheels of one size"));
                }
                radii[0]
            }
        };
        let middle = (right.origin + left.origin) * 0.5;
        let ground = middle - Vector3::new(0.0, 0.0, radius);
        let whole = [right.body, left.body]
            .iter()
            .fold(self.tree.lump(0), |sum, body| sum.and(self.tree.lump(*body)));
        let p = &mut imported.params;
        p.wheel_radius = radius;
        p.track_width = apart.y;
        p.base_mass = whole.mass;
        p.base_yaw_inertia = whole.inertia.m33;
        p.base_com_offset = whole.com.x - middle.x;
        let efforts = [effort(right), effort(left)];
        match efforts.into_iter().flatten().reduce(f64::min) {
            Some(torque) => p.limits.wheel_torque = torque,
            None => imported
                .notes
                .push(format!("no effort of the wheels: {} N m, the preset's", p.limits.wheel_torque)),
        }
        let aside = whole.com.y - middle.y;
        if aside.abs() > ROUNDING {
            imported.notes.push(format!(
                "the base's centre of mass is {aside:.4} m to the left of the middle: the model has it in the middle"
            ));
        }
        let spin = self.tree.lump(right.body).inertia.m22;
        if spin > ROUNDING {
            imported.notes.push(format!(
                "the wheels' inertia about their axle, {spin:.4} kg m^2 each, is not modelled"
            ));
        }
        note_friction(right, &mut imported.notes);
        note_friction(left, &mut imported.notes);
        Ok(ground)
    }

    /// The radius of a wheel's cylinder or sphere, that which collides before that which is seen.
    fn radius(&self, wheel: &Moving<'_>) -> Result<f64, Problem> {
        let links =
            || self.tree.links.iter().filter(|placed| placed.body == wheel.body).map(|placed| placed.link);
        let collide = links().flat_map(|link| &link.collision).map(|shape| &shape.geometry);
        let seen = links().flat_map(|link| &link.visual).map(|shape| &shape.geometry);
        let radius = collide.chain(seen).find_map(|shape| match shape {
            Geometry::Cylinder { radius, .. } | Geometry::Sphere { radius } => Some(*radius),
            _ => None,
        });
        let name = &wheel.joint.child.link;
        radius.filter(|radius| *radius > 0.0).ok_or_else(|| {
            Problem::link(name, "a wheel of unknown radius", "a cylinder or sphere; or --wheel-radius-m R")
        })
    }
}
