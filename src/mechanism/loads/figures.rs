//! Figures of a loaded linkage over the range of its crank.
//!
//! With T the crank's torque at crank angle phi, T_m its mean over a turn and omega the crank's speed, held constant by an ideal
//! motor, a motor of constant torque T_m would let the mechanism's energy swing by
//!
//! ```text
//! E = max - min over phi of  integral (T - T_m) dphi
//! ```
//!
//! and with J the mean inertia of all bodies reflected to the crank its coefficient of fluctuation, (omega_max -
//! omega_min)/omega, is about E/(J omega^2). A flywheel of inertia I_f on the crank makes it E/((J + I_f) omega^2) (R. L. Norton,
//! Design of Machinery, dynamic force analysis, flywheel design: I = E/(k omega^2)), so that I_f = J halves it.
//!
//! With a table of speeds over the crank angle (see [`drive`](super::drive)) the torque includes what speeds the bodies up and slows
//! them down. The work of a turn is W = integral T dphi, it takes the time t = integral dphi/|omega|, and the mean power is W/t; the root
//! mean square is over time. The fluctuation of speed is then given, not a result: E, its coefficient and the flywheel, which assume a
//! constant speed, are not defined and left out.
//!
//! Samples are [`SAMPLES`] to a turn, about half a degree apart; every peak is refined by golden-section search. Where the crank
//! does not turn fully the torque has no bound at the toggles that end its arcs; the figures are over the arcs less [`MARGIN`] at
//! each end, and the energy's swing and the flywheel, which belong to a full turn, are left out.

use super::drive::{Drive, SpeedRange};
use super::kinematics::Kinematics;
use super::loaded::{LoadedLinkage, Scratch};
use super::peaks::largest;
use super::resolve::SpringOn;
use crate::mechanism::Complex;
use crate::mechanism::any::Status;
use crate::mechanism::length;
use crate::mechanism::structure::PairKind;
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// Number of samples of a full turn.
pub const SAMPLES: usize = 720;
/// The number of pairs above which the largest sample of each pair's force is its peak: a refinement would take longer than all
/// samples.
pub const REFINED_PAIRS: usize = 32;
/// The part of an arc at each of its ends that is left out, radians: 1 degree.
pub const MARGIN: f64 = PI / 180.0;

/// The largest size of a quantity, and the crank angle at which it has it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// The size, with its sign if it has one.
    pub value: f64,
    /// The crank angle, degrees in [0, 360) of a full turn.
    pub crank_deg: f64,
}

/// The largest force of a pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointPeak {
    /// The name of the joint.
    pub at: String,
    /// The body on which the force acts.
    pub on: String,
    /// The body that it comes from.
    pub from: String,
    /// Whether it is a slider's force across its line.
    pub slides: bool,
    /// The largest force, N.
    #[serde(rename = "force_N")]
    pub force: Peak,
    /// A slider's largest moment, N m.
    #[serde(rename = "moment_N_m", skip_serializing_if = "Option::is_none")]
    pub moment: Option<Peak>,
}

/// The swing of energy over a turn, and the flywheel that halves the fluctuation of speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fluctuation {
    /// E, J.
    #[serde(rename = "energy_J")]
    pub energy: f64,
    /// J, kg m^2: the mean inertia of all bodies reflected to the crank.
    #[serde(rename = "reflected_inertia_kg_m2")]
    pub reflected_inertia: f64,
    /// E/(J omega^2); absent of a crank that stands still or bodies without mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coefficient: Option<f64>,
    /// I_f, kg m^2, the inertia of a flywheel on the crank that halves the coefficient; absent as that is.
    #[serde(rename = "halving_flywheel_kg_m2", skip_serializing_if = "Option::is_none")]
    pub halving_flywheel: Option<f64>,
}

