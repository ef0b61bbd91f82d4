//! Reads an MCAP file record by record from its start, whole or torn, in memory that does not grow with the file.

mod layout;

use std::borrow::Cow;
use std::io::{ErrorKind, Read};

use mcap::McapError;
use mcap::records::{ChunkHeader, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// Opcode and length that every record starts with.
const FRAME_BYTES: u64 = 9;
/// Most bytes that a chunk may unfold to: a length beyond is damage. Writers take chunks of 1 to 10 MiB.
const MAX_CHUNK_BYTES: u64 = 256 * 1024 * 1024;

/// How a file ends.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum End {
    /// As the format asks for, all checksums right.
    Whole,
    /// Somewhere before its end: its writer was killed, or the disk was full.
    Torn,
    /// In something that is no record, or with a wrong checksum, as the text says.
    Damaged(String),
}

/// A record that is there but cannot be trusted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Damage {
    /// Where it begins in the file, bytes.
    pub offset: u64,
    /// How long it is, bytes.
    pub bytes: u64,
    /// What is wrong with it.
    pub reason: String,
}

/// What was found on the way through a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scan {
    /// How it ends.
    pub end: End,
    /// Length of the file, bytes.
    pub bytes: u64,
    /// Bytes up to the end of the last complete record.
    pub complete_bytes: u64,
    /// Chunks that were read.
    pub chunks: u64,
    /// Records that were left out.
    pub damage: Vec<Damage>,
}

impl Scan {
    /// Whether it ends as it should and nothing in it is damaged.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.end == End::Whole && self.damage.is_empty()
    }

    /// Bytes after the last complete record.
    #[must_use]
    pub const fn torn_bytes(&self) -> u64 {
        self.bytes.saturating_sub(self.complete_bytes)
    }
}

/// Why a scan stopped.
#[derive(Debug)]
pub(super) enum ScanError {
    /// The source is no MCAP file, or cannot be read.
    Read(McapError),
    /// What takes the records refused one.
    Taker(McapError),
}

/// Reads `source` to its end and hands on its header, schemas, channels, messages, attachments and metadata; those of a chunk once
/// its checksum is known to be right.
pub(super) fn scan(
    source: &mut impl Read,
    take: &mut impl FnMut(Record<'_>) -> Result<(), McapError>,
) -> Result<Scan, ScanError> {
    let mut reader = LinearReader::new_with_options(
        LinearReaderOptions::default()
            .with_emit_chunks(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_record_length_limit(usize::try_from(MAX_CHUNK_BYTES).unwrap_or(usize::MAX)),
    );
    let magic = u64::try_from(mcap::MAGIC.len()).unwrap_or_default();
    let mut scan = Scan { end: End::Whole, bytes: 0, complete_bytes: magic, chunks: 0, damage: Vec::new() };
    let mut is_data = true;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let count = read_some(source, reader.insert(wanted)).map_err(ScanError::Read)?;
                scan.bytes += u64::try_from(count).unwrap_or_default();
                reader.notify_read(count);
            }
            Ok(LinearReadEvent::Record { opcode, data }) => {
                let length = FRAME_BYTES + u64::try_from(data.len()).unwrap_or_default();
                let offset = scan.complete_bytes;
                scan.complete_bytes += length;
                is_data &= opcode != op::DATA_END;
                if is_data {
                    scan.chunks += u64::from(opcode == op::CHUNK);
                    if let Some(reason) = record(opcode, data, take).map_err(ScanError::Taker)? {
                        scan.damage.push(Damage { offset, bytes: length, reason });
                    }
                }
            }
            Err(error)
                if scan.bytes < magic || scan.bytes == magic && matches!(error, McapError::BadMagic) =>
            {
                return Err(ScanError::Read(error));
            }
            Err(error) => {
                scan.end = match error {
                    McapError::UnexpectedEof => End::Torn,
                    other => End::Damaged(other.to_string()),
                };
                break;
            }
        }
    }
    scan.bytes += rest(source).map_err(ScanError::Read)?;
    if scan.end == End::Whole {
        // The closing magic is no record.
        scan.complete_bytes += magic;
        if scan.torn_bytes() > 0 {
            scan.end = End::Damaged("it goes on after its end".to_owned());
        }
    }
    Ok(scan)
}

