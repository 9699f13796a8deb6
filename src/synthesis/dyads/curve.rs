//! RR dyads through four poses: the circle-point and centre-point curves, by the compatibility linkage.
//!
//! Vectors at pose 0: W from the pivot G to the pin, Z from the pin to the body's origin. The dyad turns W by E_j and Z by
//! T_j = Q_j/Q_0 on the way to pose j:
//!
//! ```text
//! W (E_j - 1) + Z t_j = d_j,      t_j = T_j - 1,  d_j = P_j - P_0,  j = 1, 2, 3
//! D1 E1 + D2 E2 + D3 E3 = D1 + D2 + D3      (the three are compatible)
//! D1 = t2 d3 - t3 d2,  D2 = t3 d1 - t1 d3,  D3 = t1 d2 - t2 d1
//! ```
//!
//! The second line is the loop of a four-bar with links |D_j| and the ground |D1 + D2 + D3|, whose positions are the dyads:
//! m = -Z/Q_0 and G = P_0 - Z - W. The position E_1 = E_2 = E_3 = 1 belongs to every choice of W and counts as none.

use super::scale::Scale;
use crate::mechanism::{Complex, Dyad, Pose};
use std::f64::consts::{PI, TAU};

/// Links |D_j| below this part of the largest product of their terms are rounding.
const ZERO: f64 = 1e-13;

/// Greatest distance from the circle, in parts of size and length, of a dyad of the curve.
const EXACT: f64 = 1e-12;

/// Greatest negative square of a root that is zero but for rounding.
const OPEN: f64 = 1e-9;

/// Greatest link and pivot's or pin's distance, in sizes: the curves run to infinity.
const FARTHEST: f64 = 1e3;

/// Returns up to `samples` RR dyads through four poses, in their order along the circle-point curve: one for each step of
/// a parameter that passes over every circuit of the compatibility linkage, except those whose pin, pivot or length is
/// beyond a thousand sizes.
///
/// None if more than a curve of dyads meets the poses (equal ones among them, equal angles at all of them, turning about
/// one point).
pub fn through_four_curve(poses: &[Pose; 4], samples: usize) -> Vec<Dyad> {
    let Some((scale, poses, compatibility)) = Compatibility::scaled(poses) else { return Vec::new() };
    let circuits = compatibility.circuits();
    let each = samples / circuits.len();
    let places = circuits.iter().flat_map(|circuit| (0..each).map(move |k| circuit.at(middle(k, each))));
    places.filter_map(|place| compatibility.dyad_at(&poses, place)).map(|dyad| scale.back(dyad)).collect()
}

/// Returns the parameter in the middle of step k of a circuit in so many steps.
fn middle(k: usize, steps: usize) -> f64 {
    TAU * (k as f64 + 0.5) / steps as f64
}

/// A stretch of the curve of dyads on which no place is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand {
    /// The dyads in their order.
    pub dyads: Vec<Dyad>,
    /// Whether it is a whole circuit: the first dyad follows the last one.
    pub is_closed: bool,
}

/// Steps of a circuit, which are halved where neighbours lie far apart, so often at most.
const STEPS: usize = 120;
const HALVINGS: u32 = 12;
/// The distance of neighbours, in sizes, and in parts of their distance from the poses where that is more: aimed at, and beyond
/// which the curve has passed through infinity between them.
const NEAR: f64 = 0.06;
const ACROSS: f64 = 0.5;

/// Returns the curve of [`through_four_curve`] in strands, as finely as it bends.
pub fn four_curve_strands(poses: &[Pose; 4]) -> Vec<Strand> {
    let Some((scale, poses, compatibility)) = Compatibility::scaled(poses) else { return Vec::new() };
    let mut strands = Vec::new();
    for circuit in compatibility.circuits() {
        let at = |psi: f64| compatibility.dyad_at(&poses, circuit.at(psi));
        let mut dyads: Vec<Option<Dyad>> = Vec::new();
        let ends: Vec<(f64, Option<Dyad>)> =
            (0..=STEPS).map(|k| middle(k, STEPS)).map(|psi| (psi, at(psi))).collect();
        for pair in ends.windows(2) {
            dyads.push(pair[0].1);
            between(&at, [pair[0], pair[1]], HALVINGS, &mut dyads);
        }
        strands.extend(unbroken(dyads));
    }
    for strand in &mut strands {
        strand.dyads.iter_mut().for_each(|dyad| *dyad = scale.back(*dyad));
    }
    strands
}

