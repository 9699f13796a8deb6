//! Charts of the transmission angle, angles, velocities and accelerations against the crank angle.

use super::vectors::{ACCELERATIONS, VELOCITIES, per_time};
use super::{CYCLE_ROWS, degrees};
use crate::mechanism::analysis::{Analysis, Configuration, MobilityRecord, Pose, Rates, Row, Status};
use crate::mechanism::four_bar::transmission::POOR_DEG;
use crate::mechanism::point;
use crate::report::canvas::{Area, palette};
use crate::report::chart::{Abscissa, Chart, Range, Series};
use crate::report::sheet::{FULL, HEAD, INSET, Sheet};

const HEIGHT: f64 = 196.0;
const GAP: f64 = 22.0;
/// The number of turns above which toggles and open stretches are not marked: they would cover everything else.
const MOST_TURNS: f64 = 10.0;

pub(super) fn sheet(analysis: &Analysis, configuration: &Configuration) -> Option<Sheet> {
    let rows = sorted(configuration);
    if rows.len() < CYCLE_ROWS || !rows.iter().any(|row| row.pose.is_some()) {
        return None;
    }
    let span = Span::of(&rows)?;
    let abscissa = abscissa(&analysis.mobility, &span);
    let charts = charts(analysis, configuration, &rows, &span);
    let width = 0.5 * (FULL - 2.0 * INSET - GAP);
    let bottom = HEAD + charts.len().div_ceil(2) as f64 * (HEIGHT + 8.0);
    let mut sheet = Sheet::new("Over the cycle", FULL, bottom);
    for (i, chart) in charts.iter().enumerate() {
        let (column, row) = ((i % 2) as f64, (i / 2) as f64);
        let area =
            Area { x: INSET + column * (width + GAP), y: HEAD + row * (HEIGHT + 8.0), width, height: HEIGHT };
        chart.draw(&mut sheet.body, &abscissa, area);
    }
    sheet.note = format!(
        "against the crank angle from {} to {}; shaded red: within {POOR_DEG}° of a toggle",
        degrees(abscissa.low),
        degrees(abscissa.high)
    );
    if !abscissa.unreachable.is_empty() {
        sheet.note.push_str("; grey: the loop is open");
    }
    if !abscissa.toggles.is_empty() {
        sheet.note.push_str("; dashed: toggles");
    }
    Some(sheet)
}

/// Returns the rows sorted by crank angle.
fn sorted(configuration: &Configuration) -> Vec<&Row> {
    let mut rows: Vec<&Row> = configuration.rows.iter().filter(|row| row.crank_deg.is_finite()).collect();
    rows.sort_by(|x, y| x.crank_deg.total_cmp(&y.crank_deg));
    rows
}

/// The range of the rows' crank angles, in degrees.
struct Span {
    low: f64,
    high: f64,
    /// The distance of two rows above which there is a gap between them.
    gap: f64,
    /// Whether the rows make a full turn apart from their last step, which leads back to the first.
    closes: bool,
}

impl Span {
    /// Returns the range; `None` if all angles are equal.
    fn of(rows: &[&Row]) -> Option<Span> {
        let (low, high) = (rows.first()?.crank_deg, rows.last()?.crank_deg);
        let mut steps: Vec<f64> = rows
            .windows(2)
            .map(|pair| pair[1].crank_deg - pair[0].crank_deg)
            .filter(|step| *step > 0.0)
            .collect();
        steps.sort_by(f64::total_cmp);
        let middle = *steps.get(steps.len() / 2)?;
        let missing = 360.0 - (high - low);
        let closes = missing > 0.0 && missing <= 1.001 * middle;
        Some(Span { low, high: if closes { low + 360.0 } else { high }, gap: 2.5 * middle, closes })
    }
}

/// Returns the unreachable ranges and the toggles, moved by turns into the range.
fn abscissa(mobility: &MobilityRecord, span: &Span) -> Abscissa {
    let (low, high) = (span.low, span.high);
    let mut abscissa = Abscissa { low, high, unreachable: Vec::new(), toggles: Vec::new() };
    if high - low > 360.0 * MOST_TURNS {
        return abscissa;
    }
    let images = |angle: f64| {
        let first = ((low - angle) / 360.0).floor() - 1.0;
        (0..=MOST_TURNS as usize + 3).map(move |k| angle + 360.0 * (first + k as f64))
    };
    let within = |angle: &f64| (low..=high).contains(angle);
    abscissa.toggles = mobility.toggles_deg.iter().flat_map(|t| images(*t)).filter(within).collect();
    abscissa.toggles.sort_by(f64::total_cmp);
    let mut arcs: Vec<(f64, f64)> = mobility
        .input_arcs_deg
        .iter()
        .flat_map(|[from, to]| {
            let width = to - from;
            images(*from).map(move |start| (start, start + width))
        })
        .collect();
    arcs.sort_by(|x, y| x.0.total_cmp(&y.0));
    if !arcs.is_empty() {
        let mut reached = low;
        for (from, to) in arcs.into_iter().chain([(high, high)]) {
            if from > reached && reached < high {
                abscissa.unreachable.push((reached, from.min(high)));
            }
            reached = reached.max(to);
        }
    }
    abscissa
}

