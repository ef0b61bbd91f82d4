//! A robot that is exported as URDF and imported again is the same robot.
//!
//! Law: export and import are inverse up to rounding, in the parameters and in the dynamics. Reference: random robots with a fixed
//! seed. Tolerance: 1e-12 relative on parameters, which are sums of coordinates; 1e-10 on accelerations.

use mm_model::{Configuration, Force, Robot, RobotParams, Torque, Velocity};
use mm_sim::robot::{ImportOptions, export, import};

/// A robot of random numbers, its gravity and rest posture those of the preset.
fn random_robot(random: &mut impl FnMut(f64, f64) -> f64) -> RobotParams<f64, 3> {
    let mut p = RobotParams::thesis();
    p.base_mass = random(5.0, 200.0);
    p.base_yaw_inertia = random(0.5, 20.0);
    p.base_com_offset = random(-0.3, 0.3);
    p.arm_offset = random(-0.3, 0.4);
    p.mount_height = random(0.0, 0.9);
    p.wheel_radius = random(0.03, 0.3);
    p.track_width = random(0.1, 0.9);
    p.limits.wheel_torque = random(1.0, 99.0);
    for joint in 0..3 {
        let length = random(0.1, 1.2);
        let mut inertia = || random(0.001, 0.5);
        let (axial_inertia, pitch_inertia, normal_inertia) = (inertia(), inertia(), inertia());
        let (mass, com) = (random(0.2, 9.0), random(0.0, 1.0) * length);
        p.links[joint] = mm_model::Link { length, mass, com, axial_inertia, pitch_inertia, normal_inertia };
        p.limits.joints[joint] = (random(-3.0, -2.5), random(2.0, 3.0));
        p.limits.joint_torque[joint] = random(5.0, 300.0);
    }
    p
}

fn numbers(p: &RobotParams<f64, 3>) -> Vec<f64> {
    let mut all = vec![
        p.base_mass,
        p.base_yaw_inertia,
        p.base_com_offset,
        p.arm_offset,
        p.mount_height,
        p.wheel_radius,
        p.track_width,
        p.gravity,
        p.limits.wheel_torque,
    ];
    for (link, ((lo, hi), torque)) in p.links.iter().zip(p.limits.joints.iter().zip(&p.limits.joint_torque)) {
        all.extend([
            link.length,
            link.mass,
            link.com,
            link.axial_inertia,
            link.pitch_inertia,
            link.normal_inertia,
            *lo,
            *hi,
            *torque,
        ]);
    }
    all
}

#[test]
fn what_is_exported_is_imported_again() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |lo: f64, hi: f64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let part = f64::from(u32::try_from(state >> 32).unwrap_or(0)) / f64::from(u32::MAX);
        lo + (hi - lo) * part
    };
    for number in 0..200 {
        let params = if number == 0 { RobotParams::thesis() } else { random_robot(&mut random) };
        let text = export(&params);
        let back =
            import("my.urdf", &text, &ImportOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        for (index, (one, other)) in numbers(&params).iter().zip(numbers(&back.params)).enumerate() {
            assert!(
                (one - other).abs() <= 1e-12 * one.abs().max(1.0),
                "number {index} of robot {number}: {one} and {other}"
            );
        }
        assert_eq!(back.notes.len(), 1, "nothing but gravity and posture is open: {:?}", back.notes);
        let robots = [params, back.params]
            .map(|params| Robot::try_new(params).unwrap_or_else(|error| panic!("{error}")));
        for _ in 0..5 {
            let mut three = || [random(-2.0, 2.0), random(-2.0, 2.0), random(-2.0, 2.0)];
            let q = Configuration { x: 0.1, y: 0.2, heading: 0.3, joints: three() };
            let nu = Velocity { forward: 0.7, yaw_rate: -0.9, joints: three() };
            let tau = Torque { right: 3.0, left: -2.0, joints: three() };
            let [one, other] = robots.map(|robot| {
                let rate = robot.forward_dynamics(&q, &nu, &tau, &Force::zero());
                [rate.forward, rate.yaw_rate, rate.joints[0], rate.joints[1], rate.joints[2]]
            });
            for (a, b) in one.iter().zip(other) {
                assert!(
                    (a - b).abs() <= 1e-10 * a.abs().max(1.0),
                    "accelerations of robot {number}: {a} and {b}"
                );
            }
        }
    }
}
