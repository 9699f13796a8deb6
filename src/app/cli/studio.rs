//! `studio`: a local page that answers while a target is drawn.

use super::arguments::Studio;
use super::inputs::RESULTS;
use super::{Ended, interrupt, keyboard, refuse, refuse_at, refuse_path, terminal};
use crate::app::studio;
use crate::app::studio::StudioError;
use crate::app::studio::messages::Ask;
use crate::app::studio::reading::of_report;
use crate::files::input_text;
use crate::files::problem_file::load_any;
use std::path::Path;
use std::process::{Command, Stdio};

/// The usual port: always the same, so that the page finds its stored state again.
const PORT: u16 = 8017;

/// Runs the command.
pub fn run(options: &Studio) -> Result<Ended, Ended> {
    let beginning = options.problem.as_deref().map(beginning).transpose()?;
    let beginning = beginning.as_ref();
    let results = options.out.as_deref().unwrap_or(Path::new(RESULTS));
    let bind = |port| studio::Studio::bind(port, beginning, results);
    let bound = match options.port {
        Some(port) => bind(port),
        None => match bind(PORT) {
            // The usual port may be another studio's.
            Err(StudioError::Port { .. }) => bind(0),
            bound => bound,
        },
    };
    let studio = bound.map_err(refuse)?;
    let address = studio.address();
    terminal::answer(&format!("{address}\n"));
    terminal::tell("The studio answers there until Ctrl-C ends it.");
    let doorkeeper = studio.doorkeeper();
    let another = move || match doorkeeper.another_address() {
        Ok(address) => terminal::answer(&format!("{address}\n")),
        Err(why) => terminal::complain(&why.to_string()),
    };
    if keyboard::on_enter(another) {
        terminal::tell("Enter prints the address for another browser.");
    }
    if !options.no_open {
        open(&address);
    }
    studio.serve(interrupt::watch("closing the studio")).map_err(refuse)?;
    Ok(Ended::Good)
}

/// Reads the problem that the page begins with.
fn beginning(path: &Path) -> Result<Ask, Ended> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    if ending.is_some_and(|ending| ending == "html" || ending == "htm") {
        let text = input_text::read(path).map_err(refuse_at)?;
        return of_report(&text).map_err(|why| refuse_path(path, why));
    }
    let problem = load_any(path, &[]).map_err(refuse_at)?;
    Ask::of(&problem).map_err(|why| refuse_path(path, why))
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
