//! JSON Schemas of the files that are read, made from the types that read them.

mod reference;

pub use reference::reference;

use crate::linkage_file::RawLinkageFile;
use crate::problem_file::RawProblem;

/// A kind of file that has a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SchemaKind {
    /// Problem files.
    Problem,
    /// Linkage files.
    Linkage,
}

impl SchemaKind {
    /// Every kind.
    pub const ALL: [SchemaKind; 2] = [SchemaKind::Problem, SchemaKind::Linkage];

    /// `problem` or `linkage`.
    pub fn name(self) -> &'static str {
        match self {
            SchemaKind::Problem => "problem",
            SchemaKind::Linkage => "linkage",
        }
    }
}

impl std::str::FromStr for SchemaKind {
    type Err = UnknownKind;
    fn from_str(text: &str) -> Result<Self, UnknownKind> {
        SchemaKind::ALL.into_iter().find(|k| k.name() == text).ok_or_else(|| UnknownKind(text.to_owned()))
    }
}

/// A word that names no kind of file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no schema of {0:?}: the kinds are problem and linkage")]
pub struct UnknownKind(pub String);

/// The JSON Schema (draft 2020-12) of a kind of file.
///
/// ```
/// use linkwright::schema::{SchemaKind, schema};
/// assert!(schema(SchemaKind::Problem)["properties"]["design"].is_object());
/// ```
pub fn schema(kind: SchemaKind) -> serde_json::Value {
    match kind {
        SchemaKind::Problem => schemars::schema_for!(RawProblem),
        SchemaKind::Linkage => schemars::schema_for!(RawLinkageFile),
    }
    .to_value()
}
