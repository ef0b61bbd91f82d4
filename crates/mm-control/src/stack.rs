//! The control stack: one call from measurement and reference to torques, the same for every user.

mod checks;
mod state;
mod supervised;
mod take_over;

use mm_model::{Configuration, Mechanism, Real, Robot, SinesOf, Velocity, check};

use self::checks::{check_rates, supervise};
pub use self::state::{ControlState, StackParams};
use crate::estimator::{Measurement, Memory, Stage};
use crate::fuzzy::Bundled;
use crate::laws::{Drive, FuzzyTerm, Gains, InnerLaw, Law, LawMemory, Tracking};
use crate::observer::{MomentumObserver, ObserverState};
use crate::outer::{OuterLoop, OuterOutput};
use crate::{ControlError, Input, Output, Reference, SetupError, Signals, Status};

/// Estimator, supervisor, outer loop, inner loop and limits, in this order.
///
/// ```text
/// q, nu --estimator--> supervisor --> outer loop --nu_c--> inner loop --tau--> limits --> torque
///        (update_measured) (checks)  K, W, z, J#      s, M, C, g, law, d_hat
/// ```
/// [`update`](Self::update) takes (q, nu) from its caller, [`update_measured`](Self::update_measured) estimates them from measured
/// positions; what follows is the same.
///
/// Inner loop (4.14 to 4.44, errors actual minus desired): with nu_r = nu_c - c integral(nu - nu_c) and s = nu - nu_r,
///
/// ```text
/// f = M nu_r' + C nu_r + g + friction + law(s) - d_hat,   tau = B^-1 f, then the limits
/// ```
/// C is the matrix with dM/dt - 2C skew, and it multiplies nu_r, as the proof (4.40) needs it; (4.29) prints nu. All parameters are in
/// `self`, all memory in [`ControlState`]: retuning is another stack that [takes over](Self::take_over) the same state.
///
/// # Examples
/// ```
/// use mm_control::{ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, StackParams};
/// use mm_model::{Configuration, Robot, RobotParams, Velocity};
/// use nalgebra::Vector3;
///
/// let robot = Robot::try_new(RobotParams::<f64, 3>::thesis())?;
/// let period = 1e-3;
/// let gains = Gains::for_robot(&robot, LawKind::Bfsmc, period);
/// let params = StackParams { period, outer: OuterParams::default(), gains, estimator: Estimator::None };
/// let stack = ControlStack::try_new(robot, LawKind::Bfsmc, params)?;
/// let mut state = stack.initial_state();
///
/// // At rest in the rest posture, with the tip where it should be, only gravity is held.
/// let q = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
/// let position = robot.tip_position(&q);
/// let reference = Reference { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
/// let output = stack.update(&mut state, &Input { q, nu: Velocity::zero(), reference })?;
/// assert!((output.torque.joints[1] - 9.81 * (5.0 * 0.5 + 2.0 * 0.5)).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlStack<T: Real, const N: usize, L = Law<T, N>> {
    robot: Robot<T, N>,
    outer: OuterLoop<T, N>,
    law: L,
    observer: Option<MomentumObserver<T, N>>,
    gains: Gains<T, N>,
    period: T,
    estimator: Stage<T>,
}

impl<T: Real, const N: usize> ControlStack<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// A stack of checked parameters around one of the laws.
    ///
    /// # Errors
    /// The first parameter that does not work, by name.
    pub fn try_new(
        robot: Robot<T, N>,
        kind: crate::LawKind,
        params: StackParams<T, N>,
    ) -> Result<Self, SetupError>
    where
        T: Bundled,
    {
        let law = Law::try_new(kind, &robot, &params.gains)?;
        Self::with_law(robot, law, params)
    }

    /// A stack around a law that has a fuzzy system, with one of the caller's own.
    ///
    /// # Errors
    /// The first parameter that does not work, by name, or the fuzzy system; see [`Law::with_fuzzy`].
    pub fn with_fuzzy(
        robot: Robot<T, N>,
        kind: crate::LawKind,
        term: FuzzyTerm<T>,
        params: StackParams<T, N>,
    ) -> Result<Self, SetupError> {
        let law = Law::with_fuzzy(kind, &robot, &params.gains, term)?;
        Self::with_law(robot, law, params)
    }
}

