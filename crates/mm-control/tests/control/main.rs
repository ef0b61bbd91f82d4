//! Integration tests of the control laws: one program, so that the dependencies are linked and the generic code compiled once.

mod common {
    pub(crate) mod motion;
    pub(crate) mod plant;
    pub(crate) mod random;
    pub(crate) mod robots;
}

mod baselines;
mod estimator;
mod fuzzy;
mod fuzzy_fixed;
mod fuzzy_general;
mod laws;
mod limits;
mod lyapunov;
mod outer;
mod recovery;
mod restraints;
mod setup;
mod smooth_knots;
mod stack;
mod supervisor;
mod supervisor_random;
mod take_over;
