//! Diagnostics: error messages about a text that a person wrote, with the place, the fault and the remedy.
//!
//! A [`Diagnostic`] displays as plain text of at most five lines:
//!
//! ```text
//! arm.toml:9:5: the bounds of `a` are the wrong way round: 50 is above 10
//! 9 | a = [50, 10]
//!   |     ^^^^^^^^
//! help: write [10, 50]
//! ```
//!
//! No text from outside reaches the terminal unescaped: see [`escaped`].

use std::fmt;
use std::ops::Range;

/// A diagnostic: an error message about an input, with the place in its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file as the user named it.
    pub file: String,
    /// The whole text that `span` refers to; empty if nothing could be read.
    pub text: String,
    /// The place in `text`, as a range of bytes.
    pub span: Option<Range<usize>>,
    /// The fault.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
}

/// A value that was read from a text, or the reason why the text is refused.
pub type Checked<T> = Result<T, Box<Diagnostic>>;

/// The largest number of characters of a source line that are displayed.
const WINDOW: usize = 96;
/// The number of characters that a window shows before the caret.
const LEAD: usize = 32;
/// The mark at the ends where a line is cut to a window.
const CUT: &str = "...";

impl Diagnostic {
    /// Returns a diagnostic about a whole file.
    pub fn new(file: impl Into<String>, text: impl Into<String>, message: impl Into<String>) -> Self {
        Diagnostic { file: file.into(), text: text.into(), span: None, message: message.into(), help: None }
    }

    /// Returns the diagnostic with a place in the text; `None`: it is about the whole file.
    #[must_use]
    pub fn at(mut self, span: impl Into<Option<Range<usize>>>) -> Self {
        self.span = span.into();
        self
    }

    /// Returns the diagnostic with a remedy.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Returns the line and column of the place, both counted from 1, columns in characters.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let place = self.place()?;
        Some((place.number, place.before.chars().count() + 1))
    }

    fn place(&self) -> Option<Place<'_>> {
        let span = self.span.as_ref()?;
        let start = floor_boundary(&self.text, span.start);
        let end = floor_boundary(&self.text, span.end).max(start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = self.text[start..].find('\n').map_or(self.text.len(), |i| start + i);
        let rest = self.text[start..line_end].trim_end_matches('\r');
        let marked = end.min(start + rest.len()) - start;
        Some(Place {
            number: self.text[..line_start].matches('\n').count() + 1,
            before: &self.text[line_start..start],
            marked: &rest[..marked],
            after: &rest[marked..],
        })
    }
}

/// A line of the text in three parts: before, in and after the marked place.
struct Place<'a> {
    number: usize,
    before: &'a str,
    marked: &'a str,
    after: &'a str,
}

fn floor_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

/// Returns whether a character could move the cursor, or hide or reorder what a terminal shows: controls, marks of
/// writing direction, separators of lines, characters without width.
fn is_unprintable(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}')
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}')
        || matches!(c, '\u{e0000}'..='\u{e007f}')
}

/// Returns the text with every character that could act on a terminal escaped: `\n`, `\x1b`, `\u{202e}`.
///
/// ```
/// use linkwright::internals::files::diagnostic::escaped;
/// assert_eq!(escaped("arm\u{1b}[31m.toml"), "arm\\x1b[31m.toml");
/// ```
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        push_escaped(&mut out, c);
    }
    out
}

fn push_escaped(out: &mut String, c: char) {
    match c {
        '\n' => out.push_str("\\n"),
        '\r' => out.push_str("\\r"),
        '\t' => out.push_str("\\t"),
        c if !is_unprintable(c) => out.push(c),
        c if u32::from(c) < 0x100 => out.push_str(&format!("\\x{:02x}", u32::from(c))),
        c => out.push_str(&format!("\\u{{{:x}}}", u32::from(c))),
    }
}

/// Returns a part of a source line as it is displayed: escaped, and a tab as one blank.
fn shown(part: &str) -> String {
    escaped(&part.replace('\t', " "))
}

/// Returns the first `count` characters of a text.
fn head(text: &str, count: usize) -> &str {
    text.char_indices().nth(count).map_or(text, |(i, _)| &text[..i])
}

