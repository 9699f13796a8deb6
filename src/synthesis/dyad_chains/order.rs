//! Projects phases onto the nearest sequence in order, by pooling adjacent violators (Ayer et al. 1955).
//!
//! Closed targets are cut at their largest gap, so that the cut moves no phase.

use std::f64::consts::TAU;

/// Buffers of the projection.
#[derive(Clone, Debug, Default)]
pub(super) struct Order {
    /// Sum and number of the phases of each pool.
    pools: Vec<(f64, u32)>,
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
            self.pools.clear();
            for phase in phases.iter() {
                let mut pool = (*phase, 1);
                while let Some(&(sum, count)) = self.pools.last()
                    && sum * f64::from(pool.1) > pool.0 * f64::from(count)
                {
                    pool = (pool.0 + sum, pool.1 + count);
                    self.pools.pop();
                }
                self.pools.push(pool);
            }
            let mut at = 0;
            for (sum, count) in &self.pools {
                let mean = sum / f64::from(*count);
                for phase in &mut phases[at..at + *count as usize] {
                    *phase = mean;
                }
                at += *count as usize;
            }
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
