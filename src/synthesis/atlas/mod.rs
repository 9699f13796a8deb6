//! An atlas of coupler curves: a table of linkages from which those whose curves resemble a given target are taken as
//! starts.
//!
//! *Closed targets.* Each entry is a linkage in the frame A = 0, B = 1 with the magnitudes of its curve's Fourier
//! coefficients,
//!
//! ```text
//! F_k = sum_m P_m e^{-2 pi i k m / M},   k = +-1 .. +-K,   divided by sqrt(sum |F_k|^2)
//! ```
//!
//! at M points spaced evenly along the curve. They do not change if the curve is moved, turned, scaled or started
//! elsewhere; if it is run backwards, F_k and F_-k change places. (Descriptors of closed curves: Zahn and Roskies 1972;
//! for coupler curves McGarva and Mullineux 1993.) The nearest entries are then fitted to the target by similarity at
//! every shift (Procrustes), and the best give starts.
//!
//! *Open targets.* A second atlas holds `ARCS` arcs of each entry's curve, of random begin and length, each as M points
//! c_m evenly along it, centred and of unit norm. For a target t_m normalised alike, the relative residual after the
//! best similarity is 1 - |sum conj(c_m) t_m|^2.
//!
//! Both are drawn from a fixed stream, once in a process, when they are first needed, on all cores.

use super::coarse::points_of;
use super::starts::{SLACK_RANGE, Starts, draw_ratios};
use crate::mechanism::four_bar::mobility::{Mobility, linkage_type};
use crate::mechanism::{Circuit, Complex, InputArc, LinkageType};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::once::once;
use crate::numbers::arithmetic::streams::{Stream, below, stream, uniform};
use crate::task::forms::linear_fit::{Ratios, coupler_direction};
use crate::task::forms::start::Start;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

mod compare;

use compare::{Descriptor, HARMONICS, Normal, SideBySide, arcs_apart, descriptors_apart};
pub(super) use compare::{EVEN, Even, ON_ARC, OnArc, arc_misfits};

/// Number of entries drawn.
pub const ENTRIES: usize = 30_000;
/// Entries drawn from one random stream.
const CHUNK: usize = 500;
/// The seed of the atlas: it is the same for every problem and run.
const SEED: u64 = 0x61_746c_6173;
/// Positions at which a curve is sampled.
pub(super) const TRACED: usize = 72;
/// Number of nearest entries that are fitted to the target by similarity.
const LAID: usize = 2400;

/// A linkage of the atlas with the circuit that it runs on.
#[derive(Clone, Copy, Debug)]
struct Entry {
    kind: LinkageType,
    ratios: Ratios,
    /// The coupler point P from C in the coupler's frame, in units of the ground.
    offset: Complex,
    /// Assembly sign t1, if the crank turns fully.
    assembly: f64,
    arc: Option<InputArc>,
    even: Even,
}

/// A sampled curve with its arc length.
#[derive(Clone, Debug)]
pub(super) struct Traced {
    points: Vec<Complex>,
    /// The arc length up to each point over the whole length; one more than points.
    along: Vec<f64>,
}

impl Entry {
    /// Returns the position at a parameter in [0, 1): the crank and coupler directions (e, u) relative to the ground
    /// line.
    fn at(&self, parameter: f64) -> Option<[Complex; 2]> {
        let (e, t) = match self.arc {
            None => (Complex::from_polar(1.0, TAU * parameter), self.assembly),
            Some(arc) => {
                // Slightly off the toggles, where the assembly is undecided.
                let psi = TAU * parameter;
                let angle = arc.middle + (1.0 - 1e-9) * arc.half_width * psi.sin();
                (Complex::from_polar(1.0, angle), if psi.cos() < 0.0 { -1.0 } else { 1.0 })
            }
        };
        Some([e, coupler_direction(&self.ratios, e, t)?])
    }

