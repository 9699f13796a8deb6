//! Parts of a batch that run in parallel and are read in their order, within the evaluations that are left.

use crate::synthesis::driver::spared;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Runs parts in parallel, the earlier ones first: those that end may tell later ones that they will not be read.
pub(super) fn in_order<T: Send>(parts: Range<u64>, run: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let next = AtomicU64::new(parts.start);
    let mut done: Vec<(u64, T)> = parts
        .into_par_iter()
        .map(|_| {
            let part = next.fetch_add(1, Ordering::Relaxed);
            (part, run(part))
        })
        .collect();
    done.sort_by_key(|(part, _)| *part);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Returns the number of parts from the first on whose evaluations fit into those left together, and that these did not
/// limit.
pub(super) fn suffice_for(left: u64, costs: impl Iterator<Item = u64>) -> usize {
    let mut sum = 0_u64;
    let fits = |cost: &u64| {
        sum += cost;
        sum <= left && spared(*cost, left)
    };
    costs.take_while(fits).count()
}

/// Tells parts that run in parallel, and are read in their order, whether they will be read: one that will not may stop.
#[derive(Debug)]
pub(super) struct Reading {
    /// The index of the first part with an exact answer; those after it are not read.
    exact: AtomicU64,
    /// The index of the first part, and the evaluations of the parts that have ended.
    first: u64,
    spent: Vec<AtomicU64>,
    /// The evaluations allowed; parts before which more were spent are not read.
    left: u64,
}

impl Reading {
    pub(super) fn new(parts: Range<u64>, left: u64) -> Self {
        let (first, spent) = (parts.start, parts.map(|_| AtomicU64::new(0)).collect());
        Reading { exact: AtomicU64::new(u64::MAX), first, spent, left }
    }

    /// Returns whether a part will not be read.
    pub(super) fn is_unread(&self, part: u64) -> bool {
        let before =
            self.spent.iter().take((part - self.first) as usize).map(|spent| spent.load(Ordering::Relaxed));
        self.exact.load(Ordering::Relaxed) < part || before.sum::<u64>() > self.left
    }

    /// Records that a part ended.
    pub(super) fn ended(&self, part: u64, evaluations: u64, exact: bool) {
        if exact {
            self.exact.fetch_min(part, Ordering::Relaxed);
        }
        if let Some(spent) = self.spent.get((part - self.first) as usize) {
            spent.store(evaluations, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_parts_that_the_evaluations_suffice_for_are_read() {
        let fit = |left, costs: &[u64]| suffice_for(left, costs.iter().copied());
        assert_eq!(fit(1000, &[400, 300, 300, 1]), 3);
        assert_eq!(fit(1000, &[400, 300, 301, 1]), 2, "one that is cut ends them");
        assert_eq!(fit(1000, &[900, 1]), 0, "one that came near its allowance may have been cut");
        assert_eq!(fit(10, &[1, 1]), 0, "too little for any");
        assert_eq!(fit(1000, &[]), 0);
    }

    #[test]
    fn parts_run_in_parallel_and_come_back_in_their_order() {
        assert_eq!(in_order(3..40, |part| part * part), (3..40).map(|part| part * part).collect::<Vec<_>>());
    }
}
