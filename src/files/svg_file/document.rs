//! The choice of a drawing's shape, and the transforms above it: groups, nested svg, symbols, uses.

use super::shape::{Outline, Scope};
use super::viewport;
use super::viewport::Page;
use super::{MAX_DEPTH, MAX_ELEMENTS};
use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use kurbo::{Affine, Vec2};
use roxmltree::Node;
use std::collections::BTreeMap;
use std::ops::Range;
use svgtypes::{AspectRatio, Length, Transform, ViewBox};

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
/// The largest number of shapes that a message lists.
const NAMED: usize = 8;

/// A shape with its place in the drawing.
#[derive(Clone)]
struct Placed<'a, 'input> {
    node: Node<'a, 'input>,
    transform: Affine,
    extent: Option<Vec2>,
}

/// The shape that was chosen.
pub(super) struct Chosen {
    /// The shape's curve in its own coordinates.
    pub outline: Outline,
    /// The transform to the page's coordinates, y down.
    pub transform: Affine,
    /// The place of its element in the text.
    pub place: Range<usize>,
}

/// A drawing that is being read.
pub(super) struct Document<'a, 'input> {
    file: &'a str,
    text: &'a str,
    page: Page,
    root: Node<'a, 'input>,
    ids: BTreeMap<&'a str, Node<'a, 'input>>,
    visited: u32,
    warnings: Vec<Diagnostic>,
}

/// Returns whether an element is a container: a group, a symbol or a drawing inside another.
fn is_container(name: &str) -> bool {
    matches!(name, "g" | "a" | "switch" | "svg" | "symbol")
}

/// Returns whether an element is a shape that is preferred to others.
fn is_curve(name: &str) -> bool {
    matches!(name, "path" | "polyline" | "polygon" | "circle" | "ellipse")
}

/// Returns whether an element is a shape that is often a frame or an axis.
fn is_plain(name: &str) -> bool {
    matches!(name, "line" | "rect")
}

fn name_of<'a>(node: &Node<'a, '_>) -> &'a str {
    match node.tag_name().namespace() {
        None | Some(SVG) => node.tag_name().name(),
        Some(_) => "",
    }
}

impl<'a, 'input> Document<'a, 'input> {
    pub fn new(file: &'a str, text: &'a str, parsed: &'a roxmltree::Document<'input>) -> Checked<Self> {
        let root = parsed.root_element();
        let mut ids = BTreeMap::new();
        for node in parsed.descendants() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        let page = Page { affine: Affine::IDENTITY, physical: false, extent: None };
        let mut document = Document { file, text, page, root, ids, visited: 0, warnings: Vec::new() };
        if name_of(&root) != "svg" {
            let found = quoted(root.tag_name().name());
            let message = format!("this is no SVG drawing: its first element is {found}");
            return Err(document.at_tag(&root, message, "save the drawing as (plain) SVG"));
        }
        document.page = viewport::page(
            document.size_of(&root, "width")?,
            document.size_of(&root, "height")?,
            document.view_of(&root)?,
            document.aspect_of(&root)?,
        );
        Ok(document)
    }

    /// Returns whether lengths are physical.
    pub fn physical(&self) -> bool {
        self.page.physical
    }

    pub fn into_warnings(self) -> Vec<Diagnostic> {
        self.warnings
    }

    /// Returns the shape with an id, or the first.
    pub fn target(&mut self, id: Option<&str>) -> Checked<Chosen> {
        let mut shapes = Vec::new();
        match id {
            None => {
                let page = self.page;
                let transform = page.affine * self.transform_of(&self.root)?;
                for child in self.root.children() {
                    self.visit(child, transform, page.extent, 1, &mut shapes)?;
                }
            }
            Some(id) => {
                let Some(node) = self.ids.get(id).copied() else { return Err(self.no_such_id(id)) };
                let (transform, extent) = self.above(&node)?;
                self.visit(node, transform, extent, 0, &mut shapes)?;
            }
        }
        let mut drawn = Vec::new();
        for (curves, others) in [(true, false), (false, true)] {
            for placed in &shapes {
                let name = name_of(&placed.node);
                if (curves && is_curve(name)) || (others && is_plain(name)) {
                    let scope =
                        Scope { file: self.file, text: self.text, node: placed.node, extent: placed.extent };
                    // The first shape is read as a whole; of the others only the place is reported.
                    if !drawn.is_empty() {
                        drawn.push((placed, None));
                    } else if let Some(outline) = scope.outline()? {
                        drawn.push((placed, Some(outline)));
                    }
                }
            }
            if !drawn.is_empty() {
                break;
            }
        }
        let others: Vec<Node<'_, '_>> = drawn.iter().skip(1).map(|(placed, _)| placed.node).collect();
        let Some((placed, Some(outline))) = drawn.into_iter().next() else {
            return Err(self.nothing_drawn(id));
        };
        let chosen = Chosen { outline, transform: placed.transform, place: self.tag(&placed.node) };
        if !others.is_empty() {
            let (first, list) = (self.describe(&placed.node), self.list(&others));
            let message =
                format!("the drawing has {} shapes; the target is the first, {first}", 1 + others.len());
            let help = format!("svg_id = \"..\" names another one: {list}");
            self.warnings.push(*self.at_tag(&placed.node, message, &help));
        }
        Ok(chosen)
    }

