//! The practicality of a linkage as text: layers, distances, sensitivities.

use super::grid::Align::{Left, Right};
use super::grid::{Colour, Column, Grid, Ink, plain};
use super::shop::shop_text;
use super::text::{COLUMNS, brief, capitalised, indented, significant, wrapped};
use super::words::length_suffix;
use crate::judge::practicality::clearance::PivotDistance;
use crate::judge::practicality::layers::{Layering, Passing, PinPlate, PlatePair, Stack, clear};
use crate::judge::practicality::sensitivity::{Crank, Dimension, Sensitivity};
use crate::judge::practicality::sweep::Stretch;
use crate::judge::practicality::{Build, Closest, Joint, Practicality};
use crate::mechanism::plates::{Link, Parts, parts};
use crate::mechanism::{LinkageKind, Unit};
use crate::task::{Output, TaskKind};

/// The number of significant digits of lengths and rates.
const DIGITS: usize = 3;

/// Counts of dimensions and of plates in words.
const COUNTS: [&str; 10] = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"];

/// Returns a count in words, as far as there are any.
fn count(n: usize) -> String {
    COUNTS.get(n).map_or_else(|| n.to_string(), |word| (*word).to_owned())
}

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
            for line in words.layers(practicality, layering) {
                out.push_str(&wrapped("  ", "    ", &line, COLUMNS));
            }
        }
        None => out.push_str(OPEN),
    }
    out.push_str(&shop_text(practicality, unit, colour));
    out.push_str(&words.head("Least distances of joints over the motion"));
    match &practicality.distances {
        Some(distances) => out.push_str(&words.distances(distances, 2.0 * practicality.build.pin_radius)),
        None => out.push_str(OPEN),
    }
    let moved = match (practicality.output, practicality.sweep.linkage.kind()) {
        (None, _) => "moves the path",
        (Some(Output::Place), _) => "moves the slider",
        (Some(Output::Angle), LinkageKind::FourBar) => "turns the follower",
        (Some(Output::Angle), _) => "turns the block",
    };
    out.push_str(&words.head(&format!("How much a wrong dimension {moved}")));
    match &practicality.sensitivity {
        Some(felt) => out.push_str(&words.sensitivity(felt, practicality, tolerance)),
        None => out.push_str(
            "  At every position looked at the linkage stands at a toggle: there are no derivatives.\n",
        ),
    }
    out
}

