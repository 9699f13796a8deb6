//! Dyad chains: derivatives against central differences, positions against the general chain, full turns, transmission.

use linkwright::internals::mechanism::chain::Outcome;
use linkwright::internals::mechanism::dyad_chain::proportions::parameters_of;
use linkwright::internals::mechanism::dyad_chain::sizes::{distance, log_rate, sides};
use linkwright::internals::mechanism::dyad_chain::transmission::{cosine, cosine_rate};
use linkwright::internals::mechanism::dyad_chain::{
    DyadChain, DyadChainKind, Frames, MAX_DYADS, MAX_PARAMETERS, MAX_SLOPES, Placement, Rates, Shape, Slopes,
};
use linkwright::internals::mechanism::{AssemblyMode, Complex};
use linkwright::internals::numbers::arithmetic::complex_lanes::ComplexLanes;
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, stream, uniform};
use std::f64::consts::{PI, TAU};

/// Draws a chain of a kind, all of whose parameters are of the order of 1.
pub fn drawn(kind: DyadChainKind, draws: &mut Stream) -> DyadChain {
    let mut assembly = [AssemblyMode::Plus; MAX_DYADS];
    for mode in &mut assembly {
        if below(draws, 2) == 1 {
            *mode = AssemblyMode::Minus;
        }
    }
    let mut parameters = [0.0; MAX_PARAMETERS];
    for parameter in &mut parameters[..parameters_of(kind.dyads())] {
        *parameter = uniform(draws, -1.2, 1.2);
    }
    let mut place = || Complex::new(uniform(draws, -2.0, 2.0), uniform(draws, -2.0, 2.0));
    let placement = Placement { origin: place(), ground: place(), pointer: place() };
    DyadChain { shape: Shape { kind, assembly, parameters }, placement }
}

fn direction(phase: f64) -> ComplexLanes<f64> {
    ComplexLanes { re: phase.cos(), im: phase.sin() }
}

/// Unequal weights of the numbers of one chain, so that no two terms can be exchanged unseen.
pub fn weighted(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.enumerate().map(|(i, x)| x * (1.0 + 0.37 * i as f64)).sum()
}

/// A weighted sum of the frame of P's body, the cosines of all transmission angles and the logarithms of all lengths.
fn value(chain: &DyadChain, phase: f64) -> f64 {
    let of = chain.proportions();
    let mut frames = Frames::<f64>::of(direction(phase));
    frames.assemble_all(&of);
    let body = of.kind.traced();
    let (o, v) = (frames.origin[body], frames.along[body]);
    let cosines = (0..of.kind.dyads()).flat_map(|dyad| [0, 1].map(|end| (dyad, end)));
    let cosines = cosines.map(|(dyad, end)| cosine(&of, dyad, end));
    let lengths = sides(of.kind).into_iter().map(|side| distance(&of, &chain.placement, &side).ln());
    weighted([o.re, o.im, v.re, v.im].into_iter().chain(cosines).chain(lengths))
}

/// The derivative of [`value`] by the phase (0) or a parameter (from 1).
pub fn slope(chain: &DyadChain, phase: f64, k: usize) -> f64 {
    let of = chain.proportions();
    let rates = Rates::of(&chain.shape, &of);
    let e = direction(phase);
    let (mut frames, mut slopes) = (Frames::<f64>::of(e), Slopes::<f64, MAX_SLOPES>::of(e));
    for dyad in 0..of.kind.dyads() {
        frames.assemble(&of, dyad);
        slopes.differentiate(&of, &rates, dyad, &frames, parameters_of(dyad + 1));
    }
    let body = of.kind.traced();
    let (o, v) = (slopes.origin[body][k], slopes.along[body][k]);
    let cosines = (0..of.kind.dyads()).flat_map(|dyad| [0, 1].map(|end| (dyad, end)));
    let cosines = cosines.map(|at| if k == 0 { 0.0 } else { cosine_rate(&of, &rates, at, k - 1) });
    let lengths = sides(of.kind)
        .into_iter()
        .map(|side| if k == 0 { 0.0 } else { log_rate(&of, &rates, &chain.placement, &side).shape[k - 1] });
    weighted([o.re, o.im, v.re, v.im].into_iter().chain(cosines).chain(lengths))
}