impl<T: Real, const N: usize, L: InnerLaw<T, N>> ControlStack<T, N, L>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// A stack around one law of a type known beforehand, one of [`laws`](crate::laws) or the caller's own: nothing of the others is linked.
    ///
    /// # Errors
    /// The first parameter that does not work, by name.
    pub fn with_law(robot: Robot<T, N>, law: L, params: StackParams<T, N>) -> Result<Self, SetupError> {
        let StackParams { period, outer, gains, estimator } = params;
        check::positive(period, "control_period_s")?;
        gains.check()?;
        let estimator = Stage::try_new(estimator, period)?;
        let learns = law.learns() && gains.observer_bandwidth > T::ZERO;
        let bandwidth = if learns { gains.observer_bandwidth } else { T::ZERO };
        let outer = outer.checked()?;
        check_rates(period, bandwidth, &outer)?;
        let half_range = robot.params().limits.joints.iter().fold(None, |least: Option<T>, (lo, hi)| {
            let half = (*hi - *lo) * T::HALF;
            Some(least.map_or(half, |other| other.min(half)))
        });
        if half_range.is_some_and(|half| outer.joint_limit_margin > half) {
            return Err(mm_model::ParamError::OutOfRange("joint_limit_margin_rad").into());
        }
        let observer = learns.then_some(MomentumObserver {
            bandwidth: gains.observer_bandwidth,
            limit: gains.learning_limit,
            period,
        });
        let outer = OuterLoop::new(outer, &robot.params().limits, period);
        Ok(Self { robot, outer, law, observer, gains, period, estimator })
    }

    /// The same stack for measurements that are `delay` s old when they are used: the estimated configuration is carried forward
    /// by that time at the estimated velocity. Without an estimator it has no effect.
    ///
    /// # Errors
    /// A delay that is negative, infinite or NaN: `delay_s`.
    pub fn with_delay(mut self, delay: T) -> Result<Self, SetupError> {
        self.estimator = self.estimator.with_delay(delay)?;
        Ok(self)
    }

    /// The state before the first update: nothing integrated, nothing learned, nothing measured.
    #[must_use]
    pub fn initial_state(&self) -> ControlState<T, N> {
        ControlState {
            integral: Velocity::zero(),
            observer: ObserverState::initial(),
            memory: LawMemory::None,
            held: false,
            updates: 0,
            estimator: Memory::initial(),
        }
    }

    /// Whether the stack estimates: whether [`update_measured`](Self::update_measured) works.
    #[must_use]
    pub const fn estimates(&self) -> bool {
        self.estimator.is_some()
    }

    /// The robot that the controller believes in.
    #[must_use]
    pub const fn robot(&self) -> &Robot<T, N> {
        &self.robot
    }

    /// The outer loop.
    #[must_use]
    pub const fn outer(&self) -> &OuterLoop<T, N> {
        &self.outer
    }

    /// The inner law.
    #[must_use]
    pub const fn law(&self) -> &L {
        &self.law
    }

    /// Whether a disturbance is learned.
    #[must_use]
    pub const fn learns(&self) -> bool {
        self.observer.is_some()
    }

    /// The inner gains.
    #[must_use]
    pub const fn gains(&self) -> &Gains<T, N> {
        &self.gains
    }

    /// Whether another stack computes the same from the same state, whatever gains it was given that its law does not use.
    #[must_use]
    pub fn acts_as(&self, other: &Self) -> bool
    where
        L: PartialEq,
    {
        let Self { robot, outer, law, observer, gains: _, period, estimator } = self;
        (robot, outer, law, observer) == (&other.robot, &other.outer, &other.law, &other.observer)
            && (period, estimator) == (&other.period, &other.estimator)
    }

    /// One update: torques to hold for one period.
    ///
    /// Cost for N = 3 and `bfsmc`: four sine/cosine pairs, about 600 multiplications and additions, ten divisions, five table lookups;
    /// no allocation, no loop whose length depends on data.
    ///
    /// # Errors
    /// An input that is not finite, or a torque or a state that would not be; the state is then as before the call, and the
    /// caller holds a safe command.
    #[inline]
    pub fn update(
        &self,
        state: &mut ControlState<T, N>,
        input: &Input<T, N>,
    ) -> Result<Output<T, N>, ControlError> {
        supervise(input)?;
        self.control(state, input, &self.robot.sines(&input.q))
    }

    /// The same update for a caller that knows the sines of `input.q` already, as a simulator does: the same bits.
    ///
    /// The sines must be those of `input.q` ([`Robot::sines`]); with others the torques are wrong.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    #[inline]
    pub fn update_with_sines(
        &self,
        state: &mut ControlState<T, N>,
        input: &Input<T, N>,
        sines: &SinesOf<T, N>,
    ) -> Result<Output<T, N>, ControlError> {
        supervise(input)?;
        self.control(state, input, sines)
    }

    /// The same update from measured positions: the estimator finds configuration and velocity first.
    ///
    /// The first update of a state has no difference to form and takes the velocity as zero. Cost besides
    /// [`update`](Self::update): two or three sine/cosine pairs and about 100 multiplications and additions, 300 for the observer.
    ///
    /// # Errors
    /// [`ControlError::NoEstimator`] for a stack with [`Estimator::None`](crate::Estimator::None); else as [`update`](Self::update). The state is then as
    /// before the call.
    #[inline]
    pub fn update_measured(
        &self,
        state: &mut ControlState<T, N>,
        measurement: &Measurement<T, N>,
        reference: &Reference<T>,
    ) -> Result<Output<T, N>, ControlError> {
        self.update_measured_if(state, measurement, reference, |_| true)
    }

    /// Outer loop, inner loop and limits.
    #[inline(always)]
    pub(crate) fn control(
        &self,
        state: &mut ControlState<T, N>,
        input: &Input<T, N>,
        sines: &SinesOf<T, N>,
    ) -> Result<Output<T, N>, ControlError> {
        let Input { q, nu, reference } = input;
        let robot = &self.robot;
        let outer = self.outer.evaluate(robot, (q, sines), nu, reference, state.updates);

        let c = self.outer.params().sliding_gain;
        let lag = nu.minus(outer.nu_c);
        let nu_r = outer.nu_c.minus(c.zip(state.integral, |c, i| c * i));
        let dnu_r = outer.dnu_c.minus(c.zip(lag, |c, e| c * e));

        let inertia = robot.inertia(&sines.posture);
        let friction = robot.friction(nu);
        let lag_integral = state.integral;
        let at = Tracking {
            robot,
            posture: &sines.posture,
            inertia: &inertia,
            nu,
            dnu_c: &outer.dnu_c,
            lag,
            lag_integral: &lag_integral,
            nu_r,
            dnu_r,
            sliding: nu.minus(nu_r),
            friction,
            load: robot.gravity(&inertia).plus(friction),
            period: self.period,
        };
        match self.law.switching_force(&at.sliding) {
            Some(robust) => self.settle(state, &input.q, &outer, &at, at.switching(robust)),
            None => self.settle_model_based(state, &input.q, &outer, &at),
        }
    }

    /// The laws that are no function of s alone, out of the way of those that are.
    #[inline(never)]
    fn settle_model_based(
        &self,
        state: &mut ControlState<T, N>,
        q: &Configuration<T, N>,
        outer: &OuterOutput<T, N>,
        at: &Tracking<'_, T, N>,
    ) -> Result<Output<T, N>, ControlError> {
        let drive = self.law.drive(at, &state.memory);
        self.settle(state, q, outer, at, drive)
    }

    /// Learned part, limits and the state after the update.
    #[inline(always)]
    fn settle(
        &self,
        state: &mut ControlState<T, N>,
        q: &Configuration<T, N>,
        outer: &OuterOutput<T, N>,
        at: &Tracking<'_, T, N>,
        drive: Drive<T, N>,
    ) -> Result<Output<T, N>, ControlError> {
        let Tracking { robot, inertia, nu, lag, .. } = at;
        let mut observer = state.observer;
        if let Some(learning) = &self.observer {
            observer = learning.learn(&state.observer, &robot.mass_product(inertia, nu), state.held);
        }
        let force = drive.force.minus(*observer.learned());
        let commanded = robot.torque_of(&force);
        let (torque, saturated) = robot.limit_torque(&commanded);
        if !(commanded.is_finite()) {
            return Err(ControlError::Overflow);
        }
        if let Some(learning) = &self.observer {
            let own = robot.coriolis_transpose_product(inertia, nu).minus(at.load);
            learning.account(&mut observer, &robot.force_of(&torque).plus(own));
        }
        let integral = if saturated { state.integral } else { state.integral.plus(lag.scaled(self.period)) };
        let is_finite = drive.memory.as_ref().is_none_or(LawMemory::is_finite);
        if !(integral.is_finite() && observer.is_finite() && is_finite) {
            return Err(ControlError::Overflow);
        }
        if let (Some(memory), false) = (drive.memory, saturated) {
            state.memory = memory;
        }
        state.updates = state.updates.saturating_add(1);
        (state.integral, state.observer, state.held) = (integral, observer, saturated);
        Ok(Output {
            torque,
            status: Status {
                saturated,
                near_singular: outer.near_singular,
                speed_limited: outer.speed_limited,
                joint_limited: outer.joint_limited,
                beyond_joint_limit: !robot.within_joint_limits(&q.joints),
            },
            signals: Signals {
                nu: **nu,
                tip: outer.tip,
                error: outer.error,
                nu_c: outer.nu_c,
                nu_r: at.nu_r,
                dnu_r: at.dnu_r,
                sliding: at.sliding,
                equivalent: drive.equivalent,
                fuzzy: drive.fuzzy,
                learned: drive.learned.unwrap_or(*observer.learned()),
                commanded,
                manipulability_squared: outer.manipulability_squared,
                damping_squared: outer.damping_squared,
            },
        })
    }
}
