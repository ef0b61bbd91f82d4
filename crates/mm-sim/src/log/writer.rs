//! The writer: one call a sample, a file that survives the process.

use super::encoder::{Encoder, Message};
use super::error::LogError;
use super::header::{self, LogHeader, Outcome};
use super::sample::LogSample;
use super::schema;
use super::topics::PerTopic;
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Attachment, McapError, WriteOptions};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Uncompressed bytes after which a chunk is closed.
const CHUNK_BYTES: u64 = 1024 * 1024;
/// Level of zstd: the fastest but few, which the crate takes as an unsigned number. Beside 1 it makes files 3 % longer.
const COMPRESSION_LEVEL: i32 = -1;
/// Wall time after which what was written goes to the operating system. With the time until somebody looks again it stays below
/// the 100 ms that a killed run loses at most.
const FLUSH_PERIOD: Duration = Duration::from_millis(50);
/// Writes the log of one run.
///
/// After an error the file holds what had been written before it; every later call gives an error again. A writer
/// that is dropped without [`finish`](Self::finish) leaves a readable file without summary and outcome.
///
/// Cost: no allocation per sample once the buffers have grown, apart from the index that the file format needs.
pub struct LogWriter<W: Write = BufWriter<File>> {
    mcap: mcap::Writer<NoSeek<W>>,
    path: PathBuf,
    channels: PerTopic<u16>,
    encoder: Encoder,
    last_flush: Instant,
    is_flushed: bool,
    last_stamp_ns: u64,
    /// Number of changes that were written down.
    changes: u32,
}

impl<W: Write> std::fmt::Debug for LogWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { path, encoder, .. } = self;
        f.debug_struct("LogWriter")
            .field("path", path)
            .field("samples", &encoder.samples())
            .finish_non_exhaustive()
    }
}

impl LogWriter {
    /// Creates the file `path`, replacing what was there, and writes everything known before the run.
    ///
    /// # Errors
    ///
    /// [`LogError::Create`] if the file cannot be created, [`LogError::Busy`] if another writer has it, [`LogError::Write`] if it cannot be
    /// written to.
    pub fn create(path: impl AsRef<Path>, header: &LogHeader<'_>) -> Result<Self, LogError> {
        let path = path.as_ref();
        let failed = |source| LogError::Create { path: path.to_owned(), source };
        let file = OpenOptions::new().write(true).create(true).truncate(false).open(path).map_err(failed)?;
        // Another run that writes it would write into the middle of this one. A file system that knows no locks is no reason to refuse.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(LogError::Busy { path: path.to_owned() });
        }
        if file.metadata().is_ok_and(|it| it.is_file()) {
            file.set_len(0).map_err(failed)?;
        }
        Self::to_sink(BufWriter::with_capacity(64 * 1024, file), path, header)
    }

    /// The same on standard output.
    ///
    /// # Errors
    ///
    /// As [`create`](Self::create).
    pub fn to_stdout(header: &LogHeader<'_>) -> Result<Self, LogError> {
        let path = PathBuf::from("on standard output");
        let file = stdout_file().map_err(|source| LogError::Create { path: path.clone(), source })?;
        Self::to_sink(BufWriter::with_capacity(64 * 1024, file), path, header)
    }
}

impl<W: Write> LogWriter<W> {
    /// Writes a log to any sink, which never has to seek; `path` is what errors call it.
    ///
    /// # Errors
    ///
    /// [`LogError::Write`] if the sink refuses.
    pub fn to_sink(sink: W, path: impl AsRef<Path>, header: &LogHeader<'_>) -> Result<Self, LogError> {
        let path = path.as_ref().to_owned();
        let open = || -> Result<_, McapError> {
            let mut mcap = container(schema::PROFILE).create(NoSeek::new(sink))?;
            mcap.write_metadata(&header.metadata())?;
            attach(&mut mcap, 0, "scenario.toml", "application/toml", header.scenario_text)?;
            for (name, text) in header.files {
                let is_csv = Path::new(name).extension().is_some_and(|kind| kind.eq_ignore_ascii_case("csv"));
                attach(&mut mcap, 0, name, if is_csv { "text/csv" } else { "application/toml" }, text)?;
            }
            let channels = add_channels(&mut mcap)?;
            Ok((mcap, channels))
        };
        let (mcap, channels) = match open() {
            Ok(opened) => opened,
            Err(source) => return Err(LogError::Write { path, source }),
        };
        let mut writer = Self {
            mcap,
            path,
            channels,
            encoder: Encoder::new(header),
            last_flush: Instant::now(),
            is_flushed: true,
            last_stamp_ns: 0,
            changes: 0,
        };
        let preamble = writer.write_preamble(header);
        writer.named(preamble)?;
        Ok(writer)
    }

    /// Writes one instant of the run. Samples come in the order of time.
    ///
    /// # Errors
    ///
    /// [`LogError::Write`] if the file cannot be written to.
    pub fn write(&mut self, sample: &LogSample) -> Result<(), LogError> {
        let written = self.write_sample(sample);
        self.named(written)
    }

    /// Gives what was written to the operating system if it is time to, as every [`write`](Self::write) does: for a caller whose
    /// samples come slowly.
    ///
    /// # Errors
    ///
    /// [`LogError::Write`] if the file cannot be written to.
    pub fn flush_if_due(&mut self) -> Result<(), LogError> {
        let flushed = self.flush_in_time();
        self.named(flushed)
    }