/// Returns how far apart two dyads lie, in sizes, and in parts of their distance from the poses where that is more.
fn apart(one: &Dyad, other: &Dyad) -> f64 {
    let (Dyad::RR { pin: m, pivot: g, .. }, Dyad::RR { pin: n, pivot: h, .. }) = (one, other) else {
        return 0.0;
    };
    let of = |p: &Complex, q: &Complex| (p - q).norm() / p.norm().min(q.norm()).max(1.0);
    of(m, n).max(of(g, h))
}

/// Adds the places between two neighbours, in their order: none where they are near, a gap where the curve passes through infinity.
fn between(
    at: &impl Fn(f64) -> Option<Dyad>,
    [from, to]: [(f64, Option<Dyad>); 2],
    halvings: u32,
    out: &mut Vec<Option<Dyad>>,
) {
    // Beside a place that is left out the curve goes on for a while.
    let distance = match (from.1, to.1) {
        (Some(one), Some(other)) => apart(&one, &other),
        (None, None) => return,
        _ => f64::INFINITY,
    };
    if distance <= NEAR {
        return;
    }
    if halvings == 0 {
        if distance > ACROSS {
            out.push(None);
        }
        return;
    }
    let psi = 0.5 * (from.0 + to.0);
    let half = (psi, at(psi));
    between(at, [from, half], halvings - 1, out);
    out.push(half.1);
    between(at, [half, to], halvings - 1, out);
}

/// Returns the strands of a circuit, the last place of which comes before its first, between places that are left out.
fn unbroken(circuit: Vec<Option<Dyad>>) -> Vec<Strand> {
    let Some(gap) = circuit.iter().position(Option::is_none) else {
        return vec![Strand { dyads: circuit.into_iter().flatten().collect(), is_closed: true }];
    };
    let around: Vec<Option<Dyad>> = [&circuit[gap..], &circuit[..gap]].concat();
    let strands = around.split(Option::is_none).filter(|strand| !strand.is_empty());
    strands
        .map(|strand| Strand { dyads: strand.iter().copied().flatten().collect(), is_closed: false })
        .collect()
}

/// A circuit of the compatibility linkage: the places of its crank for a parameter from 0 to 2 pi.
#[derive(Clone, Copy, Debug)]
enum Circuit {
    /// The crank turns fully, with the other links on one side.
    Turn { side: f64 },
    /// The crank rocks about an angle, out on one side and back on the other.
    Arc { middle: f64, reach: f64 },
}

impl Circuit {
    /// Returns the crank's angle from the ground and the side at a parameter.
    fn at(self, psi: f64) -> (f64, f64) {
        match self {
            Circuit::Turn { side } => (psi, side),
            Circuit::Arc { middle, reach } => (middle + reach * psi.cos(), psi.sin().signum()),
        }
    }
}

/// The compatibility linkage, its poses 1 to 3 numbered so that the first link is the shortest.
struct Compatibility {
    /// D1, D2, D3.
    links: [Complex; 3],
    /// t_j and d_j.
    equations: [[Complex; 2]; 3],
}

