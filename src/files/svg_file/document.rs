//! The choice of a drawing's shape, and the transforms above it: groups, nested svg, symbols, uses.

use super::element::Element;
use super::viewport;
use super::viewport::Page;
use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use kurbo::{Affine, BezPath, Vec2};
use roxmltree::Node;
use std::collections::BTreeMap;
use std::ops::Range;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
/// The largest number of elements of a drawing, each use of an element counted.
pub(super) const MAX_ELEMENTS: u32 = 200_000;
/// The largest depth of nested elements and uses.
const MAX_DEPTH: usize = 128;
/// The largest number of shapes that a message lists.
const NAMED: usize = 8;

/// A shape with its place in the drawing.
struct Placed<'a, 'input> {
    element: Element<'a, 'input>,
    transform: Affine,
}

/// The shape that was chosen.
pub(super) struct Chosen {
    /// The shape's curve in its own coordinates.
    pub outline: BezPath,
    /// The transform to the page's coordinates, y down.
    pub transform: Affine,
    /// The place of its element in the text.
    pub place: Range<usize>,
    /// A warning if there are other shapes.
    pub warning: Option<Diagnostic>,
}

/// A drawing that is being read.
pub(super) struct Document<'a, 'input> {
    file: &'a str,
    text: &'a str,
    /// The placement of the drawing as a whole.
    pub page: Page,
    root: Node<'a, 'input>,
    ids: BTreeMap<&'a str, Node<'a, 'input>>,
    visited: u32,
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
        let element = Element { file, text, node: root, extent: None };
        if name_of(&root) != "svg" {
            let found = quoted(root.tag_name().name());
            let message = format!("this is no SVG drawing: its first element is {found}");
            return Err(element.refuse(message, "save the drawing as (plain) SVG"));
        }
        let (width, height) = (element.page_size("width")?, element.page_size("height")?);
        let page = viewport::page(width, height, element.view()?, element.aspect()?);
        Ok(Document { file, text, page, root, ids, visited: 0 })
    }

    /// Returns an element; percentages in it refer to `extent`.
    fn element(&self, node: Node<'a, 'input>, extent: Option<Vec2>) -> Element<'a, 'input> {
        Element { file: self.file, text: self.text, node, extent }
    }

    /// Returns the shape with an id, or the first.
    pub fn target(&mut self, id: Option<&str>) -> Checked<Chosen> {
        let mut shapes = Vec::new();
        match id {
            None => {
                let page = self.page;
                let transform = page.affine * self.element(self.root, None).transform()?;
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
        for is_wanted in [is_curve, is_plain] {
            let mut wanted = shapes.iter().filter(|placed| is_wanted(name_of(&placed.element.node)));
            while let Some(Placed { element, transform }) = wanted.next() {
                let Some(outline) = element.outline()? else { continue };
                // The first shape is read as a whole; of the others only the place is reported.
                let others: Vec<Node<'_, '_>> = wanted.map(|placed| placed.element.node).collect();
                let warning = (!others.is_empty()).then(|| {
                    let (first, list) = (self.describe(&element.node), self.list(&others));
                    let count = 1 + others.len();
                    let message = format!("the drawing has {count} shapes; the target is the first, {first}");
                    *element.refuse(message, &format!("svg_id = \"..\" names another one: {list}"))
                });
                return Ok(Chosen { outline, transform: *transform, place: element.tag(), warning });
            }
        }
        Err(self.nothing_drawn(id))
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
        let element = self.element(node, extent);
        self.visited += 1;
        if self.visited > MAX_ELEMENTS {
            let message = format!("the drawing shows more than {MAX_ELEMENTS} elements, uses counted");
            return Err(element.refuse(message, "leave only the target in it"));
        }
        if depth > MAX_DEPTH {
            let message = format!("elements and uses stand more than {MAX_DEPTH} deep inside each other");
            return Err(element.refuse(message, "ungroup the drawing; a use must not show itself"));
        }
        let name = name_of(&node);
        let transform = transform * element.transform()?;
        if is_curve(name) || is_plain(name) {
            shapes.push(Placed { element, transform });
        } else if name == "use" {
            self.visit_use(&element, transform, depth, shapes)?;
        } else if is_container(name) && (name != "symbol" || depth == 0) {
            // A symbol is shown only by a use, or if it was named itself.
            let (transform, extent) = match name {
                "svg" | "symbol" => self.inner(&element, transform, (None, None))?,
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
        element: &Element<'a, 'input>,
        transform: Affine,
        depth: usize,
        shapes: &mut Vec<Placed<'a, 'input>>,
    ) -> Checked<()> {
        let Element { node, extent, .. } = *element;
        let href = node.attribute("href").or_else(|| node.attribute((XLINK, "href"))).unwrap_or("");
        let Some(shown) = href.strip_prefix('#').and_then(|id| self.ids.get(id)).copied() else {
            let message = format!("this use shows {}, which is not in the drawing", quoted(href));
            let help = "unlink the clone, or bring what it shows into the drawing";
            return Err(element.refuse(message, help));
        };
        let shift = Vec2::new(element.or_zero("x", 'x')?, element.or_zero("y", 'y')?);
        let transform = transform * Affine::translate(shift);
        if matches!(name_of(&shown), "symbol" | "svg") && !is_hidden(&shown) {
            let size = (element.length("width", 'x')?, element.length("height", 'y')?);
            let inner = self.element(shown, extent);
            let (inside, extent) = self.inner(&inner, transform * inner.transform()?, size)?;
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
        element: &Element<'a, 'input>,
        mut transform: Affine,
        size: (Option<f64>, Option<f64>),
    ) -> Checked<(Affine, Option<Vec2>)> {
        let width = size.0.or(element.length("width", 'x')?).or(element.extent.map(|e| e.x));
        let height = size.1.or(element.length("height", 'y')?).or(element.extent.map(|e| e.y));
        if name_of(&element.node) == "svg" && element.node != self.root {
            transform *= Affine::translate(Vec2::new(element.or_zero("x", 'x')?, element.or_zero("y", 'y')?));
        }
        let Some(view) = element.view()? else {
            return Ok((transform, width.zip(height).map(|(w, h)| Vec2::new(w, h))));
        };
        let Some((width, height)) = width.zip(height) else {
            let message =
                "how large this part is drawn is not told: it has a viewBox and no width and height";
            return Err(element.refuse(message, "give it a width and a height"));
        };
        let placed = viewport::placed(view, width, height, element.aspect()?);
        Ok((transform * placed, Some(Vec2::new(view.w, view.h))))
    }

    /// Returns the transform of everything above an element.
    fn above(&self, node: &Node<'a, 'input>) -> Checked<(Affine, Option<Vec2>)> {
        let line: Vec<Node<'a, 'input>> = node.ancestors().skip(1).filter(Node::is_element).collect();
        let (mut transform, mut extent) = (Affine::IDENTITY, None);
        for node in line.into_iter().rev() {
            let element = self.element(node, extent);
            transform *= element.transform()?;
            if node == self.root {
                // The root's own transform acts on the page's coordinates.
                transform = self.page.affine * transform;
                extent = self.page.extent;
            } else if name_of(&node) == "svg" {
                (transform, extent) = self.inner(&element, transform, (None, None))?;
            }
        }
        Ok((transform, extent))
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
        let place = id.and_then(|id| self.ids.get(id)).map(|node| self.element(*node, None).tag());
        Box::new(Diagnostic::new(self.file, self.text, message).at(place).with_help(help))
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