    /// Samples the curve at the parameters of [`Samples`].
    fn trace(&self) -> Option<Traced> {
        let samples = Samples::get();
        let (mut cranks, mut signs) = (samples.circle, [self.assembly; TRACED]);
        if let Some(arc) = self.arc {
            signs = samples.signs;
            let [ex, ey] = &mut cranks;
            for ((x, y), sine) in ex.iter_mut().zip(ey).zip(&samples.sines) {
                let angle = arc.middle + (1.0 - 1e-9) * arc.half_width * sine;
                (*y, *x) = angle.sin_cos();
            }
        }
        let mut points = [[0.0; TRACED]; 2];
        vectorised(
            #[inline(always)]
            || curve_points(&self.ratios, self.offset, &cranks, &signs, &mut points),
        )
        .then(|| Traced::of(points[0].iter().zip(&points[1]).map(|(&x, &y)| Complex::new(x, y)).collect()))?
    }
}

/// Computes the points of a curve at crank directions (x and y coordinates) with their assembly signs, as
/// [`coupler_direction`] and to the same bits; `false` if the loop is open at one.
#[inline(always)]
fn curve_points(
    ratios: &Ratios,
    offset: Complex,
    [ex, ey]: &[[f64; TRACED]; 2],
    signs: &[f64; TRACED],
    [x, y]: &mut [[f64; TRACED]; 2],
) -> bool {
    let (p, q, r) = (ratios.crank, ratios.coupler, ratios.follower);
    let mut open = [false; TRACED];
    for i in 0..TRACED {
        let (wx, wy) = (1.0 - ex[i] * p, 0.0 - ey[i] * p);
        let f2 = wx * wx + wy * wy;
        let along = 0.5 * (q * q - r * r + f2);
        let h2 = q * q * f2 - along * along;
        open[i] = h2.is_nan() || h2 <= 0.0 || f2 == 0.0;
        let across = signs[i] * h2.sqrt();
        let scale = f2 * q;
        let (ux, uy) = ((wx * along - wy * across) / scale, (wx * across + wy * along) / scale);
        x[i] = ex[i] * p + (ux * offset.re - uy * offset.im);
        y[i] = ey[i] * p + (ux * offset.im + uy * offset.re);
    }
    !open.contains(&true)
}

/// The parameters at which curves are sampled: half a step off, so that no sample lies on a toggle.
struct Samples {
    /// The crank directions of a full turn.
    circle: [[f64; TRACED]; 2],
    /// The sines of the parameters of an arc, and the assembly signs there.
    sines: [f64; TRACED],
    signs: [f64; TRACED],
}

impl Samples {
    fn get() -> &'static Samples {
        static SAMPLES: OnceLock<Samples> = OnceLock::new();
        SAMPLES.get_or_init(|| {
            let psi = |i: usize| TAU * ((i as f64 + 0.5) / TRACED as f64);
            let circle = |i: usize| Complex::from_polar(1.0, psi(i));
            Samples {
                circle: [std::array::from_fn(|i| circle(i).re), std::array::from_fn(|i| circle(i).im)],
                sines: std::array::from_fn(|i| psi(i).sin()),
                signs: std::array::from_fn(|i| if psi(i).cos() < 0.0 { -1.0 } else { 1.0 }),
            }
        })
    }
}

/// Returns a number in [0, 2) less its whole part.
pub(super) fn fraction(x: f64) -> f64 {
    debug_assert!((0.0..2.0).contains(&x));
    if x < 1.0 { x } else { x - 1.0 }
}

impl Traced {
    /// Measures a closed polygon; `None` if it has no length.
    pub(super) fn of(points: Vec<Complex>) -> Option<Traced> {
        let mut along = vec![0.0];
        for i in 0..points.len() {
            let step = (points[(i + 1) % points.len()] - points[i]).norm_sqr().sqrt();
            along.push(along[i] + step);
        }
        let whole = along[points.len()];
        along.iter_mut().for_each(|s| *s /= whole);
        (whole > 0.0 && whole.is_finite()).then_some(Traced { points, along })
    }

    /// Returns the index of the sample before a place in [0, 1) of the curve, and the fraction of the way to the next.
    pub(super) fn locate(&self, place: f64) -> (usize, f64) {
        self.between(self.along.partition_point(|length| *length <= place), place)
    }

