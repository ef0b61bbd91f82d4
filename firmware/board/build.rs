//! Chooses the machine of a target, and its memory for the linker.
//!
//! Another machine is another name here, a file `src/NAME.rs` with its line in `src/lib.rs`, and a file `memory/NAME.x`.

use std::path::Path;

/// The machines there are.
const MACHINES: [&str; 3] = ["mps2", "microbit", "virt"];

fn main() {
    let names: Vec<String> = MACHINES.iter().map(|name| format!("{name:?}")).collect();
    println!("cargo::rustc-check-cfg=cfg(machine, values({}))", names.join(", "));
    println!("cargo::rerun-if-changed=memory");
    let target = std::env::var("TARGET").unwrap_or_default();
    let machine = match target.as_str() {
        "thumbv7em-none-eabihf" | "thumbv7m-none-eabi" => "mps2",
        "thumbv6m-none-eabi" => "microbit",
        "riscv32imac-unknown-none-elf" => "virt",
        // The host, for which the crate is empty.
        _ => return,
    };
    println!("cargo::rustc-cfg=machine={machine:?}");
    let output = std::env::var("OUT_DIR").unwrap_or_default();
    let memory = Path::new(env!("CARGO_MANIFEST_DIR")).join("memory").join(format!("{machine}.x"));
    if let Err(error) = std::fs::copy(&memory, Path::new(&output).join("memory.x")) {
        println!("cargo::error={}: {error}", memory.display());
    }
    println!("cargo::rustc-link-search={output}");
}
