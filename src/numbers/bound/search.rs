//! Best-first branch and bound over the chart.
//!
//! Boxes wait in the order of their bounds. A batch of the lowest is taken, each is halved across the axis that costs
//! its bound most, and the halves are bounded on all cores; a half that is decided is a leaf, one that is not waits
//! again. The lowest bound that waits is at any time a bound of the whole. Batches are of one size whatever the
//! number of threads, and their results are taken in order: the same boxes, the same digits.

use super::absolute;
use super::bound::{Bound, bound};
use super::halving::{centre, split};
use super::target::{Target, TargetError};
use linkwright_leaves::{Angles, Axis, Cell, Class, HALVED, Nodes, OPEN, ROOT, root};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The number of boxes in a batch.
const BATCH: usize = 2048;
/// The largest number of boxes that wait: about a gigabyte.
pub const MAX_WAITING: usize = 20_000_000;
/// The largest number of boxes of a tree: about a gigabyte.
pub const MAX_BOXES: usize = 250_000_000;

/// The problem for one class and one direction of the crank, ready to be bounded.
#[derive(Clone, Debug)]
pub struct Question {
    class: Class,
    whole: Target,
    /// The targets of all points but one.
    fewer: Vec<Option<Target>>,
    turns: Vec<f64>,
    /// The largest |Z| of the linkages that are covered.
    cap: f64,
    /// The reference direction of the crank angles.
    angles: Angles,
}

/// The rule by which a box is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaf {
    /// No linkage is in the box: |d| > min(g, pi - g), or no length of the crank fits.
    Outside = 1,
    /// The linkages of the box have cognates in the other half.
    Cognate = 2,
    /// The bound of the box reaches the wanted sum of squares.
    Bounded = 3,
}

/// The result for a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The box is decided.
    Leaf(Leaf),
    /// The box is not decided; its bound.
    Open(Bound),
}

impl Question {
    /// Creates the question for a class and a direction (+1 or -1), for points with increments of the crank in
    /// degrees.
    ///
    /// # Errors
    /// [`TargetError`].
    pub fn new(
        class: Class,
        direction: f64,
        points: &[[f64; 2]],
        turns_deg: &[f64],
        cap: f64,
    ) -> Result<Self, TargetError> {
        let (whole, fewer) =
            targets(points, turns_deg, |points, turns| Target::new(points, turns, direction))?;
        if fewer.iter().any(Option::is_none) {
            return Err(TargetError::Degenerate);
        }
        let turns = turns_deg.iter().map(|deg| direction.signum() * deg.to_radians()).collect();
        Ok(Question { class, whole, fewer, turns, cap, angles: Angles::Increments })
    }

    /// Creates the question for a class, for points with crank angles from the x axis.
    ///
    /// # Errors
    /// [`TargetError`].
    pub fn from_axis(
        class: Class,
        points: &[[f64; 2]],
        angles_deg: &[f64],
        cap: f64,
        axis: Axis,
    ) -> Result<Self, TargetError> {
        let (whole, fewer) =
            targets(points, angles_deg, |points, angles| Target::on_axis(points, angles, &axis))?;
        let line = axis.angle_deg().unwrap_or_default();
        let turns = angles_deg.iter().map(|deg| (deg - line).to_radians()).collect();
        Ok(Question { class, whole, fewer, turns, cap, angles: Angles::Axis(axis) })
    }

    /// Returns the same question with the angles from the ground line: phi_0 = 0.
    #[must_use]
    pub fn from_ground(mut self) -> Self {
        self.angles = Angles::Ground;
        self
    }

    /// Returns the part of the chart that is covered.
    fn part(&self) -> Cell {
        match self.angles {
            Angles::Increments => ROOT,
            Angles::Ground => root([0.0; 2]),
            Angles::Axis(axis) => root(axis.phi),
        }
    }

    fn bound(&self, target: &Target, cell: &Cell, wanted: f64) -> Bound {
        match &self.angles {
            Angles::Axis(axis) => {
                // With any complex K there is no larger least sum.
                let any = bound(target, self.class, cell, self.cap, wanted);
                if any.sum_sq >= wanted {
                    return any;
                }
                let real = absolute::bound(target, self.class, cell, &axis.lengths, self.cap, wanted);
                if real.sum_sq > any.sum_sq { real } else { any }
            }
            _ => bound(target, self.class, cell, self.cap, wanted),
        }
    }

