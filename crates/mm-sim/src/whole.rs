//! Files that are there whole or not at all.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a file beside its place and moves it there when it is complete.
///
/// A link stays one: what it leads to is replaced. What is no file, such as a pipe or a device, is written to as it is.
///
/// What is beside has a name of its own for every call of every process, so that none disturbs another: the last to be complete
/// stays.
pub(crate) fn write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let place = match (std::fs::metadata(path), path.is_symlink()) {
        (Ok(there), _) if !there.is_file() && !there.is_dir() => None,
        (Ok(_), _) => Some(path.canonicalize()?),
        // A link to nowhere yet.
        (Err(_), true) => None,
        (Err(_), false) => Some(path.to_owned()),
    };
    let Some(place) = place else {
        let mut out = BufWriter::new(File::create(path)?);
        return fill(&mut out).and_then(|()| out.flush());
    };
    let (beside, file) = create_beside(&place)?;
    let mut out = BufWriter::new(file);
    let written = fill(&mut out).and_then(|()| out.flush());
    drop(out);
    let moved = written.and_then(|()| std::fs::rename(&beside, &place));
    if moved.is_err() {
        // What is left of it is of no use; that it cannot be removed adds nothing to the error.
        let _ = std::fs::remove_file(&beside);
    }
    moved
}

/// A new file in the folder of another.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let beside = path.with_file_name(format!(".mmsim-{}-{count}.part", std::process::id()));
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
        let left = format!(".mmsim-{}-0.part", std::process::id());
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

    /// Law: a link stays a link and what it leads to is replaced; what is no file is written to and stays; a name of the greatest length is
    /// no obstacle. Why: `-o` may name any of them, `/dev/null` included. Reference: the file system.
    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = std::env::temp_dir().join(format!("mmsim-whole-links-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let text = |path: &Path| std::fs::read_to_string(path).expect("a file");
        let (file, link, early) = (folder.join("file"), folder.join("link"), folder.join("early"));
        std::fs::write(&file, "before").expect("a file");
        std::os::unix::fs::symlink("file", &link).expect("a link");
        std::os::unix::fs::symlink("later", &early).expect("a link");
        for (path, behind) in [(&link, &file), (&early, &folder.join("later"))] {
            write(path, |out| write!(out, "after")).expect("a link to a file");
            assert!(path.is_symlink(), "{} is still a link", path.display());
            assert_eq!(text(behind), "after");
        }
        write(Path::new("/dev/null"), |out| write!(out, "nothing")).expect("a device");
        assert!(!std::fs::metadata("/dev/null").expect("a device").is_file(), "it is still a device");
        let long = folder.join("n".repeat(250));
        write(&long, |out| write!(out, "long")).expect("a long name");
        assert_eq!(text(&long), "long");
        std::fs::remove_dir_all(&folder).expect("a folder of our own");
    }
}
