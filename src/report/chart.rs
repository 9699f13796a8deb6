//! A chart of a few series against the crank angle.

use crate::report::canvas::{
    Anchor, Area, Canvas, ROUND_CORNERS, Spot, Vec2, bold, font, outline, palette, px, stroke,
};
use crate::report::scene::round_length;
use crate::report::text::{brief, text_width, xml};

/// A series: values at crank angles, in the order of the angles.
pub(in crate::report) struct Series {
    pub(in crate::report) name: &'static str,
    pub(in crate::report) colour: &'static str,
    /// The stretches without a gap, (crank angle in degrees, value).
    pub(in crate::report) strands: Vec<Vec<(f64, f64)>>,
}

impl Series {
    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.strands.iter().flatten().map(|(_, y)| *y).filter(|y| y.is_finite())
    }
}

/// The range of the vertical axis.
#[derive(Clone, Copy)]
pub(in crate::report) enum Range {
    /// Fixed bounds, with ticks this far apart.
    Fixed { low: f64, high: f64, tick: f64 },
    /// The range of the values, or about `natural` wide if they are constant; angles have ticks at parts of a turn. If
    /// values may grow without bound, the few that do are cut off.
    Fitted { natural: f64, angle: bool, unbounded: bool },
}

/// The horizontal axis that all charts of a sheet share.
pub(in crate::report) struct Abscissa {
    pub(in crate::report) low: f64,
    pub(in crate::report) high: f64,
    /// The ranges of crank angles out of reach, within [low, high].
    pub(in crate::report) unreachable: Vec<(f64, f64)>,
    /// The crank angles of toggles, within [low, high].
    pub(in crate::report) toggles: Vec<f64>,
}

pub(in crate::report) struct Chart {
    pub(in crate::report) title: &'static str,
    pub(in crate::report) unit: String,
    pub(in crate::report) series: Vec<Series>,
    pub(in crate::report) range: Range,
    /// The ranges of values that are shaded as a warning.
    pub(in crate::report) warning: Vec<(f64, f64)>,
}

/// The space for the numbers left of and below the plot, and for the title above.
const LEFT: f64 = 58.0;
const BELOW: f64 = 22.0;
const ABOVE: f64 = 26.0;

/// The factor of flattening above which peaks are cut off.
const WORTH_CUTTING: f64 = 3.0;

/// The possible steps of an axis in degrees.
const DEGREE_STEPS: [f64; 13] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0];

impl Chart {
    pub(in crate::report) fn draw(&self, canvas: &mut Canvas, abscissa: &Abscissa, area: Area) {
        let plot = Area {
            x: area.x + LEFT,
            y: area.y + ABOVE,
            width: area.width - LEFT - 8.0,
            height: area.height - ABOVE - BELOW,
        };
        let (low, high, tick, cut) = self.vertical();
        let x_of = |x: f64| plot.width * (x - abscissa.low) / (abscissa.high - abscissa.low);
        let y_of = |y: f64| plot.height * (1.0 - (y - low) / (high - low));
        self.heading(canvas, &area, &plot, cut);

        // Curves that could run out of the plot are clipped to it.
        canvas
            .clipped(plot, |canvas| self.curves(canvas, abscissa, (low, high, tick), (&x_of, &y_of), &plot));
        canvas.area(plot, &outline(palette::MUTED, 1));
        numbers(canvas, &plot, (low, high, tick), y_of);
        crank_angles(canvas, &plot, abscissa, x_of);
    }

