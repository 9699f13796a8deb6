//! The cut list: the sizes of the plates and the places of their holes.

use super::model::{Model, distances};
use super::stock;
use crate::mechanism::Complex;
use crate::mechanism::plates::{Link, Placement, Plate, Slot};
use crate::report::csv::written;
use crate::report::text::{cell, exact};
use std::f64::consts::PI;

/// The columns; there is one row for each plate and pair of its holes, the two ends S and T of a slot among them.
const COLUMNS: [&str; 12] = [
    "plate",
    "holes",
    "from",
    "to",
    "distance_mm",
    "hole_mm",
    "length_mm",
    "width_mm",
    "thickness_mm",
    "area_mm2",
    "from_hole_mm",
    "to_hole_mm",
];

/// Returns the length and width of the piece of stock: along the line of the first two holes, and across it.
fn size(plate: &Plate) -> [f64; 2] {
    let [low, high] = plate.bounds();
    [high.re - low.re, high.im - low.im]
}

/// Returns the letters and the centres of a plate's holes, and of the two ends of its slot.
fn marked(plate: &Plate) -> Vec<(String, Complex)> {
    let ends = plate.slot.into_iter().flat_map(|slot| Slot::LETTERS.into_iter().zip(slot.ends));
    let ends = ends.map(|(letter, end)| (letter.to_owned(), end));
    plate.distinct_holes().into_iter().chain(ends).collect()
}

/// Returns the area of the plate without its holes and its slot.
fn area(model: &Model<'_>, plate: &Plate) -> f64 {
    let holes = plate.distinct_holes().into_iter();
    let area = |(joints, _): (String, _)| PI * (0.5 * model.holes.of(plate.link, &joints)).powi(2);
    let width = model.holes.pins;
    let slot = plate.slot.map_or(0.0, |slot| slot.length() * width + PI * (0.5 * width).powi(2));
    plate.area() - holes.map(area).sum::<f64>() - slot
}

fn number(value: f64) -> String {
    format!("{value:.3}")
}

/// Returns the number of pins that join the plates, and whether P has a hole of its own.
fn pins(model: &Model<'_>, plates: &[(Plate, Placement)]) -> (usize, bool) {
    let holes = |link| {
        let plate = plates.iter().filter(move |(plate, _)| plate.link == link);
        plate.flat_map(|(plate, _)| plate.distinct_holes())
    };
    let is_joined = |(name, _): (String, _)| name.contains('P') && name.len() > 1;
    // Coincident fixed pivots share one pin.
    let ground = plates.iter().find(|(plate, _)| plate.link == Link::Ground);
    let shared = ground.map_or(0, |(plate, _)| plate.holes.len() - plate.distinct_holes().len());
    let all = model.parts.as_ref().map_or(0, |parts| parts.pins().len());
    let traced = model.parts.as_ref().map_or(Link::Coupler, |parts| parts.traced());
    (all - shared, !holes(traced).any(is_joined))
}

/// Returns the list as text.
pub(super) fn text(model: &Model<'_>, plates: &[(Plate, Placement)]) -> String {
    let mut out = format!("Cut list: {}\n{}\n\n", model.heading(), crate::files::generator::mark());
    let (thickness, for_shop) = (number(model.thickness), model.holes.shop.is_some());
    out.push_str(&format!(
        "material {thickness} mm thick, holes {} mm in diameter{}, {} mm from a hole's edge to the plate's\n\n",
        number(model.holes.pins),
        model.holes.listed(),
        number(model.margin)
    ));
    let line = |plate: &str, [length, width, thick, area]: [&str; 4], holes: &str| {
        // Without shop data all plates are as thick.
        let thick = if for_shop { format!("{thick:>12}") } else { String::new() };
        format!("{plate:<10}{length:>12}{width:>12}{thick}{area:>14}   {holes}\n")
    };
    out.push_str(&line("plate", ["length mm", "width mm", "thick mm", "area mm2"], "holes, mm apart"));
    for (plate, _) in plates {
        let [length, width] = size(plate);
        let pairs = distances(&marked(plate));
        let mut holes: Vec<String> =
            pairs.iter().map(|(from, to, apart)| format!("{from} to {to} {}", number(*apart))).collect();
        if holes.is_empty() {
            holes = plate.distinct_holes().into_iter().map(|(name, _)| format!("{name} alone")).collect();
        }
        let sizes = [length, width, model.thickness_of(plate.link), area(model, plate)].map(number);
        out.push_str(&line(plate.link.name(), sizes.each_ref().map(|size| &**size), &holes.join(", ")));
    }
    if for_shop {
        out.push_str(&stock::text(model));
    } else {
        out.push_str(&counted_pins(model, plates));
    }
    if let Some((plate, slot)) = plates.iter().find_map(|(plate, _)| Some((plate, plate.slot?))) {
        out.push_str(&format!(
            "slot in the {}: {} mm wide, {} mm from S to T, the centres of its round ends; the block's pins E and F run in it\n",
            plate.link.name(),
            number(model.holes.pins),
            number(slot.length())
        ));
    }
    out
}

/// Returns the line about the pins of plates that are all as thick.
fn counted_pins(model: &Model<'_>, plates: &[(Plate, Placement)]) -> String {
    let (pins, tracer) = pins(model, plates);
    let motor = model.holes.bores.differ();
    let mut out = format!(
        "\n{} plates, {} pins of {} mm through at least two plates ({} mm)",
        plates.len(),
        pins - usize::from(motor),
        number(model.holes.pins),
        number(2.0 * model.thickness)
    );
    if motor {
        out.push_str(", a shaft at A");
    }
    let undrilled = model.parts.as_ref().is_some_and(|parts| parts.undrilled().is_some());
    out.push_str(match (undrilled, tracer) {
        (true, _) => "; P lies in the slot and has no hole\n",
        (false, true) => ", a pen or a pin at P\n",
        (false, false) => "; P is on a pin\n",
    });
    out
}

/// Returns the list as CSV, one row for each pair of holes of a plate.
pub(super) fn csv(model: &Model<'_>, plates: &[(Plate, Placement)]) -> String {
    let rows = plates.iter().flat_map(|(plate, _)| {
        let holes = plate.distinct_holes();
        let mut pairs = distances(&marked(plate));
        if pairs.is_empty() {
            pairs = holes.iter().map(|(name, _)| (name.clone(), name.clone(), 0.0)).collect();
        }
        let [length, width] = size(plate);
        let (area, thickness) = (area(model, plate), model.thickness_of(plate.link));
        let count = holes.len();
        pairs.into_iter().map(move |(from, to, apart)| {
            let mut row = vec![plate.link.name().to_owned(), count.to_string(), cell(&from), cell(&to)];
            let of = |joints: &str| model.holes.of(plate.link, joints);
            let numbers = [apart, model.holes.pins, length, width, thickness, area, of(&from), of(&to)];
            row.extend(numbers.into_iter().map(exact));
            row
        })
    });
    let stock = if model.holes.shop.is_some() { stock::rows(model) } else { Vec::new() };
    written(COLUMNS, rows.chain(stock))
}
