//! The functions of C in double precision, and those that know no precision.

use core::ffi::c_char;

use crate::calls::{self, Header, Outputs};
use crate::controller::Controller;
use crate::params::Params;
use crate::status::{Problem, Status};
use crate::storage::DoubleController;
use crate::values::{Command, Input, Measurement, Output, Signals, Timing};

/// Version of the library, such as "0.1.0".
///
/// @return text that lives as long as the program
#[unsafe(no_mangle)]
pub extern "C" fn mm_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// ABI version that the library was built with, to compare with MM_ABI_VERSION.
///
/// @return the version
#[unsafe(no_mangle)]
pub extern "C" fn mm_abi_version() -> u32 {
    crate::MM_ABI_VERSION
}

/// What a status means, in English.
///
/// @param[in] status  any number
/// @return text that lives as long as the program; "no such status" for a number that is none
#[unsafe(no_mangle)]
pub extern "C" fn mm_status_text(status: i32) -> *const c_char {
    Status::text(status).as_ptr()
}

/// Fills parameters with the robot of the thesis, MM_LAW_BFSMC at 1 kHz and the defaults for these.
///
/// @param[out] params  parameters, all fields
/// @return MM_STATUS_OK, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_params_thesis(params: *mut Params<f64>) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::thesis(params) }
}

/// Fills parameters with what suits a robot, a law and a period: all fields but params.robot, params.law and params.period_s, which are
/// read and have to be set before.
///
/// Gains follow the torque limits and the inertia of the robot; there is no estimator and no supervisor.
///
/// @param[in,out] params   parameters
/// @param[out]    problem  which parameter was refused, or an empty name; may be NULL
/// @return MM_STATUS_OK, a MM_STATUS_PARAMETER_ status, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_params_defaults(params: *mut Params<f64>, problem: *mut Problem) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::defaults(params, problem) }
}

/// Makes a controller of parameters in the caller's memory, whatever was in it.
///
/// Not for the control loop: it takes some hundred updates' time, for the fuzzy system is tabulated and, for MM_LAW_LQR, the Riccati
/// equation solved. On any status but MM_STATUS_OK the memory is as it was.
///
/// @param[out] controller   the caller's memory; need not be cleared
/// @param[in]  size         sizeof(mm_controller)
/// @param[in]  abi_version  MM_ABI_VERSION
/// @param[in]  params       parameters; copied
/// @param[out] problem      which parameter was refused, or an empty name; may be NULL
/// @return MM_STATUS_OK, MM_STATUS_ABI_VERSION, MM_STATUS_STORAGE_SIZE, a MM_STATUS_PARAMETER_ status, MM_STATUS_RICCATI,
///         MM_STATUS_REFUSED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_init(
    controller: *mut DoubleController,
    size: usize,
    abi_version: u32,
    params: *const Params<f64>,
    problem: *mut Problem,
) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::init::<f64>(controller, Header { size, abi_version }, params, problem) }
}

/// Gives a controller other parameters and keeps its memory: integrals, what was learned, estimates, mode.
///
/// What was learned stands for one update under another observer_bandwidth_1_s or robot, and is forgotten by a law that does not learn. Whether it is
/// supervised cannot change. On any status but MM_STATUS_OK it is as it was.
///
/// @param[in,out] controller  an initialized controller
/// @param[in]     params      parameters; copied
/// @param[out]    problem     which parameter was refused, or an empty name; may be NULL
/// @return as mm_controller_init, and MM_STATUS_NOT_INITIALIZED, MM_STATUS_SUPERVISED or MM_STATUS_NOT_SUPERVISED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_retune(
    controller: *mut DoubleController,
    params: *const Params<f64>,
    problem: *mut Problem,
) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::retune::<f64>(controller, params, problem) }
}

/// Forgets everything since the initialization: integrals, what was learned, estimates. A supervised controller runs again, from any mode.
///
/// @param[in,out] controller  an initialized controller
/// @return MM_STATUS_OK, MM_STATUS_NOT_INITIALIZED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_reset(controller: *mut DoubleController) -> Status {
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::reset::<f64>(controller) }
}

