//! An analysis as text: the mobility in words, and the tables of positions, motion and methods.

use super::analysis_csv::{POSE, RATES};
use super::csv::{Column, names};
use super::grid::Align::{Left, Right};
use super::grid::{Cell, Colour, Grid, Ink, plain};
use super::loads;
use super::text::{COLUMNS, NO_NUMBER, capitalised, clean, indented, plural, significant, wrapped};
use super::words::length_suffix;
use crate::mechanism::Unit;
use crate::mechanism::analysis::{
    Analysis, ConditionRecord, Configuration, MethodRow, MobilityRecord, Pose, Rates, Row, Status,
};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::four_bar::transmission::ForceTransmission;
use crate::mechanism::loads::Drive;
use crate::mechanism::{FourBar, LinkageType};

/// The number of significant digits of lengths and rates.
pub(super) const DIGITS: usize = 7;

/// Returns the linkage and its mobility in words.
pub fn analysis_head(analysis: &Analysis, colour: Colour) -> String {
    let mut out = format!("{}\n", colour.paint(Ink::Strong, &clean(&analysis.name)));
    if let Some(first) = analysis.configurations.first() {
        out.push_str(&linkage_line(&first.linkage, analysis.unit));
        out.push_str(&mobility_words(&analysis.mobility, analysis.unit));
    }
    if let Some(record) = &analysis.loads {
        out.push_str(&format!("\n{}", loads::words(record, analysis.drive.mean())));
    }
    out
}

/// Returns the whole output of `analyze`.
pub fn analysis_table(analysis: &Analysis, colour: Colour) -> String {
    let mut out = analysis_head(analysis, colour);
    for configuration in &analysis.configurations {
        let linkage = &configuration.linkage;
        let [t1, t2] = [linkage.assembly().sign(), linkage.side().sign()];
        let [d, p] = [t1, t2].map(|sign| if sign > 0.0 { "left" } else { "right" });
        let signs = format!("\n  t1 = {t1:+}, t2 = {t2:+} (D {d} of C-B, P {p} of C-D)\n");
        out.push_str(&colour.paint(Ink::Strong, &signs));
        out.push_str(&positions(configuration, colour));
        if analysis.omega2_rad_s != 0.0 || analysis.alpha2_rad_s2 != 0.0 {
            for columns in &RATES {
                out.push('\n');
                out.push_str(&rates(configuration, colour, columns));
            }
        }
        if let Some(record) = &analysis.loads {
            let rows: Vec<_> =
                configuration.rows.iter().map(|row| (row.crank_deg, row.loads.as_deref())).collect();
            out.push_str(&loads::table(record, &rows, colour));
        }
        out.push_str(&methods(configuration, colour));
        out.push_str(&conditions(configuration));
    }
    let unit = analysis.unit.map_or("the file's unit".to_owned(), |u| u.label().to_owned());
    out.push_str(&wrapped(
        "\n  ",
        "  ",
        &format!(
            "Crank {}. Angles in degrees from the x axis, \
             counter-clockwise; lengths in {unit}. status: ok; singular: a toggle, velocities are not decided by \
             the crank; open: the loop does not close; undetermined: C lies on B.",
            input(&analysis.drive),
        ),
        COLUMNS,
    ));
    out
}

fn linkage_line(linkage: &FourBar, unit: Option<Unit>) -> String {
    let [ax, ay, bx, by, a, b, c, d, e] =
        linkage.natural_coordinates().numbers().map(|number| significant(number, 6));
    let (ground, unit) = (significant(linkage.ground(), 6), length_suffix(unit));
    indented(&format!(
        "A ({ax}, {ay}), B ({bx}, {by}), ground {ground}, a {a}, b {b}, c {c}, d {d}, e {e}{unit}"
    ))
}

