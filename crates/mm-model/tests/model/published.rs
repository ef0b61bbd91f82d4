//! The numbers of one state that independent rigid-body engines agree on.
//!
//! Law: M, C nu, g and forward dynamics at q = (0.3, 0.4, -0.7), nu = (0.5, -0.8, 0.9, 1.1, -1.3), no torque, for the thesis's
//! robot with its base's centre of mass on the axle, point masses at the link tips and link inertias of 1e-3 kg m^2. Reference:
//! a CasADi derivation and Pinocchio agree on these digits. Tolerance: the digits given.

#![expect(clippy::unwrap_used, reason = "a test that cannot build its robot has failed")]

use mm_model::{Configuration, Force, Mechanism, Robot, RobotParams, Torque, Velocity};

fn robot() -> Robot<f64, 3> {
    let mut params = RobotParams::<f64, 3>::thesis();
    params.base_com_offset = 0.0;
    for link in &mut params.links {
        link.axial_inertia = 1e-3;
    }
    Robot::try_new(params).unwrap()
}

#[test]
fn one_state_agrees_with_other_engines() {
    let robot = robot();
    let q = Configuration { joints: [0.3, 0.4, -0.7], ..Configuration::zero() };
    let nu = Velocity { forward: 0.5, yaw_rate: -0.8, joints: [0.9, 1.1, -1.3] };
    let inertia = robot.inertia(&robot.posture(&q.joints));
    let first_row = robot.mass_matrix(&inertia);
    let row = [
        first_row.base[(0, 0)],
        first_row.base[(0, 1)],
        first_row.coupling[(0, 0)],
        first_row.coupling[(0, 1)],
        first_row.coupling[(0, 2)],
    ];
    close("M, first row", row, [64.0, -1.925603, -1.925603, -1.295485, 0.564642], 1e-6);
    let channels = |f: Force<f64, 3>| [f.forward, f.yaw, f.joints[0], f.joints[1], f.joints[2]];
    let coriolis = channels(robot.coriolis_product(&inertia, &nu, &nu));
    close("C nu", coriolis, [-5.862822, -3.191276, -2.728051, -0.536337, -0.876829], 1e-6);
    close("g", channels(robot.gravity(&inertia)), [0.0, 0.0, 0.0, 63.921744, 18.743702], 1e-6);
    let a = robot.forward_dynamics(&q, &nu, &Torque::zero(), &Force::zero());
    let a = [a.forward, a.yaw_rate, a.joints[0], a.joints[1], a.joints[2]];
    close("nu'", a, [-0.32067, -0.115768, 0.548543, -16.1311, 11.1955], 5e-5);
}

fn close(what: &str, got: [f64; 5], expected: [f64; 5], tolerance: f64) {
    for (channel, (a, b)) in got.into_iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance, "{what}, channel {channel}: {a} instead of {b}");
    }
}
