//! Starts of fits: the random chains whose curves resemble the target most.
//!
//! *Closed targets.* Each draw's curve is taken at equal arcs, centred, of unit norm, and described by the magnitudes of its
//! Fourier coefficients. With those of the target, sum |X_h| |Y_h| bounds the correlation |sum conj(x_k) y_{k+s}| at every
//! shift and rotation, up to the harmonics that are left out: the best of this prefilter are correlated exactly, in the four
//! variants of the target (derived here). *Open targets.* Random arcs of each curve are correlated at once.
//!
//! Draws that were chosen are drawn again from their stream, so that nothing but their numbers is kept.

use super::curve::{Curve, EVEN, Even, best_shift, bound, correlation, magnitudes};
use super::draw::{Drawn, drawn};
use super::limits::Limits;
use super::target::{Points, Target, Variant};
use crate::mechanism::dyad_chain::sizes::{Side, distance, sides};
use crate::mechanism::dyad_chain::{DyadChain, DyadChainKind, Grid, Placement, Proportions};
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::streams::{Stream, stream, uniform};
use rayon::prelude::*;

/// Draws of one random stream.
pub(super) const CHUNK: usize = 250;
/// Arcs of each curve for an open target, and the range of their share of the curve.
const ARCS: usize = 8;
const ARC_SHARE: (f64, f64) = (0.15, 0.95);
/// A chain may be longer than the limit by this factor before it is fitted.
pub(super) const TOO_LONG: f64 = 2.0;

/// A start of a fit: a chain, and where a variant of the target begins on it. With free timing the chain stands in the frame A = 0,
/// B = 1.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) chain: DyadChain,
    pub(super) variant: Variant,
    /// Correlation with the target; of prescribed timing 1 less the part of its mean square that is left. 1 at best.
    pub(super) score: f64,
    /// Phases at equal arcs from the target's beginning to its end; of prescribed timing the offset of the phases.
    pub(super) along: Vec<f64>,
}

impl Start {
    /// Returns the phases of points by their shares of the arc length.
    pub(super) fn phases(&self, points: &Points) -> Vec<f64> {
        if let Some(times) = &points.timing {
            return times.angles.iter().map(|angle| angle + self.along[0]).collect();
        }
        let at = |share: &f64| {
            let place = share * EVEN as f64;
            let i = (place as usize).min(EVEN - 1);
            self.along[i] + (self.along[i + 1] - self.along[i]) * (place - i as f64)
        };
        points.shares.iter().map(at).collect()
    }
}

/// The number of a draw and of one of its arcs.
#[derive(Clone, Copy, Debug)]
struct Kept {
    score: f64,
    stream: u64,
    place: usize,
    arc: usize,
    variant: Variant,
}

/// Returns the best `most`, the best first; of equal ones the first drawn.
fn best_of(mut kept: Vec<Kept>, most: usize) -> Vec<Kept> {
    let key = |kept: &Kept| (kept.stream, kept.place, kept.arc);
    kept.sort_by(|a, b| b.score.total_cmp(&a.score).then(key(a).cmp(&key(b))));
    kept.truncate(most);
    kept
}

/// An atlas: `draws` chains, from a range of random streams.
#[derive(Clone, Debug)]
pub(super) struct Atlas<'a> {
    pub(super) kinds: &'a [DyadChainKind],
    pub(super) seed: u64,
    /// The first random stream.
    pub(super) stream: u64,
    pub(super) draws: usize,
    /// The draws that are correlated exactly.
    pub(super) prefiltered: usize,
    pub(super) limits: &'a Limits,
}

/// A chain of an atlas with its arcs: where they begin, and their share of the length.
struct Entry {
    drawn: Drawn,
    arcs: [[f64; 2]; ARCS],
}

/// The whole curve as an arc.
const WHOLE: [f64; 2] = [0.0, 1.0];

