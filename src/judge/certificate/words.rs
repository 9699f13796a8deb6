//! The wording of a certificate: the linkages that it covers and those that it does not.

use super::axis::WIDER;
use super::subject::Subject;
use crate::numbers::leaves::Angles;
use crate::numbers::leaves::{Axis, Class};
use std::f64::consts::TAU;

/// The wording of a certificate.
pub(super) struct Words {
    /// The linkages of the statement "No .. whose coupler point is near enough has a sum below the bound", as a noun
    /// phrase.
    pub linkage: String,
    /// The reference direction of the crank angles.
    pub angles: &'static str,
    pub covered: Vec<String>,
    pub not_covered: Vec<String>,
}

impl Subject {
    /// Returns the wording of the subject's certificate.
    pub(super) fn words(&self) -> Words {
        let limit = self.limit;
        let either = if self.directions.len() == 2 { "either way" } else { "the way that is asked for" };
        let (angles, first) = match self.angles {
            Angles::Increments => {
                ("increments of the crank", format!("the crank turning {either}, any first crank angle"))
            }
            Angles::Ground => (
                "angles of the crank from the ground line",
                "the crank angles from the ground line, as prescribed".into(),
            ),
            Angles::Axis(_) => (
                "angles of the crank from the x axis",
                "the crank angles from the x axis, as prescribed".into(),
            ),
        };
        let (classes, mut linkage) = match self.classes[..] {
            [only] => (format!("{}s", only.name()), only.name().to_owned()),
            _ => (
                "crank-rockers and double-cranks".to_owned(),
                "four-bar linkage whose input turns fully".to_owned(),
            ),
        };
        let mut covered = vec![
            format!("{classes}, and linkages with change points as long as they stay in one assembly"),
            "either assembly, the same at all points".into(),
            first,
        ];
        let mut not_covered = vec![
            "linkages whose input rocks".into(),
            "motions that pass from one assembly to the other at a change point".into(),
            "coupler points farther from the crank pin".into(),
        ];
        match &self.angles {
            Angles::Increments | Angles::Ground => covered.push(format!(
                "any pivots and lengths of links, the coupler point at most {limit} from the crank pin"
            )),
            Angles::Axis(axis) => {
                let place = place(axis);
                linkage = format!("{linkage} ({})", place.join("; "));
                covered.extend(place);
                covered.push(format!(
                    "any lengths of the other links, the coupler point at most {limit} from the crank pin"
                ));
                not_covered.push("cranks and grounds of other lengths".into());
                let others = Class::ALL.iter().filter(|class| !self.classes.contains(class));
                not_covered.extend(
                    others.map(|other| format!("{}s, which the problem does not allow", other.name())),
                );
            }
        }
        Words { linkage, angles, covered, not_covered }
    }
}

/// Rounds a limit to twelve digits: the limit as it was before it was widened, by far more than the rounding.
fn to_twelve_digits(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}

/// Returns the wording for the known pivots, ground line and lengths.
fn place(axis: &Axis) -> Vec<String> {
    let range = |name: &str, [low, high]: [f64; 2]| {
        let [least, most] = [low / (1.0 - WIDER), high / (1.0 + WIDER)].map(to_twelve_digits);
        match (low < high, high.is_finite()) {
            (false, _) => format!("{name} {low} long"),
            (true, true) => format!("{name} {least} to {most} long"),
            (true, false) => format!("{name} at least {least} long"),
        }
    };
    let pivot = match axis.pivot {
        Some([x, y]) => format!("crank pivot at ({x}, {y})"),
        None => "any crank pivot".into(),
    };
    let [low, high] = axis.phi;
    let line = match (axis.angle_deg(), axis.limits_deg) {
        // Adding 0 turns -0 into 0.
        (Some(angle), _) => format!("ground line at {} degrees", angle + 0.0),
        (None, Some([from, to])) if high - low < TAU => format!("ground line at {from} to {to} degrees"),
        (None, _) => "any ground line".into(),
    };
    vec![pivot, line, range("crank", axis.lengths.crank), range("ground", axis.lengths.ground)]
}
