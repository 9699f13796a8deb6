//! Boxes of the chart: their middle and half widths, and their halves.

use linkwright_leaves::Cell;

/// The factor that covers the rounding of majorants: they are computed in plain arithmetic from non-negative numbers
/// and from differences that are kept above `NEAR` (in `expansion`) times the numbers they are taken from.
pub(super) const LARGER: f64 = 1.0 + 1e-9;

/// Returns the middle and half the width, such that the box lies within them.
pub(super) fn centre(cell: &Cell) -> ([f64; 4], [f64; 4]) {
    let mut c = [0.0; 4];
    let mut h = [0.0; 4];
    for k in 0..4 {
        c[k] = 0.5 * (cell.low[k] + cell.high[k]);
        h[k] = (cell.high[k] - c[k]).max(c[k] - cell.low[k]) * LARGER;
    }
    (c, h)
}

/// Returns both halves of the box, split along an axis. They meet in one number, the middle in single precision, as the
/// boxes of a tree are stored.
pub(super) fn split(cell: &Cell, axis: usize) -> [Cell; 2] {
    let middle = f64::from((0.5 * (cell.low[axis] + cell.high[axis])) as f32);
    let (mut lower, mut upper) = (*cell, *cell);
    lower.high[axis] = middle;
    upper.low[axis] = middle;
    [lower, upper]
}
