//! A DXF document of AutoCAD 2000 (AC1015): the tables and blocks that readers require, and entities in model space.
//!
//! Source of the group codes: Autodesk, "AutoCAD 2000 DXF Reference" (1999). Lengths are millimetres
//! (`$INSUNITS` = 4); text is ASCII, other characters as `\U+XXXX`.

use crate::mechanism::{Complex, cross};
use crate::report::scene::Bounds;
use std::fmt::{Display, Write};

/// Handles of the fixed objects; those of entities and layers follow from [`FIRST_FREE`].
const MODEL_SPACE: u32 = 0x1F;
const PAPER_SPACE: u32 = 0x1B;
const FIRST_FREE: u32 = 0x100;

/// A drawing under construction.
pub(super) struct Drawing {
    layers: Vec<(String, u8)>,
    entities: Tags,
    next: u32,
    bounds: Bounds,
}

/// Pairs of group code and value, as text.
#[derive(Default)]
struct Tags(String);

impl Tags {
    fn text(&mut self, code: u16, value: impl Display) {
        let _ = writeln!(self.0, "{code:>3}\n{value}");
    }

    fn texts(&mut self, pairs: &[(u16, &str)]) {
        pairs.iter().for_each(|(code, value)| self.text(*code, value));
    }

    fn number(&mut self, code: u16, value: f64) {
        // Never with an exponent; the shortest text that reads back as the same number; -0 is written as 0.
        self.text(code, value + 0.0);
    }

    fn handle(&mut self, code: u16, value: u32) {
        self.text(code, format_args!("{value:X}"));
    }

    /// Writes a point at codes 10, 20, 30 (or 11, 21, 31).
    fn point(&mut self, code: u16, at: Complex) {
        self.number(code, at.re);
        self.number(code + 10, at.im);
        self.number(code + 20, 0.0);
    }

    /// Writes the beginning of an object: its kind, its handle and that of its owner.
    fn object(&mut self, kind: &str, handle: u32, owner: u32) {
        self.text(0, kind);
        self.handle(if kind == "DIMSTYLE" { 105 } else { 5 }, handle);
        self.handle(330, owner);
    }

    /// Writes a table's entry with its classes.
    fn entry(&mut self, kind: &str, handle: u32, owner: u32, class: &str, name: &str) {
        self.object(kind, handle, owner);
        self.texts(&[(100, "AcDbSymbolTableRecord"), (100, class), (2, name)]);
        // No flags; records of blocks have none.
        if kind != "BLOCK_RECORD" {
            self.text(70, 0);
        }
    }

    /// Writes a table with this number of entries.
    fn table(&mut self, kind: &str, handle: u32, count: usize, entries: impl FnOnce(&mut Tags)) {
        self.texts(&[(0, "TABLE"), (2, kind)]);
        self.handle(5, handle);
        self.handle(330, 0);
        self.text(100, "AcDbSymbolTable");
        self.text(70, count);
        entries(self);
        self.text(0, "ENDTAB");
    }

    fn section(&mut self, name: &str, contents: impl FnOnce(&mut Tags)) {
        self.texts(&[(0, "SECTION"), (2, name)]);
        contents(self);
        self.text(0, "ENDSEC");
    }
}

impl Drawing {
    /// Returns an empty drawing with layers, each with a name and a colour (AutoCAD's index).
    pub(super) fn new(layers: &[(impl ToString, u8)]) -> Self {
        Drawing {
            layers: layers.iter().map(|(name, colour)| (name.to_string(), *colour)).collect(),
            entities: Tags::default(),
            next: FIRST_FREE + layers.len() as u32,
            bounds: Bounds::default(),
        }
    }

    fn entity(&mut self, kind: &str, layer: &str, class: &str) {
        self.entities.object(kind, self.next, MODEL_SPACE);
        self.next += 1;
        self.entities.texts(&[(100, "AcDbEntity"), (8, layer), (100, class)]);
    }

    /// Draws a line segment.
    pub(super) fn line(&mut self, layer: &str, from: Complex, to: Complex) {
        self.entity("LINE", layer, "AcDbLine");
        self.entities.point(10, from);
        self.entities.point(11, to);
        self.bounds.hold(from);
        self.bounds.hold(to);
    }

