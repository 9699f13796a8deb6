//! Loads of an analysis as text, as columns of a CSV, and as a chart of the torque over the crank angle.

use super::analysis_text::{degrees, number};
use super::canvas::{Anchor, Area, Canvas, Spot, bold, font, palette};
use super::chart::{Abscissa, Chart, Range, Series};
use super::grid::Align::Right;
use super::grid::{Colour, Grid, plain};
use super::sheet::{FULL, HEAD, INSET, Sheet};
use super::text::{COLUMNS, clean, exact, plural, significant, wrapped};
use crate::mechanism::analysis::loaded::{LoadRecord, PairName};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::loads::figures::{Fluctuation, JointPeak};
use crate::mechanism::loads::{Instant, JointForce, LoadFigures, Peak};
use crate::mechanism::structure::OutputBody;
use std::f64::consts::TAU;

/// Digits of figures in sentences.
const FIGURES: usize = 4;
/// The largest number of pairs that the table has columns for; all are in CSV and JSON.
const COLUMNS_OF_PAIRS: usize = 6;
/// The largest number of pairs whose largest force is named.
const NAMED_PAIRS: usize = 12;
/// The largest number of crank angles that are named one by one.
const NAMED_ANGLES: usize = 6;
/// A coefficient of speed fluctuation of machines that run steadily (R. L. Norton, Design of Machinery: 0.01 to 0.05).
const STEADY: f64 = 0.05;
/// The height of the chart.
const HEIGHT: f64 = 210.0;
/// The height of a row of the sheet's table.
const ROW: f64 = 17.0;

/// The names of the columns after those of the forces.
const LAST: [&str; 5] = ["shaking_Fx_N", "shaking_Fy_N", "shaking_M_N_m", "kinetic_J", "potential_J"];

/// Returns a pair's name in columns, unique among those of one record: the joint's, with a number from the second force at the joint
/// on.
fn column_name(record: &LoadRecord, index: usize) -> String {
    let pair = &record.pairs[index];
    let same = |other: &&PairName| other.at == pair.at && other.slides == pair.slides;
    match record.pairs[..index].iter().filter(same).count() {
        0 => super::text::cell(&pair.at),
        // A dot is in no joint's name.
        before => format!("{}.{}", super::text::cell(&pair.at), before + 1),
    }
}

/// The names of the columns of the crank's motion, of a speed that changes over the turn.
const INPUT: [&str; 2] = ["omega2_rad_s", "alpha2_rad_s2"];

/// Returns the names of the columns of the crank's motion; none of a constant speed.
fn inputs(record: &LoadRecord) -> impl Iterator<Item = &'static str> {
    let changes = record.figures.as_ref().is_some_and(|figures| figures.speed_over_turn.is_some());
    INPUT.into_iter().filter(move |_| changes)
}

/// Returns the columns that loads add to a CSV: speed and acceleration of a crank with a table of speeds, `torque_N_m`, two of each
/// pair, shaking force and moment, energies.
pub(super) fn columns(record: &LoadRecord) -> Vec<String> {
    let mut columns: Vec<String> = inputs(record).map(str::to_owned).collect();
    columns.push("torque_N_m".to_owned());
    for (i, pair) in record.pairs.iter().enumerate() {
        let name = column_name(record, i);
        columns.extend(match pair.slides {
            false => [format!("Fx_{name}_N"), format!("Fy_{name}_N")],
            true => [format!("normal_{name}_N"), format!("moment_{name}_N_m")],
        });
    }
    columns.extend(LAST.map(str::to_owned));
    columns
}

/// Returns the cells of a row in these columns, empty without a result.
pub(super) fn cells(record: &LoadRecord, instant: Option<&Instant>) -> Vec<String> {
    let Some(at) = instant else { return vec![String::new(); columns(record).len()] };
    let two = |force: &JointForce| {
        let slider = [force.normal.unwrap_or_default(), force.moment.unwrap_or_default()];
        force.force.unwrap_or(slider)
    };
    let [x, y] = at.shaking_force;
    let forces = at.forces.iter().flat_map(two);
    let last = [x, y, at.shaking_moment, at.kinetic, at.potential];
    let input = at.input.iter().flat_map(|input| [input.speed_rad_s, input.acceleration_rad_s2]);
    input.chain([at.torque]).chain(forces).chain(last).map(exact).collect()
}

