//! An analysis of a compound mechanism as text and as CSV.

use super::csv::written;
use super::grid::{Align, Colour, Grid, Ink};
use super::text::{clean, exact, significant, wrapped};
use crate::mechanism::analysis::Status;
use crate::mechanism::analysis::chain::{ChainAnalysis, ChainRow};

const COLUMNS: usize = 100;
const DIGITS: usize = 7;

/// Returns the mechanism in words: stages, input range, the box of the traced path.
pub fn chain_head(analysis: &ChainAnalysis, colour: Colour) -> String {
    let unit = analysis.unit.map_or(String::new(), |u| format!(" {}", u.label()));
    let trace = clean(&analysis.trace);
    let stages = if analysis.stages == 1 { "stage follows" } else { "stages follow" };
    let mut words = format!("{} {stages} the crank.", analysis.stages);
    if analysis.input_turns_fully {
        words.push_str(" The crank turns fully.");
    } else if analysis.input_arcs_deg.is_empty() {
        words.push_str(" It closes at no crank angle.");
    } else {
        let arcs = analysis.input_arcs_deg.iter();
        let arcs: Vec<String> = arcs
            .map(|[from, to]| format!("{}° to {}°", significant(*from, 6), significant(*to, 6)))
            .collect();
        words.push_str(&format!(" The crank reaches {}.", arcs.join(" or ")));
    }
    if let Some(stroke) = analysis.stroke {
        let along = |axis: usize| {
            let (low, high) = (stroke.low[axis], stroke.high[axis]);
            format!(
                "{} (from {} to {})",
                significant(high - low, 5),
                significant(low, 5),
                significant(high, 5)
            )
        };
        words.push_str(&format!(" Over a turn {trace} moves {} in x and {} in y{unit}.", along(0), along(1)));
    }
    format!("{}\n{}", colour.paint(Ink::Strong, &clean(&analysis.name)), wrapped("  ", "  ", &words, COLUMNS))
}

/// Returns the whole output of `analyze` for a chain: the head and the motion of the traced point.
pub fn chain_table(analysis: &ChainAnalysis, colour: Colour) -> String {
    use Align::{Left, Right};
    let mut grid = Grid::new(&[
        ("crank", Right),
        ("x", Right),
        ("y", Right),
        ("vx", Right),
        ("vy", Right),
        ("ax", Right),
        ("ay", Right),
        ("status", Left),
    ]);
    for row in &analysis.rows {
        let point = row.points.iter().find(|p| p.name == analysis.trace);
        let mut cells = vec![(significant(row.crank_deg, 6), Ink::Plain)];
        let pairs = point.map_or([None; 3], |p| [p.at, p.velocity, p.acceleration]);
        for pair in pairs {
            for axis in 0..2 {
                let text = pair.map_or_else(|| "-".to_owned(), |xy| significant(xy[axis], DIGITS));
                cells.push((text, Ink::Plain));
            }
        }
        let ink = if row.status == Status::Ok { Ink::Faint } else { Ink::Bad };
        cells.push((status(row), ink));
        grid.row(cells);
    }
    let note = format!(
        "Motion of {}; crank speed {} rad/s, acceleration {} rad/s2. Every point stands in the CSV and JSON.",
        clean(&analysis.trace),
        significant(analysis.omega2_rad_s, DIGITS),
        significant(analysis.alpha2_rad_s2, DIGITS)
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
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
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
    written(&head, rows)
}
