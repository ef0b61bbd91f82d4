//! Recordings in single precision.
#![no_std]
#![no_main]

board::program!(digest::run::<f32>);