fn read_some(source: &mut impl Read, buffer: &mut [u8]) -> Result<usize, McapError> {
    loop {
        match source.read(buffer) {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            other => return Ok(other?),
        }
    }
}

/// Bytes that nobody has read.
fn rest(source: &mut impl Read) -> Result<u64, McapError> {
    Ok(std::io::copy(source, &mut std::io::sink())?)
}

/// Hands on one record of the file, or those of a chunk; what is wrong with it otherwise.
fn record(
    opcode: u8,
    data: &[u8],
    take: &mut impl FnMut(Record<'_>) -> Result<(), McapError>,
) -> Result<Option<String>, McapError> {
    let parsed = match parsed(opcode, data) {
        Ok(Some(parsed)) => parsed,
        Ok(None) => return Ok(None),
        Err(reason) => return Ok(Some(reason)),
    };
    let Record::Chunk { header, data } = parsed else {
        return take(parsed).map(|()| None);
    };
    match unfolded(&header, &data) {
        Ok(records) => inside(&records, take),
        Err(reason) => Ok(Some(reason)),
    }
}

/// A record that somebody wants to know of.
fn parsed(opcode: u8, data: &[u8]) -> Result<Option<Record<'_>>, String> {
    match opcode {
        _ if !layout::fits(opcode, data) => {
            Err("a text, a list or an attachment that is longer than its record".to_owned())
        }
        op::HEADER | op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK | op::ATTACHMENT | op::METADATA => {
            mcap::parse_record(opcode, data).map(Some).map_err(|error| error.to_string())
        }
        _ => Ok(None),
    }
}

/// The records of a chunk, once its checksum is known to be right.
fn unfolded<'a>(header: &ChunkHeader, data: &'a [u8]) -> Result<Cow<'a, [u8]>, String> {
    let length = header.uncompressed_size;
    let size = usize::try_from(length).ok().filter(|_| length <= MAX_CHUNK_BYTES);
    let size = size.ok_or_else(|| format!("a chunk of {length} bytes"))?;
    let records = match header.compression.as_str() {
        "" => Cow::Borrowed(data),
        "zstd" => Cow::Owned(zstd::bulk::decompress(data, size).map_err(|error| error.to_string())?),
        other => return Err(format!("compressed with {other}, which is not read here")),
    };
    if records.len() != size {
        return Err(format!("a chunk of {} bytes instead of {size}", records.len()));
    }
    // Zero stands for a checksum that was not computed.
    let (saved, found) = (header.uncompressed_crc, crc32fast::hash(&records));
    if saved != 0 && saved != found {
        return Err(format!("the checksum of a chunk is {found:08x} instead of {saved:08x}"));
    }
    Ok(records)
}

/// Hands on the records of a chunk; what is wrong with them, if something is.
fn inside(
    mut records: &[u8],
    take: &mut impl FnMut(Record<'_>) -> Result<(), McapError>,
) -> Result<Option<String>, McapError> {
    while !records.is_empty() {
        let Some((opcode, data, rest)) = framed(records) else {
            return Ok(Some("a chunk that ends within a record".to_owned()));
        };
        match opcode {
            op::SCHEMA | op::CHANNEL | op::MESSAGE => match parsed(opcode, data) {
                Ok(Some(record)) => take(record)?,
                Ok(None) => {}
                Err(reason) => return Ok(Some(reason)),
            },
            _ => {}
        }
        records = rest;
    }
    Ok(None)
}

/// Opcode and data of the first record, and what follows it.
fn framed(records: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (&opcode, after) = records.split_first()?;
    let (length, after) = after.split_first_chunk()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let (data, rest) = after.split_at_checked(length)?;
    Some((opcode, data, rest))
}
