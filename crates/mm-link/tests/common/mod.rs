//! A host for a node in the same process, and a stack to compare with.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clocks and random numbers are cut to their width"
)]

use std::cell::Cell;
use std::collections::VecDeque;

use mm_control::{
    Estimator, Input, LawKind, Measurement, Reference, SupervisedStack, SupervisedState, WheelAngles,
};
use mm_link::{
    Clock, Command, Header, Identity, Kind, LONGEST_ON_WIRE, Node, Pace, Port, Reason, Receiver, Refusal,
    Scalar, Seen, Setup, Stages, Tick, encode,
};
use mm_model::{Configuration, Mechanism, RobotParams, Velocity};
use nalgebra::Vector3;
use serde::{Serialize, de::DeserializeOwned};

/// The session of all frames here.
pub(crate) const SESSION: u16 = 7;
/// Sound ticks after which a stopped stack runs again.
pub(crate) const SETTLED: u32 = 10;
/// Who the node says it is: a clock of 1 MHz.
pub(crate) const IDENTITY: Identity =
    Identity { target: "test", ticks_per_second: 1_000_000, loop_ticks: 10_000 };

/// Bytes in both directions.
#[derive(Debug, Default)]
pub(crate) struct Wire {
    /// To the node.
    pub(crate) input: VecDeque<u8>,
    /// From it.
    pub(crate) output: Vec<u8>,
}

impl Port for Wire {
    fn read(&mut self) -> Option<u8> {
        self.input.pop_front()
    }
    fn write(&mut self, bytes: &[u8]) {
        self.output.extend_from_slice(bytes);
    }
}

/// A clock that goes when it is told to.
#[derive(Debug, Default)]
pub(crate) struct TestClock(Cell<i64>);

impl TestClock {
    /// Lets a time pass, in s.
    pub(crate) fn advance(&self, time: f64) {
        self.0.set(self.0.get() + (time * 1e6).round() as i64);
    }
}

impl Clock for TestClock {
    fn ticks(&self) -> u32 {
        self.0.get() as u32 & 0x00ff_ffff
    }
}

/// SplitMix64.
#[derive(Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// A number below another.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        (self.bits() % end.max(1) as u64) as usize
    }
    /// Any byte.
    pub(crate) fn byte(&mut self) -> u8 {
        self.bits() as u8
    }
}

/// A frame of the session as it goes over the wire.
pub(crate) fn frame<B: Serialize>(kind: Kind, seq: u32, body: &B) -> Vec<u8> {
    let mut buffer = [0; LONGEST_ON_WIRE];
    encode(Header { kind, session: SESSION, seq }, body, &mut buffer).unwrap().to_vec()
}

