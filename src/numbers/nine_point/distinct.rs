//! The proof that certified solutions belong to different classes.
//!
//! The three foci of a coupler curve are the ground pivots a, b and that of the third Roberts cognate,
//! c = (b x - a y) / (x - y). The six solutions of a class (three cognates, two labels each) only permute them:
//! exchanging the links exchanges a and b, and Roberts' map takes (a, b, c) to (c, a, b). So their symmetric
//! functions
//!
//! ```text
//! a + b + c        a b + b c + c a        a b c        and the starred ones
//! ```
//!
//! are the same at all six. So is the sum over the foci of the products of the two pins that cognates have there,
//! with p = (x - a) y / (x - y) the pin at c:
//!
//! ```text
//! x (a - x) + y (b - y) + p (c - p)        and the starred one
//! ```
//!
//! The two of a slider-crank's class exchange x and a - x, and y and its image z = a - x + x (x - a) / (x - y), so that
//!
//! ```text
//! a        x (a - x)        y + z        y z        and the starred ones
//! ```
//!
//! are the same. A class of inverted slider-cranks is one solution.
//!
//! The products distinguish linkages that are mirror images of one another and have their foci on the axis. Two solutions
//! whose enclosures give disjoint discs for one of these functions belong to different classes.

use super::certificate::Certificate;
use super::discs::Disc;
use super::target::Closure;

/// Discs of these eight functions; `None` if x - y may be zero, so that c is not defined.
type Invariants = Option<[Disc; 8]>;

fn invariants(certificate: &Certificate) -> Invariants {
    let e = certificate.enclosure();
    let of = |x: Disc, y: Disc, a: Disc, b: Disc| -> Option<[Disc; 4]> {
        let coupler = (x - y).inverse()?;
        let (c, p) = ((b * x - a * y) * coupler, (x - a) * y * coupler);
        let products = x * (a - x) + y * (b - y) + p * (c - p);
        Some([a + b + c, a * b + (a + b) * c, a * b * c, products])
    };
    match certificate.closure {
        Closure::FourBar => {}
        Closure::SliderCrank => {
            let of = |x: Disc, y: Disc, a: Disc| -> Option<[Disc; 4]> {
                let z = a - x + x * (x - a) * (x - y).inverse()?;
                Some([a, x * (a - x), y + z, y * z])
            };
            let ([s1, s2, s3, s4], [t1, t2, t3, t4]) = (of(e[0], e[1], e[2])?, of(e[4], e[5], e[6])?);
            return Some([s1, s2, s3, s4, t1, t2, t3, t4]);
        }
        Closure::InvertedSliderCrank => return e.first_chunk().copied(),
    }
    let ([s1, s2, s3, s4], [t1, t2, t3, t4]) = (of(e[0], e[1], e[2], e[3])?, of(e[4], e[5], e[6], e[7])?);
    Some([s1, s2, s3, s4, t1, t2, t3, t4])
}

/// Returns the pairs (first < second, in order) that are *not* proved to be of different classes. An empty answer is
/// the proof that all classes differ.
///
/// Sorted along the real part of a + b + c and swept: only pairs whose intervals there overlap are compared further, so
/// the cost is O(n log n) plus these pairs. A solution whose third focus cannot be bounded is paired with all others.
pub fn not_proved_distinct(certificates: &[Certificate]) -> Vec<[usize; 2]> {
    let invariants: Vec<Invariants> = certificates.iter().map(invariants).collect();
    let mut intervals: Vec<_> = invariants.iter().map(interval).zip(0..).collect();
    intervals.sort_by(|(one, i), (two, k)| one.0.total_cmp(&two.0).then(i.cmp(k)));
    let mut pairs = Vec::new();
    for (place, &((_, high), first)) in intervals.iter().enumerate() {
        let overlapping = intervals[place + 1..].iter().take_while(|((low, _), _)| *low <= high);
        for &(_, second) in overlapping {
            if !apart(&invariants[first], &invariants[second]) {
                pairs.push([first.min(second), first.max(second)]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Returns an interval that contains the real part of the first invariant.
fn interval(of: &Invariants) -> (f64, f64) {
    let bounds = of.as_ref().map(|[sum, ..]| {
        let (mid, radius) = (sum.mid.re, sum.radius.get());
        ((mid - radius).next_down(), (mid + radius).next_up())
    });
    match bounds {
        Some((low, high)) if low <= high => (low, high),
        _ => (f64::NEG_INFINITY, f64::INFINITY),
    }
}

fn apart(one: &Invariants, two: &Invariants) -> bool {
    match (one, two) {
        (Some(one), Some(two)) => one.iter().zip(two).any(|(a, b)| a.is_disjoint(b)),
        _ => false,
    }
}