/// Returns a series of the rows' values, with gaps at rows without one.
fn series(
    name: &'static str,
    colour: &'static str,
    rows: &[&Row],
    span: &Span,
    turns: bool,
    value: impl Fn(&Row) -> Option<f64>,
) -> Series {
    let again = rows.first().filter(|_| span.closes).map(|first| (first.crank_deg + 360.0, *first));
    let all = rows.iter().map(|row| (row.crank_deg, *row)).chain(again);
    let mut strands: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for (x, row) in all {
        let Some(mut y) = value(row).filter(|y| y.is_finite()) else {
            last = None;
            continue;
        };
        match last {
            Some((x_before, y_before)) if x - x_before <= span.gap => {
                if turns {
                    y += 360.0 * ((y_before - y) / 360.0).round();
                }
                if let Some(strand) = strands.last_mut() {
                    strand.push((x, y));
                }
            }
            _ => strands.push(vec![(x, y)]),
        }
        last = Some((x, y));
    }
    Series { name, colour, strands }
}

fn charts(analysis: &Analysis, configuration: &Configuration, rows: &[&Row], span: &Span) -> Vec<Chart> {
    let pose = |name, colour, turns, value: fn(&Pose) -> f64| {
        series(name, colour, rows, span, turns, |row| row.pose.as_ref().map(value))
    };
    let rate = |name, colour, value: &dyn Fn(&Rates) -> f64| {
        series(name, colour, rows, span, false, |row| row.rates.as_ref().map(value))
    };
    let chart = |title, unit: &str, series, range| Chart {
        title,
        unit: unit.to_owned(),
        series,
        range,
        warning: Vec::new(),
    };
    let poor = POOR_DEG;
    let transmission = pose("μ", palette::CURVE, false, |p| p.transmission_deg);
    let half_turn = Range::Fixed { low: 0.0, high: 180.0, tick: 30.0 };
    let coupler = pose("coupler θ3", palette::TARGET, true, |p| p.coupler_deg);
    let follower = pose("follower θ4", palette::FOLLOWER, true, |p| p.follower_deg);
    let angles = Range::Fitted { natural: 10.0, angle: true, unbounded: false };
    let mut charts = vec![
        Chart {
            warning: vec![(0.0, poor), (180.0 - poor, 180.0)],
            ..chart("Transmission angle", "μ, °", vec![transmission], half_turn)
        },
        chart("Angles", "°", vec![coupler, follower], angles),
    ];
    let (omega, alpha) = (analysis.omega2_rad_s.abs(), analysis.alpha2_rad_s2.abs());
    if !rows.iter().any(|row| row.rates.is_some()) || (omega == 0.0 && alpha == 0.0) {
        return charts;
    }
    let singular = rows.iter().any(|row| row.status == Status::Singular);
    let unbounded = singular || !analysis.mobility.toggles_deg.is_empty();
    let fitted = |natural: f64| Range::Fitted { natural, angle: false, unbounded };
    let length = configuration.linkage.longest_link();
    // At a crank that only begins to turn there are no velocities.
    let kinds = [(VELOCITIES, omega), (ACCELERATIONS, omega * omega + alpha)];
    let kinds = &kinds[usize::from(omega == 0.0)..];
    for (kind, natural) in kinds {
        let ([coupler, follower], of) = (kind.turning_names, kind.turning);
        let coupler = rate(coupler, palette::TARGET, &|r| of(r)[0]);
        let follower = rate(follower, palette::FOLLOWER, &|r| of(r)[1]);
        let unit = format!("rad/{}", kind.per);
        charts.push(chart(kind.charts[0], &unit, vec![coupler, follower], fitted(*natural)));
    }
    for (kind, natural) in kinds {
        let size = rate(kind.of_p, palette::CURVE, &|r| point((kind.vectors)(r)[2]).norm());
        let unit = per_time(analysis.unit, kind.per);
        charts.push(chart(kind.charts[1], &unit, vec![size], fitted(natural * length)));
    }
    charts
}
