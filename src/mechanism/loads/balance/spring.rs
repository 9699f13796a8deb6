//! The spring that lets a loaded linkage stay where it is put: rate and free length, or free angle, for the least static torque.
//!
//! With l the length between the ends of a spring of rate k and free length l0, and ' the derivative by the crank angle, the spring
//! adds k (l - l0) l' to the torque of the motor: linear in u = k and v = k l0,
//!
//! ```text
//! T = T_0 + u l l' - v l'                    u >= 0, v >= l_min u        l_min: the least free length
//! T = T_0 + u w w' - v w'                    u >= 0                      torsion: w the angle between the bodies, v = k w_0
//! ```
//!
//! T_0, the torque without it, is that of statics. A lamp arm of weight m g with its centre at r, and a spring from b on the arm to
//! a above the pivot, has l l' = a b sin(phi'), so that k a b = m g r with l0 = 0 balances it exactly (R. H. Nathan, A constant force
//! generation mechanism, ASME J. Mech. Trans. Autom. Des. 107 (1985) 508-512).

use super::{BalanceError, STEPS, TorqueOver, VERIFIED, angle, length, percent, product, torques};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::loads::loaded::LoadedLinkage;
use crate::mechanism::loads::resolve::SpringOn;
use crate::mechanism::loads::{Loads, Place, Spring};
use crate::mechanism::{Linkage, Unit};
use crate::numbers::optimise::nonnegative::nonnegative_least_squares;
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// The part of the torque that a spring has to take off, at least, to be any use.
const LEAST_USE: f64 = 1e-9;
/// The room between a torsion spring's deflection and half a turn, where its moment jumps; radians.
const ROOM: f64 = 1e-6;

/// The ends of a spring.
#[derive(Clone, Debug, PartialEq)]
pub enum SpringEnds {
    /// Of an extension spring: two places on two bodies, one of which may be the ground.
    Places([Place; 2]),
    /// Of a torsion spring: the body on which it acts, and the one that bears it.
    Bodies([String; 2]),
}

/// The balance that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringRequest {
    /// The ends of the spring.
    pub ends: SpringEnds,
    /// The range of crank angles, radians: the second above the first by a full turn at most.
    pub range: [f64; 2],
    /// The rates to choose from, N/m or N m/rad; empty: any.
    pub rates: Vec<f64>,
    /// The least free length of an extension spring, m.
    pub least_free_length: f64,
}

/// A balance by a spring, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpringBalance {
    /// The spring.
    pub spring: Spring,
    /// [least, greatest] length of an extension spring over the range, m; of a torsion spring its deflection, radians.
    pub span: [f64; 2],
    /// The largest force of the spring (N), or moment (N m), over the range; negative if it is pushed.
    pub largest: f64,
    /// The static torque without the spring.
    pub before: TorqueOver,
    /// The static torque with it, from the mechanics of the balanced loads.
    pub after: TorqueOver,
    /// The peak that is left, percent of the one before.
    pub residual_percent: f64,
    /// The root mean square that is left, percent of the one before.
    pub residual_rms_percent: f64,
    /// The loads with the spring.
    #[serde(skip)]
    pub loads: Loads,
}

/// Computes the spring that leaves the least root mean square of the static torque over a range.
///
/// # Errors
/// [`BalanceError`]: loads or ends that do not fit the linkage, a range in which it is open, nothing to balance, or a spring that
/// is no use.
pub fn balance_by_spring(
    linkage: &Linkage,
    unit: Unit,
    loads: &Loads,
    request: &SpringRequest,
) -> Result<SpringBalance, BalanceError> {
    check(request)?;
    let range = request.range;
    let loaded = LoadedLinkage::new(linkage, unit, loads)?;
    let before = TorqueOver::of(&loaded, range)?;
    let own = torques(&loaded, range, STEPS)?;
    if before.peak.value == 0.0 {
        return Err(BalanceError::NothingToBalance);
    }
    let columns = Columns::of(linkage, unit, request)?;
    let [rate, free] = columns.best(&own, request)?;
    let spring = spring_of(&request.ends, rate, free);
    let mut balanced = loads.clone();
    balanced.springs.push(spring.clone());
    let with = LoadedLinkage::new(linkage, unit, &balanced)?;
    let after = TorqueOver::of(&with, range)?;
    let span = columns.span(linkage, unit, request)?;
    let span = if columns.torsion { span.map(|turn| turn - free) } else { span };
    let rest = if columns.torsion { 0.0 } else { free };
    let forces = span.map(|at| rate * (at - rest));
    let largest = if forces[0].abs() > forces[1].abs() { forces[0] } else { forces[1] };
    Ok(SpringBalance {
        spring,
        span,
        largest,
        before,
        after,
        residual_percent: percent(after.peak.value.abs(), before.peak.value.abs()),
        residual_rms_percent: percent(after.rms, before.rms),
        loads: balanced,
    })
}

