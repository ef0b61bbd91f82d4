//! The file of samples: a line each, appended in order, that a later call goes on with.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::Xxh3;

use super::{Ended, QUANTITIES, Row, edits, sample_seed};
use crate::VERSION;
use crate::scenario::Loaded;

/// Name and version of the file's format.
const FORMAT: &str = "mmsim.sweep-samples/1";

/// Digits of the digest of a trajectory.
const DIGEST_LENGTH: usize = 32;

/// What is wrong with a file of samples.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// It cannot be read or written.
    #[error("cannot {doing} {}", path.display())]
    Io {
        /// What could not be done.
        doing: &'static str,
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: io::Error,
    },
    /// Another process is writing it.
    #[error("{} is being written by another sweep", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// It holds the samples of another scenario, seed or version.
    #[error(
        "{} holds the samples of another sweep: its first line is `{found}`, that of this scenario, seed and version would be \
         `{wanted}`; --fresh starts over",
        path.display()
    )]
    Other {
        /// The file.
        path: PathBuf,
        /// Its first line.
        found: String,
        /// What it should be.
        wanted: String,
    },
    /// A line is no sample, or not the one that belongs there.
    #[error("{}:{line}: not sample {sample} of this sweep; --fresh starts over", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The number that should be on it.
        sample: usize,
    },
}

/// An open file of samples.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    file: File,
    rows: Vec<Row>,
}

impl Store {
    /// Opens the file of a sweep, reads the samples that it holds and cuts off a half-written last line.
    ///
    /// `fresh` forgets what is there.
    ///
    /// # Errors
    /// The file cannot be opened, is of another sweep, or holds a line that is no sample.
    pub fn open(path: &Path, loaded: &Loaded, seed: u64, fresh: bool) -> Result<Self, StoreError> {
        let fail = |doing| {
            let path = path.to_path_buf();
            move |source| StoreError::Io { doing, path, source }
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(fail("make the folder of"))?;
        }
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let mut file = opened.map_err(fail("open"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(StoreError::Busy { path: path.to_path_buf() }),
            // A file system that knows no locks is no reason to refuse.
            Err(TryLockError::Error(_)) => {}
        }
        let mut text = Vec::new();
        if !fresh {
            file.read_to_end(&mut text).map_err(fail("read"))?;
        }
        let first = first_line(loaded, seed);
        let columns = format!("sample,seed,ended,simulated_s,{},digest", QUANTITIES.join(","));
        let head = format!("{first}\n{columns}\n");
        let (mut rows, mut new) = (Vec::new(), "");
        if head.as_bytes().starts_with(&text) {
            // Cut off in its head, or not even begun.
            text.clear();
            new = &head;
        } else {
            check_first_line(path, &text, &first)?;
            let whole = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            text.truncate(whole);
            rows = parse(path, &text, seed)?;
        }
        file.set_len(text.len() as u64)
            .and_then(|()| file.seek(io::SeekFrom::End(0)))
            .and_then(|_| file.write_all(new.as_bytes()))
            .map_err(fail("write"))?;
        Ok(Self { path: path.to_path_buf(), file, rows })
    }

    /// The samples that the file holds, from number 0 on.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends the next sample.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn append(&mut self, row: Row) -> Result<(), StoreError> {
        let written = self.file.write_all(line(&row).as_bytes());
        self.rows.push(row);
        written.map_err(|source| StoreError::Io { doing: "write", path: self.path.clone(), source })
    }
}

/// The first line of a file of samples: whatever changes it makes another sweep.
fn first_line(loaded: &Loaded, seed: u64) -> String {
    format!("# {FORMAT} version={VERSION} digest={} seed={seed}", digest(loaded))
}

/// XXH3-128 over the digest of the scenario, and over the edits of a sample for what is drawn.
fn digest(loaded: &Loaded) -> String {
    let mut hash = Xxh3::new();
    let drawn = edits(&loaded.file, 0, 0);
    for text in std::iter::once(loaded.digest()).chain(drawn) {
        hash.update(text.as_bytes());
    }
    format!("{:032x}", hash.digest128())
}

fn check_first_line(path: &Path, text: &[u8], wanted: &str) -> Result<(), StoreError> {
    let text = String::from_utf8_lossy(text);
    let found = text.lines().next().unwrap_or_default();
    if found == wanted {
        return Ok(());
    }
    // Whatever it is, it has to fit into a message.
    let found = found.chars().take(200).collect();
    Err(StoreError::Other { path: path.to_path_buf(), found, wanted: wanted.to_owned() })
}

/// The samples of a file of whole lines.
fn parse(path: &Path, text: &[u8], seed: u64) -> Result<Vec<Row>, StoreError> {
    let text = String::from_utf8_lossy(text);
    let columns_and_header = 2;
    let row = |(sample, text): (usize, &str)| {
        let bad =
            || StoreError::Line { path: path.to_path_buf(), line: sample + columns_and_header + 1, sample };
        read_line(text).filter(|row| belongs(row, sample as u64, seed)).ok_or_else(bad)
    };
    text.lines().skip(columns_and_header).enumerate().map(row).collect()
}

/// Whether a row is a sample of a sweep's seed; one that ran away at once may have no numbers, any other has all.
fn belongs(row: &Row, sample: u64, seed: u64) -> bool {
    let is_whole = row.simulated_s >= 0.0
        && (row.ended != Ended::Finished || row.values.iter().all(|value| !value.is_nan()))
        && row.digest.len() == DIGEST_LENGTH
        && row.digest.bytes().all(|digit| digit.is_ascii_hexdigit());
    row.sample == sample && row.seed == sample_seed(seed, sample) && is_whole
}

fn line(row: &Row) -> String {
    let ended = row.ended.name();
    let values = row.values.map(|value| format!("{value:?}")).join(",");
    format!("{},{},{ended},{:?},{values},{}\n", row.sample, row.seed, row.simulated_s, row.digest)
}

fn read_line(text: &str) -> Option<Row> {
    let mut cells = text.split(',');
    let sample = cells.next()?.parse().ok()?;
    let seed = cells.next()?.parse().ok()?;
    let ended = Ended::from_name(cells.next()?)?;
    let simulated_s = cells.next()?.parse().ok()?;
    let mut values = [0.0; QUANTITIES.len()];
    for value in &mut values {
        *value = cells.next()?.parse().ok()?;
    }
    let digest = cells.next()?.to_owned();
    cells.next().is_none().then_some(Row { sample, seed, ended, simulated_s, values, digest })
}
