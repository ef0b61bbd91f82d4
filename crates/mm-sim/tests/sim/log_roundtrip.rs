//! A log read back holds what was written: topics, definitions, numbers, attachments and metadata.
//!
//! Reference: the messages are decoded here by hand, from the offsets that the definitions give, without the
//! crate's own encoder. All comparisons are exact, since a log stores the bits it is given.

#![expect(clippy::expect_used, reason = "a helper that cannot go on is a failed test")]

use mcap::read::{Options, Summary};
use mcap::{Message, MessageStream};
use mm_sim::log::{LogError, LogHeader, LogSample, LogWriter, Outcome, RobotShape, control_field_names};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

const SCENARIO: &str = "name = \"synthetic\"\n[simulation]\nduration_s = 2.0\n";

fn shape() -> RobotShape {
    RobotShape::from(&mm_model::RobotParams::thesis())
}

fn sample(t_s: f64) -> LogSample {
    LogSample {
        t_s,
        x: 0.1 * t_s,
        y: -0.2 * t_s,
        joints: [0.3 * t_s, 1.0 - t_s, -2.0 + t_s],
        forward: 0.5,
        yaw_rate: 1.0,
        wheel_angles: [3.0 * t_s, 2.0 * t_s],
        tip: [t_s, 2.0 * t_s, 0.5],
        error: [1e-3 * t_s, 0.0, -1e-3],
        torque_applied: [1.0, 2.0, 3.0, 4.0, 5.0],
        manipulability: 0.45,
        saturated: t_s > 1.0,
        ..LogSample::default()
    }
}

fn header(reference: &[[f64; 4]]) -> LogHeader<'_> {
    LogHeader {
        scenario_name: "synthetic",
        scenario_text: SCENARIO,
        edits: &[],
        files: &[("my/path.CSV", "x_m,y_m,z_m\n"), ("robot.toml", "base_mass_kg = 40\n")],
        versions: &[("mm-control", "9.8.7")],
        seed: 42,
        controller: "bfsmc",
        robot: shape(),
        reference,
    }
}

/// Writes `duration_s` seconds at 100 Hz and gives the file's bytes.
fn run(duration_s: u32, reference: &[[f64; 4]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let writer = LogWriter::to_sink(&mut bytes, "synthetic.mcap", &header(reference));
    let mut writer = writer.expect("a vector takes anything");
    for k in 0..=duration_s * 100 {
        writer.write(&sample(f64::from(k) / 100.0)).expect("a vector takes anything");
    }
    writer.finish("{\"schema\": \"mmsim.summary/1\"}", "00ff").expect("a vector takes anything");
    bytes
}

fn messages(bytes: &[u8]) -> Vec<Message<'_>> {
    MessageStream::new(bytes).expect("a log").map(|message| message.expect("a message")).collect()
}

fn f64_at(message: &Message<'_>, offset: usize) -> f64 {
    // Offsets count from the end of the encapsulation, four bytes.
    f64::from_le_bytes(message.data[offset + 4..offset + 12].try_into().expect("eight bytes"))
}

fn u32_at(message: &Message<'_>, offset: usize) -> u32 {
    u32::from_le_bytes(message.data[offset + 4..offset + 8].try_into().expect("four bytes"))
}

fn exactly(got: f64, expected: f64, what: &str) {
    assert_eq!(got.to_bits(), expected.to_bits(), "{what}: {got} instead of {expected}");
}

#[test]
fn topics_types_and_counts_are_those_promised() {
    let bytes = run(2, &[[0.0, 0.0, 0.0, 0.5], [2.0, 1.0, 0.0, 0.5]]);
    let messages = messages(&bytes);
    assert_eq!(messages[0].channel.topic, "/robot_description", "the first message");
    assert_eq!(messages[1].channel.topic, "/reference", "the second message");
    let mut seen: BTreeMap<&str, (&str, u32)> = BTreeMap::new();
    for message in &messages {
        let schema = message.channel.schema.as_ref().expect("every channel has a schema");
        assert_eq!(message.channel.message_encoding, "cdr", "{}", message.channel.topic);
        assert_eq!(schema.encoding, "ros2msg", "{}", message.channel.topic);
        assert_eq!(message.data[..4], [0, 1, 0, 0], "little-endian CDR on {}", message.channel.topic);
        assert_eq!(message.log_time, message.publish_time, "one clock, the scenario's");
        seen.entry(&message.channel.topic).or_insert((&schema.name, 0)).1 += 1;
    }
    let expected = BTreeMap::from([
        ("/control", ("mmsim_msgs/msg/Control", 201)),
        ("/joint_states", ("sensor_msgs/msg/JointState", 201)),
        ("/odom", ("nav_msgs/msg/Odometry", 201)),
        ("/path", ("nav_msgs/msg/Path", 5)),
        ("/reference", ("nav_msgs/msg/Path", 1)),
        ("/robot_description", ("std_msgs/msg/String", 1)),
        ("/tf", ("tf2_msgs/msg/TFMessage", 201)),
    ]);
    assert_eq!(seen, expected, "topics with types and numbers of messages");
}

