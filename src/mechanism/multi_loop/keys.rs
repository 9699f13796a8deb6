//! The keys of `[chain]` in linkage files and under `chain` in records: pivots, the crank, dyads, and points on links.
//!
//! A linkage is read from any chain of a crank and two or three dyads whose points lie on its links, whatever the names and the
//! order, and written with the names of [`joints`](super::joints), every number to the digit.

use super::joints::{CRANK_PIN, NamedJoint, end_name, joint_name};
use super::{LinkPair, MultiLoop};
use crate::mechanism::chain::{Attachment, Stage};
use crate::mechanism::dyad_chain::kinds::{CRANK, DyadChainKind, GROUND, MAX_DYADS};
use crate::mechanism::{AssemblyMode, Chain, Complex, LinkageError, point, xy};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The keys of `[chain]`: fixed pivots, a driven crank, dyads and points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ChainKeys")]
pub struct ChainKeys {
    /// The name of the point whose path is drawn.
    pub trace: String,
    /// Fixed pivots: a name and a point each.
    pub pivots: BTreeMap<String, [f64; 2]>,
    /// The driven crank.
    pub crank: CrankKeys,
    /// Two links that meet in a new joint, each.
    pub dyad: Vec<DyadKeys>,
    /// Points on links.
    #[serde(default)]
    pub point: Vec<PointKeys>,
}

/// The driven crank.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrankKeys {
    /// The name of its fixed pivot.
    pub pivot: String,
    /// The name of the joint that it carries.
    pub joint: String,
    /// From pivot to joint.
    pub length: f64,
}

/// Two links from two points to a new joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DyadKeys {
    /// The name of the new joint.
    pub joint: String,
    /// The two points that it hangs on.
    pub from: [String; 2],
    /// The two links.
    pub lengths: [f64; 2],
    /// 1: the joint lies left of the line from the first point to the second; -1: right.
    #[schemars(with = "i64")]
    pub side: AssemblyMode,
}

/// A point on a link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointKeys {
    /// The name of the new point.
    pub name: String,
    /// Two points of the link.
    pub on: [String; 2],
    /// Along the line from the first point to the second, and to its left, from the first point.
    pub at: [f64; 2],
}

/// A stage of a chain, which makes one point.
#[derive(Clone, Debug, PartialEq)]
pub enum StageKeys {
    /// Two links that meet in a new joint.
    Dyad(DyadKeys),
    /// A point on a link.
    Point(PointKeys),
}

/// The reason why a chain is no six-bar or eight-bar.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoMultiLoop {
    /// A number of dyads that is neither two nor three.
    #[error("a six-bar has two dyads and an eight-bar three; this chain has {0}")]
    Dyads(usize),
    /// The first dyad does not hang on the crank's joint and a fixed pivot.
    #[error("the first dyad of a six-bar hangs on the crank's joint and a fixed pivot")]
    FirstDyad,
    /// A stage of another kind.
    #[error("the stage of `{0}` is no dyad and no point on a link by its place `at`")]
    Stage(String),
    /// A name that is not that of a point made before, or on one link.
    #[error("`{0}` hangs on points that are not known, or lie on no one link")]
    Unknown(String),
    /// The traced point lies on the ground or the crank.
    #[error("the traced point `{0}` lies on no link of a dyad")]
    Traced(String),
    /// The crank does not turn fully.
    #[error("its crank does not turn fully, and six-bars are driven by a motor")]
    Turn,
    /// The values are those of no linkage.
    #[error(transparent)]
    Linkage(#[from] LinkageError),
}

/// The bodies that carry a point, with its place on each.
type Places = Vec<(usize, Complex)>;

impl MultiLoop {
    /// Returns the stages of its chain in the order of assembly: each hangs on points that are made before it.
    pub fn stages(&self) -> Vec<StageKeys> {
        let made = |joint: &NamedJoint| joint.body != GROUND && joint.name != CRANK_PIN;
        let stage = |joint: NamedJoint| {
            let name = joint.name.to_owned();
            let Some(dyad) = (0..self.dyad_count()).find(|dyad| joint_name(*dyad) == joint.name) else {
                return StageKeys::Point(PointKeys { name, on: line_of(joint.body), at: xy(joint.at) });
            };
            let LinkPair { lengths, side, .. } = self.dyads[dyad];
            let from = [0, 1].map(|end| end_name(dyad, end).to_owned());
            StageKeys::Dyad(DyadKeys { joint: name, from, lengths, side })
        };
        self.joints().into_iter().filter(made).map(stage).collect()
    }

    /// Returns the keys of its chain.
    pub fn keys(&self) -> ChainKeys {
        let fixed = self.joints().into_iter().filter(|joint| joint.body == GROUND);
        let mut keys = ChainKeys {
            trace: "P".into(),
            pivots: fixed.map(|joint| (joint.name.to_owned(), xy(joint.at))).collect(),
            crank: CrankKeys { pivot: "A".into(), joint: CRANK_PIN.into(), length: self.crank },
            dyad: Vec::new(),
            point: Vec::new(),
        };
        for stage in self.stages() {
            match stage {
                StageKeys::Dyad(dyad) => keys.dyad.push(dyad),
                StageKeys::Point(point) => keys.point.push(point),
            }
        }
        keys
    }

