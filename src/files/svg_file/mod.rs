//! SVG drawings as targets: one shape of a drawing as target points, spaced evenly by arc length, y up.
//!
//! The shape r(t) of the drawing is mapped by every transform above it, then (x, y) becomes (x, -y), then the points
//! r(s_i) are taken at s_i = i L / n of a closed curve of length L and at s_i = i L / (n - 1) of an open one. If the
//! drawing's width or height is in mm, cm, in, pt or pc the points are physical lengths; otherwise they are in the
//! drawing's user units. SVG 1.1, sections 7 to 9.

mod arc_length;
mod document;
mod element;
mod pen;
mod shape;
mod viewport;

use crate::files::diagnostic::Diagnostic;
use crate::files::input_text;
use crate::mechanism::{MAX_MAGNITUDE, Unit};
use document::MAX_ELEMENTS;
use std::borrow::Cow;
use std::path::Path;

/// The default number of points of a drawing.
pub const DEFAULT_SAMPLES: usize = 60;

/// The beginning of a document type.
const DOCTYPE: &str = "<!DOCTYPE";

/// The options for reading a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SvgOptions<'a> {
    /// The id of the shape, of a group that holds it or of a use of it; absent: the first path, polyline, polygon,
    /// circle or ellipse, and if there is none the first line or rect.
    pub id: Option<&'a str>,
    /// The number of points.
    pub samples: usize,
    /// Whether the target is closed; absent: as it is drawn. `true` closes an open shape by a straight line, `false`
    /// gives both ends of a closed one.
    pub closed: Option<bool>,
    /// The unit in which physical lengths are given; absent: mm.
    pub unit: Option<Unit>,
}

impl Default for SvgOptions<'_> {
    fn default() -> Self {
        SvgOptions { id: None, samples: DEFAULT_SAMPLES, closed: None, unit: None }
    }
}

/// The target points of a shape with their properties.
#[derive(Clone, Debug, PartialEq)]
pub struct SvgTarget {
    /// The file as the user named it.
    pub file: String,
    /// The points.
    pub points: Vec<[f64; 2]>,
    /// Whether they are points of a closed curve.
    pub closed: bool,
    /// The unit of physical lengths; absent: user units.
    pub unit: Option<Unit>,
    /// The length of the curve.
    pub length: f64,
    /// Warnings about ignored parts of the drawing.
    pub warnings: Vec<Diagnostic>,
}

/// Reads the target points of a drawing.
///
/// # Errors
/// A [`Diagnostic`] that points at the element or attribute at fault.
pub fn load(path: &Path, options: &SvgOptions<'_>) -> Result<SvgTarget, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse(&path.display().to_string(), &text, options)
}

