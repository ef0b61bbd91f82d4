//! Law: the programs of `firmware/` compute on this machine what they print on a microcontroller.
//!
//! Why: all machines could agree with each other and be wrong together. Reference: the texts beside the programs, which `cargo xtask
//! qemu` compares with what the machines print. No tolerance: bits. `MMSIM_BLESS=1` writes the table of `control-tick` and
//! the texts anew.

#![expect(clippy::expect_used, reason = "helpers outside of test functions")]

use std::fmt::Write as _;
use std::path::PathBuf;

use mm_sim::experiment::Experiment;
use mm_sim::scenario;
use mm_sim::simulation::{Recorder, Sample};

#[path = "../../../firmware/fault/src/cases.rs"]
mod cases;
#[path = "../../../firmware/fuzzy-only/src/systems.rs"]
mod systems;
#[path = "../../../firmware/tick/src/table.rs"]
mod table;
#[path = "../../../firmware/tick/src/tick.rs"]
mod tick;

fn blesses() -> bool {
    std::env::var("MMSIM_BLESS").is_ok_and(|value| value == "1")
}

fn compare(file: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../firmware").join(file);
    if blesses() {
        std::fs::write(&path, text).expect("writable");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(text, kept, "{}; MMSIM_BLESS=1 keeps it", path.display());
}

/// What `control-tick` does with a controller that it has no static place for.
fn ticked(out: &mut String) -> bool {
    tick::stack().is_ok_and(|stack| tick::run(out, (&stack, &mut stack.initial_state())))
}

fn printed(program: fn(&mut String) -> bool) -> String {
    let mut text = String::new();
    assert!(program(&mut text), "the program fails: {text}");
    text
}

#[test]
fn programs_print_here_what_is_kept() {
    compare("fuzzy-only/expected.txt", &printed(systems::run));
    compare("fault/expected.txt", &printed(cases::run));
    compare("tick/expected.txt", &printed(ticked));
}

/// Rows of the table.
const ROWS: usize = 32;

/// Takes the rows.
struct Rows(String, usize);

impl Recorder for Rows {
    type Error = std::fmt::Error;

    #[expect(clippy::cast_possible_truncation, reason = "the table is in single precision")]
    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        let single = |value: f64| format!("{:?}", value as f32);
        let list = |values: &[f64]| values.iter().map(|value| single(*value)).collect::<Vec<_>>().join(", ");
        let q = &sample.state.q;
        let coordinates = [&[q.x, q.y, q.heading][..], &q.joints].concat();
        let speeds: Vec<f64> = sample.state.nu.channels().collect();
        let reference = sample.reference;
        let parts = [reference.position, reference.velocity, reference.acceleration];
        writeln!(self.0, "    Row {{")?;
        writeln!(self.0, "        q: [{}],", list(&coordinates))?;
        writeln!(self.0, "        nu: [{}],", list(&speeds))?;
        writeln!(
            self.0,
            "        reference: [{}],",
            parts.map(|v| format!("[{}]", list(v.as_slice()))).join(", ")
        )?;
        writeln!(self.0, "    }},")?;
        self.1 += 1;
        Ok(self.1 < ROWS)
    }
}

#[test]
fn the_table_is_the_begin_of_the_square() {
    let loaded = scenario::load("square", &[]).expect("a bundled scenario");
    let Ok(Experiment::Closed(mut simulation)) = Experiment::build(&loaded) else { panic!("no closed loop") };
    simulation.clock.log_every = 1;
    let mut rows = Rows(String::new(), 0);
    simulation.run(&mut rows).expect("text");
    let head = "\
//! The first states of the scenario `square` in single precision, written by `MMSIM_BLESS=1 cargo test -p mm-replay --test firmware`.

/// What enters an update.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// Pose of the base, m and rad, and joint angles, rad.
    pub(crate) q: [f32; 6],
    /// Quasi-velocities, m/s and rad/s.
    pub(crate) nu: [f32; 5],
    /// Position, velocity and acceleration of the reference, m, m/s and m/s^2.
    pub(crate) reference: [[f32; 3]; 3],
}

/// One period after the other.
#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = \"measured angles\")]
pub(crate) static TABLE: [Row; 32] = [
";
    compare("tick/src/table.rs", &format!("{head}{}];\n", rows.0));
}
