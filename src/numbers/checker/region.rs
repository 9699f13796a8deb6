//! The check of one box: a proof that every linkage in it has a sum of squares of at least the claimed one.

use super::claim::{Claim, Direction, functional, witness, witness_slack};
use super::frame::Frame;
use super::interval::Interval;
use super::model::{Model, UP};
use super::real::crank_lengths;
use linkwright_leaves::{Axis, Class};

/// A box of the chart: p, phi_0, g, d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The lower ends of the sides.
    pub low: [f64; 4],
    /// The upper ends of the sides.
    pub high: [f64; 4],
}

impl Region {
    /// Returns both parts along an axis, which meet at `middle`.
    pub fn parts(&self, axis: usize, middle: f64) -> [Region; 2] {
        let (mut lower, mut upper) = (*self, *self);
        lower.high[axis] = middle;
        upper.low[axis] = middle;
        [lower, upper]
    }

    fn side(&self, axis: usize) -> Interval {
        Interval { low: self.low[axis], high: self.high[axis] }
    }

    /// Returns whether no linkage is in it: |d| > min(g, pi - g) everywhere.
    pub fn is_outside(&self) -> bool {
        let (g, d) = (self.side(2), self.side(3));
        let least = d.low.max(-d.high).max(0.0);
        least > g.high || least > (Interval::pi() - g).high
    }

    /// Returns whether |sin g sin d| < p cos d |cos g| everywhere: then the other half of the chart has the cognates
    /// of all its linkages.
    pub fn has_cognates(&self) -> bool {
        let ([cos_g, sin_g], [cos_d, sin_d]) = (self.side(2).cos_sin(), self.side(3).cos_sin());
        let least = |x: Interval| x.low.max(-x.high).max(0.0);
        let right = Interval::exact(self.low[0]) * Interval::exact(least(cos_g)) * Interval::exact(cos_d.low);
        let left = Interval::exact(sin_g.size()) * Interval::exact(sin_d.size());
        cos_d.low > 0.0 && left.high < right.low
    }
}

/// The result for a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shown {
    /// The claim holds on all of it.
    Yes,
    /// The claim is not shown; it may be on the halves across this axis.
    Not(usize),
}

impl Claim {
    /// Returns whether no linkage is in a box: no length of the crank fits, or |d| > min(g, pi - g) everywhere.
    pub fn is_outside(&self, region: &Region) -> bool {
        let excluded = |axis: &Axis| {
            let [least, greatest] = crank_lengths(axis, self.class, region.side(0));
            least > greatest
        };
        region.is_outside() || self.axis.as_ref().is_some_and(excluded)
    }

    /// Returns whether all linkages of a box have cognates in the other half of the chart, with the same crank
    /// angles. These have another A, and a K that is not real if that of the linkage is, so it is false for crank
    /// angles from the x axis.
    pub fn has_cognates(&self, region: &Region) -> bool {
        self.axis.is_none() && region.has_cognates()
    }

    /// Tries to show that the claim holds on a box.
    pub fn look(&self, region: &Region) -> Shown {
        if self.claim <= 0.0 || self.is_outside(region) || self.has_cognates(region) {
            return Shown::Yes;
        }
        let (us, nearest) = self.directions(region);
        let mut cost = [0.0; 4];
        if self.shown(&self.whole, region, &us, &mut cost) {
            return Shown::Yes;
        }
        if let Some((j, f_sq)) = nearest
            && f_sq < 0.25
            && let Some(fewer) = &self.fewer[j]
        {
            cost = [0.0; 4];
            if self.shown(fewer, region, &us, &mut cost) {
                return Shown::Yes;
            }
        }
        for (k, cost) in cost.iter_mut().enumerate() {
            // The widths decide if nothing is known.
            *cost += 1e-6 * (region.high[k] - region.low[k]);
        }
        Shown::Not((0..4).max_by(|&i, &j| cost[i].total_cmp(&cost[j])).unwrap_or(0))
    }