/// Returns the comment above the header of a CSV: the body on which each force acts.
pub(super) fn comment(record: &LoadRecord) -> String {
    let pair = |(i, pair): (usize, &PairName)| {
        let [name, on, from] = [&column_name(record, i), &pair.on, &pair.from].map(|name| clean(name));
        let kind = if pair.slides { " (slider: across its line, to the left, and moment)" } else { "" };
        format!("{name} on {on} from {from}{kind}")
    };
    let pairs: Vec<String> = record.pairs.iter().enumerate().map(pair).collect();
    format!(
        "# torque_N_m: of the motor on the crank, counter-clockwise. Forces: {}. Friction is left out.\n",
        pairs.join("; ")
    )
}

/// Returns a figure with its unit and the crank angle at which it is.
fn at(peak: &Peak, unit: &str) -> String {
    format!("{} {unit} at {}", significant(peak.value, FIGURES), degrees(peak.crank_deg))
}

/// Returns the figures over the range of the crank in sentences, wrapped.
pub fn words(record: &LoadRecord, mean: CrankMotion) -> String {
    let Some(figures) = &record.figures else {
        return wrapped("  ", "  ", "Loads: the linkage closes at no crank angle.", COLUMNS);
    };
    let n = |value: f64| significant(value, FIGURES);
    let range = if figures.full_turn {
        "a turn".to_owned()
    } else {
        let arcs: Vec<String> = figures
            .arcs_deg
            .iter()
            .map(|[from, to]| format!("{} to {}", degrees(*from), degrees(*to)))
            .collect();
        format!("{} (1° short of each toggle, where the torque has no bound)", arcs.join(" and "))
    };
    let mut text = format!(
        "Loads over {range}: the torque on the crank has its peak of {}, {} N m rms, {} N m on average",
        at(&figures.torque_peak, "N m"),
        n(figures.torque_rms),
        n(rounded(figures.torque_mean, figures.torque_rms)),
    );
    text.push_str(&match mean.speed_rad_s {
        0.0 => "; the crank stands still (statics: --rpm adds the masses' inertia).".to_owned(),
        _ if rounded(figures.torque_mean, figures.torque_rms) == 0.0 => "; mean power 0 W.".to_owned(),
        _ => format!("; mean power {} W.", n(figures.power_mean)),
    });
    if let Some(range) = &figures.speed_over_turn {
        let [slowest, fastest, average] =
            [range.slowest_rad_s, range.fastest_rad_s, range.mean_rad_s].map(|speed| n(speed * 60.0 / TAU));
        text.push_str(&format!(
            " The crank turns at {slowest} to {fastest} rpm, at {average} rpm on average over time: a turn takes {} s. Rms and power are \
             over time; the speed is given, so that a flywheel is not computed.",
            n(range.turn_s)
        ));
    }
    if let Some(fluctuation) = figures.fluctuation.as_ref().filter(|_| mean.speed_rad_s != 0.0) {
        text.push_str(&swing(fluctuation));
    }
    text.push_str(&largest(&figures.joints));
    text.push_str(&format!(
        " Shaking force up to {}, shaking moment about the crank's pivot up to {}.",
        at(&figures.shaking_force, "N"),
        at(&Peak { value: figures.shaking_moment.value.abs(), ..figures.shaking_moment }, "N m")
    ));
    text.push_str(&advantages(figures, record.output));
    text.push_str(&left_out(figures));
    text.push_str(" Friction is left out.");
    wrapped("  ", "  ", &text, COLUMNS)
}

/// Returns 0 for a mean that is rounding beside the values.
pub fn rounded(mean: f64, size: f64) -> f64 {
    /// Sums of some hundred values are known to this part of them.
    const ROUNDING: f64 = 1e-12;
    if mean.abs() <= ROUNDING * size { 0.0 } else { mean }
}

fn swing(fluctuation: &Fluctuation) -> String {
    let n = |value: f64| significant(value, FIGURES);
    let mut text = format!(" At constant motor torque the energy swings by {} J", n(fluctuation.energy));
    match (fluctuation.coefficient, fluctuation.halving_flywheel) {
        (Some(coefficient), Some(halving)) => {
            let inertia = n(fluctuation.reflected_inertia);
            text.push_str(&format!(
                ". With the bodies' own inertia at the crank, {inertia} kg m2, the coefficient of speed fluctuation is {}: a flywheel of {} \
                 kg m2 on the crank halves it",
                n(coefficient),
                n(halving)
            ));
            if let Some(flywheel) = fluctuation.flywheel_for(STEADY).filter(|flywheel| *flywheel > 0.0) {
                text.push_str(&format!(", one of {} kg m2 brings it to {STEADY}", n(flywheel)));
            }
            text.push('.');
        }
        _ => text.push('.'),
    }
    text
}