    /// Writes down what somebody changed while the run goes on, so that a log without its end says it too.
    ///
    /// # Errors
    ///
    /// [`LogError::Write`] if the file cannot be written to.
    pub fn note_change(&mut self, change: &str) -> Result<(), LogError> {
        self.changes += 1;
        let written = self.mcap.write_metadata(&header::change(self.changes, change));
        self.is_flushed = false;
        self.named(written)
    }

    /// Ends the log of a run that reached its end: the summary as JSON and the digest of the run.
    ///
    /// # Errors
    ///
    /// [`LogError::Write`] if the file cannot be written to.
    pub fn finish(self, summary_json: &str, digest: &str) -> Result<(), LogError> {
        self.finish_as(Outcome::Finished, summary_json, digest)
    }

    /// Ends the log of a run that ended as `outcome` says.
    ///
    /// # Errors
    ///
    /// [`LogError::Write`] if the file cannot be written to.
    pub fn finish_as(mut self, outcome: Outcome, summary_json: &str, digest: &str) -> Result<(), LogError> {
        let finished = self.write_result(outcome, summary_json, digest);
        self.named(finished)?;
        let Self { mcap, path, .. } = self;
        let mut sink = mcap.into_inner().into_inner();
        sink.flush().map_err(|error| LogError::Write { path, source: McapError::Io(error) })
    }

    fn write_preamble(&mut self, header: &LogHeader<'_>) -> Result<(), McapError> {
        let Self { encoder, mcap, channels, .. } = self;
        encoder.preamble(header, |message| publish(mcap, channels, message))?;
        self.mcap.flush()
    }

    fn write_sample(&mut self, sample: &LogSample) -> Result<(), McapError> {
        let Self { encoder, mcap, channels, .. } = self;
        encoder.sample(sample, |message| publish(mcap, channels, message))?;
        self.last_stamp_ns = sample.stamp_ns();
        self.is_flushed = false;
        self.flush_in_time()
    }

    fn flush_in_time(&mut self) -> Result<(), McapError> {
        if !self.is_flushed && self.last_flush.elapsed() >= FLUSH_PERIOD {
            self.mcap.flush()?;
            self.last_flush = Instant::now();
            self.is_flushed = true;
        }
        Ok(())
    }

    fn write_result(&mut self, outcome: Outcome, summary_json: &str, digest: &str) -> Result<(), McapError> {
        let end_ns = self.last_stamp_ns;
        attach(&mut self.mcap, end_ns, "summary.json", "application/json", summary_json)?;
        self.mcap.write_metadata(&outcome.metadata(digest, self.encoder.samples(), end_ns))?;
        self.mcap.finish().map(drop)
    }

    fn named<T>(&self, result: Result<T, McapError>) -> Result<T, LogError> {
        result.map_err(|source| LogError::Write { path: self.path.clone(), source })
    }
}

/// How the files of this crate are written.
///
/// Chunks are built in memory and written whole: a direct writer goes back to fill in a chunk's size, and until then the file is
/// of no use to anybody.
pub(super) fn container(profile: &str) -> WriteOptions {
    WriteOptions::new()
        .profile(profile)
        .library(concat!("mmsim ", env!("CARGO_PKG_VERSION")))
        .chunk_size(Some(CHUNK_BYTES))
        .disable_seeking(true)
        .compression_level(COMPRESSION_LEVEL.cast_unsigned())
        .compression_threads(0)
}

/// Standard output without the buffer that ends a line.
fn stdout_file() -> std::io::Result<File> {
    #[cfg(unix)]
    let owned = std::os::fd::AsFd::as_fd(&std::io::stdout()).try_clone_to_owned();
    #[cfg(windows)]
    let owned = std::os::windows::io::AsHandle::as_handle(&std::io::stdout()).try_clone_to_owned();
    owned.map(File::from)
}

fn attach<W: Write>(
    mcap: &mut mcap::Writer<NoSeek<W>>,
    stamp_ns: u64,
    name: &str,
    media_type: &str,
    text: &str,
) -> Result<(), McapError> {
    mcap.attach(&Attachment {
        log_time: stamp_ns,
        create_time: stamp_ns,
        name: name.to_owned(),
        media_type: media_type.to_owned(),
        data: Cow::Borrowed(text.as_bytes()),
    })
}

fn add_channels<W: Write>(mcap: &mut mcap::Writer<NoSeek<W>>) -> Result<PerTopic<u16>, McapError> {
    PerTopic::try_make(|topic, schema| {
        let schema = mcap.add_schema(schema.name, schema::SCHEMA_ENCODING, schema.text.as_bytes())?;
        mcap.add_channel(schema, topic, schema::MESSAGE_ENCODING, &BTreeMap::new())
    })
}

fn publish<W: Write>(
    mcap: &mut mcap::Writer<NoSeek<W>>,
    channels: &PerTopic<u16>,
    Message { topic, sequence, stamp_ns, bytes }: Message<'_>,
) -> Result<(), McapError> {
    let channel_id = *channels.of(topic);
    let header = MessageHeader { channel_id, sequence, log_time: stamp_ns, publish_time: stamp_ns };
    mcap.write_to_known_channel(&header, bytes)
}
