//! An analysis as one self-contained SVG page: the drawings of the classic papers, as far as they apply.
//!
//! | sheet | after | when |
//! |---|---|---|
//! | positions with the path of P | De Castro, figure 2.2 | always |
//! | construction by arcs | graphical position analysis by ruler and compasses | a row closes |
//! | velocities, accelerations | De Castro, figures 3.2 and 4.1 | the input moves |
//! | the four configurations | Romero, figure 3 | all four were asked for |
//! | curves over the cycle | | from [`CYCLE_ROWS`] rows on |
//! | torque over the crank's range | | there are loads |
//!
//! The figures are those of the analysis; only curves are computed from the linkage's own kinematics.

mod configurations;
mod construction;
mod cycle;
mod positions;
mod vectors;

use super::canvas::{Canvas, View, filled, palette};
use super::loads;
use super::parts::{UP, letter, stand};
use super::scene::{Pose, Scene, circuits_through, middle_position};
use super::sheet::{FULL, HALF, Sheet, dimensions, page};
use super::text::{brief, plural, significant};
use super::words;
use crate::mechanism::analysis::{Analysis, Configuration, Row, Status, joints_of};
use crate::mechanism::{Complex, FourBar};
use vectors::{ACCELERATIONS, VELOCITIES};

/// The least number of rows that are drawn as curves against the crank angle.
pub const CYCLE_ROWS: usize = 24;

/// Returns the page of an analysis: title, the linkage's mobility, and the sheets that apply.
///
/// Rows without a position are left out of drawings and are gaps in curves; vectors are those of the first row that has
/// them.
///
/// ```
/// # use linkwright::internals::mechanism::{analysis::{Request, analyze}, four_bar::motion::CrankMotion, *};
/// let linkage = FourBar::with_coupler_offset([point([0.0, 0.0]), point([4.0, 1.0])], [2.0, 5.0, 5.0],
///     point([2.5, 4.3]), AssemblyMode::Plus)?;
/// let request = Request { name: "mine".into(), unit: None, linkage, crank_deg: vec![30.0, 60.0],
///     input: CrankMotion::steady(1.0).into(), methods: vec![], all_configurations: false };
/// let svg = linkwright::internals::report::analysis_sheets::analysis_svg(&analyze(&request));
/// assert!(svg.contains("Construction by arcs") && svg.contains("Velocities"));
/// # Ok::<(), LinkageError>(())
/// ```
pub fn analysis_svg(analysis: &Analysis) -> String {
    let kind = analysis.mobility.linkage_type.map_or("no assembly", |t| t.name());
    let name = words::named(&analysis.name, "unnamed linkage");
    page(&name, kind, &lines(analysis), sheets(analysis))
}

fn sheets(analysis: &Analysis) -> Vec<Sheet> {
    let Some(configuration) = analysis.configurations.first() else { return Vec::new() };
    type Maker = fn(&Analysis, &Configuration, f64) -> Option<Sheet>;
    let makers: [Maker; 4] = [
        positions::sheet,
        construction::sheet,
        |analysis, configuration, width| vectors::sheet(analysis, configuration, width, &VELOCITIES),
        |analysis, configuration, width| vectors::sheet(analysis, configuration, width, &ACCELERATIONS),
    ];
    let mut sheets: Vec<Sheet> =
        makers.iter().filter_map(|make| make(analysis, configuration, HALF)).collect();
    if sheets.len() % 2 == 1 {
        // The first sheet takes the whole width.
        sheets.splice(..1, positions::sheet(analysis, configuration, FULL));
    }
    sheets.extend(configurations::sheet(analysis));
    sheets.extend(cycle::sheet(analysis, configuration));
    let of_loads = analysis.loads.as_ref();
    sheets.extend(of_loads.and_then(|record| loads::sheet(record, &analysis.mobility.toggles_deg)));
    sheets
}

