//! Loop-closure methods of position analysis from the literature, as reference solvers beside the natural coordinates
//! of `position.rs`.
//!
//! All three close the same loop, C + b e^{i theta3} = B + c e^{i theta4} (De Castro, equations 2 and 3):
//!
//! | method | source | both assemblies | singular |
//! |---|---|---|---|
//! | [`FourBar::close_by_algebra`] | Norton 4.2d to 4.2g (UTP, chapter 4) | yes | C straight over B: Ax = d |
//! | [`FourBar::close_by_complex_numbers`] | UTP, chapter 4: quadratic in e^{i theta4} | yes | Z = 0: C on B |
//! | [`FourBar::close_by_iteration`] | De Castro 4 and 5 | the one it falls into | slow towards a toggle |
//!
//! # Agreement with the natural coordinates
//! D solves |D - C| = b, |D - B| = c, a system whose inverse is at most (b + c)/(b c sin mu), mu the
//! transmission angle, and squares are rounded to eps scale^2. So two sound solvers agree in D within
//!
//! ```text
//! K eps scale^2 (b + c)/(b c sin mu),      scale = |A| + |B| + a + b + c + d + e,   K = 32
//! ```
//!
//! That holds for the complex quadratic. The algebraic method divides by Ax - d first and loses the further
//! factor (s/(Ax - d))^2, s = |CB|; the iteration is within b tolerance/sin^2 mu.

use crate::mechanism::{AssemblyMode, Complex, FLAT_TOLERANCE, FourBar, Joints, cross};

/// Largest |Ax - d|, as a part of s = |CB|, at which the algebraic method gives no answer: its error grows with
/// (s/(Ax - d))^2, here to 1e8 times that of the other methods, and half the digits are gone.
pub const ALGEBRAIC_SINGULAR: f64 = 1e-4;

/// One position that closes the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopRoot {
    /// t1, the assembly mode of the position. At a toggle, where the two positions meet, the first root has Plus.
    pub assembly: AssemblyMode,
    /// C, D and P.
    pub joints: Joints,
    /// theta3 = arg(D - C), radians in (-pi, pi].
    pub coupler_angle: f64,
    /// theta4 = arg(D - B), radians in (-pi, pi].
    pub follower_angle: f64,
    /// The closure error: the larger of ||D - C| - b| and ||D - B| - c|, a length.
    pub residual: f64,
}

/// The singularity of a formula that has no answer although the linkage may have a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// The crank pin lies straight over or under the follower pivot, seen along the ground line: Ax = d
    /// within [`ALGEBRAIC_SINGULAR`], and (4.2d) divides by Ax - d.
    CrankPinOverFollowerPivot,
    /// The crank pin lies on the follower pivot: Z = 0, and the quadratic loses its leading coefficient. The
    /// position is undetermined (b = c) or there is none.
    CrankPinOnFollowerPivot,
}

/// Result of a closed-form method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoopRoots {
    /// The two positions, t1 = +1 first; equal at a toggle.
    Closed([LoopRoot; 2]),
    /// No position closes the loop (or the crank angle is no number).
    Open,
    /// The formula is singular and decides nothing.
    Singular(Singularity),
}

impl LoopRoots {
    /// Returns the position with the given assembly mode, if the loop closes.
    pub fn root(self, assembly: AssemblyMode) -> Option<LoopRoot> {
        match self {
            LoopRoots::Closed(roots) => roots.into_iter().find(|root| root.assembly == assembly),
            LoopRoots::Open | LoopRoots::Singular(_) => None,
        }
    }
}

/// Form of the arctangent in equations 4 and 5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arctangent {
    /// atan2: the quadrant is that of numerator and denominator.
    TwoArguments,
    /// Arctangent of the quotient, as printed: angles in [-90, 90] degrees only. The iteration then cycles or settles
    /// on false points (De Castro's example 2.1 at 90 degrees: 63.43, 63.43). For demonstration.
    OfQuotient,
}

