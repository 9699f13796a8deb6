//! The Pareto front of error, transmission angle and size.

use std::cmp::Ordering;

/// The figures that decide about the front; a point with a missing figure is not on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Whether all requirements are met.
    pub accepted: bool,
    /// The error; less is better.
    pub error: Option<f64>,
    /// The worst transmission angle; more is better.
    pub angle: Option<f64>,
    /// The size; less is better.
    pub size: Option<f64>,
}

/// Returns the costs of a point; less is better for each.
fn costs(point: &Point) -> Option<[f64; 4]> {
    let costs = [f64::from(u8::from(!point.accepted)), point.error?, -point.angle?, point.size?];
    costs.iter().all(|cost| cost.is_finite()).then_some(costs)
}

fn dominates(x: &[f64; 4], y: &[f64; 4]) -> bool {
    x.iter().zip(y).all(|(x, y)| x <= y) && x.iter().zip(y).any(|(x, y)| x < y)
}

/// Returns whether each point is on the front: no other is at least as good in error, angle and size and better in one
/// of them. A point that is not accepted never dominates one that is. Equal points are on the front together.
///
/// O(n f) for a front of f points.
pub fn front(points: &[Point]) -> Vec<bool> {
    let mut order: Vec<(usize, [f64; 4])> =
        points.iter().enumerate().filter_map(|(i, point)| Some((i, costs(point)?))).collect();
    // A point that dominates another comes before it.
    order.sort_by(|x, y| x.1.partial_cmp(&y.1).unwrap_or(Ordering::Equal));
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
