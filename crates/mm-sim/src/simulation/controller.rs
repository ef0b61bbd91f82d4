//! Who computes the torque of a tick, and who moves the robot under it.

use mm_control::{Input, Measurement, Output};
use mm_model::Torque;

use super::Ending;
use crate::plant::PlantState;

/// Computes torques, perhaps in the stack's place.
pub trait Controller {
    /// Whether it does; otherwise the simulation asks its own stack, and this one nothing.
    const ELSEWHERE: bool;

    /// The update at time `t`, from the true state or, where there are sensors, from what they read.
    ///
    /// # Errors
    /// How the run ends, where there is no output.
    fn update(
        &mut self,
        t: f64,
        input: &Input<f64, 3>,
        measured: Option<Measurement<f64, 3>>,
    ) -> Result<Output<f64, 3>, Ending>;

    /// Whether it moves the robot too; otherwise the simulation asks its own plant.
    const MOVES: bool = false;

    /// The state after a control period of `period` s from time `t` on, under a torque.
    ///
    /// # Errors
    /// How the run ends, where there is no state.
    fn advance(
        &mut self,
        (t, _period): (f64, f64),
        _state: &PlantState,
        _torque: &Torque<f64, 3>,
    ) -> Result<PlantState, Ending> {
        // Never asked.
        Err(Ending::Stopped { t })
    }
}

/// The simulation's own stack.
#[derive(Debug, Clone, Copy, Default)]
pub struct Own;

impl Controller for Own {
    const ELSEWHERE: bool = false;

    fn update(
        &mut self,
        t: f64,
        _input: &Input<f64, 3>,
        _measured: Option<Measurement<f64, 3>>,
    ) -> Result<Output<f64, 3>, Ending> {
        // Never asked.
        Err(Ending::Stopped { t })
    }
}
