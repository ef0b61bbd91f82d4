//! The target's side of the link, under every damage that a wire can do.
//!
//! Laws: (1) whatever bytes come in, no panic, and no torque beyond the robot's limits, infinite or NaN; (2) the answers to
//! accepted ticks are those of a supervised stack that saw exactly these ticks, bit for bit; (3) a request is done once: its repetition
//! gets the first answer again, byte for byte, an older one is refused; (4) silence leads to a held torque, then to a stop; sound ticks
//! lead back. References: the same supervised stack, called here; a count of what was done to the frames. There is no tolerance.
#![expect(clippy::expect_used, reason = "helpers of tests")]

mod common;

use common::{Host, SETTLED, TestClock, Wire, frame, ticks};
use mm_control::LawKind;
use mm_control::supervisor::{Findings, Mode};
use mm_link::{Counters, Header, Kind, LONGEST_ON_WIRE, Node, Pace, Reason, Refusal, Report, encode};

/// Sends what stands in the wire to the node and checks law (1).
fn poll(node: &mut Node, wire: &mut Wire, clock: &TestClock) {
    node.poll(wire, clock);
    within_limits(node);
}

fn within_limits(node: &Node) {
    let applied = node.applied();
    for (torque, limit) in applied.torque.into_iter().zip([60.0, 60.0, 150.0, 200.0, 150.0]) {
        assert!(torque.is_finite() && torque.abs() <= limit, "{applied:?}");
    }
}

#[test]
fn every_sound_tick_is_answered_as_by_the_stack_itself() {
    sound::<f32>(LawKind::Bfsmc, false);
    sound::<f64>(LawKind::BfsmcThesis, false);
    sound::<f64>(LawKind::Bfsmc, true);
    sound::<f32>(LawKind::SuperTwisting, true);
}

fn sound<T: mm_link::Scalar>(law: LawKind, measured: bool) {
    let mut host = Host::<T>::new(law, measured, Pace::Lockstep);
    let mut twin = host.twin();
    for (seq, tick) in ticks::<T>(measured).take(500) {
        let there = host.tick(seq, &tick).expect("an answer");
        twin.agrees(1, &tick, &there);
    }
    assert_eq!(host.node.counters(), &Counters { updates: 500, ..Counters::default() }, "{law:?}");
}

#[test]
fn a_repeated_request_is_answered_alike_and_done_once() {
    let mut host = Host::<f32>::new(LawKind::Bfsmc, false, Pace::Lockstep);
    let mut twin = host.twin();
    for (seq, tick) in ticks::<f32>(false).take(200) {
        let bytes = frame(Kind::Tick32, seq, &tick);
        let first = host.exchange(&bytes);
        for _ in 0..seq % 4 {
            assert_eq!(host.exchange(&bytes), first, "tick {seq}");
        }
        twin.agrees(1, &tick, &Host::<f32>::command(&first, seq).expect("an answer"));
    }
    let reset = frame(Kind::Reset, 1000, &());
    let first = host.exchange(&reset);
    assert_eq!(host.exchange(&reset), first, "a reset is no other");
    assert_eq!(host.node.counters().duplicates, 200 / 4 * 6 + 1, "all counted");
    assert_eq!(host.node.counters().updates, 200, "and done once");
}

#[test]
fn older_requests_are_refused_and_change_nothing() {
    let mut host = Host::<f64>::new(LawKind::Bfsmc, false, Pace::Lockstep);
    let mut twin = host.twin();
    let all: Vec<_> = ticks::<f64>(false).take(300).collect();
    for (i, (seq, tick)) in all.iter().enumerate() {
        twin.agrees(1, tick, &host.tick(*seq, tick).expect("an answer"));
        if i % 3 == 2 {
            let (old, tick) = &all[i - 1 - i % 2];
            assert_eq!(
                host.refused(&frame(Kind::Tick64, *old, tick)),
                Reason::Stale,
                "tick {old} after {seq}"
            );
            assert_eq!(host.refused(&frame(Kind::Reset, *old, &())), Reason::Stale, "a reset, too");
        }
    }
    assert_eq!(host.node.counters().stale, 200, "all counted");
}

