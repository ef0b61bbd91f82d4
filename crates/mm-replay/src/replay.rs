//! Computing a recording again.

use core::fmt;

use mm_control::{ControlStack, ControlState, Output};
use mm_link::{Setup, signals};
use xxhash_rust::xxh3::Xxh3;

use crate::format::{self, Entry, Head};
use crate::recording::update;
use crate::{Difference, Failure, Name, Signal, Word};

/// Where a recording is read from.
pub trait Source {
    /// Reads the next bytes, as many as there are and room for; 0 at the end.
    fn read(&mut self, buffer: &mut [u8]) -> usize;
}

/// A recording that was computed again with the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Replayed {
    /// Name of the run.
    pub name: Name,
    /// Name of the precision.
    pub precision: &'static str,
    /// Ticks compared.
    pub ticks: u32,
    /// XXH3-64 over the bits of all outputs, as computed here.
    pub digest: u64,
}

impl fmt::Display for Replayed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, precision, ticks, digest } = self;
        write!(f, "{name} {precision} ticks={ticks} digest={digest:016x}")
    }
}

/// Computes the next recording of a file again; none at its end.
///
/// # Errors
/// The first bit that differs, an input that the stack refuses, or what is wrong with the file.
pub fn replay(source: &mut impl Source) -> Result<Option<Replayed>, Failure> {
    let Some(head) = Head::read(source)? else { return Ok(None) };
    let replayed = match head.width {
        4 => precision::<f32>(&head, source),
        8 => precision::<f64>(&head, source),
        _ => Err(Failure::Format("numbers of an unknown width")),
    };
    replayed.map(Some)
}

/// The same for recordings of one precision: nothing of the other is linked.
///
/// # Errors
/// As [`replay`]; a recording of the other precision is one that is wrong.
pub fn replay_in<T: Word>(source: &mut impl Source) -> Result<Option<Replayed>, Failure> {
    match Head::read(source)? {
        None => Ok(None),
        Some(head) if head.width == T::BYTES => precision::<T>(&head, source).map(Some),
        Some(_) => Err(Failure::Format("a recording of the other precision")),
    }
}

#[inline(never)]
fn precision<T: Word>(head: &Head, source: &mut impl Source) -> Result<Replayed, Failure> {
    // Built in its place: a microcontroller has no room for many copies.
    let mut stack = None;
    build::<T>(head, source, &mut stack)?;
    let Some(stack) = &stack else { return Err(Failure::Format("no setup")) };
    let mut state = stack.initial_state();
    let mut digest = Xxh3::new();
    for _ in 0..head.ticks {
        tick(head, source, stack, &mut state, &mut digest)?;
    }
    Ok(Replayed { name: head.name, precision: T::NAME, ticks: head.ticks, digest: digest.digest() })
}

#[inline(never)]
fn tick<T: Word>(
    head: &Head,
    source: &mut impl Source,
    stack: &ControlStack<T, 3>,
    state: &mut ControlState<T, 3>,
    digest: &mut Xxh3,
) -> Result<(), Failure> {
    let entry = Entry::<T>::read(source, head.kind)?;
    let refused = |error| Failure::Refused { name: head.name, tick: entry.tick, error };
    let output = update(stack, state, &entry).map_err(refused)?;
    compare((head.name, entry.tick), &output, digest, source)
}

/// The stack of the recording; its setup is gone from memory when it is made.
#[inline(never)]
fn build<T: Word>(
    head: &Head,
    source: &mut impl Source,
    stack: &mut Option<ControlStack<T, 3>>,
) -> Result<(), Failure> {
    let mut setup = None;
    read::<T>(head, source, &mut setup)?;
    if let Some(setup) = &setup {
        make(setup, stack)?;
        delay(stack, setup.delay)?;
    }
    Ok(())
}

#[inline(never)]
fn make<T: Word>(setup: &Setup<T>, stack: &mut Option<ControlStack<T, 3>>) -> Result<(), Failure> {
    *stack = Some(setup.control_stack().map_err(Failure::Setup)?);
    Ok(())
}

#[inline(never)]
fn delay<T: Word>(stack: &mut Option<ControlStack<T, 3>>, delay: T) -> Result<(), Failure> {
    if let Some(prompt) = stack {
        *prompt = prompt.with_delay(delay).map_err(Failure::Setup)?;
    }
    Ok(())
}

#[inline(never)]
fn read<T: Word>(head: &Head, source: &mut impl Source, setup: &mut Option<Setup<T>>) -> Result<(), Failure> {
    let mut room = [0; format::LONGEST_SETUP];
    let length = usize::try_from(head.setup).unwrap_or(usize::MAX);
    let bytes = room.get_mut(..length).ok_or(Failure::Format("a setup that is too long"))?;
    format::take(source, bytes)?;
    *setup = Some(postcard::from_bytes(bytes).map_err(|_| Failure::Format("a setup that cannot be read"))?);
    Ok(())
}

/// Bytes of all that comes out of an update.
const LONGEST: usize = signals::COUNT * 8 + 4;

/// Compares an update with the recorded one, and adds it to the digest.
#[inline(never)]
fn compare<T: Word>(
    (name, tick): (Name, u32),
    output: &Output<T, 3>,
    digest: &mut Xxh3,
    source: &mut impl Source,
) -> Result<(), Failure> {
    let (mut here, mut recorded) = ([0; LONGEST], [0; LONGEST]);
    let width = usize::from(T::BYTES);
    let status = signals::outcomes(&output.status);
    for (bytes, value) in here.chunks_exact_mut(width).zip(signals::numbers(output)) {
        let bits = value.bits().to_le_bytes();
        bytes.iter_mut().zip(bits).for_each(|(to, from)| *to = from);
    }
    let numbers = signals::COUNT * width;
    if let Some(bytes) = here.get_mut(numbers..) {
        bytes.iter_mut().zip(status.to_le_bytes()).for_each(|(to, from)| *to = from);
    }
    let length = numbers + size_of_val(&status);
    let here = here.get(..length).unwrap_or_default();
    let recorded = recorded.get_mut(..length).unwrap_or_default();
    format::take(source, recorded)?;
    digest.update(here);
    if here == recorded {
        return Ok(());
    }
    let place = here.iter().zip(recorded.iter()).position(|(a, b)| a != b).unwrap_or_default() / width;
    let bits = |bytes: &[u8]| {
        let number = bytes.chunks(width).nth(place).unwrap_or_default();
        number.iter().rfold(0, |bits, byte| bits << 8 | u64::from(*byte))
    };
    let (here, recorded) = (bits(here), bits(recorded));
    let signal: Signal = signals::signal(place);
    Err(Failure::Differs(Difference { name, precision: T::NAME, tick, signal, here, recorded }))
}
