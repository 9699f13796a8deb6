//! The referee: judges order, circuit and branch of a motion through target points.
//!
//! Circuits and branches are those of Chase and Mirth (1993), determined from the closed forms of
//! [`crate::mechanism::four_bar::mobility`]; that the loop stays closed between the points is checked on dense samples. Nothing
//! here uses an optimiser: every verdict follows from the linkage and its positions alone. Searches use the referee:
//! they rank by its verdicts and keep the same [`ORDER_TOLERANCE`].
//!
//! *Order* is judged if the timing is free (prescribed angles are an order by themselves, but for a closed target, and for
//! targets among them whose angles are free): the parameter of the circuit
//! (the crank angle, or psi if the input rocks) must run one way through the points and less than once around.
//!
//! A target that ends where it begins ([`Task::returns`]) has one step more, from its last point back to its first,
//! and that has to be taken without reversing: a crank that turns fully turns on; one that rocks comes back only by way
//! of both toggles, around the whole circuit, if the task allows that ([`Return`]). A motion that returns through all
//! of its points in reverse is out of order at point 0, unless the task allows that too. Prescribed angles of a closed
//! target have to run one way for the same reason.

use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::mobility::{step_along, wrapped};
use crate::mechanism::four_bar::transmission::TransmissionExtremes;
use crate::mechanism::{
    AssemblyMode, Complex, CrankLinkage, InputArc, OnCircuit, bounding_box, least_and_greatest,
};
use crate::task::Defect;
use crate::task::defect::ORDER_TOLERANCE;
use crate::task::{Return, Task, Timing};
use std::f64::consts::{PI, TAU};

/// Number of samples of the motion between two neighbouring points on which closure is checked.
const CLOSURE_SAMPLES: usize = 24;
/// Greatest number of such samples in all: a turn in steps of 0.018 degrees.
const MOST_CLOSURE_SAMPLES: usize = 20_000;

/// The part of the motion between the first and the last target point.
#[derive(Clone, Debug, PartialEq)]
pub struct UsedMotion {
    /// The linkage on the circuit of the first point.
    pub on: OnCircuit<CrankLinkage>,
    /// The range of the circuit's parameter, low to high, at most a whole turn.
    pub range: [f64; 2],
}

/// The referee's verdict on a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Every defect, whether it is allowed or not.
    pub defects: Vec<Defect>,
    /// The direction: +1 if the crank (or the circuit's parameter) runs counter-clockwise through the points, -1 if
    /// clockwise, 0 if it stands still at one place of the motion.
    pub direction: f64,
    /// Whether the motion comes back to the first point of a target that ends there only by reversing.
    pub to_and_fro: bool,
    /// The motion used.
    pub motion: UsedMotion,
}

