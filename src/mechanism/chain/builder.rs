//! Builder of a chain from its parts, which are referred to by name.

use super::assembly::Assembly;
use super::{Attachment, Chain, ChainError, SliderLine, Stage};
use crate::mechanism::{AssemblyMode, CouplerSide};

/// Maximum number of stages of a chain.
pub const MAX_STAGES: usize = 1000;

/// Maximum number of characters of a point's name.
pub const MAX_POINT_NAME: usize = 16;

/// The parts of a chain in the order in which they are assembled; nothing is checked before [`ChainBuilder::build`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChainBuilder {
    /// Fixed points with their names.
    pub pivots: Vec<(String, [f64; 2])>,
    /// Name of the crank's fixed pivot.
    pub crank_pivot: String,
    /// Name of the crank's moving joint.
    pub crank_joint: String,
    /// |AC|, the length of the crank.
    pub crank: f64,
    /// The stages that follow the crank.
    pub stages: Vec<Stage>,
    /// Name of the traced point; `None` for the last point that is made.
    pub trace: Option<String>,
}

impl ChainBuilder {
    /// Returns a builder without parts.
    pub fn new() -> Self {
        ChainBuilder::default()
    }

    /// Adds a fixed pivot.
    #[must_use]
    pub fn pivot(mut self, name: &str, at: [f64; 2]) -> Self {
        self.pivots.push((name.into(), at));
        self
    }

    /// Sets the driven crank: it turns about a fixed pivot and carries `joint` at the distance `length`.
    #[must_use]
    pub fn crank(mut self, pivot: &str, joint: &str, length: f64) -> Self {
        (self.crank_pivot, self.crank_joint, self.crank) = (pivot.into(), joint.into(), length);
        self
    }

    /// Adds a stage of any kind.
    #[must_use]
    pub fn stage(mut self, stage: Stage) -> Self {
        self.stages.push(stage);
        self
    }

    /// Adds a dyad, two links of the given lengths from two points to a new joint: [`Stage::Dyad`].
    #[must_use]
    pub fn dyad(self, joint: &str, from: [&str; 2], lengths: [f64; 2], side: AssemblyMode) -> Self {
        self.stage(Stage::Dyad { joint: joint.into(), from: from.map(Into::into), lengths, side })
    }

    /// Adds a point on a link, along and across the line between two of its points: [`Stage::Point`].
    #[must_use]
    pub fn point(self, name: &str, on: [&str; 2], offset: [f64; 2]) -> Self {
        let at = Attachment::Offset(offset);
        self.stage(Stage::Point { name: name.into(), on: on.map(Into::into), at })
    }

    /// Adds a point on a link by its distances from two of the link's points: [`Stage::Point`].
    #[must_use]
    pub fn point_at_distances(
        self,
        name: &str,
        on: [&str; 2],
        distances: [f64; 2],
        side: CouplerSide,
    ) -> Self {
        let at = Attachment::Distances(distances, side);
        self.stage(Stage::Point { name: name.into(), on: on.map(Into::into), at })
    }

    /// Adds a link whose end slides along the fixed line through `through` at `angle` (radians from the x axis):
    /// [`Stage::Slider`].
    #[must_use]
    pub fn slider(
        self,
        joint: &str,
        from: &str,
        length: f64,
        through: [f64; 2],
        angle: f64,
        side: AssemblyMode,
    ) -> Self {
        let line = SliderLine::Fixed { through, angle };
        self.stage(Stage::Slider { joint: joint.into(), from: from.into(), length, line, side })
    }

    /// Adds a link that turns about `pivot` while the block `block` slides along it, carrying a joint at `at` along and
    /// across it: [`Stage::Guide`], the block ahead of the pivot and on the line through it.
    #[must_use]
    pub fn guide(self, joint: &str, pivot: &str, block: &str, at: [f64; 2]) -> Self {
        self.stage(Stage::Guide {
            joint: joint.into(),
            pivot: pivot.into(),
            block: block.into(),
            at,
            offset: 0.0,
            side: AssemblyMode::Plus,
        })
    }

    /// Sets the traced point, the one whose path is shown.
    #[must_use]
    pub fn trace(mut self, name: &str) -> Self {
        self.trace = Some(name.into());
        self
    }

    /// Builds the chain, with every name resolved.
    ///
    /// # Errors
    /// [`ChainError`], the first in the order of assembly, with the part, the key and the fault.
    pub fn build(self) -> Result<Chain, Box<ChainError>> {
        Assembly::new(&self).finish().map(|parts| Chain { source: self, ..parts })
    }

    /// Returns the name of every point in the order of assembly.
    pub(super) fn all_names(&self) -> Vec<String> {
        let pivots = self.pivots.iter().map(|(name, _)| name.as_str());
        let crank = std::iter::once(self.crank_joint.as_str());
        pivots.chain(crank).chain(self.stages.iter().map(Stage::joint)).map(Into::into).collect()
    }
}
