//! An element of a drawing with the values of its attributes, and diagnostics at its place.

use super::viewport::px_of;
use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use kurbo::{Affine, Vec2};
use roxmltree::Node;
use std::ops::Range;
use svgtypes::{AspectRatio, Length, LengthUnit, Transform, ViewBox};

/// An element with the context in which its attributes are read.
#[derive(Clone, Copy)]
pub(super) struct Element<'a, 'input> {
    pub file: &'a str,
    pub text: &'a str,
    pub node: Node<'a, 'input>,
    /// The width and height to which percentages refer.
    pub extent: Option<Vec2>,
}

impl Element<'_, '_> {
    /// Returns the text of an attribute that is not `auto`.
    fn given(&self, key: &str) -> Option<&str> {
        self.node.attribute(key).filter(|text| text.trim() != "auto")
    }

    /// Returns the place of the element's name.
    pub fn tag(&self) -> Range<usize> {
        let range = self.node.range();
        let own = self.text.get(range.clone()).unwrap_or("");
        range.start..range.start + own.find([' ', '\n', '\r', '\t', '>', '/']).unwrap_or(own.len())
    }

    /// Returns a diagnostic about the element.
    pub fn refuse(&self, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
        Box::new(Diagnostic::new(self.file, self.text, message).at(self.tag()).with_help(help))
    }

    /// Returns a diagnostic about the value of an attribute.
    pub fn at(&self, key: &str, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
        let place = self.node.attribute_node(key).map_or(self.tag(), |attribute| attribute.range_value());
        Box::new(self.refuse(message, help).at(place))
    }

    /// Returns a diagnostic about an unreadable attribute, at the character at which the reading stopped.
    pub fn at_error(&self, key: &str, what: &str, error: &svgtypes::Error, example: &str) -> Box<Diagnostic> {
        use svgtypes::Error::{InvalidChar, InvalidNumber, InvalidString, UnexpectedData};
        let help = format!("export the drawing again; this is how a {what} is written: {example}");
        let value = self.node.attribute_node(key).map(|a| (a.value(), a.range_value()));
        let position = match error {
            UnexpectedData(at) | InvalidChar(_, at) | InvalidString(_, at) | InvalidNumber(at) => Some(*at),
            _ => None,
        };
        // If the text is the same in the file as in the value; positions count characters from 1.
        if let (Some(position), Some((value, range))) = (position, value)
            && self.text.get(range.clone()) == Some(value)
            && let Some((start, c)) = value.char_indices().nth(position.saturating_sub(1))
        {
            let start = range.start + start;
            let diagnostic =
                Diagnostic::new(self.file, self.text, format!("this {what} cannot be read from here on"));
            return Box::new(diagnostic.at(start..start + c.len_utf8()).with_help(help));
        }
        self.at(key, format!("this {what} cannot be read: {error}"), &help)
    }

    /// Returns a length in user units; `axis` is the axis to which a percentage refers: x, y or r.
    pub fn length(&self, key: &str, axis: char) -> Checked<Option<f64>> {
        let Some(text) = self.given(key) else { return Ok(None) };
        let refuse = |help: &str| Err(self.at(key, format!("{key} = {} is no length", quoted(text)), help));
        let Ok(length) = text.trim().parse::<Length>() else { return refuse("write a number such as 12.5") };
        let of = |e: Vec2| match axis {
            'x' => e.x,
            'y' => e.y,
            _ => (0.5 * (e.x * e.x + e.y * e.y)).sqrt(),
        };
        let value = match (length.unit, self.extent) {
            (LengthUnit::Percent, Some(extent)) => length.number / 100.0 * of(extent),
            (LengthUnit::Percent, None) => {
                return refuse("of what? give the drawing a viewBox, or write a number");
            }
            (unit, _) => match px_of(unit) {
                Some(px) => px * length.number,
                None => return refuse("lengths in em and ex are not read; write a number"),
            },
        };
        if value.is_finite() { Ok(Some(value)) } else { refuse("write a finite number") }
    }

    /// Returns a length in user units, 0 if the attribute is absent.
    pub fn or_zero(&self, key: &str, axis: char) -> Checked<f64> {
        Ok(self.length(key, axis)?.unwrap_or(0.0))
    }

    /// Returns a length that must not be negative.
    pub fn size(&self, key: &str, axis: char) -> Checked<Option<f64>> {
        match self.length(key, axis)? {
            Some(value) if value < 0.0 => {
                Err(self.at(key, format!("{key} = {value} is negative"), "write 0 or more"))
            }
            other => Ok(other),
        }
    }

    /// Returns the element's own transform.
    pub fn transform(&self) -> Checked<Affine> {
        let mut rules = self.node.attribute("style").unwrap_or("").split(';');
        let is_styled = rules.any(|rule| rule.trim_start().starts_with("transform"));
        if is_styled || self.node.has_attribute("transform-origin") {
            let message = "this element is transformed by a style, which is not read";
            return Err(self.refuse(message, "save the drawing as plain SVG, with transform attributes"));
        }
        let Some(text) = self.node.attribute("transform") else { return Ok(Affine::IDENTITY) };
        let Transform { a, b, c, d, e, f } = text.parse::<Transform>().map_err(|error| {
            self.at_error("transform", "transform", &error, "translate(10 20) rotate(30)")
        })?;
        let transform = Affine::new([a, b, c, d, e, f]);
        if transform.is_finite() {
            return Ok(transform);
        }
        Err(self.at("transform", "this transform is not finite", "use smaller numbers"))
    }

    /// Returns the width or height of the drawing.
    pub fn page_size(&self, key: &str) -> Checked<Option<Length>> {
        let Some(text) = self.given(key) else { return Ok(None) };
        match text.trim().parse::<Length>() {
            Ok(length) if length.number.is_finite() && length.number > 0.0 => Ok(Some(length)),
            _ => {
                let message = format!("{key} = {} is no size of a drawing", quoted(text));
                Err(self.at(key, message, "write a positive length, such as 200mm"))
            }
        }
    }

    /// Returns the viewBox.
    pub fn view(&self) -> Checked<Option<ViewBox>> {
        let Some(text) = self.node.attribute("viewBox") else { return Ok(None) };
        match text.parse::<ViewBox>() {
            Ok(v) if [v.x, v.y, v.w, v.h].iter().all(|n| n.is_finite()) => Ok(Some(v)),
            _ => {
                let message = format!("viewBox = {} is no box", quoted(text));
                Err(self.at("viewBox", message, "write x y width height, the last two positive"))
            }
        }
    }

    /// Returns the alignment of the viewBox.
    pub fn aspect(&self) -> Checked<AspectRatio> {
        let Some(text) = self.node.attribute("preserveAspectRatio") else {
            return Ok(AspectRatio::default());
        };
        text.trim().parse().map_err(|_| {
            let message = format!("preserveAspectRatio = {} is not known", quoted(text));
            self.at("preserveAspectRatio", message, "write none or such as xMidYMid meet")
        })
    }
}
