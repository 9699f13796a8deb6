//! The coupler curve of a circuit: samples, length, and the distance from a point.
//!
//! A circuit is parametrised by tau in [0, 2 pi) as [`OnCircuit`] defines it.

use crate::mechanism::{AssemblyMode, Complex, FourBar, InputArc, OnCircuit, dot, length};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::LANES;
use std::f64::consts::TAU;

/// Default number of samples of a full circuit: 0.5 degrees apart.
pub const DEFAULT_SAMPLES: usize = 720;

/// A linkage that a crank drives, as far as its coupler curve asks.
pub trait CrankDriven: Copy {
    /// Returns the same linkage with the given sign of the closure's root.
    #[must_use]
    fn with_assembly(self, assembly: AssemblyMode) -> Self;

    /// Returns t1, the sign of the closure's root.
    fn assembly(&self) -> AssemblyMode;

    /// Computes P at a crank angle (radians) in the given assembly; `None` if the loop is open.
    fn coupler_point_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Complex>;

    /// Returns the arc on which the crank rocks in the circuit of a position; `None` if it turns fully or cannot move.
    fn arc_of(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<InputArc>;
}

impl CrankDriven for FourBar {
    fn with_assembly(self, assembly: AssemblyMode) -> Self {
        FourBar::with_assembly(self, assembly)
    }

    fn assembly(&self) -> AssemblyMode {
        FourBar::assembly(self)
    }

    fn coupler_point_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Complex> {
        self.position_with(crank_angle, assembly).joints().map(|joints| joints.coupler_point)
    }

    fn arc_of(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<InputArc> {
        let mobility = self.mobility();
        mobility.arc(mobility.branch(crank_angle, assembly).circuit)
    }
}

/// The coupler curve of one circuit.
#[derive(Clone, Debug)]
pub struct CouplerCurve<L = FourBar> {
    on: OnCircuit<L>,
    /// P at tau = 2 pi i / n; `None` if the loop is open (only within rounding of a toggle).
    samples: Vec<Option<Complex>>,
    /// The samples as columns of x and y, infinitely far away if the loop is open: a loop over them becomes vector
    /// instructions.
    columns: [Vec<f64>; 2],
    /// The largest distance between neighbouring samples.
    longest_chord: f64,
}

/// The nearest point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The parameter tau of the circuit at the nearest point.
    pub parameter: f64,
    /// The nearest point of the curve.
    pub point: Complex,
    /// Its distance from the given point.
    pub distance: f64,
}

impl<L: CrankDriven> CouplerCurve<L> {
    /// Samples the curve of the circuit that holds the given position, with `samples` samples (at least 8).
    pub fn through(linkage: &L, crank_angle: f64, assembly: AssemblyMode, samples: usize) -> Self {
        let on = OnCircuit::through(linkage, crank_angle, assembly);
        let n = samples.max(8);
        let samples = (0..n).map(|i| on.point_at(TAU * i as f64 / n as f64)).collect();
        let mut curve = CouplerCurve { on, samples, columns: [Vec::new(), Vec::new()], longest_chord: 0.0 };
        let column =
            |of: fn(Complex) -> f64| curve.samples.iter().map(|p| p.map_or(f64::INFINITY, of)).collect();
        curve.columns = [column(|p| p.re), column(|p| p.im)];
        curve.longest_chord = (0..n).map(|i| curve.chord(i, (i + 1) % n)).fold(0.0, f64::max);
        curve
    }

    /// Returns the crank angle and the assembly mode at a parameter of the circuit.
    pub fn position_at(&self, parameter: f64) -> (f64, AssemblyMode) {
        self.on.position_at(parameter)
    }

    /// Computes P at a parameter of the circuit; `None` if the loop is open.
    pub fn point_at(&self, parameter: f64) -> Option<Complex> {
        self.on.point_at(parameter)
    }

    /// Iterates over the sampled points in the order of the parameter.
    pub fn points(&self) -> impl Iterator<Item = Complex> + '_ {
        self.samples.iter().flatten().copied()
    }

    /// Computes the length of the closed curve, as the sum of the chords between samples.
    pub fn length(&self) -> f64 {
        let points: Vec<Complex> = self.points().collect();
        (0..points.len()).map(|i| length(points[(i + 1) % points.len()] - points[i])).sum()
    }

    /// Returns the distance between two samples; 0 if one of them is open.
    fn chord(&self, i: usize, j: usize) -> f64 {
        match (self.samples[i], self.samples[j]) {
            (Some(p), Some(q)) => length(p - q),
            _ => 0.0,
        }
    }

