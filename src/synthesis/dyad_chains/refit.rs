//! Fits of a known chain under other limits, or with dimensions at given values.

use super::answers::{DyadChainAnswer, End};
use super::constants::{FEW, IDLE_LAST};
use super::curve::EVEN;
use super::fit::{Ending, State};
use super::held::{AllHeld, Held};
use super::limits::Limits;
use super::request::Request;
use super::stages::{Bench, Setup};
use super::target::{Target, Variant};
use crate::mechanism::DyadChain;

/// Fits a chain that draws a path at these phases, one a point, under the limits of a request and with dimensions at given values, with
/// at most so many trial steps; returns the end and the evaluations. `None` for numbers that are not usable, phases that run
/// both ways, or a sense that prescribed timing excludes.
pub fn refit(
    request: &Request<'_>,
    chain: &DyadChain,
    phases: &[f64],
    held: &[Held],
    steps: usize,
) -> Option<(DyadChainAnswer, u64)> {
    if !request.is_usable() || phases.len() != request.points.len() {
        return None;
    }
    let target = Target::of((request.points, request.closed), request.timing, FEW, EVEN)?;
    let falls = match &request.timing {
        None => phases.last()? < phases.first()?,
        Some(timing) => {
            let run = timing.run(phases);
            if !timing.runs.contains(&run) {
                return None;
            }
            run != timing.sense()
        }
    };
    let variant = Variant { reversed: false, mirrored: falls };
    let (chain, phases) = target.normalised(chain, phases, variant);
    if request.timing.is_none() && phases.windows(2).any(|pair| pair[1] < pair[0]) {
        return None;
    }
    let limits = [false, true].map(|mirrored| Limits::of(&request.limits, &target, mirrored));
    let setup = Setup { target: &target, limits: &limits };
    let mut bench = Bench::default();
    let state = State { chain, phases, value: f64::INFINITY, misfit: f64::INFINITY };
    bench.hold(chain.shape.kind, AllHeld::of(held, &target, falls));
    let end =
        setup.strict_fit(&mut bench, &End { state, variant, hits: 1 }, Ending { steps, idle: IDLE_LAST });
    end.state.value.is_finite().then(|| (DyadChainAnswer::of(&end, &target, request), bench.evaluations()))
}