/// Options of the fixed-point iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IterationOptions {
    /// Start value of theta3, radians. A start on the line C-B stays on it: see [`IterationVerdict::FalsePoint`].
    pub start_coupler_angle: f64,
    /// Largest step of theta3, radians, that counts as converged; raised to 4 eps if it is less.
    pub tolerance: f64,
    /// Maximum number of rounds of equations 4 and 5.
    pub iterations: u32,
    /// Form of the arctangent.
    pub arctangent: Arctangent,
}

impl Default for IterationOptions {
    /// Returns the defaults: start at theta3 = 1 radian (an angle that seldom lies on the line C-B), tolerance 1e-12
    /// radians, 10,000 rounds, atan2.
    fn default() -> Self {
        IterationOptions {
            start_coupler_angle: 1.0,
            tolerance: 1e-12,
            iterations: 10_000,
            arctangent: Arctangent::TwoArguments,
        }
    }
}

/// Outcome of the fixed-point iteration. With L = a + b + c + |AB|:
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IterationVerdict {
    /// The step is within the tolerance and the loop closes within tolerance L.
    Converged(LoopRoot),
    /// The step is within the tolerance, but the loop misses closure by more than sqrt(tolerance) L: a start
    /// on the line C-B, a loop that cannot close, or arctangents of quotients. (Next to a toggle a step of
    /// tolerance leaves a residual of tolerance^(2/3) L at most, so that it is not called false.)
    FalsePoint,
    /// theta3 came back to an earlier value, within the tolerance, while still moving.
    Cycling,
    /// No such result within the allowed rounds: next to a toggle the iteration is slow.
    NotConverged,
    /// A vector without a direction: its length is zero, or the crank angle or the start is no number.
    NoDirection,
}

/// A run of the fixed-point iteration: its outcome and its last values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// The outcome of the run.
    pub verdict: IterationVerdict,
    /// The last theta3, radians.
    pub coupler_angle: f64,
    /// The last theta4, radians.
    pub follower_angle: f64,
    /// Number of rounds of equations 4 and 5.
    pub iterations: u32,
    /// The last step of theta3, radians; infinite before the first.
    pub step: f64,
    /// The closure error |C + b e^{i theta3} - B - c e^{i theta4}|, a length.
    pub residual: f64,
}

impl Iteration {
    /// Returns the position if the iteration converged to one.
    pub fn root(&self) -> Option<LoopRoot> {
        match self.verdict {
            IterationVerdict::Converged(root) => Some(root),
            _ => None,
        }
    }
}

impl FourBar {
    fn crank_pin_at(&self, crank_angle: f64) -> Complex {
        self.crank_pivot() + Complex::from_polar(self.crank(), crank_angle)
    }

    fn loop_root(&self, crank_pin: Complex, follower_pin: Complex, assembly: AssemblyMode) -> LoopRoot {
        let w = follower_pin - crank_pin;
        let r = follower_pin - self.follower_pivot();
        LoopRoot {
            assembly,
            joints: Joints { crank_pin, follower_pin, coupler_point: crank_pin + self.coupler_ratio() * w },
            coupler_angle: w.arg(),
            follower_angle: r.arg(),
            residual: (w.norm() - self.coupler()).abs().max((r.norm() - self.follower()).abs()),
        }
    }

