//! Work on a pool while the calling thread waits, looks for signals and passes progress on.
//!
//! Observers run on the pool's threads, where Python has no signals. So the calling thread waits for the result without
//! the interpreter's lock, and takes the lock every 20 ms to check for Ctrl-C and to call the progress callback.

use crate::errors::{bug, guarded};
use crate::pools;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The time between two looks for a signal.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// The messages between the work and the waiting thread.
#[derive(Debug, Default)]
pub struct Talk {
    /// Set when the work should end with its best so far.
    pub cancel: AtomicBool,
    /// The latest progress, as JSON values by name; taken by the waiting thread.
    latest: Mutex<Option<serde_json::Value>>,
    /// Whether anybody listens.
    heard: bool,
}

impl Talk {
    /// Tells the progress, if anybody listens.
    pub fn tell(&self, progress: impl FnOnce() -> serde_json::Value) {
        if self.heard {
            *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress());
        }
    }

    fn take(&self) -> Option<serde_json::Value> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// The outcome of work, and the exception that ended it early, if one did.
pub struct Ended<T> {
    /// The outcome: of work that was ended early, its best by then.
    pub value: T,
    /// A KeyboardInterrupt, or what the signal handler or the callback raised.
    pub interrupt: Option<PyErr>,
}

/// Runs work on a pool of so many threads. `progress` is called with a dict.
///
/// # Errors
/// `InternalError` if it panics; the second interrupt, if one comes while the first is being obeyed.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Talk) -> T + Send + 'static,
) -> PyResult<Ended<T>> {
    let pool = pools::take(threads)?;
    let talk = Arc::new(Talk { heard: progress.is_some(), ..Talk::default() });
    let (sender, mut receiver) = sync_channel(1);
    let there = Arc::clone(&talk);
    pool.spawn(move || {
        let outcome = catch_unwind(AssertUnwindSafe(|| work(&there)));
        // If nobody waits any more, nobody wants it.
        let _ = sender.send(outcome);
    });
    let mut interrupt: Option<PyErr> = None;
    loop {
        let received;
        (receiver, received) = py.detach(move || {
            let received = receiver.recv_timeout(LOOK_EVERY);
            (receiver, received)
        });
        let over = !matches!(received, Err(RecvTimeoutError::Timeout));
        if let (Some(callback), None) = (progress, &interrupt)
            && let Some(told) = talk.take()
            && let Err(raised) = called(callback, &told)
        {
            talk.cancel.store(true, Ordering::Relaxed);
            interrupt = Some(raised);
        }
        if !over && let Err(raised) = py.check_signals() {
            if interrupt.is_some() {
                return Err(raised);
            }
            talk.cancel.store(true, Ordering::Relaxed);
            interrupt = Some(raised);
        }
        match received {
            Err(RecvTimeoutError::Timeout) => {}
            Ok(Ok(value)) => {
                pools::give_back(pool);
                return Ok(Ended { value, interrupt });
            }
            Ok(Err(panic)) => return Err(bug(panic.as_ref())),
            Err(RecvTimeoutError::Disconnected) => return Err(bug(&"the search ended without an answer")),
        }
    }
}

/// Runs work that has no best so far: an interrupt ends it without a result.
///
/// # Errors
/// As [`run`], and the interrupt.
pub fn run_whole<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Talk) -> T + Send + 'static,
) -> PyResult<T> {
    let Ended { value, interrupt } = run(py, pools::threads(None)?, None, work)?;
    interrupt.map_or(Ok(value), Err)
}

fn called(callback: &Bound<'_, PyAny>, told: &serde_json::Value) -> PyResult<()> {
    let told = crate::values::to_python(callback.py(), told)?;
    guarded(|| callback.call1((told,)).map(drop))
}

/// Returns an exception that carries the best so far as its attribute `result`.
pub fn carrying(py: Python<'_>, interrupt: PyErr, result: Bound<'_, PyAny>) -> PyErr {
    let value = interrupt.value(py);
    // An exception of a user's own may refuse attributes; it is raised all the same.
    if interrupt.is_instance_of::<PyKeyboardInterrupt>(py) || value.hasattr("__dict__").unwrap_or(false) {
        let _ = value.setattr("result", result);
    }
    interrupt
}
