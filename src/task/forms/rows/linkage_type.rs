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
    let Some(aim) = aim else { return };
    if let Some(shortest) = shortest(aim) {
        for other in (0..4).filter(|&i| i != shortest) {
            let mut factors = [1.0; 4];
            factors[shortest] = -1.0;
            factors[other] = -1.0;
            each(&combine(factors, -margin));
        }
        return;
    }
    // The links as they are now, in the order s, p, q, l.
    let mut order = [0, 1, 2, 3];
    order.sort_by(|&i, &j| links[i].total_cmp(&links[j]));
    let ordered = |signs: [f64; 4]| {
        let mut factors = [0.0; 4];
        order.into_iter().zip(signs).for_each(|(link, sign)| factors[link] = sign);
        factors
    };
    if aim == LinkageType::TripleRocker {
        // l + s - p - q >= 0, and l <= the others together.
        each(&combine(ordered([1.0, -1.0, -1.0, 1.0]), -margin));
        each(&combine(ordered([1.0, 1.0, 1.0, -1.0]), -margin));
    } else {
        // A change point, whose margin is zero: both inequalities, without slack.
        each(&combine(ordered([-1.0, 1.0, 1.0, -1.0]), 0.0));
        each(&combine(ordered([1.0, -1.0, -1.0, 1.0]), 0.0));
    }
}

/// Returns the index of the link (ground, a, b, c) that is the shortest in a Grashof type; `None` in the others.
fn shortest(linkage_type: LinkageType) -> Option<usize> {
    match linkage_type {
        LinkageType::DoubleCrank => Some(0),
        LinkageType::CrankRocker => Some(1),
        LinkageType::DoubleRocker => Some(2),
        LinkageType::RockerCrank => Some(3),
        LinkageType::TripleRocker | LinkageType::ChangePoint => None,
    }
}

/// Returns the allowed type that a shape is nearest to: its own if that is allowed.
pub fn nearest_type(links: [f64; 4], allowed: &[LinkageType]) -> Option<LinkageType> {
    let own = linkage_type(links)?;
    if allowed.is_empty() || allowed.contains(&own) {
        return Some(own);
    }
    let off = |t: &LinkageType| shortest(*t).map_or_else(|| grashof_margin(links).abs(), |link| links[link]);
    allowed.iter().copied().min_by(|s, t| off(s).total_cmp(&off(t)))
}