    /// As [`Traced::locate`], with the number of samples up to the place.
    fn between(&self, samples: usize, place: f64) -> (usize, f64) {
        let corner = samples.clamp(1, self.points.len()) - 1;
        let (from, to) = (self.along[corner], self.along[corner + 1]);
        (corner, if to > from { (place - from) / (to - from) } else { 0.0 })
    }

    pub(super) fn point(&self, (corner, part): (usize, f64)) -> Complex {
        let (from, to) = (self.points[corner], self.points[(corner + 1) % self.points.len()]);
        from + (to - from) * part
    }

    /// Returns points evenly along the curve, from its first sample on.
    pub(super) fn even(&self) -> Vec<Complex> {
        let mut samples = 0;
        let mut point = |m: usize| {
            let place = m as f64 / EVEN as f64;
            while self.along.get(samples).is_some_and(|length| *length <= place) {
                samples += 1;
            }
            self.point(self.between(samples, place))
        };
        (0..EVEN).map(&mut point).collect()
    }

    pub(super) fn parameter(&self, place: f64) -> f64 {
        let (corner, part) = self.locate(place);
        fraction((corner as f64 + 0.5 + part) / TRACED as f64)
    }
}

fn descriptor(even: &[Complex]) -> Option<Descriptor> {
    let (mut ahead, mut back) = ([[0.0; HARMONICS]; 2], [[0.0; HARMONICS]; 2]);
    for (p, [cos, sin]) in even.iter().zip(phases()) {
        for k in 0..HARMONICS {
            ahead[0][k] += p.re * cos[k] - p.im * sin[k];
            ahead[1][k] += p.re * sin[k] + p.im * cos[k];
            back[0][k] += p.re * cos[k] - p.im * -sin[k];
            back[1][k] += p.re * -sin[k] + p.im * cos[k];
        }
    }
    let mut magnitudes = [0.0; 2 * HARMONICS];
    for k in 0..HARMONICS {
        magnitudes[k] = ahead[0][k] * ahead[0][k] + ahead[1][k] * ahead[1][k];
        magnitudes[HARMONICS + k] = back[0][k] * back[0][k] + back[1][k] * back[1][k];
    }
    let whole: f64 = magnitudes.iter().sum();
    let mut out = [0.0f32; 2 * HARMONICS];
    for (out, m) in out.iter_mut().zip(magnitudes) {
        *out = (m / whole).sqrt() as f32;
    }
    whole.is_normal().then_some(out)
}

/// Returns cos and sin of -2 pi k m / M for each of M points evenly along a curve and each harmonic k.
fn phases() -> &'static [[[f64; HARMONICS]; 2]; EVEN] {
    static PHASES: OnceLock<[[[f64; HARMONICS]; 2]; EVEN]> = OnceLock::new();
    PHASES.get_or_init(|| {
        let mut phases = [[[0.0; HARMONICS]; 2]; EVEN];
        let turn = Complex::from_polar(1.0, -TAU / EVEN as f64);
        let mut step = Complex::new(1.0, 0.0);
        for k in 0..HARMONICS {
            step *= turn;
            let mut phase = Complex::new(1.0, 0.0);
            for [cos, sin] in &mut phases {
                (cos[k], sin[k]) = (phase.re, phase.im);
                phase *= step;
            }
        }
        phases
    })
}

const KINDS: [LinkageType; 5] = [
    LinkageType::CrankRocker,
    LinkageType::DoubleCrank,
    LinkageType::RockerCrank,
    LinkageType::DoubleRocker,
    LinkageType::TripleRocker,
];

/// One in this many entries is close to a change point: such curves have the sharpest corners.
const NEAR_CHANGE_POINT_EVERY: usize = 4;
/// Range of the distance |s + l - p - q| from the change point, in units of the shortest link.
const FROM_CHANGE_POINT: (f64, f64) = (1e-4, 0.1);

