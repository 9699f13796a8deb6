//! Curves and arcs of the atlas compared with a target, many of them side by side.

use crate::mechanism::Complex;
use crate::numbers::arithmetic::dispatch::vectorised;

/// Points evenly along a curve.
pub(in crate::synthesis) const EVEN: usize = 32;
/// Fourier harmonics of each sign.
pub(super) const HARMONICS: usize = 6;
/// Number of points on an arc.
pub(in crate::synthesis) const ON_ARC: usize = 12;

/// The magnitudes of a curve's Fourier coefficients, of positive harmonics and then of negative ones.
pub(super) type Descriptor = [f32; 2 * HARMONICS];

/// The x and y coordinates of points, centred and scaled to unit norm.
#[derive(Clone, Copy, Debug)]
pub(in crate::synthesis) struct Normal<const N: usize>(pub(super) [[f32; N]; 2]);

impl<const N: usize> Normal<N> {
    /// Creates them from `N` points; `None` if all points coincide.
    pub(in crate::synthesis) fn of(points: &[Complex]) -> Option<Self> {
        let middle = points.iter().sum::<Complex>() / points.len() as f64;
        let norm = points.iter().map(|p| (p - middle).norm_sqr()).sum::<f64>().sqrt();
        let mut out = [[0.0; N]; 2];
        for (m, p) in points.iter().enumerate().take(N) {
            let q = (p - middle) / norm;
            (out[0][m], out[1][m]) = (q.re as f32, q.im as f32);
        }
        norm.is_normal().then_some(Normal(out))
    }
}

/// Points evenly along a closed curve.
pub(in crate::synthesis) type Even = Normal<EVEN>;
/// Points evenly along an arc.
pub(in crate::synthesis) type OnArc = Normal<ON_ARC>;

impl Even {
    /// Returns the relative residual of a target fitted by similarity to this curve, for each shift of the first point;
    /// `ahead`: in the same direction, else reversed.
    #[inline(always)]
    pub(in crate::synthesis) fn misfits(&self, target: &Even, ahead: bool) -> [f32; EVEN] {
        // Twice around, so that every shift is a contiguous range.
        let mut around = [[0.0f32; 2 * EVEN]; 2];
        for (around, own) in around.iter_mut().zip(&self.0) {
            around[..EVEN].copy_from_slice(own);
            around[EVEN..].copy_from_slice(own);
        }
        let (mut re, mut im) = ([0.0f32; EVEN], [0.0f32; EVEN]);
        for m in 0..EVEN {
            let (tx, ty) = (target.0[0][m], target.0[1][m]);
            let from = if ahead { m } else { EVEN - m };
            let (x, y) = (&around[0][from..from + EVEN], &around[1][from..from + EVEN]);
            for shift in 0..EVEN {
                re[shift] += x[shift] * tx + y[shift] * ty;
                im[shift] += x[shift] * ty - y[shift] * tx;
            }
        }
        let mut misfits = [0.0f32; EVEN];
        for shift in 0..EVEN {
            misfits[shift] = 1.0 - (re[shift] * re[shift] + im[shift] * im[shift]);
        }
        misfits
    }
}

/// `K` numbers of each of many items, those of [`LANES`] items side by side: so their sums become vector instructions, each
/// in the order in which that of one item would be added.
pub(super) struct SideBySide<const K: usize> {
    blocks: Vec<[[f32; LANES]; K]>,
    count: usize,
}

/// The items that are side by side.
const LANES: usize = 16;

impl<const K: usize> SideBySide<K> {
    pub(super) fn of(items: impl Iterator<Item = [f32; K]>) -> Self {
        let items: Vec<[f32; K]> = items.collect();
        let block = |items: &[[f32; K]]| {
            std::array::from_fn(|k| std::array::from_fn(|lane| items.get(lane).map_or(0.0, |item| item[k])))
        };
        SideBySide { blocks: items.chunks(LANES).map(block).collect(), count: items.len() }
    }
}

impl OnArc {
    /// Returns the x coordinates followed by the y coordinates.
    pub(super) fn flat(&self) -> [f32; 2 * ON_ARC] {
        let Normal([x, y]) = self;
        std::array::from_fn(|k| if k < ON_ARC { x[k] } else { y[k - ON_ARC] })
    }
}

/// Returns the relative residual of a target after the best similarity to an arc, in the target's direction and reversed.
pub(in crate::synthesis) fn arc_misfits(Normal([x, y]): &OnArc, Normal([tx, ty]): &OnArc) -> [f32; 2] {
    let (mut ahead, mut back) = ([0.0f32; 2], [0.0f32; 2]);
    for m in 0..ON_ARC {
        let r = ON_ARC - 1 - m;
        ahead = [ahead[0] + x[m] * tx[m] + y[m] * ty[m], ahead[1] + x[m] * ty[m] - y[m] * tx[m]];
        back = [back[0] + x[r] * tx[m] + y[r] * ty[m], back[1] + x[r] * ty[m] - y[r] * tx[m]];
    }
    [ahead, back].map(|z| 1.0 - (z[0] * z[0] + z[1] * z[1]))
}

