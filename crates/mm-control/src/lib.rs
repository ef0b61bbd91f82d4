//! Backstepping fuzzy sliding mode control.
#![cfg_attr(not(test), no_std)]

pub mod fuzzy;
