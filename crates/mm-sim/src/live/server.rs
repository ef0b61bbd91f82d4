//! The server: topics out, parameters in, one sample at a time.

use std::sync::{Arc, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use foxglove::websocket::Capability;
use foxglove::{
    ChannelBuilder, Context, FoxgloveError, PartialMetadata, RawChannel, Schema, WebSocketServer,
    WebSocketServerHandle,
};

use super::board::{Answer, Board, Change};
use super::{LiveError, Options};
use crate::VERSION;
use crate::experiment::Experiment;
use crate::log::{
    Converter, Encoder, MESSAGE_ENCODING, Message, PerTopic, SCHEMA_ENCODING, Topic, with_header,
};
use crate::scenario::Loaded;
use crate::simulation::{Retuned, Sample};

/// Longest sleep before somebody looks whether to stop.
const NAP: Duration = Duration::from_millis(50);
/// Time that a viewer is given after its first subscription, in which it makes the others.
const SETTLING: Duration = Duration::from_millis(300);

/// Time in which what was sent last is to reach the viewers, and for which they are waited for at the end.
const GRACE: Duration = Duration::from_millis(200);
const FAREWELL: Duration = Duration::from_secs(1);
/// Messages that a viewer may be behind, of four a sample and a few more.
const BACKLOG: usize = 16 * 1024;
/// Wall time between two messages of the clock.
const CLOCK_PERIOD: Duration = Duration::from_millis(20);

/// A served run.
pub struct Live {
    server: Option<WebSocketServerHandle>,
    /// Server and channels only know it, and are for nothing without it.
    _context: Arc<Context>,
    url: String,
    channels: PerTopic<Option<Arc<RawChannel>>>,
    converter: Converter,
    encoder: Encoder,
    /// What is sent once: its topic and bytes.
    preamble: Vec<(Topic, Vec<u8>)>,
    board: Arc<Board>,
    retuned: Option<Box<Retuned>>,
    changes: Vec<String>,
    speed: f64,
    begin: Option<Instant>,
    last_clock: Option<Instant>,
}

impl std::fmt::Debug for Live {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Live").field("url", &self.url).finish_non_exhaustive()
    }
}

impl Live {
    /// Serves a run of a scenario.
    ///
    /// # Errors
    /// An imposed motion; an address that cannot be had.
    pub fn start(
        (loaded, experiment): (&Loaded, &Experiment),
        Options { address, speed }: Options,
    ) -> Result<Self, LiveError> {
        let Experiment::Closed(simulation) = experiment else { return Err(LiveError::Imposed) };
        let failed = |source: FoxgloveError| LiveError::Server { address, source: Box::new(source) };
        let supervised = simulation.guard.as_ref().is_some_and(|guard| guard.supervisor.is_some());
        let board = Arc::new(Board::new(loaded.clone(), supervised, simulation.stack));
        // A context of its own: a process may serve several runs, one after the other.
        let context = Context::new();
        let channels = PerTopic::try_make(|topic, schema| {
            let schema = Schema::new(schema.name, SCHEMA_ENCODING, schema.text.into_bytes());
            let builder = ChannelBuilder::new(topic).context(&context).message_encoding(MESSAGE_ENCODING);
            builder.schema(schema).build_raw().map(Some)
        })
        .map_err(failed)?;
        let server = WebSocketServer::new()
            .name(format!("mmsim {VERSION}: {}", loaded.name()))
            .bind(address.ip().to_string(), address.port())
            .capabilities([Capability::Time, Capability::Parameters])
            .listener(Arc::clone(&board) as _)
            .parameter_handler(Arc::clone(&board) as _)
            .message_backlog_size(BACKLOG)
            .context(&context)
            .start_blocking()
            .map_err(failed)?;
        let mut preamble = Vec::new();
        let encoder = with_header(loaded, experiment, |header| {
            let mut encoder = Encoder::new(header);
            let Ok(()) = encoder.preamble(header, |Message { topic, bytes, .. }| {
                preamble.push((topic, bytes.to_vec()));
                Ok::<(), std::convert::Infallible>(())
            });
            encoder
        });
        let at = std::net::SocketAddr::new(address.ip(), server.port());
        Ok(Self {
            url: format!("ws://{at}"),
            server: Some(server),
            _context: context,
            channels,
            converter: Converter::new(experiment),
            encoder,
            preamble,
            board,
            retuned: None,
            changes: Vec::new(),
            speed,
            begin: None,
            last_clock: None,
        })
    }

