//! Any bytes at all as a log: refused, or read; and what is recovered of it is a whole log with the same messages.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mm_sim::log::{LogFile, LogInfo, recover_stream};

fuzz_target!(|bytes: &[u8]| {
    let _ = LogFile::of("fuzzed.mcap", bytes);
    let mut recovered = Vec::new();
    let (Ok(info), Ok(found)) = (LogInfo::of(bytes), recover_stream(bytes, &mut recovered)) else {
        return;
    };
    assert_eq!(info.scan, found.scan, "both read the same way");
    if found.messages == 0 {
        return;
    }
    let again = LogInfo::of(recovered.as_slice()).expect("a log");
    assert!(again.scan.is_whole(), "{:?}", again.scan);
    assert_eq!(again.messages(), found.messages, "messages");
    assert_eq!(again.orphans, 0, "every message has its channel");
});
