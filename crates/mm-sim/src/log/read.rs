//! Reading a log back: what it says about its run, and the signals of `/control` column by column.
//!
//! A file whose end is missing, since its run was killed, is read as far as it goes, damaged parts are left out, and its warnings say so. Columns are
//! decoded by the message definition in the file, not by that of this version.

mod bytes;
mod columns;
mod error;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use mcap::McapError;
use mcap::records::{AttachmentHeader, Metadata, Record};
use serde_json::Value;

use bytes::Bytes;
pub use columns::Columns;
use columns::Layout;
pub use error::ReadError;

use super::header::CHANGES;
use super::scan::{End, Scan, ScanError, scan};

/// A log as read.
#[derive(Debug, Clone, Default)]
pub struct LogFile {
    /// The file as given.
    pub path: PathBuf,
    /// What identifies the run: version, scenario, controller, seed, and `version.NAME` of what else took part.
    pub run: BTreeMap<String, String>,
    /// How it ended: outcome, digest, samples, `end_ns`; none for a run that did not get there.
    pub result: Option<BTreeMap<String, String>>,
    /// The text of the scenario file, TOML, without edits of the command line.
    pub scenario_text: String,
    /// Texts of the files that the scenario names: file, text.
    pub files: Vec<(String, String)>,
    /// The summary; none for a run that did not get there.
    pub summary: Option<Value>,
    /// The robot as URDF.
    pub urdf: String,
    /// The desired path of the tip: time in seconds, x, y and z in metres.
    pub reference: Vec<[f64; 4]>,
    /// The signals.
    pub columns: Columns,
    /// What a reader should know of the file.
    pub warnings: Vec<String>,
}

/// What the records before said that those to come need.
#[derive(Default)]
struct Known {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Carried>,
    /// What was changed while the run went on.
    changes: Vec<String>,
}

/// What a channel of the file carries, as far as it is read here.
enum Carried {
    Robot,
    Reference,
    Control(Layout),
}

impl LogFile {
    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read, is no MCAP, or holds no samples of a run.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let file = File::open(path).map_err(|source| ReadError::Open { path: path.to_owned(), source })?;
        Self::of(path, BufReader::new(file))
    }

    /// Reads any source to its end; `path` is what errors and warnings call it.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub fn of(path: impl AsRef<Path>, mut source: impl Read) -> Result<Self, ReadError> {
        let path = path.as_ref().to_owned();
        let mut log = Self { path, ..Self::default() };
        let mut known = Known::default();
        let scanned = scan(&mut source, &mut |record| {
            log.take(&mut known, record);
            Ok(())
        });
        match scanned {
            Ok(scan) => log.warn(&scan),
            Err(ScanError::Read(McapError::Io(source))) => {
                return Err(ReadError::Open { path: log.path, source });
            }
            Err(ScanError::Read(_) | ScanError::Taker(_)) => return Err(ReadError::NoLog { path: log.path }),
        }
        if log.columns.is_empty() {
            return Err(ReadError::NoSamples { path: log.path });
        }
        if log.result.is_none() {
            // A run that got there says it in its summary.
            log.warnings.extend(known.changes.iter().map(|change| format!("changed by a viewer: {change}")));
            log.warnings.push("the run did not reach its end: there is no outcome, digest or summary".into());
        }
        Ok(log)
    }

    /// Something that identifies the run, empty if the file does not say it.
    #[must_use]
    pub fn says(&self, key: &str) -> &str {
        self.run.get(key).map_or("", String::as_str)
    }

    /// How the run ended, in a word: `unfinished` if the file does not say it.
    #[must_use]
    pub fn outcome(&self) -> &str {
        self.result.as_ref().and_then(|result| result.get("outcome")).map_or("unfinished", String::as_str)
    }

    /// Says what of the file could not be read.
    fn warn(&mut self, scan: &Scan) {
        match &scan.end {
            End::Whole => {}
            End::Torn => self.warnings.push("the file is torn and was read up to there".to_owned()),
            End::Damaged(reason) => {
                self.warnings.push(format!("the file is damaged and was read up to there: {reason}"));
            }
        }
        if let Some(first) = scan.damage.first() {
            let (count, at, reason) = (scan.damage.len(), first.offset, &first.reason);
            let text = format!(
                "damaged records of the file were left out: {count}, the first at byte {at}: {reason}"
            );
            self.warnings.push(text);
        }
    }

    fn take(&mut self, known: &mut Known, record: Record<'_>) {
        match record {
            Record::Schema { header, data } => {
                known.schemas.insert(header.id, String::from_utf8_lossy(&data).into_owned());
            }
            Record::Channel(channel) => {
                let schema = known.schemas.get(&channel.schema_id).map_or("", String::as_str);
                if let Some(carried) = Carried::by(&channel.topic, schema) {
                    known.channels.entry(channel.id).or_insert(carried);
                }
            }
            Record::Message { header, data } => {
                if let Some(carried) = known.channels.get(&header.channel_id) {
                    self.take_message(carried, &data);
                }
            }
            Record::Attachment { header, data, .. } => {
                self.take_attachment(header, &String::from_utf8_lossy(&data));
            }
            Record::Metadata(record) if record.name == CHANGES => {
                known.changes.extend(record.metadata.into_values());
            }
            Record::Metadata(record) => self.take_metadata(record),
            _ => {}
        }
    }

    fn take_message(&mut self, carried: &Carried, data: &[u8]) {
        match carried {
            Carried::Robot => self.urdf = Bytes::of(data).string().unwrap_or_default(),
            Carried::Reference => self.reference = path_points(data).unwrap_or_default(),
            Carried::Control(layout) => {
                if let Some(row) = layout.decode(data) {
                    self.columns.push(layout.names(), &row);
                }
            }
        }
    }

    /// The scenario comes first; files that it names may have any name, but no JSON is among them.
    fn take_attachment(&mut self, header: AttachmentHeader, text: &str) {
        match header.name.as_str() {
            "scenario.toml" if self.scenario_text.is_empty() => text.clone_into(&mut self.scenario_text),
            "summary.json" if header.media_type == "application/json" => {
                self.summary = serde_json::from_str(text).ok();
            }
            _ => self.files.push((header.name, text.to_owned())),
        }
    }

    fn take_metadata(&mut self, record: Metadata) {
        match record.name.as_str() {
            "mmsim" => self.run = record.metadata,
            "mmsim.result" => self.result = Some(record.metadata),
            _ => {}
        }
    }
}

impl Carried {
    fn by(topic: &str, schema: &str) -> Option<Self> {
        match topic {
            "/robot_description" => Some(Self::Robot),
            "/reference" => Some(Self::Reference),
            "/control" => Layout::of(schema).map(Self::Control),
            _ => None,
        }
    }
}

/// Times and positions of a `nav_msgs/msg/Path`; none if the message is shorter than it says.
fn path_points(data: &[u8]) -> Option<Vec<[f64; 4]>> {
    let mut bytes = Bytes::of(data);
    bytes.header()?;
    let count = bytes.u32()?;
    (0..count)
        .map(|_| {
            let t = bytes.header()?;
            let [x, y, z] = [bytes.f64()?, bytes.f64()?, bytes.f64()?];
            for _ in 0..4 {
                bytes.f64()?;
            }
            Some([t, x, y, z])
        })
        .collect()
}
