//! An analysis of a compound mechanism as text and as CSV.

use super::analysis_text::{DIGITS, input, reach, status_cell};
use super::csv::written;
use super::grid::Align::{Left, Right};
use super::grid::{Colour, Grid, Ink, plain};
use super::text::{COLUMNS, NO_NUMBER, clean, exact, indented, significant, wrapped};
use super::words::length_suffix;
use crate::mechanism::analysis::chain::{ChainAnalysis, ChainRow};

/// Returns the mechanism in words: stages, input range, the box of the traced path.
pub fn chain_head(analysis: &ChainAnalysis, colour: Colour) -> String {
    let unit = length_suffix(analysis.unit);
    let trace = clean(&analysis.trace);
    let stages = if analysis.stages == 1 { "stage follows" } else { "stages follow" };
    let mut words = format!("{} {stages} the crank.", analysis.stages);
    if analysis.input_turns_fully {
        words.push_str(" The crank turns fully.");
    } else if analysis.input_arcs_deg.is_empty() {
        words.push_str(" It closes at no crank angle.");
    } else {
        words.push_str(&format!(" The crank reaches {}.", reach(&analysis.input_arcs_deg)));
    }
    if let Some(stroke) = analysis.stroke {
        let along = |axis: usize| {
            let (low, high) = (stroke.low[axis], stroke.high[axis]);
            let [moves, from, to] = [high - low, low, high].map(|length| significant(length, 5));
            format!("{moves} (from {from} to {to})")
        };
        words.push_str(&format!(" Over a turn {trace} moves {} in x and {} in y{unit}.", along(0), along(1)));
    }
    format!("{}\n{}", colour.paint(Ink::Strong, &clean(&analysis.name)), indented(&words))
}

/// Returns the whole output of `analyze` for a chain: the head and the motion of the traced point.
pub fn chain_table(analysis: &ChainAnalysis, colour: Colour) -> String {
    let mut grid = Grid::new(&[(Right, &["crank", "x", "y", "vx", "vy", "ax", "ay"]), (Left, &["status"])]);
    for row in &analysis.rows {
        let point = row.points.iter().find(|p| p.name == analysis.trace);
        let pairs = point.map_or([None; 3], |p| [p.at, p.velocity, p.acceleration]);
        let shown = |pair: Option<[f64; 2]>| {
            pair.map_or([NO_NUMBER.to_owned(), NO_NUMBER.to_owned()], |xy| xy.map(|x| significant(x, DIGITS)))
        };
        let mut cells = vec![plain(significant(row.crank_deg, 6))];
        cells.extend(pairs.into_iter().flat_map(shown).map(plain));
        cells.push(status_cell(row.status, status(row)));
        grid.row(cells);
    }
    let note = format!(
        "Motion of {}; crank {}. Every point stands in the CSV and JSON.",
        clean(&analysis.trace),
        input(analysis.omega2_rad_s, analysis.alpha2_rad_s2)
    );
    format!(
        "{}\n{}{}",
        chain_head(analysis, colour),
        grid.render(colour),
        wrapped("\n  ", "  ", &note, COLUMNS)
    )
}

/// Returns `ok`, or the fault and the joint at which it occurs.
fn status(row: &ChainRow) -> String {
    match &row.joint {
        Some(joint) => format!("{} at {}", row.status.word(), clean(joint)),
        None => row.status.word().to_owned(),
    }
}

/// Returns one row for each crank angle: `crank_deg`, then x, y, vx, vy, ax, ay of every moving point, then `status`.
pub fn chain_csv(analysis: &ChainAnalysis) -> String {
    let names: Vec<String> =
        analysis.rows.first().map_or(Vec::new(), |row| row.points.iter().map(|p| p.name.clone()).collect());
    let mut head = vec!["crank_deg".to_owned()];
    for name in &names {
        let name = super::text::cell(name);
        head.extend(["x", "y"].map(|axis| format!("{name}{axis}")));
        head.extend(["vx", "vy", "ax", "ay"].map(|k| format!("{}{name}{}", &k[..1], &k[1..])));
    }
    head.push("status".to_owned());
    let rows = analysis.rows.iter().map(|row| {
        let mut cells = vec![exact(row.crank_deg)];
        for point in &row.points {
            for pair in [point.at, point.velocity, point.acceleration] {
                let xy = pair.map_or([String::new(), String::new()], |xy| xy.map(exact));
                cells.extend(xy);
            }
        }
        cells.push(status(row));
        cells
    });
    written(head, rows)
}
