//! The practicality of a linkage as text: layers, distances, sensitivities.

use super::grid::Align::{Left, Right};
use super::grid::{Colour, Grid, Ink, plain};
use super::text::{COLUMNS, brief, capitalised, indented, significant, wrapped};
use crate::judge::practicality::clearance::PivotDistance;
use crate::judge::practicality::layers::{Layering, PinPlate, PlatePair, Stack, clear};
use crate::judge::practicality::sensitivity::{Crank, Dimension, Sensitivity};
use crate::judge::practicality::{Closest, Practicality};
use crate::mechanism::Unit;
use crate::mechanism::plates::Link;

/// The number of significant digits of lengths and rates.
const DIGITS: usize = 3;

/// Returns the whole text, for a standard deviation `tolerance` of each dimension.
pub fn practicality_text(
    practicality: &Practicality,
    unit: Option<Unit>,
    tolerance: f64,
    colour: Colour,
) -> String {
    let words = Words { unit, colour };
    let mut out = words.head("Layers");
    out.push_str(&indented(&words.made(practicality)));
    match &practicality.layering {
        Some(layering) => {
            for line in words.layers(layering) {
                out.push_str(&wrapped("  ", "    ", &line, COLUMNS));
            }
        }
        None => out.push_str(OPEN),
    }
    out.push_str(&words.head("Least distances of joints over the motion"));
    match &practicality.distances {
        Some(distances) => out.push_str(&words.distances(distances, 2.0 * practicality.build.pin_radius)),
        None => out.push_str(OPEN),
    }
    out.push_str(&words.head("How much a wrong dimension moves the path"));
    match &practicality.sensitivity {
        Some(felt) => out.push_str(&words.sensitivity(felt, practicality.at_points, tolerance)),
        None => out.push_str(
            "  At every position looked at the linkage stands at a toggle: there are no derivatives.\n",
        ),
    }
    out
}

const OPEN: &str = "  The loop is open somewhere in the motion: nothing can be said.\n";

/// The sentences, with their lengths in a unit.
pub(super) struct Words {
    pub(super) unit: Option<Unit>,
    pub(super) colour: Colour,
}

impl Words {
    fn head(&self, text: &str) -> String {
        format!("{}\n", self.colour.paint(Ink::Strong, text))
    }

    pub(super) fn length(&self, value: f64) -> String {
        let unit = self.unit.map_or(String::new(), |u| format!(" {}", u.label()));
        format!("{}{unit}", brief(value, DIGITS))
    }

    /// Returns the construction of the links, and the motion over which they were examined.
    pub(super) fn made(&self, practicality: &Practicality) -> String {
        let (radius, pin) = (practicality.build.plate_radius, practicality.build.pin_radius);
        let motion = match practicality.sweep.full_turn {
            true => "the full turn of the crank".to_owned(),
            false => {
                let of = |s: &crate::judge::practicality::sweep::Stretch| {
                    format!("{} to {}", degrees(s.from), degrees(s.to))
                };
                format!(
                    "crank {}",
                    practicality.sweep.stretches.iter().map(of).collect::<Vec<_>>().join(", ")
                )
            }
        };
        format!(
            "Holes {}, plates {} around them; over {motion}.",
            self.length(2.0 * pin),
            self.length(radius - pin)
        )
    }

    /// Returns the stacking and its obstacles, one line for each.
    pub(super) fn layers(&self, layering: &Layering) -> Vec<String> {
        let mut out = Vec::new();
        let mut line = |text: &str| out.push(text.to_owned());
        match &layering.stack {
            Some(stack) => {
                line(&format!("{} layers, from below: {}.", stack.layers.len(), in_layers(stack)));
                for pair in &layering.free_pairs {
                    line(&self.pair(pair));
                }
                for (pin, layer) in &stack.through {
                    line(&self.through(layering, stack, *pin, *layer));
                }
            }
            None => {
                line(&self.colour.paint(
                    Ink::Bad,
                    "No stacking of the four plates works, each in one layer, the ground in one piece.",
                ));
                for pair in &layering.free_pairs {
                    line(&self.pair(pair));
                }
                for p in layering.crossings() {
                    line(&self.crossing(p));
                }
                line(
                    "What always works: the ground on both sides, in five layers: ground, crank, coupler, follower, \
                     ground. The two halves are joined outside of where the links reach.",
                );
            }
        }
        line(
            "Plates that a pin joins (ground-crank, crank-coupler, coupler-follower, follower-ground) overlap at it and never share a layer.",
        );
        out
    }

    fn pair(&self, pair: &PlatePair) -> String {
        let [one, other] = pair.plates.map(Link::name);
        let Closest { value, .. } = pair.closest;
        let at = at(&pair.closest);
        let names = format!("{} and {other}", capitalised(one));
        if clear(&pair.closest) {
            format!("{names} can share a plane: never nearer than {} ({at}).", self.length(value))
        } else if value < 0.0 {
            format!("{names} cannot share a plane: they overlap by up to {} ({at}).", self.length(-value))
        } else {
            format!("{names} cannot share a plane: they all but touch ({at}).")
        }
    }

    fn crossing(&self, p: &PinPlate) -> String {
        let (pin, plate) = (p.pin.name(), p.plate.name());
        format!(
            "A pin {pin} that stood through the layer of the {plate} would cross it ({}).",
            at(&p.closest)
        )
    }