/// Judges the motion of a linkage through the points of a task at the given crank angles (radians) and assemblies, one
/// per point.
///
/// # Panics
/// If there are fewer angles or assemblies than points.
pub fn judge(
    task: &Task,
    linkage: impl Into<CrankLinkage>,
    crank_angles: &[f64],
    assemblies: &[AssemblyMode],
) -> Verdict {
    let linkage = linkage.into();
    let n = task.len();
    let samples = (CLOSURE_SAMPLES * n).min(MOST_CLOSURE_SAMPLES);
    computed(n + samples);
    let (crank_angles, assemblies) = (&crank_angles[..n], &assemblies[..n]);
    let mobility = linkage.mobility();
    let first = mobility.branch(crank_angles[0], assemblies[0]);
    let on = OnCircuit { linkage: linkage.with_assembly(assemblies[0]), arc: mobility.arc(first.circuit) };
    let prescribed = matches!(task.timing(), Timing::Prescribed { .. });
    let rocks = on.arc.is_some();

    let mut off_circuit = Vec::new();
    let mut off_branch = Vec::new();
    for j in 0..n {
        let branch = mobility.branch(crank_angles[j], assemblies[j]);
        let open = linkage.joints_with(crank_angles[j], assemblies[j]).is_none();
        // A rocking crank cannot get from one turn to the next, even if the angles agree modulo a turn.
        let other_turn = prescribed
            && on.arc.is_some_and(|arc| {
                let turns = |angle: f64| ((angle - arc.offset(angle) - arc.middle) / TAU).round();
                turns(crank_angles[j]) != turns(crank_angles[0])
            });
        if open || other_turn || branch.circuit != first.circuit {
            off_circuit.push(j);
        } else if branch.assembly != first.assembly {
            off_branch.push(j);
        }
    }

    let parameter = parameters(on.arc, crank_angles, assemblies);
    // The closing point is the first one again and does not count for the order.
    let ordered = if task.repeats_first() { n - 1 } else { n };
    let one_branch = rocks && off_branch.is_empty();
    let comes_back = task.comes_back();
    let mut to_and_fro = false;
    let course = if prescribed && !rocks {
        let mut course = Course::within_a_branch(&parameter);
        if task.closed() {
            // A closed target is closed by turning on to its first point.
            course.range[1] = course.range[1].max(course.range[0] + TAU);
        }
        if !task.closed() || comes_back == Return::Any {
            course.jumps.retain(|j| is_out_of_turn(task, *j));
        }
        course
    } else if prescribed || !off_circuit.is_empty() {
        to_and_fro = task.returns() && rocks && (one_branch || !off_circuit.is_empty());
        // The hull of the parameters used; within a branch psi is monotone in the crank angle.
        let direction = if crank_angles[n - 1] < crank_angles[0] { -1.0 } else { 1.0 };
        let mut course = Course { direction, ..Course::within_a_branch(&parameter) };
        course.jumps.retain(|j| prescribed && is_out_of_turn(task, *j));
        course
    } else {
        let within = one_branch.then(|| Course::within_a_branch(&parameter[..ordered]));
        match within {
            Some(mut course) if course.jumps.is_empty() => {
                to_and_fro = task.returns() && comes_back != Return::AroundTheCircuit;
                if task.returns() && !to_and_fro {
                    // On from the last point by way of both toggles.
                    off_branch.push(0);
                    Course::through(&parameter[..ordered], true)
                } else {
                    // On the branch t1 = -1 psi falls where the crank angle rises.
                    course.direction *= first.assembly.sign();
                    course
                }
            }
            _ => {
                // Once back at the first point, the motion has gone the whole way round.
                let whole = task.returns() && !(one_branch && comes_back == Return::Any);
                let around = Course::through(&parameter[..ordered], whole);
                if let Some(within) = within.filter(|_| around.jumps.is_empty()) {
                    // The order holds around the circuit alone: by way of the toggles and the other branch.
                    off_branch.extend(within.jumps);
                }
                around
            }
        }
    };
    // Any part beyond a whole turn has been passed already.
    let [low, high] = course.range;
    let range = [low, high.min(low + TAU)];
    let motion = UsedMotion { on, range };

    if off_circuit.is_empty() && off_branch.is_empty() {
        let open = (0..=samples).any(|i| motion.on.joints_at(motion.blend(i, samples)).is_none());
        if open {
            off_circuit.extend(1..n);
        }
    }
    let mut defects = Vec::new();
    if !off_circuit.is_empty() {
        defects.push(Defect::Circuit { at: off_circuit });
    }
    if !off_branch.is_empty() {
        defects.push(Defect::Branch { at: off_branch });
    }
    if !course.jumps.is_empty() {
        defects.push(Defect::Order { at: course.jumps });
    } else if to_and_fro && comes_back != Return::Any {
        defects.push(Defect::to_and_fro());
    }
    let moves = course.range[1] - course.range[0] > ORDER_TOLERANCE;
    let direction = if moves { course.direction } else { 0.0 };
    Verdict { defects, direction, to_and_fro, motion }
}

/// Returns whether a step back to a target is one that its crank angles do not ask for: they are free there, or at the target
/// before it.
fn is_out_of_turn(task: &Task, j: usize) -> bool {
    task.is_untimed(j) || j.checked_sub(1).is_some_and(|before| task.is_untimed(before))
}

/// Returns the parameter of the circuit at each point: the crank angle, or psi of the arc on which the input rocks.
fn parameters(arc: Option<InputArc>, crank_angles: &[f64], assemblies: &[AssemblyMode]) -> Vec<f64> {
    let Some(arc) = arc else { return crank_angles.to_vec() };
    let at = crank_angles.iter().zip(assemblies);
    let mut parameter: Vec<f64> = at.map(|(angle, assembly)| arc.parameter(*angle, *assembly)).collect();
    // psi is periodic: each point is reached the nearer way round from the one before it.
    for j in 1..parameter.len() {
        parameter[j] = parameter[j - 1] + wrapped(parameter[j] - parameter[j - 1]);
    }
    parameter
}

/// The course of a cyclic parameter through the points: its direction, range and steps back.
struct Course {
    direction: f64,
    range: [f64; 2],
    jumps: Vec<usize>,
}

