//! Pins and spacers of the cut list, cut to length for the layers of the plates: with shop data alone, which gives thicknesses.

use super::model::Model;
use crate::judge::practicality::layers::Stack;
use crate::judge::practicality::pins::PinLength;
use crate::report::shop::through;
use crate::report::text::{cell, exact};

fn number(value: f64) -> String {
    format!("{value:.3}")
}

/// Returns the layers of a stack, from below.
fn layers(stack: &Stack) -> String {
    let layer = |links: &Vec<crate::mechanism::plates::Link>| {
        links.iter().map(|link| link.name()).collect::<Vec<_>>().join(" and ")
    };
    stack.layers.iter().map(layer).collect::<Vec<_>>().join(", ")
}

/// Returns the lines about pins and spacers.
pub(super) fn text(model: &Model<'_>) -> String {
    let Some((stack, pins)) = model.stacked() else {
        return "\nno stacking of these plates keeps them and their pins from crossing: the pins have no lengths (linkwright build says \
                what crosses)\n"
            .to_owned();
    };
    let mut out = format!("\nlayers, from below: {}\n\n", layers(&stack));
    let line = |pin: &str, thick: &str, long: &str, through: &str| {
        format!("{pin:<10}{thick:>12}{long:>12}   {through}\n")
    };
    out.push_str(&line("pin", "diameter mm", "length mm", "through, from below"));
    for pin in &pins {
        out.push_str(&line(&pin.name(), &number(pin.diameter), &number(pin.length), &through(pin, number)));
    }
    let spacers: usize = pins.iter().map(|pin| pin.spacers.len()).sum();
    let count = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    out.push_str(&format!(
        "\n{}, {}; pins end flush with their plates: add what heads, nuts and washers need\n",
        count(pins.len(), "pin"),
        count(spacers, "spacer")
    ));
    out
}

/// Returns the rows of pins and spacers: `from` and `to` are the lowest and the highest plate, `hole_mm` the inner diameter of a
/// spacer, `width_mm` the diameter of a pin.
pub(super) fn rows(model: &Model<'_>) -> Vec<Vec<String>> {
    let Some((_, pins)) = model.stacked() else { return Vec::new() };
    let row = |kind: &str, pin: &PinLength, [from, to]: [&str; 2], [hole, length, width]: [String; 3]| {
        let name = cell(&format!("{kind} {}", pin.name()));
        let words = [name, String::new(), from.to_owned(), to.to_owned(), String::new(), hole, length, width];
        words.into_iter().chain(std::iter::repeat_n(String::new(), 4)).collect::<Vec<String>>()
    };
    let mut rows = Vec::new();
    for pin in &pins {
        if let [lowest, .., highest] = pin.plates[..] {
            let sizes = [String::new(), exact(pin.length), exact(pin.diameter)];
            rows.push(row("pin", pin, [lowest.name(), highest.name()], sizes));
        }
        for spacer in &pin.spacers {
            let sizes = [exact(pin.diameter), exact(spacer.length), String::new()];
            rows.push(row("spacer", pin, spacer.between.map(|link| link.name()), sizes));
        }
    }
    rows
}
