//! Tables for spreadsheets and scripts. Every number is the shortest text that reads back as the same double; a cell
//! without a number is empty.

use super::body;
use super::scene::first_position;
use super::text::{cell, exact, push_exact};
use super::words;
use crate::mechanism::multi_loop::LinkPair;
use crate::mechanism::{Complex, CouplerCurve, CrankLinkage, FourBar, Joints, LoopJoints, point};
use crate::record::{Candidate, Member, Record};
use crate::task::{Defect, TaskKind};

/// A column of a table: its name, and the value of a row in it.
pub(super) type Column<Row, Value = String> = (&'static str, fn(&Row) -> Value);

/// The figures of a candidate, in the order of the table of candidates.
const FIGURES: [Column<Candidate>; 19] = [
    ("rank", |c| c.rank.to_string()),
    ("accepted", |c| c.accepted.to_string()),
    ("sum_sq", |c| exact(c.error.sum_sq)),
    ("rms", |c| exact(c.error.rms)),
    ("max", |c| exact(c.error.max)),
    ("max_at", |c| c.error.max_at.to_string()),
    ("rms_over_size", |c| exact(c.error.rms_over_size)),
    ("to_curve_sum_sq", |c| exact(c.error.to_curve.sum_sq)),
    ("to_curve_rms", |c| exact(c.error.to_curve.rms)),
    ("to_curve_max", |c| exact(c.error.to_curve.max)),
    ("objective", |c| exact(c.error.objective)),
    ("type", |c| c.type_name().to_owned()),
    ("grashof_margin", |c| exact(c.grashof_margin)),
    ("transmission_min_deg", |c| exact(c.transmission_deg.min)),
    ("transmission_max_deg", |c| exact(c.transmission_deg.max)),
    ("transmission_worst_deg", |c| exact(c.transmission_deg.worst)),
    ("transmission_over", |c| words::over(c.transmission_deg.over).to_owned()),
    ("link_ratio", |c| exact(c.link_ratio)),
    ("ground", |c| c.linkage.ground().map_or(String::new(), exact)),
];

/// The figures that a candidate of a motion has beside those.
pub(super) const OF_MOTION: [Column<Candidate>; 4] = [
    ("frame_deg", |c| c.frame_deg.map_or(String::new(), exact)),
    ("angle_rms_deg", |c| c.error.angle.map_or(String::new(), |angle| exact(angle.rms_deg))),
    ("angle_max_deg", |c| c.error.angle.map_or(String::new(), |angle| exact(angle.max_deg))),
    ("angle_max_at", |c| c.error.angle.map_or(String::new(), |angle| angle.max_at.to_string())),
];

/// The figures that a candidate of a function has beside those.
pub(super) const OF_FUNCTION: [Column<Candidate>; 3] = [
    ("input_offset_deg", |c| c.input_offset_deg.map_or(String::new(), exact)),
    ("output_offset_deg", |c| c.output_offset_deg.map_or(String::new(), exact)),
    ("sense", |c| c.sense.map_or(String::new(), |sense| words::sense(sense).to_owned())),
];

/// As [`OF_FUNCTION`], of one of a slider's places.
const OF_PLACES: [Column<Candidate>; 3] =
    [OF_FUNCTION[0], ("output_offset", |c| c.output_offset.map_or(String::new(), exact)), OF_FUNCTION[2]];

/// As [`OF_FUNCTION`], of one with a free range.
pub(super) const OF_FREE_RANGES: [Column<Candidate>; 5] = [
    OF_FUNCTION[0],
    OF_FUNCTION[1],
    ("input_range_deg", |c| c.input_range_deg.map_or(String::new(), exact)),
    ("output_range_deg", |c| c.output_range_deg.map_or(String::new(), exact)),
    OF_FUNCTION[2],
];

/// The figures that a candidate has beside those in a problem with loads.
const OF_LOADS: [Column<Candidate>; 1] =
    [("peak_torque_N_m", |c| c.peak_torque.map_or(String::new(), exact))];

/// The parameters of a linkage: coordinates, lengths and signs.
pub(super) const PARAMETERS: [Parameter; 11] = [
    ("Ax", |l| Some(l.crank_pivot().re)),
    ("Ay", |l| Some(l.crank_pivot().im)),
    ("Bx", |l| Some(l.second_pivot()?.re)),
    ("By", |l| Some(l.second_pivot()?.im)),
    ("a", |l| Some(l.crank())),
    ("b", CrankLinkage::coupler),
    ("c", |l| {
        let of_several = || l.multi_loop().map(|l| l.dyads()[0].lengths[1]);
        l.four_bar().map(FourBar::follower).or_else(of_several)
    }),
    ("d", |l| l.multi_loop().is_none().then(|| l.crank_side())),
    ("e", |l| l.four_bar().map(FourBar::follower_side)),
    ("t1", |l| Some(l.assembly().sign())),
    ("t2", |l| Some(l.four_bar()?.side().sign())),
];

/// A parameter of a linkage: its name and its value; `None` of a kind that has no such parameter.
pub(super) type Parameter = Column<CrankLinkage, Option<f64>>;

/// The parameters that only linkages with a slider have.
pub(super) const OF_SLIDERS: [Parameter; 6] = [
    ("line_point_x", |l| Some(l.slider_crank()?.line_point().re)),
    ("line_point_y", |l| Some(l.slider_crank()?.line_point().im)),
    ("line_deg", |l| Some(l.slider_crank()?.parameters().line_deg)),
    ("offset", |l| Some(l.inverted_slider_crank()?.offset())),
    ("coupler_x", |l| l.four_bar().is_none().then(|| l.coupler_offset().re)),
    ("coupler_y", |l| l.four_bar().is_none().then(|| l.coupler_offset().im)),
];

/// The parameters that only linkages of several loops have: of each further dyad the places of its ends along and across the
/// lines of the links that carry them, its two lengths and its sign. P is coupler_x and coupler_y on the line of its own link.
pub(super) const OF_SEVERAL_LOOPS: [Parameter; 14] = [
    ("X2x", |l| Some(dyad(l, 1)?.ends[0].re)),
    ("X2y", |l| Some(dyad(l, 1)?.ends[0].im)),
    ("Y2x", |l| Some(dyad(l, 1)?.ends[1].re)),
    ("Y2y", |l| Some(dyad(l, 1)?.ends[1].im)),
    ("X2F2", |l| Some(dyad(l, 1)?.lengths[0])),
    ("Y2F2", |l| Some(dyad(l, 1)?.lengths[1])),
    ("side2", |l| Some(dyad(l, 1)?.side.sign())),
    ("X3x", |l| Some(dyad(l, 2)?.ends[0].re)),
    ("X3y", |l| Some(dyad(l, 2)?.ends[0].im)),
    ("Y3x", |l| Some(dyad(l, 2)?.ends[1].re)),
    ("Y3y", |l| Some(dyad(l, 2)?.ends[1].im)),
    ("X3F3", |l| Some(dyad(l, 2)?.lengths[0])),
    ("Y3F3", |l| Some(dyad(l, 2)?.lengths[1])),
    ("side3", |l| Some(dyad(l, 2)?.side.sign())),
];

/// Returns a dyad of a linkage of several loops.
fn dyad(linkage: &CrankLinkage, index: usize) -> Option<&LinkPair> {
    linkage.multi_loop()?.dyads().get(index)
}

/// Returns the parameters that linkages of these kinds have: those of a slider, and of several loops, only where one is among
/// them.
pub(super) fn parameters_of<'l>(linkages: impl IntoIterator<Item = &'l CrankLinkage>) -> Vec<Parameter> {
    let (mut others, mut dyads) = (false, 0);
    for linkage in linkages {
        others |= linkage.four_bar().is_none();
        dyads = dyads.max(linkage.multi_loop().map_or(0, |linkage| 7 * (linkage.dyad_count() - 1)));
    }
    let of_sliders = OF_SLIDERS.into_iter().filter(|_| others);
    PARAMETERS.into_iter().chain(of_sliders).chain(OF_SEVERAL_LOOPS.into_iter().take(dyads)).collect()
}

