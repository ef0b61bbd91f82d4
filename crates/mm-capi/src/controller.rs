//! A controller and its memory: what the caller's storage holds. Safe code alone.

use mm_control::fuzzy::fixed::{SMOOTH_Q15, SMOOTH_SURFACE, THESIS_Q15, THESIS_SURFACE};
use mm_control::fuzzy::{Bundled, Curve, FuzzyError};
use mm_control::laws::{FuzzyTerm, Law as StackLaw};
use mm_control::{
    Command, ControlStack, ControlState, LawKind, Output, SupervisedStack, SupervisedState, Timing,
};
use mm_model::{Real, Robot};

use crate::kinds::{FuzzyEngine, Law};
use crate::params::Params;
use crate::status::{Refusal, Status};
use crate::storage::{DoubleController, SingleController};
use crate::values::{Input, Measurement};

/// A precision of the interface.
pub(crate) trait Scalar: Bundled {
    /// The caller's memory.
    type Storage;
    /// What marks memory as an initialized controller of this precision and ABI version.
    const MARK: u64;
}

impl Scalar for f64 {
    type Storage = DoubleController;
    const MARK: u64 = 0x6d6d_5f64_c0a7_7001 ^ ((crate::MM_ABI_VERSION as u64) << 32);
}

impl Scalar for f32 {
    type Storage = SingleController;
    const MARK: u64 = 0x6d6d_5f66_c0a7_7002 ^ ((crate::MM_ABI_VERSION as u64) << 32);
}

/// A stack with its state, under a supervisor or not.
#[derive(Debug)]
pub(crate) enum Controller<T: Real> {
    Plain { stack: ControlStack<T, 3>, state: ControlState<T, 3> },
    Supervised { stack: SupervisedStack<T, 3>, state: SupervisedState<T, 3> },
}

impl<T: Scalar> Controller<T> {
    /// A controller of a stack and what else the parameters ask for, nothing integrated, learned or measured.
    #[inline(never)]
    pub(crate) fn try_new(stack: &ControlStack<T, 3>, params: &Params<T>) -> Result<Self, Refusal> {
        Ok(if params.supervised == 0 {
            Self::Plain { stack: *stack, state: stack.initial_state() }
        } else {
            let stack = SupervisedStack::try_new(*stack, params.supervisor.of())?;
            Self::Supervised { state: stack.initial_state(), stack }
        })
    }

    /// The same memory under other parameters.
    pub(crate) fn retuned(&self, params: &Params<T>) -> Result<Self, Refusal> {
        Ok(match (Self::try_new(&stack(params)?, params)?, self) {
            (Self::Plain { stack, .. }, Self::Plain { stack: from, state }) => {
                let mut state = *state;
                stack.take_over(&mut state, from);
                Self::Plain { stack, state }
            }
            (Self::Supervised { stack, .. }, Self::Supervised { stack: from, state }) => {
                let mut state = *state;
                stack.take_over(&mut state, from);
                Self::Supervised { stack, state }
            }
            (Self::Plain { .. }, Self::Supervised { .. }) => return Err(Status::Supervised.into()),
            (Self::Supervised { .. }, Self::Plain { .. }) => return Err(Status::NotSupervised.into()),
        })
    }

    pub(crate) fn reset(&mut self) {
        match self {
            Self::Plain { stack, state } => *state = stack.initial_state(),
            Self::Supervised { stack, state } => stack.reset(state),
        }
    }

    pub(crate) fn update(&mut self, input: Input<T>) -> Result<Output<T, 3>, Status> {
        let (stack, state) = self.plain()?;
        Ok(stack.update(state, &input.of())?)
    }

    pub(crate) fn update_measured(&mut self, measurement: Measurement<T>) -> Result<Output<T, 3>, Status> {
        let (stack, state) = self.plain()?;
        Ok(stack.update_measured(state, &measurement.of(), &measurement.reference.of())?)
    }

    pub(crate) fn step(&mut self, timing: Timing<T>, input: Input<T>) -> Result<Command<T, 3>, Status> {
        let (stack, state) = self.supervised()?;
        Ok(stack.update(state, timing, &input.of()))
    }

