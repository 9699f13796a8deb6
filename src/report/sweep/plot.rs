//! The plot of a sweep: the least rms error over one varied key as a line, or over two as a map of colours.

use super::summary::{GridAxis, GridCell, Summary};
use crate::record::sweep::Plan;
use crate::report::canvas::{Anchor, Area, Canvas, Spot, bold, filled, font, outline, palette, px};
use crate::report::scale::{LOGARITHMIC, Scale, colour};
use crate::report::text::{brief, shortened, text_width, xml};

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 520.0;
const LEFT: f64 = 110.0;
const TOP: f64 = 78.0;
const BOTTOM: f64 = 64.0;
/// The room at the right of a line and of a map.
const RIGHT: [f64; 2] = [30.0, 132.0];
const TEXT: f64 = 12.5;
/// The most columns of a label on the axis up.
const UP_COLUMNS: usize = 14;
/// Errors below this part of the largest one are drawn as that.
const LEAST_ERROR: f64 = 1e-9;

/// Returns the plot as an SVG document.
pub fn plot_svg(plan: &Plan, summary: &Summary) -> String {
    let mut canvas = Canvas::default();
    let scale = error_scale(&summary.cells);
    let right = WIDTH - RIGHT[usize::from(summary.axes.len() > 1)];
    canvas.text(Spot::new(LEFT, 28.0), Anchor::Start, &bold(17, palette::INK), &shortened(&plan.name, 80));
    canvas.text(Spot::new(LEFT, 48.0), Anchor::Start, &font(TEXT, palette::MUTED), &caption(plan, summary));
    let frame = Area { x: LEFT, y: TOP, width: right - LEFT, height: HEIGHT - TOP - BOTTOM };
    match (summary.axes.as_slice(), scale) {
        ([axis], Some(scale)) => line(&mut canvas, frame, axis, &summary.cells, &scale),
        ([up, across], Some(scale)) => map(&mut canvas, frame, [up, across], &summary.cells, &scale),
        _ => {
            let middle = Spot::new(0.5 * WIDTH, 0.5 * HEIGHT);
            canvas.text(middle, Anchor::Middle, &font(15, palette::MUTED), "No job has an answer to plot.");
        }
    }
    let title = format!("Sweep {}", plan.name);
    canvas.document(WIDTH, HEIGHT, &title, &caption(plan, summary))
}

/// Returns the sentence below the title.
fn caption(plan: &Plan, summary: &Summary) -> String {
    let over: Vec<&str> = summary.axes.iter().map(|axis| axis.key.as_str()).collect();
    let least = format!("Least rms error over {}", over.join(" and "));
    let others = summary.others(plan);
    let grouped = summary.axes.iter().any(|axis| axis.a_cell > 1);
    let best = match (others.is_empty(), grouped) {
        (true, false) => String::new(),
        (true, true) => "; neighbouring values share a place".into(),
        (false, _) => format!("; the best over {}", others.join(", ")),
    };
    shortened(&format!("{least}{best}"), 120)
}

/// Returns the error that is drawn for a cell, and whether it is of an accepted candidate.
fn shown(cell: &GridCell) -> Option<(f64, bool)> {
    cell.rms.map(|rms| (rms, true)).or_else(|| cell.rms_unaccepted.map(|rms| (rms, false)))
}

/// Returns the scale of the errors; `None` if there are none.
fn error_scale(cells: &[GridCell]) -> Option<(Scale, f64)> {
    let mut errors: Vec<f64> = cells.iter().filter_map(shown).map(|(rms, _)| rms).collect();
    let most = errors.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let least = LEAST_ERROR * most;
    errors.iter_mut().for_each(|rms| *rms = rms.max(least));
    (!errors.is_empty()).then(|| (Scale::new(&errors, LOGARITHMIC), least))
}

/// Draws the axis of the errors, with its lines.
fn errors_up(canvas: &mut Canvas, frame: Area, (scale, _): &(Scale, f64)) {
    for tick in scale.ticks() {
        let y = frame.y + frame.height * (1.0 - scale.part(tick));
        let [from, to] = [frame.x, frame.x + frame.width].map(|x| Spot::new(x, y));
        canvas.line(from, to, &outline(palette::FAINT, 0.8));
        let at = Spot::new(frame.x - 9.0, y + 4.2);
        canvas.text(at, Anchor::End, &font(TEXT, palette::MUTED), &brief(tick, 3));
    }
    upright(canvas, frame, "rms error");
}

/// Writes the name of the axis up.
fn upright(canvas: &mut Canvas, frame: Area, name: &str) {
    let (y, ink, name) =
        (px(frame.y + 0.5 * frame.height), bold(13, palette::INK), xml(&shortened(name, 50)));
    canvas.raw(&format!(
        r#"<text transform="translate(22 {y}) rotate(-90)" text-anchor="middle" {ink}>{name}</text>"#
    ));
}

/// Writes the name of the axis across.
fn across_name(canvas: &mut Canvas, frame: Area, name: &str) {
    let at = Spot::new(frame.x + 0.5 * frame.width, HEIGHT - 16.0);
    canvas.text(at, Anchor::Middle, &bold(13, palette::INK), &shortened(name, 90));
}

/// Writes the values of an axis below the frame at their places, as many as there is room for.
fn values_across(canvas: &mut Canvas, frame: Area, axis: &GridAxis, x: impl Fn(usize) -> f64) {
    let mut free = f64::NEG_INFINITY;
    for cell in 0..axis.values.len() {
        let label = shortened(&axis.label(cell), 24);
        let half = 0.5 * text_width(&label, TEXT);
        if x(cell) - half >= free {
            let at = Spot::new(x(cell), frame.y + frame.height + 20.0);
            canvas.text(at, Anchor::Middle, &font(TEXT, palette::MUTED), &label);
            free = x(cell) + half + 10.0;
        }
    }
}

