//! The check of one box: a proof that every linkage in it has a sum of squares of at least the claimed one.

use super::frame::{Complex, Frame, conjugate, times, turn};
use super::interval::Interval;
use super::model::{Model, Sum, UP};
use super::real::crank_lengths;
use linkwright_leaves::{Axis, Class, Line};

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

/// A claim about one class in one direction: no linkage with |Z| <= cap has a sum of squares below `claim`.
#[derive(Clone, Debug)]
pub struct Claim {
    pub(super) class: Class,
    turns: Vec<[Interval; 2]>,
    whole: Frame,
    /// The frames of all points but one; `None` if the others are too much alike.
    fewer: Vec<Option<Frame>>,
    pub(super) cap: f64,
    pub(super) claim: f64,
    /// The known pivots, directions and limits if crank angles are from the x axis.
    axis: Option<Axis>,
}

/// The direction u at a point, with bounds of the sizes of its parts.
pub(super) struct Direction {
    u: [Model; 2],
    size: [f64; 2],
}

impl Claim {
    /// Creates the claim; `None` if the target's figures are too much alike to bound anything.
    pub fn new(
        class: Class,
        direction: f64,
        points: &[[f64; 2]],
        turns_deg: &[f64],
        cap: f64,
        claim: f64,
    ) -> Option<Self> {
        let points: Vec<Complex> = points.iter().map(|p| p.map(Interval::exact)).collect();
        let turns = turns_deg.iter().map(|deg| turn(*deg, direction)).collect();
        Claim::of(class, points, turns, cap, claim, None)
    }

    /// Creates the claim for crank angles from the x axis; `None` as in [`Claim::new`].
    pub fn on_axis(
        class: Class,
        points: &[[f64; 2]],
        angles_deg: &[f64],
        cap: f64,
        claim: f64,
        axis: &Axis,
    ) -> Option<Self> {
        let [a_x, a_y] = axis.pivot.unwrap_or_default().map(Interval::exact);
        let from_pivot = |p: &[f64; 2]| [Interval::exact(p[0]) - a_x, Interval::exact(p[1]) - a_y];
        let back = match &axis.line {
            None => [Interval::exact(1.0), Interval::exact(0.0)],
            Some(Line::Angle(angle)) => conjugate(turn(*angle, 1.0)),
            Some(Line::To(b)) => {
                let [x, y] = from_pivot(b);
                let length = (x.square() + y.square()).root();
                [x.over(length), -y.over(length)]
            }
        };
        let points = points.iter().map(|p| times(from_pivot(p), back)).collect();
        let turns = angles_deg.iter().map(|deg| times(turn(*deg, 1.0), back)).collect();
        Claim::of(class, points, turns, cap, claim, Some(*axis))
    }

    fn of(
        class: Class,
        points: Vec<Complex>,
        turns: Vec<Complex>,
        cap: f64,
        claim: f64,
        axis: Option<Axis>,
    ) -> Option<Self> {
        let all: Vec<usize> = (0..points.len()).collect();
        let at_origin = axis.is_some_and(|axis| axis.pivot.is_some());
        let whole = Frame::new(&points, &turns, all.clone(), at_origin)?;
        let but = |j: usize| all.iter().copied().filter(|i| *i != j).collect();
        let fewer = all.iter().map(|j| Frame::new(&points, &turns, but(*j), at_origin)).collect();
        Some(Claim { class, turns, whole, fewer, cap, claim, axis })
    }

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

/// Computes the inner product <b, v> = sum conj(b) v.
fn product(b: &[[f64; 2]], v: &[[f64; 2]]) -> [f64; 2] {
    b.iter()
        .zip(v)
        .fold([0.0; 2], |[re, im], (b, v)| [re + b[0] * v[0] + b[1] * v[1], im + b[0] * v[1] - b[1] * v[0]])
}

/// Returns a bound of the share of <y, u> that is due to the parts of y along the frame's exact directions.
pub(super) fn witness_slack(frame: &Frame, y: &[[f64; 2]]) -> f64 {
    let n = y.len() as f64;
    // <b, y> with its rounding and that of b; |<b, u>| <= sqrt n.
    let rounding = (2.0 * n + 4.0) * f64::EPSILON;
    let along = |b: &Vec<[f64; 2]>| {
        let [re, im] = product(b, y);
        re.abs() + im.abs() + rounding + 1.01 * frame.error
    };
    frame.basis.iter().map(along).sum::<f64>() * n.sqrt() * UP * UP
}

/// Returns the witness y: u in the middle of the box, projected off the frame's directions and scaled to length 1.
/// Any vector would be valid.
pub(super) fn witness(frame: &Frame, at: &[&Option<Direction>]) -> Vec<[f64; 2]> {
    let mut y: Vec<[f64; 2]> =
        at.iter().map(|d| d.as_ref().map_or([0.0; 2], |d| [d.u[0].middle(), d.u[1].middle()])).collect();
    for _ in 0..2 {
        for b in &frame.basis {
            let [re, im] = product(b, &y);
            for (b, y) in b.iter().zip(&mut y) {
                *y = [y[0] - (b[0] * re - b[1] * im), y[1] - (b[0] * im + b[1] * re)];
            }
        }
        let length = y.iter().flatten().map(|y| y * y).sum::<f64>().sqrt();
        let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
        for y in &mut y {
            *y = [y[0] * scale, y[1] * scale];
        }
    }
    y
}

/// Encloses the real and the imaginary part of <v, u> over the box.
pub(super) fn functional(v: &[[f64; 2]], at: &[&Option<Direction>], slack: f64) -> [Model; 2] {
    let (mut re, mut im) = (Sum::EMPTY, Sum::EMPTY);
    for (v, direction) in v.iter().zip(at) {
        match direction {
            Some(Direction { u, size }) => {
                re.add(v[0], &u[0], size[0]);
                re.add(v[1], &u[1], size[1]);
                im.add(v[0], &u[1], size[1]);
                im.add(-v[1], &u[0], size[0]);
            }
            None => {
                let size = (v[0] * v[0] + v[1] * v[1]).sqrt() * UP;
                re.add_unknown(size);
                im.add_unknown(size);
            }
        }
    }
    [re.model(slack), im.model(slack)]
}
