//! A place for a variable that lives as long as the program and is made when it runs.

use core::cell::{Cell, UnsafeCell};
use core::mem::MaybeUninit;

/// Memory for one value, filled once: what is large belongs there, not on the stack.
#[derive(Debug)]
pub struct Place<T> {
    taken: Cell<bool>,
    value: UnsafeCell<MaybeUninit<T>>,
}

#[expect(unsafe_code, reason = "a static has to be shared between threads, of which there is one")]
// SAFETY: the programs here have one thread and no interrupt; the flag lets one call alone get hold of the value.
unsafe impl<T> Sync for Place<T> {}

impl<T> Place<T> {
    /// An empty place.
    #[must_use]
    pub const fn new() -> Self {
        Self { taken: Cell::new(false), value: UnsafeCell::new(MaybeUninit::uninit()) }
    }

    /// Fills the place and hands it out; none where that was done before.
    #[expect(clippy::mut_from_ref, reason = "it is handed out once: the flag sees to that")]
    #[inline(always)]
    pub fn fill(&'static self, value: T) -> Option<&'static mut T> {
        if self.taken.replace(true) {
            return None;
        }
        #[expect(unsafe_code, reason = "the only reference to what the place holds is made here")]
        // SAFETY: the flag was false, so that nobody has or gets another reference; the place is valid for as long as the program.
        let place = unsafe { &mut *self.value.get() };
        Some(place.write(value))
    }
}

impl<T> Default for Place<T> {
    fn default() -> Self {
        Self::new()
    }
}
