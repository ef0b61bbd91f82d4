//! QEMU's virt machine with a riscv32imac processor, started as `-machine virt -cpu rv32,f=false,d=false -bios none -m 32M`; its serial
//! port is an ns16550a.

use core::arch::asm;
use core::fmt::Write;

use riscv_rt::TrapFrame;
pub use riscv_rt::entry;

use crate::register::Register;
use crate::{Console, exit};

/// What it is called over a link.
pub const NAME: &str = "riscv32imac";
/// Rate of the clock, Hz.
pub const CLOCK_HZ: u32 = 1_000_000_000;

/// Makes the machine ready.
pub(crate) fn start() -> (Serial, Clock) {
    (Serial::start(), Clock)
}

/// The cycle counter.
#[derive(Debug)]
#[non_exhaustive]
pub struct Clock;

impl Clock {
    /// Ticks since any moment, modulo 2^24.
    #[inline(always)]
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "registers have 32 bits here")]
    pub fn ticks(&self) -> u32 {
        riscv::register::mcycle::read() as u32 & 0x00ff_ffff
    }

    /// Spends exactly this many instructions, an even number, and some few in addition, always the same.
    #[inline(always)]
    pub fn spend(&self, instructions: u32) {
        #[expect(unsafe_code, reason = "only in assembly is it known how many instructions there are")]
        // SAFETY: a loop over one register, which is not used any more.
        unsafe {
            asm!(
                "2:", "addi {n}, {n}, -1", "bnez {n}, 2b",
                n = inout(reg) instructions / 2 + 1 => _,
                options(nomem, nostack),
            );
        }
    }
}

/// The serial port.
#[derive(Debug)]
pub struct Serial {
    data: Register<u8>,
    state: Register<u8>,
}

/// State: a byte has been received.
const RECEIVED: u8 = 1;
/// State: there is room for a byte to be sent.
const ROOM: u8 = 0x20;

impl Serial {
    fn start() -> Self {
        #[expect(unsafe_code, reason = "registers are addresses")]
        // SAFETY: the serial port of the machine; none of its registers reaches memory.
        let [data, queues, format, state] =
            [0x1000_0000, 0x1000_0002, 0x1000_0003, 0x1000_0005].map(|at| unsafe { Register::at(at) });
        // Bytes of 8 bits, queues on.
        format.write(3);
        queues.write(1);
        Self { data, state }
    }

    /// A byte, if one was received.
    #[inline]
    pub fn try_read(&mut self) -> Option<u8> {
        (self.state.read() & RECEIVED != 0).then(|| self.data.read())
    }

    /// Sends bytes; waits until the last is on its way.
    pub fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            while self.state.read() & ROOM == 0 {}
            self.data.write(byte);
        }
    }
}

/// Called by the runtime, by this name.
#[expect(unsafe_code, reason = "the runtime calls it by its name")]
#[unsafe(export_name = "ExceptionHandler")]
fn exception(_frame: &TrapFrame) -> ! {
    let at = riscv::register::mepc::read();
    let _ = writeln!(Console::new(), "exception at {at:#x}: {:?}", riscv::register::mcause::read().cause());
    exit(false)
}
