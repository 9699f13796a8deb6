//! The parts of a linkage that is built with shop data, as text: pins, spacers, thicknesses and rims.

use super::grid::Align::{Left, Right};
use super::grid::{Colour, Grid, Ink, plain};
use super::text::{COLUMNS, brief, wrapped};
use super::words::length_suffix;
use crate::judge::practicality::Practicality;
use crate::judge::practicality::pins::{PinLength, pin_lengths};
use crate::judge::practicality::rims::{NeededRim, needed_rims};
use crate::mechanism::Unit;
use crate::mechanism::plates::shop::RIM_SHARE;
use crate::mechanism::plates::{Beside, Link, Shop};

/// The number of significant digits of lengths.
const DIGITS: usize = 4;

/// Returns the plates that a pin passes through with the spacers between them, from below; `length` writes a length.
pub fn through(pin: &PinLength, length: impl Fn(f64) -> String) -> String {
    let mut words = Vec::new();
    for (i, link) in pin.plates.iter().enumerate() {
        words.push(link.name().to_owned());
        let above = pin.plates.get(i + 1);
        let spacer = pin.spacers.iter().find(|spacer| Some(&spacer.between[1]) == above);
        words.extend(spacer.map(|spacer| format!("spacer {}", length(spacer.length))));
    }
    words.join(", ")
}

/// Returns the warning of a thin rim; `length` writes a length with its unit.
pub fn thin_rim(needed: &NeededRim, length: impl Fn(f64) -> String) -> String {
    let NeededRim { link, rim, hole: (joints, hole), needed } = needed;
    let link = link.in_words();
    let beside = match &rim.beside {
        Beside::Edge => "the edge".to_owned(),
        Beside::Slot => "the slot".to_owned(),
        Beside::Hole(other) => format!("the hole at {other}"),
    };
    let width = match rim.width > 0.0 {
        true => format!("is {} wide", length(rim.width)),
        false => "has nothing left".to_owned(),
    };
    let remedy = match rim.beside {
        Beside::Edge => "a wider plate or margin, or a smaller hole",
        _ => "smaller holes, or a linkage on which they are farther apart",
    };
    format!(
        "Thin rim: {link} {width} between the hole at {} and {beside}, where the hole of {} at {joints} needs {}: choose {remedy}.",
        rim.joints,
        length(*hole),
        length(*needed)
    )
}

/// Returns the section on pins, spacers and rims; nothing without shop data.
pub fn shop_text(practicality: &Practicality, unit: Option<Unit>, colour: Colour) -> String {
    let build = &practicality.build;
    let (Some(shop), Some(parts)) = (&build.shop, build.parts(&practicality.sweep)) else {
        return String::new();
    };
    let number = |value: f64| brief(value, DIGITS);
    let length = |value: f64| number(value) + &length_suffix(unit);
    let mut out = format!("{}\n", colour.paint(Ink::Strong, "Pins, spacers and rims"));
    let mut line = |text: &str| out.push_str(&wrapped("  ", "    ", text, COLUMNS));
    let links = parts.links();
    line(&thicknesses(&links, |link| build.thickness_of(link), length));
    let layering = practicality.layering.as_ref();
    let pins = layering
        .and_then(|layering| pin_lengths(layering, &parts, &build.bores, |link| build.thickness_of(link)));
    match pins {
        None => line("Without a stacking the pins have no lengths."),
        Some(pins) => {
            let rows: Vec<&PinLength> = pins.iter().collect();
            let grid = Grid::of(
                &rows,
                &[
                    (Left, "pin", &|pin| plain(pin.name())),
                    (Right, "diameter", &|pin| plain(number(pin.diameter))),
                    (Right, "length", &|pin| plain(number(pin.length))),
                    (Left, "through, from below", &|pin| plain(through(pin, length))),
                ],
            );
            out.push_str(&grid.render(colour));
        }
    }
    let plates = parts.plates(|link| build.radius_of(link));
    let rims = needed_rims(&plates, &build.bores, shop);
    let mut line = |text: &str| out.push_str(&wrapped("  ", "    ", text, COLUMNS));
    line(&rule(shop, &length));
    let spare = |rim: &NeededRim| rim.rim.width - rim.needed;
    match rims.iter().min_by(|one, other| spare(one).total_cmp(&spare(other))) {
        Some(least) if !least.is_thin() => {
            let (joints, link) = (&least.rim.joints, least.link.in_words());
            let [width, needed] = [least.rim.width, least.needed].map(length);
            line(&format!(
                "All are wide enough; the tightest is {width} at {joints} of {link}, which needs {needed}."
            ));
        }
        _ => rims
            .iter()
            .filter(|rim| rim.is_thin())
            .for_each(|rim| line(&colour.paint(Ink::Bad, &thin_rim(rim, length)))),
    }
    out
}

/// Returns the thicknesses of plates: the first of them, and those that differ.
fn thicknesses(links: &[Link], of: impl Fn(Link) -> f64, length: impl Fn(f64) -> String) -> String {
    let Some(first) = links.iter().map(|link| of(*link)).reduce(f64::min) else { return String::new() };
    let others = links.iter().filter(|link| of(**link) != first);
    let others: Vec<String> =
        others.map(|link| format!("{} {}", link.in_words(), length(of(*link)))).collect();
    let others = if others.is_empty() { String::new() } else { format!(", {}", others.join(", ")) };
    format!("Plates {} thick{others}; pins end flush with their plates.", length(first))
}

/// Returns the rule of rims in words.
fn rule(shop: &Shop, length: &impl Fn(f64) -> String) -> String {
    let own = shop.joints.iter().filter_map(|(joint, sizes)| Some((joint.name(), sizes.rim?)));
    let own: Vec<String> = own.map(|(joint, rim)| format!("{} at {joint}", length(rim))).collect();
    let own = if own.is_empty() { String::new() } else { format!(", and {}", own.join(", ")) };
    match shop.rim {
        Some(rim) => format!("Rims are to be {} wide (rim of [shop]){own}.", length(rim)),
        None => format!(
            "Rims are to be {RIM_SHARE} of the hole's diameter wide (EN 1993-1-8: centres at least 1.2 diameters from edges; rim of \
             [shop] sets another width){own}."
        ),
    }
}