    /// Computes both positions by Norton's algebra (4.2d to 4.2g), in the frame with A at the origin and B at (d, 0).
    ///
    /// ```text
    /// S = (a^2 - b^2 + c^2 - d^2)/(2 (Ax - d))       P = Ay^2/(Ax - d)^2 + 1
    /// Q = 2 Ay (d - S)/(Ax - d)                      R = (d - S)^2 - c^2
    /// By = (-Q +- sqrt(Q^2 - 4 P R))/(2 P)           Bx = S - Ay By/(Ax - d)
    /// theta3 = atan2(By - Ay, Bx - Ax)               theta4 = atan2(By, Bx - d)
    /// ```
    ///
    /// In these equations A and B are the pins (C and D here), d is the ground. P, Q and the quotient of By are written
    /// as they are meant: the chapter's MATLAB lines misplace two parentheses, and (4.2g) needs atan2.
    ///
    /// Singular if Ax = d, a limit of the method and not of the linkage; next to it the error is (s/(Ax - d))^2 times
    /// the bound in the module's documentation. Open if Q^2 - 4 P R < 0, beyond rounding and [`FLAT_TOLERANCE`].
    pub fn close_by_algebra(&self, crank_angle: f64) -> LoopRoots {
        let ground_direction = Complex::from_polar(1.0, self.ground_angle());
        let (a, b, c, d) = (self.crank(), self.coupler(), self.follower(), self.ground());
        let crank_pin = self.crank_pin_at(crank_angle);
        let local = (crank_pin - self.crank_pivot()) * ground_direction.conj();
        let (ax, ay) = (local.re, local.im);
        let over = ax - d;
        let distance = over.hypot(ay); // |CB|
        if !distance.is_finite() {
            return LoopRoots::Open;
        }
        if over.abs() <= ALGEBRAIC_SINGULAR * distance {
            return LoopRoots::Singular(if distance == 0.0 {
                Singularity::CrankPinOnFollowerPivot
            } else {
                Singularity::CrankPinOverFollowerPivot
            });
        }
        let s = (a * a - b * b + c * c - d * d) / (2.0 * over);
        let p = ay * ay / (over * over) + 1.0;
        let q = 2.0 * ay * (d - s) / over;
        let r = (d - s) * (d - s) - c * c;
        let discriminant = q * q - 4.0 * p * r; // = 4 P h1^2
        let slack = 4.0 * p * (FLAT_TOLERANCE * b * b + 16.0 * f64::EPSILON * p * c * c);
        let closes = discriminant >= -slack; // false for NaN too
        if !closes {
            return LoopRoots::Open;
        }
        let root = discriminant.max(0.0).sqrt();
        let at = |sign: f64, assembly| {
            let by = (-q + sign * root) / (2.0 * p);
            let bx = s - ay * by / over;
            let follower_pin = self.crank_pivot() + ground_direction * Complex::new(bx, by);
            self.loop_root(crank_pin, follower_pin, assembly)
        };
        // The larger By lies left of C -> B if that points to +x, which is so if Ax < d.
        let left = if over < 0.0 { 1.0 } else { -1.0 };
        LoopRoots::Closed([at(left, AssemblyMode::Plus), at(-left, AssemblyMode::Minus)])
    }

    /// Computes both positions by complex numbers: the quadratic in t = e^{i theta4} of the UTP chapter.
    ///
    /// ```text
    /// Z = d e^{i theta1} - a e^{i theta2}                            (= B - C)
    /// conj(Z) c t^2 + (Z conj(Z) + c^2 - b^2) t + Z c = 0,           s = e^{i theta3} = (Z + c t)/b
    /// ```
    ///
    /// It uses conj(s) = 1/s and conj(t) = 1/t (of Z that is false: the slide's note lost its bar). If the loop closes,
    /// the discriminant m^2 - 4 c^2 |Z|^2, m = |Z|^2 + c^2 - b^2, is not positive and both roots have modulus 1; if it
    /// is positive (beyond rounding and [`FLAT_TOLERANCE`]), the moduli are not 1 and the loop is open. It is singular
    /// if Z = 0.
    pub fn close_by_complex_numbers(&self, crank_angle: f64) -> LoopRoots {
        let (b, c) = (self.coupler(), self.follower());
        let crank_pin = self.crank_pin_at(crank_angle);
        let z = self.follower_pivot() - crank_pin;
        let z_sq = z.norm_sqr();
        if !z_sq.is_finite() {
            return LoopRoots::Open;
        }
        if z_sq == 0.0 {
            return LoopRoots::Singular(Singularity::CrankPinOnFollowerPivot);
        }
        let m = z_sq + c * c - b * b;
        let discriminant = m * m - 4.0 * c * c * z_sq; // = -4 s^2 h1^2
        let slack = 4.0 * z_sq * (FLAT_TOLERANCE * b * b + 16.0 * f64::EPSILON * c * c);
        let closes = discriminant <= slack; // false for NaN too
        if !closes {
            return LoopRoots::Open;
        }
        let root = Complex::new(0.0, (-discriminant).max(0.0).sqrt());
        let at = |sign: f64, assembly| {
            let t = (root * sign - m) / (z.conj() * (2.0 * c));
            self.loop_root(crank_pin, self.follower_pivot() + t * c, assembly)
        };
        LoopRoots::Closed([at(1.0, AssemblyMode::Plus), at(-1.0, AssemblyMode::Minus)])
    }

