//! Counter of linkage positions computed between two checks for a stop, in this crate's own tests; elsewhere it does
//! nothing.
//!
//! A stopped search ends at its next check. Its work between two checks is bounded in positions of the linkage, a
//! number that does not depend on the machine.

/// Least number of points of a target that a thread takes at once: for a few positions each, tens of microseconds of work.
pub(crate) const POINTS_AT_ONCE: usize = 512;

/// Records that so many positions are about to be computed on this thread.
#[inline(always)]
pub(crate) fn computed(positions: usize) {
    #[cfg(test)]
    counted::computed(positions as u64);
    #[cfg(not(test))]
    let _ = positions;
}

/// Records a check for a stop on this thread and returns whether a test demands the stop.
#[inline(always)]
pub(crate) fn is_stopped_by_a_test() -> bool {
    #[cfg(test)]
    return counted::asked();
    #[cfg(not(test))]
    false
}

#[cfg(test)]
pub(crate) mod counted {
    use std::cell::Cell;

    /// Counters of this thread.
    #[derive(Clone, Copy, Debug, Default)]
    pub(crate) struct Counts {
        /// Number of checks so far.
        pub asked: u64,
        /// Largest number of positions between two checks, before the stop.
        pub most: u64,
        /// Number of positions since the stop.
        pub after: u64,
        since: u64,
        stop_at: Option<u64>,
    }

    thread_local! {
        static COUNTS: Cell<Counts> =
            const { Cell::new(Counts { asked: 0, most: 0, after: 0, since: 0, stop_at: None }) };
    }

    fn change(by: impl FnOnce(&mut Counts)) -> Counts {
        COUNTS.with(|cell| {
            let mut counts = cell.get();
            by(&mut counts);
            cell.set(counts);
            counts
        })
    }

    impl Counts {
        fn is_stopped(&self) -> bool {
            self.stop_at.is_some_and(|at| self.asked >= at)
        }
    }

    pub(super) fn computed(positions: u64) {
        change(|counts| {
            if counts.is_stopped() {
                counts.after += positions;
            } else {
                counts.since += positions;
            }
        });
    }

    pub(super) fn asked() -> bool {
        let counts = change(|counts| {
            counts.asked += 1;
            counts.most = counts.most.max(counts.since);
            counts.since = 0;
        });
        counts.is_stopped()
    }

    /// Resets the counters; from check number `stop_at` on the search is to stop.
    pub(crate) fn begin(stop_at: Option<u64>) {
        COUNTS.with(|cell| cell.set(Counts { stop_at, ..Counts::default() }));
    }

    /// Returns the counts since the last call of [`begin`].
    pub(crate) fn counts() -> Counts {
        COUNTS.with(Cell::get)
    }
}
