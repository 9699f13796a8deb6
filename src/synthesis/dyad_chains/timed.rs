//! Starts of fits with prescribed timing: the random chains that are nearest to the target at its phases, T, S and Z fitted.
//!
//! With the phases known, o and v are, and P = T + S o + Z v is linear in T, S and Z. Each draw is sampled once over its turn; for
//! each of a few offsets of the phases the least squares of three complex numbers remain (of the real s in S = s e^{-i omega},
//! where phases count from the x axis; derived here).

use super::atlas::{Atlas, CHUNK, Start, TOO_LONG, longest};
use super::curve::{TRACED, sampled};
use super::draw::{Drawn, drawn};
use super::target::{Target, Variant};
use crate::mechanism::dyad_chain::sizes::{Side, sides};
use crate::mechanism::dyad_chain::{DyadChain, Grid, Placement, Proportions};
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::streams::stream;
use crate::task::AngleOffset;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Offsets of prescribed phases that are tried, and the samples between two of them.
const OFFSETS: usize = 32;
const BETWEEN: usize = TRACED / OFFSETS;
/// The most points that a draw is compared at.
const COMPARED: usize = 24;
/// Share of the product of both variances below which o and v are too nearly proportional.
const INDEPENDENT: f64 = 1e-9;

/// The frame (o, v) of the link that carries P at evenly spaced phases: x and y of o, then of v, twice around; every
/// `BETWEEN`-th sample stands together.
struct TracedFrames {
    samples: [[[f64; 2 * OFFSETS]; BETWEEN]; 4],
}

/// A phase between two samples.
struct TracedPlace {
    sample: usize,
    part: f64,
}

impl TracedPlace {
    /// Returns the place of a phase.
    fn of(phase: f64) -> Self {
        let place = (phase / TAU).rem_euclid(1.0) * TRACED as f64;
        let sample = (place as usize).min(TRACED - 1);
        TracedPlace { sample, part: place - sample as f64 }
    }
}

impl TracedFrames {
    /// Samples a chain in the frame A = 0, B = 1; `None` if a number is not finite.
    fn of(drawn: &Drawn, grid: &mut Grid) -> Option<(TracedFrames, Proportions)> {
        let mut flat = [[0.0; TRACED]; 4];
        let of = vectorised(
            #[inline(always)]
            || {
                sampled(
                    drawn,
                    grid,
                    #[inline(always)]
                    |at, o, v| {
                        for (to, x) in flat.iter_mut().zip([o.re, o.im, v.re, v.im]) {
                            x.store(to, at);
                        }
                    },
                )
            },
        );
        if !flat.iter().flatten().all(|x| x.is_finite()) {
            return None;
        }
        let mut samples = [[[0.0; 2 * OFFSETS]; BETWEEN]; 4];
        for (samples, flat) in samples.iter_mut().zip(&flat) {
            for (i, x) in flat.iter().enumerate() {
                let own = &mut samples[i % BETWEEN];
                (own[i / BETWEEN], own[i / BETWEEN + OFFSETS]) = (*x, *x);
            }
        }
        Some((TracedFrames { samples }, of))
    }

    /// Returns x and y of o and of v at a phase and all offsets, between two samples in proportion.
    #[inline(always)]
    fn around(&self, at: &TracedPlace) -> [[f64; OFFSETS]; 4] {
        let next = at.sample + 1;
        let mut out = [[0.0; OFFSETS]; 4];
        for (out, samples) in out.iter_mut().zip(&self.samples) {
            let from = &samples[at.sample % BETWEEN][at.sample / BETWEEN..][..OFFSETS];
            let to = &samples[next % BETWEEN][next / BETWEEN..][..OFFSETS];
            for k in 0..OFFSETS {
                out[k] = from[k] + (to[k] - from[k]) * at.part;
            }
        }
        out
    }
}

/// A number at each offset of the phases.
type AtOffsets = [f64; OFFSETS];

