//! A transport delay of whole periods.

/// Gives each value back as many pushes later as it is long; filled with the first value at the start.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DelayLine<T> {
    length: usize,
    held: std::collections::VecDeque<T>,
}

impl<T: Copy> DelayLine<T> {
    /// A delay of `length` pushes; 0 passes everything on at once.
    #[must_use]
    pub fn new(length: usize) -> Self {
        Self { length, held: std::collections::VecDeque::with_capacity(length + 1) }
    }

    /// Takes the value of now, and gives the one of `length` pushes ago; before there is one, the first of all.
    pub fn push(&mut self, value: T) -> T {
        self.held.push_back(value);
        if self.held.len() > self.length
            && let Some(oldest) = self.held.pop_front()
        {
            return oldest;
        }
        self.held.front().copied().unwrap_or(value)
    }
}

#[cfg(test)]
mod tests {
    use super::DelayLine;

    /// Law: the n-th output is the (n - length)-th input, and the first before. Reference: the definition.
    #[test]
    fn each_value_comes_back_after_the_length() {
        for length in 0..5_usize {
            let mut line = DelayLine::new(length);
            for n in 0..50_usize {
                assert_eq!(line.push(n), n.saturating_sub(length), "push {n} of a line of {length}");
            }
        }
    }
}
