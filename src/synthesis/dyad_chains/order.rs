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
