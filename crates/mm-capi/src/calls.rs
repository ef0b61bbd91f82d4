//! What each function of C does, for both precisions.
//!
//! The order is the same everywhere: pointers, then values, then the controller, and outputs last and only where all went well.

use mm_control::ControlStack;

use crate::MM_ABI_VERSION;
use crate::controller::{self, Controller, Scalar};
use crate::params::Params;
use crate::raw::{self, Target};
use crate::status::{Problem, Refusal, Status};
use crate::storage::Held;
use crate::values::{Command, Output, Signals, Timing};

/// The status of a call.
fn status(result: Result<(), Status>) -> Status {
    result.err().unwrap_or(Status::Ok)
}

/// The status of a call that may have a problem with a parameter, which it tells.
fn told(problem: Option<Target<Problem>>, result: Result<(), Refusal>) -> Status {
    let refusal = result.err().unwrap_or(Refusal::from(Status::Ok));
    if let Some(problem) = problem {
        problem.put(refusal.problem());
    }
    refusal.status
}

/// # Safety
/// `params` is null or valid for writing.
pub(crate) unsafe fn thesis<T: Scalar>(params: *mut Params<T>) -> Status {
    status((|| {
        // SAFETY: the caller's promise.
        let target = unsafe { Target::new(params) }?;
        target.put(Params::thesis().map_err(|refusal| refusal.status)?);
        Ok(())
    })())
}

/// # Safety
/// `params` is null or valid for reading and writing, `problem` null or valid for writing.
pub(crate) unsafe fn defaults<T: Scalar>(params: *mut Params<T>, problem: *mut Problem) -> Status {
    // SAFETY: the caller's promise.
    let problem = match unsafe { Target::optional(problem) } {
        Ok(problem) => problem,
        Err(status) => return status,
    };
    let filled = (|| {
        // SAFETY: the caller's promise.
        let given = unsafe { raw::read(params) }?;
        // SAFETY: as above.
        let target = unsafe { Target::new(params) }?;
        target.put(Params::defaults(given.robot.of(), given.law, given.period_s)?);
        Ok(())
    })();
    told(problem, filled)
}

/// What the caller says of its header.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Header {
    pub(crate) size: usize,
    pub(crate) abi_version: u32,
}

impl Header {
    const fn check<T: Scalar>(self) -> Result<(), Status> {
        if self.abi_version != MM_ABI_VERSION {
            return Err(Status::AbiVersion);
        }
        if self.size != size_of::<T::Storage>() {
            return Err(Status::StorageSize);
        }
        Ok(())
    }
}

/// # Safety
/// Each pointer is null or valid; `storage` is not used by anybody else meanwhile.
pub(crate) unsafe fn init<T: Scalar>(
    storage: *mut T::Storage,
    header: Header,
    params: *const Params<T>,
    problem: *mut Problem,
) -> Status {
    // SAFETY: the caller's promise.
    let problem = match unsafe { Target::optional(problem) } {
        Ok(problem) => problem,
        Err(status) => return status,
    };
    let made = (|| {
        header.check::<T>()?;
        // SAFETY: the caller's promise.
        let place = unsafe { raw::vacant::<T>(storage) }?;
        // SAFETY: as above.
        let params = unsafe { raw::read(params) }?;
        fill(place, &params)
    })();
    told(problem, made)
}

/// Makes the controller of parameters in its place; two steps out of line for the sake of the stack.
#[inline(never)]
fn fill<T: Scalar>(place: Target<Held<T>>, params: &Params<T>) -> Result<(), Refusal> {
    finish(place, &controller::stack(params)?, params)
}

#[inline(never)]
fn finish<T: Scalar>(
    place: Target<Held<T>>,
    stack: &ControlStack<T, 3>,
    params: &Params<T>,
) -> Result<(), Refusal> {
    place.put(Held { mark: T::MARK, controller: Controller::try_new(stack, params)? });
    Ok(())
}

