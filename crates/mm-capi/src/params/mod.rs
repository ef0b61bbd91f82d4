//! Everything that makes a controller, as structs of C.

mod gains;
mod outer;
mod robot;
mod supervisor;

pub use gains::Gains;
pub use outer::Outer;
pub use robot::{Friction, Link, Robot};
pub use supervisor::Supervisor;

use mm_control::{Estimator as StackEstimator, OuterParams, StackParams, SupervisorParams};
use mm_model::{Real, RobotParams, check};

use crate::kinds::{EstimatorKind, FuzzyEngine, Law};
use crate::status::Refusal;

/// How the velocity is found where only positions are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Estimator<T> {
    /// Cutoff, Hz; below half the update rate. Not looked at for MM_ESTIMATOR_KIND_NONE.
    pub cutoff_hz: T,
    /// Age of a measurement when it is used, s: the estimate is carried forward by it.
    pub delay_s: T,
    /// An mm_estimator_kind.
    pub kind: i32,
}

/// Everything that makes a controller: begin with mm_params_thesis or mm_params_defaults, then change what differs.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Params<T> {
    /// Time between two updates, s.
    pub period_s: T,
    /// The robot.
    pub robot: Robot<T>,
    /// Outer loop and sliding surface.
    pub outer: Outer<T>,
    /// Gains of the inner law.
    pub gains: Gains<T>,
    /// Estimator.
    pub estimator: Estimator<T>,
    /// Supervisor; looked at where supervised is not 0.
    pub supervisor: Supervisor<T>,
    /// Inner law: an mm_law.
    pub law: i32,
    /// Form of its fuzzy system: an mm_fuzzy_engine.
    pub fuzzy_engine: i32,
    /// Not 0: mm_controller_step and its kin work, which always give a safe torque. 0: mm_controller_update and its kin.
    pub supervised: u32,
}

impl<T: Real> Params<T> {
    /// The robot of the thesis with `bfsmc` at 1 kHz, and the defaults for these.
    pub(crate) fn thesis() -> Result<Self, Refusal> {
        let period = T::ONE / T::from_u32(1000);
        Self::defaults(RobotParams::thesis(), Law::Bfsmc as i32, period)
    }

    /// What suits a robot, a law and a period.
    pub(crate) fn defaults(robot: RobotParams<T, 3>, law: i32, period: T) -> Result<Self, Refusal> {
        let kind = Law::of(law)?;
        check::positive(period, "period_s")?;
        let robot = mm_model::Robot::try_new(robot)?;
        Ok(Self {
            period_s: period,
            robot: (*robot.params()).into(),
            outer: OuterParams::for_robot(&robot).into(),
            gains: mm_control::Gains::for_robot(&robot, kind, period).into(),
            estimator: Estimator {
                cutoff_hz: T::from_u32(60).min(T::from_f64(0.1) / period),
                delay_s: T::ZERO,
                kind: EstimatorKind::None as i32,
            },
            supervisor: SupervisorParams::for_robot(&robot, period).into(),
            law,
            fuzzy_engine: FuzzyEngine::Default as i32,
            supervised: 0,
        })
    }

    /// The parameters of the stack.
    pub(crate) fn stack(&self) -> Result<StackParams<T, 3>, Refusal> {
        Ok(StackParams {
            period: self.period_s,
            outer: self.outer.of(),
            gains: self.gains.of(),
            estimator: self.estimator.of()?,
        })
    }
}

impl<T: Real> Estimator<T> {
    fn of(self) -> Result<StackEstimator<T>, Refusal> {
        let cutoff_hz = self.cutoff_hz;
        Ok(match EstimatorKind::of(self.kind)? {
            EstimatorKind::None => StackEstimator::None,
            EstimatorKind::FilteredDifference => StackEstimator::FilteredDifference { cutoff_hz },
            EstimatorKind::Observer => StackEstimator::Observer { cutoff_hz },
        })
    }
}

// The header asserts the same sizes.
const _: () = {
    assert!(size_of::<Robot<f64>>() == 49 * 8 && size_of::<Robot<f32>>() == 49 * 4, "mm_robot");
    assert!(size_of::<Params<f64>>() == 175 * 8 && size_of::<Params<f32>>() == 179 * 4, "mm_params");
};
