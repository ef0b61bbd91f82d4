//! What stands between controller and plant: sensors, actuators, and the time that both take.

mod actuators;
mod delay;
mod motor;
mod sensors;

use mm_control::Measurement;
use mm_model::{Robot, Torque, Velocity};

pub use actuators::{Actuators, Axis};
pub use delay::DelayLine;
pub use motor::{Motor, MotorAxis};
pub use sensors::{PoseSource, Sensors, quantized};

use crate::plant::{Plant, PlantSines, PlantState};
use crate::simulation::Clock;
use actuators::ActuatorState;
use sensors::SensorState;

/// Sensors and actuators of a plant.
#[derive(Debug, Clone, PartialEq)]
pub struct Hardware {
    /// Sensors.
    pub sensors: Sensors,
    /// Actuators.
    pub actuators: Actuators,
}

/// Hardware in use.
#[derive(Debug, Clone)]
pub struct Running<'a> {
    sensors: SensorState<'a>,
    actuators: ActuatorState<'a>,
}

impl<'a> Running<'a> {
    /// The hardware of a robot at its start.
    #[must_use]
    pub fn new(hardware: &'a Hardware, robot: &Robot<f64, 3>, start: &PlantState) -> Self {
        Self {
            sensors: SensorState::new(&hardware.sensors, robot, start),
            actuators: ActuatorState::new(&hardware.actuators, robot),
        }
    }

    /// Reads the sensors, and gives what has come through by now.
    pub fn measure(&mut self, state: &PlantState) -> Measurement<f64, 3> {
        self.sensors.measure(state)
    }

    /// Takes a command; says whether an actuator has to limit it.
    ///
    /// The torque at the plant's input follows from [`torque`](Self::torque).
    pub fn command(&mut self, torque: &Torque<f64, 3>, nu: &Velocity<f64, 3>) -> bool {
        self.actuators.command(torque, nu)
    }

    /// Torque at the plant's input now.
    #[must_use]
    pub fn torque(&self) -> Torque<f64, 3> {
        self.actuators.torque()
    }

    /// The plant over one control period that begins at `t`, under the torques that the actuators make.
    #[must_use]
    pub fn advance(
        &mut self,
        (t, clock): (f64, &Clock),
        plant: &Plant,
        state: &PlantState,
        mut sines: PlantSines,
    ) -> PlantState {
        let step = clock.period / f64::from(clock.substeps);
        let mut state = *state;
        for i in 0..clock.substeps {
            if i > 0 {
                sines = plant.sines(&state.q);
            }
            let torques = self.drive(&state.nu);
            state = plant.step_driven(t + f64::from(i) * step, &state, &sines, &torques);
        }
        state
    }

    /// Torque at the begin, in the middle and at the end of the next plant step, with the velocity at its begin.
    pub fn drive(&mut self, nu: &Velocity<f64, 3>) -> [Torque<f64, 3>; 3] {
        self.actuators.drive(nu)
    }
}