    /// Decides a box, or bounds it.
    pub fn look(&self, cell: &Cell, wanted: f64) -> Outcome {
        if outside(cell) {
            return Outcome::Leaf(Leaf::Outside);
        }
        match &self.angles {
            // The cognate has another A and a K that is not real.
            Angles::Axis(axis) if absolute::exclude(&axis.lengths, self.class, cell) => {
                return Outcome::Leaf(Leaf::Outside);
            }
            Angles::Increments | Angles::Ground if in_cognate_half(cell) => {
                return Outcome::Leaf(Leaf::Cognate);
            }
            _ => {}
        }
        let mut best = self.bound(&self.whole, cell, wanted);
        if best.sum_sq < wanted && cell.high[0] > 0.5 {
            // The crank pin may be near B at one point: that point is left out.
            if let Some(fewer) = self.near(cell).and_then(|j| self.fewer[j].as_ref()) {
                let other = self.bound(fewer, cell, wanted);
                if other.sum_sq > best.sum_sq {
                    best.sum_sq = other.sum_sq;
                }
                best.weight = other.weight;
            }
        }
        if best.sum_sq >= wanted { Outcome::Leaf(Leaf::Bounded) } else { Outcome::Open(best) }
    }

    /// Returns the index of the point whose crank pin comes nearest to B, if it comes near in comparison with the
    /// box.
    fn near(&self, cell: &Cell) -> Option<usize> {
        let (c, h) = centre(cell);
        let f = |turn: f64| ((c[1] + turn).cos() - c[0]).hypot((c[1] + turn).sin());
        let all = self.turns.iter().map(|&turn| f(turn)).enumerate();
        let (j, f) = all.min_by(|x, y| x.1.total_cmp(&y.1))?;
        (f < 4.0 * (h[0] + h[1])).then_some(j)
    }
}

/// Creates the target of all points, and those of all but one.
fn targets(
    points: &[[f64; 2]],
    turns_deg: &[f64],
    target: impl Fn(&[[f64; 2]], &[f64]) -> Result<Target, TargetError>,
) -> Result<(Target, Vec<Option<Target>>), TargetError> {
    if points.len() < 5 {
        return Err(TargetError::Points { points: points.len() });
    }
    let whole = target(points, turns_deg)?;
    let but = |j: usize| {
        let (mut points, mut turns) = (points.to_vec(), turns_deg.to_vec());
        points.remove(j);
        turns.remove(j);
        target(&points, &turns).ok()
    };
    Ok((whole, (0..points.len()).map(but).collect()))
}

/// Returns whether no point of the box has |d| <= min(g, pi - g).
pub fn outside(cell: &Cell) -> bool {
    let d = cell.low[3].max(-cell.high[3]).max(0.0);
    let above_pi = std::f64::consts::PI + 1e-5;
    d > cell.high[2] || d > above_pi - cell.low[2]
}

/// Returns whether |sin g sin d| < p cos d |cos g| on the whole box: b > c there, and the cognate has b < c.
pub fn in_cognate_half(cell: &Cell) -> bool {
    let (c, h) = centre(cell);
    let least = |x: f64, h: f64| (x.abs() - h).max(0.0);
    let sin = (c[2].sin().abs() + h[2]) * (c[3].sin().abs() + h[3]);
    let cos = least(c[2].cos(), h[2]) * least(c[3].cos(), h[3]);
    c[3].abs() + h[3] < 1.57 && sin + 1e-12 < cell.low[0] * cos
}

/// An undecided box that waits to be halved.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    sum_sq: f64,
    /// The number of the box in the order in which boxes were made.
    number: u32,
    /// The index of the box in the tree.
    node: u32,
    axis: u8,
    ends: Ends,
}

/// The lower and upper ends of a box in single precision; they have no more digits.
type Ends = [[f32; 4]; 2];

fn in_single(cell: &Cell) -> Ends {
    [cell.low, cell.high].map(|ends| ends.map(|end| end as f32))
}

