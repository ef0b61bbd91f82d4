//! The caller's memory for a controller.

use crate::controller::Scalar;

/// Bytes of an mm_controller; the caller owns them, on the stack, as a static or in a struct of its own.
pub const MM_CONTROLLER_SIZE: usize = 4096;

/// Bytes of an mmf_controller.
pub const MMF_CONTROLLER_SIZE: usize = 2048;

/// A controller in double precision: memory that mm_controller_init fills and the other calls use.
///
/// It holds no address: it may be copied and moved while no call is running. What is in it is the library's business.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct DoubleController {
    /// Not for the caller.
    pub opaque: [u64; 512],
}

/// A controller in single precision, for mmf_controller_init and its kin; see mm_controller.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct SingleController {
    /// Not for the caller.
    pub opaque: [u64; 256],
}

impl DoubleController {
    /// Memory that holds no controller yet.
    #[must_use]
    pub const fn empty() -> Self {
        Self { opaque: [0; 512] }
    }
}

impl SingleController {
    /// Memory that holds no controller yet.
    #[must_use]
    pub const fn empty() -> Self {
        Self { opaque: [0; 256] }
    }
}

/// What lies in the memory: a mark that it is initialized, and the controller.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Held<T: Scalar> {
    pub(crate) mark: u64,
    pub(crate) controller: crate::controller::Controller<T>,
}

/// Fails the build where a controller does not fit into its memory.
const fn assert_fits<T: Scalar>() {
    assert!(size_of::<Held<T>>() <= size_of::<T::Storage>(), "a controller is larger than its storage");
    assert!(align_of::<Held<T>>() <= align_of::<T::Storage>(), "a controller is stricter than its storage");
}

const _: () = {
    assert!(size_of::<DoubleController>() == MM_CONTROLLER_SIZE, "mm_controller");
    assert!(size_of::<SingleController>() == MMF_CONTROLLER_SIZE, "mmf_controller");
    assert!(align_of::<DoubleController>() == 8 && align_of::<SingleController>() == 8, "alignment");
    assert_fits::<f64>();
    assert_fits::<f32>();
};
