//! Tables for spreadsheets and scripts. Every number is the shortest text that reads back as the same double; a cell
//! without a number is empty.

use super::scene::first_position;
use super::text::{cell, exact, push_exact};
use super::words;
use crate::mechanism::four_bar::transmission::angle_opposite;
use crate::mechanism::{CouplerCurve, FourBar};
use crate::record::{Candidate, Record};
use crate::task::Defect;

/// The header row of [`candidates_csv`].
pub const CANDIDATE_COLUMNS: [&str; 32] = [
    "rank",
    "accepted",
    "sum_sq",
    "rms",
    "max",
    "max_at",
    "rms_over_size",
    "to_curve_sum_sq",
    "to_curve_rms",
    "to_curve_max",
    "objective",
    "type",
    "grashof_margin",
    "transmission_min_deg",
    "transmission_max_deg",
    "transmission_worst_deg",
    "transmission_over",
    "link_ratio",
    "ground",
    "Ax",
    "Ay",
    "Bx",
    "By",
    "a",
    "b",
    "c",
    "d",
    "e",
    "t1",
    "t2",
    "defects",
    "unmet",
];

/// The header row of [`curve_csv`].
pub const CURVE_COLUMNS: [&str; 9] =
    ["crank_deg", "t1", "Cx", "Cy", "Dx", "Dy", "Px", "Py", "transmission_deg"];

/// Returns one row for each candidate: every parameter and figure, defects as `order:3 7;branch:2` (points from 0), and
/// the names of the requirements that are not met.
pub fn candidates_csv(record: &Record) -> String {
    written(&CANDIDATE_COLUMNS, record.candidates.iter().map(|candidate| row(record, candidate)))
}

fn row(record: &Record, candidate: &Candidate) -> Vec<String> {
    let error = &candidate.error;
    let transmission = &candidate.transmission_deg;
    let defects: Vec<String> = candidate.defects.iter().map(defect).collect();
    let unmet: Vec<String> = words::unmet(record, candidate);
    let mut cells = vec![
        candidate.rank.to_string(),
        candidate.accepted.to_string(),
        exact(error.sum_sq),
        exact(error.rms),
        exact(error.max),
        error.max_at.to_string(),
        exact(error.rms_over_size),
        exact(error.to_curve.sum_sq),
        exact(error.to_curve.rms),
        exact(error.to_curve.max),
        exact(error.objective),
        candidate.linkage_type.name().to_owned(),
        exact(candidate.grashof_margin),
        exact(transmission.min),
        exact(transmission.max),
        exact(transmission.worst),
        words::over(transmission.over).to_owned(),
        exact(candidate.link_ratio),
        exact(candidate.linkage.ground()),
    ];
    cells.extend(parameters(&candidate.linkage));
    cells.extend([defects.join(";"), cell(&unmet.join(";"))]);
    cells
}

/// Returns Ax Ay Bx By a b c d e t1 t2.
pub(super) fn parameters(linkage: &FourBar) -> [String; 11] {
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    [
        exact(a.re),
        exact(a.im),
        exact(b.re),
        exact(b.im),
        exact(linkage.crank()),
        exact(linkage.coupler()),
        exact(linkage.follower()),
        exact(linkage.crank_side()),
        exact(linkage.follower_side()),
        exact(linkage.assembly().sign()),
        exact(linkage.side().sign()),
    ]
}

fn defect(defect: &Defect) -> String {
    let at: Vec<String> = defect.at().iter().map(usize::to_string).collect();
    format!("{}:{}", defect.name(), at.join(" "))
}

/// Returns the coupler curve of the circuit of `record.candidates[index]`: if the input turns fully, one row for each
/// degree of the crank from 0 to 359; if it rocks, 720 rows there and back (evenly spaced in the circuit's parameter).
/// Positions at which the loop is open are left out; without such a candidate there is only the header row.
pub fn curve_csv(record: &Record, index: usize) -> String {
    record.candidates.get(index).map_or_else(|| written(&CURVE_COLUMNS, []), candidate_curve_csv)
}

/// Returns the curve as [`curve_csv`] does, for a candidate that need not be in a record.
pub fn candidate_curve_csv(candidate: &Candidate) -> String {
    // There are only numbers, which need no quotes.
    let mut text = CURVE_COLUMNS.join(",");
    text.push('\n');
    for row in curve(candidate) {
        for number in row {
            push_exact(&mut text, number);
            text.push(',');
        }
        text.pop();
        text.push('\n');
    }
    text
}

fn curve(candidate: &Candidate) -> Vec<[f64; CURVE_COLUMNS.len()]> {
    let linkage = &candidate.linkage;
    let (angle, assembly) = first_position(candidate);
    let mobility = linkage.mobility();
    let rocks = mobility.arc(mobility.branch(angle, assembly).circuit).is_some();
    let circuit = CouplerCurve::through(linkage, angle, assembly, 8);
    let rows = if rocks { 720 } else { 360 };
    let mut table = Vec::with_capacity(rows);
    for i in 0..rows {
        let parameter_deg = i as f64 * 360.0 / rows as f64;
        let (angle, assembly) = circuit.position_at(parameter_deg.to_radians());
        let Some(joints) = linkage.position_with(angle, assembly).joints() else { continue };
        let transmission = angle_opposite(linkage.diagonal(angle), linkage.coupler(), linkage.follower());
        let numbers = [
            if rocks { angle.to_degrees() } else { parameter_deg },
            assembly.sign(),
            joints.crank_pin.re,
            joints.crank_pin.im,
            joints.follower_pin.re,
            joints.follower_pin.im,
            joints.coupler_point.re,
            joints.coupler_point.im,
            transmission.to_degrees(),
        ];
        if numbers.iter().all(|x| x.is_finite()) {
            table.push(numbers);
        }
    }
    table
}

/// Returns the header row and the rows as CSV with line feeds.
pub(crate) fn written(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    // Writing to memory does not fail; if it did, the text so far is returned.
    let mut good = writer.write_record(head).is_ok();
    for row in rows {
        good = good && writer.write_record(&row).is_ok();
    }
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8(bytes).unwrap_or_default()
}
