//! An analysis of a linkage of any kind as text and as CSV.

use super::analysis_text::{DIGITS, degrees, input, number, reach, status_cell};
use super::csv::written;
use super::grid::Align::{Left, Right};
use super::grid::{Colour, Grid, Ink, plain};
use super::loads;
use super::text::{COLUMNS, NO_NUMBER, capitalised, clean, exact, indented, plural, significant, wrapped};
use super::words::length_suffix;
use crate::mechanism::Linkage;
use crate::mechanism::analysis::driven::{LoopRecord, MechanismAnalysis, MechanismRow};
use crate::mechanism::four_bar::transmission::ForceTransmission;

/// Returns the mechanism in words: stages or kind, input range, mobility, the box of the traced path.
pub fn mechanism_head(analysis: &MechanismAnalysis, colour: Colour) -> String {
    let unit = length_suffix(analysis.unit);
    let trace = clean(&analysis.trace);
    let mut words = match (analysis.stages, analysis.kind) {
        (Some(1), _) => "1 stage follows the crank.".to_owned(),
        (Some(stages), _) => format!("{stages} stages follow the crank."),
        (None, kind) => format!("{}.", capitalised(&in_words(kind.unwrap_or_default()))),
    };
    if analysis.input_turns_fully {
        words.push_str(" The crank turns fully.");
    } else if analysis.input_arcs_deg.is_empty() {
        words.push_str(" It closes at no crank angle.");
    } else {
        words.push_str(&format!(" The crank reaches {}.", reach(&analysis.input_arcs_deg)));
    }
    if let Some(mobility) = &analysis.mobility {
        words.push_str(&mobility_words(mobility, analysis.input_turns_fully, &unit));
    }
    if let Some(stroke) = analysis.stroke {
        let along = |axis: usize| {
            let (low, high) = (stroke.low[axis], stroke.high[axis]);
            let [moves, from, to] = [high - low, low, high].map(|length| significant(length, 5));
            format!("{moves} (from {from} to {to})")
        };
        words.push_str(&format!(" Over a turn {trace} moves {} in x and {} in y{unit}.", along(0), along(1)));
    }
    let of_loads = loads_words(analysis);
    format!("{}\n{}{of_loads}", colour.paint(Ink::Strong, &clean(&analysis.name)), indented(&words))
}

/// Returns the figures of loads after a line feed; nothing without loads.
fn loads_words(analysis: &MechanismAnalysis) -> String {
    let words = |record| format!("\n{}", loads::words(record, analysis.drive.mean()));
    analysis.loads.as_ref().map_or_else(String::new, words)
}

/// Returns a kind of file as words: `inverted slider-crank`.
pub(super) fn in_words(kind: &str) -> String {
    kind.replace("inverted-", "inverted ")
}

/// Returns circuits and branches, toggles, transmission angle and the slider's range as sentences, each after a blank.
fn mobility_words(mobility: &LoopRecord, turns_fully: bool, unit: &str) -> String {
    let mut words = String::new();
    if !mobility.toggles_deg.is_empty() {
        let ends: Vec<String> = mobility.toggles_deg.iter().map(|t| degrees(*t)).collect();
        words.push_str(&format!(" Its toggles are at {}.", ends.join(", ")));
    }
    if mobility.circuits > 0 {
        let branches = match mobility.branches_per_circuit {
            1 => "1 branch".to_owned(),
            n => format!("{n} branches"),
        };
        let circuits = plural(mobility.circuits.into(), "circuit");
        words.push_str(&format!(" {}, {branches} in each.", capitalised(&circuits)));
    }
    if let (Some([least, greatest]), Some(worst)) =
        (mobility.transmission_deg, mobility.worst_transmission_deg)
    {
        let [least, greatest] = [least, greatest].map(degrees);
        words.push_str(&format!(" Transmission angle {least} to {greatest}"));
        words.push_str(&match turns_fully {
            true => format!(": {}.", ForceTransmission::of(worst).words()),
            false => ": at a toggle the crank can no longer push the slider.".to_owned(),
        });
    }
    if let Some([low, high]) = mobility.slider_range {
        let [moves, from, to] = [high - low, low, high].map(|length| significant(length, 5));
        words.push_str(&format!(" The slider moves {moves} (from {from} to {to}){unit}."));
    }
    words
}

/// Returns the dimensions of a linkage with a slider in its letters; nothing for other kinds.
pub(super) fn dimensions(linkage: &Linkage) -> String {
    let n = |x: f64| significant(x, 6);
    let pair = |[x, y]: [f64; 2]| format!("({}, {})", n(x), n(y));
    match linkage {
        Linkage::SliderCrank(linkage) => {
            let p = linkage.parameters();
            format!(
                "A {}, a {}, b {}, line {} at {}°, coupler point {}, t1 {:+}",
                pair(p.crank_pivot),
                n(p.crank),
                n(p.coupler),
                pair(p.line_point),
                n(p.line_deg),
                pair([p.coupler_x, p.coupler_y]),
                p.assembly.sign()
            )
        }
        Linkage::InvertedSliderCrank(linkage) => {
            let p = linkage.parameters();
            format!(
                "A {}, B {}, a {}, offset {}, coupler point {}, t1 {:+}",
                pair(p.crank_pivot),
                pair(p.block_pivot),
                n(p.crank),
                n(p.offset),
                pair([p.coupler_x, p.coupler_y]),
                p.assembly.sign()
            )
        }
        Linkage::FourBar(_) | Linkage::MultiLoop(_) | Linkage::Chain(_) => String::new(),
    }
}

