//! Target of a dyad chain: points in order, normalised to their centroid and rms radius, in four variants.
//!
//! A crank that turns the other way, or the mirrored chain, draws the target reversed, or mirrored. A fit has rising phases
//! and no reflection, so the four variants {forward, reversed} x {as it is, mirrored} stand for them. With prescribed phases the
//! two that are not reversed suffice: the mirrored one is drawn by a crank that turns clockwise.

use super::request::DyadChainTiming;
use crate::mechanism::dyad_chain::{DyadChain, Placement};
use crate::mechanism::{Complex, centroid_and_radius};
use crate::numbers::arithmetic::lane::LANES;
use crate::task::AngleOffset;

/// The points of a fit, evenly weighted.
#[derive(Clone, Debug)]
pub(super) struct Points {
    /// x and y, padded to whole lanes.
    pub(super) columns: [Vec<f64>; 2],
    /// 1 for a point, 0 for padding.
    pub(super) mask: Vec<f64>,
    /// Number of points.
    pub(super) count: usize,
    pub(super) closed: bool,
    /// Mean distance of neighbours.
    pub(super) spacing: f64,
    /// Share of the arc length up to each point.
    pub(super) shares: Vec<f64>,
    /// The phases, of prescribed timing.
    pub(super) timing: Option<Times>,
}

/// Phases of points that are prescribed, up to an offset.
#[derive(Clone, Debug)]
pub(super) struct Times {
    /// The angle at each point, the last one at least the first.
    pub(super) angles: Vec<f64>,
    pub(super) offset: AngleOffset,
    /// Whether they never fall.
    pub(super) rise: bool,
}

impl Times {
    /// Puts the phases of a chain in its place; of those with a free offset, from the first phase on.
    pub(super) fn put(&self, ground: Complex, phases: &mut [f64]) {
        let offset = match self.offset {
            AngleOffset::Free => phases[0] - self.angles[0],
            AngleOffset::Fixed => -ground.arg(),
            AngleOffset::Ground => 0.0,
        };
        for (phase, angle) in phases.iter_mut().zip(&self.angles) {
            *phase = angle + offset;
        }
    }
}

impl Points {
    fn new(
        points: &[Complex],
        (shares, length): (&[f64], f64),
        closed: bool,
        timing: Option<(Vec<f64>, AngleOffset)>,
    ) -> Self {
        let count = points.len();
        let padded = count.next_multiple_of(LANES);
        let column = |part: fn(&Complex) -> f64| {
            let mut column: Vec<f64> = points.iter().map(part).collect();
            column.resize(padded, points.last().map_or(0.0, part));
            column
        };
        let mut mask = vec![1.0; count];
        mask.resize(padded, 0.0);
        let gaps = if closed { count } else { count - 1 };
        Points {
            columns: [column(|z| z.re), column(|z| z.im)],
            mask,
            count,
            closed,
            spacing: length / gaps.max(1) as f64,
            shares: shares.to_vec(),
            timing: timing.map(|(angles, offset)| {
                let rise = angles.windows(2).all(|pair| pair[0] <= pair[1]);
                Times { angles, offset, rise }
            }),
        }
    }

    /// Returns whether their phases depend on the direction of the ground.
    #[inline(always)]
    pub(super) fn follow_the_ground(&self) -> bool {
        self.timing.as_ref().is_some_and(|times| times.offset == AngleOffset::Fixed)
    }

    #[inline(always)]
    pub(super) fn point(&self, i: usize) -> Complex {
        Complex::new(self.columns[0][i], self.columns[1][i])
    }
}

/// One of the four variants of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Variant {
    pub(super) reversed: bool,
    pub(super) mirrored: bool,
}

impl Variant {
    pub(super) const ALL: [Variant; 4] = [
        Variant { reversed: false, mirrored: false },
        Variant { reversed: true, mirrored: false },
        Variant { reversed: false, mirrored: true },
        Variant { reversed: true, mirrored: true },
    ];

    pub(super) fn index(self) -> usize {
        usize::from(self.reversed) + 2 * usize::from(self.mirrored)
    }
}

/// A normalised target.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) centre: Complex,
    /// The rms radius.
    pub(super) radius: f64,
    pub(super) closed: bool,
    /// Few points and all points of each variant.
    pub(super) few: Vec<Points>,
    pub(super) all: Vec<Points>,
    /// Points evenly by arc length of each variant, centred, of unit norm.
    pub(super) even: Vec<Vec<Complex>>,
    /// Indices of the few points among all.
    pub(super) chosen: Vec<usize>,
    /// The variants that prescribed timing allows: the first, with the crank turning counter-clockwise, and the mirrored one.
    pub(super) timed: Option<[bool; 2]>,
}

