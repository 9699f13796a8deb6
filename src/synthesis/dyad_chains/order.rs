//! Projects phases onto the nearest sequence in order, by isotonic regression ([`Ordered`]).
//!
//! Closed targets are cut at their largest gap, so that the cut moves no phase.

use crate::numbers::optimise::ordered::Ordered;
use std::f64::consts::TAU;

/// Buffers of the projection.
#[derive(Clone, Debug, Default)]
pub(super) struct Order {
    ordered: Ordered,
    gaps: Vec<f64>,
    moves: Vec<f64>,
    weights: Vec<f64>,
}

impl Order {
    /// Replaces phases by the nearest sequence that does not fall and spans at most a turn.
    pub(super) fn project(&mut self, phases: &mut [f64], closed: bool) {
        let n = phases.len();
        let mut cut = n - 1;
        if closed {
            let mut largest = phases[0] + TAU - phases[n - 1];
            for i in 0..n - 1 {
                let gap = phases[i + 1] - phases[i];
                if gap > largest {
                    (largest, cut) = (gap, i);
                }
            }
        }
        // From the point after the cut, around to the point before it.
        phases.rotate_left((cut + 1) % n);
        let wrapped = n - (cut + 1);
        if wrapped > 0 {
            phases[wrapped..].iter_mut().for_each(|phase| *phase += TAU);
        }
        if phases.windows(2).any(|pair| pair[1] < pair[0]) {
            self.pool(phases);
        }
        let most = phases[0] + TAU;
        for phase in phases.iter_mut().rev() {
            if *phase <= most {
                break;
            }
            *phase = most;
        }
        if wrapped > 0 {
            phases[wrapped..].iter_mut().for_each(|phase| *phase -= TAU);
        }
        phases.rotate_right((cut + 1) % n);
    }

    /// Replaces phases by the nearest sequence that does not fall, from the first to the last.
    fn pool(&mut self, phases: &mut [f64]) {
        let n = phases.len();
        if self.weights.len() != n {
            (self.ordered, self.weights) = (Ordered::new(n), vec![1.0; n]);
        }
        self.gaps.clear();
        self.gaps.extend(phases.windows(2).map(|pair| pair[1] - pair[0]));
        // The last point and the first one are not neighbours.
        self.gaps.push(f64::INFINITY);
        self.moves.clear();
        self.moves.resize(n, 0.0);
        self.ordered.pool(&self.gaps, &mut self.moves, &self.weights);
        let mut least = f64::NEG_INFINITY;
        for (phase, by) in phases.iter_mut().zip(&self.moves) {
            // Those of a pool differ by rounding.
            least = least.max(*phase + by);
            *phase = least;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::{stream, uniform};

    #[test]
    fn open_phases_become_the_nearest_sequence_in_order() {
        let mut phases = [0.0, 2.0, 1.0, 1.0, 3.0, 2.5];
        Order::default().project(&mut phases, false);
        let third = 4.0 / 3.0;
        for (phase, wanted) in phases.into_iter().zip([0.0, third, third, third, 2.75, 2.75]) {
            assert!((phase - wanted).abs() < 1e-15);
        }
    }

    #[test]
    fn phases_in_order_stay_as_they_are_and_others_end_in_order_within_a_turn() {
        let draws = &mut stream(62, 0);
        let mut order = Order::default();
        for round in 0..500 {
            let closed = round % 2 == 0;
            let start = uniform(draws, -9.0, 9.0);
            let mut phases: Vec<f64> =
                (0..30).map(|i| start + 0.2 * f64::from(i) + uniform(draws, -0.5, 0.5)).collect();
            order.project(&mut phases, closed);
            assert!(phases.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12));
            assert!(phases[29] - phases[0] <= TAU + 1e-12);
            let mut again = phases.clone();
            order.project(&mut again, closed);
            assert!(phases.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}
