//! Mobility of a four-bar: its type by Grashof, the range of its input, and its circuits, branches and toggles.
//!
//! Grashof (1883): with the shortest link s, the longest l and the others p, q, some link turns fully
//! relative to its neighbours exactly when p + q - s - l >= 0. Circuits and branches are those of Chase and
//! Mirth (1993): a circuit is the set of positions that can be reached without taking the linkage apart, a branch
//! the part of it that can be reached without passing a toggle (a position in which coupler and follower are in
//! line).
//!
//! | input | circuits | branches in each | identified by |
//! |---|---|---|---|
//! | turns fully (crank-rocker, double-crank) | 2 | 1 | circuit: t1 |
//! | rocks, Grashof (rocker-crank, double-rocker) | 2 | 2 | circuit: input arc; branch: t1 |
//! | rocks, non-Grashof (triple-rocker) | 1 | 2 | branch: t1 |
//! | change point | by its input range; the circuits meet in the flat position | | |

use super::coupler_curve::CrankDriven;
use crate::mechanism::{AssemblyMode, Complex, FourBar, Joints};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Largest |Grashof margin| of a change point, as a part of its longest link: such a linkage can lie flat within
/// rounding, and its lengths do not decide which way it leaves that position.
pub const CHANGE_POINT_TOLERANCE: f64 = 1e-9;

/// The types of four-bars, told by which link is the shortest where the Grashof margin is positive.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum LinkageType {
    /// The crank is the shortest link: it turns fully, the follower rocks.
    CrankRocker,
    /// The follower is the shortest link: it turns fully, the driven link rocks.
    RockerCrank,
    /// The ground is the shortest link: both turn fully.
    DoubleCrank,
    /// The coupler is the shortest link: both rock, the coupler turns.
    DoubleRocker,
    /// The Grashof margin is negative: no link turns fully.
    TripleRocker,
    /// The Grashof margin is zero within [`CHANGE_POINT_TOLERANCE`].
    ChangePoint,
}

impl LinkageType {
    /// Every type, in the order of the declaration.
    pub const ALL: [LinkageType; 6] = [
        LinkageType::CrankRocker,
        LinkageType::RockerCrank,
        LinkageType::DoubleCrank,
        LinkageType::DoubleRocker,
        LinkageType::TripleRocker,
        LinkageType::ChangePoint,
    ];

    /// Returns the name in files: `crank-rocker`.
    pub fn name(self) -> &'static str {
        match self {
            LinkageType::CrankRocker => "crank-rocker",
            LinkageType::RockerCrank => "rocker-crank",
            LinkageType::DoubleCrank => "double-crank",
            LinkageType::DoubleRocker => "double-rocker",
            LinkageType::TripleRocker => "triple-rocker",
            LinkageType::ChangePoint => "change-point",
        }
    }

    /// Returns whether the input turns fully, so that a motor can drive it.
    pub fn input_turns_fully(self) -> bool {
        matches!(self, LinkageType::CrankRocker | LinkageType::DoubleCrank)
    }
}

impl std::fmt::Display for LinkageType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// An interval of crank angles that the input can reach, between two toggles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputArc {
    /// The crank angle in the middle, radians from the x axis.
    pub middle: f64,
    /// Half the width of the arc, radians.
    pub half_width: f64,
}

impl InputArc {
    /// Returns the crank angle at the parameter psi of the circuit: phi = middle + half_width sin psi.
    pub fn crank_angle(&self, psi: f64) -> f64 {
        self.middle + self.half_width * psi.sin()
    }

    /// Returns the parameter psi in (-pi, pi] of a crank angle and an assembly mode: t1 = sign cos psi.
    pub fn parameter(&self, crank_angle: f64, assembly: AssemblyMode) -> f64 {
        let psi = (self.offset(crank_angle) / self.half_width).clamp(-1.0, 1.0).asin();
        match assembly {
            AssemblyMode::Plus => psi,
            AssemblyMode::Minus if psi >= 0.0 => PI - psi,
            AssemblyMode::Minus => -PI - psi,
        }
    }

