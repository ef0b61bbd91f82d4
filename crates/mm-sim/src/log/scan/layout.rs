//! Whether what a record holds lies within it.
//!
//! The parser of the `mcap` crate makes room for a text of the length that is announced, up to 4 GiB, before it looks whether it is there, so one
//! flipped bit could end the program. Records are walked through here first.

use mcap::records::op;

/// Whether the texts and lists of a record end before it does, and an attachment has room for its length and checksum.
pub(super) fn fits(opcode: u8, data: &[u8]) -> bool {
    let walked = match opcode {
        op::HEADER => texts(data),
        op::SCHEMA => data.get(2..).and_then(texts),
        op::CHANNEL => data.get(4..).and_then(texts).and_then(map),
        op::CHUNK => data.get(28..).and_then(text),
        op::ATTACHMENT => data.get(16..).and_then(texts).and_then(|data| data.get(12..)),
        op::METADATA => text(data).and_then(map),
        _ => Some(data),
    };
    walked.is_some()
}

/// What follows two texts.
fn texts(data: &[u8]) -> Option<&[u8]> {
    text(data).and_then(text)
}

/// What follows a text.
fn text(data: &[u8]) -> Option<&[u8]> {
    counted(data).map(|(_, rest)| rest)
}

/// What follows a list of pairs of texts.
fn map(data: &[u8]) -> Option<&[u8]> {
    let (mut pairs, rest) = counted(data)?;
    while !pairs.is_empty() {
        pairs = texts(pairs)?;
    }
    Some(rest)
}

/// As many bytes as their count in front says, and what follows them.
fn counted(data: &[u8]) -> Option<(&[u8], &[u8])> {
    let (count, data) = data.split_first_chunk()?;
    data.split_at_checked(usize::try_from(u32::from_le_bytes(*count)).ok()?)
}

#[cfg(test)]
mod tests {
    use super::fits;
    use crate::log::{LogInfo, scan::End};
    use mcap::records::op;

    fn text(text: &str) -> Vec<u8> {
        [&u32::try_from(text.len()).expect("a short text").to_le_bytes(), text.as_bytes()].concat()
    }

    fn map(pairs: &[(&str, &str)]) -> Vec<u8> {
        let pairs: Vec<u8> =
            pairs.iter().flat_map(|(key, value)| [text(key), text(value)].concat()).collect();
        [&u32::try_from(pairs.len()).expect("a short list").to_le_bytes(), pairs.as_slice()].concat()
    }

    /// Law: a record that is as its layout says fits; one byte less does not, nor does one whose first text is announced longer than the record. Why: the
    /// parser behind it makes room for what is announced. Reference: the layouts of the MCAP specification.
    #[test]
    fn whole_records_fit_and_others_do_not() {
        let name = || text("name");
        let list = || map(&[("a", "1"), ("b", "")]);
        let records = [
            (op::HEADER, 0, [name(), name()].concat()),
            (op::SCHEMA, 2, [vec![0; 2], name(), name()].concat()),
            (op::CHANNEL, 4, [vec![0; 4], name(), name(), list()].concat()),
            (op::CHUNK, 28, [vec![0; 28], name()].concat()),
            (op::ATTACHMENT, 16, [vec![0; 16], name(), name(), vec![0; 12]].concat()),
            (op::METADATA, 0, [name(), list()].concat()),
        ];
        for (opcode, first_text, record) in records {
            assert!(fits(opcode, &record), "{opcode} as it should be");
            for length in 0..record.len() {
                assert!(!fits(opcode, &record[..length]), "{opcode} cut at {length}");
            }
            for announced in [5_u32, 1 << 16, u32::MAX] {
                let mut longer = record.clone();
                longer[first_text..first_text + 4].copy_from_slice(&announced.to_le_bytes());
                assert!(
                    !fits(opcode, &longer[..first_text + 8]),
                    "{opcode} with {announced} bytes announced"
                );
            }
        }
    }

    /// Found by fuzzing: a chunk whose compression is announced with 1.8 GB. It is damage, and what follows it is read.
    #[test]
    fn a_text_of_gigabytes_is_damage() {
        let chunk = [vec![0; 28], u32::MAX.to_le_bytes().to_vec(), vec![0; 8]].concat();
        let mut log = mcap::MAGIC.to_vec();
        for (opcode, data) in [
            (op::HEADER, [text("ros2"), text("")].concat()),
            (op::CHUNK, chunk),
            (op::METADATA, [text("after"), map(&[("a", "b")])].concat()),
        ] {
            log.push(opcode);
            log.extend_from_slice(&u64::try_from(data.len()).expect("a short record").to_le_bytes());
            log.extend_from_slice(&data);
        }
        let info = LogInfo::of(log.as_slice()).expect("a log");
        assert_eq!(info.scan.damage.len(), 1, "{:?}", info.scan);
        assert_eq!(info.scan.end, End::Torn, "it has no end");
        assert_eq!(info.entry("after", "a"), Some("b"), "what follows is read");
    }
}