/// Draws the errors over one key: a line through accepted cells, rings where nothing is accepted.
fn line(canvas: &mut Canvas, frame: Area, axis: &GridAxis, cells: &[GridCell], scale: &(Scale, f64)) {
    errors_up(canvas, frame, scale);
    let numbers = axis.numbers();
    let across = numbers.as_deref().map(|numbers| Scale::over(numbers, LOGARITHMIC));
    let x = |cell: usize| {
        let part = match (&across, &numbers) {
            (Some(across), Some(numbers)) => across.part(numbers[cell]),
            _ => (cell as f64 + 0.5) / axis.values.len() as f64,
        };
        frame.x + frame.width * part
    };
    let y = |rms: f64| frame.y + frame.height * (1.0 - scale.0.part(rms.max(scale.1)));
    values_across(canvas, frame, axis, x);
    across_name(canvas, frame, &axis.key);
    let mut run: Vec<Spot> = Vec::new();
    let mut runs = Vec::new();
    for (i, cell) in cells.iter().enumerate() {
        match cell.rms {
            Some(rms) => run.push(Spot::new(x(i), y(rms))),
            None => runs.push(std::mem::take(&mut run)),
        }
    }
    runs.push(run);
    for run in runs.iter().filter(|run| run.len() > 1) {
        canvas.path(run, false, &outline(palette::CURVE, 2));
    }
    let radius = if cells.len() > 60 { 2.2 } else { 4.0 };
    let mut rings = false;
    for (i, cell) in cells.iter().enumerate() {
        if let Some((rms, accepted)) = shown(cell) {
            let spot = Spot::new(x(i), y(rms));
            rings |= !accepted;
            let attributes = if accepted {
                filled(palette::CURVE, palette::PAPER, 1)
            } else {
                filled(palette::PAPER, palette::TARGET, 1.6)
            };
            canvas.circle(spot, radius, &attributes);
        }
    }
    if rings {
        let right = Spot::new(frame.x + frame.width, 66.0);
        let text = "ring: nothing acceptable there";
        canvas.text(right, Anchor::End, &font(TEXT, palette::TARGET_TEXT), text);
    }
}

/// Draws the errors over two keys: a coloured cell for each pair of values, a small one where nothing is accepted.
fn map(
    canvas: &mut Canvas,
    frame: Area,
    [up, across]: [&GridAxis; 2],
    cells: &[GridCell],
    scale: &(Scale, f64),
) {
    let (rows, columns) = (up.values.len(), across.values.len());
    let (width, height) = (frame.width / columns as f64, frame.height / rows as f64);
    canvas.area(frame, &filled("#f1f3f5", palette::FAINT, 1));
    let gap = if width.min(height) > 8.0 { 0.5 } else { 0.0 };
    let mut small = false;
    for (place, cell) in cells.iter().enumerate() {
        let Some((rms, accepted)) = shown(cell) else { continue };
        let (row, column) = (place / columns, place % columns);
        // The first value is at the bottom.
        let area = Area {
            x: frame.x + width * column as f64,
            y: frame.y + frame.height - height * (row + 1) as f64,
            width,
            height,
        };
        small |= !accepted;
        let inset = if accepted { gap } else { 0.32 * width.min(height) };
        let inside = Area {
            x: area.x + inset,
            y: area.y + inset,
            width: area.width - 2.0 * inset,
            height: area.height - 2.0 * inset,
        };
        let fill = colour(scale.0.part(rms.max(scale.1)));
        canvas.area(inside, &format!(r#"fill="{fill}" shape-rendering="crispEdges""#));
    }
    values_across(canvas, frame, across, |cell| frame.x + width * (cell as f64 + 0.5));
    let mut free = f64::INFINITY;
    for row in 0..rows {
        let y = frame.y + frame.height - height * (row as f64 + 0.5);
        if y + 8.0 <= free {
            let label = shortened(&up.label(row), UP_COLUMNS);
            canvas.text(Spot::new(frame.x - 9.0, y + 4.2), Anchor::End, &font(TEXT, palette::MUTED), &label);
            free = y - 8.0;
        }
    }
    across_name(canvas, frame, &across.key);
    upright(canvas, frame, &up.key);
    bar(canvas, frame, &scale.0);
    let note = match small {
        true => "small: nothing acceptable there; empty: no answer",
        false => "empty: no answer",
    };
    if small || cells.iter().any(|cell| shown(cell).is_none()) {
        let right = Spot::new(frame.x + frame.width, 66.0);
        canvas.text(right, Anchor::End, &font(TEXT, palette::MUTED), note);
    }
}

/// Draws the bar of colours with its numbers.
fn bar(canvas: &mut Canvas, frame: Area, scale: &Scale) {
    const STEPS: usize = 60;
    let (x, width, top, bottom) =
        (frame.x + frame.width + 30.0, 14.0, frame.y + 22.0, frame.y + frame.height);
    let y = |part: f64| bottom - (bottom - top) * part;
    for i in 0..STEPS {
        let [low, high] = [i, i + 1].map(|k| k as f64 / STEPS as f64);
        let area = Area { x, y: y(high), width, height: y(low) - y(high) + 0.4 };
        canvas.area(area, &format!(r#"fill="{}""#, colour(0.5 * (low + high))));
    }
    for tick in scale.ticks() {
        let at = Spot::new(x + width + 6.0, y(scale.part(tick)) + 4.2);
        canvas.text(at, Anchor::Start, &font(TEXT, palette::MUTED), &brief(tick, 3));
    }
    let name = Spot::new(x + 0.5 * width + 14.0, frame.y + 8.0);
    canvas.text(name, Anchor::Middle, &bold(TEXT, palette::INK), "rms error");
}