#[test]
fn ticks_left_out_are_missed_ones() {
    let mut host = Host::<f64>::new(LawKind::Bfsmc, false, Pace::Lockstep);
    let mut twin = host.twin();
    let mut gap = 0;
    let mut missed = 0;
    for (seq, tick) in ticks::<f64>(false).take(600) {
        gap += 1;
        if seq % 50 == 20 || (300..308).contains(&seq) {
            continue;
        }
        missed += gap - 1;
        let command = host.tick(seq, &tick).expect("an answer");
        twin.agrees(gap, &tick, &command);
        gap = 0;
        assert_eq!(
            command.mode == Mode::Run,
            !(308..308 + SETTLED - 1).contains(&seq),
            "tick {seq}: {command:?}"
        );
    }
    assert_eq!(host.node.counters().missed, missed, "all counted");
    // Far ahead is a mistake rather than a silence; the operator says that it is none.
    let (_, tick) = ticks::<f64>(false).next().expect("a tick");
    assert_eq!(host.refused(&frame(Kind::Tick64, 60_000, &tick)), Reason::Gap, "60,000 after 600");
    host.done(Kind::Reset, 60_000);
    assert_eq!(host.tick(60_001, &tick).expect("an answer").mode, Mode::Run, "anew");
}

/// What becomes of a frame on a bad wire.
fn damaged(random: &mut common::Random, bytes: &[u8], late: &mut Vec<(u32, Vec<u8>)>) -> Vec<u8> {
    let mut out = Vec::new();
    let at = random.below(bytes.len());
    match random.below(40) {
        0 => {}
        1 => out.extend(bytes.iter().chain(bytes)),
        2 => late.push((1 + u32::try_from(random.below(5)).expect("few"), bytes.to_vec())),
        3 => out.extend(&bytes[..at]),
        4 => out.extend(&bytes[at..]),
        5 => {
            out.extend(bytes);
            out[at] ^= 1 << random.below(8);
        }
        6 => {
            let garbage = random.below(300);
            out.extend((0..garbage).map(|_| random.byte()));
            out.extend(bytes);
        }
        7 => {
            // Sound to the last bit, but of another version, kind or length.
            let (_, tick) = ticks::<f32>(false).next().expect("a tick");
            let kinds = [Kind::Tick64, Kind::Setup32, Kind::Ready, Kind::Reset, Kind::Tick32, Kind::Query];
            let mut buffer = [0; LONGEST_ON_WIRE];
            let header = Header { kind: kinds[random.below(6)], session: common::SESSION, seq: 1 };
            let body = (tick.reference, random.byte());
            out.extend_from_slice(encode(header, &body, &mut buffer).expect("room"));
            out.extend(bytes);
        }
        8 => out.extend((0..4000).map(|_| 1 + random.byte() % 255)),
        _ => out.extend(bytes),
    }
    late.retain_mut(|(wait, held)| {
        *wait -= 1;
        if *wait == 0 {
            out.extend(held.iter());
        }
        *wait > 0
    });
    out
}

#[test]
fn no_damage_moves_the_state_from_that_of_the_accepted_ticks() {
    for seed in 0..6 {
        let measured = seed % 2 == 1;
        let mut host = Host::<f32>::new(LawKind::Bfsmc, measured, Pace::Lockstep);
        let mut twin = host.twin();
        let mut random = common::Random(seed);
        let mut late = Vec::new();
        let all: Vec<_> = ticks::<f32>(measured).take(3000).collect();
        let mut last = 0;
        let mut ran = 0;
        for (seq, tick) in &all {
            let bytes = damaged(&mut random, &frame(Kind::Tick32, *seq, tick), &mut late);
            host.wire.input.extend(bytes);
            poll(&mut host.node, &mut host.wire, &host.clock);
            for (header, command) in host.commands() {
                if header.seq == last {
                    continue;
                }
                assert!(header.seq > last, "order");
                let tick = &all[header.seq as usize - 1].1;
                twin.agrees(header.seq - last, tick, &command);
                last = header.seq;
                ran += u32::from(command.mode == Mode::Run);
            }
        }
        let counters = host.node.counters();
        assert!(counters.updates > 2000 && ran > 1000, "seed {seed}: {counters:?}, {ran} with the law");
        assert!(
            counters.corrupt > 200 && counters.duplicates > 20 && counters.stale > 20,
            "seed {seed}: {counters:?}"
        );
        host.wire.input.extend([0]);
        poll(&mut host.node, &mut host.wire, &host.clock);
        // The wire is well again: within the time of a recovery the law runs as before.
        for (seq, tick) in ticks::<f32>(measured).skip(3000).take(SETTLED as usize + 2) {
            let there = host.tick(seq, &tick).expect("an answer");
            twin.agrees(core::mem::replace(&mut last, seq).abs_diff(seq), &tick, &there);
        }
        assert_eq!(host.node.applied().mode, Mode::Run, "seed {seed}");
    }
}

