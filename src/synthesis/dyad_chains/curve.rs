//! Curves of random chains: samples, points at equal arcs, and how well those correlate with a target.

use super::draw::Drawn;
use super::target::Variant;
use crate::mechanism::dyad_chain::kinds::CRANK;
use crate::mechanism::dyad_chain::{Frames, Grid, Proportions};
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// Phases at which a curve is sampled.
pub(super) const TRACED: usize = 128;
/// Points at equal arcs.
pub(super) const EVEN: usize = 64;
/// Harmonics of each sign.
const HARMONICS: usize = 10;

/// x and y of points at equal arcs, centred and of unit norm.
pub(super) type Even = [[f64; EVEN]; 2];

/// |X_h| for h = 1 .. [`HARMONICS`], then for h = -1 .. ; the sum of the squares of all harmonics is 1.
pub(super) type Magnitudes = [f32; 2 * HARMONICS];

/// A curve at evenly spaced phases, with the share of its length up to each.
pub(super) struct Curve {
    points: [[f64; TRACED]; 2],
    along: [f64; TRACED + 1],
}

fn cranks() -> &'static [ComplexLanes; TRACED / LANES] {
    static CRANKS: OnceLock<[ComplexLanes; TRACED / LANES]> = OnceLock::new();
    CRANKS.get_or_init(|| {
        std::array::from_fn(|block| {
            let mut e = ComplexLanes::ZERO;
            for lane in 0..LANES {
                e.set(lane, Complex::from_polar(1.0, TAU * (LANES * block + lane) as f64 / TRACED as f64));
            }
            e
        })
    })
}

/// Calls `put` with the place of a sample, and with o and v of the link that carries P there, for eight samples at a time; returns the
/// proportions of the chain.
#[inline(always)]
pub(super) fn sampled(
    drawn: &Drawn,
    grid: &mut Grid,
    mut put: impl FnMut(usize, ComplexLanes, ComplexLanes),
) -> Proportions {
    let of = drawn.shape.resolve(grid);
    let mut frames = Frames::<F64x8>::of(ComplexLanes::ZERO);
    let body = of.kind.traced();
    for (block, e) in cranks().iter().enumerate() {
        frames.along[CRANK] = *e;
        frames.assemble_all(&of);
        put(LANES * block, frames.origin[body], frames.along[body]);
    }
    of
}

impl Curve {
    /// Samples the curve of a chain in the frame A = 0, B = 1; `None` if it has no length.
    pub(super) fn of(drawn: &Drawn, grid: &mut Grid) -> Option<(Curve, Proportions)> {
        let mut points = [[0.0; TRACED]; 2];
        let z = ComplexLanes::splat(drawn.place);
        let of = vectorised(
            #[inline(always)]
            || {
                sampled(
                    drawn,
                    grid,
                    #[inline(always)]
                    |at, o, v| {
                        let p = o + z * v;
                        p.re.store(&mut points[0], at);
                        p.im.store(&mut points[1], at);
                    },
                )
            },
        );
        let mut along = [0.0; TRACED + 1];
        for i in 0..TRACED {
            let next = (i + 1) % TRACED;
            let [dx, dy] = [0, 1].map(|axis| points[axis][next] - points[axis][i]);
            along[i + 1] = along[i] + (dx * dx + dy * dy).sqrt();
        }
        let whole = along[TRACED];
        (whole > 0.0 && whole.is_finite()).then(|| {
            along.iter_mut().for_each(|s| *s /= whole);
            (Curve { points, along }, of)
        })
    }

    /// Calls `put` with the number, the point and the phase at rising shares of the length, below 2; those of 1 and more go on
    /// into a second turn.
    fn sample(&self, shares: impl Iterator<Item = f64>, mut put: impl FnMut(usize, Complex, f64)) {
        let (mut i, mut turns) = (0, 0.0);
        for (m, share) in shares.enumerate() {
            if share - turns >= 1.0 {
                (turns, i) = (turns + 1.0, 0);
            }
            let at = share - turns;
            while i + 1 < TRACED && self.along[i + 1] <= at {
                i += 1;
            }
            let (from, to) = (self.along[i], self.along[i + 1]);
            let part = if to > from { (at - from) / (to - from) } else { 0.0 };
            let next = (i + 1) % TRACED;
            let [x, y] =
                [0, 1].map(|k| self.points[k][i] + (self.points[k][next] - self.points[k][i]) * part);
            put(m, Complex::new(x, y), TAU * (turns + (i as f64 + part) / TRACED as f64));
        }
    }

    /// Returns points at equal arcs of a part of the curve, and the rms radius before they were normalised; the step from one
    /// to the next is `share / steps`.
    pub(super) fn even(&self, [from, share]: [f64; 2], steps: usize) -> (Even, f64) {
        let mut points = [[0.0; EVEN]; 2];
        let shares = (0..EVEN).map(|m| from + share * m as f64 / steps as f64);
        self.sample(shares, |m, p, _| (points[0][m], points[1][m]) = (p.re, p.im));
        let mut norm_sq = 0.0;
        for x in &mut points {
            let mean = x.iter().sum::<f64>() / EVEN as f64;
            x.iter_mut().for_each(|x| *x -= mean);
            norm_sq += x.iter().map(|x| x * x).sum::<f64>();
        }
        let norm = norm_sq.sqrt();
        points.iter_mut().flatten().for_each(|x| *x /= norm);
        (points, norm / (EVEN as f64).sqrt())
    }

