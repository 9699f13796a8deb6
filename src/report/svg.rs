//! The drawing of one candidate: a self-contained SVG with the linkage, its coupler curve, the target and the figures.
//! A target that is small beside its linkage has an enlarged view of its own.

use super::beside;
use super::bodies::Posed;
use super::canvas::{
    Anchor, Area, Canvas, Frame, ROUND_ENDS, Spot, View, filled, font, outline, palette, stroke,
};
use super::figure::{Detail, draw};
use super::scene::{SAMPLES, Scene, circuits};
use super::text::{brief, capitalised, clean, shortened, significant, text_width};
use super::words;
use super::{function, output};
use crate::record::{Candidate, Record};
use crate::task::TaskKind;
use crate::task::spec::{TaskSpec, TransmissionOver};

const WIDTH: f64 = 900.0;
const MARGIN: f64 = 30.0;
/// The allowed heights of the drawing, which follows its shape.
const HEIGHTS: std::ops::RangeInclusive<f64> = 320.0..=620.0;
/// The padding for letters and stands around the geometry.
const PADDING: f64 = 34.0;
/// The fraction of the frame below which the target is drawn again, enlarged.
const SMALL_TARGET: f64 = 0.2;
/// The largest number of samples of the coupler curve in the enlarged view.
const MOST_SAMPLES: usize = 144_000;

/// Returns the drawing of `record.candidates[index]`; only the target if there is no such candidate.
pub fn candidate_svg(record: &Record, index: usize) -> String {
    drawing_svg(record, record.candidates.get(index))
}

/// Returns the drawing of a candidate that need not be among the ranked ones; only the target without one.
pub fn drawing_svg(record: &Record, candidate: Option<&Candidate>) -> String {
    let scene = Scene::new(record, candidate);
    let bounds = scene.bounds();
    let small = candidate.is_some() && scene.target_bounds().extent() < SMALL_TARGET * bounds.extent();
    let mut canvas = Canvas::default();

    let title = words::problem_name(record);
    let top = heading(&mut canvas, record, candidate, &title);
    let inner = WIDTH - 2.0 * MARGIN;
    let main_width = if small { 0.58 * inner } else { inner };
    let frame = Frame { width: main_width, padding: PADDING, heights: HEIGHTS };
    let (view, height) = frame.fit(&bounds.padded(0.0), Spot::new(MARGIN, top));

    let target_weight = if small { 0.5 } else { 1.0 };
    let all = Detail { target_weight, numbers: !small, ..Detail::lettered(1.0) };
    draw(&mut canvas, &scene, &view, all);
    if small {
        let side = 0.38 * inner;
        let panel = Area {
            x: WIDTH - MARGIN - side,
            y: top + 0.5 * (height - side.min(height)),
            width: side,
            height: side.min(height),
        };
        enlarged(&mut canvas, record, candidate, &scene, &view, panel);
    }

    let footer = top + height + 26.0;
    canvas.scale_bar(Spot::new(MARGIN, footer), &view, 0.25 * main_width, &words::unit_suffix(record));
    let task = &record.problem.resolved.task;
    legend(&mut canvas, footer, candidate.is_some(), task);
    let mut bottom = caption(&mut canvas, record, candidate, &scene, footer + 34.0);
    if let Some(candidate) = candidate {
        let area = Area { x: MARGIN, y: bottom + 12.0, width: WIDTH - 2.0 * MARGIN, height: 0.0 };
        bottom += function::charts(&mut canvas, record, candidate, area).map_or(0.0, |height| 12.0 + height);
    }
    let description = candidate.map_or("the target alone".to_owned(), |c| figures(record, c).join("; "));
    canvas.document(WIDTH, bottom + 18.0, &format!("{title}, {}", standing(record, candidate)), &description)
}

/// Returns a text such as `candidate 1 of 5`.
fn standing(record: &Record, candidate: Option<&Candidate>) -> String {
    candidate.map_or("no candidate".to_owned(), |c| words::standing(record, c))
}