/// Returns the largest force of each pair in order; of many pairs those with the largest alone.
fn largest(joints: &[JointPeak]) -> String {
    let size = |i: &usize| joints[*i].force.value.abs();
    let mut shown: Vec<usize> = (0..joints.len()).collect();
    shown.sort_by(|i, j| size(j).total_cmp(&size(i)));
    shown.truncate(NAMED_PAIRS);
    shown.sort_unstable();
    let forces: Vec<String> = shown.iter().map(|i| joint(&joints[*i])).collect();
    let more = match joints.len() - shown.len() {
        0 => String::new(),
        more => format!(", and less at {more} more"),
    };
    format!(" Largest forces: {}{more}.", forces.join(", "))
}

fn joint(joint: &JointPeak) -> String {
    let [name, on, from] = [&joint.at, &joint.on, &joint.from].map(|name| clean(name));
    let force = at(&Peak { value: joint.force.value.abs(), ..joint.force }, "N");
    match joint.moment.filter(|moment| moment.value.abs() > 1e-9 * joint.force.value.abs()) {
        _ if !joint.slides => format!("{name} ({on}, {from}) {force}"),
        None => format!("slider {name} ({on}, {from}) {force}"),
        Some(moment) => format!("slider {name} ({on}, {from}) {force} with {}", at(&moment, "N m")),
    }
}

/// Returns the least mechanical advantage at the traced point and at the output.
fn advantages(figures: &LoadFigures, output: Option<OutputBody>) -> String {
    let least = |peak: &Peak, unit: &str| {
        format!("{} {unit} (at {})", significant(peak.value, FIGURES), degrees(peak.crank_deg))
    };
    let Some(at_point) = &figures.advantage_least else { return String::new() };
    let point = format!(" Each N m on the crank gives at least {} at the traced point", least(at_point, "N"));
    let of_output = figures.output_advantage_least.as_ref().zip(output);
    point
        + &of_output.map_or_else(String::new, |(peak, output)| match output {
            OutputBody::Turns(_) => format!(" and {} at the output", least(peak, "N m")),
            OutputBody::Slides(_) => format!(" and {} at the slider", least(peak, "N")),
        })
        + "."
}

/// Returns the crank angles without a result, and the springs that are wound too far.
fn left_out(figures: &LoadFigures) -> String {
    let mut text = String::new();
    let missing = &figures.left_out_deg;
    if !missing.is_empty() {
        let named: Vec<String> = missing.iter().take(NAMED_ANGLES).map(|deg| degrees(*deg)).collect();
        let more = if missing.len() > NAMED_ANGLES { ", .." } else { "" };
        text.push_str(&format!(
            " Left out: {} at which the linkage is open or at a toggle: {}{more}.",
            plural(missing.len(), "crank angle"),
            named.join(", ")
        ));
    }
    for spring in &figures.overwound_springs {
        text.push_str(&format!(
            " Watch for: spring {spring} is wound past half a turn, where its moment is taken to jump."
        ));
    }
    text
}

/// Returns the table of torque, energies and the size of each joint's force at the crank angles asked for.
pub(super) fn table(record: &LoadRecord, rows: &[(f64, Option<&Instant>)], colour: Colour) -> String {
    let shown = record.pairs.len().min(COLUMNS_OF_PAIRS);
    let letter = |i: usize| if record.pairs[i].slides { "N" } else { "F" };
    let names: Vec<String> =
        (0..shown).map(|i| format!("{} {}", letter(i), clean(&column_name(record, i)))).collect();
    let mut heads = vec!["crank", "torque", "kinetic", "potential"];
    heads.extend(names.iter().map(String::as_str));
    let mut grid = Grid::new(&[(Right, &heads)]);
    let values = |at: &Instant| {
        let size = |force: &JointForce| {
            force.force.map_or(force.normal.unwrap_or_default().abs(), |[x, y]| x.hypot(y))
        };
        let mut values = vec![at.torque, at.kinetic, at.potential];
        values.extend(at.forces.iter().take(shown).map(size));
        values
    };
    // Against the largest of its own column a number can be rounding.
    let mut sizes = vec![0.0_f64; 3 + shown];
    for at in rows.iter().filter_map(|(_, at)| *at) {
        for (size, value) in sizes.iter_mut().zip(values(at)) {
            *size = size.max(value.abs());
        }
    }
    for (crank_deg, at) in rows {
        let mut cells = vec![plain(significant(*crank_deg, 6))];
        let values = at.map(values);
        let of = |i: usize| values.as_ref().map(|values| values[i]);
        cells.extend(sizes.iter().enumerate().map(|(i, size)| number(of(i), *size)));
        grid.row(cells);
    }
    let note = "Torque in N m, energies in J, sizes of the joints' forces (F) and of sliders' (N) in N; the CSV has their components.";
    format!("\n{}{}", grid.render(colour), wrapped("\n  ", "  ", note, COLUMNS))
}

