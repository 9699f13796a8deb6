//! The check of a box if K is a real length: crank angles from the x axis.
//!
//! In the frame of T, e and u of docs/certificate.md the sum of squares is at least L exactly where
//! X^2 + Y^2 >= L W^2; X cos a + Y sin a >= L^(1/2) W is enough, at any angle a. The functions are [`Model`]s.

use super::claim::{Claim, Direction, functional, witness, witness_slack};
use super::frame::Frame;
use super::interval::Interval;
use super::model::{Model, UP};
use linkwright_leaves::{Axis, Class};

/// Returns a lower bound of the least and an upper bound of the greatest length of a crank, over a range of p.
pub(super) fn crank_lengths(axis: &Axis, class: Class, p: Interval) -> [f64; 2] {
    let p = Interval { low: p.low.max(0.0), high: p.high.min(1.0) };
    let [low, high] = axis.lengths.ground.map(|length| Interval {
        low: length * (1.0 - 4.0 * f64::EPSILON),
        high: length * (1.0 + 4.0 * f64::EPSILON),
    });
    let (least, greatest) = match class {
        Class::CrankRocker => ((low * Interval::exact(p.low)).low, (high * Interval::exact(p.high)).high),
        Class::DoubleCrank => (low.over(Interval::exact(p.high)).low, high.over(Interval::exact(p.low)).high),
    };
    // A limit that is not known excludes nothing.
    let least = if least.is_finite() { least } else { 0.0 };
    let greatest = if greatest.is_nan() { f64::INFINITY } else { greatest };
    [axis.lengths.crank[0].max(least), axis.lengths.crank[1].min(greatest)]
}

/// Returns the square root of a model of a number in [0, `most`].
fn root(x: &Model, most: Interval) -> Model {
    x.times(Interval::exact(1.0).over(most)).root().times(most.root())
}

/// The functions of a box that do not depend on the length of the crank.
struct Parts {
    /// Re <y, u>.
    beta: Model,
    v: [Model; 2],
    alpha: [Model; 2],
    /// |u'|^2; `across_sq` is the part of it across e'.
    length_sq: Model,
    across_sq: Model,
    along: [Model; 2],
    s: Interval,
    n: Interval,
}

impl Parts {
    fn new(frame: &Frame, at_origin: bool, at: &[&Option<Direction>]) -> Self {
        let y = witness(frame, at);
        // No longer than 1.
        let y: Vec<[f64; 2]> = y.iter().map(|y| y.map(|y| y * (1.0 - 1e-13))).collect();
        let n = Interval::exact(at.len() as f64);
        let slack = frame.error * n.root().high * UP;
        let [beta, _] = functional(&y, at, witness_slack(frame, &y));
        let [v, alpha] = [1, 2].map(|k: usize| functional(&frame.basis[k], at, slack));
        let mut length_sq = Model::constant(n);
        if !at_origin {
            let [re, im] = functional(&frame.basis[0], at, slack);
            length_sq = length_sq.minus(&re.square()).minus(&im.square());
        }
        let across_sq = length_sq.minus(&v[0].square()).minus(&v[1].square());
        let along = frame.along.map(Model::constant);
        Parts { beta, v, alpha, length_sq, across_sq, along, s: frame.size_sq.root(), n }
    }

    /// Returns conj(alpha) v.
    fn across_and_along(&self) -> [Model; 2] {
        let (a, v) = (&self.alpha, &self.v);
        [v[0].by(&a[0]).plus(&v[1].by(&a[1])), v[1].by(&a[0]).minus(&v[0].by(&a[1]))]
    }

    /// Returns whether the claim is shown to hold over all lengths of the crank.
    fn any_length(&self, claim: f64, cost: &mut [f64; 4]) -> bool {
        let [_, aside] = self.across_and_along();
        let x = self.beta.by(&root(&self.length_sq, self.n)).times(self.s);
        let y = self.along[1].by(&self.across_sq).minus(&aside.times(self.s));
        holds(&x, &y, &self.across_sq.by(&self.length_sq), claim, cost)
    }

    /// Returns w = <e'/|e'|, T> - kappa |e'|.
    fn left(&self, kappa: &Model, crank: Interval) -> [Model; 2] {
        [self.along[0].minus(&kappa.times(crank)), self.along[1]]
    }

    /// Returns whether the claim is shown to hold with the crank of this length.
    fn one_length(&self, w: &[Model; 2], claim: f64, cost: &mut [f64; 4]) -> bool {
        let size_sq = w[0].square().plus(&w[1].square()).plus(&Model::constant(self.s.square()));
        let most = Interval::exact((size_sq.highest() * UP).max(1e-300));
        let x = self.beta.by(&root(&size_sq, most));
        let (a, v) = (&self.alpha, &self.v);
        let re = v[0].times(self.s).minus(&w[0].by(&a[0])).plus(&w[1].by(&a[1]));
        let im = v[1].times(self.s).minus(&w[0].by(&a[1])).minus(&w[1].by(&a[0]));
        let far = re.middle().hypot(im.middle());
        let [cos, sin] = if far > 0.0 { [re.middle() / far, im.middle() / far] } else { [1.0, 0.0] };
        let [cos, sin] = [cos, sin].map(|x| Interval::exact(x * (1.0 - 1e-13)));
        let y = re.times(cos).plus(&im.times(sin));
        holds(&x, &y, &self.length_sq, claim, cost)
    }