    /// Computes the nearest point of the curve; `None` for a curve without a point.
    ///
    /// Every sample that is a local minimum of the distance and could still be the nearest (its distance less the
    /// longest chord next to it is below the best) is refined by successive interpolation, or by golden section if that
    /// fails, between its neighbours.
    pub fn nearest(&self, to: Complex) -> Option<Nearest> {
        let n = self.samples.len();
        let mut coarse = vec![0.0; n];
        let mut least = [f64::INFINITY; LANES];
        vectorised(
            #[inline(always)]
            || {
                let [xs, ys] = [&self.columns[0][..n], &self.columns[1][..n]];
                for (distance, (x, y)) in coarse[..n].iter_mut().zip(xs.iter().zip(ys)) {
                    *distance = length(Complex::new(x - to.re, y - to.im));
                }
                for block in coarse.chunks(LANES) {
                    for (least, distance) in least.iter_mut().zip(block) {
                        *least = if distance < least { *distance } else { *least };
                    }
                }
            },
        );
        let best = least.into_iter().fold(f64::INFINITY, f64::min);
        let step = TAU / n as f64;
        let mut nearest: Option<Nearest> = None;
        for i in 0..n {
            if !coarse[i].is_finite() || coarse[i] - self.longest_chord > best {
                continue;
            }
            let [left, right] = [if i == 0 { n - 1 } else { i - 1 }, if i + 1 == n { 0 } else { i + 1 }];
            if coarse[i] > coarse[left] || coarse[i] > coarse[right] {
                continue;
            }
            let reach = self.chord(i, right).max(self.chord(i, left));
            if coarse[i] - reach > best {
                continue;
            }
            let middle = i as f64 * step;
            let around = [i, left, right].map(|j| self.samples[j]);
            let sampled = Nearest { parameter: middle, point: self.samples[i]?, distance: coarse[i] };
            let refined = self
                .interpolated(to, [middle, step], around)
                .or_else(|| self.golden_section(to, middle, step))
                .unwrap_or(sampled);
            if nearest.is_none_or(|n| refined.distance < n.distance) {
                nearest = Some(refined);
            }
        }
        nearest
    }

    /// Finds the local minimum of the distance over [middle - step, middle + step] by successive interpolation: the
    /// vector P - T is interpolated by a quadratic through the last three positions, whose nearest point to T is the
    /// next one. Interpolating the vector instead of its square keeps all digits where the curve passes through T.
    ///
    /// `around`: P at middle, middle - step and middle + step. `None` if the search leaves the interval, ends at no
    /// minimum or does not settle: on corners, at toggles, between two minima.
    fn interpolated(
        &self,
        to: Complex,
        [middle, step]: [f64; 2],
        around: [Option<Complex>; 3],
    ) -> Option<Nearest> {
        // After a last step of 1e-9 rad the parameter's error is smaller still, and next to a minimum the distance differs
        // by its square. Steps below 1e-6 that no longer shrink are rounding of the differences, in proportion to the
        // distance: their square is rounding of the distance too.
        const SETTLED: f64 = 1e-9;
        const ROUNDING: f64 = 1e-6;
        const ROUNDS: usize = 12;
        let [here, before, after] = around;
        let first = length(here? - to);
        let mut places = [(middle, here? - to), (middle - step, before? - to), (middle + step, after? - to)];
        let mut last = step;
        for _ in 0..ROUNDS {
            let by = nearest_of_quadratic(places)?;
            let parameter = places[0].0 + by;
            if (parameter - middle).abs() > step {
                return None;
            }
            let point = self.point_at(parameter)?;
            places = [(parameter, point - to), places[0], places[1]];
            let shrinks = by.abs() <= 0.25 * last;
            last = by.abs();
            if last <= SETTLED || (last <= ROUNDING && !shrinks) {
                let distance = length(point - to);
                return (distance <= first).then_some(Nearest { parameter, point, distance });
            }
        }
        None
    }

