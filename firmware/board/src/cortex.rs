//! What all Cortex-M have: the way in, the timer SysTick, faults.
#![expect(
    unsafe_code,
    reason = "the runtime wants the handler of faults to be unsafe to call; the timer is taken without asking"
)]

use core::fmt::Write;

use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
pub use cortex_m_rt::entry;
use cortex_m_rt::{ExceptionFrame, exception};

use crate::{Console, exit};

/// SysTick on the clock of the core.
#[derive(Debug)]
#[non_exhaustive]
pub struct Clock;

impl Clock {
    /// Starts the timer, whoever else has taken the peripherals before.
    pub(crate) fn start() -> Self {
        // SAFETY: the timer is used here alone, and from now on read only.
        let Peripherals { SYST: mut timer, .. } = unsafe { Peripherals::steal() };
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0x00ff_ffff);
        timer.clear_current();
        timer.enable_counter();
        Self
    }

    /// Ticks since any moment, modulo 2^24.
    #[inline(always)]
    #[must_use]
    pub fn ticks(&self) -> u32 {
        // It counts down.
        SYST::get_current().wrapping_neg() & 0x00ff_ffff
    }

    /// Spends exactly this many instructions, an even number, and some few in addition, always the same.
    #[inline(always)]
    pub fn spend(&self, instructions: u32) {
        // A loop of two instructions, run once more than its argument says.
        cortex_m::asm::delay(instructions / 2);
    }
}

/// Called where the processor gives up; it uses nothing but what it is given, and does not return.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    let _ = writeln!(Console::new(), "hard fault at {:08x}", frame.pc());
    exit(false)
}
