//! Integration tests of the rule bases: one program, so that the dependencies are linked once.

mod common {
    pub(crate) mod law;
}

mod bundled;
mod check;
mod compile_emit;
mod compile_q15;
mod compile_support;
mod compile_surface;
mod compile_surface2;
mod corpus;
mod fcl;
mod fis;
mod round_trip;
