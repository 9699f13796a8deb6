//! The order of a fit's points along their circuit: the ways from each to the next, and points that have met.

use super::Positions;
use crate::mechanism::Complex;

/// A distance between points that no step can close.
const FAR_APART: f64 = 3.0;

/// Returns the distance along the curve from one position to a near one, positive along the tangent: the turns of crank
/// and coupler along the mean of both tangents.
///
/// `None` for positions that are far apart (a radian, or tangents that differ by more than about 70 degrees): they
/// cannot pass each other in one step, and their distance counts as [`FAR_APART`] in the `sense`.
fn way(from: [Complex; 2], from_tangent: [f64; 2], to: [Complex; 2], to_tangent: [f64; 2]) -> Option<f64> {
    let turn = |i: usize| {
        let z = to[i] * from[i].conj();
        // The sine suffices for small turns: only the order and a rough length are needed.
        (z.re > 0.5).then_some(z.im)
    };
    let alike = from_tangent[0] * to_tangent[0] + from_tangent[1] * to_tangent[1];
    let mean = [0.5 * (from_tangent[0] + to_tangent[0]), 0.5 * (from_tangent[1] + to_tangent[1])];
    let (by_e, by_u) = (turn(0)?, turn(1)?);
    (alike > 0.3).then_some(by_e * mean[0] + by_u * mean[1])
}

/// Puts the ways from each position to the next one along a circuit that is run in `sense`, and from the last to the first,
/// behind `gaps`; `tangent` is the unit tangent (dphi, domega) of a position. Returns false, and puts nothing, if one has no
/// tangent.
pub(in crate::task::forms) fn gaps_along(
    state: &Positions,
    tangent: impl Fn([Complex; 2]) -> Option<[f64; 2]>,
    sense: f64,
    repeats_first: bool,
    gaps: &mut Vec<f64>,
) -> bool {
    let mut tangents = state.iter().map(|position| tangent(*position));
    let Some(Some(first)) = tangents.next() else { return false };
    let mut last = first;
    for (w, tangent) in state.windows(2).zip(tangents) {
        let Some(tangent) = tangent else {
            gaps.clear();
            return false;
        };
        gaps.push(way(w[0], last, w[1], tangent).map_or(FAR_APART, |way| sense * way));
        last = tangent;
    }
    // The last point must not run into the first from behind. If it is near, it has either gone almost all the way
    // round or, on a short interval, not gone far.
    let gone: f64 = gaps.iter().sum();
    let closing = way(state[state.len() - 1], last, state[0], first).map(|way| sense * way);
    let far = repeats_first || closing.is_none_or(|way| way < -0.1 * gone);
    gaps.push(closing.filter(|_| !far).unwrap_or(FAR_APART));
    true
}

/// Moves each position to that of the point which it has met.
pub(in crate::task::forms) fn joined(state: &mut Positions, leaders: &[usize]) {
    for (j, &leader) in leaders.iter().enumerate() {
        state[j] = state[leader];
    }
}
