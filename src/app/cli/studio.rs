//! `studio`: a local page that answers while a target is drawn.

use super::arguments::Studio;
use super::inputs::RESULTS;
use super::{Ended, interrupt, terminal};
use crate::app::studio;
use crate::app::studio::StudioError;
use crate::app::studio::messages::Ask;
use crate::files::diagnostic::escaped;
use crate::files::problem_file::load_any;
use ariadne::ReportKind;
use std::path::Path;
use std::process::{Command, Stdio};

/// Where the studio is when no port is asked for: always the same, so that the page finds what it remembers.
const PORT: u16 = 8017;

/// Runs the command.
pub fn run(options: &Studio) -> Ended {
    let beginning = match options.problem.as_deref().map(|path| (path, load_any(path, &[]))) {
        None => None,
        Some((_, Err(diagnostic))) => {
            terminal::diagnose(ReportKind::Error, &diagnostic);
            return Ended::Refused;
        }
        Some((path, Ok(problem))) => match Ask::of(&problem) {
            Ok(ask) => Some(ask),
            Err(why) => {
                terminal::complain(&escaped(&format!("{}: {why}", path.display())));
                return Ended::Refused;
            }
        },
    };
    let beginning = beginning.as_ref();
    let results = options.out.as_deref().unwrap_or(Path::new(RESULTS));
    let bound = match options.port {
        Some(port) => studio::Studio::bind(port, beginning, results),
        // The usual port may be another studio's.
        None => match studio::Studio::bind(PORT, beginning, results) {
            Err(StudioError::Port { .. }) => studio::Studio::bind(0, beginning, results),
            bound => bound,
        },
    };
    let studio = match bound {
        Ok(studio) => studio,
        Err(e) => {
            terminal::complain(&e.to_string());
            return Ended::Refused;
        }
    };
    let address = studio.address();
    terminal::answer(&format!("{address}\n"));
    terminal::tell("The studio answers there until Ctrl-C ends it.");
    if !options.no_open {
        open(&address);
    }
    match studio.serve(interrupt::watch("closing the studio")) {
        Ok(()) => Ended::Good,
        Err(e) => {
            terminal::complain(&escaped(&e.to_string()));
            Ended::Refused
        }
    }
}

/// Opens the address in the usual browser. Where there is none, the address is on the terminal.
fn open(address: &str) {
    let (program, before): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(before).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    match command.spawn() {
        // Taken leave of on a thread of its own, so that no dead process stays behind.
        Ok(mut child) => {
            std::thread::spawn(move || {
                let _ = child.wait();
            });
        }
        Err(_) => terminal::tell("No browser was found here: open the address above in one."),
    }
}
