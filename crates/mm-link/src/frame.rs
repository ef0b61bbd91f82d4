//! Frames: header, body and check sum, made into bytes without a zero and ended by one.

use cobs::{CobsEncoder, DecodeResult, DecoderState};
use crc::{CRC_32_ISO_HDLC, Crc, Digest, Table};
use heapless::Vec;
use postcard::ser_flavors::Flavor;
use serde::{Serialize, de::DeserializeOwned};

/// Version of the protocol; a frame of another one is not read.
pub const VERSION: u8 = 1;

/// Bytes of the longest frame before it is made free of zeros: a setup.
pub const LONGEST: usize = if cfg!(feature = "double") { 1408 } else { 736 };

/// Bytes of the longest frame on the wire.
pub const LONGEST_ON_WIRE: usize = LONGEST + LONGEST / 254 + 2;

/// Bytes of the header.
const HEADER: usize = 8;

/// Bytes of the check sum.
const SUM: usize = 4;

/// The check sum of a frame, and of the stages' signals: CRC-32 of IEEE 802.3.
pub(crate) static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// What a frame is; those of a target have the highest bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
#[non_exhaustive]
pub enum Kind {
    /// Who is there? No body.
    Hello = 0x01,
    /// [`Setup<f32>`](crate::Setup).
    Setup32 = 0x02,
    /// [`Setup<f64>`](crate::Setup).
    Setup64 = 0x03,
    /// [`Tick<f32>`](crate::Tick).
    Tick32 = 0x04,
    /// [`Tick<f64>`](crate::Tick).
    Tick64 = 0x05,
    /// Start anew, from any mode. No body.
    Reset = 0x06,
    /// How is it going? No body.
    Query = 0x07,
    /// The end of a session. No body.
    Bye = 0x08,
    /// [`Ready`](crate::Ready), in answer to a hello.
    Ready = 0x81,
    /// Done, in answer to a setup, a reset or the end. No body.
    Done = 0x82,
    /// [`Command<f32>`](crate::Command).
    Command32 = 0x83,
    /// [`Command<f64>`](crate::Command).
    Command64 = 0x84,
    /// [`Refusal`](crate::Refusal).
    Refused = 0x85,
    /// [`Report`](crate::Report), in answer to a query.
    Report = 0x86,
}

impl Kind {
    const ALL: [Self; 14] = [
        Self::Hello,
        Self::Setup32,
        Self::Setup64,
        Self::Tick32,
        Self::Tick64,
        Self::Reset,
        Self::Query,
        Self::Bye,
        Self::Ready,
        Self::Done,
        Self::Command32,
        Self::Command64,
        Self::Refused,
        Self::Report,
    ];
}

/// What stands before every body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// What the body is.
    pub kind: Kind,
    /// The session, a number that the host chooses anew whenever it sets a target up.
    pub session: u16,
    /// Number of the request; an answer has that of what it answers.
    pub seq: u32,
}

impl Header {
    const fn bytes(self) -> [u8; HEADER] {
        let [a, b] = self.session.to_le_bytes();
        let [c, d, e, f] = self.seq.to_le_bytes();
        [VERSION, self.kind as u8, a, b, c, d, e, f]
    }
}

/// Why the bytes between two zeros are no frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Damage {
    /// Bytes are missing, or some are too many.
    Framing,
    /// The check sum is another one.
    Sum,
    /// Another version of the protocol, which the payload tells.
    Version(u8),
    /// A kind of frame that this version does not know.
    Kind(u8),
}

/// A frame whose check sum is right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Its header.
    pub header: Header,
    body: &'a [u8],
}

/// The body is not of the form that its header says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Malformed;

impl Frame<'_> {
    /// Reads the body, all of it.
    ///
    /// # Errors
    /// [`Malformed`], where bytes are missing, left over or no value of the type.
    #[inline(never)]
    pub fn body<B: DeserializeOwned>(&self) -> Result<B, Malformed> {
        match postcard::take_from_bytes(self.body) {
            Ok((body, [])) => Ok(body),
            _ => Err(Malformed),
        }
    }
}

