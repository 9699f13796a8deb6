//! Writing to the two streams, and how colourful the terminal is.

use crate::files::diagnostic::Diagnostic;
use crate::report::Colour;
use ariadne::{Config, IndexType, Label, Report, ReportKind, Source};
use std::io::{ErrorKind, IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether an answer could not be written.
static LOST: AtomicBool = AtomicBool::new(false);

/// Writes the answer to stdout. A reader that went away (`| head`) is no failure of ours; a full disk is
/// complained of, and [`lost`] remembers it.
pub fn answer(text: &str) {
    let mut out = stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
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
    tell(&format!("error: {}", crate::files::diagnostic::escaped(text)));
}

fn colour_wanted(is_terminal: bool) -> bool {
    is_terminal && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// Whether stdout is a terminal.
pub fn stdout_is_terminal() -> bool {
    stdout().is_terminal()
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
    let file = crate::files::diagnostic::escaped(&diagnostic.file);
    let mut report = Report::build(kind, (file.clone(), span.clone()))
        .with_config(Config::default().with_index_type(IndexType::Byte))
        .with_message(crate::files::diagnostic::escaped(&diagnostic.message));
    report.add_label(Label::new((file.clone(), span)).with_message("here"));
    if let Some(help) = &diagnostic.help {
        report.set_help(crate::files::diagnostic::escaped(help));
    }
    let _ = report.finish().eprint((file, Source::from(&diagnostic.text)));
}

/// Whether a text can be shown as it is: no control characters, no line too long for a screen.
fn is_plain(text: &str) -> bool {
    text.lines().all(|line| line.len() <= 200 && !line.contains(|c: char| c.is_control() && c != '\t'))
}
