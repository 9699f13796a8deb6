//! Positions on their curves, eight at a time: steps along a curve, and the return to it.

use crate::mechanism::Complex;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::task::forms::design_space::Shape;
use smallvec::SmallVec;

/// Most Newton steps that bring a position back to its curve; each squares the miss.
pub(in crate::task::forms) const RETURN_STEPS: usize = 12;
/// Tolerance for a position on its curve: its miss over the largest link squared.
const ON_CURVE: f64 = 1e-14;

/// A closure G(e, u) = 0 of a loop, on whose curve positions lie.
pub(in crate::task::forms) trait Curve {
    /// Returns G, G_phi, G_w at e = (ex, ey), u = (ux, uy).
    fn frame(&self, position: [F64x8; 4]) -> (F64x8, F64x8, F64x8);

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
    fn frame(&self, [ex, ey, ux, uy]: [F64x8; 4]) -> (F64x8, F64x8, F64x8) {
        let all = F64x8::splat;
        let (a, b) = (all(self.a), all(self.b));
        let yx = all(self.ground[0]) + a * ex + b * ux;
        let yy = all(self.ground[1]) + a * ey + b * uy;
        let miss = all(0.5) * (yx * yx + yy * yy - all(self.c2));
        (miss, a * (yy * ex - yx * ey), b * (yy * ux - yx * uy))
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        self.near
    }
}

/// Turns unit vectors by angles, to third order, and keeps them at unit length without trigonometry: (1 + i h)/(1 - i
/// h) with h = angle/2, and one Newton step to |z| = 1.
#[inline(always)]
fn turn(x: F64x8, y: F64x8, angle: F64x8) -> (F64x8, F64x8) {
    let all = F64x8::splat;
    let h = all(0.5) * angle;
    let h2 = h * h;
    let inverse = (all(1.0) + h2).recip();
    let (cos, sin) = ((all(1.0) - h2) * inverse, all(2.0) * h * inverse);
    let (x, y) = (x * cos - y * sin, y * cos + x * sin);
    let unit = all(1.5) - all(0.5) * (x * x + y * y);
    (x * unit, y * unit)
}

/// The most blocks that stand on the stack: those of a target of few points, or of a dense one in its groups.
const ON_STACK: usize = 4;

/// Positions as blocks of e_x, e_y, u_x, u_y, each of [`LANES`] positions side by side. The last block is filled up with the
/// last position.
pub(in crate::task::forms) struct Blocks(SmallVec<[[F64x8; 4]; ON_STACK]>);

impl Blocks {
    pub(in crate::task::forms) fn gather(positions: &[[Complex; 2]]) -> Blocks {
        let block = |part: &[[Complex; 2]]| {
            let mut block = [F64x8::splat(0.0); 4];
            for lane in 0..LANES {
                let [e, u] = part[lane.min(part.len() - 1)];
                (block[0].0[lane], block[1].0[lane]) = (e.re, e.im);
                (block[2].0[lane], block[3].0[lane]) = (u.re, u.im);
            }
            block
        };
        Blocks(positions.chunks(LANES).map(block).collect())
    }

    pub(in crate::task::forms) fn scatter(&self, positions: &mut [[Complex; 2]]) {
        for (part, [ex, ey, ux, uy]) in positions.chunks_mut(LANES).zip(&self.0) {
            for (lane, position) in part.iter_mut().enumerate() {
                *position = [Complex::new(ex.0[lane], ey.0[lane]), Complex::new(ux.0[lane], uy.0[lane])];
            }
        }
    }

    /// Moves each position along its own curve by `forward` tau.
    #[inline(always)]
    pub(in crate::task::forms) fn step(&mut self, on: &impl Curve, forward: f64, tau: &[f64]) {
        for (tau, block) in tau.chunks(LANES).zip(&mut self.0) {
            let mut steps = F64x8::splat(tau[tau.len() - 1]);
            steps.0[..tau.len()].copy_from_slice(tau);
            let [ex, ey, ux, uy] = *block;
            let (_, by_e, by_u) = on.frame([ex, ey, ux, uy]);
            let step = (F64x8::splat(forward) * steps).over((by_e * by_e + by_u * by_u).sqrt());
            let (ex, ey) = turn(ex, ey, step * by_u);
            let (ux, uy) = turn(ux, uy, -step * by_e);
            *block = [ex, ey, ux, uy];
        }
    }

    /// Brings the positions back to their curves by least-norm Newton steps of at most a radian; `false` if one does
    /// not get there.
    #[inline(always)]
    pub(in crate::task::forms) fn settle(&mut self, on: &impl Curve) -> bool {
        let (near, one) = (on.near(), F64x8::splat(1.0));
        let mut limit = near;
        for round in 0..=RETURN_STEPS {
            let mut off = false;
            for block in &self.0 {
                off |= on.frame(*block).0.abs().any_above(limit);
            }
            if !off {
                return true;
            }
            if round == RETURN_STEPS {
                break;
            }
            for block in &mut self.0 {
                let [ex, ey, ux, uy] = *block;
                let (miss, by_e, by_u) = on.frame([ex, ey, ux, uy]);
                let n2 = by_e * by_e + by_u * by_u;
                let long = (miss * miss).over(n2).sqrt();
                let step = (-miss).over(n2 * long.at_least(one, long, one));
                let step = F64x8::splat(near).at_least(miss.abs(), F64x8::splat(0.0), step);
                let (ex, ey) = turn(ex, ey, step * by_e);
                let (ux, uy) = turn(ux, uy, step * by_u);
                *block = [ex, ey, ux, uy];
            }
            if round + 2 == RETURN_STEPS {
                // Rounding may keep a position from the last digit.
                limit = 16.0 * near;
            }
        }
        false
    }
}