fn in_double(ends: &Ends) -> Cell {
    let [low, high] = ends.map(|ends| ends.map(f64::from));
    Cell { low, high }
}

impl Waiting {
    fn new(cell: &Cell, bound: &Bound, parent: f64, number: u32) -> Self {
        let axis = (0..4).max_by(|&i, &j| bound.weight[i].total_cmp(&bound.weight[j])).unwrap_or(0);
        Waiting {
            sum_sq: bound.sum_sq.max(parent),
            number,
            node: number,
            axis: axis as u8,
            ends: in_single(cell),
        }
    }
}

/// The data that a stopped search keeps of a box that waits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenBox {
    /// The number of the box in the order in which boxes were made.
    pub number: u32,
    /// The lower bound of the box.
    pub sum_sq: f64,
    /// The axis to halve.
    pub axis: u8,
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Waiting {}
impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Waiting {
    /// Orders the boxes by the lowest bound first, then the oldest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.sum_sq.total_cmp(&self.sum_sq).then(other.number.cmp(&self.number))
    }
}

/// A best-first branch and bound that can be stopped and asked for its bound at any time.
#[derive(Clone, Debug)]
pub struct Search {
    question: Question,
    wanted: f64,
    heap: BinaryHeap<Waiting>,
    decided: f64,
    /// The codes of the boxes in the order in which they were made, two by two after the first: open, the rule of a
    /// leaf, or [`halved`].
    tree: Vec<u32>,
}

/// Returns the code of a box that is halved across an axis; the index of its first half in the tree is odd.
fn halved(first: u32, axis: u8) -> u32 {
    u32::from(HALVED) + (first / 2 * 4 + u32::from(axis))
}

/// Returns the index of the first half and the axis of a halved box; `None` for another box.
fn halves(node: u32) -> Option<(u32, u8)> {
    let code = node.checked_sub(u32::from(HALVED))?;
    Some((code / 4 * 2 + 1, (code % 4) as u8))
}

impl Search {
    /// Creates a search to decide whether every sum of squares is at least `wanted`.
    pub fn new(question: Question, wanted: f64) -> Self {
        let whole = question.part();
        let turn = if whole.low[1] < whole.high[1] { 2.0 } else { 0.0 };
        let none = Bound { sum_sq: 0.0, weight: [1.0, turn, 1.5, 1.2] };
        let heap = BinaryHeap::from([Waiting::new(&whole, &none, 0.0, 0)]);
        Search { question, wanted, heap, decided: 0.0, tree: vec![u32::from(OPEN)] }
    }

    /// Returns the lower bound certified by now: at most the sum of squares of every linkage of the question.
    pub fn lower_bound(&self) -> f64 {
        self.heap.peek().map_or(self.wanted, |lowest| lowest.sum_sq.min(self.wanted))
    }

    /// Returns whether every box is decided.
    pub fn closed(&self) -> bool {
        self.heap.is_empty()
    }

    /// Returns the number of boxes evaluated.
    pub fn boxes(&self) -> u64 {
        self.tree.len() as u64 - 1
    }

    /// Returns the share of the chart that is decided.
    pub fn decided(&self) -> f64 {
        self.decided
    }

    /// Returns whether no more boxes can wait: the search ends with the bound certified so far.
    pub fn full(&self) -> bool {
        self.heap.len() > MAX_WAITING || self.tree.len() > MAX_BOXES
    }

    /// Returns the tree so far, each box before its halves.
    pub fn nodes(&self) -> Nodes {
        self.walk(|_| ())
    }

    /// Returns the tree so far, each box before its halves; `open` is called with the index of each open box.
    fn walk(&self, mut open: impl FnMut(u32)) -> Nodes {
        let mut nodes = Nodes::default();
        let mut next = vec![0_u32];
        while let Some(at) = next.pop() {
            let node = self.tree.get(at as usize).copied().unwrap_or_default();
            match halves(node) {
                Some((first, axis)) => {
                    nodes.push(HALVED + axis);
                    next.extend([first + 1, first]);
                }
                None => {
                    nodes.push(node as u8);
                    if node == u32::from(OPEN) {
                        open(at);
                    }
                }
            }
        }
        nodes
    }

