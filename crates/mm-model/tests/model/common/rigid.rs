//! Base and arm as four rigid bodies in space, derived without any formula of the crate.
//!
//! Frames are chained by rotation matrices; each body has a centre of mass and a diagonal inertia tensor in its own
//! frame; Jacobians are the geometric ones (axis, and axis x lever); derivatives by the coordinates come from dual numbers.
//! The result is the Lagrange equation in six coordinates, the Coriolis matrix by Christoffel symbols, and the wheels'
//! constraint is then imposed with a multiplier or eliminated by S.

use mm_model::{Configuration, RobotParams};
use nalgebra::{SMatrix, SVector};

use super::dual::Dual;

type V3 = [Dual; 3];
type M3 = [V3; 3];

const ZERO: Dual = Dual::constant(0.0);
const ONE: Dual = Dual::constant(1.0);

fn plus(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: V3, b: V3) -> Dual {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn turn(r: &M3, v: V3) -> V3 {
    [dot(r[0], v), dot(r[1], v), dot(r[2], v)]
}

fn column(r: &M3, j: usize) -> V3 {
    [r[0][j], r[1][j], r[2][j]]
}

fn product(a: &M3, b: &M3) -> M3 {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(a[i], column(b, j))))
}

/// A frame in space: rotation and origin.
#[derive(Clone, Copy)]
struct Frame {
    rotation: M3,
    origin: V3,
}

impl Frame {
    /// This frame moved by `shift` along its own axes.
    fn moved(self, shift: [f64; 3]) -> Self {
        let shift = shift.map(Dual::constant);
        Self { origin: plus(self.origin, turn(&self.rotation, shift)), ..self }
    }

    /// This frame turned about its own z axis.
    fn turned(self, angle: Dual) -> Self {
        let (s, c) = angle.sin_cos();
        let about_z = [[c, -s, ZERO], [s, c, ZERO], [ZERO, ZERO, ONE]];
        Self { rotation: product(&self.rotation, &about_z), ..self }
    }

    /// This frame tipped by a quarter turn about its own x axis, so that z becomes the pitch axis.
    fn tipped(self) -> Self {
        let about_x = [[ONE, ZERO, ZERO], [ZERO, ZERO, -ONE], [ZERO, ONE, ZERO]];
        Self { rotation: product(&self.rotation, &about_x), ..self }
    }

    fn z_axis(&self) -> V3 {
        column(&self.rotation, 2)
    }
}

/// A joint that turns everything after it.
struct Hinge {
    axis: V3,
    origin: V3,
}

/// Mass, principal inertias in the body's frame, that frame at the centre of mass, and how many hinges turn it.
struct Body {
    mass: f64,
    inertia: [f64; 3],
    frame: Frame,
    hinges: usize,
}

/// What the equations of motion in six coordinates consist of.
pub(crate) struct Rigid {
    pub(crate) mass: SMatrix<f64, 6, 6>,
    /// Partial derivatives of the mass matrix by the coordinates.
    pub(crate) mass_by: [SMatrix<f64, 6, 6>; 6],
    pub(crate) potential: f64,
    pub(crate) gravity: SVector<f64, 6>,
    pub(crate) tip: SVector<f64, 3>,
    pub(crate) tip_jacobian: SMatrix<f64, 3, 6>,
    pub(crate) tip_jacobian_by: [SMatrix<f64, 3, 6>; 6],
}

/// Velocity of `point` per rate of each coordinate, the first `hinges` of the hinges turning it.
fn point_jacobian(point: V3, hinges: &[Hinge]) -> [V3; 6] {
    let mut columns = [[ZERO; 3]; 6];
    columns[0] = [ONE, ZERO, ZERO];
    columns[1] = [ZERO, ONE, ZERO];
    for (column, hinge) in columns[2..].iter_mut().zip(hinges) {
        *column = cross(hinge.axis, minus(point, hinge.origin));
    }
    columns
}

