//! Pointers of C, checked and turned into values and references: the unsafe code of the crate, but for handing pointers on.

use core::ptr::NonNull;

use crate::controller::{Controller, Scalar};
use crate::params::Params;
use crate::status::Status;
use crate::storage::Held;
use crate::values::{Input, Measurement, Timing};

/// A struct of numbers.
///
/// # Safety
/// Every pattern of bits has to be a value of it: integers and floating-point numbers alone.
pub(crate) unsafe trait Numbers: Copy {}

// SAFETY: all fields are of type T, which is f32 or f64, or integers.
unsafe impl<T: Scalar> Numbers for Input<T> {}
// SAFETY: as above.
unsafe impl<T: Scalar> Numbers for Measurement<T> {}
// SAFETY: as above.
unsafe impl<T: Scalar> Numbers for Timing<T> {}
// SAFETY: as above.
unsafe impl<T: Scalar> Numbers for Params<T> {}

/// A pointer that is neither null nor misaligned.
fn checked<P>(pointer: *mut P) -> Result<NonNull<P>, Status> {
    let pointer = NonNull::new(pointer).ok_or(Status::NullPointer)?;
    if pointer.is_aligned() { Ok(pointer) } else { Err(Status::Misaligned) }
}

/// The value behind a pointer.
///
/// # Safety
/// A pointer that is neither null nor misaligned is valid for reading a `P`, which nobody writes meanwhile.
pub(crate) unsafe fn read<P: Numbers>(pointer: *const P) -> Result<P, Status> {
    let pointer = checked(pointer.cast_mut())?;
    // SAFETY: valid by the caller's promise, aligned as just checked, and any bits are a value by `Numbers`.
    Ok(unsafe { pointer.read() })
}

/// Where a result goes: a pointer that was checked before anything was done.
#[derive(Debug)]
pub(crate) struct Target<P>(NonNull<P>);

impl<P> Target<P> {
    /// The target behind a pointer.
    ///
    /// # Safety
    /// A pointer that is neither null nor misaligned stays valid for writing a `P` until [`put`](Self::put), and nobody else uses what
    /// is behind it meanwhile.
    pub(crate) unsafe fn new(pointer: *mut P) -> Result<Self, Status> {
        checked(pointer).map(Self)
    }

    /// The same for a pointer that may be null, behind which nothing is written then.
    ///
    /// # Safety
    /// As [`new`](Self::new).
    pub(crate) unsafe fn optional(pointer: *mut P) -> Result<Option<Self>, Status> {
        if pointer.is_null() {
            return Ok(None);
        }
        // SAFETY: the same promise.
        unsafe { Self::new(pointer) }.map(Some)
    }

    /// Writes the result; what was there is forgotten.
    pub(crate) fn put(self, value: P) {
        // SAFETY: valid by the promise of `new`, aligned as checked there.
        unsafe { self.0.write(value) }
    }
}

/// The memory for a controller, whatever is in it.
///
/// # Safety
/// As [`Target::new`], for a `T::Storage`.
pub(crate) unsafe fn vacant<T: Scalar>(storage: *mut T::Storage) -> Result<Target<Held<T>>, Status> {
    // The storage is at least as large and as strictly aligned as what is held in it: asserted where they are defined.
    checked(storage).map(|storage| Target(storage.cast()))
}

/// The controller in its memory.
///
/// # Safety
/// A pointer that is neither null nor misaligned is valid for reading and writing a `T::Storage` that nobody else uses while the
/// reference lives; memory that bears the mark of a controller was filled by [`vacant`] and since then only copied.
pub(crate) unsafe fn controller<'a, T: Scalar>(
    storage: *mut T::Storage,
) -> Result<&'a mut Controller<T>, Status> {
    let mut held = checked(storage)?.cast::<Held<T>>();
    // SAFETY: the mark is the first of the storage's integers, aligned and valid for reading.
    let mark = unsafe { held.cast::<u64>().read() };
    if mark != T::MARK {
        return Err(Status::NotInitialized);
    }
    // SAFETY: the mark says that a controller was written here, and nobody else uses it.
    Ok(unsafe { &mut held.as_mut().controller })
}
