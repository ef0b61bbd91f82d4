//! Actuators: delay, limits, lag, rate limit and motor between a commanded torque and the plant's input.

use mm_model::{Real, Robot, Torque, Velocity};

use super::{DelayLine, Motor, MotorAxis};

/// What one actuator does to a command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Largest torque, N m; infinite for none.
    pub limit: f64,
    /// Time constant of the lag, s; 0 for none.
    pub lag: f64,
    /// Largest rate of the torque, N m/s; infinite for none.
    pub rate: f64,
}

impl Axis {
    /// A torque `y` after the time `dt` on its way to `u`, exactly.
    ///
    /// Equation: y' = (u - y)/lag, cut to +-rate: a ramp while |u - y| > lag rate, an exponential from there on. `decay` is
    /// exp(-dt/lag), which a fixed step knows beforehand.
    #[must_use]
    fn approach(&self, y: f64, u: f64, dt: f64, decay: f64) -> f64 {
        let gap = u - y;
        let ramp = self.rate * dt;
        if !(self.lag > 0.0) {
            return y + gap.clamp_to(-ramp, ramp);
        }
        let knee = self.rate * self.lag;
        let size = Real::abs(gap);
        if size <= knee {
            return u - gap * decay;
        }
        let ramp_time = (size - knee) / self.rate;
        if dt <= ramp_time {
            return y + Real::sign(gap) * ramp;
        }
        u - Real::sign(gap) * knee * Real::exp((ramp_time - dt) / self.lag)
    }

    /// Whether a command takes no time.
    const fn is_immediate(&self) -> bool {
        !(self.lag > 0.0) && self.rate == f64::INFINITY
    }
}

/// The actuators, in the order right wheel, left wheel, joints 1 to 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuators {
    /// What each does to a command.
    pub axes: [Axis; 5],
    /// The motor of each, if it is modelled.
    pub motors: [Option<Motor>; 5],
    /// Control periods from a command to its arrival.
    pub delay: usize,
    /// Plant step, s.
    pub step: f64,
}

impl Actuators {
    /// Actuators that make every torque at once, for a plant step in s.
    #[must_use]
    pub const fn ideal(step: f64) -> Self {
        let axis = Axis { limit: f64::INFINITY, lag: 0.0, rate: f64::INFINITY };
        Self { axes: [axis; 5], motors: [None; 5], delay: 0, step }
    }

    /// Whether commands pass unchanged and at once.
    #[must_use]
    pub fn is_ideal(&self) -> bool {
        *self == Self::ideal(self.step)
    }
}

/// One actuator at work.
#[derive(Debug, Clone, Copy)]
struct Worker {
    axis: Axis,
    motor: Option<MotorAxis>,
    half_decay: f64,
    decay: f64,
    /// Command after delay and limit, N m.
    target: f64,
    /// Output of lag and rate limit, N m.
    output: f64,
    /// Current of the motor, A.
    current: f64,
}

impl Worker {
    fn new(axis: Axis, motor: Option<Motor>, step: f64) -> Self {
        let decay = |dt: f64| if axis.lag > 0.0 { Real::exp(-dt / axis.lag) } else { 0.0 };
        Self {
            axis,
            motor: motor.map(|motor| MotorAxis::new(motor, step)),
            half_decay: decay(0.5 * step),
            decay: decay(step),
            target: 0.0,
            output: 0.0,
            current: 0.0,
        }
    }

    /// Takes a command at a rate of the axis; `settled` puts the actuator there at once. Says whether a limit is in the way.
    fn command(&mut self, command: f64, rate: f64, settled: bool) -> bool {
        self.target = command.clamp_to(-self.axis.limit, self.axis.limit);
        if settled || self.axis.is_immediate() {
            self.output = self.target;
        }
        let mut limited = Real::abs(command) > self.axis.limit;
        if let Some(motor) = &self.motor {
            let (current, cut) = motor.target(self.output, rate);
            limited |= cut;
            if settled || motor.is_immediate() {
                self.current = current;
            }
        }
        limited
    }

    fn torque(&self) -> f64 {
        self.motor.as_ref().map_or(self.output, |motor| motor.torque(self.current))
    }

    /// Torques over a plant step of `dt`, at a rate of the axis.
    fn drive(&mut self, dt: f64, rate: f64) -> [f64; 3] {
        let begin = self.output;
        let middle = self.axis.approach(begin, self.target, 0.5 * dt, self.half_decay);
        let end = self.axis.approach(begin, self.target, dt, self.decay);
        self.output = end;
        match &self.motor {
            None => [begin, middle, end],
            // Without inductance the current is where the drive heads for, at each of the three instants.
            Some(motor) if motor.is_immediate() => [begin, middle, end].map(|torque| {
                self.current = motor.target(torque, rate).0;
                motor.torque(self.current)
            }),
            Some(motor) => {
                let (target, _) = motor.target(middle, rate);
                motor.advance(&mut self.current, target)
            }
        }
    }
}

/// The actuators at work.
#[derive(Debug, Clone)]
pub(super) struct ActuatorState<'a> {
    actuators: &'a Actuators,
    robot: Robot<f64, 3>,
    workers: [Worker; 5],
    delay: DelayLine<[f64; 5]>,
    started: bool,
}

impl<'a> ActuatorState<'a> {
    pub(super) fn new(actuators: &'a Actuators, robot: &Robot<f64, 3>) -> Self {
        let mut motors = actuators.motors.into_iter();
        let workers = actuators.axes.map(|axis| Worker::new(axis, motors.next().flatten(), actuators.step));
        let delay = DelayLine::new(actuators.delay);
        Self { actuators, robot: *robot, workers, delay, started: false }
    }

    /// The first command finds the actuators settled on it: they held the robot before the run began.
    pub(super) fn command(&mut self, torque: &Torque<f64, 3>, nu: &Velocity<f64, 3>) -> bool {
        let [j1, j2, j3] = torque.joints;
        let command = self.delay.push([torque.right, torque.left, j1, j2, j3]);
        let mut limited = false;
        for ((worker, value), rate) in self.workers.iter_mut().zip(command).zip(rates(&self.robot, nu)) {
            limited |= worker.command(value, rate, !self.started);
        }
        self.started = true;
        limited
    }

    pub(super) fn torque(&self) -> Torque<f64, 3> {
        torque(self.workers.each_ref().map(Worker::torque))
    }

    pub(super) fn drive(&mut self, nu: &Velocity<f64, 3>) -> [Torque<f64, 3>; 3] {
        let mut rates = rates(&self.robot, nu).into_iter();
        let step = self.actuators.step;
        let over = self.workers.each_mut().map(|worker| worker.drive(step, rates.next().unwrap_or(0.0)));
        [0, 1, 2].map(|i| torque(over.map(|values| values[i])))
    }
}

/// Rates of the axes: right wheel, left wheel, joints.
fn rates(robot: &Robot<f64, 3>, nu: &Velocity<f64, 3>) -> [f64; 5] {
    let wheels = robot.wheel_rates(nu.forward, nu.yaw_rate);
    let [d1, d2, d3] = nu.joints;
    [wheels.right, wheels.left, d1, d2, d3]
}

const fn torque([right, left, j1, j2, j3]: [f64; 5]) -> Torque<f64, 3> {
    Torque { right, left, joints: [j1, j2, j3] }
}
