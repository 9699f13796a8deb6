//! Sweep: the motion of a linkage as stretches (intervals of crank angles), with bounds of the joints' displacements
//! within one.
//!
//! On a stretch from phi - h to phi + h with one assembly, measured from its middle,
//!
//! ```text
//! |dC| <= 2 a sin(h/2) = r_C
//! |dD| <= 2 c sin(min(pi, w)/2),   w = asin(r_C / s) + max |delta - delta_middle|
//! |dP| <= |1 - z| |dC| + |z| |dD|,   P = C + z (D - C)
//! ```
//!
//! s = |CB|; the first part of w is the turn of the line B-C, delta is the angle at B between it and the follower
//! (law of cosines). s is monotone between the crank along and against the ground line, so its range over the
//! stretch is that of its ends and of those two directions; delta as a function of s has its one extreme at
//! s^2 = c^2 - b^2. No derivative enters, so a toggle, where D's speed by the crank angle is infinite, is no
//! exception.

use crate::judge::referee::UsedMotion;
use crate::mechanism::four_bar::transmission::angle_opposite;
use crate::mechanism::{AssemblyMode, FourBar, InputArc, InputRange, Joints, length};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// An interval of crank angles that is passed with one assembly mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The lower crank angle, radians.
    pub from: f64,
    /// The higher crank angle, radians.
    pub to: f64,
    /// The assembly mode.
    pub assembly: AssemblyMode,
}

impl Stretch {
    /// Returns the crank angle in the middle.
    pub fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }
}

/// A linkage with its motion as stretches.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The linkage.
    pub linkage: FourBar,
    /// The stretches, which together are the motion.
    pub stretches: Vec<Stretch>,
    /// Whether the crank turns fully.
    pub full_turn: bool,
}

/// Bounds of the joints' distances from their positions in the middle of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Bound for C.
    pub crank_pin: f64,
    /// Bound for D.
    pub follower_pin: f64,
    /// Bound for P.
    pub coupler_point: f64,
}

impl Reach {
    /// Returns the largest of the three.
    pub fn coupler(&self) -> f64 {
        self.crank_pin.max(self.follower_pin).max(self.coupler_point)
    }
}

impl Sweep {
    /// Returns the whole motion of a linkage by itself without passing a toggle: the full turn, or the arc of the crank
    /// (of two arcs the one to the left of A -> B) with the linkage's own assembly mode; `None` if it cannot be
    /// assembled.
    pub fn of_linkage(linkage: &FourBar) -> Option<Self> {
        let input = linkage.mobility().input;
        let [from, to] = match input {
            InputRange::None => return None,
            InputRange::Full => [linkage.ground_angle(), linkage.ground_angle() + TAU],
            InputRange::One(arc) | InputRange::Two([arc, _]) => arc.ends(),
        };
        let stretches = vec![Stretch { from, to, assembly: linkage.assembly() }];
        Some(Sweep { linkage: *linkage, stretches, full_turn: input == InputRange::Full })
    }

    /// Returns the motion through the points of a task. With `cycle` it is all of the circuit: the full turn, or both
    /// branches of a rocking crank. `None` of a linkage with a slider.
    pub fn of_motion(motion: &UsedMotion, cycle: bool) -> Option<Self> {
        let linkage = *motion.on.linkage.four_bar()?;
        let [low, high] = motion.range;
        let high = if cycle { low + TAU } else { high };
        let full_turn = motion.on.arc.is_none() && high - low >= TAU;
        let to = if full_turn { low + TAU } else { high };
        let stretches = match motion.on.arc {
            Some(arc) => split(&arc, low, high),
            None => vec![Stretch { from: low, to, assembly: linkage.assembly() }],
        };
        Some(Sweep { linkage, stretches, full_turn })
    }

    /// Computes the joints in the middle of a stretch and the bounds of their distances from there; `None` if the loop
    /// is open.
    pub fn reach(&self, stretch: &Stretch) -> Option<(Joints, Reach)> {
        let linkage = &self.linkage;
        let middle = stretch.middle();
        let joints = linkage.position_with(middle, stretch.assembly).joints()?;
        let half = 0.5 * (stretch.to - stretch.from);
        let crank_pin = 2.0 * linkage.crank() * (0.5 * half.min(PI)).sin();
        let s = linkage.diagonal(middle);
        let turn = if crank_pin < s { (crank_pin / s).asin() } else { PI };
        let swing = turn + self.change_of_angle(stretch, s);
        let follower_pin = 2.0 * linkage.follower() * (0.5 * swing.min(PI)).sin();
        let z = linkage.coupler_ratio();
        let coupler_point = length(1.0 - z) * crank_pin + length(z) * follower_pin;
        Some((joints, Reach { crank_pin, follower_pin, coupler_point }))
    }

    /// Computes max |delta - delta(s)| over a stretch, delta the angle at B opposite to the coupler.
    fn change_of_angle(&self, stretch: &Stretch, s: f64) -> f64 {
        let linkage = &self.linkage;
        let (g, a) = (linkage.ground(), linkage.crank());
        let (b, c) = (linkage.coupler(), linkage.follower());
        let (near, far) = ((b - c).abs(), b + c);
        let holds = |angle: f64| stretch.from + (angle - stretch.from).rem_euclid(TAU) <= stretch.to;
        let ground = linkage.ground_angle();
        let ends = [linkage.diagonal(stretch.from), linkage.diagonal(stretch.to)];
        let low = if holds(ground) { (g - a).abs() } else { ends[0].min(ends[1]) }.max(near);
        let high = if holds(ground + PI) { g + a } else { ends[0].max(ends[1]) }.min(far);
        let delta = |s: f64| angle_opposite(b, s, c);
        let here = delta(s);
        let mut change = (delta(low) - here).abs().max((delta(high) - here).abs());
        let extreme = ((c - b) * (c + b)).max(0.0).sqrt();
        if extreme > low && extreme < high {
            change = change.max((delta(extreme) - here).abs());
        }
        change
    }
}

/// Splits the crank angles between two values of psi at the toggles that psi passes.
fn split(arc: &InputArc, low: f64, high: f64) -> Vec<Stretch> {
    let mut cuts = vec![low];
    let mut toggle = FRAC_PI_2 + PI * ((low - FRAC_PI_2) / PI).floor() + PI;
    while toggle < high {
        cuts.push(toggle);
        toggle += PI;
    }
    cuts.push(high);
    let stretch = |w: &[f64]| {
        let (one, other) = (arc.crank_angle(w[0]), arc.crank_angle(w[1]));
        let assembly = AssemblyMode::of((0.5 * (w[0] + w[1])).cos());
        Stretch { from: one.min(other), to: one.max(other), assembly }
    };
    cuts.windows(2).map(stretch).collect()
}
