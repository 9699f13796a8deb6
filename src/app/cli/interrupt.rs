//! Signals. Ctrl-C: the first ends the search with its best so far, the second ends the process. A file over the limit
//! of its size (`ulimit -f`): the write fails.

use std::sync::atomic::{AtomicBool, Ordering};

static CANCELLED: AtomicBool = AtomicBool::new(false);

/// Watches for Ctrl-C from now on, and returns the flag that it sets. `doing` names the effect of the first Ctrl-C.
pub fn watch(doing: &'static str) -> &'static AtomicBool {
    let handler = move || {
        if CANCELLED.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        super::terminal::tell(&format!("\ninterrupted: {doing} (Ctrl-C again to end at once)"));
    };
    // A second handler in one process, or a platform without signals: then Ctrl-C ends the process as ever.
    let _ = ctrlc::set_handler(handler);
    &CANCELLED
}

/// Lets a write over the limit of a file's size fail with an error, as a full disk does, instead of ending the process by
/// SIGXFSZ: from now on nothing half-written stays, and the error names the file.
#[cfg(unix)]
pub fn outlive_large_files() {
    use signal_hook::{consts::SIGXFSZ, flag};
    // Noting the signal is enough: the write returns EFBIG. Where that cannot be had, it is as it ever was.
    let _ = flag::register(SIGXFSZ, std::sync::Arc::new(AtomicBool::new(false)));
}

/// Other systems have no such signal.
#[cfg(not(unix))]
pub fn outlive_large_files() {}
