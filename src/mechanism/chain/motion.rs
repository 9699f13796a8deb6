//! Velocity and acceleration of every point of a chain, by differentiating each stage once and twice.
//!
//! With N' for dN/dt, n the normal i u of a line and p, q the points to which a stage is attached:
//!
//! ```text
//! crank    C' = i omega (C - A)                     C'' = (i alpha - omega^2)(C - A)
//! dyad     <N - p, N' - p'> = 0                     <N - p, N'' - p''> = -|N' - p'|^2;   q alike
//! point    N' = p' + z (q' - p')                    N'' = p'' + z (q'' - p'')
//! slider   <N - p, N' - p'> = 0                     as the dyad, and, on the line O + x u,
//!          <n, N' - O'> = -<n', N - O>              <n, N'' - O''> = -2 <n', N' - O'> - <n'', N - O>
//! guide    theta' = <i u, V'>/x                     theta'' = (<i u, V''> + theta'^2 f - 2 theta' x')/x
//!          N' = p' + i theta' (N - p)               N'' = p'' + (i theta'' - theta'^2)(N - p)
//! ```
//!
//! (De Castro's equations 8 to 24 in natural coordinates, stage by stage; x' = <u, V'> + f theta'.) Dyad and
//! slider are 2x2 systems whose determinant is the sine of the stage's transmission angle times its lengths.
//! If that sine is zero, the stage is at a toggle and has no velocity: the answer is singular.

use super::{Chain, Line, Outcome, PointId, Pose, Step, guide};
use crate::mechanism::{Complex, FLAT_TOLERANCE, MAX_MAGNITUDE, cross, dot, turned};

/// The squared sine of a stage's transmission angle at and below which it is at a toggle: there the position
/// solver takes the stage as flat ([`FLAT_TOLERANCE`]), and a root of rounding errors is no derivative.
pub const TOGGLE_SINE_SQ: f64 = FLAT_TOLERANCE;

/// Buffer for the positions, velocities and accelerations of one instant, from [`Chain::motion`].
///
/// Units: length, length/s and length/s^2 for an input in rad/s and rad/s^2.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    pose: Pose,
    velocities: Vec<Complex>,
    accelerations: Vec<Complex>,
    /// Number of points with a known velocity and acceleration.
    known: usize,
}

impl Motion {
    /// Returns the positions; at a toggle they are known although the velocities are not.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Returns the position of a point; `None` for points of and after a stage that has none.
    pub fn point(&self, id: PointId) -> Option<Complex> {
        self.pose.point(id)
    }

    /// Returns the velocity of a point; `None` for points of and after a stage that has none.
    pub fn velocity(&self, id: PointId) -> Option<Complex> {
        self.velocities[..self.known].get(id.0).copied()
    }

    /// Returns the acceleration of a point; `None` for points of and after a stage that has none.
    pub fn acceleration(&self, id: PointId) -> Option<Complex> {
        self.accelerations[..self.known].get(id.0).copied()
    }
}

/// Returns `Some` if sine^2 = `part` / `whole` is above [`TOGGLE_SINE_SQ`]; NaN counts as a toggle.
#[inline(always)]
fn away_from_toggle(part: f64, whole: f64) -> Option<()> {
    (part > TOGGLE_SINE_SQ * whole).then_some(())
}

/// N' and N'' of a stage.
type Derivatives = (Complex, Complex);

/// Returns the x with <a, x> = alpha and <b, x> = beta; `per_cross` is 1/(a x b).
#[inline(always)]
fn solve(a: Complex, b: Complex, per_cross: f64, alpha: f64, beta: f64) -> Complex {
    Complex::new((alpha * b.im - beta * a.im) * per_cross, (beta * a.re - alpha * b.re) * per_cross)
}

/// The points that are known so far, with their velocities and accelerations.
#[derive(Clone, Copy)]
struct Known<'a> {
    points: &'a [Complex],
    velocities: &'a [Complex],
    accelerations: &'a [Complex],
}

impl Known<'_> {
    #[inline(always)]
    fn at(&self, i: usize) -> (Complex, Complex, Complex) {
        (self.points[i], self.velocities[i], self.accelerations[i])
    }
}

impl Chain {
    /// Allocates a buffer for a motion.
    pub fn motion(&self) -> Motion {
        let zero = vec![Complex::new(0.0, 0.0); self.names.len()];
        let known = self.pivots.len();
        Motion { pose: self.pose(), velocities: zero.clone(), accelerations: zero, known }
    }