fn check(request: &SpringRequest) -> Result<(), BalanceError> {
    let [from, to] = request.range;
    if !(to > from && to - from <= TAU * (1.0 + 1e-12)) {
        return Err(BalanceError::BadRange);
    }
    let least = request.least_free_length;
    if !(least >= 0.0 && least.is_finite()) {
        let what = "the least free length";
        return Err(BalanceError::BadNumber { what, value: least, must: "of 0 or more" });
    }
    match request.rates.iter().find(|rate| !(**rate > 0.0 && rate.is_finite())) {
        Some(&value) => Err(BalanceError::BadNumber { what: "a rate", value, must: "above 0" }),
        None => Ok(()),
    }
}

fn spring_of(ends: &SpringEnds, rate: f64, free: f64) -> Spring {
    match ends {
        SpringEnds::Places(ends) => Spring::Extension { ends: ends.clone(), rate, free_length: free },
        SpringEnds::Bodies(bodies) => {
            // The nearest of the angles that differ by full turns.
            let free_angle = free - TAU * (free / TAU).round();
            Spring::Torsion { bodies: bodies.clone(), rate, free_angle }
        }
    }
}

/// The torque by the unknowns at the steps of a range: by u, and by v.
struct Columns {
    torsion: bool,
    by: [Vec<f64>; 2],
    /// [least, greatest] angle between the bodies of a torsion spring, without jumps.
    turns: [f64; 2],
}

impl Columns {
    fn of(linkage: &Linkage, unit: Unit, request: &SpringRequest) -> Result<Columns, BalanceError> {
        match &request.ends {
            SpringEnds::Places(_) => {
                let one = |free: f64| -> Result<Vec<f64>, BalanceError> {
                    let springs = vec![spring_of(&request.ends, 1.0, free)];
                    let loaded = LoadedLinkage::new(linkage, unit, &Loads { springs, ..Loads::default() })?;
                    torques(&loaded, request.range, STEPS)
                };
                let by_rate = one(0.0)?;
                // The free length of one metre, less that of none.
                let by_free = one(1.0)?.iter().zip(&by_rate).map(|(with, without)| with - without).collect();
                Ok(Columns { torsion: false, by: [by_rate, by_free], turns: [0.0; 2] })
            }
            SpringEnds::Bodies(_) => {
                let angles = angles(linkage, unit, request, STEPS)?;
                let by_rate = angles.iter().map(|[turn, rate]| turn * rate).collect();
                let by_free = angles.iter().map(|[_, rate]| -rate).collect();
                let ends = |(low, high): (f64, f64), [turn, _]: &[f64; 2]| (low.min(*turn), high.max(*turn));
                let (low, high) = angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
                if high - low >= TAU - 2.0 * ROOM {
                    return Err(BalanceError::TurnsTooFar);
                }
                Ok(Columns { torsion: true, by: [by_rate, by_free], turns: [low, high] })
            }
        }
    }

    /// Returns rate and free length (or angle) of the least sum of squared torques.
    fn best(&self, own: &[f64], request: &SpringRequest) -> Result<[f64; 2], BalanceError> {
        let all: Vec<[f64; 2]> = if request.rates.is_empty() {
            self.free_rate(own, request.least_free_length).into_iter().collect()
        } else {
            request.rates.iter().map(|rate| self.at_rate(own, *rate, request.least_free_length)).collect()
        };
        let best = all.into_iter().map(|spring| (self.left(own, spring), spring));
        let best = best.min_by(|(one, _), (other, _)| one.total_cmp(other));
        let use_is = |left: f64| left < (1.0 - LEAST_USE) * length(own);
        best.filter(|(left, _)| use_is(*left)).map(|(_, spring)| spring).ok_or(BalanceError::NoSpringHelps)
    }

    /// Returns the length of the torques that a spring leaves.
    fn left(&self, own: &[f64], [rate, free]: [f64; 2]) -> f64 {
        let [by_rate, by_free] = &self.by;
        let left = own.iter().zip(by_rate).zip(by_free).map(|((t, u), v)| t + rate * (u + free * v));
        length(&left.collect::<Vec<_>>())
    }