impl Atlas<'_> {
    /// Returns the number of streams that the atlas draws from.
    pub(super) fn streams(&self) -> u64 {
        self.draws.div_ceil(CHUNK) as u64
    }

    fn entry(&self, index: usize, draws: &mut Stream, grid: &mut Grid, closed: bool) -> Entry {
        let drawn = drawn(self.kinds[index % self.kinds.len()], draws, self.limits.cosine, grid);
        let mut arcs = [WHOLE; ARCS];
        if !closed {
            arcs.fill_with(|| [uniform(draws, 0.0, 1.0), uniform(draws, ARC_SHARE.0, ARC_SHARE.1)]);
        }
        Entry { drawn, arcs }
    }

    /// Returns the best `most` starts, the best first.
    pub(super) fn starts(&self, target: &Target, most: usize) -> Vec<Start> {
        let wanted: Vec<Even> = target
            .even
            .iter()
            .map(|even| [std::array::from_fn(|i| even[i].re), std::array::from_fn(|i| even[i].im)])
            .collect();
        let most_kept = if target.closed { self.prefiltered } else { most };
        let sides: Vec<Vec<Side>> = self.kinds.iter().map(|kind| sides(*kind)).collect();
        let kept: Vec<Vec<Kept>> = (0..self.streams())
            .into_par_iter()
            .map(|chunk| best_of(self.scored(self.stream + chunk, target, (&wanted, &sides)), most_kept))
            .collect();
        let mut kept = best_of(kept.into_iter().flatten().collect(), most_kept);
        kept.sort_by_key(|kept| (kept.stream, kept.place));
        let groups: Vec<&[Kept]> = kept.chunk_by(|a, b| a.stream == b.stream).collect();
        let matched: Vec<Vec<Start>> =
            groups.into_par_iter().map(|group| self.matched(group, target, &wanted)).collect();
        let mut starts: Vec<Start> = matched.into_iter().flatten().collect();
        // Stable: of equal ones the first drawn.
        starts.sort_by(|a, b| b.score.total_cmp(&a.score));
        starts.truncate(most);
        starts
    }

    /// Scores the draws of a stream.
    fn scored(&self, index: u64, target: &Target, (wanted, sides): (&[Even], &[Vec<Side>])) -> Vec<Kept> {
        let draws = &mut stream(self.seed, index);
        let described = magnitudes(&wanted[0]);
        let mut grid = Grid::default();
        let mut kept = Vec::new();
        for place in 0..CHUNK {
            let entry = self.entry(place, draws, &mut grid, target.closed);
            let Some((curve, of)) = Curve::of(&entry.drawn, &mut grid) else { continue };
            let longest = longest(&of, entry.drawn.place, &sides[place % sides.len()]);
            // The rms radius of the part of the curve becomes that of the target, which is 1.
            let fits = |radius: f64| longest <= TOO_LONG * self.limits.longest.exp() * radius;
            let mut put = |score: f64, arc: usize, variant: Variant| {
                kept.push(Kept { score, stream: index, place, arc, variant });
            };
            if target.closed {
                let (points, radius) = curve.even(WHOLE, EVEN);
                if fits(radius) {
                    put(f64::from(bound(&magnitudes(&points), &described)), 0, Variant::ALL[0]);
                }
                continue;
            }
            for (i, arc) in entry.arcs.iter().enumerate() {
                let (points, radius) = curve.even(*arc, EVEN - 1);
                if fits(radius) {
                    for (variant, wanted) in Variant::ALL.into_iter().zip(wanted) {
                        put(correlation(&points, wanted), i, variant);
                    }
                }
            }
        }
        kept
    }

    /// Correlates the kept draws of a stream exactly.
    fn matched(&self, group: &[Kept], target: &Target, wanted: &[Even]) -> Vec<Start> {
        let Some(first) = group.first() else { return Vec::new() };
        let draws = &mut stream(self.seed, first.stream);
        let mut grid = Grid::default();
        let mut starts = Vec::with_capacity(group.len());
        let mut rest = group.iter().peekable();
        for place in 0..CHUNK {
            if rest.peek().is_none() {
                break;
            }
            let entry = self.entry(place, draws, &mut grid, target.closed);
            while let Some(kept) = rest.next_if(|kept| kept.place == place) {
                let Some((curve, _)) = Curve::of(&entry.drawn, &mut grid) else { continue };
                let (variant, arc, score) = if target.closed {
                    let (variant, shift, score) = best_shift(&curve.even(WHOLE, EVEN).0, wanted);
                    (variant, [shift as f64 / EVEN as f64, 1.0], score)
                } else {
                    (kept.variant, entry.arcs[kept.arc], kept.score)
                };
                let placement = Placement {
                    origin: Complex::new(0.0, 0.0),
                    ground: Complex::new(1.0, 0.0),
                    pointer: entry.drawn.place,
                };
                let chain = DyadChain { shape: entry.drawn.shape, placement };
                starts.push(Start { chain, variant, score, along: curve.phases(arc) });
            }
        }
        starts
    }
}

/// Returns the largest distance between two joints of one body in the frame A = 0, B = 1.
pub(super) fn longest(of: &Proportions, place: Complex, sides: &[Side]) -> f64 {
    let one = Complex::new(1.0, 0.0);
    let at = Placement { origin: Complex::new(0.0, 0.0), ground: one, pointer: place };
    sides.iter().map(|side| distance(of, &at, side)).fold(0.0, f64::max)
}
