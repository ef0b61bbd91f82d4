//! C interface of the control stack: `libmm_control.a` and `mm_control.h`.
//!
//! ```text
//! C caller --pointers--> double, single   thin extern functions, one set a precision
//!                            |
//!                          calls          what each does, generic over the scalar
//!                            |
//!             raw (pointers checked, then values) --> controller (safe) --> mm_control
//! ```
//! Structs of C hold numbers alone, so that no pattern of bits is invalid; kinds and flags come in as integers and are checked. A call reads
//! its inputs into values, works on these and writes its outputs last: they may overlap, and nothing is written where a status other
//! than ok is returned. The caller owns the storage of a controller; there is no other memory, no allocation and no panic.
//!
//! The header is made from these sources by `cargo xtask capi --bless`; documentation comments are therefore written for Doxygen.
//!
//! # Not modelled
//! Fuzzy systems of the caller's own, arms of other than three joints.
//!
//! # Features
//! `panic-handler` makes the archive complete on bare metal. The handler is never linked into a program: no function here panics.
#![cfg_attr(target_os = "none", no_std)]

mod calls;
mod controller;
pub mod double;
#[cfg(all(target_os = "none", feature = "panic-handler"))]
mod handler;
pub mod kinds;
pub mod params;
mod raw;
pub mod single;
pub mod status;
pub mod storage;
pub mod values;

/// Version of this interface: of the functions, of the structs and of the size of a controller.
pub const MM_ABI_VERSION: u32 = 1;

/// Joints of the arm.
pub const MM_JOINTS: usize = 3;

/// Channels of the robot: forward, yaw, joint 1, joint 2, joint 3, in this order.
pub const MM_CHANNELS: usize = 5;

// Arrays of the header and vectors of the stack have the same lengths.
const _: () = assert!(MM_CHANNELS == 2 + MM_JOINTS, "two channels of the base and one for each joint");