    /// Draws a circle.
    pub(super) fn circle(&mut self, layer: &str, centre: Complex, radius: f64) {
        self.entity("CIRCLE", layer, "AcDbCircle");
        self.entities.point(10, centre);
        self.entities.number(40, radius);
        let reach = Complex::new(radius, radius);
        self.bounds.hold(centre - reach);
        self.bounds.hold(centre + reach);
    }

    /// Draws a point.
    pub(super) fn point(&mut self, layer: &str, at: Complex) {
        self.entity("POINT", layer, "AcDbPoint");
        self.entities.point(10, at);
        self.bounds.hold(at);
    }

    /// Draws a polyline of vertices, each with the bulge of the segment after it.
    pub(super) fn polyline(&mut self, layer: &str, vertices: &[(Complex, f64)], closed: bool) {
        self.entity("LWPOLYLINE", layer, "AcDbPolyline");
        self.entities.text(90, vertices.len());
        self.entities.text(70, u8::from(closed));
        let after = vertices.iter().cycle().skip(1);
        for ((at, bulge), (next, _)) in vertices.iter().zip(after) {
            self.entities.number(10, at.re);
            self.entities.number(20, at.im);
            if *bulge != 0.0 {
                self.entities.number(42, *bulge);
                farthest_of_arc(*at, *next, *bulge).for_each(|p| self.bounds.hold(p));
            }
            self.bounds.hold(*at);
        }
    }

    /// Returns the whole document; remarks are foreign text, written on one line each.
    pub(super) fn document(self, remarks: &[String]) -> String {
        let mut out = Tags::default();
        for remark in remarks {
            out.text(999, ascii(remark));
        }
        out.section("HEADER", |out| self.header(out));
        out.section("CLASSES", |_| ());
        out.section("TABLES", |out| self.tables(out));
        out.section("BLOCKS", blocks);
        out.section("ENTITIES", |out| out.0.push_str(&self.entities.0));
        out.section("OBJECTS", objects);
        out.text(0, "EOF");
        out.0
    }

    fn header(&self, out: &mut Tags) {
        let [low, high] = self.bounds.corners();
        out.texts(&[(9, "$ACADVER"), (1, "AC1015"), (9, "$DWGCODEPAGE"), (3, "ANSI_1252")]);
        for (name, at) in [("$EXTMIN", low), ("$EXTMAX", high)] {
            out.text(9, name);
            out.point(10, at);
        }
        // Millimetres; metric line types; points as small crosses of 1% of the screen.
        for (name, value) in [("$INSUNITS", 4), ("$MEASUREMENT", 1), ("$PDMODE", 3)] {
            out.text(9, name);
            out.text(70, value);
        }
        out.text(9, "$HANDSEED");
        out.handle(5, self.next);
    }

    fn tables(&self, out: &mut Tags) {
        out.table("VPORT", 0x8, 1, |out| self.view(out));
        out.table("LTYPE", 0x5, 3, |out| {
            let types = [(0x14, "ByBlock", ""), (0x15, "ByLayer", ""), (0x16, "Continuous", "Solid line")];
            for (handle, name, about) in types {
                out.entry("LTYPE", handle, 0x5, "AcDbLinetypeTableRecord", name);
                out.texts(&[(3, about), (72, "65"), (73, "0"), (40, "0")]);
            }
        });
        out.table("LAYER", 0x2, self.layers.len() + 1, |out| {
            let own = self.layers.iter().zip(FIRST_FREE..);
            let own = own.map(|((name, colour), handle)| (handle, name.as_str(), *colour));
            for (handle, name, colour) in own.chain([(0x10, "0", 7)]) {
                out.entry("LAYER", handle, 0x2, "AcDbLayerTableRecord", name);
                out.text(62, colour);
                out.text(6, "Continuous");
                out.handle(390, 0xF);
            }
        });
        out.table("STYLE", 0x3, 1, |out| {
            out.entry("STYLE", 0x11, 0x3, "AcDbTextStyleTableRecord", "Standard");
            out.texts(&[(40, "0"), (41, "1"), (50, "0"), (71, "0"), (42, "2.5"), (3, "txt"), (4, "")]);
        });
        out.table("VIEW", 0x6, 0, |_| ());
        out.table("UCS", 0x7, 0, |_| ());
        out.table("APPID", 0x9, 1, |out| out.entry("APPID", 0x12, 0x9, "AcDbRegAppTableRecord", "ACAD"));
        out.table("DIMSTYLE", 0xA, 1, |out| {
            out.text(100, "AcDbDimStyleTable");
            out.entry("DIMSTYLE", 0x27, 0xA, "AcDbDimStyleTableRecord", "Standard");
        });
        out.table("BLOCK_RECORD", 0x1, 2, |out| {
            for (handle, name) in [(MODEL_SPACE, "*Model_Space"), (PAPER_SPACE, "*Paper_Space")] {
                out.entry("BLOCK_RECORD", handle, 0x1, "AcDbBlockTableRecord", name);
            }
        });
    }