    /// Returns the crank angles at the two ends.
    pub fn ends(&self) -> [f64; 2] {
        [self.middle - self.half_width, self.middle + self.half_width]
    }

    /// Returns the crank angle less the middle, brought to [-pi, pi].
    pub fn offset(&self, crank_angle: f64) -> f64 {
        wrapped(crank_angle - self.middle)
    }
}

/// The range of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputRange {
    /// The full turn.
    Full,
    /// One arc, back and forth.
    One(InputArc),
    /// One of two arcs, back and forth, mirror images about the ground line: [left of it, right of it].
    Two([InputArc; 2]),
    /// No position: the links cannot be assembled.
    None,
}

impl InputRange {
    /// Returns the arcs; none for the full turn, or without a position.
    pub fn arcs(&self) -> &[InputArc] {
        match self {
            InputRange::One(arc) => std::slice::from_ref(arc),
            InputRange::Two(arcs) => arcs,
            InputRange::Full | InputRange::None => &[],
        }
    }

    /// Returns the number of circuits; `change_point`: the two assemblies of a full turn meet in the flat position.
    pub fn circuits(&self, change_point: bool) -> u8 {
        match self {
            InputRange::None => 0,
            InputRange::One(_) => 1,
            InputRange::Full if change_point => 1,
            InputRange::Full | InputRange::Two(_) => 2,
        }
    }

    /// Returns the number of branches of each circuit.
    pub fn branches_per_circuit(&self, change_point: bool) -> u8 {
        match self {
            InputRange::None => 0,
            InputRange::Full if !change_point => 1,
            _ => 2,
        }
    }

    /// Returns the arc on which a circuit's input moves; `None` if it turns fully or cannot move.
    pub fn arc(&self, circuit: Circuit) -> Option<InputArc> {
        let arcs = self.arcs();
        arcs.get(usize::from(circuit.index)).or(arcs.last()).copied()
    }

    /// Returns the branch of a position that closes the loop.
    pub fn branch(&self, change_point: bool, crank_angle: f64, assembly: AssemblyMode) -> Branch {
        let index = match self {
            InputRange::Full if !change_point => u8::from(assembly == AssemblyMode::Minus),
            InputRange::Two(arcs) => {
                u8::from(arcs[1].offset(crank_angle).abs() < arcs[0].offset(crank_angle).abs())
            }
            _ => 0,
        };
        Branch { circuit: Circuit { index }, assembly }
    }

    /// Returns the toggles, at each of which two branches of a circuit meet; none for the full turn.
    pub fn toggles(&self) -> Vec<Toggle> {
        let of = |(arc, index): (&InputArc, u8)| {
            arc.ends().map(|angle| Toggle { crank_angle: wrapped(angle), circuit: Circuit { index } })
        };
        self.arcs().iter().zip(0..).flat_map(of).collect()
    }
}

/// A circuit: the positions that are reached without taking the linkage apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Circuit {
    /// Index of the circuit, 0 or 1.
    pub index: u8,
}

/// A branch: the part of a circuit between toggles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Branch {
    /// The circuit.
    pub circuit: Circuit,
    /// The assembly mode on the branch.
    pub assembly: AssemblyMode,
}

/// A position in which coupler and follower are in line, where two branches of a circuit meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Toggle {
    /// The crank angle, radians from the x axis.
    pub crank_angle: f64,
    /// The circuit it belongs to.
    pub circuit: Circuit,
}

/// A linkage on one of its circuits, whose positions have one parameter tau: the crank angle itself if the input turns
/// fully, psi of the [`InputArc`] if it rocks (there t1 = sign cos tau, so that both branches and their toggles are
/// passed smoothly).
#[derive(Clone, Debug, PartialEq)]
pub struct OnCircuit<L = FourBar> {
    /// The linkage, with the assembly mode of the position that chose the circuit.
    pub linkage: L,
    /// The arc of a rocking input.
    pub arc: Option<InputArc>,
}