    /// Encloses u at every point (`None`: nothing is known of it); returns with them the point whose crank pin is
    /// nearest to B, and f^2 there.
    fn directions(&self, region: &Region) -> (Vec<Option<Direction>>, Option<(usize, f64)>) {
        let mut centre = [0.0; 4];
        let mut half = [0.0; 4];
        for k in 0..4 {
            centre[k] = 0.5 * (region.low[k] + region.high[k]);
            half[k] = (region.high[k] - centre[k]).max(centre[k] - region.low[k]).next_up();
        }
        let p = Model::variable(centre[0], half[0], 0);
        let [cos_phi, sin_phi] = Model::cos_sin(centre[1], half[1], 1);
        let [cos_g, sin_g] = Model::cos_sin(centre[2], half[2], 2);
        let [cos_d, sin_d] = Model::cos_sin(centre[3], half[3], 3);
        let (cc, ss) = (cos_g.by(&cos_d), sin_g.by(&sin_d));
        let (p_cos, p_sin) = (p.by(&cos_phi), p.by(&sin_phi));
        let one_p_sq = p.square().plus(&Model::constant(Interval::exact(1.0)));
        let mut nearest: Option<(usize, f64)> = None;
        let mut all = Vec::with_capacity(self.turns.len());
        for (j, [cos_t, sin_t]) in self.turns.iter().enumerate() {
            // e = e^{i phi_0} e^{i turn}; p e alike.
            let cos = cos_phi.times(*cos_t).minus(&sin_phi.times(*sin_t));
            let along = p_cos.times(*cos_t).minus(&p_sin.times(*sin_t));
            let f_sq = one_p_sq.minus(&along.times(Interval::exact(2.0)));
            if nearest.is_none_or(|(_, least)| f_sq.middle() < least) {
                nearest = Some((j, f_sq.middle()));
            }
            all.push(f_sq.inverse_root().and_then(|inverse| {
                let side = along.from_one();
                let cosine = cc.by(&side).minus(&ss.by(&cos.minus(&p))).by(&inverse);
                let sine = cosine.square().from_one().root();
                // e^{-i psi} = (1 - p e)/f;  e^{i chi} less the common turn phi_0 = (e^{i turn} - p e^{-i phi_0})/f.
                let [re, im] = match self.class {
                    Class::CrankRocker => {
                        let across = p_sin.times(*cos_t).plus(&p_cos.times(*sin_t));
                        [side, Model::within(0.0).minus(&across)]
                    }
                    Class::DoubleCrank => {
                        [Model::constant(*cos_t).minus(&p_cos), Model::constant(*sin_t).plus(&p_sin)]
                    }
                };
                let (re, im) = (re.by(&inverse), im.by(&inverse));
                let u = [cosine.by(&re).minus(&sine.by(&im)), cosine.by(&im).plus(&sine.by(&re))];
                let size = [u[0].size(), u[1].size()];
                (u[0].is_known() && u[1].is_known()).then_some(Direction { u, size })
            }));
        }
        (all, nearest)
    }

    /// Returns whether the points of a frame show the claim; else adds the cost of each axis to `cost`.
    fn shown(&self, frame: &Frame, region: &Region, us: &[Option<Direction>], cost: &mut [f64; 4]) -> bool {
        match &self.axis {
            None => self.holds(frame, us, cost),
            // With any complex K there is no larger least sum.
            Some(axis) => {
                self.holds(frame, us, cost) || self.holds_on_axis(frame, axis, region.side(0), us, cost)
            }
        }
    }

    /// Returns whether the points of a frame show the claim for any A and K; else adds the cost of each axis to
    /// `cost`.
    fn holds(&self, frame: &Frame, us: &[Option<Direction>], cost: &mut [f64; 4]) -> bool {
        let size_sq = frame.size_sq.low;
        if self.claim >= size_sq {
            return false;
        }
        let n = frame.points.len();
        let at: Vec<&Option<Direction>> = frame.points.iter().map(|j| &us[*j]).collect();
        let y = witness(frame, &at);
        let length_sq = y.iter().flatten().map(|y| y * y).sum::<f64>() * UP;
        let root_n = (n as f64).sqrt() * UP;
        let slack = witness_slack(frame, &y);
        let beta = functional(&y, &at, slack);
        let alpha = functional(&frame.basis[2], &at, frame.error * root_n);
        let alpha_sq = alpha[0].square().plus(&alpha[1].square());
        let beta_sq = beta[0].square().plus(&beta[1].square());
        // SSE >= claim exactly where |beta|^2 >= kappa^2 |alpha|^2.
        let claim = Interval::exact(self.claim);
        let kappa_sq = claim.over(Interval::exact(size_sq) - claim) * Interval::exact(length_sq);
        let excess = beta_sq.minus(&alpha_sq.times(Interval::exact(kappa_sq.high)));
        if excess.lowest() >= 0.0 {
            return true;
        }
        // |T' - Z u'| >= |T'| - |Z| |<tau, u>|.
        let longest = Interval::exact(alpha_sq.highest()).root();
        let left = Interval::exact(size_sq).root() - Interval::exact(self.cap) * longest;
        if left.low >= claim.root().high {
            return true;
        }
        for (y, direction) in y.iter().zip(&at) {
            let Some(Direction { u, .. }) = direction else { continue };
            let weight = (y[0] * y[0] + y[1] * y[1]).sqrt();
            for (k, cost) in cost.iter_mut().enumerate() {
                *cost += weight * (u[0].curve(k) + u[1].curve(k)) * beta[0].middle().abs();
            }
        }
        for (k, cost) in cost.iter_mut().enumerate() {
            *cost += excess.change(k);
        }
        false
    }
}