impl Fluctuation {
    /// Computes the inertia of a flywheel on the crank (kg m^2) that brings the coefficient of fluctuation to a value: E/(k omega^2) -
    /// J, 0 if it is below that without one; `None` as the coefficient.
    pub fn flywheel_for(&self, coefficient: f64) -> Option<f64> {
        self.coefficient.map(|own| (self.reflected_inertia * (own / coefficient - 1.0)).max(0.0))
    }
}

/// Figures over the range of the crank.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadFigures {
    /// Whether they are over a full turn.
    pub full_turn: bool,
    /// [from, to] of each arc that they are over, degrees; empty for a full turn.
    pub arcs_deg: Vec<[f64; 2]>,
    /// Crank angles of samples without a result: toggles and places at which the linkage is open, degrees.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out_deg: Vec<f64>,
    /// The torque of largest size, N m.
    #[serde(rename = "torque_peak_N_m")]
    pub torque_peak: Peak,
    /// The root mean square of the torque over time, N m.
    #[serde(rename = "torque_rms_N_m")]
    pub torque_rms: f64,
    /// The mean torque over the crank angle, N m: the work of a turn over 2 pi.
    #[serde(rename = "torque_mean_N_m")]
    pub torque_mean: f64,
    /// The mean power over time, W: the work over the time that it takes; over arcs in the one sense of the speed; 0 of a crank that
    /// stands still.
    #[serde(rename = "power_mean_W")]
    pub power_mean: f64,
    /// The speeds over a turn; absent of a constant speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_over_turn: Option<SpeedRange>,
    /// The swing of energy; absent where the crank does not turn fully, and of a table of speeds, which gives the fluctuation itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fluctuation: Option<Fluctuation>,
    /// The largest force of each pair, in the order of the structure.
    pub joints: Vec<JointPeak>,
    /// The largest shaking force, N.
    #[serde(rename = "shaking_force_N")]
    pub shaking_force: Peak,
    /// The shaking moment about the crank's pivot of largest size, N m.
    #[serde(rename = "shaking_moment_N_m")]
    pub shaking_moment: Peak,
    /// The least mechanical advantage at the traced point, 1/m; absent of a point that stands still.
    #[serde(rename = "advantage_least_per_m", skip_serializing_if = "Option::is_none")]
    pub advantage_least: Option<Peak>,
    /// The least mechanical advantage at the output; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub output_advantage_least: Option<Peak>,
    /// The torsion springs, counted from 1, that are wound past half a turn: there their moment jumps.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub overwound_springs: Vec<usize>,
    /// The torque over the range, (crank angle in degrees, N m) of each stretch without a gap.
    #[serde(skip)]
    pub torque_strands: Vec<Vec<(f64, f64)>>,
}

/// A stretch of crank angles with the samples on it.
struct Sweep {
    begin: f64,
    step: f64,
    periodic: bool,
    samples: Vec<Option<Sample>>,
}

impl Sweep {
    /// Returns the torque of each stretch without a gap; that of a full turn ends where it begins.
    fn torque_strands(&self) -> Vec<Vec<(f64, f64)>> {
        let again = self.samples.first().filter(|_| self.periodic);
        let places = (0..).map(|i| (self.begin + self.step * f64::from(i)).to_degrees());
        let all: Vec<Option<(f64, f64)>> = places
            .zip(self.samples.iter().chain(again))
            .map(|(deg, sample)| sample.as_ref().map(|sample| (deg, sample.torque)))
            .collect();
        let strands = all.split(Option::is_none).filter(|strand| !strand.is_empty());
        strands.map(|strand| strand.iter().copied().flatten().collect()).collect()
    }
}

/// All quantities at a sample whose peaks are wanted, with their signs, and the reflected inertia.
#[derive(Clone, Debug)]
struct Sample {
    values: Vec<f64>,
    torque: f64,
    reflected: f64,
    /// The part of time spent there: 1/|omega| of a table of speeds, else 1.
    dwell: f64,
    deflections: Vec<f64>,
}