impl Compatibility {
    fn of(poses: &[Pose; 4]) -> Option<Self> {
        let equation = |j: usize| {
            let turn = poses[j].direction * poses[0].direction.conj() - 1.0;
            [turn, poses[j].position - poses[0].position]
        };
        let by_number = [1, 2, 3].map(equation);
        let link = |i: usize, k: usize| {
            let [[one, to_one], [other, to_other]] = [by_number[i], by_number[k]];
            [one * to_other, other * to_one]
        };
        let terms = [link(1, 2), link(2, 0), link(0, 1)];
        let largest = terms.iter().flatten().fold(0.0_f64, |most, term| most.max(term.norm()));
        let links = terms.map(|[one, other]| one - other);
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &k| links[i].norm().total_cmp(&links[k].norm()));
        // One link may vanish (three poses with one pole); then the others are equal, and positions remain.
        let matters = links[order[1]].norm() > ZERO * largest;
        matters
            .then(|| Compatibility { links: order.map(|k| links[k]), equations: order.map(|k| by_number[k]) })
    }

    /// Returns the frame of poses, the poses in it and their compatibility linkage; `None` if more than a curve of dyads meets them.
    fn scaled(poses: &[Pose; 4]) -> Option<(Scale, [Pose; 4], Self)> {
        let scale = Scale::of(poses)?;
        let poses = poses.map(|pose| scale.pose(&pose));
        let compatibility = Compatibility::of(&poses)?;
        Some((scale, poses, compatibility))
    }

    /// Returns the ground D1 + D2 + D3.
    fn ground(&self) -> Complex {
        self.links.iter().sum()
    }

    /// Returns the linkage's circuits.
    fn circuits(&self) -> Vec<Circuit> {
        let [drive, one, other] = self.links.map(|link| link.norm());
        let ground = self.ground();
        // |V|^2 = |S|^2 + |D1|^2 - 2 |S||D1| cos phi must lie between the squares of |D2| -+ |D3|.
        let (sum, product) = (ground.norm_sqr() + drive * drive, 2.0 * ground.norm() * drive);
        let cosine = |reach: f64| if product > 0.0 { (sum - reach * reach) / product } else { f64::NAN };
        // A limit of the cosine that is not one, or where there is none, is a full turn.
        let low = cosine(one + other).max(-1.0);
        let high = cosine(one - other).min(1.0);
        let limits = [high.clamp(-1.0, 1.0).acos(), low.clamp(-1.0, 1.0).acos()];
        let full = limits == [0.0, PI] || product == 0.0;
        match limits {
            _ if full => [1.0, -1.0].map(|side| Circuit::Turn { side }).into(),
            // One arc about phi = 0 or about phi = pi.
            [0.0, most] => vec![Circuit::Arc { middle: 0.0, reach: most }],
            [least, PI] => vec![Circuit::Arc { middle: PI, reach: PI - least }],
            [least, most] => {
                let (middle, reach) = (0.5 * (least + most), 0.5 * (most - least));
                [1.0, -1.0].map(|arc| Circuit::Arc { middle: arc * middle, reach: arc * reach }).into()
            }
        }
    }

    /// Returns the dyad at a place of the crank; `None` if there is none.
    fn dyad_at(&self, poses: &[Pose; 4], (phi, side): (f64, f64)) -> Option<Dyad> {
        self.dyad(poses, self.position(self.ground(), phi, side)?)
    }

    /// Returns the position at which D1 E1 lies at an angle phi from the ground, on a side; `None` if the loop is open.
    ///
    /// V = S - D1 E1 = D2 E2 + D3 E3.
    fn position(&self, ground: Complex, phi: f64, side: f64) -> Option<[Complex; 3]> {
        let [drive, one, other] = self.links;
        let from = if ground.norm() > 0.0 { ground / ground.norm() } else { Complex::new(1.0, 0.0) };
        let driven = from * Complex::from_polar(drive.norm(), phi);
        let v = ground - driven;
        let v_sq = v.norm_sqr();
        let (one_sq, other_sq) = (one.norm_sqr(), other.norm_sqr());
        let along = 0.5 * (1.0 + (one_sq - other_sq) / v_sq);
        let across_sq = one_sq / v_sq - along * along;
        // At the ends of an arc the root is zero to the rounding.
        if across_sq.is_nan() || across_sq < -OPEN {
            return None;
        }
        let first = v * Complex::new(along, side * across_sq.max(0.0).sqrt());
        let turn = |to: Complex, link: Complex| to / link * (link.norm() / to.norm());
        let turns = [
            if drive.norm() > 0.0 { turn(driven, drive) } else { Complex::from_polar(1.0, phi) },
            turn(first, one),
            turn(v - first, other),
        ];
        turns.iter().all(|turn| turn.is_finite()).then_some(turns)
    }

    /// Returns the dyad that turns its link so; `None` if it turns it nowhere, or is too far away.
    fn dyad(&self, poses: &[Pose; 4], turns: [Complex; 3]) -> Option<Dyad> {
        // The two equations whose determinant is largest.
        let equation = |k: usize| (turns[k] - 1.0, self.equations[k]);
        let pairs = [[0, 1], [0, 2], [1, 2]].map(|[i, k]| {
            let ((e1, [t1, d1]), (e2, [t2, d2])) = (equation(i), equation(k));
            (e1 * t2 - e2 * t1, [d1 * t2 - d2 * t1, e1 * d2 - e2 * d1])
        });
        let (determinant, [w, z]) =
            pairs.into_iter().max_by(|(one, _), (other, _)| one.norm().total_cmp(&other.norm()))?;
        let (w, z) = (w / determinant, z / determinant);
        let pin = -z * poses[0].direction.conj();
        let pivot = poses[0].position - z - w;
        let is_near = pin.norm() + pivot.norm() + w.norm() < FARTHEST;
        if !is_near {
            return None;
        }
        let length = poses.iter().map(|pose| (pose.at(pin) - pivot).norm()).sum::<f64>() / 4.0;
        let dyad = Dyad::RR { pin, pivot, length };
        (dyad.largest_residual(poses) <= EXACT * (1.0 + length) && length > ZERO).then_some(dyad)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{Moved, error, nearest, random_poses, size};
    use super::*;
    use crate::numbers::arithmetic::streams::stream;

    #[test]
    fn the_curve_of_four_poses_meets_them_and_passes_the_dyads_of_a_linkage() {
        let draws = &mut stream(27, 0);
        let (mut worst, mut all): (f64, usize) = (0.0, 0);
        for case in 0..50 {
            let poses: [Pose; 4] = random_poses(draws, 4).try_into().expect("four");
            let curve = through_four_curve(&poses, 100);
            assert!(curve.len() > 50 && curve.len() <= 100, "case {case}: {}", curve.len());
            all += curve.len();
            worst = curve.iter().map(|dyad| error(dyad, &poses)).fold(worst, f64::max);
        }
        assert!(worst < 1e-12 && all > 4500, "{worst:e}, {all}");
        let (mut passed, cases) = (0, 50);
        for _ in 0..cases {
            let moved = Moved::random(draws, 4);
            let poses: [Pose; 4] = moved.poses.clone().try_into().expect("four");
            let curve = through_four_curve(&poses, 2000);
            let passes = |dyad: &Dyad| nearest(dyad, &curve) < 0.1 * size(&poses);
            passed += usize::from(moved.dyads().iter().all(passes));
        }
        assert!(passed >= 45, "{passed} of {cases}");
    }

    #[test]
    fn strands_bend_as_finely_as_they_have_to_and_break_at_infinity_alone() {
        let draws = &mut stream(28, 0);
        let (mut worst, mut farthest, mut broken): (f64, f64, usize) = (0.0, 0.0, 0);
        for case in 0..50 {
            let poses: [Pose; 4] = random_poses(draws, 4).try_into().expect("four");
            let (scale, strands) = (Scale::of(&poses).expect("a scale"), four_curve_strands(&poses));
            assert!(!strands.is_empty(), "case {case}");
            for strand in &strands {
                worst = strand.dyads.iter().map(|dyad| error(dyad, &poses)).fold(worst, f64::max);
                let place = |dyad: &Dyad| match dyad {
                    Dyad::RR { pin, pivot, .. } => (*pin / scale.size, scale.place(*pivot)),
                    _ => panic!("an RR dyad"),
                };
                for pair in strand.dyads.windows(2) {
                    let [(m, g), (n, h)] = [place(&pair[0]), place(&pair[1])];
                    let of = |p: Complex, q: Complex| (p - q).norm() / p.norm().min(q.norm()).max(1.0);
                    farthest = farthest.max(of(m, n)).max(of(g, h));
                }
                broken += usize::from(!strand.is_closed);
            }
            // The places of the coarse curve lie on the fine one.
            let all: Vec<Dyad> = strands.iter().flat_map(|strand| strand.dyads.clone()).collect();
            for dyad in through_four_curve(&poses, 40) {
                let (m, g) = match dyad {
                    Dyad::RR { pin, pivot, .. } => (pin / scale.size, scale.place(pivot)),
                    _ => panic!("an RR dyad"),
                };
                let near = nearest(&dyad, &all) / scale.size;
                assert!(near < 0.1 * m.norm().max(g.norm()).max(1.0), "case {case}: {near}");
            }
        }
        assert!(worst < 1e-12 && farthest < ACROSS, "{worst:e} {farthest}");
        assert!(broken > 0);
    }
}
