//! Registers of peripherals.

use core::fmt;
use core::ptr;

/// A register of 8 or 32 bits.
pub(crate) struct Register<T>(*mut T);

impl<T: Copy> Register<T> {
    /// The register at an address.
    ///
    /// # Safety
    /// There has to be a register of this size, and whatever is written to it must not change memory.
    #[expect(unsafe_code, reason = "an address alone proves nothing")]
    pub(crate) const unsafe fn at(address: usize) -> Self {
        Self(ptr::without_provenance_mut(address))
    }

    /// Its value now.
    #[inline(always)]
    pub(crate) fn read(&self) -> T {
        #[expect(unsafe_code, reason = "registers are read through pointers")]
        // SAFETY: who made it said that there is such a register.
        unsafe {
            self.0.read_volatile()
        }
    }

    /// Writes it.
    #[inline(always)]
    pub(crate) fn write(&self, value: T) {
        #[expect(unsafe_code, reason = "registers are written through pointers")]
        // SAFETY: who made it said that there is such a register.
        unsafe {
            self.0.write_volatile(value);
        }
    }
}

impl<T> fmt::Debug for Register<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:p}", self.0)
    }
}
