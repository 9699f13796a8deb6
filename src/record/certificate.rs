//! What is proved about a result: no linkage of the covered kind can have a lower sum of squares.

use serde::{Deserialize, Serialize};

/// A lower bound of the sum of squares with what it covers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Certificate {
    /// What is proved, in one sentence.
    pub statement: String,
    /// No covered linkage has a sum of squares below it.
    pub lower_bound: f64,
    /// 1 - lower bound/best candidate, at least 0.
    pub gap: f64,
    /// Whether the wanted gap was reached everywhere: no box is open.
    pub closed: bool,
    /// Boxes looked at.
    pub boxes: u64,
    /// What the bound holds for.
    pub covered: Vec<String>,
    /// What it says nothing about.
    pub not_covered: Vec<String>,
    /// SHA-256 of the file of leaves without its last 32 bytes.
    pub leaves_sha256: String,
    /// The gap that was asked for.
    pub wanted_gap: f64,
    /// Each class in each direction.
    pub parts: Vec<CertificatePart>,
}

/// A figure of a certificate that two of them say differently.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The key.
    pub what: String,
    /// What this one says.
    pub own: String,
    /// What the other says.
    pub other: String,
}

impl Certificate {
    /// Where another certificate says something else, in the order of the keys.
    pub fn differences(&self, other: &Certificate) -> Vec<Difference> {
        let said = |c: &Certificate| {
            let mut said = vec![
                ("statement".to_owned(), c.statement.clone()),
                ("lower_bound".to_owned(), format!("{:e}", c.lower_bound)),
                ("gap".to_owned(), format!("{:e}", c.gap)),
                ("closed".to_owned(), c.closed.to_string()),
                ("boxes".to_owned(), c.boxes.to_string()),
                ("covered".to_owned(), c.covered.join("; ")),
                ("not_covered".to_owned(), c.not_covered.join("; ")),
                ("leaves_sha256".to_owned(), c.leaves_sha256.clone()),
                ("wanted_gap".to_owned(), format!("{:e}", c.wanted_gap)),
                ("parts".to_owned(), c.parts.len().to_string()),
            ];
            let parts = c.parts.iter().enumerate();
            said.extend(parts.map(|(i, part)| (format!("parts {}", i + 1), format!("{part:?}"))));
            said
        };
        let pairs = said(self).into_iter().zip(said(other));
        let differing = pairs.filter(|(own, other)| own != other);
        differing.map(|((what, own), (_, other))| Difference { what, own, other }).collect()
    }
}

/// One class in one direction of the crank.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CertificatePart {
    /// crank-rocker or double-crank.
    #[serde(rename = "type")]
    pub linkage_type: String,
    /// 1: the crank turns with the prescribed increments; -1: against them.
    pub direction: i8,
    /// The part's bound.
    pub lower_bound: f64,
    /// Whether it was reached everywhere.
    pub closed: bool,
    /// Boxes looked at.
    pub boxes: u64,
    /// SHA-256 of the part's nodes as the file packs them.
    pub leaves_sha256: String,
}
