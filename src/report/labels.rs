//! Placement of labels beside their points, where they hide least.

use super::text::text_width;
use kurbo::{Point as Spot, Vec2};

/// The places on the canvas that are occupied already.
#[derive(Default)]
pub(super) struct Labels {
    /// The places of lines and marks, a few pixels apart.
    ink: Vec<Spot>,
    /// The middles and half sizes of labels.
    boxes: Vec<(Spot, Vec2)>,
}

/// The place that is wished for a label.
#[derive(Clone, Copy)]
pub(super) struct Beside {
    pub(super) point: Spot,
    /// The distance of the label from the point, in pixels.
    pub(super) distance: f64,
    /// The preferred direction.
    pub(super) towards: Vec2,
    /// Whether the label is written even if every place would cover another one.
    pub(super) needed: bool,
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
        (0..=steps).for_each(|i| self.mark(a.lerp(b, i as f64 / steps as f64)));
    }

    /// Marks points of a path, a few pixels apart.
    pub(super) fn mark_path(&mut self, spots: &[Spot]) {
        let mut last: Option<Spot> = None;
        for &spot in spots {
            if last.is_none_or(|last| last.distance(spot) >= 4.0) {
                self.mark(spot);
                last = Some(spot);
            }
        }
    }

    /// Returns the middle of the base line for `text` near the wished place; `None` if every place would cover another
    /// label and this one is not needed.
    pub(super) fn place(&mut self, text: &str, font_size: f64, beside: Beside) -> Option<Spot> {
        let half = Vec2::new(0.5 * text_width(text, font_size), 0.42 * font_size);
        let wished = beside.towards.y.atan2(beside.towards.x);
        let mut best: Option<(f64, Spot)> = None;
        for i in 0..Self::DIRECTIONS * 2 {
            // The preferred direction first, then alternately to both sides; then all again farther away.
            let step = (i % Self::DIRECTIONS).div_ceil(2) as f64 * if i % 2 == 0 { 1.0 } else { -1.0 };
            let angle = wished + step * std::f64::consts::TAU / Self::DIRECTIONS as f64;
            let is_near = i < Self::DIRECTIONS;
            let far = if is_near { beside.distance } else { 1.7 * beside.distance };
            let middle = beside.point + Vec2::new((far + half.x) * angle.cos(), (far + half.y) * angle.sin());
            let within = |other: Spot, room: Vec2| {
                let away = other - middle;
                away.x.abs() < room.x && away.y.abs() < room.y
            };
            let covers =
                self.boxes.iter().any(|(other, size)| within(*other, *size + half + Vec2::new(2.0, 1.0)));
            if covers && !beside.needed {
                continue;
            }
            let hidden = self.ink.iter().filter(|spot| within(**spot, half + Vec2::new(2.0, 2.0))).count();
            let cost = Self::MARK * hidden as f64
                + 0.15 * step.abs()
                + if is_near { 0.0 } else { 0.8 }
                + if covers { 100.0 } else { 0.0 };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, middle));
            }
        }
        let (_, middle) = best?;
        self.boxes.push((middle, half));
        Some(middle + Vec2::new(0.0, 0.36 * font_size))
    }
}