    /// Minimises the squared distance over [middle - step, middle + step] by golden section.
    fn golden_section(&self, to: Complex, middle: f64, step: f64) -> Option<Nearest> {
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

/// Computes the shift s from the first of three places (t, r) to the point at which the quadratic through them is
/// nearest to r = 0, near that place; `None` if two of the places are one, or if the distance has no minimum there.
///
/// r(t0 + s) = r0 + v s + w s^2 with divided differences v and w; Newton's method on the derivative of |r|^2 / 2, which
/// is r . (v + 2 w s).
fn nearest_of_quadratic([(t0, r0), (t1, r1), (t2, r2)]: [(f64, Complex); 3]) -> Option<f64> {
    const ROUNDS: usize = 6;
    if t0 == t1 || t0 == t2 || t1 == t2 {
        return None;
    }
    let (first, second) = ((r1 - r0) / (t1 - t0), (r2 - r1) / (t2 - t1));
    let w = (second - first) / (t2 - t0);
    let v = first + w * (t0 - t1);
    let mut s = 0.0;
    for _ in 0..ROUNDS {
        let (r, along) = (r0 + v * s + w * (s * s), v + w * (2.0 * s));
        let curvature = dot(along, along) + 2.0 * dot(r, w);
        if curvature <= 0.0 {
            return None;
        }
        let by = dot(r, along) / curvature;
        s -= by;
        if by.abs() <= 1e-3 * s.abs() {
            return s.is_finite().then_some(s);
        }
    }
    s.is_finite().then_some(s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Circuit;
    use crate::numbers::arithmetic::streams::{stream, uniform};
    use crate::thorough::cases;

    /// Returns linkages of each type, and one near a change point.
    fn linkages() -> Vec<FourBar> {
        let shapes = [
            ([4.0, 2.0, 5.0, 5.0], [2.5, 4.3]),
            ([2.0, 5.0, 4.0, 4.5], [-1.0, 3.0]),
            ([5.0, 5.0, 4.0, 2.0], [2.0, -3.0]),
            ([4.0, 5.0, 1.5, 4.5], [9.0, 0.5]),
            ([5.0, 4.0, 4.0, 4.2], [1.0, 2.0]),
            ([4.0, 2.0, 5.0, 3.000_001], [2.5, 1.5]),
        ];
        let linkage = |([g, a, b, c], [x, y]): ([f64; 4], [f64; 2])| {
            let pivots = [Complex::new(1.0, -2.0), Complex::new(1.0 + g, -2.0)];
            let offset = Complex::new(x, y);
            FourBar::with_coupler_offset(pivots, [a, b, c], offset, AssemblyMode::Plus).expect("lengths")
        };
        shapes.into_iter().map(linkage).collect()
    }

    /// Tolerance of a distance, as a part of 1 + the distance: next to a change point the curve all but has a corner,
    /// and an error of 1e-8 in the parameter shows there.
    const WITHIN: f64 = 1e-11;

    #[test]
    fn interpolation_finds_what_golden_section_finds() {
        let draws = &mut stream(7, 0);
        let (mut interpolated, mut tried) = (0, 0);
        let places = cases(100, 400);
        for linkage in linkages() {
            let angle = linkage.mobility().arc(Circuit { index: 0 }).map_or(0.3, |arc| arc.middle);
            let curve = CouplerCurve::through(&linkage, angle, AssemblyMode::Plus, DEFAULT_SAMPLES);
            let step = TAU / DEFAULT_SAMPLES as f64;
            for _ in 0..places {
                let to = Complex::new(uniform(draws, -9.0, 12.0), uniform(draws, -9.0, 9.0));
                let nearest = curve.nearest(to).expect("a curve");
                let least = (0..DEFAULT_SAMPLES)
                    .filter_map(|i| curve.golden_section(to, i as f64 * step, step))
                    .map(|n| n.distance)
                    .fold(f64::INFINITY, f64::min);
                let off = nearest.distance - least;
                assert!(off.abs() <= WITHIN * (1.0 + least), "{to} {nearest:?} {least} {off:e}");
                let i = (nearest.parameter / step).round() as usize % DEFAULT_SAMPLES;
                let n = DEFAULT_SAMPLES;
                let around = [i, (i + n - 1) % n, (i + 1) % n].map(|j| curve.samples[j]);
                tried += 1;
                interpolated +=
                    usize::from(curve.interpolated(to, [i as f64 * step, step], around).is_some());
            }
        }
        assert!(interpolated * 100 >= 90 * tried, "{interpolated} of {tried}");
    }

    #[test]
    fn a_point_of_the_curve_is_at_no_distance() {
        let draws = &mut stream(8, 0);
        for linkage in linkages() {
            let angle = linkage.mobility().arc(Circuit { index: 0 }).map_or(0.3, |arc| arc.middle);
            let curve = CouplerCurve::through(&linkage, angle, AssemblyMode::Plus, DEFAULT_SAMPLES);
            let points: Vec<Complex> =
                (0..400).filter_map(|_| curve.point_at(uniform(draws, 0.0, TAU))).collect();
            assert!(points.len() >= 396, "{}", points.len());
            for to in points {
                let distance = curve.nearest(to).expect("a curve").distance;
                assert!(distance <= 1e-12, "{to} {distance:e}");
            }
        }
    }
}
