//! The kinds of tasks, with their words.

/// The kind of a task: what its targets are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TaskKind {
    /// Points that a path is to pass.
    Path,
    /// Poses that a body is to pass.
    Motion,
    /// Pairs of an input angle of the crank and the output angle that the follower is to have there.
    Function,
}

impl TaskKind {
    /// Returns its name: `path`, `motion` or `function`.
    pub const fn name(self) -> &'static str {
        match self {
            TaskKind::Path => "path",
            TaskKind::Motion => "motion",
            TaskKind::Function => "function",
        }
    }

    /// Returns the name of its table in a file: `task.path`, `task.motion` or `task.function`.
    pub const fn table(self) -> &'static str {
        match self {
            TaskKind::Path => "task.path",
            TaskKind::Motion => "task.motion",
            TaskKind::Function => "task.function",
        }
    }

    /// Returns the word for one of its targets: `point`, `pose` or `pair`.
    pub const fn noun(self) -> &'static str {
        match self {
            TaskKind::Path => "point",
            TaskKind::Motion => "pose",
            TaskKind::Function => "pair",
        }
    }

    /// Returns the key of the list of its targets in a file: `task.path.points`, `task.motion.poses` or
    /// `task.function.output_deg`.
    pub const fn list_key(self) -> &'static str {
        match self {
            TaskKind::Path => "task.path.points",
            TaskKind::Motion => "task.motion.poses",
            TaskKind::Function => "task.function.output_deg",
        }
    }
}
