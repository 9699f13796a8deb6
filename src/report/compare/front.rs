//! The Pareto front.

use std::cmp::Ordering;

/// What decides about the front; a figure that is missing keeps off it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Whether everything that was asked is met.
    pub accepted: bool,
    /// Less is better.
    pub error: Option<f64>,
    /// More is better.
    pub angle: Option<f64>,
    /// Less is better.
    pub size: Option<f64>,
}

/// The costs of a point, all the less the better.
fn costs(point: &Point) -> Option<[f64; 4]> {
    let costs = [f64::from(u8::from(!point.accepted)), point.error?, -point.angle?, point.size?];
    costs.iter().all(|cost| cost.is_finite()).then_some(costs)
}

fn dominates(x: &[f64; 4], y: &[f64; 4]) -> bool {
    x.iter().zip(y).all(|(x, y)| x <= y) && x.iter().zip(y).any(|(x, y)| x < y)
}

/// Which points no other dominates: none is at least as good in error, angle and size and better in one of them.
/// What is not accepted never dominates what is. Equal points stand on the front together.
///
/// O(n f) for a front of f points.
pub fn front(points: &[Point]) -> Vec<bool> {
    let mut order: Vec<(usize, [f64; 4])> =
        points.iter().enumerate().filter_map(|(i, point)| Some((i, costs(point)?))).collect();
    // What dominates a point stands before it.
    order.sort_by(|x, y| {
        let pairs = x.1.iter().zip(&y.1);
        pairs
            .map(|(x, y)| x.partial_cmp(y).unwrap_or(Ordering::Equal))
            .find(|o| o.is_ne())
            .unwrap_or(Ordering::Equal)
    });
    let mut on_front = vec![false; points.len()];
    let mut best: Vec<[f64; 4]> = Vec::new();
    for (i, costs) in order {
        if !best.iter().any(|other| dominates(other, &costs)) {
            on_front[i] = true;
            best.push(costs);
        }
    }
    on_front
}
