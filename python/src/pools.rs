//! Thread pools that are kept between calls.
//!
//! A pool serves one call at a time, so that calls from several threads never wait for each other's work. Pools are
//! those of this process: a child that was forked has none of its parent's threads, and makes its own.

use crate::errors::refused;
use pyo3::PyResult;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::process;
use std::sync::Mutex;
use std::thread::available_parallelism;

/// The most pools that wait for their next call.
const MOST_KEPT: usize = 8;
/// The most threads of a pool, as on the command line.
const MOST_THREADS: usize = 1024;

/// A pool with the process whose threads it has, and their number.
struct Kept {
    process: u32,
    threads: usize,
    pool: ThreadPool,
}

static KEPT: Mutex<Vec<Kept>> = Mutex::new(Vec::new());

/// Returns the number of threads that is asked for, else that of the environment or of the machine.
///
/// # Errors
/// `ProblemError` unless it is from 1 to 1024.
pub fn threads(asked: Option<i64>) -> PyResult<usize> {
    match asked.map(usize::try_from) {
        Some(Ok(threads)) if (1..=MOST_THREADS).contains(&threads) => Ok(threads),
        Some(_) => {
            let asked = asked.unwrap_or_default();
            Err(refused(format!("threads = {asked}: a whole number from 1 to {MOST_THREADS} is needed")))
        }
        None => {
            let named = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse().ok());
            let named = named.filter(|threads| (1..=MOST_THREADS).contains(threads));
            Ok(named.unwrap_or_else(|| {
                available_parallelism().map_or(1, |threads| threads.get().min(MOST_THREADS))
            }))
        }
    }
}

/// Takes a pool of so many threads for a call.
///
/// # Errors
/// `ProblemError` if the system gives no threads.
pub fn take(threads: usize) -> PyResult<ThreadPool> {
    // In a child that was forked while another thread held the lock it is never released: then a pool is made.
    if let Ok(mut kept) = KEPT.try_lock() {
        let here = process::id();
        if kept.iter().any(|one| one.process != here) {
            // Their threads do not exist here, so there is nothing to end.
            let (own, parents): (Vec<_>, Vec<_>) = kept.drain(..).partition(|one| one.process == here);
            *kept = own;
            std::mem::forget(parents);
        }
        if let Some(i) = kept.iter().position(|one| one.threads == threads) {
            return Ok(kept.swap_remove(i).pool);
        }
    }
    let made =
        ThreadPoolBuilder::new().num_threads(threads).thread_name(|i| format!("linkwright-{i}")).build();
    made.map_err(|e| refused(format!("no threads to search with: {e}")))
}

/// Keeps a pool whose call has ended for the next one.
pub fn give_back(pool: ThreadPool) {
    let threads = pool.current_num_threads();
    if let Ok(mut kept) = KEPT.try_lock() {
        if kept.len() >= MOST_KEPT {
            kept.remove(0);
        }
        kept.push(Kept { process: process::id(), threads, pool });
    }
}
