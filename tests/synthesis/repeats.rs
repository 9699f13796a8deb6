//! What repeated hits foretell, against simulations of searches with basins of known shares.

use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::record::Repeats;

/// Shares that are uniform on the simplex of `k` basins.
fn shares(draws: &mut Stream, k: usize) -> Vec<f64> {
    let gaps: Vec<f64> = (0..k).map(|_| -(1.0 - uniform(draws, 0.0, 1.0)).ln()).collect();
    let all: f64 = gaps.iter().sum();
    gaps.iter().map(|gap| gap / all).collect()
}

fn drawn(draws: &mut Stream, shares: &[f64]) -> usize {
    let mut left = uniform(draws, 0.0, 1.0);
    let found = shares.iter().position(|share| {
        left -= share;
        left < 0.0
    });
    found.unwrap_or(shares.len() - 1)
}

#[test]
fn better_basins_stay_unseen_as_often_as_is_foretold() {
    // K is equally likely up to 400, far beyond what twelve starts that come to few basins allow for.
    let (starts, most, runs) = (12, 400, 400_000);
    let mut draws = stream(7, 0);
    let mut tally = vec![(0_u64, 0_u64); starts + 1];
    for _ in 0..runs {
        let k = 1 + (uniform(&mut draws, 0.0, most as f64) as usize).min(most - 1);
        let shares = shares(&mut draws, k);
        let mut seen: Vec<usize> = (0..starts).map(|_| drawn(&mut draws, &shares)).collect();
        seen.sort_unstable();
        seen.dedup();
        // Shares are drawn without regard to worth: let basin 0 be the best.
        let missed = seen[0] != 0;
        tally[seen.len()].0 += 1;
        tally[seen.len()].1 += u64::from(missed);
    }
    let mut tested = 0;
    for (basins, &(count, missed)) in tally.iter().enumerate() {
        let foretold = Repeats::new(12, 1, 1).with_basins(12, basins as u64).unseen_better;
        // Where half the starts and more are basins of their own, K beyond 400 would count.
        let Some(chance) = foretold.filter(|_| count >= 200 && 2 * basins <= starts) else { continue };
        let share = missed as f64 / count as f64;
        let deviation = (chance * (1.0 - chance) / count as f64).sqrt();
        assert!((share - chance).abs() < 4.0 * deviation, "{basins} of {count}: {share} for {chance}");
        tested += 1;
    }
    assert!(tested >= 5, "{tested}");
}

#[test]
fn the_mean_over_the_numbers_of_basins_is_what_the_closed_form_says() {
    let log_factorial = |n: u64| (1..=n).map(|i| (i as f64).ln()).sum::<f64>();
    for (m, w) in [(10_u64, 1_u64), (20, 3), (30, 12), (12, 5)] {
        let weight = |k: u64| {
            (log_factorial(k) + log_factorial(k - 1) - log_factorial(k - w) - log_factorial(m + k - 1)).exp()
        };
        let (mut all, mut unseen) = (0.0, 0.0);
        for k in w..w + 2000 {
            all += weight(k);
            unseen += weight(k) * (1.0 - w as f64 / k as f64);
        }
        let closed = Repeats::new(m, 1, 1).with_basins(m, w).unseen_better.expect("few basins");
        assert!((unseen / all - closed).abs() < 1e-6, "{m} {w}: {} {closed}", unseen / all);
    }
}

#[test]
fn a_better_basin_as_likely_as_the_best_hides_from_h_hits_as_often_as_is_foretold() {
    let mut draws = stream(8, 0);
    let (share, hits, runs) = (0.1, 4, 100_000);
    let mut hidden = 0;
    for _ in 0..runs {
        let mut count = 0;
        hidden += u64::from(loop {
            match drawn(&mut draws, &[share, share, 1.0 - 2.0 * share]) {
                0 => break false,
                1 if count + 1 == hits => break true,
                1 => count += 1,
                _ => {}
            }
        });
    }
    let foretold = Repeats::new(1, hits, hits).as_likely;
    let found = f64::from(u32::try_from(hidden).expect("few")) / f64::from(runs);
    assert_eq!(foretold, 0.0625);
    assert!((found - foretold).abs() < 4.0 * (foretold / f64::from(runs)).sqrt(), "{found}");
}

#[test]
fn a_basin_of_the_share_that_is_named_is_missed_in_one_of_twenty_searches() {
    let mut draws = stream(9, 0);
    for starts in [1, 20, 200] {
        let share = Repeats::new(starts, 1, 1).share_seen;
        let runs = 20_000;
        let missed =
            (0..runs).filter(|_| (0..starts).all(|_| uniform(&mut draws, 0.0, 1.0) >= share)).count();
        let found = missed as f64 / f64::from(runs);
        assert!((found - 0.05).abs() < 4.0 * (0.05_f64 * 0.95 / f64::from(runs)).sqrt(), "{starts}: {found}");
    }
}

#[test]
fn nothing_is_foretold_from_too_few_starts_and_counts_that_cannot_be_are_told() {
    assert_eq!(Repeats::new(5, 1, 1).with_basins(5, 4).unseen_better, None);
    assert_eq!(Repeats::new(6, 1, 1).with_basins(6, 4).unseen_better, Some(0.8));
    assert_eq!(Repeats::new(0, 0, 0).share_seen, 1.0);
    let good = Repeats::new(9, 2, 3).with_basins(7, 3);
    assert!(good.is_possible() && good.recomputed() == good);
    for bad in [Repeats::new(3, 4, 4), Repeats::new(9, 3, 2), Repeats::new(9, 2, 3).with_basins(10, 3)] {
        assert!(!bad.is_possible(), "{bad:?}");
    }
}