/// Returns the largest error of the derivatives of a chain, relative to their size.
fn worst(chain: &DyadChain, phase: f64) -> f64 {
    let step = 1e-6;
    let error = |k: usize| {
        let at = |sign: f64| {
            if k == 0 {
                return value(chain, phase + sign * step);
            }
            let mut moved = *chain;
            moved.shape.parameters[k - 1] += sign * step;
            value(&moved, phase)
        };
        let difference = (at(1.0) - at(-1.0)) / (2.0 * step);
        // Differences of values of the order of 10 have rounding errors of 1e-9 at this step.
        (difference - slope(chain, phase, k)).abs() / (10.0 + difference.abs())
    };
    (0..=chain.shape.count()).map(error).fold(0.0, f64::max)
}

#[test]
fn derivatives_of_six_bars_are_those_of_central_differences() {
    for (stream_index, kind) in (0..).zip(DyadChainKind::SIX_BARS) {
        let draws = &mut stream(51, stream_index);
        for _ in 0..1000 {
            let chain = drawn(kind, draws);
            let worst = worst(&chain, uniform(draws, -PI, PI));
            assert!(worst < 1e-6, "{}: {worst:e} of {:?}", kind.name(), chain.shape);
        }
    }
}

#[test]
fn derivatives_of_eight_bars_are_those_of_central_differences_but_where_an_extreme_jumps() {
    let kinds = DyadChainKind::eight_bars();
    let draws = &mut stream(52, 0);
    let (mut right, count) = (0, 3 * kinds.len());
    for i in 0..count {
        let chain = drawn(kinds[i % kinds.len()], draws);
        right += usize::from(worst(&chain, uniform(draws, -PI, PI)) < 1e-5);
    }
    assert!(100 * right >= 97 * count, "{right} of {count}");
}

#[test]
fn positions_are_those_of_the_general_chain() {
    let kinds = DyadChainKind::SIX_BARS.into_iter().chain(DyadChainKind::eight_bars());
    for (stream_index, kind) in (0..).zip(kinds.chain([DyadChainKind::FOUR_BAR])) {
        let draws = &mut stream(53, stream_index);
        for _ in 0..20 {
            let own = drawn(kind, draws);
            let of = own.proportions();
            let chain = own.to_chain().unwrap_or_else(|why| panic!("{}: {why}", kind.name()));
            let mut pose = chain.pose();
            let size = own.longest();
            for _ in 0..20 {
                let phase = uniform(draws, -PI, PI);
                assert_eq!(chain.position(phase + own.ground_angle(), &mut pose), Outcome::Closed);
                let p = pose.point(chain.trace()).expect("it closes");
                let apart = (p - own.point(&of, phase)).norm();
                assert!(apart <= 1e-10 * size, "{}: {apart:e} of {size}", kind.name());
            }
        }
    }
}

#[test]
fn every_value_of_the_parameters_turns_fully_with_the_transmission_angles_that_it_states() {
    for (stream_index, kind) in (0..).zip(DyadChainKind::SIX_BARS) {
        let draws = &mut stream(54, stream_index);
        for _ in 0..40 {
            let own = drawn(kind, draws);
            let of = own.proportions();
            let chain = own.to_chain().unwrap_or_else(|why| panic!("{why}"));
            assert!(chain.input(720).is_full());
            // The angle at F between both links, from the points of the general chain.
            let id = |name: &str| chain.point_id(name).expect("it has that point");
            let joints = [("C", "B", "D"), ("X2", "Y2", "F2")];
            let mut pose = chain.pose();
            for (dyad, (x, y, f)) in joints.into_iter().enumerate() {
                let mut least = f64::INFINITY;
                for i in 0..4000 {
                    assert!(chain.position(TAU * f64::from(i) / 4000.0, &mut pose).is_closed());
                    let at = |name| pose.point(id(name)).expect("it closes");
                    let angle = ((at(x) - at(f)) / (at(y) - at(f))).arg().abs();
                    least = least.min(angle.min(PI - angle));
                }
                let stated = of.least_transmission_of(dyad);
                // A sample is at most 8e-4 rad from the extreme; near a dead centre the angle has a corner there.
                assert!(stated <= least + 1e-7 && least - stated < 0.02, "{stated} {least}");
            }
        }
    }
}

#[test]
fn a_mirrored_chain_draws_the_mirror_image_backwards() {
    for (stream_index, kind) in (0..).zip(DyadChainKind::SIX_BARS) {
        let draws = &mut stream(55, stream_index);
        let chain = drawn(kind, draws);
        let mirrored = chain.mirrored();
        let (of, of_mirrored) = (chain.proportions(), mirrored.proportions());
        for i in 0..50 {
            let phase = TAU * f64::from(i) / 50.0;
            let apart = chain.point(&of, phase).conj() - mirrored.point(&of_mirrored, -phase);
            assert!(apart.norm() < 1e-10 * chain.longest());
        }
    }
}
