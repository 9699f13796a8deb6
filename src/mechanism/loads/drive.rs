//! The crank's motion over its angle: a speed and an acceleration that are given, or a table of speeds.
//!
//! A table holds rows (phi, omega). The speed between them is the periodic cubic spline through them, so that its derivative by the
//! crank angle is continuous, and the crank's acceleration follows from it:
//!
//! ```text
//! alpha = d omega/dt = omega d omega/dphi
//! ```
//!
//! The speed keeps its sign and is nowhere 0: a crank that stops or turns back passes its angles more than once, and no function of the
//! angle describes its speed. A turn takes the time integral dphi/|omega|.

use super::quantity::Quantity;
use super::spline::{Extreme, PeriodicSpline};
use super::{LoadFault, Loads};
use crate::mechanism::four_bar::motion::CrankMotion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The speed of a crank: constant, or a table over the crank angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CrankSpeed {
    /// Constant, rad/s.
    Steady(f64),
    /// (crank angle in radians, rad/s) in ascending order within one turn; a periodic cubic spline between them.
    Table(Vec<(f64, f64)>),
}

impl CrankSpeed {
    /// Returns the speed of the crank's image, its angles mapped to `turn + angle`; of a mirror image to `turn - angle`, in the other
    /// sense of rotation.
    #[must_use]
    pub fn turned(&self, turn: f64, mirrored: bool) -> Self {
        let sense = |speed: f64| if mirrored { -speed } else { speed };
        match self {
            CrankSpeed::Steady(speed) => CrankSpeed::Steady(sense(*speed)),
            CrankSpeed::Table(rows) => {
                let table = Quantity::Table(rows.iter().map(|(at, speed)| (*at, [sense(*speed)])).collect());
                match table.turned(turn, mirrored) {
                    Quantity::Table(rows) => {
                        CrankSpeed::Table(rows.into_iter().map(|(at, [speed])| (at, speed)).collect())
                    }
                    Quantity::Constant([speed]) => CrankSpeed::Steady(speed),
                }
            }
        }
    }
}

/// The motion of the crank at every crank angle.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// The same speed and acceleration at every crank angle.
    Given(CrankMotion),
    /// A speed over the crank angle, and the acceleration that follows from it.
    Table(SpeedCurve),
}

/// A smooth speed over the crank angle, of one sign.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedCurve {
    spline: PeriodicSpline,
    range: SpeedRange,
}

/// The speeds of a crank over a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedRange {
    /// The slowest, rad/s.
    pub slowest_rad_s: f64,
    /// The fastest, rad/s.
    pub fastest_rad_s: f64,
    /// The mean over time, 2 pi over the time of a turn, rad/s.
    pub mean_rad_s: f64,
    /// The time of a turn, s.
    pub turn_s: f64,
}

impl From<CrankMotion> for Drive {
    fn from(motion: CrankMotion) -> Drive {
        Drive::Given(motion)
    }
}

impl Drive {
    /// Returns the motion of a crank that stands still: statics.
    pub fn still() -> Drive {
        Drive::Given(CrankMotion::steady(0.0))
    }

    /// Returns the motion of a crank at a speed.
    ///
    /// ```
    /// use linkwright::internals::mechanism::loads::{CrankSpeed, Drive};
    /// use std::f64::consts::PI;
    /// let drive = Drive::of(&CrankSpeed::Table(vec![(0.0, 10.0), (PI, 20.0)]))?;
    /// let fastest = drive.motion(PI);
    /// assert!((fastest.speed_rad_s - 20.0).abs() < 1e-12 && fastest.acceleration_rad_s2.abs() < 1e-12);
    /// // Through two rows the spline is 15 rad/s halfway, where its slope is 15/pi.
    /// let halfway = drive.motion(PI / 2.0);
    /// assert!((halfway.acceleration_rad_s2 - 15.0 * 15.0 / PI).abs() < 1e-11);
    /// # Ok::<(), linkwright::internals::mechanism::loads::LoadFault>(())
    /// ```
    ///
    /// # Errors
    /// [`LoadFault`] of a number that is not finite; of a table with fewer than two rows or out of order, with two speeds at one crank
    /// angle, or with a speed that reaches 0 or changes its sign, in a row or between two.
    pub fn of(speed: &CrankSpeed) -> Result<Drive, LoadFault> {
        match speed {
            CrankSpeed::Steady(speed) if speed.is_finite() => Ok(Drive::Given(CrankMotion::steady(*speed))),
            CrankSpeed::Steady(speed) => Err(LoadFault::NotFinite(*speed)),
            CrankSpeed::Table(rows) => SpeedCurve::through(rows).map(Drive::Table),
        }
    }