    /// Returns whether the best crank is certainly longer (`side` 1) or shorter (-1) than this length everywhere.
    fn beyond(&self, w: &[Model; 2], side: f64) -> bool {
        let [together, _] = self.across_and_along();
        let slope = w[0].by(&self.across_sq).minus(&together.times(self.s));
        slope.times(Interval::exact(side)).lowest() > 0.0
    }
}

/// Returns whether X cos a + Y sin a >= L^(1/2) W on the box, for the angle of its middle.
fn holds(x: &Model, y: &Model, w_sq: &Model, claim: f64, cost: &mut [f64; 4]) -> bool {
    let (cos, sin) = (x.middle().max(0.0), y.middle());
    let size = cos.hypot(sin);
    if size.is_nan() || size <= 0.0 {
        return false;
    }
    let [cos, sin] = [cos, sin].map(|x| Interval::exact(x / size * (1.0 - 1e-13)));
    // W <= W^2/(2 m) + m/2.
    let m = w_sq.middle().max(0.01 * w_sq.highest()).max(1e-12).sqrt();
    let (half, m) = (Interval::exact(0.5), Interval::exact(m));
    let w = w_sq.times(half.over(m)).plus(&Model::constant(half * m));
    let excess = x.times(cos).plus(&y.times(sin)).minus(&w.times(Interval::exact(claim).root()));
    for (k, cost) in cost.iter_mut().enumerate() {
        *cost += excess.change(k);
    }
    excess.lowest() >= 0.0
}

impl Claim {
    /// Returns whether the points of a frame show the claim for crank angles from the x axis; else adds the cost of
    /// each axis to `cost`.
    pub(super) fn holds_on_axis(
        &self,
        frame: &Frame,
        axis: &Axis,
        p: Interval,
        us: &[Option<Direction>],
        cost: &mut [f64; 4],
    ) -> bool {
        let at: Vec<&Option<Direction>> = frame.points.iter().map(|j| &us[*j]).collect();
        let parts = Parts::new(frame, axis.pivot.is_some(), &at);
        let [own, ground] = [axis.lengths.crank, axis.lengths.ground];
        let known = ground[0] == ground[1];
        if !known && parts.any_length(self.claim, cost) {
            return true;
        }
        let by_ground = |length: f64| self.by_ground(length, p);
        if known
            && let Some(kappa) = by_ground(ground[0])
            && parts.one_length(&parts.left(&kappa, frame.crank), self.claim, cost)
        {
            return true;
        }
        for (side, own, ground) in [(-1.0, own[0], ground[0]), (1.0, own[1], ground[1])] {
            let own = own.is_finite().then(|| Model::constant(Interval::exact(own)));
            let ground = if ground.is_finite() && ground > 0.0 { by_ground(ground) } else { None };
            for kappa in [own, ground].into_iter().flatten() {
                let w = parts.left(&kappa, frame.crank);
                if parts.beyond(&w, side) && parts.one_length(&w, self.claim, &mut [0.0; 4]) {
                    return true;
                }
            }
        }
        // |T' - kappa e' - Z u'| >= |<y, T'>| - |Z| |<y, u>| for y = tau and for y along i t E + s tau.
        let (a, v, t) = (&parts.alpha, &parts.v, frame.along[1]);
        let both = [a[0].times(parts.s).plus(&v[1].times(t)), a[1].times(parts.s).minus(&v[0].times(t))];
        let size = (t.square() + parts.s.square()).root();
        let root = Interval::exact(self.claim).root();
        [(parts.s, Interval::exact(1.0), a), (size, size, &both)].into_iter().any(|(length, over, z)| {
            let longest = z[0].square().plus(&z[1].square()).highest();
            let reach = Interval::exact(self.cap) * Interval::exact(longest).root();
            (length - reach.over(over)).low >= root.high
        })
    }

    /// Returns the crank's length that gives the ground this length, over a range of p.
    fn by_ground(&self, length: f64, p: Interval) -> Option<Model> {
        let centre = 0.5 * (p.low + p.high);
        let half = (p.high - centre).max(centre - p.low).next_up();
        let p = Model::variable(centre, half, 0);
        let length =
            Interval { low: length * (1.0 - 4.0 * f64::EPSILON), high: length * (1.0 + 4.0 * f64::EPSILON) };
        match self.class {
            Class::CrankRocker => Some(p.times(length)),
            Class::DoubleCrank => p.square().inverse_root().map(|over| over.times(length)),
        }
    }
}
