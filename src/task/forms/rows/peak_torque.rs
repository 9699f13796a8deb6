//! Row of the peak torque: size (1 - |T|/T_max) at the crank angle at which the torque on the crank is largest, over a full turn
//! of a crank that turns fully, else over the motion used. Beyond the limit it goes on as size ln(T_max/|T|), with the same value
//! and slope there: near a toggle T has no bound.
//!
//! At its largest |T| does not change with the crank angle, so that its derivatives by the shape are those at that angle (Danskin
//! 1967), taken by central differences; at an end of the motion it also changes with that end.

use super::{At, Motion, Place, Row, RowKind, Turn, assembly_of};
use crate::mechanism::AssemblyMode;
use crate::mechanism::four_bar::mobility::linkage_type;
use crate::mechanism::loads::{LoadedLinkage, Scratch};
use crate::mechanism::{CrankLinkage, LinkageType};
use crate::task::forms::design_space::{SHAPE, Shape};
use crate::task::loads::LoadsSpec;
use crate::task::requirement::RequirementKind;
use std::f64::consts::TAU;

/// The assemblies.
const BOTH: [AssemblyMode; 2] = [AssemblyMode::Plus, AssemblyMode::Minus];
/// Number of samples of a full turn.
const SAMPLES: usize = 96;
/// Local maxima from this part of the largest sample on are refined, so many at most: between samples a curve with six waves in a
/// turn rises by 2 %.
const WORTH_REFINING: f64 = 0.97;
const MOST_REFINED: usize = 3;
/// Rounds of the refinement of each by parabolas and of the largest of them after that, and the factor by which their width
/// shrinks: the derivatives of the row leave out the change of the angle, which has to be that of the peak.
const ROUNDS: usize = 2;
const LAST_ROUNDS: usize = 3;
const SHRINK: f64 = 0.2;
/// The step of central differences, in sizes of the target and in radians: the root of the rounding of a second difference.
const STEP: f64 = 1e-6;

pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let (Some(most), Some(loads)) = (at.require.peak_torque_max, at.loads) else { return };
    let kind = RowKind::Limit { of: RequirementKind::PeakTorque, side: None, by_room: at.size / most };
    let row = peak(at, loads).and_then(|peak| row(at, loads, (kind, most), &peak));
    // A linkage without any position has no torque: its violation is the target's size.
    each(&row.unwrap_or_else(|| Row::still(kind, -at.size, [0.0; SHAPE])));
}

/// The torque of largest size.
#[derive(Clone, Copy)]
struct Peak {
    size: f64,
    angle: f64,
    assembly: AssemblyMode,
    place: Place,
}

/// A loaded shape on one assembly.
struct Loaded {
    linkage: LoadedLinkage,
    scratch: Scratch,
}

impl Loaded {
    fn of(shape: &Shape, loads: &LoadsSpec, assembly: AssemblyMode) -> Option<Loaded> {
        let linkage = shape.linkage(assembly).ok()?;
        let linkage = loads.on(&CrankLinkage::from(linkage)).ok()?;
        Some(Loaded { scratch: linkage.scratch(), linkage })
    }

    /// Returns the size of the torque at a crank angle; `None` where the loop does not close.
    fn at(&mut self, angle: f64) -> Option<f64> {
        let input = self.linkage.drive().motion(angle);
        self.linkage.torque(angle, input, &mut self.scratch).ok().map(f64::abs)
    }

    /// Returns the largest size over samples from an angle on.
    fn largest(&mut self, from: f64, step: f64, count: usize, periodic: bool) -> Option<(f64, usize, f64)> {
        let sizes: Vec<Option<f64>> = (0..count).map(|i| self.at(from + step * i as f64)).collect();
        let greatest = sizes.iter().flatten().copied().max_by(f64::total_cmp)?;
        let near = |i: usize, by: usize| {
            let j = i + count + by - 1;
            let inside = periodic || (count..2 * count).contains(&j);
            inside.then(|| sizes[j % count]).flatten()
        };
        let is_peak = |i: &usize| {
            let here = sizes[*i].unwrap_or_default();
            here >= WORTH_REFINING * greatest
                && [0, 2].iter().all(|by| near(*i, *by).is_none_or(|v| v <= here))
        };
        let peaks: Vec<usize> = (0..count).filter(is_peak).take(MOST_REFINED).collect();
        let mut best: Option<(Around, usize)> = None;
        for i in peaks {
            let mut found =
                Around { angle: from + step * i as f64, size: sizes[i].unwrap_or_default(), step };
            let beside = near(i, 0).zip(near(i, 2)).map(|(before, after)| [before, after]);
            self.refine(&mut found, beside, ROUNDS);
            // Of a sample at an end, or beside an open position, there is nothing to refine.
            found.step = if beside.is_some() { found.step } else { 0.0 };
            if best.is_none_or(|(best, _)| found.size > best.size) {
                best = Some((found, i));
            }
        }
        let (mut found, i) = best?;
        if found.step > 0.0 {
            let beside = self.beside(&found);
            self.refine(&mut found, beside, LAST_ROUNDS);
        }
        Some((found.angle, i, found.size))
    }

