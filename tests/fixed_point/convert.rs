//! Parameters, inputs and torques in another scalar.

use mm_control::fuzzy::Bundled;
use mm_control::{ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, StackParams};
use mm_model::{Configuration, Force, Friction, Limits, Link, Real, Robot, RobotParams, Torque, Velocity};
use nalgebra::Vector3;

fn n<T: Real>(x: f64) -> T {
    T::from_f64(x)
}

fn force<T: Real>(f: &Force<f64, 3>) -> Force<T, 3> {
    Force::from_channels(f.channels().map(n))
}

fn velocity<T: Real>(v: &Velocity<f64, 3>) -> Velocity<T, 3> {
    Velocity::from_channels(v.channels().map(n))
}

pub(crate) fn robot<T: Real>(p: &RobotParams<f64, 3>) -> RobotParams<T, 3> {
    RobotParams {
        base_mass: n(p.base_mass),
        base_yaw_inertia: n(p.base_yaw_inertia),
        base_com_offset: n(p.base_com_offset),
        arm_offset: n(p.arm_offset),
        mount_height: n(p.mount_height),
        wheel_radius: n(p.wheel_radius),
        track_width: n(p.track_width),
        gravity: n(p.gravity),
        links: p.links.map(|link| Link {
            length: n(link.length),
            mass: n(link.mass),
            com: n(link.com),
            axial_inertia: n(link.axial_inertia),
            pitch_inertia: n(link.pitch_inertia),
            normal_inertia: n(link.normal_inertia),
        }),
        rest_posture: p.rest_posture.map(n),
        friction: Friction {
            wheel_viscous: n(p.friction.wheel_viscous),
            wheel_coulomb: n(p.friction.wheel_coulomb),
            joint_viscous: p.friction.joint_viscous.map(n),
            joint_coulomb: p.friction.joint_coulomb.map(n),
            smoothing: n(p.friction.smoothing),
        },
        limits: Limits {
            joints: p.limits.joints.map(|(lo, hi)| (n(lo), n(hi))),
            wheel_torque: n(p.limits.wheel_torque),
            joint_torque: p.limits.joint_torque.map(n),
            speed: n(p.limits.speed),
        },
    }
}

fn outer<T: Real>(p: &OuterParams<f64, 3>) -> OuterParams<T, 3> {
    OuterParams {
        position_gain: p.position_gain.map(n),
        sliding_gain: velocity(&p.sliding_gain),
        weights: velocity(&p.weights),
        posture_gain: n(p.posture_gain),
        joint_limit_gain: n(p.joint_limit_gain),
        joint_limit_margin: n(p.joint_limit_margin),
        manipulability_gain: n(p.manipulability_gain),
        manipulability_threshold: n(p.manipulability_threshold),
        damping_max: n(p.damping_max),
        correction_speed_limit: n(p.correction_speed_limit),
        joint_limit_rate: n(p.joint_limit_rate),
        base_hold: n(p.base_hold),
        base_release: n(p.base_release),
        minimum_norm: p.minimum_norm,
    }
}

/// The gains that `bfsmc` takes from those given, the rest as the scalar's own defaults.
fn gains<T: Real>(own: Gains<T, 3>, g: &Gains<f64, 3>) -> Gains<T, 3> {
    Gains {
        fuzzy: force(&g.fuzzy),
        fuzzy_scale: velocity(&g.fuzzy_scale),
        observer_bandwidth: n(g.observer_bandwidth),
        learning_limit: force(&g.learning_limit),
        ..own
    }
}

/// The same stack with law `bfsmc` in another scalar, every number rounded to it.
pub(crate) fn stack<T: Bundled>(of: &ControlStack<f64, 3>, period: f64) -> ControlStack<T, 3> {
    let robot = Robot::try_new(robot(of.robot().params())).expect("in range");
    let own = Gains::for_robot(&robot, LawKind::Bfsmc, n(period));
    let params = StackParams {
        period: n(period),
        outer: outer(of.outer().params()),
        gains: gains(own, of.gains()),
        estimator: Estimator::None,
    };
    ControlStack::try_new(robot, LawKind::Bfsmc, params).expect("in range")
}

pub(crate) fn input<T: Real>(input: &Input<f64, 3>) -> Input<T, 3> {
    let Input { q, nu, reference } = input;
    let vector = |v: &Vector3<f64>| v.map(n);
    Input {
        q: Configuration { x: n(q.x), y: n(q.y), heading: n(q.heading), joints: q.joints.map(n) },
        nu: velocity(nu),
        reference: Reference {
            position: vector(&reference.position),
            velocity: vector(&reference.velocity),
            acceleration: vector(&reference.acceleration),
        },
    }
}

pub(crate) fn torque<T: Real>(torque: &Torque<T, 3>) -> Torque<f64, 3> {
    Torque {
        right: torque.right.to_f64(),
        left: torque.left.to_f64(),
        joints: torque.joints.map(Real::to_f64),
    }
}
