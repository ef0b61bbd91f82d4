//! How a recording is laid out.

use mm_control::{Measurement, Reference, WheelAngles};
use mm_model::{Configuration, Velocity};
use nalgebra::Vector3;

use crate::failure::{Failure, Name};
use crate::replay::Source;
use crate::{Full, Sink, Word};

/// Version of the layout.
pub const VERSION: u8 = 1;

const MAGIC: [u8; 8] = *b"mmreplay";

/// Bytes of a setup in f64, which are about 1,350, and some more.
pub(crate) const LONGEST_SETUP: usize = 1536;

/// What the controller sees at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seen<T> {
    /// Configuration and velocity, 11 numbers.
    State(Configuration<T, 3>, Velocity<T, 3>),
    /// What sensors read: 6 numbers, and 2 of the wheels where they have encoders.
    Measured(Measurement<T, 3>),
}

/// What enters an update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry<T> {
    /// Number of the tick in its run, from 0.
    pub tick: u32,
    /// What is seen.
    pub seen: Seen<T>,
    /// Where the tip should be.
    pub reference: Reference<T>,
}

/// What stands before the setup.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Head {
    /// Bytes of a number.
    pub width: u8,
    /// Kind of what is seen.
    pub(crate) kind: u8,
    /// Name of the run.
    pub name: Name,
    /// Bytes of the setup.
    pub(crate) setup: u32,
    /// Number of ticks.
    pub ticks: u32,
}

impl<T: Word> Seen<T> {
    /// Number of the kind in the head.
    pub(crate) const fn kind(&self) -> u8 {
        match self {
            Self::State(..) => 0,
            Self::Measured(Measurement { wheels: None, .. }) => 1,
            Self::Measured(_) => 2,
        }
    }
}

impl Head {
    pub(crate) fn write(&self, sink: &mut impl Sink) -> Result<(), Full> {
        sink.write(&MAGIC)?;
        sink.write(&[VERSION, self.width, self.kind, self.name.length()])?;
        sink.write(&self.setup.to_le_bytes())?;
        sink.write(&self.ticks.to_le_bytes())?;
        sink.write(self.name.as_bytes())
    }

    /// The next head; none at the end of the file.
    pub(crate) fn read(source: &mut impl Source) -> Result<Option<Self>, Failure> {
        let mut magic = [0; 8];
        match filled(source, &mut magic) {
            0 => return Ok(None),
            8 if magic == MAGIC => {}
            _ => return Err(Failure::Format("no recording")),
        }
        let [version, width, kind, length] = bytes(source)?;
        if version != VERSION {
            return Err(Failure::Format("a recording of another version"));
        }
        let setup = u32::from_le_bytes(bytes(source)?);
        let ticks = u32::from_le_bytes(bytes(source)?);
        let mut name = Name::blank(length);
        take(source, name.room())?;
        Ok(Some(Self { width, kind, name, setup, ticks }))
    }
}

impl<T: Word> Entry<T> {
    pub(crate) fn write(&self, sink: &mut impl Sink) -> Result<(), Full> {
        sink.write(&self.tick.to_le_bytes())?;
        match &self.seen {
            Seen::State(q, nu) => {
                configuration(sink, q)?;
                nu.channels().try_for_each(|value| number(sink, value))?;
            }
            Seen::Measured(Measurement { q, wheels }) => {
                configuration(sink, q)?;
                let wheels = wheels.iter().flat_map(|wheels| [wheels.right, wheels.left]);
                wheels.into_iter().try_for_each(|value| number(sink, value))?;
            }
        }
        let Reference { position, velocity, acceleration } = &self.reference;
        let parts = [position, velocity, acceleration];
        parts.into_iter().flat_map(|v| [v.x, v.y, v.z]).try_for_each(|value| number(sink, value))
    }

    pub(crate) fn read(source: &mut impl Source, kind: u8) -> Result<Self, Failure> {
        let tick = u32::from_le_bytes(bytes(source)?);
        let mut next = || read_number::<T>(source);
        let (x, y, heading) = (next()?, next()?, next()?);
        let q = Configuration { x, y, heading, joints: [next()?, next()?, next()?] };
        let seen = match kind {
            0 => {
                let (forward, yaw_rate) = (next()?, next()?);
                Seen::State(q, Velocity { forward, yaw_rate, joints: [next()?, next()?, next()?] })
            }
            1 => Seen::Measured(Measurement { q, wheels: None }),
            2 => {
                let (right, left) = (next()?, next()?);
                Seen::Measured(Measurement { q, wheels: Some(WheelAngles { right, left }) })
            }
            _ => return Err(Failure::Format("inputs of an unknown kind")),
        };
        let mut vector = || Ok::<_, Failure>(Vector3::new(next()?, next()?, next()?));
        let (position, velocity) = (vector()?, vector()?);
        Ok(Self { tick, seen, reference: Reference { position, velocity, acceleration: vector()? } })
    }
}

fn configuration<T: Word>(sink: &mut impl Sink, q: &Configuration<T, 3>) -> Result<(), Full> {
    [q.x, q.y, q.heading].into_iter().chain(q.joints).try_for_each(|value| number(sink, value))
}

/// Writes a number.
pub(crate) fn number<T: Word>(sink: &mut impl Sink, value: T) -> Result<(), Full> {
    let bytes = value.bits().to_le_bytes();
    bytes.get(..usize::from(T::BYTES)).map_or(Ok(()), |bytes| sink.write(bytes))
}

/// Reads a number.
pub(crate) fn read_number<T: Word>(source: &mut impl Source) -> Result<T, Failure> {
    let mut bits = [0; 8];
    if let Some(room) = bits.get_mut(..usize::from(T::BYTES)) {
        take(source, room)?;
    }
    Ok(T::of_bits(u64::from_le_bytes(bits)))
}

/// Reads a fixed number of bytes.
pub(crate) fn bytes<const N: usize>(source: &mut impl Source) -> Result<[u8; N], Failure> {
    let mut bytes = [0; N];
    take(source, &mut bytes)?;
    Ok(bytes)
}

/// Fills a buffer, or fails.
pub(crate) fn take(source: &mut impl Source, buffer: &mut [u8]) -> Result<(), Failure> {
    if filled(source, buffer) == buffer.len() { Ok(()) } else { Err(Failure::Format("a recording cut off")) }
}

/// Fills a buffer as far as possible.
fn filled(source: &mut impl Source, buffer: &mut [u8]) -> usize {
    let mut count = 0;
    while let Some(rest) = buffer.get_mut(count..)
        && !rest.is_empty()
    {
        match source.read(rest) {
            0 => break,
            read => count += read,
        }
    }
    count
}
