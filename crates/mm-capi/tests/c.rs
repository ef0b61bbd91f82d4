//! Law: a call that is wrong returns the status that says so and changes nothing, seen from C; the header is C99 with all warnings.
//!
//! Reference: `c/misuse.c`, which says so call by call. Here it is compiled and run plainly; `cargo xtask capi` does so under valgrind and
//! with sanitizers too, on release code.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// The archive beside this test that was made last: it is of the sources as they stand, whichever features it was made with.
#[expect(clippy::expect_used, reason = "a test that cannot find the library has failed")]
fn archive() -> PathBuf {
    let test = std::env::current_exe().expect("a test knows where it is");
    let directory = test.parent().expect("it is in a directory");
    let made =
        |path: &PathBuf| path.metadata().and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let files = directory.read_dir().expect("a directory").filter_map(Result::ok).map(|entry| entry.path());
    let is_archive = |path: &PathBuf| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        name.starts_with("libmm_capi") && name.ends_with(".a")
    };
    files.filter(is_archive).max_by_key(made).expect("cargo makes the archive with the library")
}

#[test]
fn misuse_from_c_is_a_status() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("misuse-{}", std::process::id()));
    let mut cc = Command::new("cc");
    cc.args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-I"]);
    cc.arg(package.join("include")).arg(package.join("tests/c/misuse.c")).arg(archive());
    cc.args(["-lpthread", "-ldl", "-lm", "-o"]).arg(&program);
    let compiled = cc.output().expect("a C compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let run = Command::new(&program).output().expect("the program starts");
    std::fs::remove_file(&program).expect("the program can be removed");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
}