#[test]
fn no_bytes_at_all_do_harm() {
    let mut host = Host::<f64>::new(LawKind::Bfsmc, false, Pace::RealTime);
    let mut random = common::Random(99);
    for round in 0..3000 {
        let count = random.below(400);
        host.wire
            .input
            .extend((0..count).map(|_| if round % 2 == 0 { random.byte() } else { random.byte() % 4 }));
        host.clock.advance(0.3e-3);
        poll(&mut host.node, &mut host.wire, &host.clock);
    }
    host.wire.input.extend([0]);
    assert_eq!(host.node.counters().updates, 0, "nothing came through");
    assert!(host.node.counters().corrupt > 10_000, "{:?}", host.node.counters());
    host.done(Kind::Query, 5);
}

#[test]
fn by_its_own_clock_the_target_holds_then_stops_and_comes_back() {
    let mut host = Host::<f32>::new(LawKind::Bfsmc, false, Pace::RealTime);
    let mut all = ticks::<f32>(false);
    let run = |host: &mut Host<f32>, (seq, tick): (u32, mm_link::Tick<f32>)| {
        host.clock.advance(1e-3);
        host.tick(seq, &tick).expect("an answer")
    };
    for pair in all.by_ref().take(100) {
        assert_eq!(run(&mut host, pair).mode, Mode::Run, "on time");
    }
    let held = host.node.applied().torque;
    // 1.4 periods after the last tick nothing is missing yet; 1.6 after it, one is.
    let mut modes = Vec::new();
    host.clock.advance(0.4e-3);
    for _ in 0..10 {
        host.clock.advance(1e-3);
        poll(&mut host.node, &mut host.wire, &host.clock);
        modes.push(host.node.applied().mode);
        if modes.last() == Some(&Mode::Hold) {
            let torque = host.node.applied().torque;
            assert_eq!(torque.map(f64::to_bits), held.map(f64::to_bits), "the last torque of the law");
        }
        host.clock.advance(0.1e-3);
        poll(&mut host.node, &mut host.wire, &host.clock);
        host.clock.advance(-0.1e-3);
    }
    assert_eq!(modes.first(), Some(&Mode::Run), "within the grace");
    assert_eq!(
        modes.iter().filter(|mode| **mode == Mode::Hold).count(),
        2,
        "held for two periods: {modes:?}"
    );
    assert_eq!(modes.last(), Some(&Mode::Stop), "then stopped: {modes:?}");
    assert!(host.node.counters().missed >= 9, "{:?}", host.node.counters());
    let mut all = all.skip(11);
    host.clock.advance(-0.4e-3);
    let mut last = Mode::Stop;
    for pair in all.by_ref().take(SETTLED as usize + 1) {
        last = run(&mut host, pair).mode;
    }
    assert_eq!(last, Mode::Run, "sound ticks lead back");
    // Half a second of silence: there is nothing left to brake by.
    for _ in 0..700 {
        host.clock.advance(1e-3);
        poll(&mut host.node, &mut host.wire, &host.clock);
    }
    let applied = host.node.applied();
    assert_eq!((applied.mode, applied.brake, applied.torque), (Mode::Fault, true, [0.0; 5]), "given up");
    let (seq, tick) = all.next().expect("a tick");
    assert_eq!(run(&mut host, (seq, tick)).mode, Mode::Fault, "no tick leads back from there");
    host.done(Kind::Reset, seq + 1);
    let (_, tick) = all.next().expect("a tick");
    assert_eq!(run(&mut host, (seq + 2, tick)).mode, Mode::Run, "a reset does");
}

/// Runs ticks numbered one by one that come every so many periods; how many until one is found too old.
fn ticks_until_stale(periods: f64, most: usize) -> Option<usize> {
    let mut host = Host::<f64>::new(LawKind::Bfsmc, false, Pace::RealTime);
    ticks::<f64>(false).take(most).position(|(seq, tick)| {
        host.clock.advance(periods * 1e-3);
        let command = host.tick(seq, &tick).expect("an answer");
        command.findings.any_of(Findings::STALE)
    })
}

