//! The balance of a linkage as text: what to add, and what is left before and after.

use super::grid::Align::Right;
use super::grid::{Colour, Grid, Ink, plain};
use super::text::{COLUMNS, brief, clean, significant, wrapped};
use crate::mechanism::Unit;
use crate::mechanism::loads::balance::{MassBalance, SpringBalance, TorqueOver};
use crate::mechanism::loads::{Drive, Place, Spring};
use std::f64::consts::TAU;

/// Significant digits of what is to be bought and of what is left.
const FIGURES: usize = 4;

/// The part of the torque below which what is left is rounding.
const ROUNDING: f64 = 1e-10;

/// Returns the size of what is left of a whole; 0 for rounding.
fn even(value: f64, whole: f64) -> f64 {
    if value.abs() < ROUNDING * whole.abs() { 0.0 } else { value.abs() }
}

/// Returns the page of a balance by a spring; `range` are the crank angles, degrees.
pub fn spring_text(name: &str, unit: Unit, range: [f64; 2], found: &SpringBalance, colour: Colour) -> String {
    let title = format!("{}: a spring that lets it stay where it is put", clean(name));
    let mut out = colour.paint(Ink::Strong, &title);
    out.push('\n');
    out.push_str(&wrapped("  ", "  ", &spring(unit, range, found), COLUMNS));
    out.push('\n');
    let mut grid = Grid::new(&[(Right, &["", "peak torque", "at", "rms torque"])]);
    let row = |label: &str, torque: &TorqueOver| {
        let numbers = [
            format!("{} N m", significant(even(torque.peak.value, found.before.peak.value), FIGURES)),
            format!("{}°", brief(torque.peak.crank_deg, 5)),
            format!("{} N m", significant(even(torque.rms, found.before.rms), FIGURES)),
        ];
        std::iter::once(plain(label.to_owned())).chain(numbers.map(plain)).collect::<Vec<_>>()
    };
    grid.row(row("without", &found.before));
    grid.row(row("with", &found.after));
    out.push_str(&grid.render(colour));
    let left = format!(
        "Left: {} % of the peak and {} % of the rms torque, at rest; computed anew with the spring at 1,801 crank angles. \
         Friction, which is left out, holds the rest.",
        brief(even(found.residual_percent, 100.0), 3),
        brief(even(found.residual_rms_percent, 100.0), 3)
    );
    out.push('\n');
    out.push_str(&wrapped("  ", "  ", &left, COLUMNS));
    out
}

/// Returns a sentence on the spring: its ends, its rate, its free length, and what it does over the range.
fn spring(unit: Unit, [from, to]: [f64; 2], found: &SpringBalance) -> String {
    let length =
        |metres: f64| format!("{} {}", brief(metres / unit.factor_to(Unit::M), FIGURES), unit.label());
    let over = format!("over crank angles of {} to {}°", brief(from, 5), brief(to, 5));
    let [low, high] = found.span;
    match &found.spring {
        Spring::Extension { ends, rate, free_length } => {
            let [one, other] = ends.each_ref().map(|end| place(unit, end));
            let pushed = if low < *free_length * (1.0 - 1e-9) {
                " Watch for: where it is shorter than its free length it is pushed, which an extension spring cannot be."
            } else {
                ""
            };
            let zero = if *free_length == 0.0 {
                " A free length of 0 is that of a spring behind a pulley, or with that much preload: --least-free-length asks for \
                 another."
            } else {
                ""
            };
            format!(
                "From {one} to {other}: rate {} N/m, free length {}. {over} it is {} to {} long, with {} N at most.{pushed}{zero}",
                significant(*rate, FIGURES),
                length(*free_length),
                length(low),
                length(high),
                significant(found.largest, FIGURES),
                over = super::text::capitalised(&over),
            )
        }
        Spring::Torsion { bodies: [body, against], rate, free_angle } => format!(
            "Between {} and {}: rate {} N m/rad, free angle {}°. {over} its deflection is {} to {}°, with {} N m at most.",
            clean(body),
            clean(against),
            significant(*rate, FIGURES),
            brief(free_angle.to_degrees(), FIGURES),
            brief(low.to_degrees(), FIGURES),
            brief(high.to_degrees(), FIGURES),
            significant(found.largest, FIGURES),
            over = super::text::capitalised(&over),
        ),
    }
}

fn place(unit: Unit, place: &Place) -> String {
    let at = |[x, y]: [f64; 2]| {
        let [x, y] = [x, y].map(|x| brief(x / unit.factor_to(Unit::M), 5));
        format!("({x}, {y})")
    };
    match place {
        Place::Joint(name) => clean(name),
        Place::Fixed(point) => at(*point),
        Place::OnBody(body, point) => format!("{} of {}", at(*point), clean(body)),
    }
}

/// Returns the page of a balance by counter-masses.
pub fn masses_text(name: &str, unit: Unit, drive: &Drive, found: &MassBalance, colour: Colour) -> String {
    let rpm = |speed_rad_s: f64| brief(speed_rad_s * 60.0 / TAU, 5);
    let at = match drive.range() {
        Some(range) => format!("{} to {}", rpm(range.slowest_rad_s), rpm(range.fastest_rad_s)),
        None => rpm(drive.mean().speed_rad_s),
    };
    let title = format!("{}: counter-masses, at {at} rpm", clean(name));
    let mut out = colour.paint(Ink::Strong, &title);
    out.push('\n');
    let mut grid = Grid::new(&[(Right, &["body", "mass", "from its pivot", "direction from its line"])]);
    for mass in &found.masses {
        grid.row(vec![
            plain(clean(&mass.body)),
            plain(format!("{} kg", significant(mass.mass_kg, FIGURES))),
            plain(format!(
                "{} {}",
                significant(mass.distance_m / unit.factor_to(Unit::M), FIGURES),
                unit.label()
            )),
            plain(format!("{}°", brief(mass.direction_deg, 4))),
        ]);
    }
    out.push_str(&grid.render(colour));
    out.push('\n');
    let mut grid =
        Grid::new(&[(Right, &["", "peak torque", "torque ripple", "largest shaking force", "rms"])]);
    for (label, of) in [("without", &found.before), ("with", &found.after)] {
        let numbers = [
            (even(of.torque_peak, found.before.torque_peak), "N m"),
            (even(of.torque_ripple, found.before.torque_ripple), "N m"),
            (of.shaking_force, "N"),
            (of.shaking_force_rms, "N"),
        ];
        let cells = numbers.map(|(value, unit)| plain(format!("{} {unit}", significant(value, FIGURES))));
        grid.row(std::iter::once(plain(label.to_owned())).chain(cells));
    }
    out.push_str(&grid.render(colour));
    let left = format!(
        "Left: {} % of the torque's ripple (rms, less the mean) and {} % of the shaking force (rms, less the mean, which are the \
         weights); computed anew with the masses at 1,440 crank angles.",
        brief(even(found.ripple_percent, 100.0), 3),
        brief(even(found.shaking_percent, 100.0), 3)
    );
    out.push('\n');
    out.push_str(&wrapped("  ", "  ", &left, COLUMNS));
    out
}