/// All frames among some bytes, each handed to `see`.
pub(crate) fn each(bytes: &[u8], mut see: impl FnMut(&mm_link::Frame<'_>)) {
    let mut receiver: Receiver = Receiver::new();
    for &byte in bytes {
        if let Some(frame) = receiver.feed(byte) {
            see(&frame.unwrap());
        }
    }
}

/// The header of the only frame among some bytes.
pub(crate) fn header(bytes: &[u8]) -> Header {
    let mut all = Vec::new();
    each(bytes, |frame| all.push(frame.header));
    assert_eq!(all.len(), 1, "{all:?}");
    all[0]
}

/// The body of the only frame among some bytes.
pub(crate) fn body<B: DeserializeOwned>(bytes: &[u8], kind: Kind) -> B {
    let mut found = None;
    each(bytes, |frame| {
        assert_eq!(frame.header.kind, kind, "{:?}", frame.header);
        found = Some(frame.body::<B>().unwrap());
    });
    found.unwrap()
}

/// Ticks of a gentle motion, numbered from 1: those that a loop closed here sees, so that no torque is out of place.
pub(crate) fn ticks<T: Scalar>(measured: bool) -> impl Iterator<Item = (u32, Tick<T>)> {
    let setup = Setup::for_robot(RobotParams::<f64, 3>::thesis(), LawKind::Bfsmc, PERIOD).unwrap();
    let stack = *setup.build().unwrap().stack();
    let robot = *stack.robot();
    let mut state = stack.initial_state();
    let mut q = Configuration { joints: setup.robot.rest_posture, ..Configuration::zero() };
    let mut nu = Velocity::<f64, 3>::zero();
    let mut wheels = WheelAngles { right: 0.0, left: 0.0 };
    let start = robot.tip_position(&q);
    (1_u32..).map(move |seq| {
        // A circle of 0.1 m, at a speed that rises from rest.
        let (radius, rate, t) = (0.1, 0.5, f64::from(seq) * PERIOD);
        let (angle, speed) = (rate * t * t / (1.0 + t), rate * (t * t + 2.0 * t) / ((1.0 + t) * (1.0 + t)));
        let (sin, cos) = mm_model::Real::sin_cos(angle);
        let reference = Reference {
            position: start + Vector3::new(radius * sin, radius * (1.0 - cos), 0.0),
            velocity: Vector3::new(cos, sin, 0.0) * (radius * speed),
            acceleration: Vector3::zeros(),
        };
        let tick = in_precision::<T>(&q, &nu, measured.then_some(&wheels), &reference);
        let torque = stack.update(&mut state, &Input { q, nu, reference }).unwrap().torque;
        let inertia = robot.inertia(&robot.posture(&q.joints));
        let rates = robot.acceleration(&inertia, &nu, &robot.force_of(&torque));
        nu = nu.plus(rates.scaled(PERIOD));
        let (sin, cos) = mm_model::Real::sin_cos(q.heading);
        q.x += nu.forward * cos * PERIOD;
        q.y += nu.forward * sin * PERIOD;
        q.heading += nu.yaw_rate * PERIOD;
        for (joint, rate) in q.joints.iter_mut().zip(nu.joints) {
            *joint += rate * PERIOD;
        }
        let turned = robot.wheel_rates(nu.forward, nu.yaw_rate);
        wheels.right += turned.right * PERIOD;
        wheels.left += turned.left * PERIOD;
        (seq, tick)
    })
}

/// Time between two ticks, s.
const PERIOD: f64 = 1e-3;

fn in_precision<T: Scalar>(
    q: &Configuration<f64, 3>,
    nu: &Velocity<f64, 3>,
    wheels: Option<&WheelAngles<f64>>,
    reference: &Reference<f64>,
) -> Tick<T> {
    let n = |x: f64| T::from_f64(x);
    let q = Configuration { x: n(q.x), y: n(q.y), heading: n(q.heading), joints: q.joints.map(n) };
    let nu = Velocity { forward: n(nu.forward), yaw_rate: n(nu.yaw_rate), joints: nu.joints.map(n) };
    let seen = wheels.map_or(Seen::State { q, nu }, |wheels| {
        let wheels = WheelAngles { right: n(wheels.right), left: n(wheels.left) };
        Seen::Measured(Measurement { q, wheels: Some(wheels) })
    });
    let reference = Reference {
        position: reference.position.map(n),
        velocity: reference.velocity.map(n),
        acceleration: reference.acceleration.map(n),
    };
    Tick { timing: mm_control::supervisor::Timing::exact(n(PERIOD)), seen, reference }
}

/// A node and who talks to it.
pub(crate) struct Host<T: Scalar> {
    /// The node.
    pub(crate) node: Node,
    /// The wire between.
    pub(crate) wire: Wire,
    /// The node's clock.
    pub(crate) clock: TestClock,
    /// What the node was set up with.
    pub(crate) setup: Setup<T>,
}

impl<T: Scalar> Host<T> {
    /// A node that has been set up.
    pub(crate) fn new(law: LawKind, measured: bool, pace: Pace) -> Self {
        let mut setup = Setup::for_robot(RobotParams::<T, 3>::thesis(), law, T::from_f64(1e-3)).unwrap();
        setup.pace = pace;
        if measured {
            setup.stack.estimator = Estimator::FilteredDifference { cutoff_hz: T::from_f64(60.0) };
        }
        let mut host =
            Self { node: Node::new(IDENTITY), wire: Wire::default(), clock: TestClock::default(), setup };
        let answer = host.exchange(&frame(T::SETUP, 0, &setup));
        assert_eq!(header(&answer).kind, Kind::Done, "set up");
        host
    }

    /// The stack here.
    pub(crate) fn twin(&self) -> Twin<T> {
        let stack = self.setup.build().unwrap();
        Twin { state: stack.initial_state(), stack, period: self.setup.stack.period }
    }

    /// Sends bytes and takes what comes back.
    pub(crate) fn exchange(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.wire.output.clear();
        self.wire.input.extend(bytes);
        self.node.poll(&mut self.wire, &self.clock);
        core::mem::take(&mut self.wire.output)
    }

    /// The command in an answer.
    pub(crate) fn command(answer: &[u8], seq: u32) -> Option<Command<T>> {
        let found = header(answer);
        (found == Header { kind: T::COMMAND, session: SESSION, seq }).then(|| body(answer, T::COMMAND))
    }

    /// A tick and its answer.
    pub(crate) fn tick(&mut self, seq: u32, tick: &Tick<T>) -> Option<Command<T>> {
        let answer = self.exchange(&frame(T::TICK, seq, tick));
        Self::command(&answer, seq)
    }

    /// The commands that the node has sent, with their headers; other answers are left out.
    pub(crate) fn commands(&mut self) -> Vec<(Header, Command<T>)> {
        let mut all = Vec::new();
        each(&core::mem::take(&mut self.wire.output), |frame| {
            if frame.header.kind == T::COMMAND {
                all.push((frame.header, frame.body().unwrap()));
            }
        });
        all
    }

    /// Why a request is refused.
    pub(crate) fn refused(&mut self, bytes: &[u8]) -> Reason {
        self.refused_in(SESSION, bytes)
    }

    /// Why a request of a session is refused.
    pub(crate) fn refused_in(&mut self, session: u16, bytes: &[u8]) -> Reason {
        let answer = self.exchange(bytes);
        assert_eq!(header(&answer).session, session, "the session of the request");
        body::<Refusal>(&answer, Kind::Refused).reason
    }

    /// A request without a body, which is done.
    pub(crate) fn done(&mut self, kind: Kind, seq: u32) {
        let answer = self.exchange(&frame(kind, seq, &()));
        let expected = if kind == Kind::Query { Kind::Report } else { Kind::Done };
        assert_eq!(header(&answer), Header { kind: expected, session: SESSION, seq }, "{kind:?}");
    }

    /// The body of the answer to a request without one.
    pub(crate) fn body<B: DeserializeOwned>(&mut self, kind: Kind, seq: u32, answer: Kind) -> B {
        let bytes = self.exchange(&frame(kind, seq, &()));
        body(&bytes, answer)
    }
}

/// The same stack, called directly.
pub(crate) struct Twin<T: Scalar> {
    stack: SupervisedStack<T, 3>,
    state: SupervisedState<T, 3>,
    period: T,
}

impl<T: Scalar> Twin<T> {
    /// Sees the same tick, `gap` after the last one, and gives the same command.
    #[track_caller]
    pub(crate) fn agrees(&mut self, gap: u32, tick: &Tick<T>, there: &Command<T>) {
        for _ in 1..gap {
            self.stack.missed(&mut self.state, self.period);
        }
        let here = match &tick.seen {
            Seen::State { q, nu } => {
                let input = Input { q: *q, nu: *nu, reference: tick.reference };
                self.stack.update(&mut self.state, tick.timing, &input)
            }
            Seen::Measured(measurement) => {
                self.stack.update_measured(&mut self.state, tick.timing, measurement, &tick.reference)
            }
        };
        let stages = here.output.as_ref().map_or_else(Stages::default, Stages::of);
        assert_eq!(there.stages.first_difference(&stages), None, "stages");
        let expected = Command {
            torque: here.torque,
            mode: here.mode,
            findings: here.findings,
            brake: here.brake,
            stages,
            cost: there.cost,
        };
        assert_eq!(there, &expected, "the command");
    }
}
