//! Streams of pseudo-random numbers, each determined by a seed and an index, and the draws made from them.
//!
//! Restart `i` of a search uses stream `i` of the search's seed, so a restart can be repeated alone and no thread can
//! change what another one draws. The generator is xoshiro256++ (Blackman & Vigna 2021); its 256 bits of state are
//! filled from the pair (seed, index) by the finaliser of SplitMix64 (Steele, Lea & Flood 2014):
//!
//! ```text
//!     key_k   = mix(seed + (k + 1) g)                k = 0..3,  g = 2^64 / golden ratio, odd
//!     state_k = mix(key_k + (index + 1) g')          g' odd
//! ```
//!
//! `mix` is a bijection of the 64-bit words and `g'` is odd, so two indices of one seed differ in *every* word of the
//! state. Jumping ahead 2^128 draws a stream would exclude overlap by proof, but costs time in proportion to the index;
//! here two of a million streams that draw 2^40 numbers each overlap with a probability below 2^-170.
//!
//! The draws are written out here rather than taken from a library of distributions, whose values may change with its
//! version: the digits of a stored run should not.

use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::PI;

/// The pseudo-random generator that every population search draws from.
pub type Stream = Xoshiro256PlusPlus;

/// 2^64 divided by the golden ratio, made odd: the step of SplitMix64.
const SEED_STEP: u64 = 0x9E37_79B9_7F4A_7C15;
/// 2^64 times (sqrt(2) - 1), made odd: a second step, so that seed and index cannot replace one another.
const INDEX_STEP: u64 = 0x6A09_E667_F3BC_C909;

/// Applies the finaliser of SplitMix64 (Steele, Lea & Flood 2014, with Stafford's variant 13): a bijection.
const fn mix(word: u64) -> u64 {
    let word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    word ^ (word >> 31)
}

/// Returns the stream with index `index` of `seed`.
///
/// The same pair always gives the same stream; two indices of one seed give states that differ in every word.
///
/// ```
/// # use linkwright_arithmetic::streams::{stream, unit};
/// assert_eq!(unit(&mut stream(7, 3)), unit(&mut stream(7, 3)));
/// assert_ne!(unit(&mut stream(7, 3)), unit(&mut stream(7, 4)));
/// ```
pub fn stream(seed: u64, index: u64) -> Stream {
    let mut state = [0_u8; 32];
    let offset = index.wrapping_add(1).wrapping_mul(INDEX_STEP);
    let mut position = seed;
    for word in state.chunks_exact_mut(8) {
        position = position.wrapping_add(SEED_STEP);
        word.copy_from_slice(&mix(mix(position).wrapping_add(offset)).to_le_bytes());
    }
    Stream::from_seed(state)
}

/// Draws a number uniform in [0, 1): a multiple of 2^-53.
pub fn unit(stream: &mut Stream) -> f64 {
    (stream.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// Draws a number uniform in [`lower`, `upper`], for finite `lower <= upper` with a finite difference.
pub fn uniform(stream: &mut Stream, lower: f64, upper: f64) -> f64 {
    // The sum may round up past the upper end, by one unit in its last place.
    (lower + (upper - lower) * unit(stream)).min(upper)
}

/// Draws a whole number uniform in 0..`count`.
///
/// By the multiply-and-shift of Lemire (2019) without its rejection step: the bias is at most `count` / 2^64.
///
/// # Panics
/// If `count` is zero.
pub fn below(stream: &mut Stream, count: usize) -> usize {
    assert!(count > 0, "a draw from nothing");
    ((u128::from(stream.next_u64()) * count as u128) >> 64) as usize
}

/// Draws a number from the normal distribution with the given mean and standard deviation (Box & Muller 1958).
///
/// Of the pair that the transform yields, one is used: every call takes two words, whatever was drawn before.
pub fn normal(stream: &mut Stream, mean: f64, deviation: f64) -> f64 {
    let radius = (-2.0 * (1.0 - unit(stream)).ln()).sqrt();
    mean + deviation * radius * (2.0 * PI * unit(stream)).cos()
}

/// Draws a number from the Cauchy distribution with the given median and half width at half height, by inversion.
pub fn cauchy(stream: &mut Stream, location: f64, scale: f64) -> f64 {
    location + scale * (PI * (unit(stream) - 0.5)).tan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn streams_of_one_seed_and_seeds_of_one_stream_differ() {
        let mut seen = HashSet::new();
        for seed in 0..64 {
            for index in 0..64 {
                let mut generator = stream(seed, index);
                for _ in 0..4 {
                    assert!(seen.insert(generator.next_u64()), "seed {seed}, index {index}");
                }
            }
        }
    }

    #[test]
    fn the_same_seed_and_index_repeat_their_draws() {
        let (mut one, mut other) = (stream(u64::MAX, u64::MAX), stream(u64::MAX, u64::MAX));
        assert!((0..100).all(|_| one.next_u64() == other.next_u64()));
    }

    #[test]
    fn neighbouring_streams_are_not_correlated() {
        // The first draw of each of 4096 streams: mean 1/2, lag-one correlation 0, each within five standard errors.
        let draws: Vec<f64> = (0..4096).map(|index| unit(&mut stream(0, index)) - 0.5).collect();
        let count = draws.len() as f64;
        let mean = draws.iter().sum::<f64>() / count;
        let lag = draws.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / count;
        assert!(mean.abs() < 5.0 * (1.0 / 12.0_f64).sqrt() / count.sqrt(), "{mean}");
        assert!(lag.abs() < 5.0 / 12.0 / count.sqrt(), "{lag}");
    }

    #[test]
    fn draws_have_the_moments_of_their_distributions() {
        let generator = &mut stream(1, 0);
        let count = 100_000_usize;
        let root = (count as f64).sqrt();
        let normals: Vec<f64> = (0..count).map(|_| normal(generator, 3.0, 2.0)).collect();
        let mean = normals.iter().sum::<f64>() / count as f64;
        let variance = normals.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count as f64;
        assert!((mean - 3.0).abs() < 5.0 * 2.0 / root, "{mean}");
        assert!((variance - 4.0).abs() < 5.0 * 4.0 * 2.0_f64.sqrt() / root, "{variance}");
        // A Cauchy variable lies within its half width of its median with probability one half.
        let inside = (0..count).filter(|_| (cauchy(generator, -1.0, 0.5) + 1.0).abs() < 0.5).count();
        assert!((inside as f64 / count as f64 - 0.5).abs() < 5.0 * 0.5 / root, "{inside}");
        let mut tally = [0_usize; 7];
        for _ in 0..count {
            tally[below(generator, 7)] += 1;
        }
        for hits in tally {
            assert!((hits as f64 / count as f64 - 1.0 / 7.0).abs() < 5.0 * 0.35 / root, "{hits}");
        }
    }

    #[test]
    fn a_uniform_draw_stays_in_its_interval_even_when_the_interval_is_one_step_wide() {
        let generator = &mut stream(2, 0);
        let upper = 1.0 + f64::EPSILON;
        assert!((0..1000).all(|_| (1.0..=upper).contains(&uniform(generator, 1.0, upper))));
    }
}