impl Course {
    /// Returns the course along a branch: its sense is from the first to the last point, and it is out of order where a
    /// step goes back.
    fn within_a_branch(parameter: &[f64]) -> Course {
        let last = parameter[parameter.len() - 1];
        let direction = if last < parameter[0] { -1.0 } else { 1.0 };
        let steps = parameter.windows(2).zip(1..);
        let back = steps.filter(|(w, _)| direction * (w[1] - w[0]) < -ORDER_TOLERANCE);
        let [low, high] = least_and_greatest(parameter.iter().copied());
        Course { direction, range: [low, high], jumps: back.map(|(_, j)| j).collect() }
    }

    /// Returns the course in the direction in which the parameter travels less in total; it is in order if that is at most
    /// once around: the last point may be where the first one is, as any point may be where the one before it is.
    fn through(parameter: &[f64], whole: bool) -> Course {
        let along = |direction: f64| {
            let step = |w: &[f64]| step_along(w[1] - w[0], direction, ORDER_TOLERANCE);
            let steps: Vec<f64> = parameter.windows(2).map(step).collect();
            (steps.iter().sum::<f64>(), steps)
        };
        let (forward, backward) = (along(1.0), along(-1.0));
        let (direction, (total, steps)) =
            if backward.0 < forward.0 { (-1.0, backward) } else { (1.0, forward) };
        let mut jumps = Vec::new();
        if total > TAU + ORDER_TOLERANCE {
            jumps.extend(steps.iter().zip(1..).filter(|(step, _)| **step > PI).map(|(_, j)| j));
            if jumps.is_empty() {
                jumps.push(parameter.len() - 1);
            }
        }
        let end = parameter[0] + direction * if whole { TAU } else { total.min(TAU) };
        Course { direction, range: [parameter[0].min(end), parameter[0].max(end)], jumps }
    }
}

impl UsedMotion {
    fn blend(&self, i: usize, of: usize) -> f64 {
        self.range[0] + (self.range[1] - self.range[0]) * i as f64 / of as f64
    }

    /// Returns the extremes of the transmission angle over the motion, in closed form.
    pub fn transmission(&self) -> TransmissionExtremes {
        self.on.transmission_between(self.range)
    }

    /// Returns [xmin, ymin, xmax, ymax] of all joints and P over the motion: dense samples, each extreme refined by
    /// ternary search around its sample.
    pub fn footprint(&self) -> [f64; 4] {
        const SAMPLES: usize = 720;
        let mut reached: Vec<Complex> = self.on.linkage.pivots().collect();
        let step = (self.range[1] - self.range[0]) / SAMPLES as f64;
        // Each sample once, for all joints and directions.
        let [low, high] = self.range;
        let sampled: Vec<Option<Vec<Complex>>> =
            (0..=SAMPLES).map(|i| self.on.moving_at(self.blend(i, SAMPLES).clamp(low, high))).collect();
        let count = sampled.iter().flatten().map(Vec::len).next().unwrap_or(0);
        for joint in 0..count {
            for direction in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                let toward = |joints: &Vec<Complex>| {
                    let p = joints[joint];
                    direction.0 * p.re + direction.1 * p.im
                };
                let reach = |t: f64| {
                    let joints = self.on.moving_at(t.clamp(self.range[0], self.range[1]));
                    joints.as_ref().map_or(f64::NEG_INFINITY, toward)
                };
                // Of equal ones the last is taken.
                let samples = (0..=SAMPLES).map(|i| self.blend(i, SAMPLES)).zip(&sampled);
                let best = samples
                    .map(|(t, joints)| (t, joints.as_ref().map_or(f64::NEG_INFINITY, toward)))
                    .max_by(|one, other| one.1.total_cmp(&other.1));
                let Some((best, _)) = best else { continue };
                let (mut low, mut high) = (best - step, best + step);
                for _ in 0..60 {
                    let third = (high - low) / 3.0;
                    if reach(low + third) >= reach(high - third) {
                        high -= third;
                    } else {
                        low += third;
                    }
                }
                let ends = [best, (0.5 * (low + high)).clamp(self.range[0], self.range[1])];
                reached.extend(ends.iter().filter_map(|t| Some(self.on.moving_at(*t)?[joint])));
            }
        }
        let [low, high] = bounding_box(reached.into_iter());
        [low.re, low.im, high.re, high.im]
    }
}
