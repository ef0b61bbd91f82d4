//! Links the program with the script of the processor's runtime.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "none") {
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
        // All laws in double precision, checked and built from a message, take 20 KiB of stack. There are nRF51822 with 32 KiB of RAM;
        // all other programs keep to the microbit's 16.
        if std::env::var("TARGET").is_ok_and(|target| target == "thumbv6m-none-eabi") {
            println!("cargo::rustc-link-arg-bin=digest-f64=--defsym=_stack_start=0x20008000");
        }
    }
}