/// The header row of [`curve_csv`]; the curve of a motion has a last column [`BODY_ANGLE`], that of a function
/// [`OUTPUT_ANGLE`].
pub const CURVE_COLUMNS: [&str; 9] =
    ["crank_deg", "t1", "Cx", "Cy", "Dx", "Dy", "Px", "Py", "transmission_deg"];

/// The column with the angle of a motion's body, from -180 to 180 degrees.
pub const BODY_ANGLE: &str = "angle_deg";

/// The column with the follower's angle in a function, from -180 to 180 degrees from its angle at an output of 0.
pub const OUTPUT_ANGLE: &str = "output_deg";

/// The column with the place of the slider in a function, from its place at an output of 0.
pub const OUTPUT_PLACE: &str = "output";

/// Returns one row for each candidate: every figure and parameter, defects as `order:3 7;branch:2` (points from 0), and
/// the names of the requirements that are not met. Those of a motion have the errors of the angle too.
pub fn candidates_csv(record: &Record) -> String {
    let task = &record.problem.resolved.task;
    let of_motion: &[Column<Candidate>] = match task.kind() {
        TaskKind::Motion => &OF_MOTION,
        TaskKind::Function if task.output.as_ref().is_some_and(|output| output.ranges.is_free()) => {
            &OF_FREE_RANGES
        }
        TaskKind::Function if task.is_of_places() => &OF_PLACES,
        TaskKind::Function => &OF_FUNCTION,
        TaskKind::Path => &[],
    };
    let of_linkage = parameters_of(record.candidates.iter().map(|c| &c.linkage));
    let of_loads: &[Column<Candidate>] =
        if record.problem.resolved.loads.is_some() { &OF_LOADS } else { &[] };
    let head = names(&FIGURES)
        .chain(names(of_motion))
        .chain(names(of_loads))
        .chain(names(&of_linkage))
        .chain(["defects", "unmet"]);
    let rows = record.candidates.iter().map(|c| {
        let defects: Vec<String> = c.defects.iter().map(defect).collect();
        let mut row = cells(&FIGURES, c);
        row.extend(cells(of_motion, c));
        row.extend(cells(of_loads, c));
        row.extend(parameters(&of_linkage, &c.linkage));
        row.extend([defects.join(";"), cell(&words::unmet(record, c).join(";"))]);
        row
    });
    written(head, rows)
}