/// Points that a draw is compared at: the phase without an offset, the point, and its mirror image.
struct Compared {
    places: Vec<(TracedPlace, [Complex; 2])>,
    /// The sums of the points, and of their squares from the mean.
    sums: [Complex; 2],
    square: f64,
}

impl Compared {
    /// Chooses some of the points of a target with prescribed phases.
    fn of(target: &Target) -> Option<Compared> {
        let [own, mirrored] = [false, true].map(|mirrored| {
            let variant = Variant { reversed: false, mirrored };
            &target.few[variant.index()]
        });
        let angles = &own.timing.as_ref()?.angles;
        let step = own.count.div_ceil(COMPARED);
        let places: Vec<(TracedPlace, [Complex; 2])> = (0..own.count)
            .step_by(step)
            .map(|i| (TracedPlace::of(angles[i]), [own, mirrored].map(|points| points.point(i))))
            .collect();
        let sums = [0, 1].map(|variant| places.iter().map(|(_, p)| p[variant]).sum::<Complex>());
        let mean = sums[0] / places.len() as f64;
        let square = places.iter().map(|(_, p)| (p[0] - mean).norm_sqr()).sum();
        Some(Compared { places, sums, square })
    }
}

/// Sums over the points of products of o, v and the target, at each offset.
struct Sums {
    o: [AtOffsets; 2],
    v: [AtOffsets; 2],
    oo: AtOffsets,
    vv: AtOffsets,
    ov: [AtOffsets; 2],
    /// conj(o) t and conj(v) t for the target and for its mirror image.
    ot: [[AtOffsets; 2]; 2],
    vt: [[AtOffsets; 2]; 2],
}

impl Sums {
    #[inline(always)]
    fn of(frames: &TracedFrames, compared: &Compared) -> Sums {
        const ZERO: AtOffsets = [0.0; OFFSETS];
        let mut s = Sums {
            o: [ZERO; 2],
            v: [ZERO; 2],
            oo: ZERO,
            vv: ZERO,
            ov: [ZERO; 2],
            ot: [[ZERO; 2]; 2],
            vt: [[ZERO; 2]; 2],
        };
        for (place, targets) in &compared.places {
            let [ox, oy, vx, vy] = frames.around(place);
            for k in 0..OFFSETS {
                let (ox, oy, vx, vy) = (ox[k], oy[k], vx[k], vy[k]);
                s.o[0][k] += ox;
                s.o[1][k] += oy;
                s.v[0][k] += vx;
                s.v[1][k] += vy;
                s.oo[k] += ox * ox + oy * oy;
                s.vv[k] += vx * vx + vy * vy;
                s.ov[0][k] += ox * vx + oy * vy;
                s.ov[1][k] += ox * vy - oy * vx;
                for (variant, t) in targets.iter().enumerate() {
                    s.ot[variant][0][k] += ox * t.re + oy * t.im;
                    s.ot[variant][1][k] += ox * t.im - oy * t.re;
                    s.vt[variant][0][k] += vx * t.re + vy * t.im;
                    s.vt[variant][1][k] += vx * t.im - vy * t.re;
                }
            }
        }
        s
    }

