//! Blocks of a least-squares problem: a point's residual and an inequality, each with its derivatives; directions along
//! and across a tangent.

/// A point's residual with its derivatives; N shared unknowns, R rows.
#[derive(Clone, Copy, Debug)]
pub struct PointBlock<const N: usize, const R: usize = 2> {
    /// The residual r_j.
    pub residual: [f64; R],
    /// The Jacobian dr_j/dx, R rows.
    pub jacobian: [[f64; N]; R],
    /// The tangent dr_j/dtau_j; zero if the point has no unknown of its own.
    pub tangent: [f64; R],
    /// The weight w_j.
    pub weight: f64,
}

impl<const N: usize, const R: usize> PointBlock<N, R> {
    /// Returns |t_j|^2.
    #[inline(always)]
    pub(crate) fn tangent_sq(&self) -> f64 {
        dot(&self.tangent, &self.tangent)
    }
}

/// Computes the scalar product of two vectors of residuals, added in the order of the rows.
#[inline(always)]
pub(crate) fn dot<const R: usize>(one: &[f64; R], other: &[f64; R]) -> f64 {
    (1..R).fold(one[0] * other[0], |sum, row| sum + one[row] * other[row])
}

/// Computes the component of column `i` of a Jacobian in a direction, added in the order of the rows.
#[inline(always)]
pub(crate) fn column<const N: usize, const R: usize>(
    direction: &[f64; R],
    jacobian: &[[f64; N]; R],
    i: usize,
) -> f64 {
    (1..R).fold(direction[0] * jacobian[0][i], |sum, row| sum + direction[row] * jacobian[row][i])
}

/// Returns an orthonormal basis of the space of residuals: the unit vector along a tangent t that is not zero comes
/// last, the R - 1 before it are perpendicular to t.
///
/// With R = 2 the one across is t turned by a right angle. Otherwise those across are the last R - 1 rows of the
/// Householder reflection that takes u = t / |t| onto the first axis: e_k - u_k (u + s e_1) / (1 + |u_1|), s the sign
/// of u_1.
#[inline(always)]
pub(crate) fn across_and_along<const R: usize>(t: &[f64; R], t_sq: f64) -> [[f64; R]; R] {
    let length = t_sq.sqrt();
    let along = t.map(|component| component / length);
    let mut basis = [along; R];
    if R == 2 {
        (basis[0][0], basis[0][1]) = (-t[1] / length, t[0] / length);
        return basis;
    }
    let sign = 1.0_f64.copysign(along[0]);
    for k in 1..R {
        let part = along[k] / (1.0 + along[0].abs());
        let across = &mut basis[k - 1];
        across[0] = -sign * along[k];
        for i in 1..R {
            across[i] = -part * along[i];
        }
        across[k] += 1.0;
    }
    basis
}

/// An inequality g >= 0 with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintRow<const N: usize> {
    /// The value g, in the unit of the residuals.
    pub value: f64,
    /// The gradient dg/dx, with the points' own unknowns held fixed.
    pub gradient: [f64; N],
    /// The indices of the points on whose own unknowns g depends, each with dg/dtau; `None` everywhere if g depends on
    /// the shared unknowns alone.
    pub own: [Option<(usize, f64)>; MOST_OWN],
}

/// The most points on whose own unknowns one inequality depends.
pub const MOST_OWN: usize = 4;

impl<const N: usize> ConstraintRow<N> {
    /// Returns the row with the derivative by the shared unknowns alone, the points' own unknowns following them:
    ///
    /// ```text
    /// tau = -<t, r + J dx> / (|t|^2 + nu)      its best step for the residual,
    /// dg/dx + dg/dtau dtau/dx
    /// ```
    ///
    /// `blocks` are the points' blocks at the same point of the iteration. If a point's tangent is zero, its
    /// unknown stays fixed. The derivatives by the own unknowns of points that are `kept` stay as they are.
    pub(crate) fn followed<const R: usize>(
        mut self,
        blocks: &[PointBlock<N, R>],
        nu: f64,
        kept: impl Fn(usize) -> bool,
    ) -> Self {
        let own = std::mem::replace(&mut self.own, [None; MOST_OWN]);
        for (place, entry) in own.into_iter().enumerate() {
            let Some((point, by)) = entry else { continue };
            if kept(point) {
                self.own[place] = entry;
                continue;
            }
            let Some(block) = blocks.get(point) else { continue };
            let (t, t_sq) = (block.tangent, block.tangent_sq());
            if t_sq > 0.0 {
                let by = by / (t_sq + nu);
                for (i, slope) in self.gradient.iter_mut().enumerate() {
                    *slope -= by * column(&t, &block.jacobian, i);
                }
            }
        }
        self
    }
}
