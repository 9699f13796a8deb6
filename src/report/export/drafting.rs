//! The DXF drawings: the skeleton for a sketch in a CAD program, and the plates for a cutter.

use super::dxf::Drawing;
use super::marks::marks;
use super::model::Model;
use super::skeleton::Skeleton;
use crate::files::generator::mark;
use crate::mechanism::plates::{Placement, Plate};
use crate::mechanism::{Complex, LoopJoints};
use crate::report::text::exact;

/// Draws the links as lines, the coupler curve, the joints as circles of the hole's diameter, and the target points; of a
/// slider the rail or the rod and the block on a layer of their own.
pub(super) fn sketch(model: &Model<'_>, at: &LoopJoints) -> String {
    let mut layers = vec![("SKELETON", 7), ("CURVE", 1), ("JOINTS", 3), ("TARGET", 5)];
    let (body, skeleton) = (model.body(at), Skeleton::of(model, at));
    layers.extend(body.map(|_| ("BODY", 6)));
    layers.extend(skeleton.line.map(|_| (SLIDER, 8)));
    let mut drawing = Drawing::new(&layers);
    for [from, to] in skeleton.bars() {
        // Some programs refuse a line without length.
        if from != to {
            drawing.line("SKELETON", from, to);
        }
    }
    if let Some([from, to]) = skeleton.line {
        drawing.line(SLIDER, from, to);
        let slot: Vec<(Complex, f64)> =
            skeleton.slot.iter().map(|edge| (edge.from(), edge.bulge())).collect();
        drawing.polyline(SLIDER, &slot, true);
        drawing.polyline(SLIDER, &straight(&skeleton.block), true);
    }
    for curve in &model.curves {
        drawing.polyline("CURVE", &straight(curve), true);
    }
    for (name, at) in &skeleton.joints {
        drawing.circle("JOINTS", *at, 0.5 * model.holes.drawn(name));
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
/// The layer of the rail or the rod and of the block.
const SLIDER: &str = "SLIDER";
/// The layer of what is engraved.
const MARK: &str = "MARK";

/// Draws each plate on its own layer: one closed contour, holes as true circles, a slot as a closed contour, all offset by
/// half the kerf; names to engrave on a layer of their own, unless the settings leave them out.
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
        let slot = plate.slot_outline(model.cut_slot());
        if !slot.is_empty() {
            let slot: Vec<(Complex, f64)> =
                slot.iter().map(|edge| (at.of(edge.from()), edge.bulge())).collect();
            drawing.polyline(layer, &slot, true);
        }
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
            model.holes.listed(),
            exact(model.margin),
            exact(model.kerf)
        ),
    ])
}
