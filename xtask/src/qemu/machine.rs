//! The machines that programs for microcontrollers run on.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use crate::shell::command_with;
use crate::tools::{QEMU_ARM, QEMU_RISCV, Tool, require};

/// A target and a machine of QEMU that has its processor.
#[derive(Debug)]
pub(crate) struct Machine {
    pub(crate) target: &'static str,
    pub(crate) processor: &'static str,
    /// QEMU with the machine.
    arguments: &'static [&'static str],
}

pub(crate) const M4F: Machine = Machine {
    target: "thumbv7em-none-eabihf",
    processor: "Cortex-M4F",
    arguments: &["qemu-system-arm", "-machine", "mps2-an386", "-cpu", "cortex-m4"],
};

pub(crate) const M3: Machine = Machine {
    target: "thumbv7m-none-eabi",
    processor: "Cortex-M3",
    arguments: &["qemu-system-arm", "-machine", "mps2-an385", "-cpu", "cortex-m3"],
};

pub(crate) const M0: Machine = Machine {
    target: "thumbv6m-none-eabi",
    processor: "Cortex-M0",
    // 32 KiB of RAM, for `digest`; the others are linked for the lower 16.
    arguments: &["qemu-system-arm", "-machine", "microbit", "-global", "nrf51-soc.sram-size=32768"],
};

pub(crate) const RISCV: Machine = Machine {
    target: "riscv32imac-unknown-none-elf",
    processor: "riscv32imac",
    arguments: &[
        "qemu-system-riscv32",
        "-machine",
        "virt",
        "-cpu",
        "rv32,f=false,d=false",
        "-bios",
        "none",
        "-m",
        "32M",
    ],
};

/// All of them.
pub(crate) const MACHINES: [Machine; 4] = [M4F, M3, M0, RISCV];

/// How a program ended, and what it printed.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) is_well: bool,
    pub(crate) text: String,
    pub(crate) took: Duration,
}

/// Installs the emulators of these machines where they are missing.
pub(crate) fn install_emulators(machines: &[Machine]) -> Result<()> {
    let is_used =
        |tool: &Tool| machines.iter().any(|machine| machine.arguments.first() == Some(&tool.program));
    require(&[QEMU_ARM, QEMU_RISCV].into_iter().filter(is_used).collect::<Vec<_>>())
}

impl Machine {
    /// Runs a program to its end, at most for `patience`, with a file as its argument.
    pub(crate) fn run(&self, program: &Path, file: Option<&Path>, patience: Duration) -> Result<Run> {
        let mut semihosting = "enable=on,target=native".to_owned();
        if let Some(file) = file {
            // A comma would end the argument.
            semihosting += &format!(",arg={}", file.display().to_string().replace(',', ",,"));
        }
        self.end(&["-semihosting-config", &semihosting], program, patience)
    }

    /// The same with 2^10 ns of the machine's time for every instruction, so that its timer counts them.
    pub(crate) fn count(&self, program: &Path, patience: Duration) -> Result<Run> {
        let arguments = ["-semihosting-config", "enable=on,target=native", "-icount", "shift=10"];
        self.end(&arguments, program, patience)
    }

    fn end(&self, arguments: &[&str], program: &Path, patience: Duration) -> Result<Run> {
        let mut qemu = command_with("timeout", &[&patience.as_secs().to_string()]);
        qemu.args(self.arguments).args(["-display", "none", "-monitor", "none", "-serial", "none"]);
        qemu.args(arguments).arg("-kernel").arg(program);
        let begin = Instant::now();
        let output = qemu.output();
        let output =
            output.with_context(|| format!("cannot start the emulator of the {}", self.processor))?;
        let mut text = String::from_utf8_lossy(&output.stdout).into_owned();
        text += &String::from_utf8_lossy(&output.stderr);
        if output.status.code() == Some(124) {
            text += &format!("no end after {} s\n", patience.as_secs());
        }
        Ok(Run { is_well: output.status.success(), text, took: begin.elapsed() })
    }
}