#[test]
fn numbers_come_back_bit_for_bit() {
    let bytes = run(2, &[]);
    let messages = messages(&bytes);
    let at = |topic: &str, ns: u64| {
        let found = messages.iter().find(|m| m.channel.topic == topic && m.log_time == ns);
        found.unwrap_or_else(|| panic!("{topic} at {ns} ns")).clone()
    };
    let t = 1.5;
    let s = sample(t);

    let control = at("/control", 1_500_000_000);
    assert_eq!((u32_at(&control, 0), u32_at(&control, 4)), (1, 500_000_000), "stamp");
    // Stamp 8, frame 4 + 6, padding 2: the numbers start at 24 - 4.
    let names: Vec<&str> = control_field_names().collect();
    let field =
        |name: &str| names.iter().position(|n| *n == name).unwrap_or_else(|| panic!("no field {name}"));
    for (name, expected) in [
        ("t_s", t),
        ("joint3_rad", s.joints[2]),
        ("tip_y_m", 3.0),
        ("error_x_m", s.error[0]),
        ("torque_applied_left_n_m", 2.0),
        ("manipulability", 0.45),
    ] {
        exactly(f64_at(&control, 24 + 8 * field(name)), expected, name);
    }
    let flags = 24 + 8 * field("saturated") + 4;
    assert_eq!(control.data[flags..], [1, 0, 0, 0, 0, 0, 0, 0, 0], "saturated, nothing else");
    let text = String::from_utf8_lossy(&control.channel.schema.as_ref().expect("a schema").data).into_owned();
    let defined: Vec<&str> =
        text.lines().filter_map(|l| l.split(' ').nth(1).filter(|_| l.contains(" # "))).collect();
    assert_eq!(defined[defined.len() - names.len()..], names, "the definition lists the same fields");

    let odom = at("/odom", 1_500_000_000);
    // Stamp 8, "world" 10, padding to 20, "base_link" 14, padding to 40.
    exactly(f64_at(&odom, 40), s.x, "x of the base");
    exactly(f64_at(&odom, 48), s.y, "y of the base");
    exactly(f64_at(&odom, 40 + 56 + 288), 0.5, "forward speed after pose and covariance");

    let joints = at("/joint_states", 1_500_000_000);
    let efforts = joints.data.len() - 4 - 40;
    exactly(f64_at(&joints, efforts + 8), 2.0, "torque of the left wheel");
    let velocities = efforts - 48;
    exactly(f64_at(&joints, velocities), (0.5 + 0.1) / 0.06, "rate of the right wheel");
    exactly(f64_at(&joints, velocities + 8), (0.5 - 0.1) / 0.06, "rate of the left wheel");
}

#[test]
fn attachments_and_metadata_identify_the_run() {
    let bytes = run(2, &[]);
    let summary = Summary::read(&bytes).expect("a log").expect("a finished log has a summary");
    let mut attachments = BTreeMap::new();
    for index in &summary.attachment_indexes {
        let attachment = mcap::read::attachment(&bytes, index).expect("an attachment");
        let text = String::from_utf8(attachment.data.into_owned()).expect("text");
        attachments.insert(attachment.name, (attachment.media_type, text));
    }
    assert_eq!(attachments["scenario.toml"].1, SCENARIO, "the scenario as run");
    let of = |kind: &str, text: &str| (kind.to_owned(), text.to_owned());
    assert_eq!(
        attachments["my/path.CSV"],
        of("text/csv", "x_m,y_m,z_m\n"),
        "the points that the scenario names"
    );
    assert_eq!(attachments["robot.toml"], of("application/toml", "base_mass_kg = 40\n"), "its robot");
    assert_eq!(attachments["summary.json"].0, "application/json", "type of the summary");
    assert_eq!(attachments["summary.json"].1, "{\"schema\": \"mmsim.summary/1\"}", "the summary");
    let mut records = BTreeMap::new();
    for index in &summary.metadata_indexes {
        let record = mcap::read::metadata(&bytes, index).expect("a metadata record");
        records.insert(record.name, record.metadata);
    }
    for (record, key, expected) in [
        ("mmsim", "scenario", "synthetic"),
        ("mmsim", "controller", "bfsmc"),
        ("mmsim", "seed", "42"),
        ("mmsim", "version", mm_sim::VERSION),
        ("mmsim", "version.mm-control", "9.8.7"),
        ("mmsim.result", "outcome", Outcome::Finished.as_str()),
        ("mmsim.result", "digest", "00ff"),
        ("mmsim.result", "samples", "201"),
        ("mmsim.result", "end_ns", "2000000000"),
    ] {
        assert_eq!(records[record][key], expected, "{record}: {key}");
    }
}