/// Reads the bytes of a frame that are no longer those of the wire.
fn parse(bytes: &[u8]) -> Result<Frame<'_>, Damage> {
    let (payload, sum) = bytes.split_last_chunk::<SUM>().ok_or(Damage::Framing)?;
    if CRC.checksum(payload) != u32::from_le_bytes(*sum) {
        return Err(Damage::Sum);
    }
    let (&[version, kind, a, b, c, d, e, f], body) =
        payload.split_first_chunk::<HEADER>().ok_or(Damage::Framing)?;
    if version != VERSION {
        return Err(Damage::Version(version));
    }
    let known = Kind::ALL.into_iter().find(|known| *known as u8 == kind);
    let kind = known.ok_or(Damage::Kind(kind))?;
    let header = Header { kind, session: u16::from_le_bytes([a, b]), seq: u32::from_le_bytes([c, d, e, f]) };
    Ok(Frame { header, body })
}

/// There is no room for the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooLong;

/// Writes a frame as it goes over the wire, with the zero at its end; gives the part of `buffer` that it fills.
///
/// # Errors
/// [`TooLong`], where it does not fit into `buffer`.
pub fn encode<'a, B: Serialize>(
    header: Header,
    body: &B,
    buffer: &'a mut [u8],
) -> Result<&'a mut [u8], TooLong> {
    let wire = Wire { bytes: CobsEncoder::new(buffer), sum: CRC.digest() };
    let length = postcard::serialize_with_flavor(&(header.bytes(), body), wire).map_err(|_| TooLong)?;
    *buffer.get_mut(length).ok_or(TooLong)? = 0;
    buffer.get_mut(..=length).ok_or(TooLong)
}

/// What a serializer writes to: bytes without a zero, and their sum.
struct Wire<'a> {
    bytes: CobsEncoder<'a>,
    sum: Digest<'static, u32, Table<1>>,
}

impl Flavor for Wire<'_> {
    type Output = usize;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.sum.update(bytes);
        self.bytes.push(bytes).map_err(|_| postcard::Error::SerializeBufferFull)
    }

    fn finalize(mut self) -> postcard::Result<usize> {
        let sum = self.sum.finalize().to_le_bytes();
        self.bytes.push(&sum).map_err(|_| postcard::Error::SerializeBufferFull)?;
        Ok(self.bytes.finalize())
    }
}

/// Takes the bytes of a wire and finds the frames among them.
#[derive(Debug)]
pub struct Receiver<const N: usize = LONGEST> {
    state: DecoderState,
    bytes: Vec<u8, N>,
    /// Everything up to the next zero is lost.
    lost: bool,
    /// The bytes are those of a frame that was handed out.
    handed_out: bool,
}

impl<const N: usize> Default for Receiver<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Receiver<N> {
    /// A receiver that has heard nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self { state: DecoderState::Idle, bytes: Vec::new(), lost: false, handed_out: false }
    }

    /// Takes a byte; gives the frame, or the damage, that it ends.
    ///
    /// After damage the next zero begins anew, so that a lost or changed byte costs no more than the frames that it touches.
    pub fn feed(&mut self, byte: u8) -> Option<Result<Frame<'_>, Damage>> {
        if core::mem::take(&mut self.handed_out) {
            self.bytes.clear();
        }
        if self.lost {
            if byte != 0 {
                return None;
            }
            self.begin_anew();
            return Some(Err(Damage::Framing));
        }
        match self.state.feed(byte) {
            Ok(DecodeResult::NoData) => None,
            Ok(DecodeResult::DataContinue(value)) => {
                self.lost = self.bytes.push(value).is_err();
                None
            }
            Ok(DecodeResult::DataComplete) => {
                self.handed_out = true;
                Some(parse(&self.bytes))
            }
            Err(_) => {
                // Only a zero in the wrong place gets here.
                self.begin_anew();
                Some(Err(Damage::Framing))
            }
        }
    }

    fn begin_anew(&mut self) {
        self.state = DecoderState::Idle;
        self.bytes.clear();
        self.lost = false;
    }
}
