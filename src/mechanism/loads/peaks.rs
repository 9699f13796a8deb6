//! Refinement of the largest of sampled values: golden-section search about every sample that could hold it.

/// The part of the largest sample from which on a local maximum among samples is refined. Over a step of half a degree a curve
/// with up to 20 waves in a turn rises by 2 % above its samples; near a toggle it can be a spike of a few steps.
const WORTH_REFINING: f64 = 0.5;
/// The number of local maxima that are refined, the largest first.
const MOST: usize = 8;
/// Rounds of the search: 0.618^40 of a step is 4e-9 of it.
const ROUNDS: usize = 40;

/// Returns the place and the size of the largest of values sampled at `step` apart, refined by `value`; `None` if there is none.
/// Samples without a value separate stretches; `periodic` joins the last to the first.
pub(super) fn largest(
    samples: &[Option<f64>],
    (begin, step): (f64, f64),
    periodic: bool,
    mut value: impl FnMut(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let count = samples.len();
    let greatest = samples.iter().flatten().copied().max_by(f64::total_cmp)?;
    let at = |i: usize, by: isize| -> Option<f64> {
        let j = i as isize + by;
        let j = if periodic { j.rem_euclid(count as isize) } else { j };
        samples.get(usize::try_from(j).ok()?).copied().flatten()
    };
    let is_peak = |i: usize, here: f64| {
        let below = |by: isize| at(i, by).is_none_or(|there| there <= here);
        below(-1) && below(1)
    };
    let mut peaks: Vec<(usize, f64)> =
        samples.iter().enumerate().filter_map(|(i, v)| Some((i, (*v)?))).collect();
    peaks.retain(|(i, here)| *here >= WORTH_REFINING * greatest && is_peak(*i, *here));
    peaks.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.cmp(&q.0)));
    let mut best: Option<(f64, f64)> = None;
    for (i, here) in peaks.into_iter().take(MOST) {
        let middle = begin + step * i as f64;
        let reach = |by: isize| if at(i, by).is_some() { step * by as f64 } else { 0.0 };
        let found = golden(middle + reach(-1), middle + reach(1), &mut value);
        // The sample itself is the peak at a kink or at an end of the range.
        let found = found.filter(|(_, refined)| *refined > here).unwrap_or((middle, here));
        if best.is_none_or(|(_, so_far)| found.1 > so_far) {
            best = Some(found);
        }
    }
    best
}

/// Searches the largest value between two places; `None` if a value is missing.
fn golden(mut low: f64, mut high: f64, value: &mut impl FnMut(f64) -> Option<f64>) -> Option<(f64, f64)> {
    let share = 0.5 * (5_f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - share * (high - low), low + share * (high - low)];
    let [mut p, mut q] = inner(low, high);
    let (mut of_p, mut of_q) = (value(p)?, value(q)?);
    for _ in 0..ROUNDS {
        if of_p >= of_q {
            (high, q, of_q) = (q, p, of_p);
            p = inner(low, high)[0];
            of_p = value(p)?;
        } else {
            (low, p, of_p) = (p, q, of_q);
            q = inner(low, high)[1];
            of_q = value(q)?;
        }
    }
    Some(if of_p >= of_q { (p, of_p) } else { (q, of_q) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_wave_is_found_between_samples() {
        let wave = |x: f64| (x - 1.234).cos() + 0.2 * (3.0 * x).cos();
        let step = std::f64::consts::TAU / 90.0;
        let samples: Vec<Option<f64>> = (0..90).map(|i| Some(wave(step * f64::from(i)))).collect();
        let (at, size) = largest(&samples, (0.0, step), true, |x| Some(wave(x))).expect("a peak");
        let slope = -(at - 1.234).sin() - 0.6 * (3.0 * at).sin();
        assert!(slope.abs() < 1e-6 && (size - wave(at)).abs() < 1e-15);
    }

    #[test]
    fn the_end_of_a_range_can_be_the_peak() {
        let samples: Vec<Option<f64>> = (0..10).map(|i| Some(f64::from(i))).collect();
        assert_eq!(largest(&samples, (0.0, 1.0), false, Some), Some((9.0, 9.0)));
        assert_eq!(largest(&[None, None], (0.0, 1.0), true, Some), None);
    }
}