    /// Returns the spring of any rate; `None` if its rate would be 0.
    fn free_rate(&self, own: &[f64], least: f64) -> Option<[f64; 2]> {
        let [by_rate, by_free] = &self.by;
        // v = least u + v' with v' >= 0; the angle of a torsion spring has any sign.
        let held: Vec<f64> = by_rate.iter().zip(by_free).map(|(u, v)| u + least * v).collect();
        let mut columns = vec![held, by_free.clone()];
        if self.torsion {
            columns.push(by_free.iter().map(|v| -v).collect());
        }
        let sizes: Vec<f64> = columns.iter().map(|column| length(column)).collect();
        if sizes.iter().all(|size| *size == 0.0) {
            return None;
        }
        for (column, size) in columns.iter_mut().zip(&sizes).filter(|(_, size)| **size > 0.0) {
            column.iter_mut().for_each(|x| *x /= size);
        }
        let right: Vec<f64> = own.iter().map(|t| -t).collect();
        let found = nonnegative_least_squares(&columns, &right).values;
        let value = |i: usize| if sizes[i] > 0.0 { found[i] / sizes[i] } else { 0.0 };
        let rate = value(0);
        let free = value(1) - if self.torsion { value(2) } else { 0.0 };
        if rate <= 0.0 {
            return None;
        }
        let spring = [rate, least + free / rate];
        Some(if self.torsion { self.unwound(own, spring) } else { spring })
    }

    /// Returns the spring of a given rate.
    fn at_rate(&self, own: &[f64], rate: f64, least: f64) -> [f64; 2] {
        let [by_rate, by_free] = &self.by;
        let left: Vec<f64> = own.iter().zip(by_rate).map(|(t, u)| t + rate * u).collect();
        let size = product(by_free, by_free);
        let free = if size > 0.0 { -product(by_free, &left) / (size * rate) } else { 0.0 };
        if self.torsion { [rate, self.within(free)] } else { [rate, free.max(least)] }
    }

    /// Returns a free angle at which the deflection stays within half a turn.
    fn within(&self, free: f64) -> f64 {
        let [low, high] = self.turns;
        free.clamp(high - PI + ROOM, low + PI - ROOM)
    }

    /// Returns a torsion spring whose deflection stays within half a turn: where it would not, of the nearest free angle that
    /// does, and of the best rate for that.
    fn unwound(&self, own: &[f64], [rate, free]: [f64; 2]) -> [f64; 2] {
        let held = self.within(free);
        if held == free {
            return [rate, free];
        }
        let [by_rate, by_free] = &self.by;
        let column: Vec<f64> = by_rate.iter().zip(by_free).map(|(u, v)| u + held * v).collect();
        let size = product(&column, &column);
        let rate = if size > 0.0 { (-product(&column, own) / size).max(0.0) } else { 0.0 };
        [rate, held]
    }

    /// Returns the least and the greatest length over the range, or angle between the bodies.
    fn span(&self, linkage: &Linkage, unit: Unit, request: &SpringRequest) -> Result<[f64; 2], BalanceError> {
        if self.torsion {
            return Ok(self.turns);
        }
        // The energy of a spring of 2 N/m without a free length is the square of its length.
        let springs = vec![spring_of(&request.ends, 2.0, 0.0)];
        let loaded = LoadedLinkage::new(linkage, unit, &Loads { springs, ..Loads::default() })?;
        let mut scratch = loaded.scratch();
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for i in 0..=VERIFIED {
            let at = angle(request.range, VERIFIED, i);
            let placed = loaded.torque(at, CrankMotion::steady(0.0), &mut scratch);
            placed.map_err(|_| BalanceError::NotClosed { crank_deg: at.to_degrees() })?;
            let length = loaded.potential(&scratch).sqrt();
            (low, high) = (low.min(length), high.max(length));
        }
        Ok([low, high])
    }
}

/// Returns the angle between the bodies of a torsion spring without jumps, and its derivative by the crank angle.
fn angles(
    linkage: &Linkage,
    unit: Unit,
    request: &SpringRequest,
    steps: usize,
) -> Result<Vec<[f64; 2]>, BalanceError> {
    let springs = vec![spring_of(&request.ends, 1.0, 0.0)];
    let loaded = LoadedLinkage::new(linkage, unit, &Loads { springs, ..Loads::default() })?;
    let Some(SpringOn::Torsion { bodies: [one, two], .. }) = loaded.springs().first().copied() else {
        return Err(BalanceError::NoSpringHelps);
    };
    let mut scratch = loaded.scratch();
    let mut before: Option<f64> = None;
    let mut found = Vec::with_capacity(steps + 1);
    for i in 0..=steps {
        let at = angle(request.range, steps, i);
        let placed = loaded.torque(at, CrankMotion::steady(0.0), &mut scratch);
        placed.map_err(|_| BalanceError::NotClosed { crank_deg: at.to_degrees() })?;
        let places = &scratch.places().bodies;
        let turn = (places[one].direction * places[two].direction.conj()).arg();
        let turn = before.map_or(turn, |before| turn - TAU * ((turn - before) / TAU).round());
        before = Some(turn);
        found.push([turn, places[one].first - places[two].first]);
    }
    Ok(found)
}
