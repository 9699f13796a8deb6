//! Poses of a body that runs along an ellipse and turns: a problem with three rows a point and own unknowns, for the tests
//! of the block least-squares solvers, and its optima by nested line searches without a derivative.

use super::levenberg_marquardt::{BlockLeastSquares, ConstraintRow, EachConstraint, MOST_OWN, PointBlock};
use linkwright_arithmetic::streams::{stream, uniform};

/// The shared unknowns: the ellipse's centre (x, y), its half width, and the body's angle at s = 0.
pub type Shared = [f64; 4];

/// Half height over half width of the ellipse.
const FLATNESS: f64 = 0.6;
/// Turn of the body over the change of s.
const TURN: f64 = 0.5;
/// Weight of the angle, a length.
const REACH: f64 = 0.8;

/// An inequality g >= 0 with its gradient by the shared unknowns and its derivative by the own unknown of a point.
pub struct Limit {
    pub constant: f64,
    pub gradient: Shared,
    pub own: Option<(usize, f64)>,
}

/// The fit of poses (x, y, angle).
pub struct Poses {
    pub bounds: [(f64, f64); 4],
    pub targets: Vec<[f64; 3]>,
    pub weights: Vec<f64>,
    pub limits: Vec<Limit>,
    /// Whether the own unknowns have to ascend.
    pub ordered: bool,
    /// A factor of the angle's derivatives: 1 is right.
    pub sabotage: f64,
}

/// The poses' own unknowns without noise, and the shared unknowns.
pub const TRUTH: Shared = [0.3, -0.2, 1.1, 0.4];

pub fn truth_at(j: usize, count: usize) -> f64 {
    0.2 + 2.2 * j as f64 / (count - 1) as f64
}

impl Poses {
    /// Draws poses near the truth; x and y of the centre are fixed to it.
    pub fn drawn(count: usize, noise: f64) -> Self {
        let mut draws = stream(7, count as u64);
        let target = |j| {
            let place = Poses::at(&TRUTH, truth_at(j, count));
            place.map(|v| v + uniform(&mut draws, -noise, noise))
        };
        Poses {
            bounds: [(0.3, 0.3), (-0.2, -0.2), (0.2, 3.0), (-2.0, 2.0)],
            targets: (0..count).map(target).collect(),
            weights: (0..count).map(|j| 1.0 + 0.3 * (j % 4) as f64).collect(),
            limits: Vec::new(),
            ordered: false,
            sabotage: 1.0,
        }
    }

    fn at(x: &Shared, s: f64) -> [f64; 3] {
        [x[0] + x[2] * s.cos(), x[1] + FLATNESS * x[2] * s.sin(), x[3] + TURN * s]
    }

    /// Returns a start off the truth, with the own unknowns of the truth.
    pub fn start(&self) -> (Shared, Vec<f64>) {
        let n = self.targets.len();
        ([0.3, -0.2, 1.3, 0.25], (0..n).map(|j| truth_at(j, n)).collect())
    }

    /// Computes the residual of point j at its own unknown s.
    pub fn residual(&self, x: &Shared, j: usize, s: f64) -> [f64; 3] {
        let (target, at) = (self.targets[j], Poses::at(x, s));
        [target[0] - at[0], target[1] - at[1], REACH * (target[2] - at[2])]
    }

    /// Computes the deviation of point j: the larger of place and angle over their tolerances.
    pub fn deviation(&self, x: &Shared, j: usize, s: f64, tolerances: &[f64]) -> f64 {
        let r = self.residual(x, j, s);
        (r[0].hypot(r[1]) / tolerances[2 * j]).max(r[2].abs() / tolerances[2 * j + 1])
    }

    pub fn squares(&self, x: &Shared, j: usize, s: f64) -> f64 {
        self.weights[j] * self.residual(x, j, s).iter().map(|r| r * r).sum::<f64>()
    }

