//! The damping of Levenberg-Marquardt steps, and steps that end inside bounds.
//!
//! The damping follows Nielsen (1999), *Damping parameter in Marquardt's method*: after an accepted step it is
//! multiplied by 1 - (2 gain - 1)^3, cut to [1/3, 2], with the gain as the ratio of actual to predicted reduction;
//! after rejected ones in a row by 2, 4, 8 ..

/// The first damping, relative to the diagonal of the normal matrix.
const FIRST: f64 = 1e-3;
/// The least damping; below it a step is that of Gauss and Newton.
const LEAST: f64 = 1e-15;

/// The damping of a solve.
pub(crate) struct Damping {
    pub(crate) value: f64,
    growth: f64,
    /// The largest damping; beyond it a step is below rounding.
    last: f64,
}

impl Damping {
    pub(crate) fn up_to(last: f64) -> Self {
        Damping { value: FIRST, growth: 2.0, last }
    }

    /// Adapts the damping after an accepted step.
    pub(crate) fn accept(&mut self, gain: f64) {
        self.value *= (1.0 - (2.0 * gain - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
        self.value = self.value.max(LEAST);
        self.growth = 2.0;
    }

    /// Raises the damping after a step that was rejected or does not exist; returns whether it exceeds its limit.
    pub(crate) fn raise(&mut self) -> bool {
        self.value *= self.growth;
        self.growth *= 2.0;
        self.value > self.last
    }
}

/// Returns x + dx inside the bounds.
pub(crate) fn moved<const N: usize>(x: &[f64; N], dx: &[f64; N], bounds: &[(f64, f64); N]) -> [f64; N] {
    std::array::from_fn(|i| (x[i] + dx[i]).max(bounds[i].0).min(bounds[i].1))
}

/// Returns x inside the bounds.
pub(crate) fn clamped<const N: usize>(x: [f64; N], bounds: &[(f64, f64); N]) -> [f64; N] {
    std::array::from_fn(|i| x[i].max(bounds[i].0).min(bounds[i].1))
}

/// Returns the active set: the unknowns that are fixed, or at a bound that a step down the gradient would cross.
pub(crate) fn held<const N: usize>(x: &[f64; N], bounds: &[(f64, f64); N], gradient: &[f64; N]) -> [bool; N] {
    std::array::from_fn(|i| {
        let (low, high) = bounds[i];
        low == high || (x[i] <= low && gradient[i] >= 0.0) || (x[i] >= high && gradient[i] <= 0.0)
    })
}