/// Returns the chart of the torque with its axis; `None` of torques at one crank angle alone.
fn torque_chart(figures: &LoadFigures, toggles_deg: &[f64]) -> Option<(Chart, Abscissa)> {
    let ends = figures.torque_strands.iter().flatten().map(|(deg, _)| *deg);
    let (low, high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if high <= low {
        return None;
    }
    let toggles = toggles_deg.iter().copied().filter(|deg| (low..=high).contains(deg)).collect();
    let abscissa = Abscissa { low, high, unreachable: Vec::new(), toggles };
    let series = Series { name: "torque", colour: palette::CURVE, strands: figures.torque_strands.clone() };
    let range = Range::Fitted {
        natural: figures.torque_rms.max(f64::MIN_POSITIVE),
        angle: false,
        unbounded: !figures.full_turn,
    };
    let (title, unit) = ("Torque on the crank", "N m".to_owned());
    Some((Chart { title, unit, series: vec![series], range, warning: Vec::new() }, abscissa))
}

/// Returns the chart of the torque as a drawing by itself; `None` of torques at one crank angle alone.
pub(super) fn torque_svg(figures: &LoadFigures) -> Option<String> {
    let (chart, abscissa) = torque_chart(figures, &[])?;
    let mut canvas = Canvas::default();
    chart.draw(&mut canvas, &abscissa, Area { x: 0.0, y: 0.0, width: FULL - INSET, height: HEIGHT });
    Some(canvas.document(
        FULL,
        HEIGHT + 4.0,
        "Torque on the crank",
        "The torque over the crank angle, in N m over degrees.",
    ))
}

/// Draws a row for each joint with its largest force, below a row of heads.
fn joint_rows(canvas: &mut Canvas, joints: &[JointPeak], top: f64) {
    const COLUMNS: [f64; 5] = [INSET, INSET + 110.0, INSET + 260.0, INSET + 470.0, INSET + 600.0];
    let mut row = |i: usize, cells: [&str; 5], look: &str| {
        let y = top + ROW * (i as f64 + 0.7);
        for (k, (x, text)) in COLUMNS.into_iter().zip(cells).enumerate() {
            let anchor = if k < 3 { Anchor::Start } else { Anchor::End };
            canvas.text(Spot::new(x, y), anchor, look, text);
        }
    };
    row(0, ["joint", "on", "from", "largest force", "at"], &bold(12, palette::INK));
    let look = font(12, palette::INK);
    for (i, joint) in joints.iter().enumerate() {
        let slides = if joint.slides { " (slider)" } else { "" };
        let at = format!("{}{slides}", clean(&joint.at));
        let [on, from] = [&joint.on, &joint.from].map(|name| clean(name));
        let force = format!("{} N", significant(joint.force.value.abs(), FIGURES));
        row(i + 1, [&at, &on, &from, &force, &degrees(joint.force.crank_deg)], &look);
    }
}

/// Returns the chart of the torque as a sheet, with the largest force of each joint below it; `None` of a linkage that closes at no crank angle.
pub(super) fn sheet(record: &LoadRecord, toggles_deg: &[f64]) -> Option<Sheet> {
    let figures = record.figures.as_ref()?;
    let (chart, abscissa) = torque_chart(figures, toggles_deg)?;
    let listed = figures.joints.len().min(NAMED_PAIRS);
    let bottom = HEAD + HEIGHT + 14.0;
    let mut sheet = Sheet::new("Loads", FULL, bottom + ROW * (listed + 1) as f64 + 6.0);
    let area = Area { x: INSET, y: HEAD, width: FULL - 2.0 * INSET, height: HEIGHT };
    chart.draw(&mut sheet.body, &abscissa, area);
    joint_rows(&mut sheet.body, &figures.joints[..listed], bottom);
    sheet.note = format!(
        "peak {}, {} N m rms; friction is left out",
        at(&figures.torque_peak, "N m"),
        significant(figures.torque_rms, FIGURES)
    );
    Some(sheet)
}
