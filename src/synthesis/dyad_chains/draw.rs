//! Random chains: shapes whose transmission angles lie mostly within their limit, and places of P.

use crate::mechanism::AssemblyMode;
use crate::mechanism::dyad_chain::kinds::{CRANK, DyadChainKind, GROUND, MAX_DYADS};
use crate::mechanism::dyad_chain::proportions::{first_parameter, length_parameters};
use crate::mechanism::dyad_chain::{Grid, MAX_PARAMETERS, Shape};
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use std::f64::consts::PI;

/// Draws of the ends of a dyad before lengths beyond the limit are taken.
const TRIES: usize = 30;
/// One in this many chains is drawn without regard to the limit.
const FREE_EVERY: usize = 5;
/// Range of ln p.
const CRANK_RANGE: (f64, f64) = (-2.3, 1.6);
/// Ranges of alpha and beta without a limit.
const FREE_ALPHA: (f64, f64) = (-3.0, 1.0);
const FREE_BETA: (f64, f64) = (-1.5, 1.5);
/// Distances of an end, and of P, from the middle of its body (from A on the crank, in cranks), drawn in the logarithm.
const ON_CRANK: [f64; 2] = [0.3, 3.0];
const ON_GROUND: [f64; 2] = [0.2, 2.5];
const ON_LINK: [f64; 2] = [0.1, 2.0];
const OF_POINT: [f64; 2] = [0.1, 3.0];
/// The greatest (l1 + l2)^2 in units of the least that the limit allows.
const LONG: f64 = 9.0;
/// Bounds of the sum over M, less 1, and of the difference over m: the parameters stay finite.
const LEAST_EXCESS: f64 = 1e-3;
const MOST_SHARE: f64 = 0.999;

/// A random chain: the shape, and the place of P on its link.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    pub(super) shape: Shape,
    pub(super) place: Complex,
}

/// Draws a place around the middle of a body.
fn around(draws: &mut Stream, middle: f64, [least, most]: [f64; 2]) -> Complex {
    let reach = uniform(draws, least.ln(), most.ln()).exp();
    Complex::new(middle, 0.0) + Complex::from_polar(reach, uniform(draws, -PI, PI))
}

/// Draws alpha and beta whose transmission angle has at most the cosine c in magnitude; `None` if there are none.
///
/// With S = (l1 + l2)^2 and D = (l1 - l2)^2 the cosine rule at both extremes asks for
///
/// ```text
/// S (1 + c) + D (1 - c) >= 2 M^2,   S (1 - c) + D (1 + c) <= 2 m^2
/// ```
///
/// (derived here): a triangle above D = 0, empty if M/m exceeds the cotangent of half the angle.
fn lengths_within(draws: &mut Stream, [least, greatest]: [f64; 2], c: f64) -> Option<[f64; 2]> {
    let (low, high) = (2.0 * greatest * greatest, 2.0 * least * least);
    let (bottom, top) = (low / (1.0 + c), high / (1.0 - c));
    let is_empty = bottom.is_nan() || top.is_nan() || bottom >= top;
    if is_empty {
        return None;
    }
    // D where the two bounds of S meet.
    let most = (top - bottom) / ((1.0 + c) / (1.0 - c) - (1.0 - c) / (1.0 + c));
    let difference = uniform(draws, 0.0, most.sqrt());
    let d = difference * difference;
    let from = (low - d * (1.0 - c)) / (1.0 + c);
    let to = ((high - d * (1.0 + c)) / (1.0 - c)).min(LONG * from);
    let s = uniform(draws, from.ln(), to.max(from).ln()).exp();
    let sign = if below(draws, 2) == 0 { 1.0 } else { -1.0 };
    let excess = (s.sqrt() / greatest - 1.0).max(LEAST_EXCESS);
    Some([excess.ln(), sign * (difference / least).min(MOST_SHARE).atanh()])
}

/// Draws a chain of a kind. The transmission angles of all dyads have at most the given cosine in magnitude, but for one chain
/// in [`FREE_EVERY`], and for dyads whose ends were drawn in vain.
pub(super) fn drawn(kind: DyadChainKind, draws: &mut Stream, cosine: f64, grid: &mut Grid) -> Drawn {
    let is_free = below(draws, FREE_EVERY) == 0;
    let mut assembly = [AssemblyMode::Plus; MAX_DYADS];
    for mode in &mut assembly {
        if below(draws, 2) == 1 {
            *mode = AssemblyMode::Minus;
        }
    }
    let mut shape = Shape { kind, assembly, parameters: [0.0; MAX_PARAMETERS] };
    for dyad in 0..kind.dyads() {
        let [alpha, beta] = length_parameters(dyad);
        for _ in 0..TRIES {
            let ends = if dyad == 0 {
                let p = uniform(draws, CRANK_RANGE.0, CRANK_RANGE.1);
                shape.parameters[0] = p;
                [(1.0 - p.exp()).abs(), 1.0 + p.exp()]
            } else {
                draw_ends(&mut shape, dyad, draws);
                if is_free {
                    [1.0, 1.0]
                } else {
                    vectorised(
                        #[inline(always)]
                        || shape.sampled_extremes(dyad, grid),
                    )
                }
            };
            shape.parameters[alpha] = uniform(draws, FREE_ALPHA.0, FREE_ALPHA.1);
            shape.parameters[beta] = uniform(draws, FREE_BETA.0, FREE_BETA.1);
            if is_free {
                break;
            }
            if let Some(lengths) = lengths_within(draws, ends, cosine) {
                [shape.parameters[alpha], shape.parameters[beta]] = lengths;
                break;
            }
        }
    }
    Drawn { shape, place: around(draws, 0.5, OF_POINT) }
}

/// Draws the places of the ends of a dyad after the first.
fn draw_ends(shape: &mut Shape, dyad: usize, draws: &mut Stream) {
    let crank = shape.parameters[0].exp();
    let own = first_parameter(dyad);
    for (end, body) in shape.kind.anchors(dyad).into_iter().enumerate() {
        let at = match body {
            CRANK => around(draws, 0.0, ON_CRANK.map(|x| x * crank)),
            GROUND => around(draws, 0.5, ON_GROUND),
            _ => around(draws, 0.5, ON_LINK),
        };
        [shape.parameters[own + 2 * end], shape.parameters[own + 2 * end + 1]] = [at.re, at.im];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::stream;

    #[test]
    fn lengths_have_the_transmission_angle_that_they_are_drawn_for() {
        let draws = &mut stream(3, 0);
        let cosine = 30_f64.to_radians().cos();
        let mut found = 0;
        for _ in 0..2000 {
            let least = uniform(draws, 0.1, 1.0);
            let ends = [least, least * uniform(draws, 1.0, 5.0)];
            let Some([alpha, beta]) = lengths_within(draws, ends, cosine) else {
                // M/m above the cotangent of 15 degrees, and no other.
                assert!(ends[1] / ends[0] > 1.0 / 15_f64.to_radians().tan() - 1e-9);
                continue;
            };
            let (sum, difference) = (ends[1] * (1.0 + alpha.exp()), ends[0] * beta.tanh());
            let (l1, l2) = (0.5 * (sum + difference), 0.5 * (sum - difference));
            for e in ends {
                // The bounds of alpha and beta may cost a little.
                assert!(((l1 * l1 + l2 * l2 - e * e) / (2.0 * l1 * l2)).abs() < cosine + 0.01);
            }
            found += 1;
        }
        assert!(found > 1000);
    }
}
