//! What a certificate says it covers, in words.

use super::absolute::Axis;
use super::chart::Class;
use super::leaves::Angles;
use super::subject::Subject;

/// The words of a certificate.
pub(super) struct Words {
    /// No .. whose coupler point is near enough has a sum below the bound.
    pub linkage: String,
    /// Where the crank angles are from.
    pub angles: &'static str,
    pub covered: Vec<String>,
    pub not_covered: Vec<String>,
}

impl Subject {
    /// The words for what its certificate covers.
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
        let class = match self.classes[..] {
            [Class::CrankRocker] => "crank-rockers",
            [Class::DoubleCrank] => "double-cranks",
            _ => "crank-rockers and double-cranks",
        };
        let mut linkage = match self.classes[..] {
            [Class::CrankRocker] => "crank-rocker".to_owned(),
            [Class::DoubleCrank] => "double-crank".to_owned(),
            _ => "four-bar linkage whose input turns fully and".to_owned(),
        };
        let mut covered = vec![
            format!("{class}, and linkages with change points as long as they stay in one assembly"),
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
                let known = place.join("; ");
                linkage = match linkage.strip_suffix(" and") {
                    Some(linkage) => format!("{linkage} ({known}) and"),
                    None => format!("{linkage} ({known})"),
                };
                covered.extend(place);
                covered.push(format!(
                    "any lengths of the other links, the coupler point at most {limit} from the crank pin"
                ));
                not_covered.push("cranks and grounds of other lengths".into());
                if let [only] = self.classes[..] {
                    let other = if only == Class::CrankRocker { "double-cranks" } else { "crank-rockers" };
                    not_covered.push(format!("{other}, which the problem does not allow"));
                }
            }
        }
        Words { linkage, angles, covered, not_covered }
    }
}

/// What is known of the pivots and lengths.
fn place(axis: &Axis) -> Vec<String> {
    let range = |name: &str, [low, high]: [f64; 2]| match (low < high, high.is_finite()) {
        (false, _) => format!("{name} {low:.6} long"),
        (true, true) => format!("{name} {low:.6} to {high:.6} long"),
        (true, false) => format!("{name} at least {low:.6} long"),
    };
    let pivot = match axis.pivot {
        Some([x, y]) => format!("crank pivot at ({x}, {y})"),
        None => "any crank pivot".into(),
    };
    let [low, high] = axis.phi.map(f64::to_degrees);
    let line = match axis.angle_deg() {
        Some(angle) => format!("ground line at {:.6} degrees", angle + 0.0),
        None if high - low < 359.9 => format!("ground line at {:.6} to {:.6} degrees", -high, -low),
        None => "any ground line".into(),
    };
    vec![pivot, line, range("crank", axis.lengths.crank), range("ground", axis.lengths.ground)]
}