/// Reads the target points of the text of a drawing; `file` is shown in diagnostics.
///
/// ```
/// use linkwright::internals::files::svg_file::{SvgOptions, parse};
/// let svg = r#"<svg width="20mm" viewBox="0 0 10 10"><circle cx="5" cy="5" r="3"/></svg>"#;
/// let target = parse("c.svg", svg, &SvgOptions { samples: 4, ..SvgOptions::default() }).unwrap();
/// assert!((target.length - 12.0 * std::f64::consts::PI).abs() < 1e-8 && target.closed);
/// assert!((target.points[1][1] + 16.0).abs() < 1e-8); // from (16, -10) with the drawing's y: down, then left
/// ```
///
/// # Errors
/// As [`load`]. `samples` below 2 (3 for a closed curve) are refused too.
pub fn parse(file: &str, text: &str, options: &SvgOptions<'_>) -> Result<SvgTarget, Box<Diagnostic>> {
    let text = input_text::without_mark(text);
    let about = |message: String, help: &str| Box::new(Diagnostic::new(file, text, message).with_help(help));
    if text.trim().is_empty() {
        return Err(about("the file is empty".into(), "save the drawing as (plain) SVG"));
    }
    let xml = roxmltree::ParsingOptions { nodes_limit: 4 * MAX_ELEMENTS, ..Default::default() };
    let plain = without_empty_doctype(text);
    let parsed =
        roxmltree::Document::parse_with_options(&plain, xml).map_err(|error| not_xml(file, text, &error))?;
    let mut document = document::Document::new(file, text, &parsed)?;
    let chosen = document.target(options.id)?;
    let scale = match (document.page.physical, options.unit.unwrap_or(Unit::Mm)) {
        (false, _) | (true, Unit::Mm) => 1.0,
        (true, Unit::Cm) => 0.1,
        (true, Unit::M) => 0.001,
        (true, Unit::In) => 1.0 / viewport::MM_PER_INCH,
    };
    // Shapes are drawn with y down.
    let upright = kurbo::Affine::scale_non_uniform(scale, -scale) * chosen.transform;
    let outline = upright * &chosen.outline;
    let at = |message: String, help: &str| {
        Box::new(Diagnostic::new(file, text, message).at(chosen.place.clone()).with_help(help))
    };
    let corners = outline.control_box();
    let reach =
        [corners.x0, corners.y0, corners.x1, corners.y1].into_iter().map(f64::abs).fold(0.0, f64::max);
    // A box does not show a point that is no number.
    if !outline.is_finite() || reach > MAX_MAGNITUDE {
        let message = format!("the shape reaches further than {MAX_MAGNITUDE:e}");
        return Err(at(message, "scale the drawing down, or check its transforms"));
    }
    let Some(curve) = arc_length::Measured::new(&outline, options.closed) else {
        return Err(at("the shape has no extent once it is transformed".into(), "check its transforms"));
    };
    let least = if curve.closed() { 3 } else { 2 };
    if options.samples < least {
        let shape = if curve.closed() { "a closed" } else { "an open" };
        return Err(at(
            format!("samples = {}: {shape} curve needs at least {least} points", options.samples),
            "60 points describe most paths",
        ));
    }
    Ok(SvgTarget {
        file: file.to_owned(),
        points: curve.samples(options.samples),
        closed: curve.closed(),
        unit: document.page.physical.then(|| options.unit.unwrap_or(Unit::Mm)),
        length: curve.length(),
        warnings: chosen.warning.into_iter().collect(),
    })
}

/// Returns the text with blanks in the place of a document type that declares nothing (`<!DOCTYPE svg PUBLIC ..>`, as
/// many programs write it). A document type with declarations is kept and refused later.
fn without_empty_doctype(text: &str) -> Cow<'_, str> {
    let found = text.find(DOCTYPE).and_then(|start| {
        let end = start + text.get(start..)?.find('>')? + 1;
        (!text.get(start..end)?.contains('[')).then_some(start..end)
    });
    match found {
        None => Cow::Borrowed(text),
        Some(range) => {
            // Every byte keeps its place, and every line its number.
            let blank: String =
                text[range.clone()].bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }).collect();
            Cow::Owned(format!("{}{blank}{}", &text[..range.start], &text[range.end..]))
        }
    }
}

/// Translates an error of the XML reader into a designer's words.
fn not_xml(file: &str, text: &str, error: &roxmltree::Error) -> Box<Diagnostic> {
    use roxmltree::Error;
    let (message, help) = match error {
        Error::DtdDetected => (
            "the drawing has a document type with entities (<!DOCTYPE ..>), which is not read".to_owned(),
            "remove the DOCTYPE, or save the drawing as plain SVG",
        ),
        Error::NodesLimitReached => {
            (format!("the drawing has more than {MAX_ELEMENTS} elements"), "leave only the target in it")
        }
        Error::NoRootNode => {
            ("there is no element in this file".to_owned(), "save the drawing as (plain) SVG")
        }
        other => {
            // The position is already shown in front of the caret.
            let words = other.to_string();
            let words = words.split(" at ").next().unwrap_or(&words).to_owned();
            (format!("the drawing is no XML: {words}"), "save the drawing again as (plain) SVG")
        }
    };
    if let (Error::DtdDetected, Some(start)) = (error, text.find(DOCTYPE)) {
        let place = start..start + DOCTYPE.len();
        return Box::new(Diagnostic::new(file, text, message).at(place).with_help(help));
    }
    let place = error.pos();
    let line_start: usize =
        text.split_inclusive('\n').take((place.row as usize).saturating_sub(1)).map(str::len).sum();
    let rest = text.get(line_start..).unwrap_or("");
    let column = rest.char_indices().nth((place.col as usize).saturating_sub(1)).map_or(0, |(i, _)| i);
    let start = line_start + column;
    Box::new(Diagnostic::new(file, text, message).at(start..start).with_help(help))
}