    /// Where viewers connect.
    #[must_use]
    pub fn url(&self) -> String {
        self.url.clone()
    }

    /// Waits until somebody watches, or the run is to stop before it began.
    pub fn wait_for_viewer(&self, asked_to_stop: fn() -> bool) {
        while !self.board.has_watcher() {
            if asked_to_stop() {
                return;
            }
            self.answer();
            thread::sleep(NAP);
        }
        thread::sleep(SETTLING);
    }

    /// Shows a sample when its time has come, and takes up what viewers want.
    pub fn show(&mut self, sample: &Sample<'_>, asked_to_stop: fn() -> bool) {
        self.await_time(sample.t, asked_to_stop);
        let converted = self.converter.converted(sample);
        let stamp = converted.stamp_ns();
        if self.board.newcomer() {
            for (topic, bytes) in &self.preamble {
                send(&self.channels, *topic, bytes, stamp);
            }
        }
        let channels = &self.channels;
        let Ok(()) = self.encoder.sample(&converted, |Message { topic, stamp_ns, bytes, .. }| {
            send(channels, topic, bytes, stamp_ns);
            Ok::<(), std::convert::Infallible>(())
        });
        let Change { retuned, words } = self.board.take_change();
        self.changes.extend(words.iter().map(|change| format!("{change} from t = {:.3} s on", sample.t)));
        self.retuned = retuned.or(self.retuned.take());
        if let Some(server) = &self.server
            && self.last_clock.is_none_or(|last| last.elapsed() >= CLOCK_PERIOD)
        {
            server.broadcast_time(stamp);
            self.last_clock = Some(Instant::now());
        }
        self.answer();
    }

    /// Tells viewers what became of what they wanted.
    fn answer(&self) {
        let Some(server) = &self.server else { return };
        let Answer { parameters, statuses } = self.board.take_answer();
        if !parameters.is_empty() {
            server.publish_parameter_values(parameters);
        }
        for status in statuses {
            server.publish_status(status);
        }
    }

    /// The controller that a viewer asked for.
    pub fn retuned(&mut self) -> Option<Box<Retuned>> {
        self.retuned.take()
    }

    /// What viewers changed, and when.
    #[must_use]
    pub fn changes(&self) -> &[String] {
        &self.changes
    }

    /// Sleeps until a time of the scenario; one that is past already is not waited for, so a run that fell behind catches up.
    fn await_time(&mut self, t: f64, asked_to_stop: fn() -> bool) {
        let begin = *self.begin.get_or_insert_with(Instant::now);
        let Ok(due) = Duration::try_from_secs_f64(t / self.speed) else { return };
        while let Some(left) = due.checked_sub(begin.elapsed()).filter(|left| !left.is_zero()) {
            if asked_to_stop() {
                return;
            }
            self.answer();
            thread::sleep(left.min(NAP));
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        if let Some(server) = self.server.take() {
            // A stop forgets what waits to be sent, and waits for those who neither read nor leave.
            thread::sleep(GRACE);
            let stopping = server.stop();
            let (gone, all_gone) = mpsc::channel::<()>();
            thread::spawn(move || {
                stopping.wait_blocking();
                drop(gone);
            });
            let _ = all_gone.recv_timeout(FAREWELL);
        }
    }
}

fn send(channels: &PerTopic<Option<Arc<RawChannel>>>, topic: Topic, bytes: &[u8], stamp_ns: u64) {
    if let Some(channel) = channels.of(topic) {
        channel.log_with_meta(bytes, PartialMetadata::with_log_time(stamp_ns));
    }
}
