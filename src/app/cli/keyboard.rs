//! Enter, pressed at the terminal while a command runs.

use std::io::{IsTerminal, Read, stdin};
use std::thread;

/// Calls `act` for every line that is typed at the terminal, on a thread of its own; returns whether there is a terminal.
/// Nothing is read of a pipe or a file, nor while the terminal is another process's.
pub fn on_enter(act: impl Fn() + Send + 'static) -> bool {
    if !stdin().is_terminal() {
        return false;
    }
    let listen = move || {
        // A terminal gives one line at a time.
        let mut line = [0; 1024];
        while waits_for_a_line() && matches!(stdin().read(&mut line), Ok(1..)) {
            if line.contains(&b'\n') {
                act();
                line.fill(0);
            }
        }
    };
    thread::Builder::new().name("keyboard".into()).spawn(listen).is_ok()
}

/// Waits until there is a line to be read; false if none will come any more.
///
/// A process in the background that reads from its terminal is stopped by the system, and its studio with it: it waits
/// until it is in front again.
#[cfg(unix)]
fn waits_for_a_line() -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::io::Errno;
    use std::time::Duration;
    const LOOK: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };
    loop {
        let terminal = stdin();
        if !is_in_front() {
            thread::sleep(Duration::from_secs(1));
            continue;
        }
        match poll(&mut [PollFd::new(&terminal, PollFlags::IN)], Some(&LOOK)) {
            Ok(0) | Err(Errno::INTR) => {}
            Ok(_) if is_in_front() => return true,
            Ok(_) => {}
            Err(_) => return false,
        }
    }
}

/// Whether the terminal is this process's. One that controls no processes stops none either.
#[cfg(unix)]
fn is_in_front() -> bool {
    use rustix::process::getpgrp;
    use rustix::termios::tcgetpgrp;
    tcgetpgrp(stdin()).map_or(true, |front| front == getpgrp())
}

/// Elsewhere nobody is stopped by reading.
#[cfg(not(unix))]
fn waits_for_a_line() -> bool {
    true
}