impl Rigid {
    pub(crate) fn new(p: &RobotParams<f64, 3>, q: &Configuration<f64, 3>) -> Self {
        let [one, two, three] = p.links;
        let [q1, q2, q3] = q.joints;
        let at = |index, value| Dual::coordinate(index, value);
        let upright = [[ONE, ZERO, ZERO], [ZERO, ONE, ZERO], [ZERO, ZERO, ONE]];
        let ground = Frame { rotation: upright, origin: [at(0, q.x), at(1, q.y), ZERO] };
        let base = ground.turned(at(2, q.heading));
        let foot = base.moved([p.arm_offset, 0.0, p.mount_height]);
        let link1 = foot.turned(at(3, q1));
        let shoulder = link1.moved([0.0, 0.0, one.length]).tipped();
        let link2 = shoulder.turned(at(4, q2));
        let elbow = link2.moved([two.length, 0.0, 0.0]);
        let link3 = elbow.turned(at(5, q3));
        let tip = link3.moved([three.length, 0.0, 0.0]).origin;
        let hinges = [base, link1, link2, link3].map(|f| Hinge { axis: f.z_axis(), origin: f.origin });
        // Only the yaw inertia of what never tips can matter: the others are set to what would be seen.
        let bodies = [
            Body {
                mass: p.base_mass,
                inertia: [7.0, 11.0, p.base_yaw_inertia],
                frame: base.moved([p.base_com_offset, 0.0, 0.3]),
                hinges: 1,
            },
            Body {
                mass: one.mass,
                inertia: [one.normal_inertia, one.pitch_inertia, one.axial_inertia],
                frame: link1.moved([0.0, 0.0, one.com]),
                hinges: 2,
            },
            Body {
                mass: two.mass,
                inertia: [two.axial_inertia, two.normal_inertia, two.pitch_inertia],
                frame: link2.moved([two.com, 0.0, 0.0]),
                hinges: 3,
            },
            Body {
                mass: three.mass,
                inertia: [three.axial_inertia, three.normal_inertia, three.pitch_inertia],
                frame: link3.moved([three.com, 0.0, 0.0]),
                hinges: 4,
            },
        ];
        let mut mass = [[ZERO; 6]; 6];
        let mut potential = ZERO;
        for (index, body) in bodies.iter().enumerate() {
            body.add_to(&mut mass, &hinges[..body.hinges]);
            if index > 0 {
                potential = potential + Dual::constant(body.mass * p.gravity) * body.frame.origin[2];
            }
        }
        let tip_columns = point_jacobian(tip, &hinges);
        Self {
            mass: SMatrix::from_fn(|i, j| mass[i][j].value),
            mass_by: [0, 1, 2, 3, 4, 5].map(|k| SMatrix::from_fn(|i, j| mass[i][j].by[k])),
            potential: potential.value,
            gravity: SVector::from(potential.by),
            tip: SVector::from(tip.map(|x| x.value)),
            tip_jacobian: SMatrix::from_fn(|i, j| tip_columns[j][i].value),
            tip_jacobian_by: [0, 1, 2, 3, 4, 5].map(|k| SMatrix::from_fn(|i, j| tip_columns[j][i].by[k])),
        }
    }

    /// Coriolis matrix by Christoffel symbols of the first kind.
    pub(crate) fn coriolis(&self, rate: &SVector<f64, 6>) -> SMatrix<f64, 6, 6> {
        SMatrix::from_fn(|k, j| {
            (0..6).fold(0.0, |sum, i| {
                let by = &self.mass_by;
                sum + 0.5 * (by[i][(k, j)] + by[j][(k, i)] - by[k][(i, j)]) * rate[i]
            })
        })
    }
}

impl Body {
    /// Adds m Jv' Jv + Jw' R I R' Jw.
    fn add_to(&self, mass: &mut [[Dual; 6]; 6], hinges: &[Hinge]) {
        let linear = point_jacobian(self.frame.origin, hinges);
        // Jw in the body's frame, where the inertia is diagonal.
        let mut angular = [[ZERO; 3]; 6];
        for (out, hinge) in angular[2..].iter_mut().zip(hinges) {
            *out = [0, 1, 2].map(|i| dot(column(&self.frame.rotation, i), hinge.axis));
        }
        for (i, row) in mass.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let [ix, iy, iz] = self.inertia.map(Dual::constant);
                let [a, b] = [angular[i], angular[j]];
                *entry = *entry
                    + Dual::constant(self.mass) * dot(linear[i], linear[j])
                    + ix * a[0] * b[0]
                    + iy * a[1] * b[1]
                    + iz * a[2] * b[2];
            }
        }
    }
}
