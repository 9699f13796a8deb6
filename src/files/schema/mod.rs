//! JSON Schemas of the files that are read and of the record that is written, generated from the types that read and
//! write them.

mod reference;

pub use reference::reference;

use crate::files::linkage_file::RawLinkageFile;
use crate::files::problem_file::RawProblem;
use crate::files::sweep_file::RawSweep;
use crate::record::Record;

/// A kind of file that has a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SchemaKind {
    /// Problem files.
    Problem,
    /// Linkage files.
    Linkage,
    /// Records: `record.json` of a result.
    Record,
    /// Sweep files.
    Sweep,
}

impl SchemaKind {
    /// Every kind.
    pub const ALL: [SchemaKind; 4] =
        [SchemaKind::Problem, SchemaKind::Linkage, SchemaKind::Record, SchemaKind::Sweep];

    /// Returns the name of the kind: `problem`, `linkage`, `record` or `sweep`.
    pub fn name(self) -> &'static str {
        match self {
            SchemaKind::Problem => "problem",
            SchemaKind::Linkage => "linkage",
            SchemaKind::Record => "record",
            SchemaKind::Sweep => "sweep",
        }
    }
}

impl std::str::FromStr for SchemaKind {
    type Err = UnknownKind;
    fn from_str(text: &str) -> Result<Self, UnknownKind> {
        SchemaKind::ALL.into_iter().find(|k| k.name() == text).ok_or_else(|| UnknownKind(text.to_owned()))
    }
}

/// The error that a word does not name a kind of file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no schema of {0:?}: the kinds are problem, linkage, record and sweep")]
pub struct UnknownKind(pub String);

/// Returns the JSON Schema (draft 2020-12) of a kind of file.
///
/// ```
/// use linkwright::internals::files::schema::{SchemaKind, schema};
/// assert!(schema(SchemaKind::Problem)["properties"]["design"].is_object());
/// ```
pub fn schema(kind: SchemaKind) -> serde_json::Value {
    match kind {
        SchemaKind::Problem => schemars::schema_for!(RawProblem),
        SchemaKind::Linkage => schemars::schema_for!(RawLinkageFile),
        SchemaKind::Record => schemars::schema_for!(Record),
        SchemaKind::Sweep => schemars::schema_for!(RawSweep),
    }
    .to_value()
}