impl Target {
    /// Normalises a target of at least three points; `None` if they coincide or are not finite.
    pub(super) fn of(
        (points, closed): (&[Complex], bool),
        timing: Option<DyadChainTiming<'_>>,
        few: usize,
        even: usize,
    ) -> Option<Target> {
        if points.len() < 3 || points.iter().any(|p| !(p.re.is_finite() && p.im.is_finite())) {
            return None;
        }
        let (centre, radius) = centroid_and_radius(points);
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        let points: Vec<Complex> = points.iter().map(|p| (p - centre) / radius).collect();
        let count = points.len();
        let chosen = if count <= few + few / 2 {
            (0..count).collect()
        } else if closed {
            (0..few).map(|i| i * count / few).collect()
        } else {
            (0..few).map(|i| (i * (count - 1) + (few - 1) / 2) / (few - 1)).collect()
        };
        // As the crank turns counter-clockwise.
        let sense = timing.map_or(1.0, |timing| timing.sense());
        let angles =
            timing.map(|timing| timing.angles.iter().map(|angle| sense * angle).collect::<Vec<f64>>());
        let timed = timing.map(|timing| [sense, -sense].map(|run| timing.runs.contains(&run)));
        let mut out = Target {
            centre,
            radius,
            closed,
            few: Vec::new(),
            all: Vec::new(),
            even: Vec::new(),
            chosen,
            timed,
        };
        for variant in Variant::ALL {
            let mut own: Vec<Complex> =
                points.iter().map(|p| if variant.mirrored { p.conj() } else { *p }).collect();
            if variant.reversed {
                own.reverse();
            }
            let (shares, length) = shares(&own, closed);
            let of_chosen: Vec<Complex> = out.chosen.iter().map(|i| own[*i]).collect();
            let shares_chosen: Vec<f64> = out.chosen.iter().map(|i| shares[*i]).collect();
            let times = |chosen: Option<&[usize]>| {
                let (angles, timing) = (angles.as_ref()?, timing?);
                let own = match chosen {
                    Some(chosen) => chosen.iter().map(|i| angles[*i]).collect(),
                    None => angles.clone(),
                };
                Some((own, timing.offset))
            };
            let few = Points::new(&of_chosen, (&shares_chosen, length), closed, times(Some(&out.chosen)));
            out.few.push(few);
            out.all.push(Points::new(&own, (&shares, length), closed, times(None)));
            out.even.push(evenly(&own, &shares, closed, even));
        }
        Some(out)
    }

    /// Returns the target, for cranks that turn counter-clockwise alone if `counter_clockwise`: nothing resembles the two variants
    /// that stand for the other sense.
    pub(super) fn turning(mut self, counter_clockwise: bool) -> Self {
        for variant in Variant::ALL {
            if counter_clockwise && variant.reversed != variant.mirrored {
                self.even[variant.index()].fill(Complex::new(0.0, 0.0));
            }
        }
        self
    }

    /// Returns a chain and its phases in the normalised coordinates of a variant that is not reversed.
    pub(super) fn normalised(
        &self,
        chain: &DyadChain,
        phases: &[f64],
        variant: Variant,
    ) -> (DyadChain, Vec<f64>) {
        let [t, s, z] = chain.placement.numbers();
        let placement = Placement {
            origin: (t - self.centre) / self.radius,
            ground: s / self.radius,
            pointer: z / self.radius,
        };
        let own = DyadChain { placement, ..*chain };
        match variant.mirrored {
            true => (own.mirrored(), phases.iter().map(|phase| -phase).collect()),
            false => (own, phases.to_vec()),
        }
    }

    /// Returns a chain of a variant in the coordinates of the target, and its phases in the order of the target's points.
    pub(super) fn restored(
        &self,
        chain: &DyadChain,
        phases: &[f64],
        variant: Variant,
    ) -> (DyadChain, Vec<f64>) {
        let mut phases = phases.to_vec();
        let mut chain = *chain;
        if variant.reversed {
            phases.reverse();
        }
        if variant.mirrored {
            chain = chain.mirrored();
            phases.iter_mut().for_each(|phase| *phase = -*phase);
        }
        let [t, s, z] = chain.placement.numbers();
        chain.placement = Placement {
            origin: self.centre + t * self.radius,
            ground: s * self.radius,
            pointer: z * self.radius,
        };
        (chain, phases)
    }
}

/// Returns the share of the arc length up to each point, and the length.
fn shares(points: &[Complex], closed: bool) -> (Vec<f64>, f64) {
    let mut along = vec![0.0];
    let mut whole = 0.0;
    for pair in points.windows(2) {
        whole += (pair[1] - pair[0]).norm();
        along.push(whole);
    }
    if closed && let (Some(first), Some(last)) = (points.first(), points.last()) {
        whole += (first - last).norm();
    }
    along.iter_mut().for_each(|s| *s /= whole);
    (along, whole)
}

/// Returns points evenly by arc length, centred and of unit norm.
fn evenly(points: &[Complex], shares: &[f64], closed: bool, count: usize) -> Vec<Complex> {
    let per = if closed { count } else { count - 1 };
    let mut out: Vec<Complex> = (0..count)
        .map(|m| {
            let share = m as f64 / per as f64;
            let i = shares.partition_point(|s| *s <= share).clamp(1, points.len()) - 1;
            let next = (i + 1) % points.len();
            let to = if i + 1 < points.len() { shares[i + 1] } else { 1.0 };
            let part = if to > shares[i] { ((share - shares[i]) / (to - shares[i])).min(1.0) } else { 0.0 };
            if i + 1 == points.len() && !closed {
                points[i]
            } else {
                points[i] + (points[next] - points[i]) * part
            }
        })
        .collect();
    let middle = out.iter().sum::<Complex>() / count as f64;
    out.iter_mut().for_each(|p| *p -= middle);
    let norm = out.iter().map(|p| p.norm_sqr()).sum::<f64>().sqrt();
    out.iter_mut().for_each(|p| *p /= norm);
    out
}
