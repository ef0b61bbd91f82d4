//! The host's side of the link: asks, waits, asks again.

use std::io;
use std::time::{Duration, Instant};

use mm_link::{Header, Kind, LONGEST_ON_WIRE, Receiver, Refusal, encode};
use serde::{Serialize, de::DeserializeOwned};
use thiserror::Error;

use super::inject::{Fate, Injector};
use super::wire::Wire;

/// Why the link failed.
#[derive(Debug, Error)]
pub(super) enum LinkError {
    #[error("the wire failed")]
    Wire(#[source] io::Error),
    #[error("no answer to {what} in {attempts} attempts of {patience_ms} ms")]
    Silent { what: &'static str, attempts: u32, patience_ms: u128 },
    #[error("the target refused {what}: {reason}")]
    Refused { what: &'static str, reason: String },
    #[error("the target's answer to {what} cannot be read")]
    Malformed { what: &'static str },
}

/// Frames as this side saw them.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub(super) struct Frames {
    /// Requests and their repetitions.
    pub(super) sent: u64,
    /// Answers that were asked for.
    pub(super) received: u64,
    /// Times that no answer came.
    pub(super) lost: u64,
    /// Damaged frames, here.
    pub(super) corrupt: u64,
    /// Answers that came again, or late.
    pub(super) duplicated: u64,
    /// Requests sent again.
    pub(super) retried: u64,
}

/// The other end, as seen from here.
pub(super) struct Client {
    wire: Box<dyn Wire>,
    receiver: Receiver,
    session: u16,
    pub(super) patience: Duration,
    pub(super) attempts: u32,
    pub(super) frames: Frames,
    pub(super) injector: Option<Injector>,
    buffer: Vec<u8>,
    late: Vec<u8>,
}

impl Client {
    pub(super) fn new(wire: Box<dyn Wire>, session: u16, patience: Duration) -> Self {
        Self {
            wire,
            receiver: Receiver::new(),
            session,
            patience,
            attempts: 6,
            frames: Frames::default(),
            injector: None,
            buffer: vec![0; LONGEST_ON_WIRE],
            late: Vec::new(),
        }
    }

    /// Asks until an answer comes or patience ends. The number makes a repetition known as one.
    pub(super) fn ask<B: Serialize, A: DeserializeOwned>(
        &mut self,
        (kind, answer): (Kind, Kind),
        (what, seq): (&'static str, u32),
        body: &B,
    ) -> Result<A, LinkError> {
        let header = Header { kind, session: self.session, seq };
        let length = encode(header, body, &mut self.buffer).map_err(|_| LinkError::Malformed { what })?.len();
        for attempt in 0..self.attempts {
            self.frames.retried += u64::from(attempt > 0);
            self.send(length).map_err(LinkError::Wire)?;
            if let Some(body) = self.wait((answer, seq), what)? {
                self.frames.received += 1;
                return Ok(body);
            }
            self.frames.lost += 1;
        }
        Err(LinkError::Silent { what, attempts: self.attempts, patience_ms: self.patience.as_millis() })
    }

    fn send(&mut self, length: usize) -> io::Result<()> {
        self.frames.sent += 1;
        let bytes = self.buffer.get_mut(..length).unwrap_or_default();
        let Some(injector) = &mut self.injector else { return self.wire.send(bytes) };
        match injector.fate() {
            Fate::Sound => self.wire.send(bytes)?,
            Fate::Dropped => {}
            Fate::Corrupted => {
                let mut damaged = bytes.to_vec();
                injector.damage(&mut damaged);
                self.wire.send(&damaged)?;
            }
            Fate::Duplicated => {
                self.wire.send(bytes)?;
                self.wire.send(bytes)?;
            }
            Fate::Delayed => {
                self.late.extend_from_slice(bytes);
                return Ok(());
            }
        }
        // What was held back comes after what was sent later, sooner or later.
        if !self.late.is_empty() && injector.comes_now() {
            self.wire.send(&self.late)?;
            self.late.clear();
        }
        Ok(())
    }

    /// The answer of a number, if it comes in time.
    fn wait<A: DeserializeOwned>(
        &mut self,
        (kind, seq): (Kind, u32),
        what: &'static str,
    ) -> Result<Option<A>, LinkError> {
        let deadline = Instant::now() + self.patience;
        let mut bytes = [0; 512];
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            // Shorter waits make way for a signal to end the run.
            let count = self.wire.receive(&mut bytes, left.min(Duration::from_millis(100)).max(LEAST));
            let count = count.map_err(LinkError::Wire)?;
            for &byte in bytes.iter().take(count) {
                match self.receiver.feed(byte) {
                    None => {}
                    Some(Err(_)) => self.frames.corrupt += 1,
                    Some(Ok(frame)) if (frame.header.session, frame.header.seq) != (self.session, seq) => {
                        self.frames.duplicated += 1;
                    }
                    Some(Ok(frame)) if frame.header.kind == kind => {
                        if self.injector.as_mut().is_some_and(Injector::loses_answer) {
                            continue;
                        }
                        return frame.body().map(Some).map_err(|_| LinkError::Malformed { what });
                    }
                    Some(Ok(frame)) if frame.header.kind == Kind::Refused => {
                        let refusal: Refusal = frame.body().map_err(|_| LinkError::Malformed { what })?;
                        let reason = if refusal.text.is_empty() {
                            format!("{:?}", refusal.reason).to_lowercase()
                        } else {
                            refusal.text.as_str().to_owned()
                        };
                        return Err(LinkError::Refused { what, reason });
                    }
                    Some(Ok(_)) => self.frames.duplicated += 1,
                }
            }
        }
    }

    /// Ends whatever the wire held before: the next frame begins after a zero.
    pub(super) fn clear(&mut self) -> Result<(), LinkError> {
        self.wire.send(&[0]).map_err(LinkError::Wire)
    }
}

/// A wait of zero would mean one without end.
const LEAST: Duration = Duration::from_millis(1);