    pub(crate) fn step_measured(
        &mut self,
        timing: Timing<T>,
        measurement: Measurement<T>,
    ) -> Result<Command<T, 3>, Status> {
        let (stack, state) = self.supervised()?;
        if !stack.stack().estimates() {
            return Err(Status::NoEstimator);
        }
        Ok(stack.update_measured(state, timing, &measurement.of(), &measurement.reference.of()))
    }

    pub(crate) fn missed(&mut self, elapsed: T) -> Result<Command<T, 3>, Status> {
        let (stack, state) = self.supervised()?;
        Ok(stack.missed(state, elapsed))
    }

    const fn plain(&mut self) -> Result<(&ControlStack<T, 3>, &mut ControlState<T, 3>), Status> {
        match self {
            Self::Plain { stack, state } => Ok((stack, state)),
            Self::Supervised { .. } => Err(Status::Supervised),
        }
    }

    const fn supervised(&mut self) -> Result<(&SupervisedStack<T, 3>, &mut SupervisedState<T, 3>), Status> {
        match self {
            Self::Supervised { stack, state } => Ok((stack, state)),
            Self::Plain { .. } => Err(Status::NotSupervised),
        }
    }
}

/// The stack of parameters.
///
/// Out of line, as its parts are: their temporaries, which are large, then do not lie on the stack at the same time.
#[inline(never)]
pub(crate) fn stack<T: Scalar>(params: &Params<T>) -> Result<ControlStack<T, 3>, Refusal> {
    let robot = Robot::try_new(params.robot.of())?;
    let law = law(params, &robot)?;
    let stack = ControlStack::with_law(robot, law, params.stack()?)?;
    Ok(stack.with_delay(params.estimator.delay_s)?)
}

/// The inner law of parameters.
#[inline(never)]
fn law<T: Scalar>(params: &Params<T>, robot: &Robot<T, 3>) -> Result<StackLaw<T, 3>, Refusal> {
    let kind = Law::of(params.law)?;
    let gains = params.gains.of();
    Ok(match term(kind, FuzzyEngine::of(params.fuzzy_engine)?)? {
        Some(term) => StackLaw::with_fuzzy(kind, robot, &gains, term)?,
        None => StackLaw::try_new(kind, robot, &gains)?,
    })
}

/// Half the input range of the bundled systems, and of their outputs, as they were compiled.
const SMOOTH_RANGES: (f64, f64) = (1.0, 4.0 / 3.0);
const THESIS_RANGES: (f64, f64) = (1.4, 1.0);

/// The bundled fuzzy system of a law in the form asked for; none where the law makes its own.
#[inline(never)]
fn term<T: Scalar>(kind: LawKind, engine: FuzzyEngine) -> Result<Option<FuzzyTerm<T>>, Refusal> {
    let (rules, q15, surface, ranges) = match (kind, engine) {
        (_, FuzzyEngine::Default) => return Ok(None),
        (LawKind::Bfsmc, _) => (T::SMOOTH, &SMOOTH_Q15, SMOOTH_SURFACE, SMOOTH_RANGES),
        (LawKind::BfsmcThesis, _) => (T::THESIS, &THESIS_Q15, THESIS_SURFACE, THESIS_RANGES),
        _ => return Err(Refusal::no_such("fuzzy_engine")),
    };
    let (input, output) = (T::from_f64(ranges.0), T::from_f64(ranges.1));
    let (input, output) = ((-input, input), (-output, output));
    let refused = |_: FuzzyError| Refusal::no_such("fuzzy_engine");
    let term = match engine {
        FuzzyEngine::Default | FuzzyEngine::Table => {
            Curve::<T>::try_new(rules).and_then(|curve| FuzzyTerm::table(&curve))
        }
        FuzzyEngine::Exact => FuzzyTerm::rules(rules),
        FuzzyEngine::Q15 => FuzzyTerm::q15(q15, input, output),
        FuzzyEngine::Surface => FuzzyTerm::surface(surface, input, output),
    };
    term.map(Some).map_err(refused)
}