/// The quantities of [`Sample::values`] in their order: two of each pair, then these.
const TORQUE: usize = 0;
const SHAKING_FORCE: usize = 1;
const SHAKING_MOMENT: usize = 2;
const POINT_RATE: usize = 3;
const OUTPUT_RATE: usize = 4;
const OF_PAIRS: usize = 5;

impl LoadedLinkage {
    /// Computes the figures over the range of the crank, which moves as given (0: statics).
    ///
    /// `None` if the linkage closes at no crank angle.
    pub fn figures(&self, drive: &Drive) -> Option<LoadFigures> {
        let mut scratch = self.scratch();
        let range = self.crank_range();
        let stretches: Vec<[f64; 2]> = if range.turns_fully {
            vec![[0.0, TAU]]
        } else {
            let inner = range.arcs.iter().map(|[from, to]| [from + MARGIN, to - MARGIN]);
            inner.filter(|[from, to]| to > from).collect()
        };
        let sweeps: Vec<Sweep> = stretches
            .iter()
            .map(|stretch| self.sweep(*stretch, range.turns_fully, drive, &mut scratch))
            .collect();
        let mut peak = |quantity: usize| self.peak(&sweeps, quantity, drive, &mut scratch);
        let torque_peak = peak(TORQUE)?;
        let joints = self.pairs().iter().enumerate().filter_map(|(i, pair)| {
            let [at, on, from] = self.names(pair).map(str::to_owned);
            let slides = pair.kind == PairKind::Prismatic;
            let force = peak(OF_PAIRS + 2 * i)?;
            let moment = if slides { peak(OF_PAIRS + 2 * i + 1) } else { None };
            Some(JointPeak { at, on, from, slides, force, moment })
        });
        let joints = joints.collect();
        let [shaking_force, shaking_moment] = [peak(SHAKING_FORCE)?, peak(SHAKING_MOMENT)?];
        let mut advantage = |quantity: usize| {
            let fastest = peak(quantity).filter(|rate| rate.value > 0.0)?;
            Some(Peak { value: 1.0 / fastest.value, ..fastest }).filter(|least| least.value.is_finite())
        };
        let (advantage_least, output) = (advantage(POINT_RATE), advantage(OUTPUT_RATE));
        let Means { torque: mean, torque_rms, pace } = means(&sweeps);
        let (full_turn, speed_over_turn) = (range.turns_fully, drive.range());
        Some(LoadFigures {
            full_turn,
            arcs_deg: if full_turn {
                Vec::new()
            } else {
                stretches.iter().map(|arc| arc.map(f64::to_degrees)).collect()
            },
            left_out_deg: left_out(&sweeps),
            torque_peak,
            torque_rms,
            torque_mean: mean,
            power_mean: mean
                * drive.range().map_or(drive.mean().speed_rad_s, |range| range.mean_rad_s.signum() / pace),
            fluctuation: sweeps
                .first()
                .filter(|_| full_turn && speed_over_turn.is_none())
                .and_then(|sweep| fluctuation(sweep, drive.mean().speed_rad_s)),
            speed_over_turn,
            joints,
            shaking_force,
            shaking_moment,
            advantage_least,
            output_advantage_least: output.filter(|_| self.output().is_some()),
            overwound_springs: overwound(&sweeps, &self.torsion_springs()),
            torque_strands: sweeps.iter().flat_map(Sweep::torque_strands).collect(),
        })
    }

    fn sweep(&self, [from, to]: [f64; 2], periodic: bool, drive: &Drive, scratch: &mut Scratch) -> Sweep {
        let steps = (((to - from) / TAU * SAMPLES as f64).ceil() as usize).max(24);
        let (step, count) = ((to - from) / steps as f64, if periodic { steps } else { steps + 1 });
        let samples = (0..count).map(|i| self.sample(from + step * i as f64, drive, scratch).ok()).collect();
        Sweep { begin: from, step, periodic, samples }
    }