/// The figures of a member of a front.
const FRONT: [Column<Member>; 8] = [
    ("rms", |m| exact(m.figures.rms)),
    ("max", |m| exact(m.figures.max)),
    ("transmission_deg", |m| exact(m.figures.transmission_deg)),
    ("extent", |m| exact(m.figures.extent)),
    ("longest", |m| exact(m.figures.longest)),
    ("link_ratio", |m| exact(m.figures.link_ratio)),
    ("sensitivity", |m| exact(m.figures.sensitivity)),
    ("kind", |m| m.candidate.linkage.kind().name().to_owned()),
];

/// The figures that a member has beside those in a problem with loads.
const FRONT_OF_LOADS: [Column<Member>; 1] =
    [("peak_torque_N_m", |m| m.figures.peak_torque.map_or(String::new(), exact))];

/// Returns one row for each member of a record's front: its figures, its kind and its parameters; only the header row
/// without a front.
pub fn front_csv(record: &Record) -> String {
    let members = || record.front.iter().flat_map(|front| &front.members);
    let of_linkage = parameters_of(members().map(|member| &member.candidate.linkage));
    let of_loads: &[Column<Member>] =
        if record.problem.resolved.loads.is_some() { &FRONT_OF_LOADS } else { &[] };
    let head = names(&FRONT).chain(names(of_loads)).chain(names(&of_linkage));
    let rows = members().map(|member| {
        let mut row = cells(&FRONT, member);
        row.extend(cells(of_loads, member));
        row.extend(parameters(&of_linkage, &member.candidate.linkage));
        row
    });
    written(head, rows)
}

/// Returns the names of columns.
pub(super) fn names<Row, Value>(columns: &[Column<Row, Value>]) -> impl Iterator<Item = &'static str> {
    columns.iter().map(|(name, _)| *name)
}

/// Returns the cells of a row.
pub(super) fn cells<Row>(columns: &[Column<Row>], row: &Row) -> Vec<String> {
    columns.iter().map(|(_, cell)| cell(row)).collect()
}

