//! The cost of snapping as text: before and after, and the next best linkages.

use super::csv::{OF_SLIDERS, PARAMETERS, Parameter};
use super::grid::Align::{Left, Right};
use super::grid::{Colour, Grid, Ink, plain, verdict};
use super::text::{COLUMNS, brief, exact, grouped, indented, significant, wrapped};
use super::words::length_suffix;
use crate::mechanism::{Complex, CrankLinkage, MultiLoop, Unit};
use crate::record::Candidate;
use crate::synthesis::snap::{Length, Request, Snapped};

/// The line of a slider-crank, and the offset of an inverted one.
const PLACES_OF_SLIDERS: [Parameter; 4] = [OF_SLIDERS[0], OF_SLIDERS[1], OF_SLIDERS[2], OF_SLIDERS[3]];

/// The number of significant digits of lengths and errors.
const DIGITS: usize = 6;

/// Returns the table of one candidate before and after, the linkages found, and the cost of plain rounding.
pub fn snap_text(
    before: &Candidate,
    request: &Request,
    snapped: &Snapped,
    unit: Option<Unit>,
    colour: Colour,
) -> String {
    let Some(after) = snapped.candidates.first() else { return String::new() };
    let unit = length_suffix(unit);
    let of_errors = if after.error.output.is_some() { "°" } else { &unit };
    let keys: Vec<String> = snapped.lengths.iter().map(|length| length.key()).collect();
    let text =
        format!("{} snapped to {}{unit}; the rest fitted again.", keys.join(", "), request.stock.words());
    let mut out = indented(&text);
    out.push_str(&dimensions(before, after, snapped, request, colour));
    out.push('\n');
    out.push_str(&figures(before, snapped, colour));
    let [was, is] = [before, after].map(|c| significant(c.error.rms, 4));
    let times = match after.error.rms / before.error.rms {
        times if before.error.rms > 0.0 && times < 1e3 => format!(": {} times", brief(times, 3)),
        _ => String::new(),
    };
    let cost = format!("The rms error goes from {was} to {is}{of_errors}{times}.");
    let target = match (&after.frame_deg, &after.error.output) {
        (Some(_), _) => "pose",
        (None, Some(_)) => "pair",
        (None, None) => "point",
    };
    let plain = match &snapped.nearest {
        Some(c) if c.accepted == after.accepted => format!(
            "Each length to its nearest stock size at once would give {}.",
            significant(c.error.rms, 4)
        ),
        Some(_) => "Each length to its nearest stock size at once would not be acceptable.".to_owned(),
        None => {
            format!(
                "Each length to its nearest stock size at once gives no linkage that reaches every {target}."
            )
        }
    };
    let fits = format!("{} combinations were fitted.", grouped(snapped.fits));
    out.push_str(&wrapped("\n  ", "  ", &format!("{cost} {plain} {fits}"), COLUMNS));
    if !after.accepted {
        let unmet: Vec<&str> =
            after.requirements.iter().filter(|r| !r.met).map(|r| r.name.as_str()).collect();
        let text = format!("Not accepted, none of them: {} not met.", unmet.join(", "));
        out.push_str(&colour.paint(Ink::Bad, &indented(&text)));
    }
    out
}

