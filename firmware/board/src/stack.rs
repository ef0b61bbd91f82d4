//! How deep the stack went: it is painted, and what lost its paint was used.

use core::arch::asm;

/// A word that no program leaves behind by chance.
const PAINT: u32 = 0xc5c5_a5c5;

/// The memory between the last variable and the begin of the stack, down from which it grows.
#[derive(Debug)]
#[expect(missing_copy_implementations, reason = "there is one stack")]
pub struct Stack {
    lowest: usize,
    highest: usize,
}

impl Stack {
    pub(crate) fn new() -> Self {
        Self { lowest: lowest(), highest: highest() }
    }

    /// Paints all that is not in use.
    #[inline(never)]
    pub fn paint(&mut self) {
        #[cfg(target_arch = "arm")]
        #[expect(unsafe_code, reason = "memory below the stack pointer has no owner to ask")]
        // SAFETY: what lies between the last variable and the stack pointer belongs to nobody; the loop itself uses no stack.
        unsafe {
            asm!(
                "2:", "cmp {at}, sp", "bhs 3f", "str {paint}, [{at}]", "adds {at}, #4", "b 2b", "3:",
                at = inout(reg) self.lowest => _,
                paint = in(reg) PAINT,
                options(nostack),
            );
        }
        #[cfg(target_arch = "riscv32")]
        #[expect(unsafe_code, reason = "memory below the stack pointer has no owner to ask")]
        // SAFETY: as above.
        unsafe {
            asm!(
                "2:", "bgeu {at}, sp, 3f", "sw {paint}, 0({at})", "addi {at}, {at}, 4", "j 2b", "3:",
                at = inout(reg) self.lowest => _,
                paint = in(reg) PAINT,
                options(nostack),
            );
        }
    }

    /// Bytes of the stack in use where this is called.
    #[inline(always)]
    #[must_use]
    pub fn depth(&self) -> usize {
        self.highest - pointer()
    }

    /// Most bytes of the stack that were in use since the last painting.
    #[must_use]
    pub fn deepest(&self) -> usize {
        let mut at = self.lowest;
        while at < self.highest && word(at) == PAINT {
            at += size_of::<u32>();
        }
        self.highest - at
    }

    /// Bytes that the stack may take.
    #[must_use]
    pub fn size(&self) -> usize {
        self.highest - self.lowest
    }
}

/// The stack pointer.
#[inline(always)]
fn pointer() -> usize {
    let value;
    #[expect(unsafe_code, reason = "registers of the processor are read in assembly")]
    // SAFETY: reading the stack pointer has no effect.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("mov {}, sp", out(reg) value, options(nomem, nostack, preserves_flags));
        #[cfg(target_arch = "riscv32")]
        asm!("mv {}, sp", out(reg) value, options(nomem, nostack, preserves_flags));
    }
    value
}

/// A word of the stack's memory, painted or not.
fn word(address: usize) -> u32 {
    let value;
    #[expect(unsafe_code, reason = "memory below the stack pointer has no owner to ask")]
    // SAFETY: the address is that of RAM, and a multiple of 4; in assembly, since nothing was ever written there as Rust sees it.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("ldr {}, [{}]", out(reg) value, in(reg) address, options(readonly, nostack, preserves_flags));
        #[cfg(target_arch = "riscv32")]
        asm!("lw {}, 0({})", out(reg) value, in(reg) address, options(readonly, nostack, preserves_flags));
    }
    value
}

#[expect(unsafe_code, reason = "symbols of the linker are foreign")]
// SAFETY: both are symbols of the runtime's linker script; only their addresses are used.
unsafe extern "C" {
    static __sheap: u32;
    static _stack_start: u32;
}

/// First address that is no variable's.
fn lowest() -> usize {
    (&raw const __sheap).addr().next_multiple_of(size_of::<u32>())
}

/// Where the stack begins.
fn highest() -> usize {
    (&raw const _stack_start).addr()
}