    fn through(
        &self,
        layering: &Layering,
        stack: &Stack,
        pin: crate::judge::practicality::Joint,
        layer: usize,
    ) -> String {
        let beside: Vec<String> = stack.layers[layer]
            .iter()
            .filter_map(|plate| layering.pins_plates.iter().find(|p| p.pin == pin && p.plate == *plate))
            .map(|p| {
                format!(
                    "never nearer than {} to the {} ({})",
                    self.length(p.closest.value),
                    p.plate.name(),
                    at(&p.closest)
                )
            })
            .collect();
        format!("Pin {} stands through layer {}: {}.", pin.name(), layer + 1, beside.join(", "))
    }

    fn distances(&self, distances: &[PivotDistance], hole: f64) -> String {
        let mut grid = Grid::new(&[(Left, &["joints"]), (Right, &["least", "at crank"]), (Left, &[""])]);
        for d in distances.iter().filter(|d| !d.fixed) {
            let [one, other] = d.between;
            let note = objection(d, hole);
            let ink = if note.is_empty() { Ink::Plain } else { Ink::Bad };
            grid.row([
                plain(format!("{one}-{other}")),
                (significant(d.closest.value, DIGITS + 1), ink),
                plain(degrees(d.closest.crank_angle)),
                (note.to_owned(), ink),
            ]);
        }
        let mut out = grid.render(self.colour);
        out.push_str(&indented(&held(distances)));
        out
    }

    fn sensitivity(&self, felt: &Sensitivity, at_points: bool, tolerance: f64) -> String {
        let heads: &[&str] = if at_points { &["rms", "most", "at point"] } else { &["rms", "most"] };
        let mut grid = Grid::new(&[(Left, &["dimension"]), (Right, heads)]);
        let worst = felt.worst_dimension().name;
        let row = |d: &Dimension, ink: Ink| {
            [
                (d.name.to_owned(), ink),
                (significant(d.rms, DIGITS), ink),
                (significant(d.worst, DIGITS), ink),
                (d.worst_at.to_string(), ink),
            ]
        };
        for d in &felt.dimensions {
            grid.row(row(d, if d.name == worst { Ink::Strong } else { Ink::Plain }));
        }
        grid.row(row(&felt.ground, Ink::Faint));
        let mut out = indented(&shift(felt));
        out.push_str(&grid.render(self.colour));
        out.push_str(&indented(&self.together(felt, at_points, tolerance)));
        out
    }

    /// Returns the worst dimension, and the combined effect of all dimensions.
    pub(super) fn together(&self, felt: &Sensitivity, at_points: bool, tolerance: f64) -> String {
        let worst = felt.worst_dimension().name;
        let most = if at_points { format!(" at point {}", felt.worst_at) } else { String::new() };
        let mut text = format!(
            "The worst dimension is {worst}. With every dimension off by {} (1 sigma, the nine above independent of \
             each other) the path is off by {} rms, {} where it is most{most} (1 sigma).",
            self.length(tolerance),
            self.length(tolerance * felt.band),
            self.length(tolerance * felt.worst)
        );
        if felt.dimensions.iter().any(|d| d.name == "coupler_x") {
            text.push_str(" P lies nearly on the line C-D, where d and e hardly say where: coupler_x and coupler_y are P along and across it.");
        }
        if !felt.at_toggles.is_empty() {
            text.push_str(&format!(
                " {} positions at a toggle have no derivative and are left out.",
                felt.at_toggles.len()
            ));
        }
        text
    }
}

/// Returns the description of the table of sensitivities.
pub(super) fn shift(felt: &Sensitivity) -> String {
    format!("Shift of the path for an error of 1 in each dimension alone, {}.", settles(felt.crank))
}

/// Returns the distances between joints that a link keeps fixed.
pub(super) fn held(distances: &[PivotDistance]) -> String {
    let held: Vec<String> = distances
        .iter()
        .filter(|d| d.fixed)
        .map(|d| format!("{}-{} {}", d.between[0], d.between[1], brief(d.closest.value, DIGITS + 1)))
        .collect();
    format!("Held by a link: {}.", held.join(", "))
}

/// Returns the objection to a distance that is below a hole; empty if there is none.
pub(super) fn objection(d: &PivotDistance, hole: f64) -> &'static str {
    let pins = d.between.iter().all(|joint| *joint != "P");
    match d.closest.value < hole {
        true if pins => "a pin there crosses the other: not in one layer",
        true => "nearer than a hole: mind what is mounted at P",
        false => "",
    }
}

/// Returns the behaviour of the crank that the sensitivities assume.
fn settles(crank: Crank) -> &'static str {
    match crank {
        Crank::Settles => "across the path (along it, a point is only passed earlier or later)",
        Crank::OffsetIsSet => "with the crank's common offset set anew so that the points move least",
        Crank::Stays => "at the same crank angles",
        Crank::TurnsWithGround => {
            "at the same crank angles from the ground line, which turns with the pivots"
        }
    }
}

fn in_layers(stack: &Stack) -> String {
    let layer = |(i, plates): (usize, &Vec<Link>)| {
        format!("{} {}", i + 1, plates.iter().map(|plate| plate.name()).collect::<Vec<_>>().join(" and "))
    };
    stack.layers.iter().enumerate().map(layer).collect::<Vec<_>>().join("; ")
}

fn at(closest: &Closest) -> String {
    format!("crank at {}", degrees(closest.crank_angle))
}

/// Returns an angle in [0, 360) degrees, to a tenth.
pub(super) fn degrees(angle: f64) -> String {
    let degrees = (angle.to_degrees().rem_euclid(360.0) * 10.0).round() / 10.0;
    format!("{}°", if degrees >= 360.0 { 0.0 } else { degrees })
}
