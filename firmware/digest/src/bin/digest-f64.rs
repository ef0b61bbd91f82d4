//! Recordings in double precision.
#![no_std]
#![no_main]

board::program!(digest::run::<f64>);
