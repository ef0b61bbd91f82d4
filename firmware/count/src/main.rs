//! Counts on a Cortex-M and prints over semihosting; QEMU ends with 0, or with 1 where anything went wrong.
#![no_std]
#![no_main]

use core::fmt::Write;
use core::panic::PanicInfo;

use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hio};
use count::{Clock, Counter};

/// Ticks of 10,000 instructions of 1,024 ns (`-icount shift=10`) at the 25 MHz of mps2-an386 and the 16 MHz of the microbit.
const TICKS: [u32; 2] = [256_000, 163_840];

/// The timer that every Cortex-M may have, on the clock of the core; it counts down.
struct SysTick;

impl SysTick {
    fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0x00ff_ffff);
        timer.clear_current();
        timer.enable_counter();
        Self
    }
}

impl Clock for SysTick {
    #[inline(always)]
    fn ticks(&self) -> u32 {
        SYST::get_current().wrapping_neg()
    }

    #[inline(always)]
    fn spend(&self, instructions: u32) {
        // A loop of two instructions, run once more than its argument says.
        cortex_m::asm::delay(instructions / 2);
    }
}

#[entry]
fn main() -> ! {
    let ok = hio::hstdout().is_ok_and(|mut out| run(&mut out));
    end(ok)
}

fn run(out: &mut impl Write) -> bool {
    let Some(peripherals) = Peripherals::take() else { return false };
    let counter = match Counter::calibrated(SysTick::start(peripherals.SYST)) {
        Ok(counter) => counter,
        Err(error) => {
            let _ = writeln!(out, "calibration: {error:?}");
            return false;
        }
    };
    // The loop and the clock have to agree on what an instruction is; a tick more or less is rounding.
    if !TICKS.iter().any(|ticks| counter.reference().abs_diff(*ticks) <= 1) {
        let _ = writeln!(out, "calibration: {} ticks, one of {TICKS:?} expected", counter.reference());
        return false;
    }
    match count::run(&counter, out) {
        Ok(()) => true,
        Err(error) => {
            let _ = writeln!(out, "tables: {error}");
            false
        }
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    end(false)
}

fn end(ok: bool) -> ! {
    debug::exit(if ok { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    loop {
        cortex_m::asm::nop();
    }
}