fn dimensions(
    before: &Candidate,
    after: &Candidate,
    snapped: &Snapped,
    request: &Request,
    colour: Colour,
) -> String {
    let mut grid = Grid::new(&[(Left, &[""]), (Right, &["before", "after", "change"]), (Left, &[""])]);
    let mut row = |name: &str, from: f64, to: f64, stock: bool, note: &str| {
        let shown = if stock { exact(to) } else { significant(to, DIGITS) };
        let change = to - from;
        let change = if change.abs() <= 1e-12 * from.abs().max(to.abs()) { 0.0 } else { change };
        let change = format!("{}{}", if change > 0.0 { "+" } else { "" }, significant(change, 3));
        let ink = if stock { Ink::Strong } else { Ink::Plain };
        grid.row([
            plain(name),
            plain(significant(from, DIGITS)),
            (shown, ink),
            plain(change),
            (note.to_owned(), Ink::Faint),
        ]);
    };
    let (from, to) = (&before.linkage, &after.linkage);
    for (length, value, was) in
        Length::all(to).into_iter().filter_map(|length| Some((length, length.of(*to)?, length.of(*from)?)))
    {
        let stock = snapped.lengths.contains(&length);
        let note = match request.fixed.get(length) {
            _ if stock => "stock",
            Some(_) => "as given",
            None => "",
        };
        // The ground follows from the pivots, up to rounding.
        let value = if stock { rounded(value) } else { value };
        row(&length.key(), was, value, stock, note);
    }
    for (name, was, is) in further_pivots(from, to) {
        for (axis, was, is) in [("x", was.re, is.re), ("y", was.im, is.im)] {
            row(&format!("{name}{axis}"), was, is, false, "");
        }
    }
    for (name, of) in PARAMETERS[..4].iter().chain(&PLACES_OF_SLIDERS) {
        if let (Some(from), Some(to)) = (of(from), of(to)) {
            row(name, from, to, false, "");
        }
    }
    if from.second_pivot().is_some() {
        let [was, is] = [from, to].map(|linkage| linkage.ground_angle().to_degrees());
        row("ground angle", was, is, false, "");
    }
    grid.render(colour)
}

/// Returns the fixed pivots beside A and B before and after, by name.
fn further_pivots(from: &CrankLinkage, to: &CrankLinkage) -> Vec<(&'static str, Complex, Complex)> {
    let pivots =
        |linkage: &CrankLinkage| linkage.multi_loop().map(MultiLoop::named_pivots).unwrap_or_default();
    let both = pivots(from).into_iter().zip(pivots(to)).skip(2);
    both.map(|((name, was), (_, is))| (name, was, is)).collect()
}

/// Returns a stock length without the last digits that were lost because it is stored as two pivots.
fn rounded(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// Returns the lengths that have a column beside the figures: where there are many, those in which the answers differ.
fn shown(snapped: &Snapped) -> Vec<Length> {
    const MOST: usize = 6;
    let differs = |length: &Length| {
        let mut values = snapped.candidates.iter().map(|c| length.of(c.linkage).map(rounded));
        let first = values.next();
        values.any(|value| Some(value) != first)
    };
    let few = snapped.lengths.len() <= MOST;
    snapped.lengths.iter().copied().filter(|length| few || differs(length)).take(MOST).collect()
}

fn figures(before: &Candidate, snapped: &Snapped, colour: Colour) -> String {
    let lengths = shown(snapped);
    let keys: Vec<String> = lengths.iter().map(|length| length.key()).collect();
    let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
    let has_angles = before.error.angle.is_some();
    let mut grid = Grid::new(&[
        (Left, &[""]),
        (
            Right,
            if has_angles {
                &["rms", "max", "angle rms", "angle max", "mu worst"]
            } else {
                &["rms", "max", "mu worst"]
            },
        ),
        (Left, &["accepted"]),
        (Right, &keys),
    ]);
    let mut row = |name: String, c: &Candidate, stock: bool| {
        let mut cells =
            vec![plain(name), plain(significant(c.error.rms, 4)), plain(significant(c.error.max, 4))];
        if has_angles {
            let angle = c.error.angle.as_ref().map_or([f64::NAN; 2], |angle| [angle.rms_deg, angle.max_deg]);
            cells.extend(angle.map(|degrees| plain(format!("{}°", significant(degrees, 4)))));
        }
        cells.extend([
            plain(format!("{}°", significant(c.transmission_deg.worst, 4))),
            verdict(if c.accepted { "yes" } else { "no" }, c.accepted),
        ]);
        for length in &lengths {
            let value = length.of(c.linkage).unwrap_or(f64::NAN);
            cells.push(plain(if stock { exact(rounded(value)) } else { significant(value, DIGITS) }));
        }
        grid.row(cells);
    };
    row("before".into(), before, false);
    for c in &snapped.candidates {
        row(format!("{}.", c.rank), c, true);
    }
    grid.render(colour)
}
