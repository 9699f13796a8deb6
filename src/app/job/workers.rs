//! Threads of a batch: jobs side by side, each on one thread, if there are enough of them; else one after the other, each
//! on all threads.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// From this many jobs a thread on, jobs run side by side: then no thread waits for another.
const JOBS_A_THREAD: usize = 4;

/// Returns the pools of a batch, one for each job that runs at a time. `threads` is the number of threads in all, by
/// default that of the current pool.
///
/// # Errors
/// [`ThreadPoolBuildError`] if the system gives no threads.
pub fn pools(jobs: usize, threads: Option<usize>) -> Result<Vec<ThreadPool>, ThreadPoolBuildError> {
    let threads = threads.unwrap_or_else(rayon::current_num_threads).max(1);
    let side_by_side = threads > 1 && jobs >= JOBS_A_THREAD * threads;
    let (workers, threads_each) = if side_by_side { (threads, 1) } else { (1, threads) };
    (0..workers).map(|_| ThreadPoolBuilder::new().num_threads(threads_each).build()).collect()
}
