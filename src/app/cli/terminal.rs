//! Writing to the two streams, and how colourful the terminal is.

use crate::files::diagnostic::{Diagnostic, escaped};
use crate::report::Colour;
use ariadne::{Config, IndexType, Label, Report, ReportKind, Source};
use std::io::{self, ErrorKind, IsTerminal, Write, stderr, stdout};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether an answer could not be written.
static LOST: AtomicBool = AtomicBool::new(false);

/// Writes the answer to stdout. A full disk is complained of, and [`lost`] remembers it.
pub fn answer(text: &str) {
    let mut out = stdout().lock();
    note(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
}

/// Takes note of how writing to stdout ended. A reader that went away (`| head`) is no failure of ours.
pub fn note(written: io::Result<()>) {
    if let Err(e) = written
        && e.kind() != ErrorKind::BrokenPipe
        && !LOST.swap(true, Ordering::Relaxed)
    {
        complain(&format!("the answer cannot be written to standard output: {e}"));
    }
}

/// Whether an answer was lost on its way to stdout.
pub fn lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// Writes a line to stderr.
pub fn tell(text: &str) {
    let _ = writeln!(stderr().lock(), "{text}");
}

/// Writes an error line to stderr, control characters made visible.
pub fn complain(text: &str) {
    tell(&format!("error: {}", escaped(text)));
}

/// Returns a path as it is shown: control characters made visible.
pub fn shown(path: &Path) -> String {
    escaped(&path.display().to_string())
}

fn colour_wanted(is_terminal: bool) -> bool {
    is_terminal && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// The colour for stdout.
pub fn colour() -> Colour {
    if colour_wanted(stdout().is_terminal()) { Colour::Always } else { Colour::Never }
}

/// Writes a diagnostic to stderr: in colour on a terminal, else as plain text.
pub fn diagnose(kind: ReportKind<'_>, diagnostic: &Diagnostic) {
    let colourful = colour_wanted(stderr().is_terminal());
    let Some(span) = diagnostic.span.clone().filter(|_| colourful && is_plain(&diagnostic.text)) else {
        let word = if kind == ReportKind::Warning { "warning" } else { "error" };
        tell(&format!("{word}: {diagnostic}"));
        return;
    };
    let file = escaped(&diagnostic.file);
    let place = (file.clone(), span);
    let mut report = Report::build(kind, place.clone())
        .with_config(Config::default().with_index_type(IndexType::Byte))
        .with_message(escaped(&diagnostic.message))
        .with_label(Label::new(place).with_message("here"));
    if let Some(help) = &diagnostic.help {
        report.set_help(escaped(help));
    }
    let _ = report.finish().eprint((file, Source::from(&diagnostic.text)));
}

/// Whether a text can be shown as it is: no control characters, no line too long for a screen.
fn is_plain(text: &str) -> bool {
    text.lines().all(|line| line.len() <= 200 && !line.contains(|c: char| c.is_control() && c != '\t'))
}