/// Returns the same links with the longest one changed so that s + l - p - q is almost zero, on either side.
fn near_change_point(stream: &mut Stream, ratios: &Ratios) -> Option<(Ratios, LinkageType)> {
    let mut links = [1.0, ratios.crank, ratios.coupler, ratios.follower];
    // Of equal ones the first.
    let shortest = (0..4).min_by(|&i, &j| links[i].total_cmp(&links[j]))?;
    let longest = (0..4).min_by(|&i, &j| links[j].total_cmp(&links[i]))?;
    let off = uniform(stream, FROM_CHANGE_POINT.0.ln(), FROM_CHANGE_POINT.1.ln()).exp();
    let side = if below(stream, 2) == 0 { 1.0 } else { -1.0 };
    let others: f64 = links.iter().sum::<f64>() - links[longest] - links[shortest];
    links[longest] = others - links[shortest] + side * off * links[shortest];
    let kind = linkage_type(links).filter(|kind| *kind != LinkageType::ChangePoint)?;
    let ground = links[0];
    let ratios = Ratios { crank: links[1] / ground, coupler: links[2] / ground, follower: links[3] / ground };
    Some((ratios, kind))
}

fn draw(stream: &mut Stream) -> Option<(Entry, Descriptor)> {
    let kind = KINDS[below(stream, KINDS.len())];
    let assembly = if below(stream, 2) == 0 { 1.0 } else { -1.0 };
    let which = below(stream, 2) as u8;
    let reach = uniform(stream, 0.05_f64.ln(), 3.0_f64.ln()).exp();
    let angle = uniform(stream, -PI, PI);
    let mut ratios = draw_ratios(stream, kind, SLACK_RANGE)?;
    let mut kind = kind;
    if below(stream, NEAR_CHANGE_POINT_EVERY) == 0 {
        (ratios, kind) = near_change_point(stream, &ratios)?;
    }
    let longest = ratios.crank.max(ratios.coupler).max(ratios.follower).max(1.0);
    let offset = Complex::new(0.5 * ratios.coupler, 0.0) + Complex::from_polar(reach * longest, angle);
    let arc = if kind.input_turns_fully() {
        None
    } else {
        let mobility: Mobility = super::starts::unit_linkage(&ratios)?;
        Some(mobility.arc(Circuit { index: which % mobility.circuits().max(1) })?)
    };
    let even = Normal([[0.0; EVEN]; 2]);
    let mut entry = Entry { kind, ratios, offset, assembly, arc, even };
    let points = entry.trace()?.even();
    let descriptor = descriptor(&points)?;
    entry.even = Even::of(&points)?;
    Some((entry, descriptor))
}

/// The entries, with what is compared with every target in a form that is compared fast.
struct Atlas {
    entries: Vec<Entry>,
    kinds: Vec<LinkageType>,
    descriptors: SideBySide<{ 2 * HARMONICS }>,
}

fn atlas() -> &'static Atlas {
    static ATLAS: OnceLock<Atlas> = OnceLock::new();
    once(&ATLAS, || {
        let chunk = |index: usize| -> Vec<(Entry, Descriptor)> {
            let mut draws = stream(SEED, index as u64);
            (0..CHUNK).filter_map(|_| draw(&mut draws)).collect()
        };
        let drawn: Vec<(Entry, Descriptor)> =
            (0..ENTRIES / CHUNK).into_par_iter().flat_map_iter(chunk).collect();
        let descriptors = SideBySide::of(drawn.iter().map(|(_, descriptor)| *descriptor));
        let entries: Vec<Entry> = drawn.into_iter().map(|(entry, _)| entry).collect();
        Atlas { kinds: entries.iter().map(|entry| entry.kind).collect(), entries, descriptors }
    })
}

/// An arc of an entry's curve.
#[derive(Clone, Copy, Debug)]
struct Arc {
    entry: u32,
    /// Begin and length of the arc, in parts of the curve's length.
    begin: f32,
    span: f32,
    /// Whether the arc stays on one branch (assembly).
    one_branch: bool,
}

/// The arcs, with their points ([`OnArc`]) in a form that is compared fast.
struct Arcs {
    arcs: Vec<Arc>,
    points: SideBySide<{ 2 * ON_ARC }>,
}