    /// Fits T, S and Z at an offset; returns them with 1 less the part of the target's mean square that is left.
    fn fitted(
        &self,
        compared: &Compared,
        k: usize,
        variant: usize,
        of: AngleOffset,
    ) -> Option<(f64, Placement)> {
        let n = compared.places.len() as f64;
        let number = |of: &[AtOffsets; 2]| Complex::new(of[0][k], of[1][k]);
        let (o, v, t) = (number(&self.o) / n, number(&self.v) / n, compared.sums[variant] / n);
        let oo = self.oo[k] - n * o.norm_sqr();
        let vv = self.vv[k] - n * v.norm_sqr();
        let ov = number(&self.ov) - o.conj() * v * n;
        let ot = number(&self.ot[variant]) - o.conj() * t * n;
        let vt = number(&self.vt[variant]) - v.conj() * t * n;
        let det = oo * vv - ov.norm_sqr();
        if det.is_nan() || det <= INDEPENDENT * oo * vv {
            return None;
        }
        let ground = if of == AngleOffset::Fixed {
            // S = s e^{-i omega}: of o and t what Z v does not reach.
            let turn = Complex::from_polar(1.0, -offset(k));
            let s = ((ot - ov * vt / vv) * turn.conj()).re * vv / det;
            if s <= 0.0 {
                return None;
            }
            turn * s
        } else {
            (ot * vv - ov * vt) / det
        };
        let pointer = (vt - ov.conj() * ground) / vv;
        // |t - S o - Z v|^2, summed.
        let left = compared.square + ground.norm_sqr() * oo + pointer.norm_sqr() * vv
            - 2.0 * (ground.conj() * ot + pointer.conj() * vt - ground.conj() * pointer * ov).re;
        let origin = t - ground * o - pointer * v;
        Some((1.0 - left / compared.square, Placement { origin, ground, pointer }))
    }
}

/// Returns an offset of the phases by its number.
fn offset(k: usize) -> f64 {
    TAU * k as f64 / OFFSETS as f64
}

/// Returns the best `most`, the best first; of equal ones the first drawn.
fn best_of(mut starts: Vec<Start>, most: usize) -> Vec<Start> {
    starts.sort_by(|a, b| b.score.total_cmp(&a.score));
    starts.truncate(most);
    starts
}

impl Atlas<'_> {
    /// Returns the best `most` starts with prescribed phases, the best first.
    pub(super) fn timed_starts(&self, target: &Target, most: usize) -> Vec<Start> {
        let times = target.few[0].timing.as_ref();
        let (Some(compared), Some(times)) = (Compared::of(target), times) else { return Vec::new() };
        let sides: Vec<Vec<Side>> = self.kinds.iter().map(|kind| sides(*kind)).collect();
        let chunks: Vec<Vec<Start>> = (0..self.streams())
            .into_par_iter()
            .map(|chunk| {
                let draws = &mut stream(self.seed, self.stream + chunk);
                let mut grid = Grid::default();
                let starts = (0..CHUNK).filter_map(|place| {
                    let kind = self.kinds[place % self.kinds.len()];
                    let drawn = drawn(kind, draws, self.limits.cosine, &mut grid);
                    let sides = &sides[place % self.kinds.len()];
                    self.timed(&drawn, &mut grid, (target, &compared, times.offset), sides)
                });
                best_of(starts.collect(), most)
            })
            .collect();
        best_of(chunks.into_iter().flatten().collect(), most)
    }

    /// Returns the best start of a draw; `None` where it has none that is short enough.
    fn timed(
        &self,
        drawn: &Drawn,
        grid: &mut Grid,
        (target, compared, from): (&Target, &Compared, AngleOffset),
        sides: &[Side],
    ) -> Option<Start> {
        let (frames, of) = TracedFrames::of(drawn, grid)?;
        let sums = vectorised(
            #[inline(always)]
            || Sums::of(&frames, compared),
        );
        let offsets = if from == AngleOffset::Ground { 1 } else { OFFSETS };
        let mut best: Option<Start> = None;
        for (mirrored, allowed) in [false, true].into_iter().zip(target.timed.unwrap_or_default()) {
            for k in (0..offsets).filter(|_| allowed) {
                let Some((score, at)) = sums.fitted(compared, k, usize::from(mirrored), from) else {
                    continue;
                };
                if best.as_ref().is_some_and(|best| best.score >= score) {
                    continue;
                }
                let own = longest(&of, at.pointer / at.ground, sides);
                if own * at.ground.norm() <= TOO_LONG * self.limits.longest.exp() {
                    let chain = DyadChain { shape: drawn.shape, placement: at };
                    let variant = Variant { reversed: false, mirrored };
                    best = Some(Start { chain, variant, score, along: vec![offset(k)] });
                }
            }
        }
        best
    }
}
