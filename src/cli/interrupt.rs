//! Ctrl-C: the first ends the search with its best so far, the second ends the process.

use std::sync::atomic::{AtomicBool, Ordering};

static CANCELLED: AtomicBool = AtomicBool::new(false);

/// Watches for Ctrl-C from now on; the flag that it sets. `doing` says what the first Ctrl-C brings about.
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