    /// Returns the motion that is asked for: a constant speed (rad/s), if one is given, else that of the loads, else none; with a
    /// constant acceleration (rad/s^2).
    ///
    /// # Errors
    /// [`LoadFault::AccelerationOfTable`] of an acceleration beside a table of speeds; else as [`of`](Self::of).
    pub fn chosen(speed: Option<f64>, acceleration: f64, loads: Option<&Loads>) -> Result<Drive, LoadFault> {
        let of_loads = loads.and_then(|loads| loads.speed_rad_s.clone());
        match speed.map(CrankSpeed::Steady).or(of_loads) {
            Some(table @ CrankSpeed::Table(_)) if acceleration == 0.0 => Drive::of(&table),
            Some(CrankSpeed::Table(_)) => Err(LoadFault::AccelerationOfTable),
            Some(CrankSpeed::Steady(speed)) => {
                Ok(CrankMotion { speed_rad_s: speed, acceleration_rad_s2: acceleration }.into())
            }
            None => Ok(CrankMotion { speed_rad_s: 0.0, acceleration_rad_s2: acceleration }.into()),
        }
    }

    /// Returns the motion of the crank at a crank angle (radians).
    pub fn motion(&self, crank_angle: f64) -> CrankMotion {
        match self {
            Drive::Given(motion) => *motion,
            Drive::Table(curve) => {
                let [speed, slope] = curve.spline.at(crank_angle);
                CrankMotion { speed_rad_s: speed, acceleration_rad_s2: speed * slope }
            }
        }
    }

    /// Returns the motion over a turn as one: as given, or the mean speed over time, at which the acceleration is 0 on average.
    pub fn mean(&self) -> CrankMotion {
        match self {
            Drive::Given(motion) => *motion,
            Drive::Table(curve) => CrankMotion::steady(curve.range.mean_rad_s),
        }
    }

    /// Returns the speeds of a table over a turn; `None` without a table.
    pub fn range(&self) -> Option<SpeedRange> {
        match self {
            Drive::Given(_) => None,
            Drive::Table(curve) => Some(curve.range),
        }
    }

    /// Returns the part of time that a crank spends at a crank angle beside others: 1/|omega| of a table, else 1.
    pub(super) fn dwell(&self, crank_angle: f64) -> f64 {
        match self {
            Drive::Given(_) => 1.0,
            Drive::Table(_) => 1.0 / self.motion(crank_angle).speed_rad_s.abs(),
        }
    }
}

impl SpeedCurve {
    fn through(rows: &[(f64, f64)]) -> Result<SpeedCurve, LoadFault> {
        let as_quantity = Quantity::Table(rows.iter().map(|(angle, speed)| (*angle, [*speed])).collect());
        as_quantity.check()?;
        let [(first, speed), .., (last, again)] = rows else { return Err(LoadFault::BadTable) };
        let closes = last - first >= TAU * (1.0 - 4.0 * f64::EPSILON);
        if closes && speed != again {
            return Err(LoadFault::SpeedJumps { row: rows.len() - 1 });
        }
        let sense = speed.signum();
        if let Some(row) = rows.iter().position(|(_, speed)| speed * sense <= 0.0) {
            return Err(LoadFault::SpeedStops { row, speed_rad_s: rows[row].1 });
        }
        let knots = if closes { &rows[..rows.len() - 1] } else { rows };
        let spline = PeriodicSpline::through(knots);
        let mut range = spline.extremes();
        if sense < 0.0 {
            range.reverse();
        }
        let [Extreme { at, value: slowest }, Extreme { value: fastest, .. }] = range;
        if slowest * sense <= 0.0 {
            return Err(LoadFault::SpeedStopsBetween { crank_angle: at, speed_rad_s: slowest });
        }
        let turn_s = turn_time(&spline);
        let range = SpeedRange {
            slowest_rad_s: slowest,
            fastest_rad_s: fastest,
            mean_rad_s: sense * TAU / turn_s,
            turn_s,
        };
        if !(range.mean_rad_s.is_finite() && fastest.is_finite()) {
            return Err(LoadFault::NotFinite(fastest));
        }
        Ok(SpeedCurve { spline, range })
    }
}

