//! Rows of the type aimed at: Grashof margins with the links' derivatives.

use super::{At, Row, RowKind};
use crate::mechanism::LinkageType;
use crate::mechanism::four_bar::mobility::{grashof_margin, linkage_type};
use crate::task::requirement::RequirementKind;

/// The margin aimed at inside the Grashof boundary, in parts of the sum of the links: well beyond the
/// change-point tolerance.
const TYPE_MARGIN: f64 = 1e-7;

pub(super) fn rows(at: &At<'_>, aim: Option<LinkageType>, each: &mut dyn FnMut(&Row)) {
    let links = at.links;
    let combine =
        |factors, constant| at.combined(RowKind::of(RequirementKind::Type, None), factors, constant);
    let margin = TYPE_MARGIN * links.iter().sum::<f64>();
    let shortest = match aim {
        Some(LinkageType::DoubleCrank) => 0,
        Some(LinkageType::CrankRocker) => 1,
        Some(LinkageType::DoubleRocker) => 2,
        Some(LinkageType::RockerCrank) => 3,
        Some(LinkageType::TripleRocker) => {
            // l + s - p - q >= 0 with the links as they are now, and l <= the others together.
            let mut order = [0, 1, 2, 3];
            order.sort_by(|&i, &j| links[i].total_cmp(&links[j]));
            let mut factors = [0.0; 4];
            for (place, sign) in [(0, 1.0), (1, -1.0), (2, -1.0), (3, 1.0)] {
                factors[order[place]] = sign;
            }
            each(&combine(factors, -margin));
            let mut closes = [1.0; 4];
            closes[order[3]] = -1.0;
            each(&combine(closes, -margin));
            return;
        }
        Some(LinkageType::ChangePoint) => {
            // The margin is zero: both inequalities, without slack.
            let mut order = [0, 1, 2, 3];
            order.sort_by(|&i, &j| links[i].total_cmp(&links[j]));
            let mut factors = [0.0; 4];
            for (place, sign) in [(0, -1.0), (1, 1.0), (2, 1.0), (3, -1.0)] {
                factors[order[place]] = sign;
            }
            each(&combine(factors, 0.0));
            each(&combine(factors.map(|f| -f), 0.0));
            return;
        }
        None => return,
    };
    for other in (0..4).filter(|&i| i != shortest) {
        let mut factors = [1.0; 4];
        factors[shortest] = -1.0;
        factors[other] = -1.0;
        each(&combine(factors, -margin));
    }
}

/// Returns the allowed type that a shape is nearest to: its own if that is allowed.
pub fn nearest_type(links: [f64; 4], allowed: &[LinkageType]) -> Option<LinkageType> {
    let own = linkage_type(links)?;
    if allowed.is_empty() || allowed.contains(&own) {
        return Some(own);
    }
    let shortest = |t: &LinkageType| match t {
        LinkageType::DoubleCrank => links[0],
        LinkageType::CrankRocker => links[1],
        LinkageType::DoubleRocker => links[2],
        LinkageType::RockerCrank => links[3],
        LinkageType::TripleRocker | LinkageType::ChangePoint => grashof_margin(links).abs(),
    };
    allowed.iter().copied().min_by(|s, t| shortest(s).total_cmp(&shortest(t)))
}
