//! Any text at all: it is refused with places in it, or read, written, read again and evaluated.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../crates/mm-fis/tests/fis/common/law.rs"]
mod law;

fuzz_target!(|text: &str| {
    law::holds(text, mm_fis::read_fis);
});
