//! The writer: one call a sample, a file that survives the process.

use super::arrows::Arrows;
use super::cdr::Cdr;
use super::error::LogError;
use super::frames::{JOINTS, Joint, joints, transforms};
use super::header::{LogHeader, Outcome};
use super::sample::{LogSample, stamp_ns};
use super::topics::TOPICS;
use super::trail::Trail;
use super::urdf::urdf;
use super::{messages, schema};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Attachment, McapError, WriteOptions};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
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
/// Simulated time between two messages on `/path`.
const PATH_PERIOD_NS: u64 = 500_000_000;
/// Most points of `/reference`.
const MAX_REFERENCE_POINTS: usize = 2_000;

/// Channel numbers of the file.
#[derive(Debug, Clone, Copy)]
struct Channels {
    robot_description: u16,
    reference: u16,
    tf: u16,
    joint_states: u16,
    odom: u16,
    control: u16,
    path: u16,
    disturbance: u16,
}

/// Writes the log of one run.
///
/// After an error the file holds what had been written before it; every later call gives an error again. A writer
/// that is dropped without [`finish`](Self::finish) leaves a readable file without summary and outcome.
///
/// Cost: no allocation per sample once the buffers have grown, apart from the index that the file format needs.
pub struct LogWriter<W: Write = BufWriter<File>> {
    mcap: mcap::Writer<NoSeek<W>>,
    path: PathBuf,
    channels: Channels,
    joints: [Joint; JOINTS],
    wheel_radius_m: f64,
    half_track_m: f64,
    cdr: Cdr,
    trail: Trail,
    arrows: Arrows,
    next_path_ns: u64,
    last_flush: Instant,
    is_flushed: bool,
    last_stamp_ns: u64,
    samples: u32,
}

impl<W: Write> std::fmt::Debug for LogWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { path, samples, .. } = self;
        f.debug_struct("LogWriter").field("path", path).field("samples", samples).finish_non_exhaustive()
    }
}

impl LogWriter {
    /// Creates the file `path`, replacing what was there, and writes everything known before the run.
    ///
    /// # Errors
    ///
    /// [`LogError::Create`] if the file cannot be created, [`LogError::Write`] if it cannot be written to.
    pub fn create(path: impl AsRef<Path>, header: &LogHeader<'_>) -> Result<Self, LogError> {
        let path = path.as_ref();
        let file = File::create(path).map_err(|source| LogError::Create { path: path.to_owned(), source })?;
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
            joints: joints(&header.robot),
            wheel_radius_m: header.robot.wheel_radius_m,
            half_track_m: header.robot.track_width_m / 2.0,
            cdr: Cdr::default(),
            trail: Trail::new(),
            arrows: Arrows::default(),
            next_path_ns: 0,
            last_flush: Instant::now(),
            is_flushed: true,
            last_stamp_ns: 0,
            samples: 0,
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
        messages::string(&mut self.cdr, &urdf(&header.robot));
        self.publish(self.channels.robot_description, 0, 0)?;
        let stride = header.reference.len().div_ceil(MAX_REFERENCE_POINTS).max(1);
        let points = header.reference.iter().step_by(stride);
        messages::path(&mut self.cdr, 0, points.map(|&[t, x, y, z]| (stamp_ns(t), [x, y, z])));
        self.publish(self.channels.reference, 0, 0)?;
        self.mcap.flush()
    }

    fn write_sample(&mut self, sample: &LogSample) -> Result<(), McapError> {
        let (stamp, sequence) = (sample.stamp_ns(), self.samples);
        let channels = self.channels;
        messages::tf(&mut self.cdr, stamp, &transforms(&self.joints, sample));
        self.publish(channels.tf, sequence, stamp)?;
        let turn = self.half_track_m * sample.yaw_rate;
        let wheel_rates = [sample.forward + turn, sample.forward - turn].map(|v| v / self.wheel_radius_m);
        messages::joint_states(&mut self.cdr, stamp, sample, wheel_rates);
        self.publish(channels.joint_states, sequence, stamp)?;
        messages::odometry(&mut self.cdr, stamp, sample);
        self.publish(channels.odom, sequence, stamp)?;
        messages::control(&mut self.cdr, stamp, sample);
        self.publish(channels.control, sequence, stamp)?;
        if stamp >= self.next_path_ns {
            self.publish_path(stamp, sample.tip)?;
        }
        self.trail.offer(stamp, sample.tip);
        self.samples = self.samples.wrapping_add(1);
        self.last_stamp_ns = stamp;
        if self.arrows.write(&mut self.cdr, stamp, &self.joints, &sample.disturbance) {
            self.publish(channels.disturbance, sequence, stamp)?;
        }
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

    /// The trail and, as its newest point, the tip as it is now.
    fn publish_path(&mut self, stamp: u64, tip: [f64; 3]) -> Result<(), McapError> {
        let kept = self.trail.points();
        let points = (0..kept.len() + 1).map(|index| kept.get(index).copied().unwrap_or((stamp, tip)));
        messages::path(&mut self.cdr, stamp, points);
        let number = stamp / PATH_PERIOD_NS;
        self.next_path_ns = number.saturating_add(1).saturating_mul(PATH_PERIOD_NS);
        self.publish(self.channels.path, u32::try_from(number).unwrap_or(u32::MAX), stamp)
    }

    fn write_result(&mut self, outcome: Outcome, summary_json: &str, digest: &str) -> Result<(), McapError> {
        let end_ns = self.last_stamp_ns;
        attach(&mut self.mcap, end_ns, "summary.json", "application/json", summary_json)?;
        self.mcap.write_metadata(&outcome.metadata(digest, self.samples, end_ns))?;
        self.mcap.finish().map(drop)
    }

    /// Logs the message in the buffer.
    fn publish(&mut self, channel_id: u16, sequence: u32, stamp_ns: u64) -> Result<(), McapError> {
        let header = MessageHeader { channel_id, sequence, log_time: stamp_ns, publish_time: stamp_ns };
        self.mcap.write_to_known_channel(&header, self.cdr.bytes())
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

fn add_channels<W: Write>(mcap: &mut mcap::Writer<NoSeek<W>>) -> Result<Channels, McapError> {
    let mut ids = [0; TOPICS.len()];
    for (id, (topic, schema)) in ids.iter_mut().zip(&TOPICS) {
        let schema = schema();
        let schema = mcap.add_schema(schema.name, schema::SCHEMA_ENCODING, schema.text.as_bytes())?;
        *id = mcap.add_channel(schema, topic, schema::MESSAGE_ENCODING, &BTreeMap::new())?;
    }
    let [robot_description, reference, tf, joint_states, odom, control, path, disturbance] = ids;
    Ok(Channels { robot_description, reference, tf, joint_states, odom, control, path, disturbance })
}
