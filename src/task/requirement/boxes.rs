//! Boxes [xmin, ymin, xmax, ymax] as limits.

use super::{Limit, Refusal};

pub(super) fn limits(corners: Option<[f64; 4]>) -> Option<Vec<Limit>> {
    let corners = corners?;
    Some((0..4).map(|i| Limit { value: corners[i], outward: if i < 2 { -1.0 } else { 1.0 } }).collect())
}

pub(super) fn check(corners: Option<[f64; 4]>) -> Result<(), Refusal> {
    match corners {
        Some([x0, y0, x1, y1]) if !(x0 < x1 && y0 < y1) => Refusal::because(
            format!("the box [{x0}, {y0}, {x1}, {y1}] is empty or the wrong way round"),
            "write [xmin, ymin, xmax, ymax] with xmin < xmax and ymin < ymax",
        ),
        _ => Ok(()),
    }
}
