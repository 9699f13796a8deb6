//! The DXF drawings: the skeleton for a sketch in a CAD program, and the plates for a cutter.

use super::dxf::Drawing;
use super::marks::marks;
use super::model::Model;
use crate::files::generator::mark;
use crate::mechanism::plates::{Placement, Plate};
use crate::mechanism::{Complex, Joints};
use crate::report::scene::all_joints;
use crate::report::text::exact;

/// Draws the links as lines, the coupler curve, the joints as circles of the hole's diameter, and the target points.
pub(super) fn sketch(model: &Model<'_>, joints: &Joints) -> String {
    let mut layers = vec![("SKELETON", 7), ("CURVE", 1), ("JOINTS", 3), ("TARGET", 5)];
    let body = model.body(joints);
    layers.extend(body.map(|_| ("BODY", 6)));
    let mut drawing = Drawing::new(&layers);
    let [a, b, c, d, p] = all_joints(model.linkage, joints);
    for (from, to) in [(a, b), (a, c), (c, d), (b, d), (c, p), (d, p)] {
        // Some programs refuse a line without length.
        if from != to {
            drawing.line("SKELETON", from, to);
        }
    }
    for curve in &model.curves {
        drawing.polyline("CURVE", &straight(curve), true);
    }
    for at in [a, b, c, d, p] {
        drawing.circle("JOINTS", at, 0.5 * model.holes.pins);
    }
    for at in &model.target {
        drawing.point("TARGET", *at);
    }
    if model.target.len() > 1 {
        drawing.polyline("TARGET", &straight(&model.target), model.subject.closed);
    }
    let frames = model.wanted.iter().map(|frame| ("TARGET", frame));
    for (layer, [tip, origin, end]) in frames.chain(body.iter().map(|frame| ("BODY", frame))) {
        drawing.line(layer, *origin, *tip);
        drawing.line(layer, *origin, *end);
    }
    drawing.document(&[mark(), model.heading()])
}

fn straight(points: &[Complex]) -> Vec<(Complex, f64)> {
    points.iter().map(|p| (*p, 0.0)).collect()
}

/// Returns the name of a plate's layer.
fn layer(plate: &Plate) -> String {
    plate.link.name().to_uppercase()
}

/// The colours of what is cut and of what is engraved, red and blue: lasers tell work apart by colours.
const CUT: u8 = 1;
const ENGRAVED: u8 = 5;
/// The layer of what is engraved.
const MARK: &str = "MARK";

/// Draws each plate on its own layer: one closed contour, holes as true circles, both offset by half the kerf; names to
/// engrave on a layer of their own, unless the settings leave them out.
pub(super) fn plates(model: &Model<'_>, plates: &[(Plate, Placement)]) -> String {
    let mut layers: Vec<(String, u8)> = plates.iter().map(|(plate, _)| (layer(plate), CUT)).collect();
    if model.settings.marks() {
        layers.push((MARK.to_owned(), ENGRAVED));
    }
    let mut drawing = Drawing::new(&layers);
    for (plate, at) in plates {
        let layer = &layer(plate);
        let edges = model.cut(plate).outline();
        let contour: Vec<(Complex, f64)> =
            edges.iter().map(|edge| (at.of(edge.from()), edge.bulge())).collect();
        drawing.polyline(layer, &contour, true);
        for (joints, hole) in plate.distinct_holes() {
            drawing.circle(layer, at.of(hole), model.cut_hole(plate.link, &joints));
        }
        if model.settings.marks() {
            let hole = |joints: &str| model.holes.of(plate.link, joints);
            for stroke in marks(plate, at, (&hole, model.margin)) {
                drawing.polyline(MARK, &straight(&stroke), false);
            }
        }
    }
    drawing.document(&[
        mark(),
        model.heading(),
        format!(
            "holes {} mm{}, margin {} mm, paths moved outward by half a kerf of {} mm",
            exact(model.holes.pins),
            model.motor_holes(),
            exact(model.margin),
            exact(model.kerf)
        ),
    ])
}