const SIMPLE: &str = "The model is simple: a plate with a slot counts as if it were filled, and the guide pins end flush with \
    their plates; washers or heads that hold the block on its slot need the room beside it.";

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
        brief(value, DIGITS) + &length_suffix(self.unit)
    }

    /// Returns the construction of the links, and the motion over which they were examined.
    pub(super) fn made(&self, practicality: &Practicality) -> String {
        let build = &practicality.build;
        let of = |s: &Stretch| format!("{} to {}", degrees(s.from), degrees(s.to));
        let stretches: Vec<String> = practicality.sweep.stretches.iter().map(of).collect();
        let motion = match practicality.sweep.full_turn {
            true => "the full turn of the crank".to_owned(),
            false => format!("crank {}", stretches.join(", ")),
        };
        format!(
            "Holes {}{}, plates {} around them; over {motion}.{}",
            self.length(2.0 * build.pin_radius),
            self.own_holes(practicality),
            self.length(build.margin()),
            build.parts(&practicality.sweep).map_or(String::new(), |parts| self.guide(&parts, build))
        )
    }

    /// Returns the holes with diameters of their own, with a comma before each joint.
    fn own_holes(&self, Practicality { build, sweep, .. }: &Practicality) -> String {
        let linkage = &sweep.linkage;
        let hole = |(link, hole): &(Link, f64)| format!("{} in {}", self.length(*hole), link.in_words());
        let joint = |(joint, holes): (Joint, Vec<(Link, f64)>)| {
            let holes: Vec<String> = holes.iter().map(hole).collect();
            format!(", at {} {}", joint.name(), holes.join(" and "))
        };
        let listed = build.bores.listed(&parts::pins(linkage), parts::traced(linkage));
        listed.into_iter().map(joint).collect()
    }

    /// Returns the description of the guide of a slider, with a blank before it; nothing of a four-bar.
    fn guide(&self, parts: &Parts, build: &Build) -> String {
        let (Some(guide), Some(slot)) = (parts.guide(), parts.slot()) else { return String::new() };
        let mut text = format!(
            " The block runs on two pins, E and F, {} apart, in a slot of the {} as wide as a hole and {} long between the \
             centres of its ends S and T; it travels {}.",
            self.length(2.0 * guide.half),
            slot.link.name(),
            self.length(slot.length()),
            self.length(guide.travel[1] - guide.travel[0])
        );
        if parts.undrilled().is_some() {
            text.push_str(
                " P lies in the slot, where no hole has room: what is mounted there bridges the slot.",
            );
        }
        if let Some((link, joints, _)) = parts.hole_in_slot(|link, joints| build.bores.of(link, joints)) {
            let fault = format!(
                " The slot runs into the hole at {joints} of the {}: choose a smaller hole and margin, or another linkage.",
                link.name()
            );
            text.push_str(&self.colour.paint(Ink::Bad, &fault));
        }
        text
    }

    /// Returns the stacking, its obstacles and the plates that pass over ends of pins, one line for each. A pin may have
    /// a head as wide as the plates around it.
    pub(super) fn layers(&self, practicality: &Practicality, layering: &Layering) -> Vec<String> {
        let no_stack = format!(
            "No stacking of the {} plates works, each in one layer, the ground in one piece.",
            count(layering.links.len())
        );
        let joined: Vec<String> =
            layering.joined().iter().map(|[one, other]| format!("{}-{}", one.name(), other.name())).collect();
        let joined =
            format!("Plates that a pin joins ({}) overlap at it and never share a layer.", joined.join(", "));
        let mut out = vec![match &layering.stack {
            Some(stack) => format!("{} layers, from below: {}.", stack.layers.len(), in_layers(stack)),
            None => self.colour.paint(Ink::Bad, &no_stack),
        }];
        out.extend(layering.free_pairs.iter().map(|pair| self.pair(pair)));
        match &layering.stack {
            Some(stack) => {
                let through = |(pin, layer): &(Joint, usize)| self.through(layering, stack, *pin, *layer);
                out.extend(stack.through.iter().map(through));
                let head = practicality.build.margin();
                out.extend(layering.passings(stack, head).map(|passing| self.passing(&passing)));
            }
            None => {
                out.extend(layering.crossings().map(|p| self.crossing(p)));
                out.push(always(&layering.links));
            }
        }
        out.push(joined);
        out.extend(layering.links.contains(&Link::Block).then(|| SIMPLE.to_owned()));
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
        let (pin, plate) = (p.pin.name(), p.plate.in_words());
        format!("A pin {pin} that stood through the layer of {plate} would cross it ({}).", at(&p.closest))
    }

    fn through(&self, layering: &Layering, stack: &Stack, pin: Joint, layer: usize) -> String {
        let beside: Vec<String> = stack.layers[layer]
            .iter()
            .filter_map(|plate| layering.pins_plates.iter().find(|p| p.pin == pin && p.plate == *plate))
            .map(|p| {
                format!(
                    "never nearer than {} to {} ({})",
                    self.length(p.closest.value),
                    p.plate.in_words(),
                    at(&p.closest)
                )
            })
            .collect();
        format!("Pin {} stands through layer {}: {}.", pin.name(), layer + 1, beside.join(", "))
    }

    fn passing(&self, Passing { pair, plate, end }: &Passing<'_>) -> String {
        let beside = match pair.closest.value {
            value if value > 0.0 => format!("{} beside", self.length(value)),
            _ if plate > end => "over".to_owned(),
            _ => "under".to_owned(),
        };
        format!(
            "{} (layer {}) passes {beside} the end of pin {} ({}): end the pin flush with layer {}, without a head, \
             nut or motor there, or leave room for it by spacers.",
            capitalised(&pair.plate.in_words()),
            plate + 1,
            pair.pin.name(),
            at(&pair.closest),
            end + 1
        )
    }

    fn distances(&self, distances: &[PivotDistance], hole: f64) -> String {
        let moving: Vec<&PivotDistance> = distances.iter().filter(|d| !d.fixed).collect();
        let ink = |d: &PivotDistance| if objection(d, hole).is_empty() { Ink::Plain } else { Ink::Bad };
        let grid = Grid::of(
            &moving,
            &[
                (Left, "joints", &|d| plain(d.between.join("-"))),
                (Right, "least", &|d| (significant(d.closest.value, DIGITS + 1), ink(d))),
                (Right, "at crank", &|d| plain(degrees(d.closest.crank_angle))),
                (Left, "", &|d| (objection(d, hole).to_owned(), ink(d))),
            ],
        );
        let mut out = grid.render(self.colour);
        out.push_str(&indented(&held(distances)));
        out
    }

    fn sensitivity(&self, felt: &Sensitivity, practicality: &Practicality, tolerance: f64) -> String {
        let at_target = match practicality.kind {
            TaskKind::Path => "at point",
            TaskKind::Motion => "at pose",
            TaskKind::Function => "at pair",
        };
        let worst = felt.worst_dimension().name;
        let ink = |d: &Dimension| match d.name {
            "ground" => Ink::Faint,
            name if name == worst => Ink::Strong,
            _ => Ink::Plain,
        };
        let columns: [Column<'_, &Dimension>; 4] = [
            (Left, "dimension", &|d| (d.name.to_owned(), ink(d))),
            (Right, "rms", &|d| (significant(d.rms, DIGITS), ink(d))),
            (Right, "most", &|d| (significant(d.worst, DIGITS), ink(d))),
            (Right, at_target, &|d| (d.worst_at.to_string(), ink(d))),
        ];
        let rows: Vec<&Dimension> = felt.dimensions.iter().chain(&felt.ground).collect();
        let grid = Grid::of(&rows, if practicality.at_points { &columns } else { &columns[..3] });
        let mut out = indented(&shift(felt, practicality));
        out.push_str(&grid.render(self.colour));
        out.push_str(&indented(&self.together(felt, practicality, tolerance)));
        out
    }

    /// Returns the worst dimension, and the combined effect of all dimensions.
    pub(super) fn together(&self, felt: &Sensitivity, practicality: &Practicality, tolerance: f64) -> String {
        let worst = felt.worst_dimension().name;
        let (at_points, kind) = (practicality.at_points, practicality.kind);
        let most = if at_points { format!(" at {} {}", kind.noun(), felt.worst_at) } else { String::new() };
        let of_function = kind == TaskKind::Function;
        let off = |value: f64| match practicality.output == Some(Output::Angle) {
            true => format!("{}°", significant(value, DIGITS)),
            false => self.length(value),
        };
        let what = if of_function { "the output" } else { "the path" };
        let count = count(felt.dimensions.len());
        let has = |name: &str| felt.dimensions.iter().any(|d| d.name == name);
        let mut text = format!(
            "The worst dimension is {worst}. With every dimension off by {} (1 sigma, the {count} above independent of \
             each other) {what} is off by {} rms, {} where it is most{most} (1 sigma).",
            self.length(tolerance),
            off(tolerance * felt.band),
            off(tolerance * felt.worst)
        );
        if has("rail_from") {
            text.push_str(" rail_from and rail_to move the rail across itself at the least and at the greatest place of D, the other end held.");
        }
        if has("c") && has("coupler_x") {
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

/// Returns the construction without a stacking of plates that are each in one layer.
fn always(links: &[Link]) -> String {
    match links[..] {
        [.., last] if links.len() == 4 => format!(
            "What always works: the ground on both sides, in five layers: ground, crank, coupler, {}, ground. The two \
             halves are joined outside of where the links reach.",
            last.name()
        ),
        _ => "What helps: a link in two halves, one on either side of the others, joined outside of where they reach; \
            smaller holes and margins; or another candidate."
            .to_owned(),
    }
}

/// Returns the description of the table of sensitivities.
pub(super) fn shift(felt: &Sensitivity, Practicality { kind, output, .. }: &Practicality) -> String {
    let alone = match felt.settled {
        0 => String::new(),
        n => format!(", and across the path at the {n} of {} points whose crank angle is free", felt.points),
    };
    let settled = (settles(felt.crank).to_owned() + &alone).replace("point", kind.noun());
    if let Some(output) = output {
        let settled = settled.replace("pairs move", "outputs change");
        let what = if *output == Output::Angle { "output, in degrees," } else { "slider's place" };
        return format!("Change of the {what} for an error of 1 in each dimension alone, {settled}.");
    }
    format!("Shift of the path for an error of 1 in each dimension alone, {settled}.")
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
    // Five digits are exact; in this way no zero has a sign.
    format!("{}°", brief(if degrees >= 360.0 { 0.0 } else { degrees }, 5))
}

#[cfg(test)]
mod tests {
    use super::degrees;

    #[test]
    fn an_angle_is_shown_to_a_tenth_below_a_turn_and_never_as_minus_zero() {
        let shown = [-0.0, -1e-9, 0.5, 123.44, 359.96, -90.0].map(|deg: f64| degrees(deg.to_radians()));
        assert_eq!(shown, ["0°", "0°", "0.5°", "123.4°", "0°", "270°"]);
    }
}
