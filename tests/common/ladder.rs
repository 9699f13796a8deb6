//! Problems that ask for more and more, and the comparison of their errors: what the ladder test and the bench of
//! strokes share.

use linkwright::internals::mechanism::LinkageType;
use linkwright::internals::task::spec::ProblemSpec;

/// The error of a looser problem over that of a tighter one up to which it is not worse.
pub const NEVER_WORSE: f64 = 1.001;
/// Errors below this part of the target's size are exact.
const EXACT: f64 = 1e-9;

/// The requirements of the ladder, each beside those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    Nothing,
    /// A crank that turns fully.
    Type,
    /// A transmission angle of 30 degrees.
    Transmission,
    /// A footprint within 1.5 sizes of the target's centre.
    Footprint,
}

impl Rung {
    pub const ALL: [Rung; 4] = [Rung::Nothing, Rung::Type, Rung::Transmission, Rung::Footprint];

    /// Adds the requirements of this rung to a problem.
    pub fn asks(self, spec: &mut ProblemSpec) {
        if self >= Rung::Type {
            spec.require.types = vec![LinkageType::CrankRocker, LinkageType::DoubleCrank];
        }
        if self >= Rung::Transmission {
            spec.require.transmission_deg_min = Some(30.0);
        }
        if self >= Rung::Footprint {
            let [x, y] = [0, 1].map(|k| range(spec, k));
            let reach = 1.5 * size(spec);
            let [middle_x, middle_y] = [x, y].map(|[least, most]| 0.5 * (least + most));
            spec.require.footprint_in =
                Some([middle_x - reach, middle_y - reach, middle_x + reach, middle_y + reach]);
        }
    }
}

/// Returns the diagonal of the points' bounding box.
pub fn size(spec: &ProblemSpec) -> f64 {
    let [x, y] = [0, 1].map(|k| range(spec, k)).map(|[least, most]| most - least);
    x.hypot(y)
}

/// Returns the least and the greatest x (0) or y (1) of the points.
fn range(spec: &ProblemSpec, k: usize) -> [f64; 2] {
    let values = spec.task.points.iter().map(|p| p[k]);
    [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)]
}

/// Returns the largest factor by which an error exceeds the least one after it; the errors are in sizes of the target,
/// those of looser problems first, infinite where there is no answer.
pub fn largest_factor(errors: &[f64]) -> f64 {
    let over_later = |i: usize| {
        let later = errors[i + 1..].iter().copied().fold(f64::INFINITY, f64::min);
        (errors[i] / later.max(EXACT), later)
    };
    let found = (0..errors.len()).map(over_later).filter(|(_, later)| later.is_finite());
    found.map(|(factor, _)| factor).fold(0.0, f64::max)
}