    fn sample(&self, angle: f64, drive: &Drive, scratch: &mut Scratch) -> Result<Sample, Status> {
        let input = drive.motion(angle);
        self.balance(angle, input, scratch)?;
        let (shaking, shaking_moment) = scratch.shaking();
        let rates = self.advantage(scratch).map(|advantage| advantage.map_or(0.0, |of| 1.0 / of));
        let mut values = vec![scratch.torque(), shaking.norm(), shaking_moment, rates[0], rates[1]];
        for (pair, [x, y]) in self.pairs().iter().zip(scratch.reactions()) {
            values.extend(match pair.kind {
                PairKind::Revolute => [length(Complex::new(*x, *y)), 0.0],
                PairKind::Prismatic => [*x, *y],
            });
        }
        let (torque, reflected) = (scratch.torque(), self.reflected_inertia(scratch));
        let dwell = drive.dwell(angle);
        Ok(Sample { values, torque, reflected, dwell, deflections: self.deflections(scratch.places()) })
    }

    /// Returns the value of largest size of a quantity over all sweeps.
    fn peak(&self, sweeps: &[Sweep], quantity: usize, drive: &Drive, scratch: &mut Scratch) -> Option<Peak> {
        let mut best: Option<(f64, f64)> = None;
        for sweep in sweeps {
            let of = |sample: &Option<Sample>| sample.as_ref().map(|sample| sample.values[quantity].abs());
            let sizes: Vec<Option<f64>> = sweep.samples.iter().map(of).collect();
            let is_refined = quantity < OF_PAIRS || self.pairs().len() <= REFINED_PAIRS;
            let found = largest(&sizes, (sweep.begin, sweep.step), sweep.periodic, |angle| {
                let sample = if is_refined { self.sample(angle, drive, scratch).ok() } else { None };
                sample.map(|sample| sample.values[quantity].abs())
            });
            best = match (best, found) {
                (Some(best), Some(found)) if found.1 <= best.1 => Some(best),
                (best, found) => found.or(best),
            };
        }
        let (angle, _) = best?;
        let value = self.sample(angle, drive, scratch).ok()?.values[quantity];
        Some(Peak { value, crank_deg: degrees(angle, sweeps.iter().any(|sweep| sweep.periodic)) })
    }

    /// Returns the deflections of the torsion springs at a position.
    fn deflections(&self, places: &Kinematics) -> Vec<f64> {
        let of = |spring: &SpringOn| match spring {
            SpringOn::Torsion { bodies: [one, two], free_angle, .. } => {
                Some(super::applied::deflection(&places.bodies[*one], &places.bodies[*two], *free_angle))
            }
            SpringOn::Extension { .. } => None,
        };
        self.springs().iter().filter_map(of).collect()
    }

    /// Returns the numbers of the torsion springs among all springs, counted from 1.
    fn torsion_springs(&self) -> Vec<usize> {
        let is_torsion = |(_, spring): &(usize, &SpringOn)| matches!(spring, SpringOn::Torsion { .. });
        self.springs().iter().enumerate().filter(is_torsion).map(|(i, _)| i + 1).collect()
    }
}

fn degrees(angle: f64, periodic: bool) -> f64 {
    let degrees = angle.to_degrees();
    let turned = if periodic { degrees.rem_euclid(360.0) } else { degrees };
    // A peak is known to far less than a millionth of a degree.
    if periodic && turned >= 360.0 - 1e-6 { 0.0 } else { turned }
}

/// Returns the crank angles of samples without a result.
fn left_out(sweeps: &[Sweep]) -> Vec<f64> {
    let of = |sweep: &Sweep| {
        let missing = sweep.samples.iter().enumerate().filter(|(_, sample)| sample.is_none());
        missing.map(|(i, _)| degrees(sweep.begin + sweep.step * i as f64, sweep.periodic)).collect::<Vec<_>>()
    };
    sweeps.iter().flat_map(of).collect()
}

