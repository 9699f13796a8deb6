//! The diagonal of a box around joints that move, by the joints at its sides.
//!
//! With least coordinates u of all joints in the directions +x, +y, -x, -y the box is w = -(u_1 + u_3) wide and
//! h = -(u_2 + u_4) high; its diagonal is sqrt(w^2 + h^2), and
//!
//! ```text
//! d(L - sqrt(w^2 + h^2)) = (w (du_1 + du_3) + h (du_2 + du_4)) / sqrt(w^2 + h^2)
//! ```
//!
//! Each side is the extreme of all joints. One diagonal has the extreme joint on every side; for each side and each other
//! joint there is one with that joint in its place: never longer, and as long where two joints lie on that side.

/// A diagonal of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::task::forms) struct Diagonal {
    /// The joint at each side.
    pub(in crate::task::forms) joints: [usize; 4],
    /// Its length.
    pub(in crate::task::forms) length: f64,
    /// The part of each side's du in the change of L less the length.
    pub(in crate::task::forms) factors: [f64; 4],
}

/// Passes the diagonals of a box to `each`, always as many for a number of joints; `least[side][joint]` is the least coordinate
/// of a joint towards the inside of a side.
pub(in crate::task::forms) fn diagonals(least: [&[f64]; 4], each: &mut dyn FnMut(&Diagonal)) {
    let extreme = least.map(|joints| {
        let by_value = |i: &usize, k: &usize| joints[*i].total_cmp(&joints[*k]);
        (0..joints.len()).min_by(by_value).unwrap_or(0)
    });
    each(&Diagonal::of(least, extreme));
    for (side, joints) in least.into_iter().enumerate() {
        for joint in (0..joints.len()).filter(|joint| *joint != extreme[side]) {
            let mut others = extreme;
            others[side] = joint;
            each(&Diagonal::of(least, others));
        }
    }
}

impl Diagonal {
    fn of(least: [&[f64]; 4], joints: [usize; 4]) -> Diagonal {
        let side = |i: usize| least[i][joints[i]];
        let (width, height) = (-(side(0) + side(2)), -(side(1) + side(3)));
        let length = width.hypot(height);
        let [by_width, by_height] = [width, height].map(|part| part / length.max(f64::MIN_POSITIVE));
        Diagonal { joints, length, factors: [by_width, by_height, by_width, by_height] }
    }
}
