//! A small plot for the terminal: the target points and the coupler curve, with one scale for both axes.

use super::scene::{Bounds, Scene, round_length};
use super::text::brief;
use super::words;
use crate::mechanism::Complex;
use crate::record::Record;

/// The characters with which a plot is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Glyphs {
    /// Braille characters, eight dots in each.
    #[default]
    Braille,
    /// ASCII characters only.
    Ascii,
}

/// The allowed sizes of a plot, in characters.
const WIDTHS: (usize, usize) = (16, 400);
const HEIGHTS: (usize, usize) = (4, 200);

/// The largest number of target points that are marked, evenly chosen.
const MOST_MARKS: usize = 40;
/// The indentation of every line.
const INDENT: usize = 2;

/// The fraction of its curve below which a target fills the plot, so that the curve runs out of it.
const SMALL_TARGET: f64 = 0.2;

/// Returns the target points and the coupler curve of `record.candidates[index]` (without such a candidate only the
/// points), at most `width` by `height` characters with a legend in the line below. A character is assumed to be twice
/// as high as wide.
pub fn terminal_plot(record: &Record, index: usize, width: usize, height: usize, glyphs: Glyphs) -> String {
    let scene = Scene::new(record, record.candidates.get(index));
    if scene.targets.is_empty() {
        return "  nothing to plot\n".to_owned();
    }
    let target = scene.target_bounds();
    let whole = scene.curve_bounds();
    let small = target.extent() < SMALL_TARGET * whole.extent();
    let bounds = if small { target.padded(0.5) } else { whole };
    let mut raster = Raster::fit(
        &bounds,
        width.clamp(WIDTHS.0, WIDTHS.1) - INDENT,
        height.clamp(HEIGHTS.0 + 1, HEIGHTS.1) - 1,
        glyphs,
    );
    for circuit in &scene.circuits {
        for (i, joints) in circuit.iter().enumerate() {
            let next = circuit[(i + 1) % circuit.len()].coupler_point;
            raster.line(joints.coupler_point, next);
        }
    }
    let (first, other, rule, curve) = match glyphs {
        Glyphs::Braille => ('●', '○', "─", "  ⠤⠒ coupler curve"),
        Glyphs::Ascii => ('@', 'o', "-", "  . coupler curve"),
    };
    let of_function = record.problem.resolved.task.is_function();
    let of_pin = curve.replace("coupler curve", "way of the output's pin");
    let is_four_bar = record.candidates.first().is_none_or(|c| c.linkage.four_bar().is_some());
    let of_pin = if is_four_bar { of_pin.replace("output's", "follower's") } else { of_pin };
    let curve = if of_function { of_pin.as_str() } else { curve };
    // Marking many points would hide the curve. The first one is marked last, so that no other one hides it.
    let every = scene.targets.len().div_ceil(MOST_MARKS);
    for point in scene.targets.iter().rev().filter(|point| point.index % every == 0) {
        raster.mark(point.at, if point.index == 0 { first } else { other });
    }
    let mut out = raster.render();
    let curve = if scene.circuits.is_empty() { "" } else { curve };
    let thinned = if every > 1 { format!(", 1 in {every}") } else { String::new() };
    let columns = 10.0_f64.min(raster.columns as f64);
    let length = round_length(columns * raster.unit_of_column());
    let count = (length / raster.unit_of_column()).round().max(1.0) as usize;
    let ruler = rule.repeat(count);
    out.push_str(&format!(
        "{:INDENT$}{other} target{thinned}  {first} {} 0{curve}  {ruler} {}{}\n",
        "",
        record.problem.resolved.task.noun(),
        brief(length, 3),
        words::unit_suffix(record)
    ));
    out
}

/// A raster: dots in character cells.
struct Raster {
    columns: usize,
    rows: usize,
    glyphs: Glyphs,
    /// The number of dots per unit of length, and the plane's point at the middle of the raster.
    scale: f64,
    centre: Complex,
    cells: Vec<char>,
}