/// Means over all sweeps.
struct Means {
    /// The torque over the crank angle.
    torque: f64,
    /// The root mean square of the torque over time.
    torque_rms: f64,
    /// The time spent for each radian, in the unit of [`Sample::dwell`].
    pace: f64,
}

/// Returns the means: sums over a full turn, which is periodic, and the trapezium rule over arcs.
fn means(sweeps: &[Sweep]) -> Means {
    let (mut work, mut square, mut time, mut turned) = (0.0, 0.0, 0.0, 0.0);
    for sweep in sweeps {
        let last = sweep.samples.len() - 1;
        for (i, sample) in sweep.samples.iter().enumerate() {
            let Some(Sample { torque, dwell, .. }) = sample else { continue };
            let is_end = !sweep.periodic && (i == 0 || i == last);
            let share = if is_end { 0.5 * sweep.step } else { sweep.step };
            work += share * torque;
            square += share * dwell * torque * torque;
            time += share * dwell;
            turned += share;
        }
    }
    if turned <= 0.0 {
        return Means { torque: 0.0, torque_rms: 0.0, pace: 1.0 };
    }
    Means { torque: work / turned, torque_rms: (square / time).sqrt(), pace: time / turned }
}

/// Computes the swing of energy over a full turn; `None` if a sample is missing.
///
/// The integral over a step is the cubic's through four samples, step/24 (-T0 + 13 T1 + 13 T2 - T3); its extremes are those of
/// parabolas through three of its values.
fn fluctuation(sweep: &Sweep, speed: f64) -> Option<Fluctuation> {
    let samples: Vec<&Sample> = sweep.samples.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let count = samples.len();
    let mean = samples.iter().map(|sample| sample.torque).sum::<f64>() / count as f64;
    let torque = |i: usize| samples[i % count].torque - mean;
    let mut energies = vec![0.0];
    for i in 0..count - 1 {
        let [before, here, next, after] = [torque(i + count - 1), torque(i), torque(i + 1), torque(i + 2)];
        energies.push(energies[i] + sweep.step / 24.0 * (13.0 * (here + next) - before - after));
    }
    let vertex = |i: usize| {
        let [before, here, next] =
            [energies[(i + count - 1) % count], energies[i], energies[(i + 1) % count]];
        let (slope, bend) = (0.5 * (next - before), before - 2.0 * here + next);
        let shift = if bend == 0.0 { 0.0 } else { -slope / bend };
        if shift.abs() <= 1.0 { here + 0.5 * slope * shift } else { here }
    };
    let of = |sign: f64| {
        (0..count).max_by(|i, j| (sign * energies[*i]).total_cmp(&(sign * energies[*j]))).map_or(0.0, vertex)
    };
    let energy = (of(1.0) - of(-1.0)).max(0.0);
    let reflected_inertia = samples.iter().map(|sample| sample.reflected).sum::<f64>() / count as f64;
    let coefficient = Some(energy / (reflected_inertia * speed * speed)).filter(|of| of.is_finite());
    let halving_flywheel = coefficient.map(|_| reflected_inertia);
    Some(Fluctuation { energy, reflected_inertia, coefficient, halving_flywheel })
}

/// Returns the numbers of torsion springs whose deflection jumps from half a turn to the other between two samples.
fn overwound(sweeps: &[Sweep], numbers: &[usize]) -> Vec<usize> {
    let jumps = |sweep: &Sweep, spring: usize| {
        let count = sweep.samples.len();
        let last = if sweep.periodic { count } else { count - 1 };
        (0..last).any(|i| match (&sweep.samples[i], &sweep.samples[(i + 1) % count]) {
            (Some(one), Some(two)) => (one.deflections[spring] - two.deflections[spring]).abs() > PI,
            _ => false,
        })
    };
    let is_over = |(spring, _): &(usize, &usize)| sweeps.iter().any(|sweep| jumps(sweep, *spring));
    numbers.iter().enumerate().filter(is_over).map(|(_, number)| *number).collect()
}