/// Returns the mobility of a linkage in words: type, margin, input range, toggles, circuits and branches, transmission,
/// warnings.
pub fn mobility_words(mobility: &MobilityRecord, unit: Option<Unit>) -> String {
    let apart = "These links cannot be joined: the longest is longer than the other three together.";
    let Some(kind) = mobility.linkage_type else { return indented(apart) };
    let unit = length_suffix(unit);
    let of_type = match kind {
        LinkageType::CrankRocker => "the crank turns fully, the follower rocks",
        LinkageType::RockerCrank => "the driven link rocks, the follower turns fully",
        LinkageType::DoubleCrank => "crank and follower both turn fully",
        LinkageType::DoubleRocker => "crank and follower rock, the coupler turns fully",
        LinkageType::TripleRocker => "no link turns fully",
        LinkageType::ChangePoint => "it can lie flat, and there the next position is not decided",
    };
    let mut words = format!(
        "{}: {of_type} (Grashof margin p + q - s - l = {}{unit}).",
        capitalised(kind.name()),
        significant(mobility.grashof_margin, 5)
    );
    if mobility.input_turns_fully {
        words.push_str(" The crank reaches every angle.");
    } else if !mobility.input_arcs_deg.is_empty() {
        let ends: Vec<String> = mobility.toggles_deg.iter().map(|t| degrees(*t)).collect();
        words.push_str(&format!(
            " The crank reaches {}; toggles, with coupler and follower in line, at {}.",
            reach(&mobility.input_arcs_deg),
            ends.join(", ")
        ));
    }
    let circuits = plural(mobility.circuits.into(), "circuit");
    let branches = match mobility.branches_per_circuit {
        1 => "1 branch".to_owned(),
        n => format!("{n} branches"),
    };
    words.push_str(&format!(" {circuits}, {branches} in each."));
    if let (Some([least, greatest]), Some(worst)) =
        (mobility.transmission_deg, mobility.worst_transmission_deg)
    {
        words.push_str(&format!(
            " Transmission angle {} to {}, at its worst {} from a toggle.",
            degrees(least),
            degrees(greatest),
            degrees(worst)
        ));
        let force = ForceTransmission::of(worst);
        let danger = match mobility.input_turns_fully {
            true => force.words(),
            false => {
                "at a toggle the crank can no longer push the follower; stop short of it or drive the follower"
            }
        };
        if force < ForceTransmission::Fair {
            words.push_str(&format!(" Watch for: {danger}."));
        }
    }
    if let Some(ratio) = mobility.link_ratio {
        words.push_str(&format!(" Longest over shortest link: {}.", significant(ratio, 4)));
    } else {
        words.push_str(" The two fixed pivots coincide.");
    }
    indented(&words)
}

/// Returns an angle in degrees with its sign of degrees.
pub(super) fn degrees(value: f64) -> String {
    format!("{}°", significant(value, 6))
}

/// Returns the ranges of the input: `30° to 60° or 90° to 120°`.
pub(super) fn reach(arcs_deg: &[[f64; 2]]) -> String {
    let arcs = arcs_deg.iter().map(|[from, to]| format!("{} to {}", degrees(*from), degrees(*to)));
    arcs.collect::<Vec<_>>().join(" or ")
}

/// Returns the input's motion: `speed 1.000000 rad/s, acceleration 0 rad/s2`.
pub(super) fn input(drive: &Drive) -> String {
    let n = |rate: f64| significant(rate, DIGITS);
    match (drive.range(), drive.mean()) {
        (Some(range), mean) => format!(
            "speed {} to {} rad/s over the turn, {} rad/s on average over time",
            n(range.slowest_rad_s),
            n(range.fastest_rad_s),
            n(mean.speed_rad_s)
        ),
        (None, CrankMotion { speed_rad_s, acceleration_rad_s2 }) => {
            format!("speed {} rad/s, acceleration {} rad/s2", n(speed_rad_s), n(acceleration_rad_s2))
        }
    }
}

/// Returns a number shown beside others of the given size; a number that is only rounding in comparison is shown as 0.
pub(super) fn number(value: Option<f64>, size: f64) -> Cell {
    let shown = |v: f64| if v.abs() <= ROUNDING * size { 0.0 } else { v };
    plain(value.map_or_else(|| NO_NUMBER.to_owned(), |v| significant(shown(v), DIGITS)))
}

/// The fraction of its neighbours below which a number is rounding: the table shows 0, CSV and JSON all digits.
const ROUNDING: f64 = 1e-14;

/// Returns the cell of a row's status, with more words on it if there are any.
pub(super) fn status_cell(status: Status, words: String) -> Cell {
    (words, if status == Status::Ok { Ink::Faint } else { Ink::Bad })
}

fn status(row: &Row) -> Cell {
    status_cell(row.status, row.status.word().to_owned())
}

fn positions(configuration: &Configuration, colour: Colour) -> String {
    let (points, angles) = POSE.split_at(6);
    let heads: Vec<&str> = names(points).collect();
    let mut grid =
        Grid::new(&[(Right, &["crank", "theta3", "theta4", "mu"]), (Right, &heads), (Left, &["status"])]);
    for row in &configuration.rows {
        let p = row.pose.as_ref();
        let size = points.iter().filter_map(|(_, of)| Some(of(p?).abs())).fold(0.0, f64::max);
        let angle = |of: fn(&Pose) -> f64| plain(p.map_or(NO_NUMBER.to_owned(), |p| significant(of(p), 6)));
        let mut cells = vec![plain(significant(row.crank_deg, 6))];
        cells.extend(angles.iter().map(|(_, of)| angle(*of)));
        cells.extend(points.iter().map(|(_, of)| number(p.map(of), size)));
        cells.push(status(row));
        grid.row(cells);
    }
    grid.render(colour)
}