    /// Returns the phases at equal arcs of a part of the curve, from its beginning to its end.
    pub(super) fn phases(&self, [from, share]: [f64; 2]) -> Vec<f64> {
        let mut phases = Vec::with_capacity(EVEN + 1);
        let shares = (0..=EVEN).map(|m| from + share * m as f64 / EVEN as f64);
        self.sample(shares, |_, _, phase| phases.push(phase));
        phases
    }
}

/// Computes the magnitudes of the Fourier coefficients of points at equal arcs.
pub(super) fn magnitudes(points: &Even) -> Magnitudes {
    vectorised(
        #[inline(always)]
        || magnitudes_inlined(points),
    )
}

#[inline(always)]
fn magnitudes_inlined([x, y]: &Even) -> Magnitudes {
    static TABLE: OnceLock<Box<[Even; HARMONICS]>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let angle = |h: usize, k: usize| TAU * ((h + 1) * k % EVEN) as f64 / EVEN as f64;
        Box::new(std::array::from_fn(|h| {
            [std::array::from_fn(|k| angle(h, k).cos()), std::array::from_fn(|k| angle(h, k).sin())]
        }))
    });
    let mut out = [0.0; 2 * HARMONICS];
    for (h, [cos, sin]) in table.iter().enumerate() {
        let mut sums = [F64x8::splat(0.0); 4];
        for at in (0..EVEN).step_by(LANES) {
            let (x, y) = (F64x8::load(x, at), F64x8::load(y, at));
            let (c, s) = (F64x8::load(cos, at), F64x8::load(sin, at));
            sums[0] = sums[0] + x * c;
            sums[1] = sums[1] + y * s;
            sums[2] = sums[2] + y * c;
            sums[3] = sums[3] + x * s;
        }
        let [xc, ys, yc, xs] = sums.map(|sum| sum.sum());
        let size = |re: f64, im: f64| ((re * re + im * im) / EVEN as f64).sqrt() as f32;
        out[h] = size(xc + ys, yc - xs);
        out[HARMONICS + h] = size(xc - ys, yc + xs);
    }
    out
}

/// Returns an upper bound, up to the harmonics that are left out, of the correlation of two closed curves at every shift, in
/// all four variants: reversed and mirrored curves have h and -h exchanged.
pub(super) fn bound(one: &Magnitudes, other: &Magnitudes) -> f32 {
    let (ahead, back) = other.split_at(HARMONICS);
    let (first, second) = one.split_at(HARMONICS);
    let sum = |x: &[f32], y: &[f32]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f32>();
    (sum(first, ahead) + sum(second, back)).max(sum(first, back) + sum(second, ahead))
}

/// Returns |sum conj(x_k) y_k|.
pub(super) fn correlation([x, y]: &Even, [u, v]: &Even) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for k in 0..EVEN {
        re += x[k] * u[k] + y[k] * v[k];
        im += x[k] * v[k] - y[k] * u[k];
    }
    (re * re + im * im).sqrt()
}

/// Returns the variant of the target and the shift of the curve's points with the highest correlation, and that.
pub(super) fn best_shift(points: &Even, wanted: &[Even]) -> (Variant, usize, f64) {
    vectorised(
        #[inline(always)]
        || best_shift_inlined(points, wanted),
    )
}

#[inline(always)]
fn best_shift_inlined(points: &Even, wanted: &[Even]) -> (Variant, usize, f64) {
    // Twice around, so that every shift is one range.
    let mut around = [[0.0_f32; 2 * EVEN]; 2];
    for (around, own) in around.iter_mut().zip(points) {
        for (k, x) in own.iter().enumerate() {
            (around[k], around[k + EVEN]) = (*x as f32, *x as f32);
        }
    }
    let mut best = (Variant::ALL[0], 0, -1.0_f32);
    for (variant, [u, v]) in Variant::ALL.into_iter().zip(wanted) {
        let (mut re, mut im) = ([0.0_f32; EVEN], [0.0_f32; EVEN]);
        for k in 0..EVEN {
            let (u, v) = (u[k] as f32, v[k] as f32);
            let (x, y) = (&around[0][k..k + EVEN], &around[1][k..k + EVEN]);
            for shift in 0..EVEN {
                re[shift] += x[shift] * u + y[shift] * v;
                im[shift] += x[shift] * v - y[shift] * u;
            }
        }
        for shift in 0..EVEN {
            let score = (re[shift] * re[shift] + im[shift] * im[shift]).sqrt();
            if score > best.2 {
                best = (variant, shift, score);
            }
        }
    }
    (best.0, best.1, f64::from(best.2))
}