/// Computes the time of a turn, integral dphi/|omega|, by three Gauss-Legendre nodes on each of `STEPS` steps of every piece: of
/// sixth order in the step.
fn turn_time(spline: &PeriodicSpline) -> f64 {
    /// At 16 steps the integral is exact to rounding unless the speed nearly vanishes.
    const STEPS: usize = 16;
    let node = 0.6_f64.sqrt();
    let pace = |angle: f64| 1.0 / spline.at(angle)[0].abs();
    let step = |from: f64, to: f64| {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let ends = pace(middle - node * half) + pace(middle + node * half);
        half / 9.0 * (5.0 * ends + 8.0 * pace(middle))
    };
    let pieces = spline.pieces();
    let parts = pieces.flat_map(|[from, to]| {
        let at = move |k: usize| from + (to - from) * k as f64 / STEPS as f64;
        (0..STEPS).map(move |k| [at(k), at(k + 1)])
    });
    parts.map(|[from, to]| step(from, to)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_time_of_a_turn_is_that_of_the_closed_form() {
        // Of omega = w (1 + k cos phi): 2 pi/(w sqrt(1 - k^2)).
        let (w, k) = (8.0, 0.4);
        let rows: Vec<(f64, f64)> =
            (0..180).map(|i| TAU * f64::from(i) / 180.0).map(|x| (x, w * (1.0 + k * x.cos()))).collect();
        for sense in [1.0, -1.0] {
            let rows = rows.iter().map(|(at, speed)| (*at, sense * speed)).collect();
            let drive = Drive::of(&CrankSpeed::Table(rows)).expect("a table");
            let range = drive.range().expect("its range");
            let turn = TAU / (w * (1.0 - k * k).sqrt());
            // The spline is within 5/384 h^4 k w of the cosine.
            assert!((range.turn_s - turn).abs() < 1e-7 * turn);
            assert!((range.mean_rad_s - sense * TAU / turn).abs() < 1e-6);
            assert!((range.slowest_rad_s - sense * w * (1.0 - k)).abs() < 1e-6);
            assert!((range.fastest_rad_s - sense * w * (1.0 + k)).abs() < 1e-6);
        }
    }

    #[test]
    fn the_acceleration_is_the_rate_of_the_speed_in_time() {
        let table = CrankSpeed::Table(vec![(0.2, 5.0), (1.7, 9.0), (4.0, 6.0)]);
        let drive = Drive::of(&table).expect("a table");
        let h = 1e-5;
        for i in 0..40 {
            let angle = 0.37 * f64::from(i);
            let here = drive.motion(angle);
            // In the time h the crank turns by omega h, but for terms of second order that a central difference cancels.
            let by = here.speed_rad_s * h;
            let change = drive.motion(angle + by).speed_rad_s - drive.motion(angle - by).speed_rad_s;
            assert!((here.acceleration_rad_s2 - change / (2.0 * h)).abs() < 1e-4);
            let image = Drive::of(&table.turned(0.9, true)).expect("a table").motion(0.9 - angle);
            assert!((image.speed_rad_s + here.speed_rad_s).abs() < 1e-12);
            assert!((image.acceleration_rad_s2 + here.acceleration_rad_s2).abs() < 1e-10);
        }
    }

    #[test]
    fn speeds_that_stop_or_turn_back_are_refused() {
        let of = |rows: &[(f64, f64)]| Drive::of(&CrankSpeed::Table(rows.to_vec()));
        assert_eq!(of(&[(0.0, 5.0)]), Err(LoadFault::BadTable));
        assert_eq!(of(&[(1.0, 5.0), (0.0, 6.0)]), Err(LoadFault::BadTable));
        let stops = LoadFault::SpeedStops { row: 1, speed_rad_s: 0.0 };
        assert_eq!(of(&[(0.0, 5.0), (PI, 0.0)]), Err(stops));
        assert_eq!(of(&[(0.0, 5.0), (PI, 4.0), (TAU, 6.0)]), Err(LoadFault::SpeedJumps { row: 2 }));
        // A full turn that closes is the same as one without its last row.
        assert_eq!(of(&[(0.0, 5.0), (PI, 4.0), (TAU, 5.0)]), of(&[(0.0, 5.0), (PI, 4.0)]));
        let dips = of(&[(0.0, 10.0), (0.4, 0.1), (0.8, 0.1), (1.2, 10.0)]);
        assert!(matches!(dips, Err(LoadFault::SpeedStopsBetween { speed_rad_s, .. }) if speed_rad_s <= 0.0));
    }
}
