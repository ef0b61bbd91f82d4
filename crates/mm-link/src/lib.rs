//! Frames between a simulator and a controller on a microcontroller.
#![no_std]