/// Number of arcs per entry.
const ARCS: usize = 3;
/// Least and greatest length of an arc, in parts of the curve's.
const SPANS: (f64, f64) = (0.1, 0.97);

impl Arc {
    fn of(index: usize, entry: &Entry, traced: &Traced, stream: &mut Stream) -> Option<(Arc, OnArc)> {
        let begin = uniform(stream, 0.0, 1.0);
        let span = uniform(stream, SPANS.0, SPANS.1);
        let mut points = [Complex::new(0.0, 0.0); ON_ARC];
        for (m, p) in points.iter_mut().enumerate() {
            *p = traced.point(traced.locate(fraction(begin + span * m as f64 / (ON_ARC - 1) as f64)));
        }
        let one_branch = entry.arc.is_none() || {
            // psi = 2 pi parameter: the toggles are at a quarter and at three quarters.
            let half = |s: f64| fraction(traced.parameter(fraction(s)) + 0.25) < 0.5;
            let first = half(begin);
            (1..=24).all(|m| half(begin + span * f64::from(m) / 24.0) == first)
        };
        let points = Normal::of(&points)?;
        Some((Arc { entry: index as u32, begin: begin as f32, span: span as f32, one_branch }, points))
    }
}

fn arcs() -> &'static Arcs {
    static ARC_ATLAS: OnceLock<Arcs> = OnceLock::new();
    once(&ARC_ATLAS, || {
        let of_chunk = |(chunk, entries): (usize, &[Entry])| -> Vec<(Arc, OnArc)> {
            let mut draws = stream(SEED + 1, chunk as u64);
            let mut out = Vec::with_capacity(ARCS * entries.len());
            for (i, entry) in entries.iter().enumerate() {
                let Some(traced) = entry.trace() else { continue };
                for _ in 0..ARCS {
                    out.extend(Arc::of(chunk * CHUNK + i, entry, &traced, &mut draws));
                }
            }
            out
        };
        let drawn: Vec<(Arc, OnArc)> =
            atlas().entries.par_chunks(CHUNK).enumerate().flat_map_iter(of_chunk).collect();
        let points = SideBySide::of(drawn.iter().map(|(_, points)| points.flat()));
        Arcs { arcs: drawn.into_iter().map(|(arc, _)| arc).collect(), points }
    })
}

/// An entry fitted to a target by similarity.
#[derive(Clone, Copy, Debug)]
struct Laid {
    entry: &'static Entry,
    /// The place on the curve at which the target begins, in parts of its length from its first sample.
    begin: f64,
    /// The part of the curve's length that the target covers.
    span: f64,
    /// The direction: +1 if the target runs as the parameter grows, -1 if against it.
    direction: f64,
    /// The residual of the similarity fit, relative to the target's spread.
    misfit: f64,
}

/// Returns the `LAID` nearest of some entries or arcs, each with its misfit and its index, nearest first; equals in
/// their order.
fn nearest<T>(mut near: Vec<(f32, usize, T)>) -> Vec<(f32, usize, T)> {
    let order =
        |one: &(f32, usize, T), other: &(f32, usize, T)| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1));
    if near.len() > LAID {
        near.select_nth_unstable_by(LAID, order);
        near.truncate(LAID);
    }
    near.sort_by(order);
    near
}

/// The nearest entries to a target, best first.
#[derive(Debug)]
pub(super) struct Matches {
    laid: Vec<Laid>,
}

impl Matches {
    /// Finds the matches for the target of a problem; empty if no entry may be used.
    pub(super) fn of(starts: &Starts<'_>) -> Matches {
        let task = starts.problem.task();
        let is_closed = task.closed() || task.repeats_first();
        let laid = if is_closed { Matches::closed(starts) } else { Matches::open(starts) };
        Matches { laid: laid.unwrap_or_default() }
    }