/// Returns the linkage, its mobility and its positions, a line for each.
fn lines(analysis: &Analysis) -> Vec<String> {
    let Some(configuration) = analysis.configurations.first() else {
        return vec!["no configuration to draw".to_owned()];
    };
    let mobility = &analysis.mobility;
    let unit = words::length_suffix(analysis.unit);
    let worst = mobility
        .worst_transmission_deg
        .map_or(String::new(), |worst| format!(", worst transmission angle {}°", significant(worst, 3)));
    let range = match (&mobility.linkage_type, mobility.input_turns_fully) {
        (None, _) => "the links cannot be joined".to_owned(),
        (_, true) => "the input turns fully".to_owned(),
        _ => {
            let arcs = mobility.input_arcs_deg.iter();
            let arcs: Vec<String> =
                arcs.map(|[from, to]| format!("{} to {}", degrees(*from), degrees(*to))).collect();
            format!("input from {}", arcs.join(" or from "))
        }
    };
    let margin = brief(mobility.grashof_margin, 4);
    vec![
        dimensions(&configuration.linkage),
        format!("Grashof margin {margin}{unit}, {range}{worst}"),
        format!("{}; {}", counted(&configuration.rows), input(analysis)),
    ]
}

/// Returns the counts of positions, such as `360 positions: 358 ok, 2 singular`.
fn counted(rows: &[Row]) -> String {
    let all = [Status::Ok, Status::Singular, Status::Open, Status::Undetermined, Status::NotFinite];
    let counts: Vec<(Status, usize)> = all
        .into_iter()
        .map(|status| (status, rows.iter().filter(|row| row.status == status).count()))
        .filter(|(_, count)| *count > 0)
        .collect();
    let total = match rows.len() {
        0 => "no crank angle asked".to_owned(),
        n => plural(n, "position"),
    };
    match counts.as_slice() {
        [] | [(Status::Ok, _)] => total,
        [(status, _)] => format!("{total}, {}", status.word()),
        several => {
            let parts: Vec<String> = several.iter().map(|(s, n)| format!("{n} {}", s.word())).collect();
            format!("{total}: {}", parts.join(", "))
        }
    }
}

fn input(analysis: &Analysis) -> String {
    let mut text = format!("ω2 = {} rad/s", brief(analysis.omega2_rad_s, 5));
    if let Some(range) = analysis.drive.range() {
        let [slowest, fastest] = [range.slowest_rad_s, range.fastest_rad_s].map(|speed| brief(speed, 5));
        return format!("ω2 = {slowest} to {fastest} rad/s");
    }
    if analysis.alpha2_rad_s2 != 0.0 {
        text.push_str(&format!(", α2 = {} rad/s²", brief(analysis.alpha2_rad_s2, 5)));
    }
    text
}

/// Returns an angle such as `90°`.
fn degrees(value: f64) -> String {
    format!("{}°", brief(value, 5))
}

/// Returns the rows that have a position, with A, B, C, D, P there.
fn closed(configuration: &Configuration) -> Vec<(&Row, [Complex; 5])> {
    let rows = configuration.rows.iter();
    rows.filter_map(|row| Some((row, joints_of(&configuration.linkage, row)?)))
        .filter(|(_, joints)| joints.iter().all(|p| p.re.is_finite() && p.im.is_finite()))
        .collect()
}

/// Returns the scene of the first of these positions, with the circuits through all of them; without a position only
/// the curve.
fn scene(linkage: &FourBar, closed: &[(&Row, [Complex; 5])], samples: usize) -> Scene {
    let positions = closed.iter().map(|(row, _)| (row.crank_deg.to_radians(), linkage.assembly()));
    let mut circuits = circuits_through(linkage, positions, samples);
    if circuits.is_empty() {
        circuits = circuits_through(linkage, [middle_position(linkage)], samples);
    }
    let pose = closed.first().map(|(_, joints)| {
        let [.., c, d, _] = *joints;
        Pose { target: None, joints: *joints, coupler: d - c }
    });
    Scene { linkage: Some(linkage.into()), targets: Vec::new(), circuits, pose }
}

/// Draws A and B, if there is no position to draw.
fn pivots(canvas: &mut Canvas, view: &View, linkage: &FourBar, weight: f64) {
    for (name, pivot) in [("A", linkage.crank_pivot()), ("B", linkage.follower_pivot())] {
        let at = view.spot(pivot);
        stand(canvas, at, weight);
        canvas.circle(at, 5.2 * weight, &filled(palette::PAPER, palette::BAR_EDGE, 1.5));
        letter(canvas, name, at, UP);
    }
}
