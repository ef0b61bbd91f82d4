//! CDR, the byte format of ROS 2 messages: little endian, plain (XCDR1), into a buffer that is used again.
//!
//! A message starts with four bytes that name the representation. A number of n bytes stands at a multiple of n,
//! counted from the end of those four bytes; the gap is filled with zeros.

/// Representation identifier of little-endian CDR, and two bytes of options.
const ENCAPSULATION: [u8; 4] = [0x00, 0x01, 0x00, 0x00];

/// Writer of one message at a time.
#[derive(Debug, Default)]
pub(super) struct Cdr {
    buffer: Vec<u8>,
}

impl Cdr {
    /// Starts a message; the last one is forgotten, its memory is not given back.
    pub(super) fn begin(&mut self) {
        self.buffer.clear();
        self.buffer.extend_from_slice(&ENCAPSULATION);
    }

    /// The message so far, ready to be logged.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.buffer
    }

    /// Fills with zeros up to a multiple of `size`, 4 or 8.
    #[inline]
    fn align(&mut self, size: usize) {
        const ZEROS: [u8; 8] = [0; 8];
        let beyond = (self.buffer.len() - ENCAPSULATION.len()) % size;
        if beyond != 0 {
            self.buffer.extend_from_slice(&ZEROS[..size - beyond]);
        }
    }

    /// `bool`.
    pub(super) fn boolean(&mut self, value: bool) {
        self.buffer.push(u8::from(value));
    }

    /// `int32`.
    pub(super) fn i32(&mut self, value: i32) {
        self.align(4);
        self.buffer.extend_from_slice(&value.to_le_bytes());
    }

    /// `uint32`.
    pub(super) fn u32(&mut self, value: u32) {
        self.align(4);
        self.buffer.extend_from_slice(&value.to_le_bytes());
    }

    /// `float64`.
    #[inline]
    pub(super) fn f64(&mut self, value: f64) {
        self.align(8);
        self.buffer.extend_from_slice(&value.to_le_bytes());
    }

    /// A fixed-size array of `float64`, or several `float64` fields in a row.
    pub(super) fn f64s(&mut self, values: &[f64]) {
        if !values.is_empty() {
            self.align(8);
            for value in values {
                self.buffer.extend_from_slice(&value.to_le_bytes());
            }
        }
    }

    /// Several `float32` fields in a row.
    pub(super) fn f32s(&mut self, values: &[f32]) {
        self.align(4);
        for value in values {
            self.buffer.extend_from_slice(&value.to_le_bytes());
        }
    }

    /// Number of elements that follow, as an unbounded sequence starts; far below 2^32 in every message here.
    pub(super) fn length(&mut self, elements: usize) {
        self.u32(u32::try_from(elements).unwrap_or(u32::MAX));
    }

    /// `string`: its length with the closing zero, its bytes, the zero.
    pub(super) fn string(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.buffer.extend_from_slice(text.as_bytes());
        self.buffer.push(0);
    }
}

#[cfg(test)]
mod tests {
    use super::Cdr;

    #[test]
    fn numbers_are_aligned_from_the_end_of_the_encapsulation() {
        let mut cdr = Cdr::default();
        cdr.begin();
        cdr.boolean(true);
        cdr.f64(1.0);
        cdr.boolean(false);
        cdr.i32(-2);
        let expected = [
            0, 1, 0, 0, // little-endian CDR
            1, 0, 0, 0, 0, 0, 0, 0, // bool, then seven bytes up to offset 8
            0, 0, 0, 0, 0, 0, 0xf0, 0x3f, // 1.0
            0, 0, 0, 0, // bool, then three bytes up to offset 20
            0xfe, 0xff, 0xff, 0xff, // -2
        ];
        assert_eq!(cdr.bytes(), expected, "bool, float64, bool, int32");
    }

    #[test]
    fn a_string_carries_its_closing_zero() {
        let mut cdr = Cdr::default();
        cdr.begin();
        cdr.string("tip");
        cdr.string("");
        let expected = [0, 1, 0, 0, 4, 0, 0, 0, b't', b'i', b'p', 0, 1, 0, 0, 0, 0];
        assert_eq!(cdr.bytes(), expected, "two strings");
    }

    #[test]
    fn an_empty_sequence_has_no_padding_after_its_length() {
        let mut cdr = Cdr::default();
        cdr.begin();
        cdr.length(0);
        cdr.u32(7);
        assert_eq!(cdr.bytes(), [0, 1, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0], "length 0, then uint32");
    }

    #[test]
    fn a_sequence_of_doubles_is_padded_after_its_length() {
        let mut cdr = Cdr::default();
        cdr.begin();
        cdr.length(1);
        cdr.f64s(&[-0.5]);
        let expected = [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xe0, 0xbf];
        assert_eq!(cdr.bytes(), expected, "one element");
    }

    #[test]
    fn the_buffer_is_used_again() {
        let mut cdr = Cdr::default();
        cdr.begin();
        cdr.string("a message that is longer than the next one");
        let capacity = cdr.buffer.capacity();
        cdr.begin();
        cdr.boolean(true);
        assert_eq!(cdr.bytes(), [0, 1, 0, 0, 1], "nothing of the first message is left");
        assert_eq!(cdr.buffer.capacity(), capacity, "its memory is kept");
    }
}
