//! Makes a whole log of what a torn or damaged one still holds: `mmsim log recover`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use mcap::McapError;
use mcap::records::{Metadata, Record};
use mcap::write::NoSeek;

use super::LogError;
use super::scan::{Scan, ScanError, scan};
use super::writer::container;
use crate::whole;

/// Name of the record that says that a log was recovered.
pub const RECOVERED: &str = "mmsim.recovered";

/// What was recovered of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recovered {
    /// How the file was found.
    pub scan: Scan,
    /// Messages in the new file.
    pub messages: u64,
    /// Messages that could not be taken over: without a channel, or of one that is defined twice.
    pub left_out: u64,
    /// Time of the last message, ns.
    pub last_ns: u64,
}

impl Recovered {
    /// Whether everything that was complete in the file was taken over.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.scan.damage.is_empty()
            && self.left_out == 0
            && !matches!(self.scan.end, super::scan::End::Damaged(_))
    }
}

/// Writes what can be read of the log `from` to the file `to`, which appears as a whole or not at all.
///
/// # Errors
///
/// [`LogError::Read`] if `from` cannot be read or is no MCAP file, [`LogError::Empty`] if it holds no message, [`LogError::Create`] and
/// [`LogError::Write`] if `to` cannot be written.
pub fn recover(from: &Path, to: &Path) -> Result<Recovered, LogError> {
    let unreadable = |source| LogError::Read { path: from.to_owned(), source };
    let source = File::open(from).map_err(|error| unreadable(error.into()))?;
    let mut outcome = None;
    let written = whole::write(to, |out| {
        let copied = copy(&mut BufReader::new(source), out);
        let is_good = matches!(&copied, Ok(recovered) if recovered.messages > 0);
        outcome = Some(copied);
        if is_good { Ok(()) } else { Err(io::Error::other("nothing to write")) }
    });
    match (outcome, written) {
        (Some(Ok(recovered)), Ok(())) => Ok(recovered),
        (Some(Ok(recovered)), Err(_)) if recovered.messages == 0 => {
            Err(LogError::Empty { path: from.to_owned() })
        }
        (Some(Err(ScanError::Read(source))), _) => Err(unreadable(source)),
        (Some(Err(ScanError::Taker(source))), _) => Err(LogError::Write { path: to.to_owned(), source }),
        (_, Err(source)) => Err(LogError::Create { path: to.to_owned(), source }),
        (None, Ok(())) => Err(LogError::Empty { path: from.to_owned() }),
    }
}

/// The same from any source to any sink.
///
/// # Errors
///
/// Those of source and sink, or that the source is no MCAP file.
pub fn recover_stream(mut source: impl Read, sink: impl Write) -> Result<Recovered, McapError> {
    copy(&mut source, sink).map_err(|error| match error {
        ScanError::Read(error) | ScanError::Taker(error) => error,
    })
}

fn copy(source: &mut impl Read, sink: impl Write) -> Result<Recovered, ScanError> {
    let mut taker = Taker { sink: Some(sink), mcap: None, messages: 0, left_out: 0, last_ns: 0 };
    let scan = scan(source, &mut |record| taker.take(record))?;
    taker.finish(scan).map_err(ScanError::Taker)
}

/// Takes the records into the new file.
struct Taker<W: Write> {
    /// Until the header is there.
    sink: Option<W>,
    mcap: Option<mcap::Writer<NoSeek<W>>>,
    messages: u64,
    left_out: u64,
    last_ns: u64,
}

impl<W: Write> Taker<W> {
    fn take(&mut self, record: Record<'_>) -> Result<(), McapError> {
        if let Record::Header(header) = &record {
            if let Some(sink) = self.sink.take() {
                self.mcap = Some(container(&header.profile).create(NoSeek::new(sink))?);
            }
            return Ok(());
        }
        let Some(mcap) = &mut self.mcap else { return Ok(()) };
        let taken = match record {
            Record::Message { header, data } => {
                let written = mcap.write_to_known_channel(&header, &data);
                if written.is_ok() {
                    self.messages += 1;
                    self.last_ns = self.last_ns.max(header.log_time);
                }
                written
            }
            Record::Schema { header, data } => {
                mcap.add_schema_with_id(header.id, &header.name, &header.encoding, &data).map(drop)
            }
            Record::Channel(channel) => {
                let (id, schema) = (channel.id, channel.schema_id);
                mcap.add_channel_with_id(
                    id,
                    schema,
                    &channel.topic,
                    &channel.message_encoding,
                    &channel.metadata,
                )
                .map(drop)
            }
            Record::Attachment { header, data, .. } => mcap.attach(&mcap::Attachment {
                log_time: header.log_time,
                create_time: header.create_time,
                name: header.name,
                media_type: header.media_type,
                data,
            }),
            Record::Metadata(metadata) => mcap.write_metadata(&metadata),
            _ => Ok(()),
        };
        match taken {
            Err(
                McapError::UnknownChannel(..)
                | McapError::UnknownSchema(..)
                | McapError::InvalidSchemaId
                | McapError::ConflictingSchemas(_)
                | McapError::ConflictingChannels(_),
            ) => {
                self.left_out += 1;
                Ok(())
            }
            other => other,
        }
    }

    fn finish(self, scan: Scan) -> Result<Recovered, McapError> {
        let Self { mcap, messages, left_out, last_ns, .. } = self;
        if let Some(mut mcap) = mcap {
            let entries = [
                ("messages", messages),
                ("end_ns", last_ns),
                ("torn_bytes", scan.torn_bytes()),
                ("damaged_records", u64::try_from(scan.damage.len()).unwrap_or(u64::MAX)),
                ("left_out", left_out),
            ];
            let metadata: BTreeMap<String, String> =
                entries.map(|(key, value)| (key.to_owned(), value.to_string())).into();
            mcap.write_metadata(&Metadata { name: RECOVERED.to_owned(), metadata })?;
            mcap.finish()?;
        }
        Ok(Recovered { scan, messages, left_out, last_ns })
    }
}
