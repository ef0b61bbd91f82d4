//! The machines that QEMU has.

/// A machine with a processor, and how its time runs.
#[derive(Debug)]
pub(super) struct Machine {
    /// Name of the processor.
    pub(super) name: &'static str,
    pub(super) emulator: &'static str,
    pub(super) arguments: &'static [&'static str],
    /// An instruction takes 2^shift ns: several ticks of the machine's timer, and 2^24 of them hold an update.
    pub(super) icount: &'static str,
    /// Target of the compiler.
    pub(super) target: &'static str,
    /// Profile of the build.
    pub(super) profile: &'static str,
}

pub(super) const MACHINES: [Machine; 4] = [
    Machine {
        name: "cortex-m4",
        emulator: "qemu-system-arm",
        arguments: &["-machine", "mps2-an386", "-cpu", "cortex-m4"],
        icount: "shift=8",
        target: "thumbv7em-none-eabihf",
        profile: "release",
    },
    Machine {
        name: "cortex-m3",
        emulator: "qemu-system-arm",
        arguments: &["-machine", "mps2-an385", "-cpu", "cortex-m3"],
        icount: "shift=8",
        target: "thumbv7m-none-eabi",
        profile: "release",
    },
    Machine {
        name: "cortex-m0",
        emulator: "qemu-system-arm",
        arguments: &["-machine", "microbit"],
        icount: "shift=8",
        target: "thumbv6m-none-eabi",
        profile: "release",
    },
    Machine {
        name: "riscv32",
        emulator: "qemu-system-riscv32",
        arguments: &["-machine", "virt", "-cpu", "rv32,f=false,d=false", "-bios", "none", "-m", "32M"],
        icount: "shift=4",
        target: "riscv32imac-unknown-none-elf",
        profile: "release",
    },
];

/// Bytes that a program takes in flash and, stack apart, in RAM: the segments of a 32-bit ELF file.
pub(super) fn image_sizes(elf: &[u8]) -> Option<(u64, u64)> {
    let word = |at: usize| Some(u32::from_le_bytes(*elf.get(at..)?.first_chunk::<4>()?));
    let half = |at: usize| Some(u16::from_le_bytes(*elf.get(at..)?.first_chunk::<2>()?));
    // A magic number, 32 bits, lowest byte first.
    if elf.get(..6)? != [0x7f, b'E', b'L', b'F', 1, 1] {
        return None;
    }
    let (table, size, count) = (word(28)? as usize, half(42)? as usize, half(44)? as usize);
    let (mut flash, mut ram) = (0, 0);
    for i in 0..count {
        let at = table.checked_add(i.checked_mul(size)?)?;
        let [kind, in_file, in_memory, flags] = [word(at)?, word(at + 16)?, word(at + 20)?, word(at + 24)?];
        if kind == 1 {
            flash += u64::from(in_file);
            ram += if flags & 2 == 2 { u64::from(in_memory) } else { 0 };
        }
    }
    Some((flash, ram))
}