    /// Computes one position by De Castro's fixed-point iteration (equations 4 and 5), from a first theta3.
    ///
    /// ```text
    /// theta4 = arg(C + b e^{i theta3} - B)       (4)
    /// theta3 = arg(B + c e^{i theta4} - C)       (5)
    /// ```
    ///
    /// arg is atan2 (or, to see the effect of the printed arctan, [`Arctangent::OfQuotient`]). Near a position each
    /// round takes the error times cos^2(theta3 - theta4): slow next to a toggle, and a step delta leaves an error of
    /// delta/sin^2(theta3 - theta4). A small step is no proof of closure: the line C-B holds fixed points at which the
    /// loop is open, and the residual tells them apart. Both positions attract; the one that is reached depends on the
    /// start and is reported, whatever the linkage's own t1.
    pub fn close_by_iteration(&self, crank_angle: f64, options: &IterationOptions) -> Iteration {
        let (b, c) = (self.coupler(), self.follower());
        let crank_pin = self.crank_pin_at(crank_angle);
        let to_pivot = self.follower_pivot() - crank_pin;
        let tolerance = options.tolerance.max(4.0 * f64::EPSILON);
        let length = self.crank() + b + c + self.ground();
        let mut coupler = Complex::from_polar(1.0, options.start_coupler_angle);
        let mut follower = coupler;
        let mut earlier = coupler; // Brent's cycle search: the value at the last power of two
        let mut step = f64::INFINITY;
        let mut residual = f64::INFINITY;
        let mut rounds = 0;
        let verdict = loop {
            if rounds >= options.iterations {
                break IterationVerdict::NotConverged;
            }
            let next_follower = direction(coupler * b - to_pivot, options.arctangent);
            let next_coupler = next_follower.and_then(|f| direction(to_pivot + f * c, options.arctangent));
            let Some((next_follower, next_coupler)) = next_follower.zip(next_coupler) else {
                break IterationVerdict::NoDirection;
            };
            rounds += 1;
            step = (next_coupler - coupler).norm();
            (coupler, follower) = (next_coupler, next_follower);
            residual = (coupler * b - to_pivot - follower * c).norm();
            if step <= tolerance {
                if residual <= tolerance * length {
                    let follower_pin = self.follower_pivot() + follower * c;
                    let assembly = AssemblyMode::of(cross(to_pivot, follower_pin - crank_pin));
                    break IterationVerdict::Converged(self.loop_root(crank_pin, follower_pin, assembly));
                }
                if residual > tolerance.sqrt() * length {
                    break IterationVerdict::FalsePoint;
                }
            } else if (coupler - earlier).norm() <= tolerance {
                break IterationVerdict::Cycling;
            }
            if rounds.is_power_of_two() {
                earlier = coupler;
            }
        };
        Iteration {
            verdict,
            coupler_angle: coupler.arg(),
            follower_angle: follower.arg(),
            iterations: rounds,
            step,
            residual,
        }
    }
}

/// Returns e^{i angle} of a vector; `None` if it has no direction.
fn direction(vector: Complex, arctangent: Arctangent) -> Option<Complex> {
    let norm = vector.norm();
    if !(norm > 0.0 && norm.is_finite()) {
        return None;
    }
    let unit = vector / norm;
    Some(if arctangent == Arctangent::OfQuotient && unit.re < 0.0 { -unit } else { unit })
}
