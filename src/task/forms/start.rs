//! The start of a local search: a design vector with its discrete choices and the points' positions.

use crate::mechanism::Complex;
use crate::task::Setting;
use crate::task::forms::design_space::Design;
use crate::task::forms::torus::Positions;
use crate::task::ranges::Scales;
use serde::{Deserialize, Serialize};

/// The scales of ranges that are as they are written.
pub const AS_WRITTEN: Scales = [1.0; 2];

/// A start for a local search.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "WrittenStart", into = "WrittenStart")]
pub struct Start {
    /// The design vector, inside its bounds.
    pub design: Design,
    /// The discrete choices: type aimed at, assembly, direction and side.
    pub setting: Setting,
    /// The points' positions; empty for prescribed timing.
    pub positions: Positions,
    /// The scales of a function's inputs and outputs; 1 unless their range is free.
    pub scales: Scales,
}

/// The serialised form of a start: for each position the real and imaginary parts of both directions.
#[derive(Serialize, Deserialize)]
struct WrittenStart {
    design: Design,
    setting: Setting,
    positions: Vec<[f64; 4]>,
    #[serde(default = "as_written", skip_serializing_if = "is_as_written")]
    scales: Scales,
}

fn as_written() -> Scales {
    AS_WRITTEN
}

fn is_as_written(scales: &Scales) -> bool {
    *scales == AS_WRITTEN
}

impl From<Start> for WrittenStart {
    fn from(Start { design, setting, positions, scales }: Start) -> Self {
        let positions = positions.iter().map(|[e, u]| [e.re, e.im, u.re, u.im]).collect();
        WrittenStart { design, setting, positions, scales }
    }
}

impl From<WrittenStart> for Start {
    fn from(WrittenStart { design, setting, positions, scales }: WrittenStart) -> Self {
        let position = |[a, b, c, d]: [f64; 4]| [Complex::new(a, b), Complex::new(c, d)];
        Start { design, setting, positions: positions.into_iter().map(position).collect(), scales }
    }
}
