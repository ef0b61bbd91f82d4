//! The wire to a target: a serial port, or the one of an emulated machine.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serialport::SerialPort;

use super::machine::Machine;

/// Bytes there and back.
pub(super) trait Wire {
    /// Sends bytes.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;
    /// Takes what has come, waiting up to `patience` for a first byte; none came where that is 0.
    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize>;
}

/// Nothing within the time is no error.
fn unless_late(result: io::Result<usize>) -> io::Result<usize> {
    match result {
        Ok(0) => Err(io::Error::new(ErrorKind::UnexpectedEof, "the other side has closed it")),
        Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => Ok(0),
        Err(error) if error.kind() == ErrorKind::Interrupted => Ok(0),
        other => other,
    }
}

/// A serial port of this machine.
pub(super) struct Serial(Box<dyn SerialPort>);

impl Serial {
    /// Opens it with 8 bits, no parity, one stop bit and no flow control.
    pub(super) fn open(name: &str, baud: u32) -> io::Result<Self> {
        let port = serialport::new(name, baud).timeout(Duration::from_millis(100)).open()?;
        Ok(Self(port))
    }
}

impl Wire for Serial {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        if self.0.timeout() != patience {
            self.0.set_timeout(patience)?;
        }
        unless_late(self.0.read(buffer))
    }
}

/// A machine in QEMU, whose serial port is a connection to here; it ends with this value.
pub(super) struct Qemu {
    stream: TcpStream,
    patience: Duration,
    child: Running,
}

/// A process that does not outlive its owner.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Time that QEMU has to start.
const START: Duration = Duration::from_secs(30);

impl Qemu {
    /// Starts a machine with a program.
    pub(super) fn start(machine: &Machine, firmware: &Path) -> io::Result<Self> {
        let listener = TcpListener::bind(("127.0.0.1", 0))?;
        listener.set_nonblocking(true)?;
        let port = listener.local_addr()?.port();
        let child = Command::new(machine.emulator)
            .args(machine.arguments)
            .args(["-icount", machine.icount, "-display", "none", "-monitor", "none"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .args(["-serial", &format!("tcp:127.0.0.1:{port},nodelay=on"), "-kernel"])
            .arg(firmware)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn();
        let child = child.map_err(|error| {
            io::Error::new(error.kind(), format!("cannot start {}: {error}", machine.emulator))
        })?;
        let mut child = Running(child);
        let begin = Instant::now();
        let stream = loop {
            match listener.accept() {
                Ok((stream, _)) => break stream,
                Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                Err(error) => return Err(error),
            }
            if let Some(status) = child.0.try_wait()? {
                return Err(io::Error::other(format!("{} ended at once: {status}", machine.emulator)));
            }
            if begin.elapsed() > START {
                return Err(io::Error::new(ErrorKind::TimedOut, "QEMU did not connect its serial port"));
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        let patience = Duration::from_millis(100);
        stream.set_read_timeout(Some(patience))?;
        Ok(Self { stream, patience, child })
    }
}

impl Wire for Qemu {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        if self.patience != patience {
            self.stream.set_read_timeout(Some(patience))?;
            self.patience = patience;
        }
        let received = unless_late(self.stream.read(buffer));
        match (received, self.child.0.try_wait()) {
            (Err(_), Ok(Some(status))) => Err(io::Error::other(format!("QEMU has ended: {status}"))),
            (received, _) => received,
        }
    }
}

/// The firmware of a machine, where `cargo xtask pil` puts it: beside this command, or in the folder that this is run in.
pub(super) fn built_firmware(machine: &Machine) -> Result<PathBuf, PathBuf> {
    let beside = std::env::current_exe().ok().and_then(|exe| exe.parent()?.parent().map(Path::to_path_buf));
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let places = [target, beside, Some(PathBuf::from("target"))];
    let place =
        |folder: PathBuf| folder.join("firmware").join(machine.target).join(machine.profile).join("pil");
    let all: Vec<_> = places.into_iter().flatten().map(place).collect();
    let found = all.iter().find(|path| path.is_file()).cloned();
    found.ok_or_else(|| all.last().cloned().unwrap_or_default())
}