    /// Returns the tree so far, and the waiting boxes in the order of its open boxes.
    pub fn state(&self) -> (Nodes, Vec<OpenBox>) {
        let mut by_node: Vec<&Waiting> = self.heap.iter().collect();
        by_node.sort_unstable_by_key(|waiting| waiting.node);
        let mut open = Vec::with_capacity(by_node.len());
        let nodes = self.walk(|node| {
            let found = by_node.binary_search_by_key(&node, |waiting| waiting.node);
            if let Some(waiting) = found.ok().and_then(|at| by_node.get(at)) {
                open.push(OpenBox { number: waiting.number, sum_sq: waiting.sum_sq, axis: waiting.axis });
            }
        });
        (nodes, open)
    }

    /// Restores a search with the question of `like` from the state that [`Search::state`] returned; `None` if no
    /// search can be in that state.
    pub fn restored(like: &Search, nodes: &Nodes, open: &[OpenBox], decided: f64) -> Option<Self> {
        nodes.covers().ok()?;
        let count = usize::try_from(nodes.len()).ok().filter(|count| *count <= MAX_BOXES + 2 * BATCH)?;
        let mut numbers: Vec<u32> = open.iter().map(|waiting| waiting.number).collect();
        numbers.sort_unstable();
        let apart = numbers.windows(2).all(|pair| pair[0] < pair[1]);
        let within = numbers.last().is_none_or(|last| (*last as usize) < count);
        let sound = open.iter().all(|waiting| waiting.axis < 4 && waiting.sum_sq >= 0.0);
        if !(apart && within && sound && (0.0..=1.1).contains(&decided)) {
            return None;
        }
        let mut tree = Vec::with_capacity(count);
        tree.push(u32::from(OPEN));
        let mut next = vec![(0_u32, like.question.part())];
        let mut waiting = Vec::with_capacity(open.len());
        let mut open = open.iter();
        for code in nodes.codes() {
            let (node, cell) = next.pop()?;
            if let Some(axis) = code.checked_sub(HALVED) {
                let first = tree.len() as u32;
                tree[node as usize] = halved(first, axis);
                tree.extend([u32::from(OPEN); 2]);
                let [lower, upper] = split(&cell, usize::from(axis));
                next.extend([(first + 1, upper), (first, lower)]);
            } else if code == OPEN {
                let OpenBox { number, sum_sq, axis } = *open.next()?;
                waiting.push(Waiting { sum_sq, number, node, axis, ends: in_single(&cell) });
            } else {
                tree[node as usize] = u32::from(code);
            }
        }
        let heap = BinaryHeap::from(waiting);
        Some(Search { question: like.question.clone(), wanted: like.wanted, heap, decided, tree })
    }

    /// Evaluates one batch of boxes: halves the lowest ones, and decides or bounds the halves.
    pub fn step(&mut self) {
        let mut batch = Vec::with_capacity(BATCH);
        while batch.len() < BATCH {
            let Some(lowest) = self.heap.pop() else { break };
            batch.push(lowest);
        }
        let look = |parent: &Waiting| {
            let halves = split(&in_double(&parent.ends), usize::from(parent.axis));
            halves.map(|half| (half, self.question.look(&half, self.wanted)))
        };
        let looked: Vec<[(Cell, Outcome); 2]> = batch.par_iter().with_min_len(16).map(look).collect();
        let whole = self.question.part();
        for (parent, pair) in batch.iter().zip(looked) {
            self.tree[parent.node as usize] = halved(self.tree.len() as u32, parent.axis);
            for (cell, outcome) in pair {
                let number = self.tree.len() as u32;
                self.tree.push(match outcome {
                    Outcome::Leaf(rule) => {
                        self.decided += share(&cell, &whole);
                        rule as u32
                    }
                    Outcome::Open(bound) => {
                        self.heap.push(Waiting::new(&cell, &bound, parent.sum_sq, number));
                        u32::from(OPEN)
                    }
                });
            }
        }
    }
}

fn share(cell: &Cell, whole: &Cell) -> f64 {
    let side = |cell: &Cell, k: usize| cell.high[k] - cell.low[k];
    (0..4).filter(|k| side(whole, *k) > 0.0).map(|k| side(cell, k) / side(whole, k)).product()
}