    /// Computes positions, velocities and accelerations at the crank angle (radians) with the input speed `omega` =
    /// phi' (rad/s) and acceleration `alpha` = phi'' (rad/s^2). Allocates nothing.
    ///
    /// Open and singular as [`Chain::position`]; singular as well at a stage's toggle (squared sine of its
    /// transmission angle at most [`TOGGLE_SINE_SQ`]): all positions are known there, and the velocities of
    /// the points before it. No answer holds a NaN or an infinity.
    ///
    /// ```
    /// # use linkwright::{AssemblyMode, ChainBuilder};
    /// # use linkwright::internals::mechanism::chain::Outcome;
    /// // In line, crank 3, rod 5: upright, the slider runs at omega * 3 and the rod doesn't turn.
    /// let chain = ChainBuilder::new().pivot("A", [0.0, 0.0]).crank("A", "B", 3.0)
    ///     .slider("C", "B", 5.0, [0.0, 0.0], 0.0, AssemblyMode::Plus).build()?;
    /// let mut motion = chain.motion();
    /// assert_eq!(chain.move_at(90f64.to_radians(), 2.0, 0.0, &mut motion), Outcome::Closed);
    /// assert!((motion.velocity(chain.trace()).unwrap().re + 6.0).abs() < 1e-14);
    /// # Ok::<(), Box<linkwright::internals::mechanism::chain::ChainError>>(())
    /// ```
    ///
    /// # Panics
    /// When `motion` is of a chain with another number of points.
    pub fn move_at(&self, crank_angle: f64, omega: f64, alpha: f64, motion: &mut Motion) -> Outcome {
        let fixed = self.pivots.len();
        motion.known = fixed;
        let position = self.position(crank_angle, &mut motion.pose);
        let usable = |x: f64| x.abs() <= MAX_MAGNITUDE;
        if position == Outcome::InputNotUsable || !usable(omega) || !usable(alpha) {
            return Outcome::InputNotUsable;
        }
        let points = motion.pose.known();
        let crank = points[fixed] - points[self.crank_pivot];
        motion.velocities[fixed] = turned(crank) * omega;
        motion.accelerations[fixed] = turned(crank) * alpha - crank * (omega * omega);
        motion.known = fixed + 1;
        for (stage, step) in self.steps.iter().enumerate().take(points.len() - fixed - 1) {
            let new = fixed + 1 + stage;
            let known =
                Known { points, velocities: &motion.velocities, accelerations: &motion.accelerations };
            let made = self.differentiate(step, points[new], known);
            match made {
                Some((v, a)) if [v.re, v.im, a.re, a.im].iter().all(|x| x.is_finite()) => {
                    (motion.velocities[new], motion.accelerations[new]) = (v, a);
                    motion.known = new + 1;
                }
                _ => return Outcome::Singular { stage },
            }
        }
        position
    }

    /// Computes N' and N'' of one stage; `None` at its toggle.
    #[inline(always)]
    fn differentiate(&self, step: &Step, n: Complex, known: Known<'_>) -> Option<Derivatives> {
        match *step {
            Step::Dyad { p, q, sine_per_cross, .. } => {
                let ((p, p_v, p_a), (q, q_v, q_a)) = (known.at(p), known.at(q));
                let (a, b) = (n - p, n - q);
                let det = cross(a, b);
                let sine = det * sine_per_cross;
                away_from_toggle(sine * sine, 1.0)?;
                let per = 1.0 / det;
                let v = solve(a, b, per, dot(a, p_v), dot(b, q_v));
                let turning = |end_v: Complex| dot(v - end_v, v - end_v);
                let acceleration = solve(a, b, per, dot(a, p_a) - turning(p_v), dot(b, q_a) - turning(q_v));
                Some((v, acceleration))
            }
            Step::Point { p, q, z } => {
                let ((_, p_v, p_a), (_, q_v, q_a)) = (known.at(p), known.at(q));
                Some((p_v + z * (q_v - p_v), p_a + z * (q_a - p_a)))
            }
            Step::Slider { p, length_sq, line, .. } => {
                let (p, p_v, p_a) = known.at(p);
                let MovingLine { origin: [o, o_v, o_a], direction: [u, u_v, u_a] } = line.motion(known);
                let (a, normal) = (n - p, turned(u));
                let det = cross(a, normal);
                away_from_toggle(det * det, length_sq)?;
                let per = 1.0 / det;
                let [n_v, n_a] = [turned(u_v), turned(u_a)];
                let v = solve(a, normal, per, dot(a, p_v), dot(normal, o_v) - dot(n_v, n - o));
                let acceleration = solve(
                    a,
                    normal,
                    per,
                    dot(a, p_a) - dot(v - p_v, v - p_v),
                    dot(normal, o_a) - 2.0 * dot(n_v, v - o_v) - dot(n_a, n - o),
                );
                Some((v, acceleration))
            }
            Step::Guide { p, q, offset, t, .. } => {
                let ((p, p_v, p_a), (q, q_v, q_a)) = (known.at(p), known.at(q));
                let v = q - p;
                let (along, u) = guide(v, offset, t, self.coincident_sq).ok()?;
                away_from_toggle(along * along, dot(v, v))?;
                let per = 1.0 / along;
                let (v_v, v_a) = (q_v - p_v, q_a - p_a);
                let theta_v = dot(turned(u), v_v) * per;
                let along_v = dot(u, v_v) + offset * theta_v;
                let theta_a =
                    (dot(turned(u), v_a) + theta_v * theta_v * offset - 2.0 * theta_v * along_v) * per;
                let arm = n - p;
                Some((p_v + turned(arm) * theta_v, p_a + turned(arm) * theta_a - arm * (theta_v * theta_v)))
            }
        }
    }
}

/// A line O + x u in motion: O, O', O'' and u, u', u''.
struct MovingLine {
    origin: [Complex; 3],
    direction: [Complex; 3],
}

impl Line {
    #[inline(always)]
    fn motion(&self, known: Known<'_>) -> MovingLine {
        let zero = Complex::new(0.0, 0.0);
        match *self {
            Line::Fixed { origin, direction } => {
                MovingLine { origin: [origin, zero, zero], direction: [direction, zero, zero] }
            }
            Line::OnLink { p, q, per_length, offset } => {
                let ((p, p_v, p_a), (q, q_v, q_a)) = (known.at(p), known.at(q));
                let direction = [(q - p) * per_length, (q_v - p_v) * per_length, (q_a - p_a) * per_length];
                let [u, u_v, u_a] = direction;
                MovingLine {
                    origin: [p + turned(u) * offset, p_v + turned(u_v) * offset, p_a + turned(u_a) * offset],
                    direction,
                }
            }
        }
    }
}