/// One update from configuration and velocity: torques to hold for one period.
///
/// Call it once every params.period_s; it has no clock of its own. Cost for MM_LAW_BFSMC: four sine and cosine pairs, about 600
/// multiplications and additions, ten divisions; no loop depends on data. On any status but MM_STATUS_OK the controller and
/// the outputs are as they were, and the caller holds a safe torque of its own choice.
///
/// @param[in,out] controller  an initialized controller without supervisor
/// @param[in]     input       state of the robot and reference at this instant
/// @param[out]    output      torque and flags
/// @param[out]    signals     signals of the law; may be NULL
/// @return MM_STATUS_OK, MM_STATUS_CONFIGURATION_NOT_FINITE, MM_STATUS_VELOCITY_NOT_FINITE, MM_STATUS_REFERENCE_NOT_FINITE,
///         MM_STATUS_OVERFLOW, MM_STATUS_SUPERVISED, MM_STATUS_NOT_INITIALIZED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_update(
    controller: *mut DoubleController,
    input: *const Input<f64>,
    output: *mut Output<f64>,
    signals: *mut Signals<f64>,
) -> Status {
    let outputs = Outputs { output, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::update(controller, input, outputs, Controller::update) }
}

/// The same from measured positions: the estimator finds configuration and velocity first. The first update takes the velocity as zero.
///
/// @param[in,out] controller   an initialized controller with estimator and without supervisor
/// @param[in]     measurement  what the sensors read, and the reference at this instant
/// @param[out]    output       torque and flags
/// @param[out]    signals      signals of the law, with the estimated velocity; may be NULL
/// @return as mm_controller_update, and MM_STATUS_WHEELS_NOT_FINITE or MM_STATUS_NO_ESTIMATOR
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_update_measured(
    controller: *mut DoubleController,
    measurement: *const Measurement<f64>,
    output: *mut Output<f64>,
    signals: *mut Signals<f64>,
) -> Status {
    let outputs = Outputs { output, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::update(controller, measurement, outputs, Controller::update_measured) }
}

/// One update under the supervisor: always a safe torque, whatever the numbers of timing and input are.
///
/// An implausible, late or refused input is no status but a finding: the last torque is held, then the robot brought to rest. A status other
/// than MM_STATUS_OK means that the call itself was wrong.
///
/// @param[in,out] controller  an initialized controller with params.supervised
/// @param[in]     timing      what the clock says
/// @param[in]     input       state of the robot and reference at this instant
/// @param[out]    command     torque, mode, findings, brake
/// @param[out]    signals     signals of the law, written where command.ran is 1; may be NULL
/// @return MM_STATUS_OK, MM_STATUS_NOT_SUPERVISED, MM_STATUS_NOT_INITIALIZED, MM_STATUS_NULL_POINTER or MM_STATUS_MISALIGNED
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_step(
    controller: *mut DoubleController,
    timing: *const Timing<f64>,
    input: *const Input<f64>,
    command: *mut Command<f64>,
    signals: *mut Signals<f64>,
) -> Status {
    let outputs = Outputs { output: command, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::stepped(controller, timing, input, outputs, Controller::step) }
}

/// The same from measured positions.
///
/// @param[in,out] controller   an initialized controller with estimator and params.supervised
/// @param[in]     timing       what the clock says
/// @param[in]     measurement  what the sensors read, and the reference at this instant
/// @param[out]    command      torque, mode, findings, brake
/// @param[out]    signals      signals of the law, written where command.ran is 1; may be NULL
/// @return as mm_controller_step, and MM_STATUS_NO_ESTIMATOR
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_step_measured(
    controller: *mut DoubleController,
    timing: *const Timing<f64>,
    measurement: *const Measurement<f64>,
    command: *mut Command<f64>,
    signals: *mut Signals<f64>,
) -> Status {
    let outputs = Outputs { output: command, signals };
    // SAFETY: the caller's promises are those asked for.
    unsafe { calls::stepped(controller, timing, measurement, outputs, Controller::step_measured) }
}

/// The update of a period in which no input came: to be called from the loop, or from a watchdog, when the period is over.
///
/// @param[in,out] controller  an initialized controller with params.supervised
/// @param[in]     timing      what the clock says; the age is not looked at
/// @param[out]    command     torque, mode, findings, brake
/// @return as mm_controller_step
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mm_controller_missed(
    controller: *mut DoubleController,
    timing: *const Timing<f64>,
    command: *mut Command<f64>,
) -> Status {
    let outputs = Outputs { output: command, signals: core::ptr::null_mut() };
    // SAFETY: the caller's promises are those asked for.
    unsafe {
        calls::step(controller, timing, outputs, |controller, timing| controller.missed(timing.elapsed))
    }
}
