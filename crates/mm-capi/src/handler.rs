//! What a panic would do on bare metal. No call of this crate panics, so that no linked program has it: `cargo xtask capi` looks for its name.

use core::panic::PanicInfo;

/// Where a panic would end. It is never linked into a program.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn mm_panic_reached() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    mm_panic_reached()
}
