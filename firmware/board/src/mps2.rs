//! mps2-an386, a Cortex-M4F, and mps2-an385, a Cortex-M3, both at 25 MHz, with the serial port UART0.

pub use crate::cortex::{Clock, entry};
use crate::register::Register;

/// What it is called over a link.
pub const NAME: &str = if cfg!(target_abi = "eabihf") { "cortex-m4f" } else { "cortex-m3" };
/// Rate of the clock, Hz.
pub const CLOCK_HZ: u32 = 25_000_000;

/// Makes the machine ready.
pub(crate) fn start() -> (Serial, Clock) {
    (Serial::start(), Clock::start())
}

/// UART0, of the CMSDK.
#[derive(Debug)]
pub struct Serial {
    data: Register<u32>,
    state: Register<u32>,
}

/// State: a byte waits to be sent.
const SENDING: u32 = 1;
/// State: a byte has been received.
const RECEIVED: u32 = 2;

impl Serial {
    fn start() -> Self {
        #[expect(unsafe_code, reason = "registers are addresses")]
        // SAFETY: UART0 of both machines; none of its registers reaches memory.
        let [data, state, control, divider] =
            [0x4000_4000, 0x4000_4004, 0x4000_4008, 0x4000_4010].map(|at| unsafe { Register::at(at) });
        // 25 MHz / 217 is 115,200 baud.
        divider.write(217);
        // Sender and receiver on, no interrupts.
        control.write(3);
        Self { data, state }
    }

    /// A byte, if one was received.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "the register holds a byte")]
    pub fn try_read(&mut self) -> Option<u8> {
        (self.state.read() & RECEIVED != 0).then(|| self.data.read() as u8)
    }

    /// Sends bytes; waits until the last is on its way.
    pub fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            while self.state.read() & SENDING != 0 {}
            self.data.write(u32::from(byte));
        }
    }
}
