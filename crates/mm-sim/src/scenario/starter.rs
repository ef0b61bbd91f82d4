//! A scenario to begin with.

/// Returns the text of a commented scenario that runs as it is.
#[must_use]
pub fn starter(name: &str) -> String {
    STARTER.replace("NAME", &toml::Value::from(name).to_string())
}

const STARTER: &str = r##"# A scenario: what the robot is, what it shall do and what disturbs it, in SI units and radians. Editors complete the
# keys and say what they mean, once `mmsim scenario schema > scenario.schema.json` is beside this file and its first
# line is `#:schema ./scenario.schema.json`.
#
#   mmsim --scenario FILE                 runs it
#   mmsim scenario check FILE             finds what is wrong with it

name = NAME # of the run and of its log
description = "The tip goes round a circle, while something pushes a joint."
# include = "square-compare" # to change a few keys of another scenario, a file or a bundled one

[simulation]
duration_s = 20.0
plant_step_s = 0.001     # step of the simulated robot
control_period_s = 0.001 # the controller runs at 1 kHz
seed = 0                 # of everything random

[robot] # that the controller knows
preset = "thesis" # or file = "robot.toml"; `mmsim robot import` makes one from a URDF
# base_mass_kg = 50.0 # any field that differs

[plant] # how the simulated robot differs from it
mass_scale = 1.1 # all masses and inertias

# [plant.sensors] # without them the controller knows the state exactly
# bits = 14
# delay_periods = 1

[trajectory] # of the tip of the arm
kind = "circle" # or square, sinusoid, spiral, step, line, hold, waypoints
center_m = [0.0, 0.0, 0.5]
radius_m = 1.0
speed_m_s = 0.3
start_ramp_s = 2.0 # from rest

[controller]
kind = "bfsmc" # any of ten: `mmsim compare --scenario FILE --controllers bsmc,bfsmc,pid`

[[disturbance]] # unknown to the controller; as many as you like
on = "joint2"
shape = "sine"
amplitude_n_m = 5.0
frequency_rad_s = 2.0
from_s = 5.0
to_s = 15.0

[expect] # checked at the end: exit code 3 where one is missed
max_error_m = { max = 0.05 }
"##;
