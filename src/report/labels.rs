//! Placement of labels beside their points, where they hide least.

use super::canvas::{Spot, text_width};

/// The places on the canvas that are occupied already.
#[derive(Default)]
pub(super) struct Labels {
    /// The places of lines and marks, a few pixels apart.
    ink: Vec<Spot>,
    /// The middles and half sizes of labels.
    boxes: Vec<(Spot, f64, f64)>,
}

impl Labels {
    /// The number of directions that are tried around a point.
    const DIRECTIONS: usize = 16;
    /// The weight of hiding one mark, relative to turning away from the preferred direction.
    const MARK: f64 = 0.5;

    pub(super) fn mark(&mut self, spot: Spot) {
        self.ink.push(spot);
    }

    /// Marks every few pixels along a line.
    pub(super) fn mark_line(&mut self, a: Spot, b: Spot) {
        let steps = (a.distance(b) / 5.0).ceil().clamp(1.0, 400.0) as usize;
        for i in 0..=steps {
            let t = i as f64 / steps as f64;
            self.mark(Spot::new(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)));
        }
    }

    /// Returns the middle of the base line for `text` around `point` at `distance` from it, near the direction
    /// `towards` if that is free; `None` if every place would cover another label and `needed` is false.
    pub(super) fn place(
        &mut self,
        text: &str,
        font_size: f64,
        point: Spot,
        distance: f64,
        towards: Spot,
        needed: bool,
    ) -> Option<Spot> {
        let (half_width, half_height) = (0.5 * text_width(text, font_size), 0.42 * font_size);
        let wished = towards.y.atan2(towards.x);
        let mut best: Option<(f64, Spot)> = None;
        for i in 0..Self::DIRECTIONS * 2 {
            // The preferred direction first, then alternately to both sides; then all again farther away.
            let step = (i % Self::DIRECTIONS).div_ceil(2) as f64 * if i % 2 == 0 { 1.0 } else { -1.0 };
            let angle = wished + step * std::f64::consts::TAU / Self::DIRECTIONS as f64;
            let far = if i < Self::DIRECTIONS { distance } else { 1.7 * distance };
            let middle = Spot::new(
                point.x + (far + half_width) * angle.cos(),
                point.y + (far + half_height) * angle.sin(),
            );
            let covers = self.boxes.iter().any(|(other, w, h)| {
                (other.x - middle.x).abs() < w + half_width + 2.0
                    && (other.y - middle.y).abs() < h + half_height + 1.0
            });
            if covers && !needed {
                continue;
            }
            let hidden = self
                .ink
                .iter()
                .filter(|s| {
                    (s.x - middle.x).abs() < half_width + 2.0 && (s.y - middle.y).abs() < half_height + 2.0
                })
                .count();
            let cost = Self::MARK * hidden as f64
                + 0.15 * step.abs()
                + if i < Self::DIRECTIONS { 0.0 } else { 0.8 }
                + if covers { 100.0 } else { 0.0 };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, middle));
            }
        }
        let (_, middle) = best?;
        self.boxes.push((middle, half_width, half_height));
        Some(Spot::new(middle.x, middle.y + 0.36 * font_size))
    }
}
