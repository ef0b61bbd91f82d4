//! Tests of the whole house: one program, so that the dependencies are linked and the generic code compiled once.

mod energy;
mod faults;
mod fixed_point;
mod integrator;
mod metrics;
mod monitors;
mod realism;
mod robustness;
mod scurve;
mod square_smooth;
mod trajectories;
mod verify;
mod waypoint_files;
mod waypoints;
