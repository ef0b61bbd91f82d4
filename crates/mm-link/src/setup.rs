//! Everything that makes a supervised stack, as a message: what a target needs to know to compute the host's torques.

use mm_control::fuzzy::fixed::{SMOOTH_Q15, SMOOTH_SURFACE, THESIS_Q15, THESIS_SURFACE};
use mm_control::fuzzy::{Bundled, Curve, FuzzyError};
use mm_control::laws::FuzzyTerm;
use mm_control::{
    ControlStack, Estimator, Gains, Law, LawKind, OuterParams, SetupError, StackParams, SupervisedStack,
    SupervisorParams,
};
use mm_model::{Robot, RobotParams};
use serde::{Deserialize, Serialize};

use crate::Scalar;

/// How the law's own rule base is evaluated; without meaning for laws that have none.
///
/// The rule bases are those of the crate `mm-control`, smooth for `bfsmc` and the thesis's for `bfsmc-thesis`: their tables are in
/// the target's flash and do not travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Fuzzy {
    /// As the law does unless told otherwise.
    #[default]
    Own,
    /// Linear between 65 knots.
    Table,
    /// By the rules with the exact centroid.
    Rules,
    /// By the rules in whole numbers of 16 bits.
    Q15,
    /// By the compiled table of whole numbers.
    Surface,
}

/// Whose clock decides that an input is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Pace {
    /// The host's: time stands still between two ticks, however long they take to come. Ticks that were left out count as missed
    /// when the next one comes.
    #[default]
    Lockstep,
    /// The target's: a period and a half without a tick is a missed one, and every period after that.
    RealTime,
}

/// A supervised stack, not yet checked.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar", deserialize = "T: Scalar"))]
pub struct Setup<T> {
    /// Inner law.
    pub law: LawKind,
    /// How its rule base is evaluated.
    pub fuzzy: Fuzzy,
    /// Whose clock counts.
    pub pace: Pace,
    /// Robot that the controller believes in.
    pub robot: RobotParams<T, 3>,
    /// Period, outer loop, gains and estimator.
    pub stack: StackParams<T, 3>,
    /// Age of the measurements that the stack is built for, s.
    pub delay: T,
    /// Limits of plausibility.
    pub supervisor: SupervisorParams<T, 3>,
}

impl<T: Scalar> Setup<T> {
    /// The setup of a robot with the gains and limits that follow from it, for a caller that knows the velocity.
    ///
    /// # Errors
    /// The first parameter of the robot that does not work, by name.
    pub fn for_robot(robot: RobotParams<T, 3>, law: LawKind, period: T) -> Result<Self, SetupError> {
        let checked = Robot::try_new(robot)?;
        let stack = StackParams {
            period,
            outer: OuterParams::for_robot(&checked),
            gains: Gains::for_robot(&checked, law, period),
            estimator: Estimator::None,
        };
        let supervisor = SupervisorParams::for_robot(&checked, period);
        let (fuzzy, pace) = (Fuzzy::default(), Pace::default());
        Ok(Self { law, fuzzy, pace, robot, stack, delay: T::ZERO, supervisor })
    }

    /// Checks everything and makes the stack.
    ///
    /// # Errors
    /// The first parameter that does not work, by name.
    #[inline]
    pub fn build(&self) -> Result<SupervisedStack<T, 3>, SetupError> {
        SupervisedStack::try_new(self.control_stack()?, self.supervisor)
    }

    // Each part in a function of its own, so that the stack of a small machine holds few of them at a time.

    /// The stack alone, without the supervisor.
    ///
    /// # Errors
    /// The first parameter that does not work, by name.
    #[inline(never)]
    pub fn control_stack(&self) -> Result<ControlStack<T, 3>, SetupError> {
        let robot = Robot::try_new(self.robot)?;
        let stack = ControlStack::with_law(robot, self.inner(&robot)?, self.stack)?;
        stack.with_delay(self.delay)
    }

    #[inline(never)]
    fn inner(&self, robot: &Robot<T, 3>) -> Result<Law<T, 3>, SetupError> {
        match self.term()? {
            Some(term) => Law::with_fuzzy(self.law, robot, &self.stack.gains, term),
            None => Law::try_new(self.law, robot, &self.stack.gains),
        }
    }

    /// The fuzzy term asked for; none where the law keeps its own, or has none.
    #[inline(never)]
    fn term(&self) -> Result<Option<FuzzyTerm<T>>, FuzzyError> {
        let is_smooth = match self.law {
            LawKind::Bfsmc => true,
            LawKind::BfsmcThesis => false,
            _ => return Ok(None),
        };
        let (rules, q15, surface) = if is_smooth {
            (<T as Bundled>::SMOOTH, &SMOOTH_Q15, SMOOTH_SURFACE)
        } else {
            (<T as Bundled>::THESIS, &THESIS_Q15, THESIS_SURFACE)
        };
        let [(input, output)] = match (rules.inputs, rules.outputs) {
            ([input], [output]) => [(input.range, output.range)],
            _ => return Err(FuzzyError::Length("inputs")),
        };
        Ok(Some(match self.fuzzy {
            Fuzzy::Own => return Ok(None),
            Fuzzy::Table => FuzzyTerm::table(&Curve::<T>::try_new(rules)?)?,
            Fuzzy::Rules => FuzzyTerm::rules(rules)?,
            Fuzzy::Q15 => FuzzyTerm::q15(q15, input, output)?,
            Fuzzy::Surface => FuzzyTerm::surface(surface, input, output)?,
        }))
    }
}
