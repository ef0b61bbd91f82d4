//! Status codes, their texts, and which parameter was refused.

use core::ffi::{CStr, c_char};

use mm_control::{ControlError, SetupError};
use mm_model::ParamError;

/// Bytes of a parameter's name, with the zero at its end.
pub const MM_NAME_SIZE: usize = 48;

/// How a call ended. After anything but MM_STATUS_OK outputs and controller are as they were before the call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A pointer that must not be null is null.
    NullPointer = 1,
    /// A pointer is not aligned for what it points at.
    Misaligned = 2,
    /// The caller was compiled with a header of another ABI version.
    AbiVersion = 3,
    /// The caller's controller has another size than the library's.
    StorageSize = 4,
    /// The storage holds no controller of this precision: never initialized, cleared, or something else.
    NotInitialized = 5,
    /// A supervised controller was given to an unsupervised call; see mm_controller_step.
    Supervised = 6,
    /// An unsupervised controller was given to a supervised call; see mm_params.supervised.
    NotSupervised = 7,
    /// A measurement was given to a controller without estimator; see mm_estimator.kind.
    NoEstimator = 8,
    /// A number of the configuration is infinite or NaN.
    ConfigurationNotFinite = 16,
    /// A number of the velocity is infinite or NaN.
    VelocityNotFinite = 17,
    /// A number of the reference is infinite or NaN.
    ReferenceNotFinite = 18,
    /// A wheel angle is infinite or NaN.
    WheelsNotFinite = 19,
    /// The torque or the controller's memory would be infinite or NaN: an input is far beyond any robot.
    Overflow = 20,
    /// A parameter is infinite or NaN.
    ParameterNotFinite = 32,
    /// A parameter has to be above zero.
    ParameterNotPositive = 33,
    /// A parameter has to be zero or above.
    ParameterNegative = 34,
    /// A parameter lies outside its range, or is no kind that there is.
    ParameterOutOfRange = 35,
    /// The lower bound of a parameter is not below the upper one.
    ParameterInverted = 36,
    /// For want of an inertia the mass matrix would not be positive definite.
    ParameterNotPositiveDefinite = 37,
    /// The Riccati equation of MM_LAW_LQR was not solved: acceptable values too far apart.
    Riccati = 38,
    /// The parameters were refused for another reason.
    Refused = 39,
}

/// Every status with its text.
const TEXTS: [(Status, &CStr); 22] = [
    (Status::Ok, c"done"),
    (Status::NullPointer, c"a pointer is null"),
    (Status::Misaligned, c"a pointer is misaligned"),
    (Status::AbiVersion, c"header and library have different ABI versions"),
    (Status::StorageSize, c"header and library disagree on the size of a controller"),
    (Status::NotInitialized, c"the storage holds no initialized controller of this precision"),
    (Status::Supervised, c"the controller is supervised: use the step calls"),
    (Status::NotSupervised, c"the controller has no supervisor: use the update calls"),
    (Status::NoEstimator, c"the controller has no estimator: it cannot take a measurement alone"),
    (Status::ConfigurationNotFinite, c"the configuration is infinite or not a number"),
    (Status::VelocityNotFinite, c"the velocity is infinite or not a number"),
    (Status::ReferenceNotFinite, c"the reference is infinite or not a number"),
    (Status::WheelsNotFinite, c"a wheel angle is infinite or not a number"),
    (Status::Overflow, c"the torque overflowed: an input is far beyond any robot"),
    (Status::ParameterNotFinite, c"the parameter must be a finite number"),
    (Status::ParameterNotPositive, c"the parameter must be above zero"),
    (Status::ParameterNegative, c"the parameter must be zero or above"),
    (Status::ParameterOutOfRange, c"the parameter must lie in its documented range"),
    (Status::ParameterInverted, c"the parameter must have its lower bound below its upper bound"),
    (
        Status::ParameterNotPositiveDefinite,
        c"the parameter must be above zero for a positive definite mass matrix",
    ),
    (Status::Riccati, c"the Riccati equation was not solved: acceptable values too far apart"),
    (Status::Refused, c"the parameters were refused"),
];

impl Status {
    /// The text of a number, which need not be a status.
    pub(crate) fn text(status: i32) -> &'static CStr {
        let found = TEXTS.iter().find(|(known, _)| *known as i32 == status);
        found.map_or(c"no such status", |(_, text)| text)
    }
}

/// Which parameter was refused. Empty where none is to blame.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Problem {
    /// Name of the field, as in the structs below and in scenario files; it ends with a zero. Fields of links carry no link number.
    pub parameter: [c_char; MM_NAME_SIZE],
}

/// Why parameters were refused, and which.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Refusal {
    pub(crate) status: Status,
    pub(crate) parameter: &'static str,
}

impl Refusal {
    /// A number that is no kind that there is.
    pub(crate) const fn no_such(parameter: &'static str) -> Self {
        Self { status: Status::ParameterOutOfRange, parameter }
    }

    /// The name for C, cut to its room.
    pub(crate) fn problem(self) -> Problem {
        let mut parameter = [0; MM_NAME_SIZE];
        for (slot, byte) in parameter.iter_mut().take(MM_NAME_SIZE - 1).zip(self.parameter.bytes()) {
            *slot = c_char::from_ne_bytes([byte]);
        }
        Problem { parameter }
    }
}

impl From<Status> for Refusal {
    fn from(status: Status) -> Self {
        Self { status, parameter: "" }
    }
}

impl From<ParamError> for Refusal {
    fn from(error: ParamError) -> Self {
        let status = match error {
            ParamError::NonFinite(_) => Status::ParameterNotFinite,
            ParamError::NonPositive(_) => Status::ParameterNotPositive,
            ParamError::Negative(_) => Status::ParameterNegative,
            ParamError::OutOfRange(_) => Status::ParameterOutOfRange,
            ParamError::Inverted(_) => Status::ParameterInverted,
            ParamError::NotPositiveDefinite(_) => Status::ParameterNotPositiveDefinite,
            _ => Status::Refused,
        };
        // The stack calls the period after its key in a scenario.
        let parameter = match error.parameter() {
            "control_period_s" => "period_s",
            name => name,
        };
        Self { status, parameter }
    }
}

impl From<SetupError> for Refusal {
    fn from(error: SetupError) -> Self {
        match error {
            SetupError::Param(error) => error.into(),
            SetupError::Fuzzy(_) => Self { status: Status::Refused, parameter: "fuzzy_engine" },
            SetupError::Riccati => Status::Riccati.into(),
            _ => Status::Refused.into(),
        }
    }
}

impl From<ControlError> for Status {
    fn from(error: ControlError) -> Self {
        match error {
            ControlError::NonFinite("configuration") => Self::ConfigurationNotFinite,
            ControlError::NonFinite("velocity") => Self::VelocityNotFinite,
            ControlError::NonFinite("reference") => Self::ReferenceNotFinite,
            ControlError::NonFinite("wheel angles") => Self::WheelsNotFinite,
            ControlError::NoEstimator => Self::NoEstimator,
            _ => Self::Overflow,
        }
    }
}
