//! Isotonic regression on a closed chain: points on a curve that may meet but not pass each other.
//!
//! Point j is at s_j, and its desired position is s_j + tau_j with the weight k_j (its stiffness). The positions v_j
//! with the least sum k_j (v_j - s_j - tau_j)^2 subject to v_0 <= v_1 <= .. around the chain are found by pooling
//! adjacent violators (Ayer, Brunk, Ewing, Reid and Silverman 1955) in linear time: each pool goes to the weighted
//! mean of its members' desired positions. The chain is cut at its widest gap.

use std::ops::Range;

/// Isotonic regression by pool adjacent violators: the pools of a chain, in buffers that are kept to save
/// allocations.
#[derive(Clone, Debug, Default)]
pub struct Ordered {
    leaders: Vec<usize>,
    /// The pools: (value, stiffness, members as a range of `chain`).
    stack: Vec<(f64, f64, Range<usize>)>,
    /// Point indices from the cut on; `places` holds their positions.
    chain: Vec<usize>,
    places: Vec<f64>,
    /// Members of the pools of more than one point, each with its step to the weighted mean of the members'
    /// positions.
    members: Vec<(usize, f64)>,
    ranges: Vec<Range<usize>>,
    pooled: Vec<bool>,
    any: bool,
}

impl Ordered {
    /// Creates the buffers for a chain of `n` points.
    pub fn new(n: usize) -> Self {
        Ordered { leaders: (0..n).collect(), pooled: vec![false; n], ..Ordered::default() }
    }

    /// Pools the points. `gaps[j]` is the distance from point j to the next, the last one back to the first; a
    /// negative gap means that the two are out of order already. `tau` is changed for the members of pools, so that
    /// all members of a pool end in one place.
    pub fn pool(&mut self, gaps: &[f64], tau: &mut [f64], stiffness: &[f64]) {
        let n = gaps.len();
        self.members.clear();
        self.ranges.clear();
        if self.any {
            self.leaders.iter_mut().enumerate().for_each(|(j, leader)| *leader = j);
            self.pooled.fill(false);
            self.any = false;
        }
        let mut widest = (0, 0.0);
        let mut violated = false;
        for j in 0..n {
            let next = if j + 1 < n { j + 1 } else { 0 };
            let after = gaps[j] + tau[next] - tau[j];
            violated |= after < 0.0;
            if j == 0 || after > widest.1 {
                widest = (j, after);
            }
        }
        let (widest, _) = widest;
        if !violated {
            return;
        }
        self.chain.clear();
        self.places.clear();
        self.stack.clear();
        let mut place = 0.0;
        for i in 0..n {
            let j = (widest + 1 + i) % n;
            self.chain.push(j);
            self.places.push(place);
            let mut block = (place + tau[j], stiffness[j].max(f64::MIN_POSITIVE), i..i + 1);
            while let Some((value, weight, range)) = self.stack.pop_if(|(value, ..)| *value > block.0) {
                let total = weight + block.1;
                block = (value + (block.0 - value) * (block.1 / total), total, range.start..block.2.end);
            }
            self.stack.push(block);
            place += gaps[j];
        }
        self.any = true;
        for (value, _, range) in &self.stack {
            if range.len() == 1 {
                continue;
            }
            let start = self.members.len();
            let (mut sum, mut total) = (0.0, 0.0);
            let first = self.places[range.start];
            let mut leader = self.chain[range.start];
            let mut nearest = f64::INFINITY;
            for i in range.clone() {
                let j = self.chain[i];
                let way = value - self.places[i];
                tau[j] = way;
                if way.abs() < nearest {
                    (leader, nearest) = (j, way.abs());
                }
                let weight = stiffness[j].max(f64::MIN_POSITIVE);
                sum += weight * (self.places[i] - first);
                total += weight;
            }
            let middle = first + sum / total;
            for i in range.clone() {
                self.leaders[self.chain[i]] = leader;
                self.pooled[self.chain[i]] = true;
                self.members.push((self.chain[i], middle - self.places[i]));
            }
            self.ranges.push(start..self.members.len());
        }
    }

    /// Returns whether a point is in no pool.
    pub fn is_alone(&self, j: usize) -> bool {
        !self.pooled[j]
    }

    /// Returns whether any pool has more than one point.
    pub fn any(&self) -> bool {
        self.any
    }

    /// Returns the pools of more than one point, each member as (index, step to the weighted mean of the members'
    /// positions).
    pub fn pools(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        self.ranges.iter().map(|range| &self.members[range.clone()])
    }

    /// Returns for each point the index of the point whose position it takes; its own index if it is in no pool.
    pub fn leaders(&self) -> &[usize] {
        &self.leaders
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_order_are_left_alone() {
        let mut ordered = Ordered::new(3);
        let mut tau = [0.1, 0.0, -0.2];
        ordered.pool(&[1.0, 1.0, 4.0], &mut tau, &[1.0; 3]);
        assert_eq!(tau, [0.1, 0.0, -0.2]);
        assert!((0..3).all(|j| ordered.is_alone(j)) && !ordered.any());
    }

    #[test]
    fn violators_meet_at_their_weighted_mean() {
        // Positions 0, 1, 2; desired 0, 1.9, 1.1 with stiffness 1, 3, 1: the last two meet at 1.7.
        let mut ordered = Ordered::new(3);
        let mut tau = [0.0, 0.9, -0.9];
        ordered.pool(&[1.0, 1.0, 4.0], &mut tau, &[1.0, 3.0, 1.0]);
        assert!((tau[1] - 0.7).abs() < 1e-15 && (tau[2] + 0.3).abs() < 1e-15, "{tau:?}");
        assert_eq!(ordered.leaders(), [0, 2, 2]);
        assert!(ordered.is_alone(0) && !ordered.is_alone(1) && !ordered.is_alone(2));
        let pools: Vec<_> = ordered.pools().collect();
        assert_eq!(pools.len(), 1);
        // The mean of the members' positions, weighted by stiffness, is 1.25.
        assert_eq!(pools[0], [(1, 0.25), (2, -0.75)]);
    }

    #[test]
    fn the_regression_is_the_least_of_all_ordered_ones() {
        use linkwright_arithmetic::streams::{stream, uniform};
        let mut draws = stream(3, 0);
        for _ in 0..200 {
            let n = 6;
            let gaps: Vec<f64> =
                (0..n).map(|j| if j + 1 == n { 50.0 } else { uniform(&mut draws, -0.2, 1.0) }).collect();
            let stiffness: Vec<f64> = (0..n).map(|_| uniform(&mut draws, 0.1, 2.0)).collect();
            let wants: Vec<f64> = (0..n).map(|_| uniform(&mut draws, -1.0, 1.0)).collect();
            let mut tau = wants.clone();
            Ordered::new(n).pool(&gaps, &mut tau, &stiffness);
            let cost = |t: &[f64]| -> f64 { (0..n).map(|j| stiffness[j] * (t[j] - wants[j]).powi(2)).sum() };
            let in_order = |t: &[f64], by: f64| (0..n - 1).all(|j| gaps[j] + t[j + 1] - t[j] >= by);
            assert!(in_order(&tau, -1e-12));
            // No feasible neighbour is better: random moves that keep the order.
            for _ in 0..200 {
                let moved: Vec<f64> = tau.iter().map(|t| t + uniform(&mut draws, -0.05, 0.05)).collect();
                if in_order(&moved, 0.0) {
                    assert!(cost(&moved) >= cost(&tau) - 1e-9);
                }
            }
        }
    }
}