/// # Safety
/// Each pointer is null or valid; `storage` is not used by anybody else meanwhile.
pub(crate) unsafe fn retune<T: Scalar>(
    storage: *mut T::Storage,
    params: *const Params<T>,
    problem: *mut Problem,
) -> Status {
    // SAFETY: the caller's promise.
    let problem = match unsafe { Target::optional(problem) } {
        Ok(problem) => problem,
        Err(status) => return status,
    };
    let made = (|| {
        // SAFETY: the caller's promise.
        let params = unsafe { raw::read(params) }?;
        // SAFETY: as above.
        let controller = unsafe { raw::controller::<T>(storage) }?;
        *controller = controller.retuned(&params)?;
        Ok(())
    })();
    told(problem, made)
}

/// # Safety
/// `storage` is null or valid, and not used by anybody else meanwhile.
pub(crate) unsafe fn reset<T: Scalar>(storage: *mut T::Storage) -> Status {
    // SAFETY: the caller's promise.
    status(unsafe { raw::controller::<T>(storage) }.map(Controller::reset))
}

/// Where an update writes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outputs<T, O> {
    pub(crate) output: *mut O,
    /// May be null.
    pub(crate) signals: *mut Signals<T>,
}

/// The same, checked.
type Targets<T, O> = (Target<O>, Option<Target<Signals<T>>>);

impl<T: Scalar, O> Outputs<T, O> {
    /// # Safety
    /// As [`Target::new`], for both.
    unsafe fn checked(self) -> Result<Targets<T, O>, Status> {
        // SAFETY: the caller's promise.
        let output = unsafe { Target::new(self.output) }?;
        // SAFETY: as above.
        let signals = unsafe { Target::optional(self.signals) }?;
        Ok((output, signals))
    }
}

/// # Safety
/// Each pointer is null or valid; `storage` is not used by anybody else meanwhile.
pub(crate) unsafe fn update<T: Scalar, I: raw::Numbers>(
    storage: *mut T::Storage,
    input: *const I,
    outputs: Outputs<T, Output<T>>,
    run: impl FnOnce(&mut Controller<T>, I) -> Result<mm_control::Output<T, 3>, Status>,
) -> Status {
    status((|| {
        // SAFETY: the caller's promise.
        let input = unsafe { raw::read(input) }?;
        // SAFETY: as above.
        let (target, signals) = unsafe { outputs.checked() }?;
        // SAFETY: as above.
        let output = run(unsafe { raw::controller::<T>(storage) }?, input)?;
        target.put((&output).into());
        if let Some(signals) = signals {
            signals.put((&output.signals).into());
        }
        Ok(())
    })())
}

/// # Safety
/// Each pointer is null or valid; `storage` is not used by anybody else meanwhile.
pub(crate) unsafe fn step<T: Scalar>(
    storage: *mut T::Storage,
    timing: *const Timing<T>,
    outputs: Outputs<T, Command<T>>,
    run: impl FnOnce(&mut Controller<T>, mm_control::Timing<T>) -> Result<mm_control::Command<T, 3>, Status>,
) -> Status {
    status((|| {
        // SAFETY: the caller's promise.
        let timing = unsafe { raw::read(timing) }?;
        // SAFETY: as above.
        let (target, signals) = unsafe { outputs.checked() }?;
        let timing = mm_control::Timing { elapsed: timing.elapsed_s, age: timing.age_s };
        // SAFETY: as above.
        let command = run(unsafe { raw::controller::<T>(storage) }?, timing)?;
        target.put((&command).into());
        if let (Some(signals), Some(output)) = (signals, &command.output) {
            signals.put((&output.signals).into());
        }
        Ok(())
    })())
}

/// An input that a step needs besides its timing.
///
/// # Safety
/// As [`raw::read`].
pub(crate) unsafe fn stepped<T: Scalar, I: raw::Numbers>(
    storage: *mut T::Storage,
    timing: *const Timing<T>,
    input: *const I,
    outputs: Outputs<T, Command<T>>,
    run: impl FnOnce(&mut Controller<T>, mm_control::Timing<T>, I) -> Result<mm_control::Command<T, 3>, Status>,
) -> Status {
    // SAFETY: the caller's promise.
    match unsafe { raw::read(input) } {
        // SAFETY: as above.
        Ok(input) => unsafe {
            step(storage, timing, outputs, |controller, timing| run(controller, timing, input))
        },
        Err(status) => status,
    }
}
