//! The target's side of the link, for any machine: bytes and a clock come in as arguments.

mod engine;

use core::fmt::Write as _;

use heapless::{String, Vec};
use serde::Serialize;

use crate::frame::{Frame, Header, Kind, Receiver, encode};
use crate::{Counters, Ready, Reason, Refusal, Report, Scalar, Setup, Tick};
pub use engine::Applied;
use engine::{Engine, Order, Time};

/// A wire that bytes go over.
pub trait Port {
    /// A byte, if one has come.
    fn read(&mut self) -> Option<u8>;
    /// Sends bytes.
    fn write(&mut self, bytes: &[u8]);
}

/// A timer that runs evenly.
pub trait Clock {
    /// Ticks since any moment, modulo 2^24. Read at least once in 2^24 ticks, it can be taken for one that never starts anew.
    fn ticks(&self) -> u32;
}

/// Who a target says that it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity {
    /// Its name; what is beyond 32 bytes is not sent.
    pub target: &'static str,
    /// Ticks of its [`Clock`] in a second.
    pub ticks_per_second: u32,
    /// Ticks that a loop of 10,000 instructions takes.
    pub loop_ticks: u32,
}

/// Takes requests and answers them: a supervised stack at the end of a wire.
///
/// Damaged frames are dropped and counted: the host asks again. A request that was done already is answered with the answer that it
/// had, and nothing is updated twice; one that is older than that is refused. Whatever comes in, [`applied`](Self::applied) is
/// finite and within the robot's limits.
#[derive(Debug)]
pub struct Node {
    receiver: Receiver,
    core: Core,
}

/// The node without what the frame being read lies in.
#[derive(Debug)]
struct Core {
    identity: Identity,
    time: Time,
    session: u16,
    machine: Machine,
    /// The last answer to a tick or a reset, as it went over the wire.
    answer: Vec<u8, ANSWER>,
    counters: Counters,
}

/// The stack in either precision.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one of it, and it has to have room for the larger")]
enum Machine {
    None,
    Single(Engine<f32>),
    Double(Engine<f64>),
}

/// Bytes of the longest answer on the wire: a refusal.
const ANSWER: usize = 128;

impl Node {
    /// A node that has not been set up.
    #[must_use]
    pub const fn new(identity: Identity) -> Self {
        Self {
            receiver: Receiver::new(),
            core: Core {
                identity,
                time: Time::new(identity.ticks_per_second),
                session: 0,
                machine: Machine::None,
                answer: Vec::new(),
                counters: Counters { updates: 0, missed: 0, duplicates: 0, stale: 0, corrupt: 0, refused: 0 },
            },
        }
    }

    /// Takes the bytes that have come, answers the requests among them, and looks at the clock; to be called again and again.
    ///
    /// True if anything came.
    #[inline]
    pub fn poll(&mut self, port: &mut impl Port, clock: &impl Clock) -> bool {
        let Self { receiver, core } = self;
        core.time.see(clock);
        let mut came = false;
        while let Some(byte) = port.read() {
            came = true;
            match receiver.feed(byte) {
                None => {}
                Some(Ok(frame)) => core.answer(&frame, port, clock),
                Some(Err(_)) => core.counters.corrupt = core.counters.corrupt.saturating_add(1),
            }
        }
        core.keep_pace();
        came
    }

    /// What the actuators are to do until the next call of [`poll`](Self::poll): no torque and brakes on without a setup, a tick, or after the
    /// end of a session.
    #[must_use]
    pub fn applied(&self) -> Applied {
        match &self.core.machine {
            Machine::None => Applied::nothing(),
            Machine::Single(engine) => engine.applied(),
            Machine::Double(engine) => engine.applied(),
        }
    }

    /// Frames and updates up to now.
    #[must_use]
    pub const fn counters(&self) -> &Counters {
        &self.core.counters
    }
}

impl Core {
    fn answer(&mut self, frame: &Frame<'_>, port: &mut impl Port, clock: &impl Clock) {
        let Header { kind, session, .. } = frame.header;
        match kind {
            Kind::Hello => self.introduce(frame, port),
            Kind::Query => self.send(frame, Kind::Report, &self.report(), port),
            Kind::Setup32 => self.set_up(frame, Machine::Single, port),
            Kind::Setup64 => self.set_up(frame, Machine::Double, port),
            _ if matches!(self.machine, Machine::None) => self.refuse(frame, Reason::NotSetUp, port),
            _ if session != self.session => self.refuse(frame, Reason::Session, port),
            Kind::Tick32 | Kind::Tick64 | Kind::Reset => self.in_order(frame, port, clock),
            Kind::Bye => {
                self.machine = Machine::None;
                self.send(frame, Kind::Done, &(), port);
            }
            _ => self.refuse(frame, Reason::Unknown, port),
        }
    }