    /// Reads a linkage from the keys of its chain.
    ///
    /// # Errors
    /// [`NoMultiLoop`] if it is no six-bar or eight-bar whose crank turns fully.
    pub fn from_keys(keys: &ChainKeys) -> Result<Self, NoMultiLoop> {
        if !(2..=MAX_DYADS).contains(&keys.dyad.len()) {
            return Err(NoMultiLoop::Dyads(keys.dyad.len()));
        }
        let mut known: BTreeMap<&str, Places> = BTreeMap::new();
        for (name, at) in &keys.pivots {
            known.insert(name, vec![(GROUND, point(*at))]);
        }
        let zero = Complex::new(0.0, 0.0);
        let crank = &keys.crank;
        let pivot = known.get_mut(crank.pivot.as_str());
        let Some(places) = pivot else { return Err(NoMultiLoop::Unknown(crank.joint.clone())) };
        let crank_pivot = places[0].1;
        places.push((CRANK, zero));
        known.insert(&crank.joint, vec![(CRANK, zero + crank.length)]);
        let (mut dyads, mut anchors) = (Vec::<LinkPair>::new(), Vec::<[usize; 2]>::new());
        let (mut left_dyads, mut left_points): (Vec<&DyadKeys>, Vec<&PointKeys>) =
            (keys.dyad.iter().collect(), keys.point.iter().collect());
        // Whatever the order of the stages, each is placed as soon as the points that it hangs on are known.
        while !left_dyads.is_empty() || !left_points.is_empty() {
            let of_point = left_points.iter().position(|p| on_one_body(&known, &p.on).is_some());
            if let Some(i) = of_point {
                let made = left_points.remove(i);
                if let Some((body, [p, q])) = on_one_body(&known, &made.on) {
                    let along = (q - p) / (q - p).norm();
                    known.insert(&made.name, vec![(body, p + along * point(made.at))]);
                }
                continue;
            }
            let is_known = |d: &&DyadKeys| d.from.iter().all(|name| known.contains_key(name.as_str()));
            let Some(i) = left_dyads.iter().position(is_known) else {
                let name = left_dyads.first().map(|d| &d.joint).or(left_points.first().map(|p| &p.name));
                return Err(NoMultiLoop::Unknown(name.cloned().unwrap_or_default()));
            };
            let made = left_dyads.remove(i);
            let mut made = made.clone();
            if dyads.is_empty() {
                if made.from[1] == crank.joint {
                    made.from.swap(0, 1);
                    made.lengths.swap(0, 1);
                    made.side = made.side.opposite();
                }
                let is_pivot = known.get(made.from[1].as_str()).is_some_and(|at| at[0].0 == GROUND);
                if made.from[0] != crank.joint || !is_pivot {
                    return Err(NoMultiLoop::FirstDyad);
                }
            }
            let ends = [0, 1].map(|end| known[made.from[end].as_str()][0]);
            let first = 2 + 2 * dyads.len();
            for end in 0..2 {
                if let Some(places) = known.get_mut(made.from[end].as_str()) {
                    places.push((first + end, zero));
                }
            }
            let name = keys.dyad.iter().find(|d| d.joint == made.joint).map_or("", |d| d.joint.as_str());
            known.insert(name, vec![(first, zero + made.lengths[0]), (first + 1, zero + made.lengths[1])]);
            anchors.push(ends.map(|(body, _)| body));
            dyads.push(LinkPair { ends: ends.map(|(_, at)| at), lengths: made.lengths, side: made.side });
        }
        let traced = known.get(keys.trace.as_str()).and_then(|at| at.iter().find(|(body, _)| *body > CRANK));
        let Some(&(body, at)) = traced else { return Err(NoMultiLoop::Traced(keys.trace.clone())) };
        let kind = DyadChainKind::of(&anchors, body);
        let linkage = MultiLoop::new(kind, (crank_pivot, crank.length), &dyads, at)?;
        if linkage.full_turn_margin() > 0.0 { Ok(linkage) } else { Err(NoMultiLoop::Turn) }
    }

    /// Returns the six-bar or eight-bar that a general chain is.
    ///
    /// # Errors
    /// As [`MultiLoop::from_keys`].
    pub fn from_chain(chain: &Chain) -> Result<Self, NoMultiLoop> {
        let parts = chain.source();
        let (mut dyad, mut points) = (Vec::new(), Vec::new());
        for stage in &parts.stages {
            match stage {
                Stage::Dyad { joint, from, lengths, side } => dyad.push(DyadKeys {
                    joint: joint.clone(),
                    from: from.clone(),
                    lengths: *lengths,
                    side: *side,
                }),
                Stage::Point { name, on, at: Attachment::Offset(at) } => {
                    points.push(PointKeys { name: name.clone(), on: on.clone(), at: *at });
                }
                other => return Err(NoMultiLoop::Stage(other.joint().to_owned())),
            }
        }
        let last = || parts.stages.last().map_or(String::new(), |stage| stage.joint().to_owned());
        MultiLoop::from_keys(&ChainKeys {
            trace: parts.trace.clone().unwrap_or_else(last),
            pivots: parts.pivots.iter().cloned().collect(),
            crank: CrankKeys {
                pivot: parts.crank_pivot.clone(),
                joint: parts.crank_joint.clone(),
                length: parts.crank,
            },
            dyad,
            point: points,
        })
    }
}

/// Returns the names of the two joints of a moving body's line.
fn line_of(body: usize) -> [String; 2] {
    match body {
        CRANK => ["A".into(), CRANK_PIN.into()],
        link => {
            let (dyad, end) = ((link - 2) / 2, (link - 2) % 2);
            [end_name(dyad, end).into(), joint_name(dyad).into()]
        }
    }
}

/// Returns a moving body that carries two different points, with their places on it.
fn on_one_body(known: &BTreeMap<&str, Places>, on: &[String; 2]) -> Option<(usize, [Complex; 2])> {
    let [p, q] = [known.get(on[0].as_str())?, known.get(on[1].as_str())?];
    p.iter().filter(|(body, _)| *body != GROUND).find_map(|(body, at)| {
        let (_, other) = q.iter().find(|(of, _)| of == body)?;
        (at != other).then_some((*body, [*at, *other]))
    })
}
