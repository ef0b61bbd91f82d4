//! The functions of C in single precision: those of [`double`](crate::double) with `mmf_` for `mm_`.

use crate::calls::{self, Header, Outputs};
use crate::controller::Controller;
use crate::params::Params;
use crate::status::{Problem, Status};
use crate::storage::SingleController;
use crate::values::{Command, Input, Measurement, Output, Signals, Timing};

/// The same as mm_params_thesis in single precision.
///
/// @copydetails mm_params_thesis
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_params_thesis(params: *mut Params<f32>) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::thesis(params) }
}

/// The same as mm_params_defaults in single precision.
///
/// @copydetails mm_params_defaults
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_params_defaults(params: *mut Params<f32>, problem: *mut Problem) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::defaults(params, problem) }
}

/// The same as mm_controller_init in single precision.
///
/// @copydetails mm_controller_init
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_init(
    controller: *mut SingleController,
    size: usize,
    abi_version: u32,
    params: *const Params<f32>,
    problem: *mut Problem,
) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::init::<f32>(controller, Header { size, abi_version }, params, problem) }
}

/// The same as mm_controller_retune in single precision.
///
/// @copydetails mm_controller_retune
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_retune(
    controller: *mut SingleController,
    params: *const Params<f32>,
    problem: *mut Problem,
) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::retune::<f32>(controller, params, problem) }
}

/// The same as mm_controller_reset in single precision.
///
/// @copydetails mm_controller_reset
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_reset(controller: *mut SingleController) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::reset::<f32>(controller) }
}

/// The same as mm_controller_update in single precision.
///
/// @copydetails mm_controller_update
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_update(
    controller: *mut SingleController,
    input: *const Input<f32>,
    output: *mut Output<f32>,
    signals: *mut Signals<f32>,
) -> Status {
    let outputs = Outputs { output, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::update(controller, input, outputs, Controller::update) }
}

/// The same as mm_controller_update_measured in single precision.
///
/// @copydetails mm_controller_update_measured
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_update_measured(
    controller: *mut SingleController,
    measurement: *const Measurement<f32>,
    output: *mut Output<f32>,
    signals: *mut Signals<f32>,
) -> Status {
    let outputs = Outputs { output, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::update(controller, measurement, outputs, Controller::update_measured) }
}

/// The same as mm_controller_step in single precision.
///
/// @copydetails mm_controller_step
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_step(
    controller: *mut SingleController,
    timing: *const Timing<f32>,
    input: *const Input<f32>,
    command: *mut Command<f32>,
    signals: *mut Signals<f32>,
) -> Status {
    let outputs = Outputs { output: command, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::stepped(controller, timing, input, outputs, Controller::step) }
}

/// The same as mm_controller_step_measured in single precision.
///
/// @copydetails mm_controller_step_measured
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_step_measured(
    controller: *mut SingleController,
    timing: *const Timing<f32>,
    measurement: *const Measurement<f32>,
    command: *mut Command<f32>,
    signals: *mut Signals<f32>,
) -> Status {
    let outputs = Outputs { output: command, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::stepped(controller, timing, measurement, outputs, Controller::step_measured) }
}

/// The same as mm_controller_missed in single precision.
///
/// @copydetails mm_controller_missed
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mmf_controller_missed(
    controller: *mut SingleController,
    timing: *const Timing<f32>,
    command: *mut Command<f32>,
) -> Status {
    let outputs = Outputs { output: command, signals: core::ptr::null_mut() };
    // SAFETY: the caller's promises are those asked for.
    unsafe {
        calls::step(controller, timing, outputs, |controller, timing| controller.missed(timing.elapsed))
    }
}