    /// Returns the matches of an open target; `None` if all of its points coincide.
    fn open(starts: &Starts<'_>) -> Option<Vec<Laid>> {
        let problem = starts.problem;
        let (points, along) = (problem.task().points(), &starts.arc);
        // ON_ARC points evenly along the target.
        let mut even = Vec::with_capacity(ON_ARC);
        for m in 0..ON_ARC {
            let s = m as f64 / (ON_ARC - 1) as f64;
            let next = along.partition_point(|length| *length < s).clamp(1, points.len() - 1);
            let (from, to) = (along[next - 1], along[next]);
            let part = if to > from { ((s - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
            even.push(points[next - 1] + (points[next] - points[next - 1]) * part);
        }
        let target = Normal::of(&even)?;
        let types = problem.types();
        let [with, against] = [1.0, -1.0].map(|sense| problem.directions().contains(&sense));
        let Arcs { arcs, points: of_arcs } = arcs();
        let usable = |arc: &Arc| {
            (arc.one_branch || problem.branch_any())
                && (types.is_empty() || types.contains(&atlas().kinds[arc.entry as usize]))
        };
        let misfits = arcs_apart(of_arcs, &target);
        let apart = |index: usize| {
            let [ahead, back] = misfits[index];
            let reversed = if with && against { back < ahead } else { !with };
            if reversed { (back, index, -1.0) } else { (ahead, index, 1.0) }
        };
        let near = nearest((0..arcs.len()).filter(|index| usable(&arcs[*index])).map(apart).collect());
        let lay = |&(misfit, index, direction): &(f32, usize, f64)| {
            let arc = &arcs[index];
            let (begin, span) = (f64::from(arc.begin), f64::from(arc.span));
            let begin = if direction > 0.0 { begin } else { begin + span };
            Laid {
                entry: &atlas().entries[arc.entry as usize],
                begin,
                span,
                direction,
                misfit: f64::from(misfit),
            }
        };
        Some(near.iter().map(lay).collect())
    }

    /// Returns the matches of a closed target; `None` if all of its points coincide.
    fn closed(starts: &Starts<'_>) -> Option<Vec<Laid>> {
        let problem = starts.problem;
        let points = &problem.task().points()[..points_of(problem)];
        let even = Traced::of(points.to_vec())?.even();
        let (wanted, target) = (descriptor(&even)?, Even::of(&even)?);
        let types = problem.types();
        let Atlas { entries, kinds, descriptors } = atlas();
        let usable = |index: usize| {
            (types.is_empty() || types.contains(&kinds[index]))
                && (kinds[index].input_turns_fully() || problem.branch_any())
        };
        let apart = descriptors_apart(descriptors, &wanted);
        let near = (0..entries.len()).filter(|index| usable(*index)).map(|i| (apart[i], i, &entries[i]));
        let near = nearest(near.collect());
        let mut laid: Vec<Laid> = Vec::with_capacity(near.len());
        vectorised(
            #[inline(always)]
            || {
                for &(_, _, entry) in &near {
                    let mut best = (f32::INFINITY, 0, 1.0);
                    for &direction in problem.directions() {
                        let misfits = entry.even.misfits(&target, direction > 0.0);
                        for (shift, misfit) in misfits.iter().enumerate() {
                            if *misfit < best.0 {
                                best = (*misfit, shift, direction);
                            }
                        }
                    }
                    let (misfit, shift, direction) = best;
                    let begin = shift as f64 / EVEN as f64;
                    laid.push(Laid { entry, begin, span: 1.0, direction, misfit: f64::from(misfit) });
                }
            },
        );
        laid.sort_by(|one, other| one.misfit.total_cmp(&other.misfit));
        Some(laid)
    }

    /// Returns the number of matches.
    pub(super) fn len(&self) -> usize {
        self.laid.len()
    }

    /// Returns the start made from the match of a rank, counted from 0.
    pub(super) fn start(&self, starts: &Starts<'_>, rank: usize) -> Option<Start> {
        let laid = self.laid.get(rank)?;
        let traced = laid.entry.trace()?;
        let mut positions = Vec::with_capacity(starts.arc.len());
        for s in &starts.arc {
            let place = (laid.begin + laid.direction * laid.span * s).rem_euclid(1.0);
            let parameter = traced.parameter(place);
            positions.push(laid.entry.at(parameter)?);
        }
        starts.from_positions(&laid.entry.ratios, laid.entry.kind, laid.direction, &positions)
    }
}
