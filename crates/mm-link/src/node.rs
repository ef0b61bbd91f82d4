//! The target's side of the link, for any machine: bytes and a clock come in as arguments.

mod engine;

use core::fmt::Write as _;

use heapless::{String, Vec};
use mm_control::{SetupError, SupervisedStack};
use serde::Serialize;

use crate::frame::{Frame, Header, Kind, Receiver, encode};
use crate::{Counters, Ready, Reason, Refusal, Report, Scalar, Setup, Tick};
pub use engine::Applied;
use engine::{Driven, Engine, Order, Time};

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
    #[cfg(feature = "double")]
    Double(Engine<f64>),
}

impl Machine {
    fn engine(&self) -> Option<&dyn Driven> {
        match self {
            Self::None => None,
            Self::Single(engine) => Some(engine),
            #[cfg(feature = "double")]
            Self::Double(engine) => Some(engine),
        }
    }

    fn engine_mut(&mut self) -> Option<&mut dyn Driven> {
        match self {
            Self::None => None,
            Self::Single(engine) => Some(engine),
            #[cfg(feature = "double")]
            Self::Double(engine) => Some(engine),
        }
    }
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
        self.core.machine.engine().map_or_else(Applied::nothing, Driven::applied)
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
            Kind::Setup32 => self.set_up::<f32>(frame, port),
            #[cfg(feature = "double")]
            Kind::Setup64 => self.set_up::<f64>(frame, port),
            #[cfg(not(feature = "double"))]
            Kind::Setup64 => self.refuse(frame, Reason::Precision, port),
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
        let Some(engine) = self.machine.engine_mut() else { return };
        match engine.order(seq, frame.header.kind) {
            Order::Next(gap) => match frame.header.kind {
                Kind::Tick32 => self.tick::<f32>(frame, gap, port, clock),
                #[cfg(feature = "double")]
                Kind::Tick64 => self.tick::<f64>(frame, gap, port, clock),
                #[cfg(not(feature = "double"))]
                Kind::Tick64 => self.refuse(frame, Reason::Precision, port),
                _ => {
                    engine.reset(seq, &self.time);
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
        let command = engine.tick(frame.header.seq, gap, &tick, (&self.time, clock));
        self.counters.missed = self.counters.missed.saturating_add(engine.missed() - before);
        count(&mut self.counters.updates);
        self.keep(frame, T::COMMAND, &command, port);
    }

    fn set_up<T: Hosted>(&mut self, frame: &Frame<'_>, port: &mut impl Port) {
        let session = frame.header.session;
        if session == self.session && !matches!(self.machine, Machine::None) {
            // The answer was lost: nothing is set up a second time.
            count(&mut self.counters.duplicates);
            return self.send(frame, Kind::Done, &(), port);
        }
        self.machine = Machine::None;
        match install::<T>(&mut self.machine, frame, &self.time) {
            Ok(()) => {
                self.session = session;
                self.answer.clear();
                self.send(frame, Kind::Done, &(), port);
            }
            Err(Some(error)) => {
                let mut text = String::new();
                // What does not fit is left out.
                let _ = write!(text, "{error}");
                count(&mut self.counters.refused);
                self.send(frame, Kind::Refused, &Refusal { reason: Reason::Setup, text }, port);
            }
            Err(None) => self.refuse(frame, Reason::Malformed, port),
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
        let engine = self.machine.engine();
        let mode = engine.map(|engine| engine.applied().mode);
        Report { counters: self.counters, mode, last: engine.and_then(Driven::last) }
    }

    /// Periods that have gone by without a tick, where the target's clock counts.
    fn keep_pace(&mut self) {
        let missed = self.machine.engine_mut().map_or(0, |engine| engine.keep_pace(&self.time));
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

/// Reads a setup and puts its engine into the machine. What there is on the stack meanwhile is all gone afterwards: the
/// stack is deepest here.
#[inline(never)]
fn install<T: Hosted>(
    machine: &mut Machine,
    frame: &Frame<'_>,
    time: &Time,
) -> Result<(), Option<SetupError>> {
    let setup = frame.body::<Setup<T>>().map_err(|_| None)?;
    let stack = setup.build()?;
    T::start(machine, &stack, &setup, time);
    Ok(())
}

/// A precision and the engine that has it.
trait Hosted: Scalar {
    fn engine(machine: &mut Machine) -> Option<&mut Engine<Self>>;
    fn start(machine: &mut Machine, stack: &SupervisedStack<Self, 3>, setup: &Setup<Self>, time: &Time);
}

impl Hosted for f32 {
    fn engine(machine: &mut Machine) -> Option<&mut Engine<Self>> {
        if let Machine::Single(engine) = machine { Some(engine) } else { None }
    }

    #[inline(never)]
    fn start(machine: &mut Machine, stack: &SupervisedStack<Self, 3>, setup: &Setup<Self>, time: &Time) {
        *machine = Machine::Single(Engine::new(stack, setup, time));
    }
}

#[cfg(feature = "double")]
impl Hosted for f64 {
    fn engine(machine: &mut Machine) -> Option<&mut Engine<Self>> {
        if let Machine::Double(engine) = machine { Some(engine) } else { None }
    }

    #[inline(never)]
    fn start(machine: &mut Machine, stack: &SupervisedStack<Self, 3>, setup: &Setup<Self>, time: &Time) {
        *machine = Machine::Double(Engine::new(stack, setup, time));
    }
}
