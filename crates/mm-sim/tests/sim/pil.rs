//! Processor in the loop, with the target's program in a thread at the other end of a pseudo-terminal.
//!
//! Laws: (1) every torque and every stage of the target's controller is the host's, bit for bit, and in double precision the run is
//! the simulation's own, digest and all; (2) a wire that loses, damages, repeats and delays frames changes nothing of that; (3) a
//! target that computes otherwise is found out at the first tick and with its stage; (4) one that falls silent, or a mistake of the
//! user, ends with the exit code and the message of the documentation. There is no tolerance.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use std::io::{Read as _, Write as _};
use std::process::{Command, Output};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mm_link::{Clock, Header, Identity, Kind, LONGEST_ON_WIRE, Node, Port, Receiver, encode};
use serde_json::Value;
use serialport::{SerialPort as _, TTYPort};

/// What is done to an answer before it goes out.
type Meddle = fn(Vec<u8>) -> Vec<u8>;

/// The target's end of a pseudo-terminal.
struct Wire {
    port: TTYPort,
    came: std::collections::VecDeque<u8>,
    meddle: Meddle,
}

impl Port for Wire {
    fn read(&mut self) -> Option<u8> {
        if self.came.is_empty() {
            let mut bytes = [0; 256];
            let count = self.port.read(&mut bytes).unwrap_or(0);
            self.came.extend(&bytes[..count]);
        }
        self.came.pop_front()
    }

    fn write(&mut self, bytes: &[u8]) {
        let _ = self.port.write_all(&(self.meddle)(bytes.to_vec()));
    }
}

/// Microseconds.
struct Stopwatch(Instant);

impl Clock for Stopwatch {
    fn ticks(&self) -> u32 {
        (self.0.elapsed().as_micros() & 0x00ff_ffff) as u32
    }
}

/// A target in a thread.
struct Board {
    /// Kept open, so that the other end does not hang up between two runs.
    _slave: std::fs::File,
    name: String,
    end: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Board {
    fn new(meddle: Meddle) -> Self {
        let (mut master, slave) = TTYPort::pair().unwrap();
        master.set_timeout(Duration::from_millis(2)).unwrap();
        let name = slave.name().unwrap();
        let open = std::fs::File::options().read(true).write(true).open(&name).unwrap();
        // The port is for one process at a time.
        drop(slave);
        let end = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&end);
        let thread = std::thread::spawn(move || {
            let identity = Identity { target: "thread", ticks_per_second: 1_000_000, loop_ticks: 10 };
            let mut node = Node::new(identity);
            let mut wire = Wire { port: master, came: std::collections::VecDeque::new(), meddle };
            let clock = Stopwatch(Instant::now());
            while !ended.load(Ordering::Relaxed) {
                node.poll(&mut wire, &clock);
            }
        });
        Self { _slave: open, name, end, thread: Some(thread) }
    }

    fn run(&self, more: &[&str]) -> Output {
        let target = format!("serial:{}", self.name);
        let mut all = vec!["pil", "--scenario", "square-compare", "--target", &target, "--no-log", "--json"];
        all.extend(more);
        mmsim(&all)
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        self.end.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn mmsim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mmsim")).args(arguments).output().unwrap()
}

fn untouched(answer: Vec<u8>) -> Vec<u8> {
    answer
}

fn report(output: &Output) -> Value {
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text).unwrap_or_else(|_| unreachable!("{text}{}", complaint(output)))
}