/// Returns the last `count` characters of a text.
fn tail(text: &str, count: usize) -> &str {
    match count.checked_sub(1) {
        None => "",
        Some(last) => text.char_indices().rev().nth(last).map_or(text, |(i, _)| &text[i..]),
    }
}

/// Returns a text of any length as it may appear inside a message: quoted, escaped and cut after 60 characters.
pub(crate) fn quoted(text: &str) -> String {
    /// The largest number of characters: enough to recognise the text.
    const LONGEST: usize = 60;
    let cut = head(text, LONGEST);
    if cut.len() < text.len() {
        format!("\"{}{CUT}\"", escaped(cut))
    } else {
        format!("\"{}\"", escaped(cut))
    }
}

/// Returns a number with its noun: `3 points`.
pub(crate) fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (file, message) = (escaped(&self.file), escaped(&self.message));
        match self.place() {
            None => write!(f, "{file}: {message}")?,
            Some(place) => {
                let column = place.before.chars().count() + 1;
                writeln!(f, "{file}:{}:{column}: {message}", place.number)?;
                write_line(f, &place)?;
            }
        }
        match &self.help {
            None => Ok(()),
            Some(help) => write!(f, "\nhelp: {}", escaped(help)),
        }
    }
}

/// Writes the source line, cut to a window around the caret, and the caret under it.
fn write_line(f: &mut fmt::Formatter<'_>, place: &Place<'_>) -> fmt::Result {
    let (before, marked, after) = (shown(place.before), shown(place.marked), shown(place.after));
    let width = |s: &str| s.chars().count();
    let fits = width(&before) + width(&marked) + width(&after) <= WINDOW;
    let before = if fits || width(&before) <= LEAD {
        before
    } else {
        format!("{CUT}{}", tail(&before, LEAD - CUT.len()))
    };
    let room = WINDOW.saturating_sub(width(&before));
    let rest = format!("{marked}{after}");
    let rest = if width(&rest) <= room { rest } else { format!("{}{CUT}", head(&rest, room - CUT.len())) };
    let number = place.number.to_string();
    let line = format!("{before}{rest}");
    let carets = "^".repeat(width(&marked).clamp(1, width(&rest).max(1)));
    writeln!(f, "{number} | {}", line.trim_end())?;
    write!(f, "{} | {}{carets}", " ".repeat(number.len()), " ".repeat(width(&before)))
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_stands_under_the_place() {
        let d = Diagnostic::new("f.toml", "one\ntwo = 3\r\n", "wrong").at(10..11).with_help("write 4");
        assert_eq!(d.line_column(), Some((2, 7)));
        assert_eq!(d.to_string(), "f.toml:2:7: wrong\n2 | two = 3\n  |       ^\nhelp: write 4");
    }

    #[test]
    fn nothing_raw_reaches_the_terminal() {
        let d = Diagnostic::new("\u{1b}]0;f", "a\u{7}b\u{202e}c", "it\nis \u{9b}1m").at(3..4);
        let text = d.to_string();
        assert!(text.chars().all(|c| c == '\n' || !is_unprintable(c)), "{text:?}");
        assert!(text.starts_with("\\x1b]0;f:1:4: it\\nis \\x9b1m\n1 | a\\x07b\\u{202e}c\n"), "{text}");
    }

    #[test]
    fn a_long_line_is_cut_around_the_caret() {
        let text = format!("{}HERE{}", "a".repeat(5000), "b".repeat(5000));
        let shown = Diagnostic::new("f", text, "m").at(5000..5004).to_string();
        let lines: Vec<&str> = shown.lines().collect();
        assert!(lines.iter().all(|l| l.len() < 110));
        assert_eq!(lines[1].find("HERE"), lines[2].find("^^^^"));
        assert!(lines[1].contains("...a") && lines[1].ends_with("b..."));
    }

    #[test]
    fn a_span_outside_the_text_or_inside_a_character_does_no_harm() {
        for span in [0..100, 90..100, 1..2] {
            let _ = Diagnostic::new("f", "\u{fc}x", "m").at(span).to_string();
        }
        let _ = Diagnostic::new("f", "", "m").at(0..0).to_string();
    }
}
