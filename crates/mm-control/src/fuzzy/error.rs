//! Why a fuzzy table was refused.

use core::fmt;

/// Why a membership function, a rule table, a surface or a call was refused; the payload names the field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FuzzyError {
    /// The field holds a NaN or an infinite number.
    NonFinite(&'static str),
    /// The numbers of the field are not in ascending order, or a range has no width.
    Inverted(&'static str),
    /// A number or an index of the field lies outside what it may be.
    OutOfRange(&'static str),
    /// The field has no entry.
    Empty(&'static str),
    /// The field has another number of entries than the system has variables, or than the call needs.
    Length(&'static str),
    /// The field has more entries than there is room for.
    TooMany(&'static str),
    /// The exact centroid needs a piecewise-linear output set, which the field prevents.
    Curved(&'static str),
}

impl FuzzyError {
    /// Name of the field that was refused.
    #[must_use]
    pub const fn field(&self) -> &'static str {
        match self {
            Self::NonFinite(name)
            | Self::Inverted(name)
            | Self::OutOfRange(name)
            | Self::Empty(name)
            | Self::Length(name)
            | Self::TooMany(name)
            | Self::Curved(name) => name,
        }
    }
}

impl fmt::Display for FuzzyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reason = match self {
            Self::NonFinite(_) => "is not finite",
            Self::Inverted(_) => "is not in ascending order",
            Self::OutOfRange(_) => "is out of range",
            Self::Empty(_) => "is empty",
            Self::Length(_) => "has the wrong number of entries",
            Self::TooMany(_) => "has too many entries",
            Self::Curved(_) => "makes the output set curved: its centroid has to be sampled",
        };
        write!(f, "`{}` {reason}", self.field())
    }
}

impl core::error::Error for FuzzyError {}

#[cfg(test)]
mod tests {
    use super::FuzzyError;

    #[test]
    fn every_message_names_the_field() {
        for error in [
            FuzzyError::NonFinite("rules"),
            FuzzyError::Inverted("rules"),
            FuzzyError::OutOfRange("rules"),
            FuzzyError::Empty("rules"),
            FuzzyError::Length("rules"),
            FuzzyError::TooMany("rules"),
            FuzzyError::Curved("rules"),
        ] {
            let text = error.to_string();
            assert!(text.starts_with("`rules`"), "{text} does not name its field");
            assert!(!text.ends_with('.'), "{text} ends in a full stop");
        }
    }
}