    /// Collects the shapes of an element and of its contents.
    fn visit(
        &mut self,
        node: Node<'a, 'input>,
        transform: Affine,
        extent: Option<Vec2>,
        depth: usize,
        shapes: &mut Vec<Placed<'a, 'input>>,
    ) -> Checked<()> {
        if !node.is_element() || is_hidden(&node) {
            return Ok(());
        }
        self.visited += 1;
        if self.visited > MAX_ELEMENTS {
            let message = format!("the drawing shows more than {MAX_ELEMENTS} elements, uses counted");
            return Err(self.at_tag(&node, message, "leave only the target in it"));
        }
        if depth > MAX_DEPTH {
            let message = format!("elements and uses stand more than {MAX_DEPTH} deep inside each other");
            return Err(self.at_tag(&node, message, "ungroup the drawing; a use must not show itself"));
        }
        let name = name_of(&node);
        let transform = transform * self.transform_of(&node)?;
        if is_curve(name) || is_plain(name) {
            shapes.push(Placed { node, transform, extent });
        } else if name == "use" {
            self.visit_use(&node, transform, extent, depth, shapes)?;
        } else if is_container(name) && (name != "symbol" || depth == 0) {
            // A symbol is shown only by a use, or if it was named itself.
            let (transform, extent) = match name {
                "svg" | "symbol" => self.inner(&node, transform, extent, (None, None))?,
                _ => (transform, extent),
            };
            for child in node.children() {
                self.visit(child, transform, extent, depth + 1, shapes)?;
            }
        }
        Ok(())
    }

    /// Collects the shapes that a use shows, moved to its x and y.
    fn visit_use(
        &mut self,
        node: &Node<'a, 'input>,
        transform: Affine,
        extent: Option<Vec2>,
        depth: usize,
        shapes: &mut Vec<Placed<'a, 'input>>,
    ) -> Checked<()> {
        let href = node.attribute("href").or_else(|| node.attribute((XLINK, "href"))).unwrap_or("");
        let Some(shown) = href.strip_prefix('#').and_then(|id| self.ids.get(id)).copied() else {
            let message = format!("this use shows {}, which is not in the drawing", quoted(href));
            return Err(self.at_tag(
                node,
                message,
                "unlink the clone, or bring what it shows into the drawing",
            ));
        };
        let scope = Scope { file: self.file, text: self.text, node: *node, extent };
        let shift = Vec2::new(scope.length("x", 'x')?.unwrap_or(0.0), scope.length("y", 'y')?.unwrap_or(0.0));
        let transform = transform * Affine::translate(shift);
        if matches!(name_of(&shown), "symbol" | "svg") && !is_hidden(&shown) {
            let size = (scope.length("width", 'x')?, scope.length("height", 'y')?);
            let own = transform * self.transform_of(&shown)?;
            let (inside, extent) = self.inner(&shown, own, extent, size)?;
            for child in shown.children() {
                self.visit(child, inside, extent, depth + 1, shapes)?;
            }
            return Ok(());
        }
        self.visit(shown, transform, extent, depth + 1, shapes)
    }

