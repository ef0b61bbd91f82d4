//! microbit, an nRF51822: a Cortex-M0 at 16 MHz, with its serial port.
//!
//! The nRF51822 itself has no SysTick; QEMU's has. There, the clock would be TIMER0.

pub use crate::cortex::{Clock, entry};
use crate::register::Register;

/// What it is called over a link.
pub const NAME: &str = "cortex-m0";
/// Rate of the clock, Hz.
pub const CLOCK_HZ: u32 = 16_000_000;

/// Makes the machine ready.
pub(crate) fn start() -> (Serial, Clock) {
    (Serial::start(), Clock::start())
}

/// UART0.
#[derive(Debug)]
pub struct Serial {
    received: Register<u32>,
    input: Register<u32>,
    sent: Register<u32>,
    output: Register<u32>,
}

const BASE: usize = 0x4000_2000;

impl Serial {
    fn start() -> Self {
        #[expect(unsafe_code, reason = "registers are addresses")]
        // SAFETY: UART0 of the nRF51822; none of its registers reaches memory.
        let at = |offset: usize| unsafe { Register::at(BASE + offset) };
        let (pin_out, pin_in, rate, enable) = (at(0x50c), at(0x514), at(0x524), at(0x500));
        // The pins that the board's USB chip listens to, at 115,200 baud.
        pin_out.write(24);
        pin_in.write(25);
        rate.write(0x01d7_e000);
        enable.write(4);
        let (start_input, start_output) = (at(0x000), at(0x008));
        start_input.write(1);
        start_output.write(1);
        Self { received: at(0x108), input: at(0x518), sent: at(0x11c), output: at(0x51c) }
    }

    /// A byte, if one was received.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "the register holds a byte")]
    pub fn try_read(&mut self) -> Option<u8> {
        if self.received.read() == 0 {
            return None;
        }
        // Cleared first: the next byte may be there as soon as this one is taken.
        self.received.write(0);
        Some(self.input.read() as u8)
    }

    /// Sends bytes; waits until the last is on its way.
    pub fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.sent.write(0);
            self.output.write(u32::from(byte));
            while self.sent.read() == 0 {}
        }
    }
}
