//! What is in a log, whole or torn: `mmsim log info`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use mcap::records::{Channel, Record};

use super::LogError;
use super::header::CHANGES;
use super::scan::{Scan, ScanError, scan};

/// One topic of a log.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TopicInfo {
    /// Type of its messages, `package/msg/Type`.
    pub message_type: String,
    /// Number of messages.
    pub messages: u64,
}

/// One attachment of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AttachmentInfo {
    /// Its name.
    pub name: String,
    /// Its media type.
    pub media_type: String,
    /// Its length, bytes.
    pub bytes: u64,
}

/// What a log holds.
#[derive(Debug, Clone, PartialEq)]
pub struct LogInfo {
    /// How the file was found.
    pub scan: Scan,
    /// Profile of the file, `ros2` for a log of this crate.
    pub profile: String,
    /// Topics by name.
    pub topics: BTreeMap<String, TopicInfo>,
    /// Messages without a channel, which nobody can read.
    pub orphans: u64,
    /// First and last time of a message, ns.
    pub span_ns: Option<(u64, u64)>,
    /// Attachments in the order of the file.
    pub attachments: Vec<AttachmentInfo>,
    /// Metadata records by name, the entries of those of one name together.
    pub metadata: BTreeMap<String, BTreeMap<String, String>>,
}

impl LogInfo {
    /// Reads the file `path` to its end.
    ///
    /// # Errors
    ///
    /// [`LogError::Read`] if it cannot be read or is no MCAP file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, LogError> {
        let path = path.as_ref();
        let refused = |source| LogError::Read { path: path.to_owned(), source };
        let file = File::open(path).map_err(|error| refused(error.into()))?;
        Self::of(BufReader::new(file)).map_err(refused)
    }

    /// Reads any source to its end.
    ///
    /// # Errors
    ///
    /// Those of the source, or that it is no MCAP file.
    pub fn of(mut source: impl Read) -> Result<Self, mcap::McapError> {
        let mut found = Contents::default();
        let scanned = scan(&mut source, &mut |record| {
            found.take(record);
            Ok(())
        });
        match scanned {
            Ok(scan) => Ok(found.into_info(scan)),
            Err(ScanError::Read(error) | ScanError::Taker(error)) => Err(error),
        }
    }

    /// Messages of all topics.
    #[must_use]
    pub fn messages(&self) -> u64 {
        self.topics.values().map(|topic| topic.messages).sum()
    }

    /// What was changed while the run went on, in the order of time.
    pub fn changes(&self) -> impl Iterator<Item = &str> {
        self.metadata.get(CHANGES).into_iter().flat_map(BTreeMap::values).map(String::as_str)
    }

    /// An entry of a metadata record.
    #[must_use]
    pub fn entry(&self, record: &str, key: &str) -> Option<&str> {
        Some(self.metadata.get(record)?.get(key)?.as_str())
    }
}

/// What has been found so far.
#[derive(Debug, Default)]
struct Contents {
    profile: String,
    types: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (Channel, u64)>,
    orphans: u64,
    span_ns: Option<(u64, u64)>,
    attachments: Vec<AttachmentInfo>,
    metadata: BTreeMap<String, BTreeMap<String, String>>,
}

impl Contents {
    fn take(&mut self, record: Record<'_>) {
        match record {
            Record::Message { header, .. } => {
                let Some((_, count)) = self.channels.get_mut(&header.channel_id) else {
                    self.orphans += 1;
                    return;
                };
                *count += 1;
                let time = header.log_time;
                let (first, last) = self.span_ns.unwrap_or((time, time));
                self.span_ns = Some((first.min(time), last.max(time)));
            }
            Record::Header(header) => self.profile = header.profile,
            Record::Schema { header, .. } => {
                self.types.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                self.channels.entry(channel.id).or_insert((channel, 0));
            }
            Record::Attachment { header, data, .. } => self.attachments.push(AttachmentInfo {
                name: header.name,
                media_type: header.media_type,
                bytes: u64::try_from(data.len()).unwrap_or(u64::MAX),
            }),
            Record::Metadata(record) => {
                // Changes come one record each.
                self.metadata.entry(record.name).or_default().extend(record.metadata);
            }
            _ => {}
        }
    }

    fn into_info(self, scan: Scan) -> LogInfo {
        let Self { profile, types, channels, orphans, span_ns, attachments, metadata } = self;
        let mut topics: BTreeMap<String, TopicInfo> = BTreeMap::new();
        for (channel, count) in channels.into_values() {
            let topic = topics.entry(channel.topic).or_default();
            topic.message_type = types.get(&channel.schema_id).cloned().unwrap_or_default();
            topic.messages += count;
        }
        LogInfo { scan, profile, topics, orphans, span_ns, attachments, metadata }
    }
}
