//! The messages, field by field, in the order of their definitions.

use super::cdr::Cdr;
use super::control::{FLAGS, NUMBERS};
use super::frames::{BASE, MOVING_JOINTS, Transform, WORLD, quaternion};
use super::sample::LogSample;
use super::trail::TrailPoint;

pub(super) const NO_TURN: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
/// A covariance that is not known, by the convention of ROS: all zeros.
const NO_COVARIANCE: [f64; 36] = [0.0; 36];

/// `builtin_interfaces/Time`. Seconds beyond 68 years stay at the largest number.
pub(super) fn time(cdr: &mut Cdr, stamp_ns: u64) {
    const NS: u64 = 1_000_000_000;
    cdr.i32(i32::try_from(stamp_ns / NS).unwrap_or(i32::MAX));
    cdr.u32(u32::try_from(stamp_ns % NS).unwrap_or_default());
}

/// `std_msgs/Header`.
pub(super) fn header(cdr: &mut Cdr, stamp_ns: u64, frame: &str) {
    time(cdr, stamp_ns);
    cdr.string(frame);
}

/// `std_msgs/msg/String`.
pub(super) fn string(cdr: &mut Cdr, text: &str) {
    cdr.begin();
    cdr.string(text);
}

/// `tf2_msgs/msg/TFMessage`.
pub(super) fn tf(cdr: &mut Cdr, stamp_ns: u64, transforms: &[Transform]) {
    cdr.begin();
    cdr.length(transforms.len());
    for transform in transforms {
        header(cdr, stamp_ns, transform.parent);
        cdr.string(transform.child);
        cdr.f64s(&transform.translation);
        cdr.f64s(&transform.rotation);
    }
}

/// `sensor_msgs/msg/JointState`; the efforts are the torques at the plant's input.
pub(super) fn joint_states(cdr: &mut Cdr, stamp_ns: u64, sample: &LogSample, wheel_rates: [f64; 2]) {
    let ([right, left], [q1, q2, q3]) = (sample.wheel_angles, sample.joints);
    let ([d_right, d_left], [d1, d2, d3]) = (wheel_rates, sample.joint_rates);
    cdr.begin();
    header(cdr, stamp_ns, "");
    cdr.length(MOVING_JOINTS.len());
    for name in MOVING_JOINTS {
        cdr.string(name);
    }
    for values in [[right, left, q1, q2, q3], [d_right, d_left, d1, d2, d3], sample.torque_applied] {
        cdr.length(values.len());
        cdr.f64s(&values);
    }
}

/// `nav_msgs/msg/Odometry`: the true pose of the base in the world, its velocity in its own frame.
pub(super) fn odometry(cdr: &mut Cdr, stamp_ns: u64, sample: &LogSample) {
    cdr.begin();
    header(cdr, stamp_ns, WORLD);
    cdr.string(BASE);
    cdr.f64s(&[sample.x, sample.y, 0.0]);
    cdr.f64s(&quaternion([0.0, 0.0, 1.0], sample.heading));
    cdr.f64s(&NO_COVARIANCE);
    cdr.f64s(&[sample.forward, 0.0, 0.0, 0.0, 0.0, sample.yaw_rate]);
    cdr.f64s(&NO_COVARIANCE);
}

/// `nav_msgs/msg/Path` in the world frame.
pub(super) fn path(cdr: &mut Cdr, stamp_ns: u64, points: impl ExactSizeIterator<Item = TrailPoint>) {
    cdr.begin();
    header(cdr, stamp_ns, WORLD);
    cdr.length(points.len());
    for (point_ns, position) in points {
        header(cdr, point_ns, WORLD);
        cdr.f64s(&position);
        cdr.f64s(&NO_TURN);
    }
}

/// `mmsim_msgs/msg/Control`.
pub(super) fn control(cdr: &mut Cdr, stamp_ns: u64, sample: &LogSample) {
    cdr.begin();
    header(cdr, stamp_ns, WORLD);
    for field in &NUMBERS {
        cdr.f64((field.value)(sample));
    }
    for field in &FLAGS {
        cdr.boolean((field.value)(sample));
    }
}

#[cfg(test)]
mod tests {
    use super::{Cdr, control, header, joint_states, path};
    use crate::log::control::{FLAGS, NUMBERS};
    use crate::log::sample::LogSample;

    #[test]
    fn a_header_is_seconds_nanoseconds_and_frame() {
        let mut cdr = Cdr::default();
        cdr.begin();
        header(&mut cdr, 3_000_000_007, "tip");
        let expected = [0, 1, 0, 0, 3, 0, 0, 0, 7, 0, 0, 0, 4, 0, 0, 0, b't', b'i', b'p', 0];
        assert_eq!(cdr.bytes(), expected, "3 s and 7 ns");
    }

    #[test]
    fn control_is_a_header_and_one_number_a_field() {
        let mut cdr = Cdr::default();
        control(&mut cdr, 0, &LogSample { t_s: 1.0, near_singular: true, ..LogSample::default() });
        // Encapsulation 4, stamp 8, "world" 4 + 6, two bytes to the next multiple of 8.
        let numbers = 4 + 24;
        let bytes = cdr.bytes();
        assert_eq!(bytes.len(), numbers + 8 * NUMBERS.len() + FLAGS.len(), "size of the message");
        assert_eq!(bytes[numbers..numbers + 8], 1.0_f64.to_le_bytes(), "the first number is the time");
        assert_eq!(bytes[bytes.len() - FLAGS.len()..], [0, 1, 0, 0, 0, 0, 0, 0, 0], "the flags");
    }

    #[test]
    fn joint_states_hold_wheels_then_arm() {
        let mut cdr = Cdr::default();
        let sample = LogSample {
            wheel_angles: [1.0, 2.0],
            joints: [3.0, 4.0, 5.0],
            torque_applied: [6.0; 5],
            ..LogSample::default()
        };
        joint_states(&mut cdr, 0, &sample, [0.0; 2]);
        let bytes = cdr.bytes();
        assert_eq!(bytes[bytes.len() - 8..], 6.0_f64.to_le_bytes(), "the last effort");
        // Positions, velocities and efforts: three times five numbers after a padded length.
        let positions = bytes.len() - 3 * 48 + 8;
        for (k, expected) in [1.0_f64, 2.0, 3.0, 4.0, 5.0].iter().enumerate() {
            let at = positions + 8 * k;
            assert_eq!(bytes[at..at + 8], expected.to_le_bytes(), "position of joint {k}");
        }
    }

    #[test]
    fn a_path_of_n_points_grows_by_80_bytes_a_point() {
        let mut cdr = Cdr::default();
        let mut size = |points: usize| {
            path(&mut cdr, 0, (0..points).map(|_| (0, [0.0; 3])));
            cdr.bytes().len()
        };
        // Stamp 8, "world" 4 + 6, two bytes of padding, seven numbers.
        let (two, ten) = (size(2), size(10));
        assert_eq!(ten - two, 8 * 80, "bytes a point");
    }
}
