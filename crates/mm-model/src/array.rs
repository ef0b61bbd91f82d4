//! Arrays of N elements for serde, which knows those of fixed lengths only: a tuple of N, by `#[serde(with = "mm_model::array")]`.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeTuple, Serializer};

/// Writes the elements in order.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer, E: Serialize, const N: usize>(
    array: &[E; N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(N)?;
    for element in array {
        tuple.serialize_element(element)?;
    }
    tuple.end()
}

/// Reads exactly N elements.
///
/// # Errors
/// Another number of elements, or those of the deserializer.
pub fn deserialize<'de, D: Deserializer<'de>, E: Copy + Deserialize<'de>, const N: usize>(
    deserializer: D,
) -> Result<[E; N], D::Error> {
    deserializer.deserialize_tuple(N, Elements(PhantomData))
}

struct Elements<E, const N: usize>(PhantomData<E>);

impl<'de, E: Copy + Deserialize<'de>, const N: usize> Visitor<'de> for Elements<E, N> {
    type Value = [E; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{N} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<[E; N], A::Error> {
        let none: &[E] = &[];
        // An array of none needs no element; every other is filled with its first one to begin with.
        if let Ok(empty) = <[E; N]>::try_from(none) {
            return Ok(empty);
        }
        let first = elements.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let mut array = [first; N];
        for (i, element) in array.iter_mut().enumerate().skip(1) {
            *element = elements.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        Ok(array)
    }
}
