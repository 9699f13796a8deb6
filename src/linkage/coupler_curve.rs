//! The coupler curve of a circuit: samples, length, and the distance from a point.
//!
//! A circuit is run through by one parameter tau in [0, 2 pi): the crank angle itself where the input turns
//! fully, psi of [`InputArc`](super::InputArc) where it rocks (there t1 = sign cos tau, so that both branches
//! and their toggles are passed smoothly).

use super::dispatch::vectorised;
use super::{AssemblyMode, Circuit, Complex, FourBar, Mobility, dot, length};
use std::f64::consts::TAU;

/// How many samples a full circuit gets when nothing else is asked: 0.5 degrees apart.
pub const DEFAULT_SAMPLES: usize = 720;

/// The coupler curve of one circuit.
#[derive(Clone, Debug)]
pub struct CouplerCurve {
    linkage: FourBar,
    mobility: Mobility,
    circuit: Circuit,
    /// P at tau = 2 pi i / n; `None` where the loop is open (only within rounding of a toggle).
    samples: Vec<Option<Complex>>,
    /// The same as columns of x and y, infinitely far away where the loop is open: a loop over them becomes vector
    /// instructions.
    columns: [Vec<f64>; 2],
}

/// The nearest point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The parameter of the circuit.
    pub parameter: f64,
    /// The point.
    pub point: Complex,
    /// Its distance.
    pub distance: f64,
}

impl CouplerCurve {
    /// The curve of the circuit that holds the given position, with `samples` samples (at least 8).
    pub fn through(linkage: &FourBar, crank_angle: f64, assembly: AssemblyMode, samples: usize) -> Self {
        let mobility = linkage.mobility();
        let circuit = mobility.branch(crank_angle, assembly).circuit;
        let linkage = linkage.with_assembly(assembly);
        let columns = [Vec::new(), Vec::new()];
        let mut curve = CouplerCurve { linkage, mobility, circuit, samples: Vec::new(), columns };
        let n = samples.max(8);
        curve.samples = (0..n).map(|i| curve.point_at(TAU * i as f64 / n as f64)).collect();
        let column =
            |of: fn(Complex) -> f64| curve.samples.iter().map(|p| p.map_or(f64::INFINITY, of)).collect();
        curve.columns = [column(|p| p.re), column(|p| p.im)];
        curve
    }

    /// The crank angle and the assembly at a parameter of the circuit.
    pub fn position_at(&self, parameter: f64) -> (f64, AssemblyMode) {
        match self.mobility.arc(self.circuit) {
            None => (parameter, self.linkage.assembly()),
            Some(arc) => (arc.crank_angle(parameter), AssemblyMode::of(parameter.cos())),
        }
    }

    /// P at a parameter of the circuit; `None` where the loop is open.
    pub fn point_at(&self, parameter: f64) -> Option<Complex> {
        let (crank_angle, assembly) = self.position_at(parameter);
        self.linkage.position_with(crank_angle, assembly).joints().map(|j| j.coupler_point)
    }

    /// The sampled points in the order of the parameter.
    pub fn points(&self) -> impl Iterator<Item = Complex> + '_ {
        self.samples.iter().flatten().copied()
    }

    /// The length of the closed curve, as the sum of the chords between samples.
    pub fn length(&self) -> f64 {
        let points: Vec<Complex> = self.points().collect();
        (0..points.len()).map(|i| length(points[(i + 1) % points.len()] - points[i])).sum()
    }

    /// The nearest point of the curve; `None` for a curve without a point.
    ///
    /// Every sample that is a local minimum of the distance and could still win (its distance less the
    /// longest chord next to it is below the best) is refined by golden section between its neighbours.
    pub fn nearest(&self, to: Complex) -> Option<Nearest> {
        let n = self.samples.len();
        let mut coarse = vec![0.0; n];
        vectorised(
            #[inline(always)]
            || {
                let [xs, ys] = [&self.columns[0][..n], &self.columns[1][..n]];
                for (distance, (x, y)) in coarse[..n].iter_mut().zip(xs.iter().zip(ys)) {
                    *distance = length(Complex::new(x - to.re, y - to.im));
                }
            },
        );
        let best = coarse.iter().copied().fold(f64::INFINITY, f64::min);
        let step = TAU / n as f64;
        let mut nearest: Option<Nearest> = None;
        for i in 0..n {
            let (before, after) = (coarse[(i + n - 1) % n], coarse[(i + 1) % n]);
            if !coarse[i].is_finite() || coarse[i] > before || coarse[i] > after {
                continue;
            }
            let chord = |j: usize| match (self.samples[i], self.samples[j]) {
                (Some(p), Some(q)) => length(p - q),
                _ => 0.0,
            };
            let reach = chord((i + 1) % n).max(chord((i + n - 1) % n));
            if coarse[i] - reach > best {
                continue;
            }
            let middle = i as f64 * step;
            let refined = self.refine(to, middle, step).unwrap_or(Nearest {
                parameter: middle,
                point: self.samples[i]?,
                distance: coarse[i],
            });
            if nearest.is_none_or(|n| refined.distance < n.distance) {
                nearest = Some(refined);
            }
        }
        nearest
    }

    /// Golden section on the squared distance over [middle - step, middle + step].
    fn refine(&self, to: Complex, middle: f64, step: f64) -> Option<Nearest> {
        const GOLDEN: f64 = 0.618_033_988_749_894_8;
        // 0.618^60 of a step is below the rounding of the parameter.
        const ROUNDS: usize = 60;
        let value = |t: f64| self.point_at(t).map_or(f64::INFINITY, |p| dot(p - to, p - to));
        let (mut low, mut high) = (middle - step, middle + step);
        let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_left, mut at_right) = (value(left), value(right));
        for _ in 0..ROUNDS {
            if at_left <= at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = value(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = value(right);
            }
        }
        [0.5 * (low + high), middle]
            .into_iter()
            .filter_map(|t| {
                let p = self.point_at(t)?;
                Some(Nearest { parameter: t, point: p, distance: length(p - to) })
            })
            .min_by(|x, y| x.distance.total_cmp(&y.distance))
    }
}
