//! Files that are there whole or not at all.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a file beside its place and moves it there when it is complete.
///
/// What is beside has a name of its own for every call of every process, so that none disturbs another: the last to be complete
/// stays.
pub(crate) fn write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let (beside, file) = create_beside(path)?;
    let mut out = BufWriter::new(file);
    let written = fill(&mut out).and_then(|()| out.flush());
    drop(out);
    let moved = written.and_then(|()| std::fs::rename(&beside, path));
    if moved.is_err() {
        // What is left of it is of no use; that it cannot be removed adds nothing to the error.
        let _ = std::fs::remove_file(&beside);
    }
    moved
}

/// A new file in the folder of another.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let beside = path.with_file_name(format!(".{name}.{}-{count}.part", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            // Left by a process of the same number.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            other => return other.map(|file| (beside, file)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: whoever writes last, the file is one text as a whole, no writer fails and nothing is left beside. Why: two processes may
    /// write to one folder. Reference: the texts written; no tolerance.
    #[test]
    fn writers_of_one_file_do_not_disturb_each_other() {
        let folder = std::env::temp_dir().join(format!("mmsim-whole-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("file.txt");
        // What a process of the same number left is passed over.
        let left = format!(".file.txt.{}-0.part", std::process::id());
        std::fs::write(folder.join(&left), "left").expect("a file");
        std::thread::scope(|scope| {
            for writer in 0..4 {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..50 {
                        write(path, |out| (0..100).try_for_each(|_| writeln!(out, "{writer}")))
                            .expect("a file of its own");
                    }
                });
            }
        });
        let text = std::fs::read_to_string(&path).expect("the file");
        let first = text.lines().next().expect("a line");
        assert!(text.lines().count() == 100 && text.lines().all(|line| line == first), "one text:\n{text}");
        assert!(write(&path, |_| Err(io::Error::other("no"))).is_err(), "an error is passed on");
        assert_eq!(std::fs::read_to_string(&path).expect("the file"), text, "and leaves the file");
        let names =
            std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("a file").file_name());
        let mut names: Vec<_> = names.collect();
        names.sort();
        assert_eq!(names, [left.as_str(), "file.txt"], "nothing is left beside");
        std::fs::remove_dir_all(&folder).expect("a folder of our own");
    }
}