impl<L: CrankDriven> OnCircuit<L> {
    /// Returns the circuit that holds the given position.
    pub fn through(linkage: &L, crank_angle: f64, assembly: AssemblyMode) -> Self {
        OnCircuit { linkage: linkage.with_assembly(assembly), arc: linkage.arc_of(crank_angle, assembly) }
    }

    /// Returns the crank angle and the assembly mode at a parameter.
    pub fn position_at(&self, parameter: f64) -> (f64, AssemblyMode) {
        match self.arc {
            None => (parameter, self.linkage.assembly()),
            Some(arc) => (arc.crank_angle(parameter), AssemblyMode::of(parameter.cos())),
        }
    }

    /// Computes P at a parameter; `None` if the loop is open.
    pub fn point_at(&self, parameter: f64) -> Option<Complex> {
        let (crank_angle, assembly) = self.position_at(parameter);
        self.linkage.coupler_point_with(crank_angle, assembly)
    }
}

impl OnCircuit {
    /// Computes the joints at a parameter; `None` if the loop is open.
    pub fn joints_at(&self, parameter: f64) -> Option<Joints> {
        let (crank_angle, assembly) = self.position_at(parameter);
        self.linkage.position_with(crank_angle, assembly).joints()
    }
}

/// Brings an angle to (-pi, pi].
pub fn wrapped(angle: f64) -> f64 {
    let turned = angle - TAU * (angle / TAU).round();
    if turned <= -PI { turned + TAU } else { turned }
}

/// Returns the step `by` taken forwards (`direction` +1) or backwards (-1), as an angle in [0, 2 pi); 0 for a step
/// that falls short of a full turn by less than `tolerance`.
pub fn step_along(by: f64, direction: f64, tolerance: f64) -> f64 {
    let step = (direction * by).rem_euclid(TAU);
    if step > TAU - tolerance { 0.0 } else { step }
}

/// Returns the total lengths of steps all taken forwards, and all taken backwards, as [`step_along`].
pub fn ways_round(steps: impl Iterator<Item = f64> + Clone, tolerance: f64) -> [f64; 2] {
    [1.0, -1.0].map(|direction| steps.clone().map(|by| step_along(by, direction, tolerance)).sum())
}

/// Type, margin and input range of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mobility {
    /// The type; `None` if the links cannot be assembled at all.
    pub linkage_type: Option<LinkageType>,
    /// The Grashof margin p + q - s - l, a length.
    pub grashof_margin: f64,
    /// The range of the input.
    pub input: InputRange,
}

/// Returns the Grashof margin p + q - s - l of four link lengths.
pub fn grashof_margin(links: [f64; 4]) -> f64 {
    let mut sorted = links;
    sorted.sort_by(f64::total_cmp);
    (sorted[1] - sorted[0]) + (sorted[2] - sorted[3])
}

/// Returns the type of the links ground, crank, coupler, follower; `None` if they cannot be assembled.
pub fn linkage_type(links: [f64; 4]) -> Option<LinkageType> {
    let longest = links.into_iter().fold(0.0, f64::max);
    let others = links.iter().sum::<f64>() - longest;
    if links.iter().any(|l| !l.is_finite()) || longest > others {
        return None;
    }
    let margin = grashof_margin(links);
    if margin.abs() <= CHANGE_POINT_TOLERANCE * longest {
        return Some(LinkageType::ChangePoint);
    }
    if margin < 0.0 {
        return Some(LinkageType::TripleRocker);
    }
    let shortest = (0..4).min_by(|&i, &j| links[i].total_cmp(&links[j]));
    Some(match shortest {
        Some(0) => LinkageType::DoubleCrank,
        Some(1) => LinkageType::CrankRocker,
        Some(2) => LinkageType::DoubleRocker,
        _ => LinkageType::RockerCrank,
    })
}

