//! The scatter plot of a front: the second axis across, the first one up, the third as the colour of the marks.

use crate::record::{Axis, Front, Record};
use crate::report::canvas::{Anchor, Area, Canvas, Spot, Vec2, bold, filled, font, outline, palette, px};
use crate::report::front::in_words;
use crate::report::labels::Beside;
use crate::report::scale::{LOGARITHMIC, Scale, colour};
use crate::report::text::{brief, capitalised, xml};
use crate::report::words;

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 470.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 58.0;
/// The room at the right, with and without the bar of colours.
const RIGHT: [f64; 2] = [132.0, 30.0];
const RADIUS: f64 = 7.5;
const KNEE_RADIUS: f64 = 12.5;
/// Errors below this part of the largest one are drawn at the lower end.
const LEAST_ERROR: f64 = 1e-9;

/// Returns the plot as an SVG document. Of four axes the last is left to the table.
pub(super) fn scatter_svg(record: &Record, front: &Front) -> String {
    let plot = Plot::new(record, front);
    let mut canvas = Canvas::default();
    plot.grid(&mut canvas);
    plot.marks(&mut canvas, front);
    if let Some((axis, scale, _)) = &plot.third {
        bar(&mut canvas, *axis, scale, &plot.unit);
    }
    let title = format!("Front of {}", words::problem_name(record));
    canvas.document(WIDTH, HEIGHT, &title, &crate::report::front::meaning(front))
}

/// An axis of the plot with its scale and the figures on it.
type Scaled = (Axis, Scale, Vec<f64>);

/// The axes of the plot.
struct Plot {
    up: Scaled,
    across: Scaled,
    third: Option<Scaled>,
    unit: String,
    right: f64,
}

fn is_error(axis: Axis) -> bool {
    matches!(axis, Axis::Rms | Axis::Max)
}

impl Plot {
    fn new(record: &Record, front: &Front) -> Plot {
        let scaled = |axis: Axis| -> Scaled {
            let mut values: Vec<f64> = front.members.iter().map(|m| m.figures.of(axis)).collect();
            if is_error(axis) {
                let least = LEAST_ERROR * values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
                values.iter_mut().for_each(|value| *value = value.max(least));
            }
            let ratio = match axis {
                Axis::Rms | Axis::Max => 1.0,
                Axis::Transmission => f64::INFINITY,
                _ => LOGARITHMIC,
            };
            (axis, Scale::new(&values, ratio), values)
        };
        let axis = |i: usize| front.axes.get(i).copied();
        let third = axis(2).map(scaled);
        Plot {
            up: scaled(axis(0).unwrap_or(Axis::Rms)),
            across: scaled(axis(1).unwrap_or(Axis::Transmission)),
            right: WIDTH - if third.is_some() { RIGHT[0] } else { RIGHT[1] },
            third,
            unit: words::unit_suffix(record),
        }
    }

    fn x(&self, value: f64) -> f64 {
        LEFT + (self.right - LEFT) * self.across.1.part(value)
    }

    fn y(&self, value: f64) -> f64 {
        HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * self.up.1.part(value)
    }

    /// Draws the lines of round values, their numbers and the names of both axes.
    fn grid(&self, canvas: &mut Canvas) {
        let faint = outline(palette::FAINT, 0.8);
        let muted = font(12.5, palette::MUTED);
        for tick in self.across.1.ticks() {
            let x = self.x(tick);
            canvas.line(Spot::new(x, TOP), Spot::new(x, HEIGHT - BOTTOM), &faint);
            let text = number(self.across.0, tick);
            canvas.text(Spot::new(x, HEIGHT - BOTTOM + 19.0), Anchor::Middle, &muted, &text);
        }
        for tick in self.up.1.ticks() {
            let y = self.y(tick);
            canvas.line(Spot::new(LEFT, y), Spot::new(self.right, y), &faint);
            canvas.text(Spot::new(LEFT - 9.0, y + 4.2), Anchor::End, &muted, &number(self.up.0, tick));
        }
        let ink = bold(13, palette::INK);
        let across = named(&self.across, &self.unit);
        canvas.text(Spot::new(0.5 * (LEFT + self.right), HEIGHT - 14.0), Anchor::Middle, &ink, &across);
        let up = xml(&named(&self.up, &self.unit));
        canvas.raw(&format!(
            r#"<text transform="translate(20 {}) rotate(-90)" text-anchor="middle" {ink}>{up}</text>"#,
            px(0.5 * (TOP + HEIGHT - BOTTOM))
        ));
    }