/// Returns the whole output of `analyze` for a linkage of any kind: the head, the motion of the traced point, and that of
/// coupler and slider.
pub fn mechanism_table(analysis: &MechanismAnalysis, colour: Colour) -> String {
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
        input(&analysis.drive)
    );
    let of_loads = analysis.loads.as_ref().map_or_else(String::new, |record| {
        let rows: Vec<_> = analysis.rows.iter().map(|row| (row.crank_deg, row.loads.as_deref())).collect();
        loads::table(record, &rows, colour)
    });
    format!(
        "{}\n{}{}{}{of_loads}",
        mechanism_head(analysis, colour),
        grid.render(colour),
        wrapped("\n  ", "  ", &note, COLUMNS),
        coupler_table(analysis, colour)
    )
}

/// Returns the table of coupler and slider below the other; nothing for chains.
fn coupler_table(analysis: &MechanismAnalysis, colour: Colour) -> String {
    if analysis.rows.iter().all(|row| row.coupler.is_none()) {
        return String::new();
    }
    let heads = ["crank", "theta3", "mu", "omega3", "alpha3", "slider", "speed", "accel."];
    let mut grid = Grid::new(&[(Right, &heads)]);
    let mut sizes = [0.0_f64; 7];
    for row in &analysis.rows {
        for (size, (_, value)) in sizes.iter_mut().zip(coupler_cells(row)) {
            *size = size.max(value.map_or(0.0, f64::abs));
        }
    }
    for row in &analysis.rows {
        let mut cells = vec![plain(significant(row.crank_deg, 6))];
        cells.extend(coupler_cells(row).into_iter().zip(sizes).map(|((_, value), size)| number(value, size)));
        grid.row(cells);
    }
    format!("\n{}", grid.render(colour))
}

/// Returns the columns of coupler and slider with their names in the CSV.
fn coupler_cells(row: &MechanismRow) -> [(&'static str, Option<f64>); 7] {
    let of = |value: fn(&crate::mechanism::analysis::driven::CouplerRow) -> Option<f64>| {
        row.coupler.as_ref().and_then(value)
    };
    [
        ("coupler_deg", of(|c| c.coupler_deg)),
        ("transmission_deg", of(|c| c.transmission_deg)),
        ("omega3_rad_s", of(|c| c.omega3_rad_s)),
        ("alpha3_rad_s2", of(|c| c.alpha3_rad_s2)),
        ("slider", of(|c| c.slider)),
        ("slider_speed", of(|c| c.slider_speed)),
        ("slider_acceleration", of(|c| c.slider_acceleration)),
    ]
}

/// Returns `ok`, or the fault and the joint at which it occurs.
fn status(row: &MechanismRow) -> String {
    match &row.joint {
        Some(joint) => format!("{} at {}", row.status.word(), clean(joint)),
        None => row.status.word().to_owned(),
    }
}

/// Returns one row for each crank angle: `crank_deg`, then x, y, vx, vy, ax, ay of every moving point, then coupler and
/// slider of kinds that have one, then the columns of loads if there are any (below a comment), then `status`.
pub fn mechanism_csv(analysis: &MechanismAnalysis) -> String {
    let names: Vec<String> =
        analysis.rows.first().map_or(Vec::new(), |row| row.points.iter().map(|p| p.name.clone()).collect());
    let mut head = vec!["crank_deg".to_owned()];
    for name in &names {
        let name = super::text::cell(name);
        head.extend(["x", "y"].map(|axis| format!("{name}{axis}")));
        head.extend(["vx", "vy", "ax", "ay"].map(|k| format!("{}{name}{}", &k[..1], &k[1..])));
    }
    let has_coupler = |row: &&MechanismRow| row.coupler.is_some();
    if let Some(row) = analysis.rows.first().filter(has_coupler) {
        head.extend(coupler_cells(row).map(|(name, _)| name.to_owned()));
    }
    head.extend(analysis.loads.iter().flat_map(loads::columns));
    head.push("status".to_owned());
    let comment = analysis.loads.as_ref().map_or_else(String::new, loads::comment);
    let rows = analysis.rows.iter().map(|row| {
        let mut cells = vec![exact(row.crank_deg)];
        for point in &row.points {
            for pair in [point.at, point.velocity, point.acceleration] {
                let xy = pair.map_or([String::new(), String::new()], |xy| xy.map(exact));
                cells.extend(xy);
            }
        }
        if has_coupler(&row) {
            cells.extend(coupler_cells(row).map(|(_, value)| value.map_or(String::new(), exact)));
        }
        cells.extend(analysis.loads.iter().flat_map(|record| loads::cells(record, row.loads.as_deref())));
        cells.push(status(row));
        cells
    });
    comment + &written(head, rows)
}