    /// Returns the coordinates inside a nested svg or a symbol; `size` replaces its own width and height.
    fn inner(
        &self,
        node: &Node<'a, 'input>,
        transform: Affine,
        extent: Option<Vec2>,
        size: (Option<f64>, Option<f64>),
    ) -> Checked<(Affine, Option<Vec2>)> {
        let scope = Scope { file: self.file, text: self.text, node: *node, extent };
        let own = |key, axis| scope.length(key, axis);
        let width = size.0.or(own("width", 'x')?).or(extent.map(|e| e.x));
        let height = size.1.or(own("height", 'y')?).or(extent.map(|e| e.y));
        let mut transform = transform;
        if name_of(node) == "svg" && *node != self.root {
            let shift = Vec2::new(own("x", 'x')?.unwrap_or(0.0), own("y", 'y')?.unwrap_or(0.0));
            transform *= Affine::translate(shift);
        }
        let Some(view) = self.view_of(node)? else {
            return Ok((transform, width.zip(height).map(|(w, h)| Vec2::new(w, h))));
        };
        let Some((width, height)) = width.zip(height) else {
            let message =
                "how large this part is drawn is not told: it has a viewBox and no width and height";
            return Err(self.at_tag(node, message.into(), "give it a width and a height"));
        };
        let placed = viewport::placed(view, width, height, self.aspect_of(node)?);
        Ok((transform * placed, Some(Vec2::new(view.w, view.h))))
    }

    /// Returns the transform of everything above an element.
    fn above(&self, node: &Node<'a, 'input>) -> Checked<(Affine, Option<Vec2>)> {
        let mut line: Vec<Node<'a, 'input>> = node.ancestors().skip(1).filter(Node::is_element).collect();
        line.reverse();
        let (mut transform, mut extent) = (Affine::IDENTITY, None);
        for node in line {
            transform *= self.transform_of(&node)?;
            if node == self.root {
                // The root's own transform acts on the page's coordinates.
                transform = self.page.affine * transform;
                extent = self.page.extent;
            } else if name_of(&node) == "svg" {
                (transform, extent) = self.inner(&node, transform, extent, (None, None))?;
            }
        }
        Ok((transform, extent))
    }

    fn transform_of(&self, node: &Node<'a, 'input>) -> Checked<Affine> {
        let styled = node.attribute("style").is_some_and(|style| {
            style
                .split(';')
                .any(|rule| rule.split(':').next().is_some_and(|key| key.trim().starts_with("transform")))
        });
        if styled || node.has_attribute("transform-origin") {
            let message = "this element is transformed by a style, which is not read";
            return Err(self.at_tag(
                node,
                message.into(),
                "save the drawing as plain SVG, with transform attributes",
            ));
        }
        let Some(text) = node.attribute("transform") else { return Ok(Affine::IDENTITY) };
        match text.parse::<Transform>() {
            Ok(t) => {
                let numbers = [t.a, t.b, t.c, t.d, t.e, t.f];
                if numbers.iter().all(|n| n.is_finite()) {
                    return Ok(Affine::new(numbers));
                }
                Err(self.at_attribute(
                    node,
                    "transform",
                    "this transform is not finite".into(),
                    "use smaller numbers",
                ))
            }
            Err(error) => {
                let scope = Scope { file: self.file, text: self.text, node: *node, extent: None };
                Err(scope.at_error("transform", "transform", &error, "translate(10 20) rotate(30)"))
            }
        }
    }

    fn size_of(&self, node: &Node<'a, 'input>, key: &str) -> Checked<Option<Length>> {
        let Some(text) = node.attribute(key).filter(|text| text.trim() != "auto") else { return Ok(None) };
        match text.trim().parse::<Length>() {
            Ok(length) if length.number.is_finite() && length.number > 0.0 => Ok(Some(length)),
            _ => {
                let message = format!("{key} = {} is no size of a drawing", quoted(text));
                Err(self.at_attribute(node, key, message, "write a positive length, such as 200mm"))
            }
        }
    }

    fn view_of(&self, node: &Node<'a, 'input>) -> Checked<Option<ViewBox>> {
        let Some(text) = node.attribute("viewBox") else { return Ok(None) };
        match text.parse::<ViewBox>() {
            Ok(v) if [v.x, v.y, v.w, v.h].iter().all(|n| n.is_finite()) => Ok(Some(v)),
            _ => {
                let message = format!("viewBox = {} is no box", quoted(text));
                Err(self.at_attribute(
                    node,
                    "viewBox",
                    message,
                    "write x y width height, the last two positive",
                ))
            }
        }
    }

    fn aspect_of(&self, node: &Node<'a, 'input>) -> Checked<AspectRatio> {
        let Some(text) = node.attribute("preserveAspectRatio") else { return Ok(AspectRatio::default()) };
        text.trim().parse().map_err(|_| {
            let message = format!("preserveAspectRatio = {} is not known", quoted(text));
            self.at_attribute(node, "preserveAspectRatio", message, "write none or such as xMidYMid meet")
        })
    }

