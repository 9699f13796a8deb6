//! Scales of charts: figures mapped to the range from 0 to 1, in proportion or by logarithms, with round values for ticks.

use super::scene::round_length;

/// The ratio of the greatest to the least figure above which a scale is logarithmic where it may be.
pub(super) const LOGARITHMIC: f64 = 12.0;

/// The colours of a scale, from its least to its greatest figure, of equal steps to the eye and to colour-blind
/// eyes (viridis, Smith and van der Walt 2015, without its lightest end).
const COLOURS: [[f64; 3]; 5] =
    [[68.0, 1.0, 84.0], [59.0, 82.0, 139.0], [33.0, 145.0, 140.0], [94.0, 201.0, 98.0], [216.0, 226.0, 25.0]];

/// A scale, which maps figures to the range from 0 to 1.
pub(super) struct Scale {
    low: f64,
    high: f64,
    /// Whether figures are mapped by their logarithms.
    pub(super) logarithmic: bool,
}

impl Scale {
    /// Returns a scale that contains the values, with a margin. It is logarithmic if all are positive and the greatest is
    /// more than `ratio` times the least.
    pub(super) fn new(values: &[f64], ratio: f64) -> Scale {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if low > 0.0 && high > ratio * low {
            return Scale { low: low.ln() - 0.12, high: high.ln() + 0.12, logarithmic: true };
        }
        let room = if high > low { 0.08 * (high - low) } else { 0.1 * high.abs().max(f64::MIN_POSITIVE) };
        Scale { low: (low - room).max(0.0), high: high + room, logarithmic: false }
    }

    /// Returns a scale as [`new`](Self::new) does, for figures that may be negative.
    pub(super) fn over(values: &[f64], ratio: f64) -> Scale {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        if low >= 0.0 {
            return Scale::new(values, ratio);
        }
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let room = 0.08 * (high - low).max(f64::MIN_POSITIVE);
        Scale { low: low - room, high: high + room, logarithmic: false }
    }

    /// Returns the place of a value, from 0 to 1.
    pub(super) fn part(&self, value: f64) -> f64 {
        let value = if self.logarithmic { value.ln() } else { value };
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }

    /// Returns round values on the scale.
    pub(super) fn ticks(&self) -> Vec<f64> {
        if self.logarithmic {
            let (low, high) = (self.low.exp(), self.high.exp());
            let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
            let few = decades.clone().count() > 5;
            let steps: &[u8] = if few { &[1] } else { &[1, 2, 5] };
            let number = |(e, m): (i32, u8)| format!("{m}e{e}").parse::<f64>().unwrap_or(1.0);
            let all = decades.flat_map(|e| steps.iter().map(move |m| (e, *m))).map(number);
            let round: Vec<f64> = all.filter(|x| (low..=high).contains(x)).collect();
            // Within less than a decade steps of equal size are rounder.
            return if round.len() < 3 { steps_between(low, high) } else { round };
        }
        steps_between(self.low, self.high)
    }
}

/// Returns the multiples of a round number between two numbers, about four of them.
fn steps_between(low: f64, high: f64) -> Vec<f64> {
    let step = round_length((high - low) / 4.0);
    let first = (low / step).ceil();
    (0..12).map(|i| (first + f64::from(i)) * step).take_while(|x| *x <= high).collect()
}

/// Returns the colour of a place on a scale, from 0 to 1.
pub(super) fn colour(part: f64) -> String {
    let at = part.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let i = (at.floor() as usize).min(COLOURS.len() - 2);
    let rest = at - i as f64;
    let mixed: Vec<String> = COLOURS[i]
        .iter()
        .zip(COLOURS[i + 1])
        .map(|(low, high)| format!("{:02x}", (low + rest * (high - low)).round() as u8))
        .collect();
    format!("#{}", mixed.concat())
}
