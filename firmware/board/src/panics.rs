//! What a panic does.

use core::fmt::Write;
use core::panic::PanicInfo;

use crate::{Console, exit};

/// Prints where the panic was; the program has failed.
pub fn report(info: &PanicInfo<'_>) -> ! {
    // A line that cannot be written is missed on the other side.
    let _ = writeln!(Console::new(), "{info}");
    exit(false)
}

/// There shall be no panic: a release build does not link where one can be reached. Without optimization it is reported.
#[inline(always)]
pub fn refuse(info: &PanicInfo<'_>) -> ! {
    #[cfg(debug_assertions)]
    report(info);
    #[cfg(not(debug_assertions))]
    {
        let _ = info;
        #[expect(unsafe_code, reason = "a symbol that nobody defines is foreign")]
        // SAFETY: a program that calls it does not link, and so never runs.
        unsafe {
            this_program_can_panic()
        }
    }
}

#[cfg(not(debug_assertions))]
#[expect(unsafe_code, reason = "a symbol that nobody defines is foreign")]
// SAFETY: never called; see above.
unsafe extern "C" {
    fn this_program_can_panic() -> !;
}