/// Returns for each arc the relative residual of a target, as [`arc_misfits`] and to the same bits.
pub(super) fn arcs_apart(arcs: &SideBySide<{ 2 * ON_ARC }>, Normal([tx, ty]): &OnArc) -> Vec<[f32; 2]> {
    let mut apart = Vec::with_capacity(LANES * arcs.blocks.len());
    vectorised(
        #[inline(always)]
        || {
            for points in &arcs.blocks {
                let (x, y) = points.split_at(ON_ARC);
                let (mut ahead, mut back) = ([[0.0f32; LANES]; 2], [[0.0f32; LANES]; 2]);
                for m in 0..ON_ARC {
                    let r = ON_ARC - 1 - m;
                    for i in 0..LANES {
                        ahead[0][i] = ahead[0][i] + x[m][i] * tx[m] + y[m][i] * ty[m];
                        ahead[1][i] = ahead[1][i] + x[m][i] * ty[m] - y[m][i] * tx[m];
                        back[0][i] = back[0][i] + x[r][i] * tx[m] + y[r][i] * ty[m];
                        back[1][i] = back[1][i] + x[r][i] * ty[m] - y[r][i] * tx[m];
                    }
                }
                for i in 0..LANES {
                    let of = |[x, y]: &[[f32; LANES]; 2]| 1.0 - (x[i] * x[i] + y[i] * y[i]);
                    apart.push([of(&ahead), of(&back)]);
                }
            }
        },
    );
    apart.truncate(arcs.count);
    apart
}

/// Returns for each entry the squared distance of its descriptor from the wanted one, in the same direction or reversed,
/// whichever is less.
pub(super) fn descriptors_apart(
    descriptors: &SideBySide<{ 2 * HARMONICS }>,
    wanted: &Descriptor,
) -> Vec<f32> {
    let mut apart = Vec::with_capacity(LANES * descriptors.blocks.len());
    vectorised(
        #[inline(always)]
        || {
            for d in &descriptors.blocks {
                let (mut same, mut reversed) = ([0.0f32; LANES], [0.0f32; LANES]);
                for k in 0..2 * HARMONICS {
                    let other = (k + HARMONICS) % (2 * HARMONICS);
                    for i in 0..LANES {
                        let (one, two) = (d[k][i] - wanted[k], d[other][i] - wanted[k]);
                        same[i] += one * one;
                        reversed[i] += two * two;
                    }
                }
                for i in 0..LANES {
                    apart.push(same[i].min(reversed[i]));
                }
            }
        },
    );
    apart.truncate(descriptors.count);
    apart
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::{stream, uniform};

    #[test]
    fn numbers_side_by_side_give_the_bits_of_one_at_a_time() {
        // More than two blocks, the last one not full.
        const COUNT: usize = 2 * LANES + 3;
        let mut draws = stream(7, 0);
        let mut arc = || {
            let points: Vec<Complex> = (0..ON_ARC)
                .map(|_| Complex::new(uniform(&mut draws, -1.0, 1.0), uniform(&mut draws, -1.0, 1.0)))
                .collect();
            OnArc::of(&points).expect("the points differ")
        };
        let (target, arcs): (OnArc, Vec<OnArc>) = (arc(), (0..COUNT).map(|_| arc()).collect());
        let apart = arcs_apart(&SideBySide::of(arcs.iter().map(OnArc::flat)), &target);
        let one_at_a_time: Vec<[f32; 2]> = arcs.iter().map(|arc| arc_misfits(arc, &target)).collect();
        assert_eq!(apart, one_at_a_time);

        let mut descriptor =
            || -> Descriptor { std::array::from_fn(|_| uniform(&mut draws, 0.0, 1.0) as f32) };
        let (wanted, descriptors) = (descriptor(), (0..COUNT).map(|_| descriptor()).collect::<Vec<_>>());
        let one_at_a_time = descriptors.iter().map(|own| {
            let along = |from: usize| {
                let differ = |k: usize| own[(k + from) % (2 * HARMONICS)] - wanted[k];
                (0..2 * HARMONICS).fold(0.0_f32, |sum, k| sum + differ(k) * differ(k))
            };
            along(0).min(along(HARMONICS))
        });
        let apart = descriptors_apart(&SideBySide::of(descriptors.iter().copied()), &wanted);
        assert_eq!(apart, one_at_a_time.collect::<Vec<_>>());
    }
}
