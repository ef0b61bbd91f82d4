//! Vectors in space for serde: three numbers, without a length.

use nalgebra::{Scalar, Vector3};
use serde::de::{Deserialize, Deserializer};
use serde::ser::{Serialize, Serializer};

/// Writes x, y, z.
pub(crate) fn serialize<S: Serializer, T: Serialize>(
    vector: &Vector3<T>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let [[x, y, z]] = &vector.data.0;
    (x, y, z).serialize(serializer)
}

/// Reads x, y, z.
pub(crate) fn deserialize<'de, D: Deserializer<'de>, T: Scalar + Deserialize<'de>>(
    deserializer: D,
) -> Result<Vector3<T>, D::Error> {
    let [x, y, z] = <[T; 3]>::deserialize(deserializer)?;
    Ok(Vector3::new(x, y, z))
}