impl Raster {
    /// Returns the number of dots in a cell, across and down.
    fn dots(glyphs: Glyphs) -> (usize, usize) {
        match glyphs {
            Glyphs::Braille => (2, 4),
            Glyphs::Ascii => (1, 1),
        }
    }

    /// Returns the height of a dot divided by its width: a cell is twice as high as wide.
    fn aspect(glyphs: Glyphs) -> f64 {
        let (across, down) = Self::dots(glyphs);
        2.0 * across as f64 / down as f64
    }

    /// Returns a raster in the shape of the box, at most `columns` by `rows`.
    fn fit(bounds: &Bounds, columns: usize, rows: usize, glyphs: Glyphs) -> Self {
        let (across, down) = Self::dots(glyphs);
        let aspect = Self::aspect(glyphs);
        let wide = (columns * across - 1) as f64;
        let high = (rows * down - 1) as f64 * aspect;
        let scale = (wide / bounds.width()).min(high / bounds.height());
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let cells = |length: f64, dots: usize, most: usize| {
            (((length * scale).round() as usize).saturating_add(1)).div_ceil(dots).clamp(1, most)
        };
        let columns = cells(bounds.width(), across, columns);
        let rows = cells(bounds.height() / aspect, down, rows);
        Raster { columns, rows, glyphs, scale, centre: bounds.centre(), cells: vec![' '; columns * rows] }
    }

    fn unit_of_column(&self) -> f64 {
        Self::dots(self.glyphs).0 as f64 / self.scale
    }

    /// Returns the position in dots across and down, not rounded.
    fn place(&self, p: Complex) -> (f64, f64) {
        let (across, down) = Self::dots(self.glyphs);
        let x = 0.5 * ((self.columns * across - 1) as f64) + self.scale * (p.re - self.centre.re);
        let y = 0.5 * ((self.rows * down - 1) as f64)
            - self.scale * (p.im - self.centre.im) / Self::aspect(self.glyphs);
        (x, y)
    }

    /// Returns the cell of a dot and the dot's place in it; `None` outside.
    fn cell(&self, x: f64, y: f64) -> Option<(usize, usize, usize)> {
        let (across, down) = Self::dots(self.glyphs);
        let (x, y) = (x.round(), y.round());
        if !(x >= 0.0 && y >= 0.0 && x < (self.columns * across) as f64 && y < (self.rows * down) as f64) {
            return None;
        }
        let (x, y) = (x as usize, y as usize);
        Some(((y / down) * self.columns + x / across, x % across, y % down))
    }

    fn line(&mut self, from: Complex, to: Complex) {
        let ((x, y), (to_x, to_y)) = (self.place(from), self.place(to));
        let steps = (to_x - x).abs().max((to_y - y).abs()).ceil();
        // A longer chord runs far outside: its ends are enough.
        let steps = if steps.is_finite() && steps < 4096.0 { steps.max(1.0) as usize } else { 1 };
        for i in 0..=steps {
            let t = i as f64 / steps as f64;
            if let Some((cell, column, row)) = self.cell(x + t * (to_x - x), y + t * (to_y - y)) {
                // Dots 1 2 3 7 down the left, 4 5 6 8 down the right.
                const DOTS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];
                const NO_DOT: u32 = 0x2800;
                let dots = u32::from(self.cells[cell]).max(NO_DOT) | DOTS[column][row];
                let braille = self.glyphs == Glyphs::Braille;
                self.cells[cell] = char::from_u32(dots).filter(|_| braille).unwrap_or('.');
            }
        }
    }

    fn mark(&mut self, p: Complex, glyph: char) {
        let (x, y) = self.place(p);
        if let Some((cell, ..)) = self.cell(x, y) {
            self.cells[cell] = glyph;
        }
    }

    fn render(&self) -> String {
        let mut out = String::new();
        for row in self.cells.chunks(self.columns) {
            let line: String = row.iter().collect();
            out.push_str(format!("{:INDENT$}{line}", "").trim_end());
            out.push('\n');
        }
        out
    }
}
