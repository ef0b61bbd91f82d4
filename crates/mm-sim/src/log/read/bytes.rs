//! CDR, read: the counterpart of the writer. Whatever is shorter than it says gives none.

/// Bytes before the first field.
const ENCAPSULATION: usize = 4;

/// A little-endian message, read from its beginning.
#[derive(Debug)]
pub(super) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(super) const fn of(data: &'a [u8]) -> Self {
        Self { data, at: ENCAPSULATION }
    }

    fn take<const N: usize>(&mut self, alignment: usize) -> Option<[u8; N]> {
        let begin = (self.at - ENCAPSULATION).next_multiple_of(alignment) + ENCAPSULATION;
        let bytes = self.data.get(begin..begin.checked_add(N)?)?;
        self.at = begin + N;
        bytes.try_into().ok()
    }

    pub(super) fn boolean(&mut self) -> Option<bool> {
        self.take::<1>(1).map(|[byte]| byte != 0)
    }

    pub(super) fn i32(&mut self) -> Option<i32> {
        self.take(4).map(i32::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.take(4).map(u32::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Option<f64> {
        self.take(8).map(f64::from_le_bytes)
    }

    /// A text, without its closing zero; what is no UTF-8 is replaced.
    pub(super) fn string(&mut self) -> Option<String> {
        let length = usize::try_from(self.u32()?).ok()?;
        let bytes = self.data.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        Some(String::from_utf8_lossy(bytes.strip_suffix(&[0]).unwrap_or(bytes)).into_owned())
    }

    /// The stamp of a `std_msgs/Header`, s.
    pub(super) fn header(&mut self) -> Option<f64> {
        let (seconds, nanoseconds) = (self.i32()?, self.u32()?);
        self.string()?;
        Some(f64::from(seconds) + 1e-9 * f64::from(nanoseconds))
    }
}

#[cfg(test)]
mod tests {
    use super::Bytes;
    use crate::log::cdr::Cdr;

    #[test]
    fn what_was_written_is_read() {
        let mut cdr = Cdr::default();
        cdr.begin();
        cdr.boolean(true);
        cdr.f64(-1.5);
        cdr.string("tip");
        cdr.i32(-7);
        let mut bytes = Bytes::of(cdr.bytes());
        assert_eq!(bytes.boolean(), Some(true), "bool");
        assert_eq!(bytes.f64(), Some(-1.5), "float64, aligned");
        assert_eq!(bytes.string().as_deref(), Some("tip"), "string");
        assert_eq!(bytes.i32(), Some(-7), "int32, aligned");
        assert_eq!(bytes.boolean(), None, "nothing is left");
    }

    #[test]
    fn a_length_beyond_the_message_is_none() {
        assert_eq!(Bytes::of(&[0, 1, 0, 0, 255, 255, 255, 255, b'x']).string(), None, "4 GB announced");
        assert_eq!(Bytes::of(&[0, 1]).u32(), None, "shorter than any message");
    }
}
