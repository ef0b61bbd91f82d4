//! Law: a recording computed again gives the same bits, and a bit that was changed anywhere in it is found, at its tick, stage and
//! signal, with both bit patterns.
//!
//! Why: `cargo xtask qemu` takes the silence of a replay as proof that a target computes the host's bits. References: the recording
//! itself, and the known place of a bit that is flipped in it. No tolerance: bits.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use mm_control::{LawKind, Measurement, Reference, WheelAngles};
use mm_link::Setup;
use mm_model::{Configuration, RobotParams, Velocity};
use mm_replay::{
    Difference, Entry, Failure, Full, Recording, SIGNALS, Seen, Sink, Source, Stage, Word, replay,
};
use nalgebra::Vector3;

const TICKS: u32 = 40;

/// Bytes in memory, as a sink and as a source.
#[derive(Clone, Default)]
struct Memory {
    bytes: Vec<u8>,
    read: usize,
}

impl Sink for Memory {
    fn write(&mut self, bytes: &[u8]) -> Result<(), Full> {
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }
}

impl Source for Memory {
    fn read(&mut self, buffer: &mut [u8]) -> usize {
        // Small pieces: a reader has to ask again.
        let count = buffer.len().min(7).min(self.bytes.len() - self.read);
        buffer[..count].copy_from_slice(&self.bytes[self.read..self.read + count]);
        self.read += count;
        count
    }
}

/// A robot that drives and waves its arm; nothing that a controller would do.
fn entry<T: Word>(tick: u32, is_measured: bool) -> Entry<T> {
    let n = T::nearest;
    let t = f64::from(tick) * 1e-3;
    let q = Configuration {
        x: n(0.4 * t),
        y: n(-0.1 * t),
        heading: n(0.3 * t),
        joints: [n(0.2 + t), n(0.7 - t), n(0.9)],
    };
    let nu = Velocity { forward: n(0.4), yaw_rate: n(0.3), joints: [n(1.0), n(-1.0), n(0.0)] };
    let seen = if is_measured {
        let wheels = Some(WheelAngles { right: n(3.0 * t), left: n(2.5 * t) });
        Seen::Measured(Measurement { q, wheels })
    } else {
        Seen::State(q, nu)
    };
    let vector = |x: f64, y: f64, z: f64| Vector3::new(n(x), n(y), n(z));
    let reference = Reference {
        position: vector(0.8 + t, 0.2, 0.9 + 0.1 * t),
        velocity: vector(1.0, 0.0, 0.1),
        acceleration: vector(0.0, 0.2, 0.0),
    };
    Entry { tick, seen, reference }
}

fn recorded<T: Word>(is_measured: bool) -> Memory {
    let mut setup = Setup::for_robot(RobotParams::thesis(), LawKind::Bfsmc, T::nearest(1e-3))
        .expect("the thesis's robot");
    if is_measured {
        setup.stack.estimator = mm_control::Estimator::FilteredDifference { cutoff_hz: T::nearest(60.0) };
    }
    let mut memory = Memory::default();
    let first = entry(0, is_measured).seen;
    let mut recording = Recording::begin("waving", &setup, &first, TICKS, &mut memory).expect("a stack");
    for tick in 0..TICKS {
        recording.add(&entry(tick, is_measured), &mut memory).expect("a finite input");
    }
    memory
}

#[test]
fn recordings_one_after_the_other_give_the_same_bits() {
    let mut memory = recorded::<f32>(false);
    memory.bytes.extend(recorded::<f64>(false).bytes);
    memory.bytes.extend(recorded::<f64>(true).bytes);
    let mut digests = Vec::new();
    while let Some(replayed) = replay(&mut memory).expect("the same bits") {
        assert_eq!((replayed.ticks, replayed.name.to_string().as_str()), (TICKS, "waving"), "the head");
        digests.push((replayed.precision, replayed.digest));
    }
    assert_eq!(digests.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["f32", "f64", "f64"], "in order");
    assert!(digests[1].1 != digests[2].1 && digests[0].1 != digests[1].1, "other numbers, other digests");
}

/// Flips the lowest bit of every recorded number of one tick in turn: it is found where it is.
fn every_flip_is_found<T: Word>() {
    let memory = recorded::<T>(false);
    let width = usize::from(T::BYTES);
    let numbers: usize = SIGNALS.iter().map(|(_, _, count)| count).sum();
    let tick_bytes = 4 + (11 + 9) * width + numbers * width + 4;
    let tick = 17;
    let outputs = memory.bytes.len() - (TICKS as usize - tick) * tick_bytes + 4 + (11 + 9) * width;
    let names =
        SIGNALS.iter().flat_map(|(stage, name, count)| (0..*count).map(move |index| (*stage, *name, index)));
    for (place, (stage, name, index)) in names.chain([(Stage::Torque, "status", 0)]).enumerate() {
        let mut damaged = memory.clone();
        damaged.bytes[outputs + place * width] ^= 1;
        let Err(Failure::Differs(difference)) = replay(&mut damaged) else {
            panic!("{name}[{index}] was not found")
        };
        let Difference { tick: found, signal, here, recorded, .. } = difference;
        assert_eq!(
            (found as usize, signal.stage, signal.name, signal.index),
            (tick, stage, name, index),
            "place"
        );
        assert_eq!(here ^ recorded, 1, "{name}[{index}]: both bit patterns");
    }
}

#[test]
fn a_flipped_bit_is_found_where_it_is() {
    every_flip_is_found::<f32>();
    every_flip_is_found::<f64>();
}

#[test]
fn a_difference_is_told_in_one_line() {
    let mut memory = recorded::<f32>(false);
    let last = memory.bytes.len() - 4 - 4;
    memory.bytes[last] ^= 1;
    let failure = replay(&mut memory).expect_err("a flipped bit").to_string();
    assert!(failure.starts_with("waving f32: tick 39: torque: torque[4] is 0x"), "{failure}");
    assert!(failure.contains(", recorded 0x"), "{failure}");
}

#[test]
fn another_input_gives_another_output() {
    // The desired height of the first tick: nothing that is recorded says what it was.
    let mut memory = recorded::<f64>(false);
    let tick_bytes = 4 + 20 * 8 + 58 * 8 + 4;
    let at = memory.bytes.len() - TICKS as usize * tick_bytes + 4 + (11 + 2) * 8 + 6;
    memory.bytes[at] ^= 1;
    let Err(Failure::Differs(difference)) = replay(&mut memory) else { panic!("a change was not found") };
    assert_eq!((difference.tick, difference.signal.stage), (0, Stage::Kinematics), "{difference}");
}

#[test]
fn a_file_that_is_none_is_refused() {
    let whole = recorded::<f32>(false);
    let with = |change: fn(&mut Vec<u8>)| {
        let mut memory = whole.clone();
        change(&mut memory.bytes);
        replay(&mut memory).expect_err("a damaged file").to_string()
    };
    assert_eq!(with(|bytes| bytes[0] = b'x'), "no recording", "magic");
    assert_eq!(with(|bytes| bytes[8] = 9), "a recording of another version", "version");
    assert_eq!(with(|bytes| bytes[9] = 5), "numbers of an unknown width", "width");
    assert_eq!(with(|bytes| bytes[10] = 7), "inputs of an unknown kind", "kind");
    assert_eq!(with(|bytes| bytes.truncate(bytes.len() - 1)), "a recording cut off", "end");
    assert_eq!(with(|bytes| bytes[14] = 1), "a setup that is too long", "length");
    assert_eq!(replay(&mut Memory::default()), Ok(None), "an empty file holds none");
}
