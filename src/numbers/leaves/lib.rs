//! The branch-and-bound trees as a file: the proof behind a certificate, for a checker with arithmetic of its own.
//!
//! ```text
//! 0    8  "lwleaves"
//! 8    4  1: the version of the format            numbers are little-endian
//! 12   4  the number of parts
//! then, a part: 1 class (0 crank-rocker, 1 double-crank), 1 direction (1 or 255 for -1),
//!               1 crank angles (0 increments, 1 from the ground line, 2 from the x axis), 5 zeros,
//!               8 its lower bound (double), 8 the number of nodes,
//!               the nodes, half a byte each, the lower half first; 15 fills the last byte
//! at the end  32  SHA-256 of all before: `leaves_sha256` of the record
//! ```
//!
//! The nodes of a part are its tree, each before its two children: 4 to 7 is a box that is halved across p, phi, g or d
//! (the lower half comes first), 0 a box that is open, 1 to 3 a leaf: outside, cognate, bounded. The first box is the
//! whole chart ([`root`]). Halves meet in the middle of the two ends, rounded to single precision.

pub mod class;

pub use class::{Axis, Cell, Class, Lengths, Line};

use sha2::{Digest, Sha256};

/// The chart: p, phi_0, g, d. p ends at 1, the others a little beyond pi, pi and pi/2; all ends have few digits, so that halving is
/// exact.
pub const ROOT: Cell = Cell { low: [0.0, -3.15625, 0.0, -1.578125], high: [1.0, 3.15625, 3.15625, 1.578125] };

/// The reference direction of the crank angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Angles {
    /// None: the angles are increments.
    Increments,
    /// The ground line.
    Ground,
    /// The x axis.
    Axis(Axis),
}

impl Angles {
    /// Returns the number of the reference direction in a file of leaves.
    pub fn origin(&self) -> u8 {
        match self {
            Angles::Increments => 0,
            Angles::Ground => 1,
            Angles::Axis(_) => 2,
        }
    }
}

/// Returns the part of the chart with phi_0 in a range, rounded outwards to single precision.
pub fn root(phi: [f64; 2]) -> Cell {
    let mut root = ROOT;
    let [low, high] = phi.map(|end| end as f32);
    let low = if f64::from(low) > phi[0] { low.next_down() } else { low };
    let high = if f64::from(high) < phi[1] { high.next_up() } else { high };
    root.low[1] = f64::from(low).max(root.low[1]);
    root.high[1] = f64::from(high).min(root.high[1]);
    root
}

/// The largest file that is read.
pub const MAX_BYTES: u64 = 1 << 30;
/// The code of a box that is open.
pub const OPEN: u8 = 0;
/// The first of the four codes of a halved box.
pub const HALVED: u8 = 4;
const FILLER: u8 = 15;
const MAGIC: &[u8; 8] = b"lwleaves";
const VERSION: u32 = 1;
const MAX_PARTS: u32 = 4;
const SUM: usize = 32;

/// The reason for which a file holds no leaves.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LeavesError {
    /// The file does not begin as a file of leaves does.
    #[error("these are no leaves of a certificate: certify RESULT --leaves writes them")]
    Foreign,
    /// It is of another version.
    #[error(
        "the leaves are of format {found}, this program reads format {VERSION}: certify RESULT --leaves writes them anew"
    )]
    Version {
        /// The version found.
        found: u32,
    },
    /// Its checksum is wrong, or it ends too early or too late.
    #[error(
        "the leaves were changed or cut off after they were written: certify RESULT --leaves writes them anew"
    )]
    Changed,
    /// The tree does not cover the chart.
    #[error("the leaves of part {part} do not cover the chart: {what}")]
    Uncovered {
        /// Number of the part, from 1.
        part: usize,
        /// The fault.
        what: &'static str,
    },
}

/// The nodes of a tree, half a byte each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Nodes {
    bytes: Vec<u8>,
    count: u64,
}

impl Nodes {
    /// Appends a node.
    pub fn push(&mut self, code: u8) {
        if self.count.is_multiple_of(2) {
            self.bytes.push(code | FILLER << 4);
        } else if let Some(last) = self.bytes.last_mut() {
            *last = *last & 0x0f | code << 4;
        }
        self.count += 1;
    }

    /// Returns the number of nodes.
    pub fn len(&self) -> u64 {
        self.count
    }

