//! Work on several cores whose results come in the order of the jobs, whatever order they were done in.

use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use rayon::iter::{ParallelBridge as _, ParallelIterator as _};

/// A number of threads that share the work.
#[derive(Debug)]
pub struct Pool(rayon::ThreadPool);

/// The threads could not be started.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {jobs} threads")]
pub struct PoolError {
    jobs: usize,
    #[source]
    source: rayon::ThreadPoolBuildError,
}

impl Pool {
    /// A pool of so many threads; without a number, one for each core.
    ///
    /// # Errors
    /// The system starts no more threads.
    pub fn new(jobs: Option<usize>) -> Result<Self, PoolError> {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let jobs = jobs.unwrap_or_else(cores).max(1);
        let built = rayon::ThreadPoolBuilder::new().num_threads(jobs).build();
        built.map(Self).map_err(|source| PoolError { jobs, source })
    }

    /// Does the work of each number and hands the results, in the order of the numbers, to `take` on the calling thread.
    ///
    /// Numbers are begun in their order. `take` may end it: work under way is then finished and forgotten.
    pub fn in_order<T: Send>(
        &self,
        numbers: Range<u64>,
        work: impl Fn(u64) -> T + Sync,
        mut take: impl FnMut(u64, T) -> ControlFlow<()>,
    ) {
        let (sender, receiver) = mpsc::channel();
        let ended = AtomicBool::new(false);
        let (work, ended_ref) = (&work, &ended);
        let mut next = numbers.start;
        self.0.in_place_scope(|scope| {
            scope.spawn(move |_| {
                numbers.par_bridge().for_each_with(sender, |sender, number| {
                    if !ended_ref.load(Ordering::Relaxed) {
                        let _ = sender.send((number, work(number)));
                    }
                });
            });
            let mut waiting = BTreeMap::new();
            for (number, result) in receiver {
                waiting.insert(number, result);
                while let Some(result) = waiting.remove(&next) {
                    if !ended.load(Ordering::Relaxed) && take(next, result).is_break() {
                        ended.store(true, Ordering::Relaxed);
                    }
                    next += 1;
                }
            }
        });
    }

    /// The results of the work on each item, in their order.
    pub fn map<I: Sync, T: Send>(&self, items: &[I], work: impl Fn(&I) -> T + Sync) -> Vec<T> {
        let mut results = Vec::with_capacity(items.len());
        let at = |number: u64| usize::try_from(number).ok().and_then(|index| items.get(index));
        self.in_order(
            0..items.len() as u64,
            |number| at(number).map(&work),
            |_, result| {
                results.extend(result);
                ControlFlow::Continue(())
            },
        );
        results
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Work that takes the longer the smaller its number, so that results come in the wrong order.
    fn slow_first(number: u64) -> u64 {
        std::thread::sleep(std::time::Duration::from_millis(8_u64.saturating_sub(number)));
        number * number
    }

    #[test]
    fn results_come_in_order_for_any_number_of_threads() {
        for jobs in [1, 2, 5] {
            let mut taken = Vec::new();
            let pool = Pool::new(Some(jobs)).expect("threads");
            pool.in_order(3..12, slow_first, |number, result| {
                taken.push((number, result));
                ControlFlow::Continue(())
            });
            let wanted: Vec<_> = (3..12).map(|number| (number, number * number)).collect();
            assert_eq!(taken, wanted, "{jobs} threads");
            assert_eq!(pool.map(&[1, 2, 3], |x| 2 * x), [2, 4, 6], "a list");
        }
    }

    #[test]
    fn nothing_is_taken_after_the_end() {
        let mut taken = Vec::new();
        Pool::new(Some(2)).expect("threads").in_order(0..1000, slow_first, |number, _| {
            taken.push(number);
            if number == 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(taken, [0, 1, 2, 3, 4], "up to the one that ended it");
    }
}
