//! Transmission angles of the dyads of a chain: the angle between the two links at F.
//!
//! ```text
//! cos mu(E) = (l1^2 + l2^2 - E^2) / (2 l1 l2),   E = |X - Y|
//! cos' = ((l1 - l2 cos) l1' + (l2 - l1 cos) l2' - E E') / (l1 l2)
//! ```
//!
//! |cos mu| is greatest at the least or at the greatest E of the turn (derived here, from the cosine rule).

use super::gradient::Rates;
use super::proportions::Proportions;

/// The cosine of a dyad's transmission angle at one of its two extremes (0: least |X - Y|, 1: greatest).
#[inline(always)]
pub fn cosine(of: &Proportions, dyad: usize, end: usize) -> f64 {
    let ([l1, l2], e) = (of.lengths[dyad], of.extremes[dyad][end].distance);
    (l1 * l1 + l2 * l2 - e * e) / (2.0 * l1 * l2)
}

/// The derivative of [`cosine`] by a parameter.
#[inline(always)]
pub fn cosine_rate(of: &Proportions, rates: &Rates, (dyad, end): (usize, usize), k: usize) -> f64 {
    let ([l1, l2], e) = (of.lengths[dyad], of.extremes[dyad][end].distance);
    let cosine = cosine(of, dyad, end);
    let [d1, d2] = [rates.lengths[dyad][0][k], rates.lengths[dyad][1][k]];
    ((l1 - l2 * cosine) * d1 + (l2 - l1 * cosine) * d2 - e * rates.extremes[dyad][end][k]) / (l1 * l2)
}

impl Proportions {
    /// Returns the least transmission angle of a dyad over the turn, folded into [0, pi/2], in radians.
    pub fn least_transmission_of(&self, dyad: usize) -> f64 {
        let worst = cosine(self, dyad, 0).abs().max(cosine(self, dyad, 1).abs());
        worst.min(1.0).acos()
    }

    /// Returns the least transmission angle of all dyads over the turn, radians in [0, pi/2].
    pub fn least_transmission(&self) -> f64 {
        (0..self.kind.dyads()).map(|dyad| self.least_transmission_of(dyad)).fold(f64::INFINITY, f64::min)
    }
}