    /// Writes the view with which a program opens the drawing: all of it.
    fn view(&self, out: &mut Tags) {
        let (centre, bounds) = (self.bounds.centre(), &self.bounds);
        out.entry("VPORT", 0x29, 0x8, "AcDbViewportTableRecord", "*Active");
        // The corners of the view on the screen, and its centre.
        out.texts(&[(10, "0"), (20, "0"), (11, "1"), (21, "1")]);
        out.number(12, centre.re);
        out.number(22, centre.im);
        // The snapping and the grid; the direction and the point looked at.
        out.texts(&[(13, "0"), (23, "0"), (14, "10"), (24, "10"), (15, "10"), (25, "10")]);
        out.texts(&[(16, "0"), (26, "0"), (36, "1"), (17, "0"), (27, "0"), (37, "0")]);
        out.number(40, 1.1 * bounds.height().max(bounds.width() / 1.5).max(1e-6));
        out.texts(&[(41, "1.5"), (42, "50")]);
    }
}

fn blocks(out: &mut Tags) {
    for (name, owner, handle) in [("*Model_Space", MODEL_SPACE, 0x20), ("*Paper_Space", PAPER_SPACE, 0x1C)] {
        out.object("BLOCK", handle, owner);
        out.texts(&[(100, "AcDbEntity"), (8, "0"), (100, "AcDbBlockBegin"), (2, name)]);
        out.text(70, 0);
        out.point(10, Complex::default());
        out.texts(&[(3, name), (1, "")]);
        out.object("ENDBLK", handle + 1, owner);
        out.texts(&[(100, "AcDbEntity"), (8, "0"), (100, "AcDbBlockEnd")]);
    }
}

fn objects(out: &mut Tags) {
    let dictionary = |out: &mut Tags, kind: &str, handle: u32, owner: u32, entries: &[(&str, u32)]| {
        out.object(kind, handle, owner);
        out.texts(&[(100, "AcDbDictionary"), (281, "1")]);
        for (name, entry) in entries {
            out.text(3, name);
            out.handle(350, *entry);
        }
    };
    dictionary(out, "DICTIONARY", 0xC, 0, &[("ACAD_GROUP", 0xD), ("ACAD_PLOTSTYLENAME", 0xE)]);
    dictionary(out, "DICTIONARY", 0xD, 0xC, &[]);
    dictionary(out, "ACDBDICTIONARYWDFLT", 0xE, 0xC, &[("Normal", 0xF)]);
    out.text(100, "AcDbDictionaryWithDefault");
    out.handle(340, 0xF);
    out.object("ACDBPLACEHOLDER", 0xF, 0xE);
}

/// Computes the leftmost, rightmost, lowest and highest points of an arc's circle that lie on the arc; a positive bulge
/// (the tangent of a quarter of the turn) turns counter-clockwise.
fn farthest_of_arc(from: Complex, to: Complex, bulge: f64) -> impl Iterator<Item = Complex> {
    let chord = to - from;
    let centre = 0.5 * (from + to) + Complex::i() * chord * ((1.0 - bulge * bulge) / (4.0 * bulge));
    let radius = chord.norm() * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    let all = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    let all = all.map(|(x, y)| centre + radius * Complex::new(x, y));
    // The arc lies to the right of its chord where it turns counter-clockwise, otherwise to the left.
    all.into_iter().filter(move |p| cross(chord, p - from) * bulge < 0.0)
}

/// Returns text on one line as DXF of 2000 writes it: printable ASCII, everything else as UTF-16 units `\U+XXXX`.
fn ascii(text: &str) -> String {
    let escaped = |c: char| -> String {
        c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\U+{unit:04X}")).collect()
    };
    text.chars().map(|c| if matches!(c, ' '..='~') { c.to_string() } else { escaped(c) }).collect()
}
