//! The mmsim command.
fn main() {}
