//! Console, files and the way out, over semihosting: whoever runs or debugs the processor does it.

use core::ffi::CStr;
use core::fmt;
use core::mem::MaybeUninit;

use semihosting::fd::{BorrowedFd, OwnedFd, RawFd};
use semihosting::io::Read;
use semihosting::sys::arm_compat::{OpenMode, sys_get_cmdline_uninit, sys_open};
use semihosting::sys::write;

/// Text to whoever watches; nothing happens before the first of it.
#[derive(Debug)]
#[expect(missing_copy_implementations, reason = "a copy would open it again")]
pub struct Console(RawFd);

/// No file.
const CLOSED: RawFd = -1;

impl Console {
    pub(crate) const fn new() -> Self {
        Self(CLOSED)
    }
}

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        if self.0 == CLOSED {
            // It stays open: the number of the file is kept, which spares the checks of an owner, and the panics in them.
            self.0 = sys_open(c":tt", OpenMode::WRONLY_TRUNC).map_or(CLOSED, OwnedFd::into_raw_fd);
        }
        if self.0 == CLOSED {
            return Err(fmt::Error);
        }
        #[expect(unsafe_code, reason = "a file by its number")]
        // SAFETY: the file was opened above, or in an earlier call, and nobody closes it.
        let out = unsafe { BorrowedFd::borrow_raw(self.0) };
        write(out, text.as_bytes()).map(|_| ()).map_err(|_| fmt::Error)
    }
}

/// A file of the host, read piece by piece.
#[derive(Debug)]
pub struct File(semihosting::fs::File);

impl File {
    /// Opens a file for reading; none, if that is not possible.
    #[must_use]
    pub fn open(path: &CStr) -> Option<Self> {
        semihosting::fs::File::open(path).ok().map(Self)
    }

    /// Reads the next bytes: as many as there are, and room for; 0 at the end of the file and after an error.
    #[must_use]
    pub fn read(&mut self, buffer: &mut [u8]) -> usize {
        self.0.read(buffer).unwrap_or(0)
    }
}

/// What the program was started with (`-semihosting-config arg=TEXT`), as far as it fits.
#[must_use]
pub fn argument(buffer: &mut [u8; 256]) -> Option<&CStr> {
    let mut line = [MaybeUninit::new(0); 256];
    let text = sys_get_cmdline_uninit(&mut line).ok()?;
    for (to, from) in buffer.iter_mut().zip(text.iter().chain(&[0])) {
        *to = *from;
    }
    CStr::from_bytes_until_nul(buffer).ok()
}

/// Ends the program.
pub fn exit(well: bool) -> ! {
    semihosting::process::exit(i32::from(!well))
}