    /// Requests that may be done once only, and in their order.
    fn in_order(&mut self, frame: &Frame<'_>, port: &mut impl Port, clock: &impl Clock) {
        let seq = frame.header.seq;
        let order = match &self.machine {
            Machine::None => return,
            Machine::Single(engine) => engine.order(seq, frame.header.kind),
            Machine::Double(engine) => engine.order(seq, frame.header.kind),
        };
        match order {
            Order::Next(gap) => match frame.header.kind {
                Kind::Tick32 => self.tick::<f32>(frame, gap, port, clock),
                Kind::Tick64 => self.tick::<f64>(frame, gap, port, clock),
                _ => {
                    match &mut self.machine {
                        Machine::None => {}
                        Machine::Single(engine) => engine.reset(seq),
                        Machine::Double(engine) => engine.reset(seq),
                    }
                    self.keep(frame, Kind::Done, &(), port);
                }
            },
            Order::Again => {
                count(&mut self.counters.duplicates);
                port.write(&self.answer);
            }
            Order::Stale => {
                count(&mut self.counters.stale);
                self.refuse(frame, Reason::Stale, port);
            }
            Order::Gap => self.refuse(frame, Reason::Gap, port),
        }
    }

    #[inline(never)]
    fn tick<T: Hosted>(&mut self, frame: &Frame<'_>, gap: u32, port: &mut impl Port, clock: &impl Clock) {
        let Ok(tick) = frame.body::<Tick<T>>() else {
            return self.refuse(frame, Reason::Malformed, port);
        };
        let Some(engine) = T::engine(&mut self.machine) else {
            return self.refuse(frame, Reason::Precision, port);
        };
        let before = engine.missed();
        let command = engine.tick(frame.header.seq, gap, &tick, (&mut self.time, clock));
        self.counters.missed = self.counters.missed.saturating_add(engine.missed() - before);
        count(&mut self.counters.updates);
        self.keep(frame, T::COMMAND, &command, port);
    }

    #[inline(never)]
    fn set_up<T: Scalar>(&mut self, frame: &Frame<'_>, wrap: fn(Engine<T>) -> Machine, port: &mut impl Port) {
        let session = frame.header.session;
        if session == self.session && !matches!(self.machine, Machine::None) {
            // The answer was lost: nothing is set up a second time.
            count(&mut self.counters.duplicates);
            return self.send(frame, Kind::Done, &(), port);
        }
        let Ok(setup) = frame.body::<Setup<T>>() else {
            return self.refuse(frame, Reason::Malformed, port);
        };
        match setup.build() {
            Ok(stack) => {
                self.machine = wrap(Engine::new(stack, &setup, &self.time));
                self.session = session;
                self.answer.clear();
                self.send(frame, Kind::Done, &(), port);
            }
            Err(error) => {
                self.machine = Machine::None;
                let mut text = String::new();
                // What does not fit is left out.
                let _ = write!(text, "{error}");
                count(&mut self.counters.refused);
                self.send(frame, Kind::Refused, &Refusal { reason: Reason::Setup, text }, port);
            }
        }
    }

    #[inline(never)]
    fn introduce(&self, frame: &Frame<'_>, port: &mut impl Port) {
        let Identity { target, ticks_per_second, loop_ticks } = self.identity;
        let mut ready = Ready { target: String::new(), version: String::new(), ticks_per_second, loop_ticks };
        let _ = ready.target.write_str(target);
        let _ = ready.version.write_str(env!("CARGO_PKG_VERSION"));
        self.send(frame, Kind::Ready, &ready, port);
    }

    fn report(&self) -> Report {
        let (mode, last) = match &self.machine {
            Machine::None => (None, None),
            Machine::Single(engine) => (Some(engine.applied().mode), engine.last()),
            Machine::Double(engine) => (Some(engine.applied().mode), engine.last()),
        };
        Report { counters: self.counters, mode, last }
    }

    /// Periods that have gone by without a tick, where the target's clock counts.
    fn keep_pace(&mut self) {
        let missed = match &mut self.machine {
            Machine::None => 0,
            Machine::Single(engine) => engine.keep_pace(&self.time),
            Machine::Double(engine) => engine.keep_pace(&self.time),
        };
        self.counters.missed = self.counters.missed.saturating_add(missed);
    }

    fn refuse(&mut self, frame: &Frame<'_>, reason: Reason, port: &mut impl Port) {
        if reason != Reason::Stale {
            count(&mut self.counters.refused);
        }
        self.send(frame, Kind::Refused, &Refusal { reason, text: String::new() }, port);
    }

    /// Sends an answer.
    fn send<B: Serialize>(&self, frame: &Frame<'_>, kind: Kind, body: &B, port: &mut impl Port) {
        let mut buffer = [0; ANSWER];
        // No answer is longer than the buffer; one that were would be a lost one.
        if let Ok(bytes) = encode(Header { kind, ..frame.header }, body, &mut buffer) {
            port.write(bytes);
        }
    }

    /// Sends an answer and keeps it, for a request that may come again.
    fn keep<B: Serialize>(&mut self, frame: &Frame<'_>, kind: Kind, body: &B, port: &mut impl Port) {
        self.answer.clear();
        let _ = self.answer.resize(ANSWER, 0);
        let length = encode(Header { kind, ..frame.header }, body, &mut self.answer).map_or(0, |b| b.len());
        self.answer.truncate(length);
        port.write(&self.answer);
    }
}

fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

/// A precision and the engine that has it.
trait Hosted: Scalar {
    fn engine(machine: &mut Machine) -> Option<&mut Engine<Self>>;
}

impl Hosted for f32 {
    fn engine(machine: &mut Machine) -> Option<&mut Engine<Self>> {
        if let Machine::Single(engine) = machine { Some(engine) } else { None }
    }
}

impl Hosted for f64 {
    fn engine(machine: &mut Machine) -> Option<&mut Engine<Self>> {
        if let Machine::Double(engine) = machine { Some(engine) } else { None }
    }
}
