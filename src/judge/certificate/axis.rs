//! The known pivots, directions and limits of a design, for problems with crank angles from the x axis.

use crate::numbers::leaves::{Axis, Lengths, Line};
use crate::task::spec::{DesignSpec, Limits};

/// The relative amount by which limits of lengths are widened.
pub(super) const WIDER: f64 = 1e-9;

/// A range of phi_0 that contains every angle, radians.
const ALL_ROUND: [f64; 2] = [-3.2, 3.2];

/// Reads the known pivots, directions and limits from a design.
pub(super) fn axis_of(design: &DesignSpec) -> Axis {
    let point = |pivot: Option<[Limits; 2]>| {
        pivot.filter(|xy| xy.iter().all(Limits::is_fixed)).map(|[x, y]| [x.0, y.0])
    };
    let pivot = point(design.crank_pivot);
    let range = |limits: Option<Limits>| match limits {
        Some(l) if l.is_fixed() => [l.0; 2],
        Some(l) => [l.0.max(0.0) * (1.0 - WIDER), l.1 * (1.0 + WIDER)],
        None => [0.0, f64::INFINITY],
    };
    let mut lengths = Lengths { crank: range(design.a), ground: range(design.ground) };
    let angle = design.ground_angle_deg;
    let mut line = angle.filter(Limits::is_fixed).map(|angle| Line::Angle(angle.0));
    if let Some((a, b)) = pivot.zip(point(design.follower_pivot)) {
        lengths.ground = [(b[0] - a[0]).hypot(b[1] - a[1]); 2];
        line = Some(Line::To(b));
    }
    let phi = match line {
        Some(_) => [0.0; 2],
        None => angle.map_or(ALL_ROUND, |angle| phi([angle.0.to_radians(), angle.1.to_radians()])),
    };
    Axis { pivot, line, lengths, limits_deg: angle.map(|angle| [angle.0, angle.1]), phi }
}

/// Returns a range of minus the ground's angle, within a turn, widened by the rounding of the angle.
fn phi([low, high]: [f64; 2]) -> [f64; 2] {
    use std::f64::consts::{PI, TAU};
    let whole = (0.5 * (low + high) / TAU).round() * TAU;
    let slack = |x: f64| 1e-15 * (x.abs() + whole.abs());
    let (low, high) = (low - whole - slack(low), high - whole + slack(high));
    if low < -PI - 0.01 || high > PI + 0.01 { ALL_ROUND } else { [-high, -low] }
}

#[cfg(test)]
mod tests {
    use super::{ALL_ROUND, phi};

    #[test]
    fn the_range_of_the_grounds_angle_is_turned_round() {
        use std::f64::consts::{PI, TAU};
        let [low, high] = phi([0.25, 0.5]);
        assert!(low <= -0.5 && -0.25 <= high && (high - low - 0.25).abs() < 1e-12);
        let [low, high] = phi([0.25 + TAU, 0.5 + TAU]);
        assert!(low <= -0.5 && -0.25 <= high && (high - low - 0.25).abs() < 1e-12);
        // Across half a turn, and all of it: the whole chart.
        assert_eq!(phi([PI - 0.5, PI + 0.5]), ALL_ROUND);
        assert_eq!(phi([-7.0, 7.0]), ALL_ROUND);
        assert_eq!(phi([1.0, 1.0 + TAU]), ALL_ROUND);
        assert_eq!(phi([0.0, 0.0]), [0.0, 0.0]);
    }
}