    /// Computes by nested line searches the least over the half width and the angle of a reduction of the points'
    /// parts, each at its own best s where the limits of [`Poses::limits`] allow it.
    pub fn by_line_searches(
        &self,
        part: impl Fn(&Shared, usize, f64) -> f64,
        reduce: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        let n = self.targets.len();
        let best_own = |x: &Shared, j: usize| {
            let middle = truth_at(j, n);
            let (mut low, mut high) = (middle - 0.5, middle + 0.5);
            for limit in &self.limits {
                let Some((_, by)) = limit.own.filter(|(of, _)| *of == j) else { continue };
                let at = -limit.shared(x) / by;
                (low, high) = if by > 0.0 { (low.max(at), high) } else { (low, high.min(at)) };
            }
            if low > high { f64::INFINITY } else { least(low, high, |s| part(x, j, s)) }
        };
        let [.., (low_width, high_width), (low_angle, high_angle)] = self.bounds;
        let total = |width, angle| {
            let x = [self.bounds[0].0, self.bounds[1].0, width, angle];
            (0..n).map(|j| best_own(&x, j)).fold(0.0, &reduce)
        };
        least(low_width.max(0.9), high_width.min(1.3), |width| {
            least(low_angle.max(0.2), high_angle.min(0.6), |angle| total(width, angle))
        })
    }
}

impl Limit {
    fn shared(&self, x: &Shared) -> f64 {
        self.constant + self.gradient.iter().zip(x).map(|(by, v)| by * v).sum::<f64>()
    }
}

/// Computes the least value of a function with one minimum, by the golden section.
pub fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (f(left), f(right));
    let mut best = f(low).min(f(high));
    for _ in 0..55 {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = f(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = f(right);
        }
        best = best.min(at_left).min(at_right);
    }
    best
}

impl BlockLeastSquares<4, 3> for Poses {
    type State = Vec<f64>;

    fn points(&self) -> usize {
        self.targets.len()
    }

    fn bounds(&self) -> &[(f64, f64); 4] {
        &self.bounds
    }

    fn cost(&self, x: &Shared, state: &Vec<f64>) -> Option<f64> {
        let cost: f64 = state.iter().enumerate().map(|(j, s)| self.squares(x, j, *s)).sum();
        cost.is_finite().then_some(cost)
    }

    fn linearise(&self, x: &Shared, state: &Vec<f64>, each: &mut dyn FnMut(&PointBlock<4, 3>)) -> bool {
        for (j, s) in state.iter().enumerate() {
            let angle = REACH * self.sabotage;
            each(&PointBlock {
                residual: self.residual(x, j, *s),
                jacobian: [
                    [-1.0, 0.0, -s.cos(), 0.0],
                    [0.0, -1.0, -FLATNESS * s.sin(), 0.0],
                    [0.0, 0.0, 0.0, -angle],
                ],
                tangent: [x[2] * s.sin(), -FLATNESS * x[2] * s.cos(), -angle * TURN],
                weight: self.weights[j],
            });
        }
        true
    }

    fn retract(&self, _: &Shared, state: &Vec<f64>, tau: &[f64], _: &Shared, out: &mut Vec<f64>) -> bool {
        *out = state.iter().zip(tau).map(|(s, tau)| s + tau).collect();
        true
    }

    fn gaps(&self, _: &Shared, state: &Vec<f64>, gaps: &mut Vec<f64>) -> bool {
        if self.ordered {
            let n = state.len();
            let turn = |j: usize| if j + 1 == n { std::f64::consts::TAU } else { 0.0 };
            gaps.extend((0..n).map(|j| state[(j + 1) % n] - state[j] + turn(j)));
        }
        self.ordered
    }

    fn join(&self, state: &mut Vec<f64>, leaders: &[usize]) {
        let before = state.clone();
        state.iter_mut().zip(leaders).for_each(|(s, leader)| *s = before[*leader]);
    }

    fn constraints(&self, x: &Shared, state: &Vec<f64>, each: &mut EachConstraint<'_, 4>) {
        for limit in &self.limits {
            let value = limit.shared(x) + limit.own.map_or(0.0, |(j, by)| by * state[j]);
            let mut own = [None; MOST_OWN];
            own[0] = limit.own;
            each(value, &|| ConstraintRow { value, gradient: limit.gradient, own });
        }
    }
}