    /// Returns whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the codes in order.
    pub fn codes(&self) -> impl Iterator<Item = u8> + '_ {
        let halves = self.bytes.iter().flat_map(|byte| [byte & 0x0f, byte >> 4]);
        halves.take(usize::try_from(self.count).unwrap_or(usize::MAX))
    }

    /// Returns the SHA-256 of the bytes.
    pub fn sha256(&self) -> [u8; 32] {
        Sha256::digest(&self.bytes).into()
    }

    /// Returns the nodes, half a byte each, the last byte filled up.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Reads `count` nodes from their bytes; `None` if these are not as many, or not filled up as they should be.
    pub fn from_bytes(bytes: &[u8], count: u64) -> Option<Self> {
        let whole = bytes.len() as u64 == count.div_ceil(2);
        let filled = count.is_multiple_of(2) || bytes.last().is_some_and(|last| last >> 4 == FILLER);
        (whole && filled).then(|| Nodes { bytes: bytes.to_vec(), count })
    }

    /// Checks that this is one whole tree of known codes: every halved box has both halves, and nothing is left over.
    ///
    /// # Errors
    /// The fault.
    pub fn covers(&self) -> Result<(), &'static str> {
        let mut missing = 1_u64;
        for code in self.codes() {
            match (missing, code) {
                (0, _) => return Err("there are more boxes than the tree has"),
                (_, HALVED..=7) => missing += 1,
                (_, 0..HALVED) => missing -= 1,
                _ => return Err("a box has no known rule"),
            }
        }
        if missing == 0 { Ok(()) } else { Err("boxes are missing") }
    }
}

/// The leaves of one class in one direction of the crank.
#[derive(Clone, Debug, PartialEq)]
pub struct LeavesPart {
    /// The class.
    pub class: Class,
    /// The direction of the crank, 1 or -1.
    pub direction: i8,
    /// The reference direction of the crank angles: 0, 1 or 2 as in the file.
    pub origin: u8,
    /// The lower bound: no linkage of the part has a sum of squares below it.
    pub lower_bound: f64,
    /// The tree.
    pub nodes: Nodes,
}

/// The leaves of a whole certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaves {
    /// The parts, in the order of the record.
    pub parts: Vec<LeavesPart>,
}

impl Leaves {
    fn body(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((self.parts.len() as u32).to_le_bytes());
        for part in &self.parts {
            bytes.extend([u8::from(part.class == Class::DoubleCrank), part.direction as u8]);
            bytes.push(part.origin);
            bytes.extend([0; 5]);
            bytes.extend(part.lower_bound.to_le_bytes());
            bytes.extend(part.nodes.len().to_le_bytes());
            bytes.extend(part.nodes.bytes());
        }
        bytes
    }

    /// Returns the bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = self.body();
        let sum: [u8; SUM] = Sha256::digest(&bytes).into();
        bytes.extend(sum);
        bytes
    }

    /// Returns the SHA-256 of the file without its last 32 bytes, which are this sum.
    pub fn sha256(&self) -> [u8; 32] {
        Sha256::digest(self.body()).into()
    }

    /// Reads the leaves of a file, each part a whole tree.
    ///
    /// # Errors
    /// [`LeavesError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, LeavesError> {
        let mut rest = bytes.strip_prefix(MAGIC).ok_or(LeavesError::Foreign)?;
        let version = u32::from_le_bytes(take(&mut rest)?);
        if version != VERSION {
            return Err(LeavesError::Version { found: version });
        }
        let (body, sum) =
            bytes.split_at_checked(bytes.len().wrapping_sub(SUM)).ok_or(LeavesError::Changed)?;
        if <[u8; SUM]>::from(Sha256::digest(body)) != sum {
            return Err(LeavesError::Changed);
        }
        let mut rest = rest.strip_suffix(sum).ok_or(LeavesError::Changed)?;
        let count = u32::from_le_bytes(take(&mut rest)?);
        if count > MAX_PARTS {
            return Err(LeavesError::Changed);
        }
        let mut parts = Vec::new();
        for number in 1..=count as usize {
            let [class, direction, origin, zeros @ ..] = take::<8>(&mut rest)?;
            let class = match (class, direction, origin, zeros) {
                (0, 1 | 255, 0..=2, [0, 0, 0, 0, 0]) => Class::CrankRocker,
                (1, 1 | 255, 0..=2, [0, 0, 0, 0, 0]) => Class::DoubleCrank,
                _ => return Err(LeavesError::Changed),
            };
            let lower_bound = f64::from_le_bytes(take(&mut rest)?);
            let count = u64::from_le_bytes(take(&mut rest)?);
            let length = usize::try_from(count.div_ceil(2)).map_err(|_| LeavesError::Changed)?;
            let (own, others) = rest.split_at_checked(length).ok_or(LeavesError::Changed)?;
            rest = others;
            let nodes = Nodes::from_bytes(own, count).ok_or(LeavesError::Changed)?;
            nodes.covers().map_err(|what| LeavesError::Uncovered { part: number, what })?;
            parts.push(LeavesPart { class, direction: direction as i8, origin, lower_bound, nodes });
        }
        if rest.is_empty() { Ok(Leaves { parts }) } else { Err(LeavesError::Changed) }
    }
}

/// Takes the next N bytes; `None` if there are fewer.
pub fn next<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (first, others) = rest.split_first_chunk::<N>()?;
    *rest = others;
    Some(*first)
}

fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], LeavesError> {
    next(rest).ok_or(LeavesError::Changed)
}
