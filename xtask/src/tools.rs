//! Programs of the system that jobs take, and the packages of Debian that hold them.

use std::sync::{Mutex, PoisonError};

use anyhow::Result;

use crate::shell::{answers, install};

/// A program and its packages.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tool {
    pub(crate) program: &'static str,
    packages: &'static [&'static str],
}

pub(crate) const QEMU_ARM: Tool = Tool { program: "qemu-system-arm", packages: &["qemu-system-arm"] };
pub(crate) const QEMU_RISCV: Tool = Tool { program: "qemu-system-riscv32", packages: &["qemu-system-misc"] };
pub(crate) const ARM_C: Tool =
    Tool { program: "arm-none-eabi-gcc", packages: &["gcc-arm-none-eabi", "libnewlib-arm-none-eabi"] };
/// With the C library's symbols, without which it does not start.
pub(crate) const VALGRIND: Tool = Tool { program: "valgrind", packages: &["valgrind", "libc6-dbg"] };
pub(crate) const CHROMIUM: Tool = Tool { program: "chromium", packages: &["chromium"] };

/// What the checks take.
pub(crate) const ALL: [Tool; 5] = [QEMU_ARM, QEMU_RISCV, ARM_C, VALGRIND, CHROMIUM];

/// Held while tools are installed: who asks for one that is on its way waits for it.
static INSTALLING: Mutex<()> = Mutex::new(());

/// Installs what is missing.
pub(crate) fn require(tools: &[Tool]) -> Result<()> {
    let _installing = INSTALLING.lock().unwrap_or_else(PoisonError::into_inner);
    let missing = tools.iter().filter(|tool| !answers(tool.program, &["--version"]));
    let packages: Vec<&str> = missing.flat_map(|tool| tool.packages).copied().collect();
    if packages.is_empty() { Ok(()) } else { install(&packages) }
}