/// Returns the cells of those columns of a candidate's figures that have these names.
pub(super) fn figures(candidate: &Candidate, wanted: &[&str]) -> Vec<String> {
    let found = wanted.iter().filter_map(|name| FIGURES.iter().find(|(known, _)| known == name));
    found.map(|(_, cell)| cell(candidate)).collect()
}

/// Returns the cells of the parameters, empty where the kind has none.
pub(super) fn parameters(columns: &[Parameter], linkage: &CrankLinkage) -> Vec<String> {
    columns.iter().map(|(_, of)| of(linkage).map_or(String::new(), exact)).collect()
}

fn defect(defect: &Defect) -> String {
    let at: Vec<String> = defect.at().iter().map(usize::to_string).collect();
    format!("{}:{}", defect.name(), at.join(" "))
}

/// Returns the coupler curve of the circuit of `record.candidates[index]`: if the input turns fully, one row for each
/// degree of the crank from 0 to 359; if it rocks, 720 rows there and back (evenly spaced in the circuit's parameter).
/// Positions at which the loop is open are left out; without such a candidate there is only the header row.
pub fn curve_csv(record: &Record, index: usize) -> String {
    record.candidates.get(index).map_or_else(|| written(CURVE_COLUMNS, []), candidate_curve_csv)
}

/// Returns the curve as [`curve_csv`] does, for a candidate that need not be in a record.
pub fn candidate_curve_csv(candidate: &Candidate) -> String {
    // There are only numbers, which need no quotes.
    let mut text = CURVE_COLUMNS.join(",");
    if candidate.frame_deg.is_some() {
        text.push_str(&format!(",{BODY_ANGLE}"));
    }
    if candidate.output_offset_deg.is_some() {
        text.push_str(&format!(",{OUTPUT_ANGLE}"));
    }
    if candidate.output_offset.is_some() {
        text.push_str(&format!(",{OUTPUT_PLACE}"));
    }
    text.push('\n');
    for (row, coupler) in curve(candidate) {
        for number in row {
            push_exact(&mut text, number);
            text.push(',');
        }
        if let Some(frame_deg) = candidate.frame_deg {
            push_exact(&mut text, body::generated(coupler, frame_deg).to_degrees());
            text.push(',');
        }
        let [.., cx, cy, dx, dy, px, py, _] = row;
        let [crank_pin, follower_pin, coupler_point] = [[cx, cy], [dx, dy], [px, py]].map(point);
        let at = LoopJoints { joints: Joints { crank_pin, follower_pin, coupler_point }, coupler };
        if let Some(output) = body::output(candidate, &at) {
            push_exact(&mut text, output);
            text.push(',');
        }
        text.pop();
        text.push('\n');
    }
    text
}

/// Returns the rows of the curve, each with the direction of the coupler.
fn curve(candidate: &Candidate) -> Vec<([f64; CURVE_COLUMNS.len()], Complex)> {
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
        let Some(LoopJoints { joints: Joints { crank_pin: c, follower_pin: d, coupler_point: p }, coupler }) =
            linkage.joints_with(angle, assembly)
        else {
            continue;
        };
        let transmission = linkage.transmission_at(angle);
        let crank_deg = if rocks { angle.to_degrees() } else { parameter_deg };
        let (t1, mu) = (assembly.sign(), transmission.to_degrees());
        let numbers = [crank_deg, t1, c.re, c.im, d.re, d.im, p.re, p.im, mu];
        if numbers.iter().all(|x| x.is_finite()) {
            table.push((numbers, coupler));
        }
    }
    table
}

/// Returns a row as CSV with its line feed.
pub(super) fn written_row(row: &[String]) -> String {
    written(row, [])
}

/// Returns the header row and the rows as CSV with line feeds.
pub(crate) fn written<Name: AsRef<[u8]>>(
    head: impl IntoIterator<Item = Name>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    // Writing to memory does not fail; if it did, the text so far is returned.
    let mut good = writer.write_record(head).is_ok();
    for row in rows {
        good = good && writer.write_record(&row).is_ok();
    }
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8(bytes).unwrap_or_default()
}
