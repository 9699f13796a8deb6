//! Starts made from known ends: near one, or along the difference of two.

use crate::mechanism::Complex;
use crate::numbers::arithmetic::streams::{Stream, normal, uniform};
use crate::synthesis::constants::free::{DIFFERENCE, JITTER};
use crate::task::Problem;
use crate::task::forms::start::Start;
use crate::task::forms::torus::PathFit;

/// Returns a start near a known end: every free number of the design is moved by a random part of its size, and the
/// positions are brought back to the curves.
pub(super) fn near(problem: &Problem, end: &Start, stream: &mut Stream) -> Option<Start> {
    let scale = uniform(stream, JITTER.0.ln(), JITTER.1.ln()).exp();
    let fit = PathFit::new(problem, end.setting);
    let mut start = end.clone();
    let size = problem.task().size();
    for (i, (value, &(low, high))) in start.design.iter_mut().zip(fit.space().bounds()).enumerate() {
        let step = normal(stream, 0.0, scale);
        // An angle is moved by parts of a radian.
        let other = if fit.space().is_angle(i) { 1.0 } else { size };
        let unit = if fit.space().is_length(i) { value.abs() } else { other };
        *value = (*value + step * unit).max(low).min(high);
    }
    fit.settle(&start.design, &mut start.positions).then_some(start)
}

/// Returns a start near a known end, moved along the difference of two others in design and positions, as in
/// differential evolution (Storn and Price 1997): this keeps the common features of the ends of one family.
pub(super) fn along_a_difference(
    problem: &Problem,
    [end, one, other]: [&Start; 3],
    stream: &mut Stream,
) -> Option<Start> {
    let part = uniform(stream, DIFFERENCE.0, DIFFERENCE.1);
    let fit = PathFit::new(problem, end.setting);
    let mut start = end.clone();
    for (i, (value, &(low, high))) in start.design.iter_mut().zip(fit.space().bounds()).enumerate() {
        let step = if fit.space().is_length(i) && *value > 0.0 && one.design[i] > 0.0 && other.design[i] > 0.0
        {
            *value * ((one.design[i] / other.design[i]).powf(part) - 1.0)
        } else {
            part * (one.design[i] - other.design[i])
        };
        *value = (*value + step).max(low).min(high);
    }
    for (position, (ahead, behind)) in
        start.positions.iter_mut().zip(one.positions.iter().zip(&other.positions))
    {
        for (direction, (to, from)) in position.iter_mut().zip(ahead.iter().zip(behind)) {
            *direction *= Complex::from_polar(1.0, part * (to * from.conj()).arg());
        }
    }
    fit.settle(&start.design, &mut start.positions).then_some(start)
}