/// Draws title, rank and source; returns the height at which the drawing starts.
fn heading(canvas: &mut Canvas, record: &Record, candidate: Option<&Candidate>, title: &str) -> f64 {
    canvas.title([MARGIN, WIDTH - MARGIN], 42.0, (title, 21.0), (&standing(record, candidate), 14.0));
    match record.problem.source.as_deref().map(clean).filter(|source| !source.is_empty()) {
        Some(source) => {
            line(canvas, 63.0, palette::MUTED, &source);
            76.0
        }
        None => 56.0,
    }
}

/// Writes a line over the whole width, cut to it.
fn line(canvas: &mut Canvas, y: f64, colour: &str, text: &str) {
    let room = ((WIDTH - 2.0 * MARGIN) / text_width("x", 13.0)) as usize;
    canvas.text(Spot::new(MARGIN, y), Anchor::Start, &font(13, colour), &shortened(text, room));
}

/// Draws the target and the curve beside it, in a panel that is connected to its place in the drawing.
fn enlarged(
    canvas: &mut Canvas,
    record: &Record,
    candidate: Option<&Candidate>,
    scene: &Scene,
    view: &View,
    panel: Area,
) {
    let bounds = scene.target_bounds().padded(0.06);
    let inside = Area { x: 0.0, y: 0.0, width: panel.width, height: panel.height };
    let zoom = View::fit(&bounds, inside.shrunk(PADDING));
    // The area that the panel shows, in the drawing.
    let centre = view.spot(bounds.centre());
    let [width, height] = [panel.width, panel.height].map(|side| side / zoom.scale * view.scale);
    let shown = Area { x: centre.x - 0.5 * width, y: centre.y - 0.5 * height, width, height };
    canvas.area(shown, &outline(palette::MUTED, 1));
    for (dy_shown, dy_panel) in [(0.0, 0.0), (shown.height, panel.height)] {
        let from = Spot::new(shown.x + shown.width, shown.y + dy_shown);
        let to = Spot::new(panel.x, panel.y + dy_panel);
        canvas.line(from, to, &stroke(palette::FAINT, 1));
    }

    let ratio = scene.bounds().extent() / bounds.extent().max(f64::MIN_POSITIVE);
    let samples = (SAMPLES as f64 * ratio).clamp(SAMPLES as f64, MOST_SAMPLES as f64) as usize;
    let part = Scene { circuits: candidate.map_or(Vec::new(), |c| circuits(c, samples)), ..scene.clone() };
    let mut within = Canvas::default();
    within.area(inside, &format!(r#"fill="{}""#, palette::PAPER));
    let clip = Some(bounds.padded(1.0));
    draw(&mut within, &part, &zoom, Detail { numbers: true, linkage: false, clip, ..Detail::small(1.0) });
    let unit = words::unit_suffix(record);
    within.scale_bar(Spot::new(14.0, panel.height - 14.0), &zoom, 0.3 * panel.width, &unit);
    let label = format!("target, {} times as large", brief(zoom.scale / view.scale, 2));
    let muted = font(12, palette::MUTED);
    within.text(Spot::new(panel.width - 10.0, 19.0), Anchor::End, &muted, &label);
    canvas.clipped(panel, |canvas| canvas.body.push_str(&within.body));
    canvas.area(panel, &(outline(palette::MUTED, 1.2) + r#" rx="3""#));
}

/// Draws the legend of the marks, from the right.
fn legend(canvas: &mut Canvas, y: f64, with_curve: bool, task: &TaskSpec) {
    let (of_motion, of_function) = (task.is_motion(), task.is_function());
    let text = font(12, palette::INK);
    let mut x = WIDTH - MARGIN;
    if with_curve {
        let curve = match task.kind() {
            TaskKind::Motion => "curve of its point",
            TaskKind::Function => "way of the output's pin",
            TaskKind::Path => "coupler curve",
        };
        x -= text_width(curve, 12.0);
        canvas.text(Spot::new(x, y), Anchor::Start, &text, curve);
        let line = stroke(palette::CURVE, 2.4) + ROUND_ENDS;
        canvas.line(Spot::new(x - 30.0, y - 4.0), Spot::new(x - 8.0, y - 4.0), &line);
        x -= 50.0;
    }
    if of_motion {
        let mut frame = |label: &str, wanted: bool| {
            x -= text_width(label, 12.0);
            canvas.text(Spot::new(x, y), Anchor::Start, &text, label);
            let posed = Posed { at: Spot::new(x - 28.0, y - 2.0), angle: 0.0 };
            match wanted {
                true => posed.outlined(canvas, 20.0, palette::TARGET, 1.0),
                false => posed.filled(canvas, 20.0, palette::CURVE),
            }
            x -= 52.0;
        };
        if with_curve {
            frame("body generated", false);
        }
        frame("body wanted", true);
    }
    let first = match (of_motion, of_function) {
        (true, _) => "pose 0",
        (_, true) => "pair 0",
        _ => "target point 0",
    };
    let marks = [(if of_function { "pairs" } else { "target" }, "none", 4.6), (first, palette::TARGET, 5.4)];
    // The ring of a pose is at the origin of its frame.
    for (label, fill, radius) in marks.into_iter().skip(usize::from(of_motion)) {
        x -= text_width(label, 12.0);
        canvas.text(Spot::new(x, y), Anchor::Start, &text, label);
        let mark = filled(fill, palette::TARGET, 1.7);
        canvas.circle(Spot::new(x - 13.0, y - 4.0), radius, &mark);
        x -= 38.0;
    }
}

/// Returns the figures in words: errors, then the linkage.
fn figures(record: &Record, candidate: &Candidate) -> [String; 2] {
    let (unit, noun) = (words::error_unit(record), record.problem.resolved.task.noun());
    let (error, transmission) = (&candidate.error, &candidate.transmission_deg);
    let more = match words::angle_errors(candidate) {
        Some(angle) => format!(", {angle}"),
        None if error.output.is_some() => String::new(),
        None => format!(", rms to the curve {}{unit}", significant(error.to_curve.rms, 4)),
    };
    [
        format!(
            "rms error {}{unit}, largest {}{unit} at {noun} {}{more}",
            significant(error.rms, 4),
            significant(error.max, 4),
            error.max_at,
        ),
        format!(
            "{}, worst transmission angle {}° ({}), link ratio {}, {}",
            candidate.type_name(),
            significant(transmission.worst, 3),
            match transmission.over {
                TransmissionOver::Cycle => "full turn",
                TransmissionOver::Used => "part used",
            },
            significant(candidate.link_ratio, 3),
            words::verdict(record, candidate).replacen("no:", "not accepted:", 1)
        ),
    ]
}

/// Draws the figures under the drawing; returns the height at which they end.
fn caption(
    canvas: &mut Canvas,
    record: &Record,
    candidate: Option<&Candidate>,
    scene: &Scene,
    top: f64,
) -> f64 {
    let mut lines = candidate.map_or(Vec::new(), |c| figures(record, c).to_vec());
    if let Some(pose) = &scene.pose {
        let noun = record.problem.resolved.task.noun();
        let drawn = pose.target.map_or(format!("drawn at no target {noun}: the loop is open there"), |j| {
            format!("drawn at {noun} {j}")
        });
        if let Some(last) = lines.last_mut() {
            last.push_str(&format!("; {drawn}"));
        }
    } else if candidate.is_some() {
        lines.push("the links of this candidate cannot be joined".to_owned());
    } else {
        lines.push("no linkage to draw".to_owned());
    }
    lines.extend(
        candidate
            .and_then(|c| output::offsets(c, &words::unit_suffix(record)))
            .map(|said| capitalised(&said)),
    );
    lines.extend(candidate.map(beside::warnings).filter(|text| !text.is_empty()));
    let y = |i: usize| top + 19.0 * i as f64;
    lines.iter().enumerate().for_each(|(i, text)| line(canvas, y(i), palette::INK, text));
    y(lines.len()) - 19.0
}
