//! Counts positions of linkages between two questions about a stop, in this crate's own tests; elsewhere it does nothing.
//!
//! A search that is stopped ends as soon as it asks. What it may do between two questions is bounded in positions of the
//! linkage: a number that does not depend on the machine.

/// So many positions are about to be computed on this thread.
#[inline(always)]
pub(crate) fn computed(positions: usize) {
    #[cfg(test)]
    counted::computed(positions as u64);
    #[cfg(not(test))]
    let _ = positions;
}

/// The question whether to stop is asked on this thread. Whether a test wants the answer to be yes.
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

    /// The counts of this thread.
    #[derive(Clone, Copy, Debug, Default)]
    pub(crate) struct Counts {
        /// Questions so far.
        pub asked: u64,
        /// The most positions between two of them, before the stop.
        pub most: u64,
        /// Positions since the stop.
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

    /// Begins anew; from the question `stop_at` on the answer is yes.
    pub(crate) fn begin(stop_at: Option<u64>) {
        COUNTS.with(|cell| cell.set(Counts { stop_at, ..Counts::default() }));
    }

    /// The counts since the last beginning.
    pub(crate) fn counts() -> Counts {
        COUNTS.with(Cell::get)
    }
}
