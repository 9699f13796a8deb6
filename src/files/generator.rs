//! The generator mark of written files: every file that a person names bears it, and a file without it is never
//! replaced.
//!
//! | kind of file | known by |
//! |---|---|
//! | SVG, HTML, DXF, STL, OpenSCAD, PNG, GIF, cut list, Markdown | the words of [`mark`], at the writer's place for them |
//! | linkage file | the mark in its first line, and its table (`[linkage]`, `[slider_crank]`, `[inverted_slider_crank]`, `[chain]`), still in it |
//! | file of loads | the mark in its first line, and its table `[loads]` |
//! | CSV | its header row, equal to that of the file which replaces it |
//! | JSON | `tool.name`, and the key that the kind is about |
//! | problem file | never: it is a user's from the moment it is there |
//!
//! One function, [`FileKind::is_written_by_us`], decides for every writer.

/// The name of the generator in every mark.
pub const NAME: &str = "linkwright";
/// The largest file, in bytes, in whose whole text a mark is searched.
pub const MAX_BYTES: u64 = 64 << 20;
/// The number of bytes at the beginning of a file that contain a mark without a fixed place.
const HEAD: usize = 8192;

/// Returns the mark of this version: `written by linkwright 0.1.0`.
pub fn mark() -> String {
    format!("written by {NAME} {}", env!("CARGO_PKG_VERSION"))
}

/// The beginning of a mark, whatever the version.
const MARK: &str = "written by linkwright";

/// A kind of file that can be written to a path of the user's choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// An SVG drawing.
    Svg,
    /// A DXF drawing, for CAD programs.
    Dxf,
    /// An STL file: bodies as triangles, in text.
    Stl,
    /// An OpenSCAD script.
    Scad,
    /// An HTML page with its script.
    Html,
    /// A linkage file (TOML).
    Linkage,
    /// A file of loads (TOML).
    Loads,
    /// A problem file (TOML). It belongs to the user as soon as it exists, so that no file is recognised as this kind.
    Problem,
    /// A table (CSV).
    Csv,
    /// A linkage as JSON.
    LinkageJson,
    /// Results of a suite as JSON.
    SuiteJson,
    /// Results of a suite as Markdown.
    SuiteMarkdown,
    /// A cut list: the sizes of the plates, as text.
    CutList,
    /// A picture (PNG).
    Png,
    /// An animation (GIF).
    Gif,
}

impl FileKind {
    /// Returns the kind with its article, for messages.
    pub fn described(self) -> &'static str {
        match self {
            FileKind::Svg => "an SVG drawing",
            FileKind::Dxf => "a DXF drawing",
            FileKind::Stl => "an STL file",
            FileKind::Scad => "an OpenSCAD script",
            FileKind::Html => "an HTML page",
            FileKind::Linkage => "a linkage file (TOML)",
            FileKind::Loads => "a file of loads (TOML)",
            FileKind::Problem => "a problem file (TOML)",
            FileKind::Csv => "a CSV table with these columns",
            FileKind::LinkageJson => "a linkage as JSON",
            FileKind::SuiteJson => "a suite's results as JSON",
            FileKind::SuiteMarkdown => "a suite's results as Markdown",
            FileKind::CutList => "a cut list",
            FileKind::Png => "a PNG picture",
            FileKind::Gif => "a GIF picture",
        }
    }

    /// Returns whether `existing`, the bytes of a file, is one that this program wrote as this kind, whatever its
    /// version, and whatever was edited apart from the mark. `new` is the content that is to replace it: a table is
    /// recognised by its header row alone.
    ///
    /// ```
    /// use linkwright::internals::files::generator::{FileKind, mark};
    /// let ours = format!("Cut list: my-path\n{}\n", mark());
    /// assert!(FileKind::CutList.is_written_by_us(ours.as_bytes(), b""));
    /// assert!(!FileKind::CutList.is_written_by_us(b"milk, eggs, butter\n", b""));
    /// ```
    pub fn is_written_by_us(self, existing: &[u8], new: &[u8]) -> bool {
        let head = String::from_utf8_lossy(&existing[..existing.len().min(HEAD)]);
        let head = head.trim_start_matches('\u{feff}');
        let line = |n: usize| head.lines().nth(n).unwrap_or_default().trim();
        match self {
            // A drawing that another program has saved again may begin with an XML declaration.
            FileKind::Svg => {
                (head.starts_with("<svg") || head.starts_with("<?xml"))
                    && head.contains(&format!("<!-- {MARK}"))
            }
            FileKind::Html => {
                head.starts_with("<!doctype html>")
                    && head.contains(&format!("<meta name=\"generator\" content=\"{NAME} "))
            }
            FileKind::Dxf => line(0) == "999" && line(1).starts_with(MARK),
            FileKind::Stl => line(0).starts_with("solid ") && line(0).contains(MARK),
            FileKind::Scad => {
                head.lines().take_while(|line| line.starts_with("//")).any(|line| line.contains(MARK))
            }
            FileKind::CutList => line(0).starts_with("Cut list") && line(1).starts_with(MARK),
            FileKind::Linkage => line(0).starts_with('#') && line(0).contains(MARK) && is_linkage(existing),
            FileKind::Loads => {
                line(0).starts_with("# Loads of a linkage")
                    && line(0).contains(MARK)
                    && head.contains("[loads]")
            }
            FileKind::Problem => false,
            FileKind::Csv => first_line(existing) == first_line(new) && !first_line(new).is_empty(),
            FileKind::LinkageJson => is_json(existing, "linkage", "candidates"),
            FileKind::SuiteJson => is_json(existing, "problems", "problem"),
            FileKind::SuiteMarkdown => {
                line(0).starts_with("# ") && line(2).starts_with("Written by linkwright ")
            }
            FileKind::Png => existing.starts_with(b"\x89PNG\r\n\x1a\n") && holds(existing, "linkwright "),
            FileKind::Gif => existing.starts_with(b"GIF8") && holds(existing, MARK),
        }
    }
}

/// Returns whether the first bytes contain a text.
fn holds(bytes: &[u8], text: &str) -> bool {
    bytes[..bytes.len().min(HEAD)].windows(text.len()).any(|window| window == text.as_bytes())
}

/// Returns the first line, without its line ending and without a byte order mark.
fn first_line(bytes: &[u8]) -> &[u8] {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// The tables of the linkage files that are written.
const LINKAGES: [&str; 4] = ["linkage", "slider_crank", "inverted_slider_crank", "chain"];

/// Returns whether a text is still a linkage file: a user who has made a problem of one may have left the mark in.
fn is_linkage(bytes: &[u8]) -> bool {
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    let table = text.trim_start_matches('\u{feff}').parse::<toml::Table>();
    let of_a_kind = |table: &toml::Table| LINKAGES.iter().any(|key| table.contains_key(*key));
    table.is_ok_and(|table| of_a_kind(&table) && !table.contains_key("task"))
}

/// Returns whether a text is JSON of this tool with the key `with` and without the key `without`.
fn is_json(bytes: &[u8], with: &str, without: &str) -> bool {
    let value: serde_json::Value = serde_json::from_slice(bytes).unwrap_or_default();
    value["tool"]["name"] == NAME && value.get(with).is_some() && value.get(without).is_none()
}
