//! Positions on their curves, eight at a time: steps along a curve, and the return to it.

use crate::mechanism::Complex;
use crate::task::forms::design_space::Shape;

/// Most Newton steps that bring a position back to its curve; each squares the miss.
pub(in crate::task::forms) const RETURN_STEPS: usize = 12;
/// Tolerance for a position on its curve: its miss over the largest link squared.
const ON_CURVE: f64 = 1e-14;

/// A closure G(e, u) = 0 of a loop, on whose curve positions lie.
pub(in crate::task::forms) trait Curve {
    /// Returns G, G_phi, G_w at e = (ex, ey), u = (ux, uy).
    fn frame(&self, position: [f64; 4]) -> (f64, f64, f64);

    /// Returns the |G| below which a position is on the curve.
    fn near(&self) -> f64;
}

/// The parameters of a shape on which its positions depend.
#[derive(Clone, Copy)]
pub(super) struct Loop {
    /// The vector A - B.
    ground: [f64; 2],
    a: f64,
    b: f64,
    c2: f64,
    /// The half squared miss below which a position is on the curve.
    near: f64,
}

impl Loop {
    pub(super) fn of(shape: &Shape) -> Loop {
        let ground = shape.crank_pivot - shape.follower_pivot;
        let largest = shape.crank.max(shape.coupler).max(shape.follower);
        Loop {
            ground: [ground.re, ground.im],
            a: shape.crank,
            b: shape.coupler,
            c2: shape.follower * shape.follower,
            near: ON_CURVE * largest * largest,
        }
    }
}

impl Curve for Loop {
    /// G = (|Y|^2 - c^2)/2.
    #[inline(always)]
    fn frame(&self, [ex, ey, ux, uy]: [f64; 4]) -> (f64, f64, f64) {
        let yx = self.ground[0] + self.a * ex + self.b * ux;
        let yy = self.ground[1] + self.a * ey + self.b * uy;
        let miss = 0.5 * (yx * yx + yy * yy - self.c2);
        (miss, self.a * (yy * ex - yx * ey), self.b * (yy * ux - yx * uy))
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        self.near
    }
}

/// Turns a unit vector by an angle, to third order, and keeps it at unit length without trigonometry: (1 + i h)/(1 - i
/// h) with h = angle/2, and one Newton step to |z| = 1.
#[inline(always)]
fn turn(x: f64, y: f64, angle: f64) -> (f64, f64) {
    let h = 0.5 * angle;
    let h2 = h * h;
    let inverse = 1.0 / (1.0 + h2);
    let (cos, sin) = ((1.0 - h2) * inverse, 2.0 * h * inverse);
    let (x, y) = (x * cos - y * sin, y * cos + x * sin);
    let unit = 1.5 - 0.5 * (x * x + y * y);
    (x * unit, y * unit)
}

/// The number of positions in a block.
const LANES: usize = 8;

/// Positions as blocks of e_x, e_y, u_x, u_y, each of [`LANES`] positions, so that the loops over a block become vector
/// instructions. The last block is filled up with the last position.
pub(in crate::task::forms) struct Blocks(Vec<[[f64; LANES]; 4]>);

impl Blocks {
    pub(in crate::task::forms) fn gather(positions: &[[Complex; 2]]) -> Blocks {
        let block = |part: &[[Complex; 2]]| {
            let mut block = [[0.0; LANES]; 4];
            for lane in 0..LANES {
                let [e, u] = part[lane.min(part.len() - 1)];
                (block[0][lane], block[1][lane]) = (e.re, e.im);
                (block[2][lane], block[3][lane]) = (u.re, u.im);
            }
            block
        };
        Blocks(positions.chunks(LANES).map(block).collect())
    }

    pub(in crate::task::forms) fn scatter(&self, positions: &mut [[Complex; 2]]) {
        for (part, [ex, ey, ux, uy]) in positions.chunks_mut(LANES).zip(&self.0) {
            for (lane, position) in part.iter_mut().enumerate() {
                *position = [Complex::new(ex[lane], ey[lane]), Complex::new(ux[lane], uy[lane])];
            }
        }
    }

    /// Moves each position along its own curve by `forward` tau.
    #[inline(always)]
    pub(in crate::task::forms) fn step(&mut self, on: &impl Curve, forward: f64, tau: &[f64]) {
        for (tau, [ex, ey, ux, uy]) in tau.chunks(LANES).zip(&mut self.0) {
            let mut steps = [tau[tau.len() - 1]; LANES];
            steps[..tau.len()].copy_from_slice(tau);
            for i in 0..LANES {
                let (_, by_e, by_u) = on.frame([ex[i], ey[i], ux[i], uy[i]]);
                let step = forward * steps[i] / (by_e * by_e + by_u * by_u).sqrt();
                (ex[i], ey[i]) = turn(ex[i], ey[i], step * by_u);
                (ux[i], uy[i]) = turn(ux[i], uy[i], -step * by_e);
            }
        }
    }

    /// Brings the positions back to their curves by least-norm Newton steps of at most a radian; `false` if one does
    /// not get there.
    #[inline(always)]
    pub(in crate::task::forms) fn settle(&mut self, on: &impl Curve) -> bool {
        let near = on.near();
        let mut limit = near;
        for round in 0..=RETURN_STEPS {
            let mut off = [0_u64; LANES];
            for [ex, ey, ux, uy] in &self.0 {
                for i in 0..LANES {
                    let miss = on.frame([ex[i], ey[i], ux[i], uy[i]]).0.abs();
                    // A NaN miss is not a position.
                    off[i] |= u64::from(miss > limit || miss.is_nan());
                }
            }
            if off == [0; LANES] {
                return true;
            }
            if round == RETURN_STEPS {
                break;
            }
            for [ex, ey, ux, uy] in &mut self.0 {
                for i in 0..LANES {
                    let (miss, by_e, by_u) = on.frame([ex[i], ey[i], ux[i], uy[i]]);
                    let n2 = by_e * by_e + by_u * by_u;
                    let long = (miss * miss / n2).sqrt();
                    let step = -miss / (n2 * if long > 1.0 { long } else { 1.0 });
                    let step = if miss.abs() <= near { 0.0 } else { step };
                    (ex[i], ey[i]) = turn(ex[i], ey[i], step * by_e);
                    (ux[i], uy[i]) = turn(ux[i], uy[i], step * by_u);
                }
            }
            if round + 2 == RETURN_STEPS {
                // Rounding may keep a position from the last digit.
                limit = 16.0 * near;
            }
        }
        false
    }
}
