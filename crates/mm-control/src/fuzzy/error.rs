//! Why a fuzzy table was refused.

use core::fmt;

/// Why a membership function, a rule table or a surface was refused; the payload names the field.
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
    /// The field has more entries than the engine has room for.
    TooMany(&'static str),
}

impl fmt::Display for FuzzyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite(name) => write!(f, "`{name}` is not finite"),
            Self::Inverted(name) => write!(f, "`{name}` is not in ascending order"),
            Self::OutOfRange(name) => write!(f, "`{name}` is out of range"),
            Self::Empty(name) => write!(f, "`{name}` is empty"),
            Self::TooMany(name) => write!(f, "`{name}` has too many entries"),
        }
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
            FuzzyError::TooMany("rules"),
        ] {
            let text = error.to_string();
            assert!(text.contains("`rules`"), "{text} does not name its field");
            assert!(!text.ends_with('.'), "{text} ends in a full stop");
        }
    }
}
