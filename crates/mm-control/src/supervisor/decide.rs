//! What becomes of an update: judged, and where the law may not run, answered with a torque that is safe.

use mm_model::{Configuration, Mechanism, Real, Robot, Torque, Velocity};

use super::braking::limited;
use super::machine::Brought;
use super::plausibility::{Believed, Clocked, Doubt};
use super::{Command, Findings, Mode, SupervisedStack, SupervisedState, Timing, Verdict};
use crate::laws::InnerLaw;
use crate::{Input, Measurement, Reference};

/// Findings after which the measured state is not believed.
///
/// One that is out of range, but went there no faster than the robot can, is where the robot is: the law may not run there, and a stop
/// brakes by it.
const UNSEEN: Findings = Findings::STATE_NOT_FINITE
    .and(Findings::STATE_RATE)
    .and(Findings::STATE_FROZEN)
    .and(Findings::STALE)
    .and(Findings::EARLY)
    .and(Findings::MISSED);

impl<T: Real, const N: usize, L: InnerLaw<T, N>> SupervisedStack<T, N, L>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Whether the law may run on an input; what is believed of it is stored.
    #[inline(always)]
    pub(super) fn judge(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        input: &Input<T, N>,
    ) -> Verdict {
        let Input { q, nu, reference } = input;
        if state.settled {
            let (ordinary, moves) =
                self.plausibility.is_ordinary(&state.believed, timing, (q, nu), reference);
            if ordinary && (moves && state.doubt.is_none() || self.stands(state, (q, nu), timing.elapsed)) {
                (state.believed.q, state.believed.nu) = (*q, *nu);
                state.believed.reference = reference.position;
                return Verdict::Run(Findings::NONE);
            }
        }
        self.examine(state, timing, input)
    }

    /// Whether an otherwise ordinary update in which a coordinate did not change may be one of a robot at rest; if so, the doubts are
    /// stored.
    #[inline(never)]
    fn stands(
        &self,
        state: &mut SupervisedState<T, N>,
        state_now: (&Configuration<T, N>, &Velocity<T, N>),
        elapsed: T,
    ) -> bool {
        let doubt = self.doubt(state, state_now, elapsed);
        if self.plausibility.is_frozen(&doubt) {
            return false;
        }
        // While nothing is doubtful, what is learned need not be noted: it can be read where it is learned.
        if self.plausibility.is_doubtful(&doubt) {
            self.note_load(state);
        }
        state.doubt = doubt;
        true
    }

    /// The same number by number.
    #[cold]
    #[inline(never)]
    pub(super) fn examine(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        input: &Input<T, N>,
    ) -> Verdict {
        let Input { q, nu, reference } = input;
        self.note_load(state);
        let clocked = self.plausibility.clocked(timing, state.waited);
        let since = state.since + clocked.elapsed;
        let last = state.seen.then_some(&state.believed);
        let mut findings = clocked
            .findings
            .and(self.plausibility.configuration(last, q, since))
            .and(self.plausibility.velocity(last, nu, since));
        if !findings.any_of(UNSEEN) {
            findings = findings.and(self.frozen(state, (q, nu), clocked.elapsed));
        }
        self.weigh(
            state,
            findings,
            &clocked,
            (reference, |state: &mut SupervisedState<T, N>| {
                (state.believed.q, state.believed.nu) = (*q, *nu);
            }),
        )
    }

    /// Whether the law may run on a measurement.
    pub(super) fn judge_measured(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        measurement: &Measurement<T, N>,
        reference: &Reference<T>,
    ) -> Verdict {
        let Measurement { q, wheels } = measurement;
        self.note_load(state);
        let clocked = self.plausibility.clocked(timing, state.waited);
        let last = state.seen.then_some(&state.believed);
        let mut findings =
            clocked.findings.and(self.plausibility.configuration(last, q, state.since + clocked.elapsed));
        if wheels.is_some_and(|wheels| !(wheels.right.is_finite() && wheels.left.is_finite())) {
            findings = findings.and(Findings::STATE_NOT_FINITE);
        }
        if !findings.any_of(UNSEEN) {
            findings = findings.and(self.frozen(state, (q, &state.believed.nu.clone()), clocked.elapsed));
        }
        let verdict = self.weigh(
            state,
            findings,
            &clocked,
            (reference, |state: &mut SupervisedState<T, N>| {
                state.believed.q = *q;
            }),
        );
        // The law's update estimates by itself; where it does not run, braking needs the velocity.
        if matches!(verdict, Verdict::Safe(_))
            && !findings.any_of(UNSEEN)
            && let Ok((_, nu)) = self.stack.estimate(&mut state.control, measurement)
            && self.plausibility.within_speed(&nu)
        {
            state.believed.nu = nu;
            let posture = self.stack.robot().posture(&q.joints);
            self.stack.foresee(&mut state.control, &posture, &nu, &state.torque);
        }
        verdict
    }

    /// What becomes of the mode without any input.
    pub(super) fn judge_missed(&self, state: &mut SupervisedState<T, N>, elapsed: T) -> Findings {
        self.note_load(state);
        let period = self.stack.period();
        // A period was missed, whatever its clock says.
        let elapsed = if elapsed >= T::ZERO { elapsed } else { period };
        let clocked = self.plausibility.clocked(Timing::exact(elapsed), state.waited);
        let findings = clocked.findings.and(Findings::MISSED);
        self.lose(state, &clocked);
        self.advance(state, findings, &clocked);
        findings
    }

    /// The verdict on findings; `believe` stores the state if it is to be believed.
    fn weigh(
        &self,
        state: &mut SupervisedState<T, N>,
        mut findings: Findings,
        clocked: &Clocked<T>,
        (reference, believe): (&Reference<T>, impl FnOnce(&mut SupervisedState<T, N>)),
    ) -> Verdict {
        let aim = state.aimed.then_some(&state.believed.reference);
        let (can_be, follows) = self.plausibility.reference(aim, reference, clocked.elapsed);
        if !(can_be && follows) {
            findings = findings.and(Findings::REFERENCE);
        }
        if findings.any_of(UNSEEN) {
            self.lose(state, clocked);
        } else {
            believe(state);
            (state.seen, state.since) = (true, T::ZERO);
        }
        // A stopped robot may be given another place to begin from; a moving one may not be torn away.
        if can_be && (follows || state.machine.mode == Mode::Stop) {
            (state.aimed, state.believed.reference) = (true, reference.position);
        }
        let stopped = state.machine.mode == Mode::Stop;
        self.advance(state, findings, clocked);
        if state.machine.mode == Mode::Run {
            if stopped {
                state.control = self.stack.restarted(&state.control);
                state.doubt = Doubt::none();
            }
            state.settled = state.seen && state.aimed;
            return Verdict::Run(findings);
        }
        Verdict::Safe(findings)
    }

    /// The mode after an update with these findings.
    fn advance(&self, state: &mut SupervisedState<T, N>, findings: Findings, clocked: &Clocked<T>) {
        let sees = !findings.any_of(UNSEEN);
        let plausible = sees && !findings.any_of(Findings::REFERENCE.and(Findings::STATE_RANGE));
        let overdue = clocked.missing > self.params().hold_periods;
        self.step(state, Brought { plausible, sees, overdue });
        state.waited = if findings.any_of(Findings::EARLY) { clocked.elapsed } else { T::ZERO };
    }

    /// The next mode; a stop holds the posture in which it begins.
    fn step(&self, state: &mut SupervisedState<T, N>, brought: Brought) {
        let before = state.machine.mode;
        state.machine = state.machine.after(brought, &self.patience);
        if state.machine.mode == Mode::Stop && before != Mode::Stop {
            state.posture = state.whereabouts().0.joints;
        }
        state.settled = false;
    }

    /// Keeps what the law has learned of the joints' loads, unless it may have learned it from a sensor that stands still.
    ///
    /// To an observer a coordinate that does not move under a torque is a load as large as that torque; a stop that carried it would throw
    /// the arm.
    fn note_load(&self, state: &mut SupervisedState<T, N>) {
        let running = matches!(state.machine.mode, Mode::Run | Mode::Hold);
        if running && !self.plausibility.is_doubtful(&state.doubt) {
            state.load = state.control.learned().joints;
        }
    }

    /// Carries on what is believed without a measurement.
    fn lose(&self, state: &mut SupervisedState<T, N>, clocked: &Clocked<T>) {
        // The time of an early update is counted when the next one is due.
        if clocked.findings.any_of(Findings::EARLY) {
            return;
        }
        if state.seen {
            state.predicted = state.whereabouts();
            let robot = self.stack.robot();
            let mut force = robot.force_of(&state.torque);
            for (force, learned) in force.joints.iter_mut().zip(&state.load) {
                *force += *learned;
            }
            self.braking.predict(robot, &mut state.predicted, &force, clocked.elapsed);
        }
        state.since += clocked.elapsed;
        if state.machine.mode == Mode::Stop {
            self.stack.forget_measured(&mut state.control);
        }
    }

    /// Whether a sensor stands still; the doubts are stored.
    fn frozen(
        &self,
        state: &mut SupervisedState<T, N>,
        state_now: (&Configuration<T, N>, &Velocity<T, N>),
        elapsed: T,
    ) -> Findings {
        if !state.seen {
            return Findings::NONE;
        }
        state.doubt = self.doubt(state, state_now, elapsed);
        if self.plausibility.is_frozen(&state.doubt) { Findings::STATE_FROZEN } else { Findings::NONE }
    }

    /// How far each coordinate should have moved while it did not, m and rad; zero for one that changed.
    ///
    /// A coordinate that stands is strained if it is pushed with more than half of what its actuators can, its weight not counted.
    #[inline(always)]
    fn doubt(
        &self,
        state: &SupervisedState<T, N>,
        (q, nu): (&Configuration<T, N>, &Velocity<T, N>),
        elapsed: T,
    ) -> Doubt<T, N> {
        let limits = &self.stack.robot().params().limits;
        let SupervisedState {
            doubt: Doubt { of: doubt, .. },
            torque,
            believed: Believed { q: before, .. },
            ..
        } = state;
        let hard = |torque: T, limit: T| torque.abs() > T::HALF * limit;
        // Half of what both wheels can together.
        let wheels = limits.wheel_torque;
        let mut next = Velocity::zero();
        if before.x == q.x && before.y == q.y {
            let strained = (torque.right + torque.left).abs() > wheels;
            next.forward = self.plausibility.doubt(doubt.forward, nu.forward * elapsed, strained);
        }
        if before.heading == q.heading {
            let strained = (torque.right - torque.left).abs() > wheels;
            next.yaw_rate = self.plausibility.doubt(doubt.yaw_rate, nu.yaw_rate * elapsed, strained);
        }
        let mut stands = false;
        for (before, now) in before.joints.iter().zip(&q.joints) {
            stands = stands || before == now;
        }
        if stands {
            let (joints, mut strained) = (&torque.joints, [false; N]);
            if joints.iter().zip(&limits.joint_torque).any(|(torque, limit)| hard(*torque, *limit)) {
                let robot = self.stack.robot();
                let load = robot.gravity(&robot.inertia(&robot.posture(&before.joints))).joints;
                let pairs = joints.iter().zip(load).zip(&limits.joint_torque);
                for (strained, ((torque, load), limit)) in strained.iter_mut().zip(pairs) {
                    *strained = hard(*torque - load, *limit);
                }
            }
            let pairs = before.joints.iter().zip(&q.joints).zip(nu.joints);
            for ((next, doubt), (((before, now), rate), strained)) in
                next.joints.iter_mut().zip(doubt.joints).zip(pairs.zip(strained))
            {
                if before == now {
                    *next = self.plausibility.doubt(doubt, rate * elapsed, strained);
                }
            }
        }
        Doubt::new(next)
    }

    /// The command where the law may not run.
    #[cold]
    #[inline(never)]
    pub(super) fn safe(&self, state: &mut SupervisedState<T, N>, findings: Findings) -> Command<T, N> {
        let mode = state.machine.mode;
        let robot = self.stack.robot();
        let torque = match mode {
            Mode::Run | Mode::Hold => state.torque,
            Mode::Stop if state.seen => {
                let (q, nu) = state.whereabouts();
                self.braking.torque(robot, (&q, &nu), &state.posture, &state.load)
            }
            Mode::Stop | Mode::Fault => Torque::zero(),
        };
        if mode == Mode::Stop && !state.machine.at_rest {
            let rest = self.params().velocity_noise;
            state.machine.at_rest = state.whereabouts().1.channels().all(|nu| nu.abs() <= rest);
        }
        state.torque = limited(robot, torque);
        let brake = match mode {
            Mode::Run | Mode::Hold => false,
            Mode::Stop => state.machine.at_rest,
            Mode::Fault => true,
        };
        Command { torque: state.torque, mode, findings, brake, output: None }
    }

    /// The command where the law was to run and gave an error; its memory is as it was.
    #[cold]
    #[inline(never)]
    pub(super) fn refused(&self, state: &mut SupervisedState<T, N>, findings: Findings) -> Command<T, N> {
        self.note_load(state);
        self.step(state, Brought { plausible: false, sees: true, overdue: false });
        self.safe(state, findings.and(Findings::REFUSED))
    }
}