/// Returns the table of velocities or of accelerations.
fn rates(configuration: &Configuration, colour: Colour, columns: &[Column<Rates, f64>]) -> String {
    // The names without their units.
    let heads: Vec<&str> = names(columns).map(|name| name.split('_').next().unwrap_or(name)).collect();
    let mut grid = Grid::new(&[(Right, &["crank"]), (Right, &heads)]);
    for row in &configuration.rows {
        let mut cells = vec![plain(significant(row.crank_deg, 6))];
        // The first two columns belong to the links, the others to the points.
        let (links, points) = columns.split_at(2);
        for group in [links, points] {
            let values = group.iter().map(|(_, of)| row.rates.as_ref().map(of));
            let size = values.clone().flatten().map(f64::abs).fold(0.0, f64::max);
            cells.extend(values.map(|value| number(value, size)));
        }
        grid.row(cells);
    }
    grid.render(colour)
}

fn methods(configuration: &Configuration, colour: Colour) -> String {
    if configuration.rows.iter().all(|row| row.methods.is_empty()) {
        return String::new();
    }
    let rows: Vec<(f64, &MethodRow)> =
        configuration.rows.iter().flat_map(|row| row.methods.iter().map(|m| (row.crank_deg, m))).collect();
    let or_none = |text: Option<String>| plain(text.unwrap_or(NO_NUMBER.to_owned()));
    let grid = Grid::of(
        &rows,
        &[
            (Right, "crank", &|(crank_deg, _)| plain(significant(*crank_deg, 6))),
            (Left, "method", &|(_, m)| plain(m.method.name())),
            (Right, "t1", &|(_, m)| or_none(m.t1.map(|t| format!("{:+}", t.sign())))),
            (Right, "theta3", &|(_, m)| number(m.coupler_deg, 0.0)),
            (Right, "theta4", &|(_, m)| number(m.follower_deg, 0.0)),
            (Right, "Px", &|(_, m)| number(m.coupler_point.map(|p| p[0]), 0.0)),
            (Right, "Py", &|(_, m)| number(m.coupler_point.map(|p| p[1]), 0.0)),
            (Right, "off", &|(_, m)| or_none(m.from_natural.map(|d| format!("{d:.1e}")))),
            (Right, "rounds", &|(_, m)| plain(m.iterations.map_or(String::new(), |n| n.to_string()))),
            (Left, "status", &|(_, m)| {
                (m.status.to_owned(), if m.status == "ok" { Ink::Faint } else { Ink::Bad })
            }),
        ],
    );
    format!(
        "\n  Other methods; off: distance of their P from that of the natural coordinates\n{}",
        grid.render(colour)
    )
}

/// Returns Romero's condition (20) beside a sufficient condition: at the rows without a position, otherwise at the row
/// at which it is nearest to failing.
fn conditions(configuration: &Configuration) -> String {
    let rows: Vec<(&Row, ConditionRecord)> =
        configuration.rows.iter().filter_map(|row| Some((row, row.assembly?))).collect();
    let line = |(row, condition): &(&Row, ConditionRecord)| {
        let ratio = condition.ratio.map_or("undefined".to_owned(), |r| significant(r, 5));
        let word = |holds| if holds { "holds" } else { "fails" };
        format!(
            "at {}°: condition (20), (b^2 + d^2)/(l1^2 + l2^2) = {ratio} >= 1, {}; b^2 >= l1^2 and d^2 >= l2^2: {}",
            significant(row.crank_deg, 6),
            word(condition.necessary),
            word(condition.sufficient)
        )
    };
    let ratio = |(_, condition): &(&Row, ConditionRecord)| condition.ratio.unwrap_or(f64::INFINITY);
    let mut shown: Vec<String> =
        rows.iter().filter(|(row, _)| row.pose.is_none()).take(6).map(line).collect();
    if shown.is_empty() {
        let Some(least) = rows.iter().min_by(|x, y| ratio(x).total_cmp(&ratio(y))) else {
            return String::new();
        };
        shown.push(line(least));
    }
    let text = format!("Assembly (Romero's condition is necessary, not sufficient): {}.", shown.join("; "));
    wrapped("\n  ", "  ", &text, COLUMNS)
}