impl FourBar {
    /// Returns the Grashof margin p + q - s - l, with the shortest link s, the longest l, the others p and q.
    pub fn grashof_margin(&self) -> f64 {
        grashof_margin(self.links())
    }

    /// Returns the type; `None` if the links cannot be assembled.
    pub fn linkage_type(&self) -> Option<LinkageType> {
        linkage_type(self.links())
    }

    /// Computes type, margin and input range.
    pub fn mobility(&self) -> Mobility {
        let linkage_type = self.linkage_type();
        Mobility {
            linkage_type,
            grashof_margin: self.grashof_margin(),
            input: self.input_range(linkage_type),
        }
    }

    /// Computes theta in [0, pi] from the ground line at which |CB| = s, by half angles (exact near 0 and pi); s
    /// outside [|g-a|, g+a] gives the nearer end.
    fn crank_from_ground(&self, s: f64) -> f64 {
        super::transmission::angle_opposite(s, self.ground(), self.crank())
    }

    fn input_range(&self, linkage_type: Option<LinkageType>) -> InputRange {
        let Some(linkage_type) = linkage_type else { return InputRange::None };
        let (g, a, b, c) = (self.ground(), self.crank(), self.coupler(), self.follower());
        let (near, far) = ((b - c).abs(), b + c);
        let slack = CHANGE_POINT_TOLERANCE * self.longest_link();
        let (limited_near, limited_far) = match linkage_type {
            t if t.input_turns_fully() => (false, false),
            LinkageType::RockerCrank | LinkageType::DoubleRocker => (true, true),
            // Of a triple-rocker exactly one limit lies inside; of a change point those beyond the tolerance.
            _ => (near - (g - a).abs() > slack, (g + a) - far > slack),
        };
        let low = if limited_near { self.crank_from_ground(near) } else { 0.0 };
        let high = if limited_far { self.crank_from_ground(far) } else { PI };
        let ground = self.ground_angle();
        match (limited_near, limited_far) {
            (false, false) => InputRange::Full,
            (false, true) => InputRange::One(InputArc { middle: ground, half_width: high }),
            (true, false) => InputRange::One(InputArc { middle: ground + PI, half_width: PI - low }),
            (true, true) => {
                let (middle, half_width) = (0.5 * (low + high), 0.5 * (high - low));
                InputRange::Two([
                    InputArc { middle: ground + middle, half_width },
                    InputArc { middle: ground - middle, half_width },
                ])
            }
        }
    }
}

impl Mobility {
    /// Returns whether the input turns fully.
    pub fn input_turns_fully(&self) -> bool {
        self.input == InputRange::Full
    }

    /// Returns the number of circuits of the linkage.
    pub fn circuits(&self) -> u8 {
        self.input.circuits(self.is_change_point())
    }

    /// Returns the number of branches of each circuit.
    pub fn branches_per_circuit(&self) -> u8 {
        self.input.branches_per_circuit(self.is_change_point())
    }

    /// Returns the arc on which a circuit's input moves; `None` if it turns fully or cannot move.
    pub fn arc(&self, circuit: Circuit) -> Option<InputArc> {
        self.input.arc(circuit)
    }

    /// Returns the branch of a position that closes the loop.
    pub fn branch(&self, crank_angle: f64, assembly: AssemblyMode) -> Branch {
        self.input.branch(self.is_change_point(), crank_angle, assembly)
    }

    /// Returns the toggles, at each of which two branches of a circuit meet; none if the input turns fully.
    pub fn toggles(&self) -> Vec<Toggle> {
        self.input.toggles()
    }

    fn is_change_point(&self) -> bool {
        self.linkage_type == Some(LinkageType::ChangePoint)
    }
}