    /// Draws a mark for each member, which leads to its drawing, with a ring at knees and a number beside.
    fn marks(&self, canvas: &mut Canvas, front: &Front) {
        let spots: Vec<Spot> = (0..front.members.len())
            .map(|i| Spot::new(self.x(self.across.2[i]), self.y(self.up.2[i])))
            .collect();
        for (i, (spot, member)) in spots.iter().zip(&front.members).enumerate() {
            let colour = self
                .third
                .as_ref()
                .map_or(palette::CURVE.to_owned(), |(_, scale, values)| colour(scale.part(values[i])));
            canvas.raw(&format!(r##"<a href="#linkage-{}">"##, i + 1));
            if member.knee {
                canvas.circle(*spot, KNEE_RADIUS, &outline(palette::TARGET, 2.2));
            }
            canvas.circle(*spot, RADIUS, &filled(&colour, palette::PAPER, 1.4));
            canvas.raw("</a>");
            // The marks are places that labels avoid.
            for step in 0..8 {
                let angle = f64::from(step) * std::f64::consts::FRAC_PI_4;
                canvas.labels.mark(*spot + 0.7 * RADIUS * Vec2::new(angle.cos(), angle.sin()));
            }
        }
        for (i, (spot, member)) in spots.iter().zip(&front.members).enumerate() {
            let distance = if member.knee { KNEE_RADIUS + 1.0 } else { RADIUS + 1.0 };
            let towards = Vec2::new(0.6, -0.8);
            let beside = Beside { point: *spot, distance, towards, needed: true };
            canvas.label(&(i + 1).to_string(), 12.0, &bold(12, palette::INK), beside);
        }
    }
}

/// Returns the name of an axis with its unit and its good end.
fn named((axis, scale, _): &Scaled, unit: &str) -> String {
    let unit = match axis {
        Axis::Transmission | Axis::LinkRatio | Axis::Sensitivity => "",
        Axis::PeakTorque => "N m",
        Axis::Rms | Axis::Max | Axis::Extent | Axis::Longest => unit,
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" [{}]", unit.trim()) };
    let logarithmic = if scale.logarithmic { ", logarithmic" } else { "" };
    let good = if *axis == Axis::Transmission { "large" } else { "small" };
    format!("{}{unit}{logarithmic} ({good} is good)", capitalised(in_words(*axis)))
}

fn number(axis: Axis, value: f64) -> String {
    let degrees = if axis == Axis::Transmission { "°" } else { "" };
    format!("{}{degrees}", brief(value, 3))
}

/// Draws the bar of colours with the numbers of the third axis.
fn bar(canvas: &mut Canvas, axis: Axis, scale: &Scale, unit: &str) {
    const STEPS: usize = 60;
    let (x, width, top, bottom) = (WIDTH - RIGHT[0] + 34.0, 14.0, TOP + 24.0, HEIGHT - BOTTOM);
    let y = |part: f64| bottom - (bottom - top) * part;
    for i in 0..STEPS {
        let [low, high] = [i, i + 1].map(|k| k as f64 / STEPS as f64);
        let area = Area { x, y: y(high), width, height: y(low) - y(high) + 0.4 };
        canvas.area(area, &format!(r#"fill="{}""#, colour(0.5 * (low + high))));
    }
    for tick in scale.ticks() {
        let at = Spot::new(x + width + 6.0, y(scale.part(tick)) + 4.2);
        canvas.text(at, Anchor::Start, &font(12.5, palette::MUTED), &number(axis, tick));
    }
    let unit = match axis {
        Axis::Transmission | Axis::LinkRatio | Axis::Sensitivity => "",
        Axis::PeakTorque => "N m",
        Axis::Rms | Axis::Max | Axis::Extent | Axis::Longest => unit.trim(),
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    let good = if axis == Axis::Transmission { "large" } else { "small" };
    let middle = x + 0.5 * width + 14.0;
    let name = format!("{}{unit}", capitalised(in_words(axis)));
    canvas.text(Spot::new(middle, top - 26.0), Anchor::Middle, &bold(12.5, palette::INK), &name);
    let good = format!("{good} is good");
    canvas.text(Spot::new(middle, top - 11.0), Anchor::Middle, &font(11.5, palette::MUTED), &good);
}
