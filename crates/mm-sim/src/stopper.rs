//! A recorder for runs of which only the result is wanted, and which may be asked to end.

use crate::simulation::{Recorder, Sample};

/// Keeps nothing, and ends the run as soon as it is asked to.
pub(crate) struct Stopper<'a>(pub(crate) &'a (dyn Fn() -> bool + Sync));

impl Recorder for Stopper<'_> {
    type Error = core::convert::Infallible;

    fn record(&mut self, _sample: &Sample<'_>) -> Result<bool, Self::Error> {
        Ok(true)
    }

    fn goes_on(&mut self) -> bool {
        !(self.0)()
    }
}
