//! Disturbances as arrows: one a wheel and a joint, along the axis that the torque turns about, by the right-hand rule.

use super::cdr::Cdr;
use super::frames::{JOINTS, Joint};
use super::messages::{NO_TURN, header, time};

/// Length of an arrow, m for each N m.
const METRES_PER_NEWTON_METRE: f64 = 0.03;
/// Longest arrow, m.
const LONGEST_M: f64 = 1.0;
/// A torque that is not drawn, N m.
const NOTHING_N_M: f64 = 1e-6;
/// Simulated time between two messages.
const PERIOD_NS: u64 = 50_000_000;
/// Diameter of shaft and head, length of the head, m.
const SHAPE_M: [f64; 3] = [0.012, 0.03, 0.04];
/// Red, green, blue, opacity.
const COLOR: [f32; 4] = [0.9, 0.2, 0.1, 1.0];
/// Numbers of the kind of marker, and of what to do with it.
const ARROW: i32 = 0;
const ADD: i32 = 0;
const DELETE: i32 = 2;

/// The arrows that a viewer shows now.
#[derive(Debug, Default)]
pub(super) struct Arrows {
    shown: [bool; 5],
    next_ns: u64,
}

impl Arrows {
    /// Writes a `visualization_msgs/msg/MarkerArray` into the buffer if there is something to draw or to take away.
    pub(super) fn write(
        &mut self,
        cdr: &mut Cdr,
        stamp_ns: u64,
        joints: &[Joint; JOINTS],
        torques: &[f64; 5],
    ) -> bool {
        if stamp_ns < self.next_ns {
            return false;
        }
        let drawn = torques.map(|torque| torque.abs() > NOTHING_N_M);
        let told = std::array::from_fn::<_, 5, _>(|index| drawn[index] || self.shown[index]);
        if !told.contains(&true) {
            return false;
        }
        self.shown = drawn;
        self.next_ns = (stamp_ns / PERIOD_NS).saturating_add(1).saturating_mul(PERIOD_NS);
        cdr.begin();
        cdr.length(told.iter().filter(|is_told| **is_told).count());
        // The joints that move come first, in the order of the torques.
        for (id, (joint, torque)) in (0_i32..).zip(joints.iter().zip(torques)) {
            let index = usize::try_from(id).unwrap_or_default();
            if told[index] {
                let length = (torque * METRES_PER_NEWTON_METRE).clamp(-LONGEST_M, LONGEST_M);
                marker(cdr, stamp_ns, (joint, id), drawn[index].then_some(length));
            }
        }
        true
    }
}

/// `visualization_msgs/Marker`: an arrow from the origin of a joint's frame, or its end.
fn marker(cdr: &mut Cdr, stamp_ns: u64, (joint, id): (&Joint, i32), length: Option<f64>) {
    header(cdr, stamp_ns, joint.child);
    cdr.string("disturbance");
    cdr.i32(id);
    cdr.i32(ARROW);
    cdr.i32(if length.is_some() { ADD } else { DELETE });
    cdr.f64s(&[0.0; 3]);
    cdr.f64s(&NO_TURN);
    cdr.f64s(&SHAPE_M);
    cdr.f32s(&COLOR);
    // It lives until the next message and moves with its frame.
    time(cdr, 0);
    cdr.boolean(true);
    cdr.length(2 * usize::from(length.is_some()));
    if let Some(length) = length {
        cdr.f64s(&[0.0; 3]);
        cdr.f64s(&joint.axis.map(|component| component * length));
    }
    // No colours of points, no texture with its image, no coordinates on it, no text, no mesh with its file.
    cdr.length(0);
    cdr.string("");
    header(cdr, 0, "");
    cdr.string("");
    cdr.length(0);
    cdr.length(0);
    cdr.string("");
    cdr.string("");
    cdr.string("");
    cdr.length(0);
    cdr.boolean(false);
}

#[cfg(test)]
mod tests {
    use super::{Arrows, Cdr};
    use crate::log::frames::joints;
    use crate::log::urdf::tests::thesis_like;

    #[test]
    fn an_arrow_is_drawn_while_there_is_a_torque_and_then_taken_away() {
        let joints = joints(&thesis_like());
        let (mut arrows, mut cdr) = (Arrows::default(), Cdr::default());
        let none = [0.0; 5];
        let one = [0.0, 0.0, 0.0, 10.0, 0.0];
        let mut at = |ms: u64, torques: &[f64; 5]| {
            let is_written = arrows.write(&mut cdr, ms * 1_000_000, &joints, torques);
            is_written.then(|| (cdr.bytes()[4], cdr.bytes().windows(11).any(|w| w == b"disturbance")))
        };
        assert_eq!(at(0, &none), None, "nothing to draw");
        assert_eq!(at(1, &one), Some((1, true)), "one marker");
        assert_eq!(at(49, &one), None, "not before 50 ms");
        assert_eq!(at(50, &one), Some((1, true)), "then again");
        assert_eq!(at(100, &none), Some((1, true)), "taken away");
        assert_eq!(at(150, &none), None, "once");
    }
}