fn complaint(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn in_double_precision_the_run_is_that_of_the_simulation() {
    let board = Board::new(untouched);
    for more in [
        &["--seconds", "0.4", "--precision", "f64"][..],
        &["--seconds", "0.2", "--precision", "f64", "--controller", "bfsmc-thesis"],
        // With sensors and an estimator.
        &["--seconds", "0.2", "--precision", "f64", "--set", "plant.sensors.joint_bits=16"],
    ] {
        let output = board.run(more);
        let there = report(&output);
        assert_eq!(output.status.code(), Some(0), "{more:?}: {}", complaint(&output));
        let mut plain = vec!["run", "--scenario", "square-compare", "--no-log", "--json"];
        let duration = format!("simulation.duration_s={}", more[1]);
        plain.extend(["--set", &duration]);
        plain.extend(more.iter().skip(4));
        let here = report(&mmsim(&plain));
        assert_eq!(there["digest"], here["digest"], "{more:?}");
        assert_eq!(there["schema"], "mmsim.pil/1");
        assert_eq!(there["equal_ticks"], there["ticks"], "{more:?}: {}", there["first_difference"]);
        let ticks = more[1].parse::<f64>().unwrap() * 1000.0;
        assert_eq!(there["ticks"].as_f64(), Some(ticks), "all of them");
        assert_eq!(there["summary"]["metrics"], here["metrics"], "{more:?}");
        assert_eq!(there["cost"]["unit"], "timer ticks", "a port has no instructions");
        assert_eq!(there["frames"]["lost"], 0, "a sound wire");
    }
}

#[test]
fn a_bad_wire_costs_time_and_nothing_else() {
    let board = Board::new(untouched);
    let damage = "drop=0.02,corrupt=0.04,duplicate=0.03,delay=0.03";
    let more = ["--seconds", "0.4", "--inject", damage, "--timeout-ms", "60"];
    let sound = report(&board.run(&more[..2]));
    let output = board.run(&more);
    let bad = report(&output);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    assert_eq!((&bad["ticks"], &bad["equal_ticks"]), (&sound["ticks"], &sound["ticks"]), "all of them");
    assert_eq!(bad["digest"], sound["digest"], "the same run");
    let injected = &bad["injected"];
    for key in ["dropped", "corrupted", "duplicated", "delayed", "answers_dropped"] {
        assert!(injected[key].as_u64() > Some(2), "{key}: {injected}");
    }
    let there = &bad["target_frames"];
    for key in ["corrupt", "duplicates", "stale"] {
        assert!(there[key].as_u64() > Some(0), "{key}: {there}");
    }
    // Two runs, each tick once.
    assert_eq!(there["updates"], 800, "{there}");
    assert!(bad["frames"]["retried"].as_u64() > Some(10), "{}", bad["frames"]);
}

/// Turns the lowest bit of the first torque, from tick 51 on.
fn one_bit_off(answer: Vec<u8>) -> Vec<u8> {
    let mut receiver: Receiver = Receiver::new();
    for &byte in &answer {
        let Some(Ok(frame)) = receiver.feed(byte) else { continue };
        let Header { kind: Kind::Command32, seq: 51.., .. } = frame.header else { return answer };
        let mut command: mm_link::Command<f32> = frame.body().unwrap();
        command.torque.right = f32::from_bits(command.torque.right.to_bits() ^ 1);
        let mut buffer = [0; LONGEST_ON_WIRE];
        return encode(frame.header, &command, &mut buffer).unwrap().to_vec();
    }
    answer
}

#[test]
fn a_single_bit_is_found_where_it_is() {
    let board = Board::new(one_bit_off);
    let output = board.run(&["--seconds", "0.08"]);
    assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
    let found = report(&output);
    assert_eq!((&found["ticks"], &found["equal_ticks"]), (&80.into(), &50.into()), "30 differ");
    assert_eq!(found["first_difference"]["tick"], 50, "counted from 0");
    assert_eq!(found["first_difference"]["stage"], "torque");
}

/// Says nothing from tick 21 on.
fn falls_silent(answer: Vec<u8>) -> Vec<u8> {
    let mut receiver: Receiver = Receiver::new();
    for &byte in &answer {
        if let Some(Ok(frame)) = receiver.feed(byte) {
            return if frame.header.seq > 20 { Vec::new() } else { answer };
        }
    }
    answer
}

#[test]
fn a_target_that_falls_silent_fails_the_run() {
    let board = Board::new(falls_silent);
    let output = board.run(&["--seconds", "0.1", "--timeout-ms", "20"]);
    assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
    let found = report(&output);
    assert_eq!((&found["ticks"], &found["equal_ticks"]), (&20.into(), &20.into()), "up to there");
    assert_eq!(found["link_error"], "no answer to a tick in 6 attempts of 20 ms");
    assert_eq!(found["summary"]["ended"], "interrupted");
}

#[test]
fn mistakes_are_answered_with_what_to_do() {
    let pil = |more: &[&str]| {
        let output = mmsim(&[&["pil", "--scenario", "square-compare", "--no-log"], more].concat());
        (output.status.code(), complaint(&output))
    };
    let (code, text) = pil(&["--target", "qemu:cortex-m7"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("no target `qemu:cortex-m7`: one of qemu:cortex-m4, qemu:cortex-m3"), "{text}");
    let (code, text) = pil(&["--target", "qemu:cortex-m4", "--firmware", "nowhere.elf"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("no firmware at nowhere.elf: `cargo xtask pil --build` builds it"), "{text}");
    let (code, text) = pil(&["--target", "serial:/dev/none"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.starts_with("error: cannot open /dev/none: "), "{text}");
    let (code, text) = pil(&["--target", "serial:/dev/none", "--inject", "drop=2"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("`drop` must lie between 0 and 0.5"), "{text}");
    let fault = ["--set", "fault=[{kind='nan', on='state', from_s=0.1, to_s=0.2}]"];
    let (code, text) = pil(&[&["--target", "serial:/dev/none"][..], &fault].concat());
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("faults are not injected into what a target sees"), "{text}");
    let (code, text) = pil(&["--target", "serial:/dev/none", "--set", "controller.fuzzy_engine='sampled'"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("no firmware samples the output sets"), "{text}");
}