#[test]
fn the_path_is_bounded_and_grows_linearly_with_the_run() {
    let path_bytes = |duration_s| {
        let bytes = run(duration_s, &[]);
        let messages = messages(&bytes);
        let paths = messages.iter().filter(|m| m.channel.topic == "/path");
        let mut largest = 0;
        let mut total = 0;
        for path in paths {
            let points = u32_at(path, 20);
            assert!((1..=256).contains(&points), "{points} points at {} ns", path.log_time);
            // The last point is the tip now: x = t; x stands 64 bytes before the end of the message.
            let x = f64_at(path, path.data.len() - 4 - 56);
            exactly(
                x,
                f64::from(u32::try_from(path.log_time / 1_000_000).expect("a short run")) / 1e3,
                "newest point",
            );
            largest = largest.max(path.data.len());
            total += path.data.len();
        }
        (largest, total)
    };
    let (largest, at_25) = path_bytes(25);
    assert!(largest <= 256 * 80 + 32, "largest message: {largest} bytes");
    let (_, at_100) = path_bytes(100);
    assert!(at_100 < 5 * at_25, "four times the run: {at_25} bytes become {at_100}");
}

#[test]
fn a_long_reference_is_decimated() {
    let reference: Vec<[f64; 4]> = (0..98_001).map(|k| [f64::from(k) / 1e3, 0.0, 0.0, 0.5]).collect();
    let bytes = run(0, &reference);
    let messages = messages(&bytes);
    let points = u32_at(&messages[1], 20);
    assert_eq!(messages[1].channel.topic, "/reference", "the second message");
    assert!((1_900..=2_000).contains(&points), "{points} of 98,001 points");
}

/// A sink whose content can be looked at while a writer holds it.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_run_that_is_killed_leaves_what_was_flushed() {
    let file = Shared::default();
    // Buffered, as a file is: a flush has to go through.
    let sink = BufWriter::with_capacity(1 << 20, file.clone());
    let mut writer = LogWriter::to_sink(sink, "killed.mcap", &header(&[])).expect("a vector");
    let start = file.0.borrow().clone();
    let text = String::from_utf8_lossy(&start);
    assert!(text.contains("duration_s = 2.0"), "the scenario's attachment is there before the first sample");
    assert!(text.contains("bfsmc"), "and so is the metadata");

    writer.write(&sample(0.0)).expect("a vector");
    std::thread::sleep(Duration::from_millis(120));
    writer.write(&sample(0.01)).expect("a vector");
    writer.write(&sample(0.02)).expect("a vector");
    let mut left = file.0.borrow().clone();
    assert!(left.len() > start.len(), "the second sample came late and was flushed");
    // The last sample was not; a record that the kill cut in two does no harm either.
    left.extend_from_slice(&[6, 99, 0]);
    let stream = MessageStream::new_with_options(&left, Options::IgnoreEndMagic.into()).expect("a start");
    let read: Vec<_> = stream.map_while(Result::ok).collect();
    assert_eq!(read[0].channel.topic, "/robot_description", "the first message");
    let controls = read.iter().filter(|m| m.channel.topic == "/control").count();
    // The third is there, too, on a machine so busy that its turn came late.
    assert!((2..=3).contains(&controls), "both flushed samples: {controls}");
}

#[test]
fn a_file_on_disk_is_whole_even_when_the_writer_is_only_dropped() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("log_roundtrip_dropped.mcap");
    let mut writer = LogWriter::create(&path, &header(&[])).expect("a directory of our own");
    writer.write(&sample(0.0)).expect("space for a sample");
    drop(writer);
    let bytes = std::fs::read(&path).expect("the file");
    let summary = Summary::read(&bytes).expect("a log").expect("a summary section");
    assert_eq!(summary.metadata_indexes.len(), 1, "no outcome: the run did not finish");
    assert_eq!(messages(&bytes).len(), 7, "two messages before the sample and five with it");
}

#[test]
fn an_error_names_the_file() {
    // A file where a directory should be: refused to every user, whatever the permissions.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml").join("run.mcap");
    let error = LogWriter::create(&path, &header(&[])).expect_err("not a directory");
    assert!(matches!(error, LogError::Create { .. }), "{error:?}");
    assert!(error.to_string().contains("run.mcap"), "{error}");
    assert!(std::error::Error::source(&error).is_some(), "the reason is the source");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_not_a_panic() {
    let header = header(&[]);
    let error = LogWriter::create("/dev/full", &header).expect_err("the device is always full");
    assert!(matches!(error, LogError::Write { .. }), "{error:?}");
    assert!(error.to_string().contains("/dev/full"), "{error}");
}

/// A sink that takes so many bytes and no more.
struct Limited(usize);

impl Write for Limited {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        if taken == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(taken) }
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_disk_that_fills_up_during_the_run_is_an_error_from_then_on() {
    let header = header(&[]);
    let mut writer = LogWriter::to_sink(Limited(20_000), "small.mcap", &header).expect("room for the start");
    let first = (0..).find_map(|k| writer.write(&sample(f64::from(k) / 1e3)).err()).expect("it fills up");
    assert!(first.to_string().contains("small.mcap"), "{first}");
    assert!(writer.write(&sample(1e6)).is_err(), "and stays full");
    assert!(writer.finish("{}", "0").is_err(), "so the end is refused too");
}