    /// Draws warnings, unreachable ranges, ticks, toggles and the series.
    fn curves(
        &self,
        canvas: &mut Canvas,
        abscissa: &Abscissa,
        (low, high, tick): (f64, f64, f64),
        (x_of, y_of): (&dyn Fn(f64) -> f64, &dyn Fn(f64) -> f64),
        plot: &Area,
    ) {
        for (from, to) in &self.warning {
            let band =
                Area { x: 0.0, y: y_of(*to), width: plot.width, height: (y_of(*from) - y_of(*to)).max(0.0) };
            canvas.area(band, &format!(r#"fill="{}" fill-opacity="0.12""#, palette::TARGET));
        }
        for (from, to) in &abscissa.unreachable {
            let (left, right) = (x_of(*from), x_of(*to));
            let shade = Area { x: left, y: 0.0, width: (right - left).max(0.0), height: plot.height };
            canvas.area(shade, &format!(r#"fill="{}" fill-opacity="0.35""#, palette::FAINT));
            if right - left > 34.0 {
                let at = Spot::new(0.5 * (left + right), 15.0);
                canvas.text(at, Anchor::Middle, &muted(11), "open");
            }
        }
        for value in ticks(low, high, tick) {
            let (colour, width) = if value == 0.0 { (palette::MUTED, 1.0) } else { (palette::FAINT, 0.6) };
            let y = y_of(value);
            canvas.line(Spot::new(0.0, y), Spot::new(plot.width, y), &stroke(colour, width));
        }
        for toggle in &abscissa.toggles {
            let x = x_of(*toggle);
            let line = stroke(palette::TARGET_TEXT, 1) + r#" stroke-dasharray="4 3""#;
            canvas.line(Spot::new(x, 0.0), Spot::new(x, plot.height), &line);
        }
        for (i, series) in self.series.iter().enumerate() {
            let attributes = outline(series.colour, 1.8) + ROUND_CORNERS + dashes(i);
            // Values without a line between them are seen beside another series.
            let is_dotted = series.strands.iter().all(|strand| strand.len() == 1);
            let diameter = if is_dotted && series.strands.len() > 1 { 5.5 } else { 3.0 };
            for strand in &series.strands {
                // Values far outside are moved nearer, to coordinates that viewers can read.
                let far = 4.0 * plot.height;
                let spots: Vec<Spot> =
                    strand.iter().map(|(x, y)| Spot::new(x_of(*x), y_of(*y).clamp(-far, far))).collect();
                match spots.as_slice() {
                    [only] => canvas.dots(&[*only], diameter, series.colour),
                    _ => canvas.path(&spots, false, &attributes),
                }
            }
        }
    }

    /// Draws title and unit at the left, and the names of the series at the right.
    fn heading(&self, canvas: &mut Canvas, area: &Area, plot: &Area, cut: bool) {
        let y = area.y + 17.0;
        let bold = bold(12.5, palette::INK);
        let note = if cut { format!("{}, peaks at toggles cut off", self.unit) } else { self.unit.clone() };
        let ([x, at], title, note) = ([area.x, y].map(px), xml(self.title), xml(&note));
        canvas.raw(&format!(
            r#"<text x="{x}" y="{at}" {bold}>{title}<tspan dx="7" font-weight="400">{note}</tspan></text>"#
        ));
        if self.series.len() < 2 {
            return;
        }
        let mut x = plot.x + plot.width;
        for (i, series) in self.series.iter().enumerate().rev() {
            let text = font(12, palette::INK);
            canvas.text(Spot::new(x, y), Anchor::End, &text, series.name);
            x -= text_width(series.name, 12.0) + 9.0;
            let line = stroke(series.colour, 2.2) + dashes(i);
            canvas.line(Spot::new(x - 17.0, y - 4.0), Spot::new(x, y - 4.0), &line);
            x -= 30.0;
        }
    }

    /// Returns the lower and upper bound, the distance of ticks, and whether values lie outside.
    fn vertical(&self) -> (f64, f64, f64, bool) {
        let (natural, angle, unbounded) = match self.range {
            Range::Fixed { low, high, tick } => return (low, high, tick, false),
            Range::Fitted { natural, angle, unbounded } => (natural, angle, unbounded),
        };
        let mut values: Vec<f64> = self.series.iter().flat_map(Series::values).collect();
        values.sort_by(f64::total_cmp);
        let (Some(&least), Some(&greatest)) = (values.first(), values.last()) else {
            return (0.0, 1.0, 0.5, false);
        };
        let natural = if natural > 0.0 && natural.is_finite() { natural } else { 1.0 };
        let (mut low, mut high) = (least, greatest);
        if unbounded {
            // The range of nine values in ten, and as much again on both sides.
            let part = |t: f64| values[(t * (values.len() - 1) as f64).round() as usize];
            let (from, to) = (part(0.05), part(0.95));
            let spread = (to - from).max(1e-3 * natural);
            let kept = (low.max(from - spread), high.min(to + spread));
            if high - low > WORTH_CUTTING * (kept.1 - kept.0) {
                (low, high) = kept;
            }
        }
        let cut = least < low || greatest > high;
        if high - low < 1e-6 * natural.max(low.abs()).max(high.abs()) {
            let middle = 0.5 * (low + high);
            // Rounding noise about zero is set to zero.
            let middle = if middle.abs() < 1e-6 * natural { 0.0 } else { middle };
            let half = 0.5 * natural.max(middle.abs());
            (low, high) = (middle - half, middle + half);
        }
        if low > 0.0 && low < 0.35 * high {
            low = 0.0;
        }
        let tick = if angle { degree_step((high - low) / 4.5) } else { round_length((high - low) / 3.0) };
        ((low / tick).floor() * tick, (high / tick).ceil() * tick, tick, cut)
    }
}

/// Returns the dashes of a series: the second one is dashed, so that two that coincide are both seen.
fn dashes(index: usize) -> &'static str {
    if index == 0 { "" } else { r#" stroke-dasharray="7 3""# }
}

fn muted(size: u8) -> String {
    font(size, palette::MUTED)
}

/// Returns the smallest step of degrees that is at least `least`.
fn degree_step(least: f64) -> f64 {
    let found = DEGREE_STEPS.into_iter().find(|step| *step >= least);
    found.unwrap_or_else(|| 360.0 * round_length(2.0 * least / 360.0).max(1.0))
}

/// Returns the multiples of the step in [low, high], at most 60 of them.
fn ticks(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let slack = 1e-6;
    let first = (low / step - slack).ceil();
    let multiples = (0..60).map(move |i| first + f64::from(i));
    multiples.take_while(move |k| *k <= high / step + slack).map(move |k| k * step)
}

/// Returns a tick's number with as many digits as are needed to distinguish it from its neighbours.
fn label(value: f64, step: f64) -> String {
    let digits = ((value.abs() / step).max(1.0).log10().floor() + 2.0).clamp(2.0, 15.0) as usize;
    brief(value, digits).replace('-', "−")
}

fn numbers(canvas: &mut Canvas, plot: &Area, (low, high, tick): (f64, f64, f64), y_of: impl Fn(f64) -> f64) {
    for value in ticks(low, high, tick) {
        let at = Spot::new(plot.x - 6.0, plot.y + y_of(value) + 4.0);
        canvas.text(at, Anchor::End, &muted(11), &label(value, tick));
    }
}

fn crank_angles(canvas: &mut Canvas, plot: &Area, abscissa: &Abscissa, x_of: impl Fn(f64) -> f64) {
    let step = degree_step((abscissa.high - abscissa.low) / 7.0);
    let y = plot.y + plot.height;
    for value in ticks(abscissa.low, abscissa.high, step) {
        let at = Spot::new(plot.x + x_of(value), y);
        canvas.line(at, at + Vec2::new(0.0, 4.0), &stroke(palette::MUTED, 1));
        let below = at + Vec2::new(0.0, 16.0);
        canvas.text(below, Anchor::Middle, &muted(11), &format!("{}°", label(value, step)));
    }
}