    fn no_such_id(&self, id: &str) -> Box<Diagnostic> {
        let named: Vec<&str> = self.ids.iter().filter(|(_, n)| is_shown(n)).map(|(id, _)| *id).collect();
        let help = match crate::files::toml_text::nearest(id, &named) {
            Some(near) => format!("did you mean {}? ", quoted(near)),
            None => String::new(),
        };
        let list = self.all_shapes();
        let message = format!("no element of the drawing has the id {}", quoted(id));
        let help = match list.as_str() {
            "" => "there is no shape in this drawing".to_owned(),
            list => format!("{help}shapes: {list}"),
        };
        Box::new(Diagnostic::new(self.file, self.text, message).with_help(help))
    }

    fn nothing_drawn(&self, id: Option<&str>) -> Box<Diagnostic> {
        let message = match id {
            Some(id) => format!("the element {} holds no shape that is drawn", quoted(id)),
            None => "there is no shape in this drawing".to_owned(),
        };
        let list = self.all_shapes();
        let help = match (id, list.as_str()) {
            (Some(_), list) if !list.is_empty() => format!("shapes: {list}"),
            _ => "draw a path, polyline, polygon, circle or ellipse; turn texts and images into paths"
                .to_owned(),
        };
        let diagnostic = Diagnostic::new(self.file, self.text, message).with_help(help);
        Box::new(match id.and_then(|id| self.ids.get(id)) {
            Some(node) => diagnostic.at(self.tag(node)),
            None => diagnostic,
        })
    }

    /// Returns a list of every shape of the file, shown or not.
    fn all_shapes(&self) -> String {
        let nodes: Vec<Node<'_, '_>> = self.root.descendants().filter(is_shape).collect();
        self.list(&nodes)
    }

    fn list(&self, nodes: &[Node<'_, '_>]) -> String {
        let mut names: Vec<String> = nodes.iter().take(NAMED).map(|node| self.describe(node)).collect();
        if nodes.len() > NAMED {
            names.push(format!("{} more", nodes.len() - NAMED));
        }
        names.join(", ")
    }

    /// Returns a description of a shape: `path "leg"`, or `path of line 12`.
    fn describe(&self, node: &Node<'_, '_>) -> String {
        let name = node.tag_name().name();
        match node.attribute("id") {
            Some(id) => format!("{name} {}", quoted(id)),
            None => {
                let line = self.text.get(..node.range().start).unwrap_or("").matches('\n').count() + 1;
                format!("{name} without id (line {line})")
            }
        }
    }

    /// Returns the place of an element's name.
    fn tag(&self, node: &Node<'_, '_>) -> Range<usize> {
        let range = node.range();
        let own = self.text.get(range.clone()).unwrap_or("");
        range.start..range.start + own.find([' ', '\n', '\r', '\t', '>', '/']).unwrap_or(own.len())
    }

    fn at_tag(&self, node: &Node<'_, '_>, message: String, help: &str) -> Box<Diagnostic> {
        Box::new(Diagnostic::new(self.file, self.text, message).at(self.tag(node)).with_help(help))
    }

    fn at_attribute(&self, node: &Node<'_, '_>, key: &str, message: String, help: &str) -> Box<Diagnostic> {
        let place = node.attribute_node(key).map_or(self.tag(node), |a| a.range_value());
        Box::new(Diagnostic::new(self.file, self.text, message).at(place).with_help(help))
    }
}

fn is_shape(node: &Node<'_, '_>) -> bool {
    node.is_element() && (is_curve(name_of(node)) || is_plain(name_of(node)))
}

/// Returns whether an element may be named by `svg_id`.
fn is_shown(node: &Node<'_, '_>) -> bool {
    is_shape(node) || is_container(name_of(node)) || name_of(node) == "use"
}

/// Returns whether an element has display = none, as an attribute or a style.
fn is_hidden(node: &Node<'_, '_>) -> bool {
    let styled = node.attribute("style").is_some_and(|style| {
        style
            .split(';')
            .filter_map(|rule| rule.split_once(':'))
            .any(|(k, v)| k.trim() == "display" && v.trim() == "none")
    });
    styled || node.attribute("display").is_some_and(|v| v.trim() == "none")
}
