//! Integration tests of the model: one program, so that the dependencies are linked and the generic code compiled once.

mod common {
    pub(crate) mod coriolis;
    pub(crate) mod differences;
    pub(crate) mod dual;
    pub(crate) mod mass;
    pub(crate) mod motion;
    pub(crate) mod random;
    pub(crate) mod rigid;
    pub(crate) mod vectors;
    pub(crate) mod worst;
}

mod inverse;
mod kinematics;
mod params;
mod platform;
mod properties;
mod published;
mod single;
mod twins;