    /// Returns the sizes a step before and after an angle.
    fn beside(&mut self, around: &Around) -> Option<[f64; 2]> {
        Some([self.at(around.angle - around.step)?, self.at(around.angle + around.step)?])
    }

    /// Refines a local maximum by parabolas through three values a step apart.
    fn refine(&mut self, around: &mut Around, mut beside: Option<[f64; 2]>, rounds: usize) {
        for _ in 0..rounds {
            let Some([before, after]) = beside else { return };
            let bend = before - 2.0 * around.size + after;
            if bend >= 0.0 {
                return;
            }
            let vertex = around.angle + around.step * (0.5 * (before - after) / bend).clamp(-1.0, 1.0);
            match self.at(vertex) {
                Some(there) if there > around.size => (around.angle, around.size) = (vertex, there),
                _ => {}
            }
            around.step *= SHRINK;
            beside = self.beside(around);
        }
    }
}

/// A local maximum between values a step apart.
#[derive(Clone, Copy)]
struct Around {
    angle: f64,
    size: f64,
    step: f64,
}

/// Returns the torque of largest size of the motion; `None` if the loop closes nowhere.
fn peak(at: &At<'_>, loads: &LoadsSpec) -> Option<Peak> {
    let turns = linkage_type(at.links).is_some_and(LinkageType::input_turns_fully);
    match *at.motion {
        Motion::Positions(positions) if !turns => {
            let mut both = BOTH.map(|assembly| Loaded::of(at.shape, loads, assembly));
            let found = positions.iter().enumerate().filter_map(|(j, [crank, coupler])| {
                let assembly = assembly_of(at.shape, *crank, *coupler);
                let which = BOTH.iter().position(|one| *one == assembly)?;
                let angle = crank.arg();
                let size = both[which].as_mut()?.at(angle)?;
                Some(Peak { size, angle, assembly, place: Place::Position(j) })
            });
            found.max_by(|one, other| one.size.total_cmp(&other.size))
        }
        Motion::Stretch(from, to, assembly) if !turns => {
            let (low, high) = (from.min(to), from.max(to));
            let steps = ((high - low) / TAU * SAMPLES as f64).ceil().clamp(8.0, SAMPLES as f64) as usize;
            let step = (high - low) / steps as f64;
            let (angle, i, size) =
                Loaded::of(at.shape, loads, assembly)?.largest(low, step, steps + 1, false)?;
            let place = match i {
                0 => Place::First,
                _ if i == steps => Place::Last,
                _ => Place::Anywhere,
            };
            Some(Peak { size, angle, assembly, place })
        }
        Motion::Positions(positions) => {
            let [crank, coupler] = *positions.first()?;
            full_turn(at, loads, assembly_of(at.shape, crank, coupler))
        }
        Motion::Stretch(.., assembly) => full_turn(at, loads, assembly),
    }
}

/// Returns the torque of largest size over a full turn.
fn full_turn(at: &At<'_>, loads: &LoadsSpec, assembly: AssemblyMode) -> Option<Peak> {
    let mut loaded = Loaded::of(at.shape, loads, assembly)?;
    let (angle, _, size) = loaded.largest(0.0, TAU / SAMPLES as f64, SAMPLES, true)?;
    Some(Peak { size, angle, assembly, place: Place::Anywhere })
}

/// Returns the row at the peak; `None` if a shape beside this one does not close there.
fn row(at: &At<'_>, loads: &LoadsSpec, (kind, most): (RowKind, f64), peak: &Peak) -> Option<Row> {
    let part = peak.size / most;
    let (value, slope) = if part > 1.0 {
        (-at.size * part.ln(), -at.size / peak.size)
    } else {
        (at.size * (1.0 - part), -at.size / most)
    };
    let mut row = Row::still(kind, value - at.margin(), [0.0; SHAPE]);
    let step = STEP * at.size;
    for (i, by) in row.shape.iter_mut().enumerate() {
        let beside = |step: f64| Loaded::of(&moved(at.shape, i, step), loads, peak.assembly)?.at(peak.angle);
        *by = slope * (beside(step)? - beside(-step)?) / (2.0 * step);
    }
    if peak.place != Place::Anywhere {
        let mut loaded = Loaded::of(at.shape, loads, peak.assembly)?;
        let by = (loaded.at(peak.angle + STEP)? - loaded.at(peak.angle - STEP)?) / (2.0 * STEP);
        row.turns = Turn::at(peak.place, slope * by);
    }
    Some(row)
}

/// Returns a shape with one parameter moved: Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y.
fn moved(shape: &Shape, parameter: usize, by: f64) -> Shape {
    let mut shape = *shape;
    let place = match parameter {
        0 => &mut shape.crank_pivot.re,
        1 => &mut shape.crank_pivot.im,
        2 => &mut shape.follower_pivot.re,
        3 => &mut shape.follower_pivot.im,
        4 => &mut shape.crank,
        5 => &mut shape.coupler,
        6 => &mut shape.follower,
        7 => &mut shape.offset.re,
        _ => &mut shape.offset.im,
    };
    *place += by;
    shape
}