#[test]
fn a_delay_that_creeps_up_is_noticed_and_a_clock_that_drifts_is_not() {
    for periods in [1.45, 1.1, 1.01] {
        // The age that is allowed, two periods, adds up at the surplus of each, less the thousandth that is forgiven.
        let due = 2.0 / (periods - 1.001);
        let found = ticks_until_stale(periods, 1000).unwrap_or(usize::MAX) as f64;
        assert!((0.9 * due..1.2 * due + 2.0).contains(&found), "{periods} periods: after {found} ticks");
    }
    for periods in [0.999, 1.0005] {
        assert_eq!(ticks_until_stale(periods, 10_000), None, "{periods} periods");
    }
}

#[test]
fn what_cannot_be_done_is_refused_with_its_reason() {
    let mut host = Host::<f32>::new(LawKind::Bfsmc, false, Pace::Lockstep);
    let (_, single) = ticks::<f32>(false).next().expect("a tick");
    let (_, double) = ticks::<f64>(false).next().expect("a tick");
    let (_, measured) = ticks::<f32>(true).next().expect("a tick");
    assert_eq!(host.refused(&frame(Kind::Tick64, 1, &double)), Reason::Precision, "the other precision");
    assert_eq!(host.refused(&frame(Kind::Tick32, 1, &double)), Reason::Malformed, "too long");
    assert_eq!(host.refused(&frame(Kind::Tick32, 1, &[0_u8; 9])), Reason::Malformed, "too short");
    assert_eq!(host.refused(&frame(Kind::Ready, 1, &())), Reason::Unknown, "what only a target says");
    let mut buffer = [0; LONGEST_ON_WIRE];
    let header = Header { kind: Kind::Tick32, session: common::SESSION + 1, seq: 1 };
    let other = encode(header, &single, &mut buffer).expect("room").to_vec();
    assert_eq!(host.refused_in(common::SESSION + 1, &other), Reason::Session, "another session");
    // A measurement is not what this stack takes: the supervisor finds that the stack refuses it.
    let command = host.tick(1, &measured).expect("an answer");
    assert!(command.mode != Mode::Run && !command.findings.is_empty(), "{command:?}");
    host.done(Kind::Bye, 9);
    assert!(host.node.applied().brake, "the end");
    assert_eq!(host.refused(&frame(Kind::Tick32, 2, &single)), Reason::NotSetUp, "after the end");
}

#[test]
fn a_setup_that_does_not_work_says_why_and_one_that_comes_again_does_nothing() {
    let mut host = Host::<f64>::new(LawKind::Bfsmc, false, Pace::Lockstep);
    for (seq, tick) in ticks::<f64>(false).take(10) {
        host.tick(seq, &tick).expect("an answer");
    }
    let report: Report = host.body(Kind::Query, 0, Kind::Report);
    assert_eq!((report.last, report.mode), (Some(10), Some(Mode::Run)), "{report:?}");
    // The same session again: the answer had been lost.
    let setup = host.setup;
    host.exchange(&frame(Kind::Setup64, 0, &setup));
    let report: Report = host.body(Kind::Query, 0, Kind::Report);
    assert_eq!(report.last, Some(10), "nothing is set up anew");
    let mut wrong = setup;
    wrong.robot.wheel_radius = -1.0;
    let mut buffer = [0; LONGEST_ON_WIRE];
    let header = Header { kind: Kind::Setup64, session: common::SESSION + 1, seq: 0 };
    let bytes = encode(header, &wrong, &mut buffer).expect("room").to_vec();
    let answer = host.exchange(&bytes);
    let refusal: Refusal = common::body(&answer, Kind::Refused);
    assert_eq!(refusal.reason, Reason::Setup, "{refusal:?}");
    assert_eq!(refusal.text.as_str(), "wheel_radius_m must be above zero");
    assert!(host.node.applied().brake, "nothing runs then");
}

#[test]
fn a_setup_that_is_cut_at_every_place_is_none() {
    let host = Host::<f32>::new(LawKind::Bfsmc, false, Pace::Lockstep);
    let setup = frame(Kind::Setup32, 0, &host.setup);
    for cut in 0..setup.len() - 1 {
        let mut node = Node::new(common::IDENTITY);
        let mut wire = Wire::default();
        wire.input.extend(setup[..cut].iter().chain(&[0]));
        node.poll(&mut wire, &TestClock::default());
        assert!(wire.output.is_empty(), "cut at {cut}");
        wire.input.extend(&setup);
        node.poll(&mut wire, &TestClock::default());
        assert_eq!(common::header(&wire.output).kind, Kind::Done, "the next one is whole");
    }
}
