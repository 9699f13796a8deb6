//! Relaxation of a problem: each requirement as limits with an outward side.

use crate::judge::assess::assess_again;
use crate::record::{Candidate, Change, TypedValue};
use crate::task::Problem;
use crate::task::requirement::{Choice, Limit, RequirementKind};
use crate::task::spec::{DEFAULT_REACH, DEFAULT_SHORTEST, DesignSpec, Limits, ProblemSpec, RequireSpec};

/// A requirement, or the bounds of a design key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Demand {
    /// A requirement.
    Require(RequirementKind),
    /// A key of `[design]`.
    Design(DesignKey),
}

/// The keys of `[design]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignKey {
    /// The crank's pivot A.
    CrankPivot,
    /// The follower's pivot B.
    FollowerPivot,
    /// The ground length |AB|.
    Ground,
    /// The angle of the ground line, arg(B - A), in degrees.
    GroundAngle,
    /// The crank length |AC|.
    Crank,
    /// The coupler length |CD|.
    Coupler,
    /// The follower length |BD|.
    Follower,
    /// The coupler side |CP| at the crank.
    CrankSide,
    /// The coupler side |DP| at the follower.
    FollowerSide,
    /// The direction of a slider-crank's line, in degrees.
    LineAngle,
    /// A place that a slider-crank's line passes.
    LinePoint,
    /// The coordinate of P along C -> D.
    CouplerX,
    /// The coordinate of P across C -> D.
    CouplerY,
}

/// The place of a key's limits in the specification: of both coordinates of a pivot, or of one number.
enum Place {
    Pivot(fn(&mut DesignSpec) -> &mut Option<[Limits; 2]>),
    One(fn(&mut DesignSpec) -> &mut Option<Limits>),
}

/// The keys of `[design]` in the order of their declaration, each with the rows of its limits among the requirements.
const DESIGN_KEYS: [(DesignKey, &[&str], Place); 13] = [
    (DesignKey::CrankPivot, &["design.Ax", "design.Ay"], Place::Pivot(|d| &mut d.crank_pivot)),
    (DesignKey::FollowerPivot, &["design.Bx", "design.By"], Place::Pivot(|d| &mut d.follower_pivot)),
    (DesignKey::Ground, &["design.ground"], Place::One(|d| &mut d.ground)),
    (DesignKey::GroundAngle, &["design.ground_angle_deg"], Place::One(|d| &mut d.ground_angle_deg)),
    (DesignKey::Crank, &["design.a"], Place::One(|d| &mut d.a)),
    (DesignKey::Coupler, &["design.b"], Place::One(|d| &mut d.b)),
    (DesignKey::Follower, &["design.c"], Place::One(|d| &mut d.c)),
    (DesignKey::CrankSide, &["design.d"], Place::One(|d| &mut d.d)),
    (DesignKey::FollowerSide, &["design.e"], Place::One(|d| &mut d.e)),
    (DesignKey::LineAngle, &["design.line_deg"], Place::One(|d| &mut d.line_deg)),
    (DesignKey::LinePoint, &["design.line_x", "design.line_y"], Place::Pivot(|d| &mut d.line_point)),
    (DesignKey::CouplerX, &["design.coupler_x"], Place::One(|d| &mut d.coupler_x)),
    (DesignKey::CouplerY, &["design.coupler_y"], Place::One(|d| &mut d.coupler_y)),
];

/// The bound of a dropped design key, in sizes of the target.
const FAR: f64 = 2.0 * DEFAULT_REACH;

impl Demand {
    /// The demand for a tolerance.
    pub const TOLERANCE: Demand = Demand::Require(RequirementKind::Tolerance);
    /// The demand for a type.
    pub const TYPE: Demand = Demand::Require(RequirementKind::Type);

    /// Returns the demands of a problem in a fixed order; design keys last.
    pub fn of(problem: &Problem) -> Vec<Demand> {
        let asked = |kind: &RequirementKind| (kind.definition().is_asked)(problem);
        let given = |key: &DesignKey| !key.get(&problem.spec().design).is_empty();
        let requirements = RequirementKind::IN_CONFLICTS.into_iter().filter(asked).map(Demand::Require);
        requirements.chain(DesignKey::all().filter(given).map(Demand::Design)).collect()
    }

    /// Returns the demand that a requirement of the record belongs to.
    pub fn named(name: &str) -> Option<Demand> {
        let design = || DesignKey::all().find(|key| key.rows().contains(&name)).map(Demand::Design);
        RequirementKind::named(name).map(Demand::Require).or_else(design)
    }

    /// Returns whether it is a choice among words, with no measure of how far it is loosened.
    pub fn is_policy(self) -> bool {
        match self {
            Demand::Require(kind) => (kind.definition().choice)(&RequireSpec::default()).is_some(),
            Demand::Design(_) => false,
        }
    }

    /// Returns the key in the file of a problem.
    pub fn key_in(self, spec: &ProblemSpec) -> String {
        match self {
            Demand::Require(kind) => kind.key_in(spec),
            Demand::Design(key) => key.key().to_owned(),
        }
    }

    /// Returns the problem without this demand; design keys keep within reach of the target.
    pub fn dropped(self, problem: &Problem, mut spec: ProblemSpec) -> ProblemSpec {
        match self {
            Demand::Require(kind) => (kind.definition().set_limits)(&mut spec, &[]),
            Demand::Design(key) => key.widen(problem, &mut spec.design),
        }
        spec
    }

    /// Returns its limits as numbers; `None` if it has none (a policy, types, a tolerance that differs from point to
    /// point).
    pub fn limits(self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        match self {
            Demand::Require(kind) => (kind.definition().limits)(spec),
            Demand::Design(key) => {
                let limits = key.get(&spec.design);
                let pair =
                    |l: Limits| [Limit { value: l.0, outward: -1.0 }, Limit { value: l.1, outward: 1.0 }];
                (!limits.is_empty()).then(|| limits.into_iter().flat_map(pair).collect())
            }
        }
    }

    /// Returns the problem with other limits, as many as [`Demand::limits`] gives.
    pub fn with_limits(self, mut spec: ProblemSpec, limits: &[f64]) -> ProblemSpec {
        match self {
            Demand::Require(kind) => (kind.definition().set_limits)(&mut spec, limits),
            Demand::Design(key) => {
                key.set(&mut spec.design, |i| Limits(limits[2 * i], limits[2 * i + 1]));
            }
        }
        spec
    }

    /// Returns whether a value to type leaves everything allowed that the problem allows: each limit at its value or
    /// farther out, a policy that allows any, the types with others.
    pub fn is_no_tighter(self, spec: &ProblemSpec, to: &TypedValue) -> bool {
        match (self, to) {
            (Demand::TYPE, TypedValue::Words(names)) => {
                spec.require.types.iter().all(|kind| names.iter().any(|name| name == kind.name()))
            }
            (policy, TypedValue::Word(word)) if policy.is_policy() => word == "any",
            (demand, to) => {
                let is_design = matches!(demand, Demand::Design(_));
                let values = match to {
                    TypedValue::Number(value) => vec![*value],
                    TypedValue::Numbers(values) => values.clone(),
                    TypedValue::Pairs(pairs) if is_design => pairs.concat(),
                    TypedValue::Pairs(_) | TypedValue::Word(_) | TypedValue::Words(_) => return false,
                };
                self.limits(spec).is_some_and(|limits| {
                    // A fixed length is typed as one number, a fixed pivot as its two coordinates.
                    let fixed = is_design && limits.len() == 2 * values.len();
                    let values = if fixed { values.iter().flat_map(|v| [*v; 2]).collect() } else { values };
                    reach_out(&limits, &values)
                })
            }
        }
    }

    /// Returns the values that a candidate, judged under the problem that demands, attains in place of each limit.
    pub fn attained(self, judged: &Candidate) -> Option<Vec<f64>> {
        if self == Demand::TOLERANCE {
            return Some(vec![judged.error.max]);
        }
        if self == Demand::Require(RequirementKind::ToleranceDeg) && judged.error.output.is_some() {
            return Some(vec![judged.error.max]);
        }
        let row = |name: &str| judged.requirements.iter().find(|r| r.name == name);
        let rows: Vec<_> = match self {
            Demand::Require(kind) => vec![row(kind.name())],
            Demand::Design(key) => key.rows().iter().map(|name| row(name)).collect(),
        };
        let mut values = Vec::new();
        for row in rows {
            let numbers = row?.value.numbers();
            match self {
                _ if numbers.is_empty() => return None,
                // Bounds have two limits for one value.
                Demand::Design(_) => values.extend(numbers.iter().flat_map(|value| [*value; 2])),
                Demand::Require(_) => values.extend(numbers),
            }
        }
        Some(values)
    }

    /// Returns the value of the key in a problem, as it is typed; `None` if it cannot be typed.
    pub fn typed(self, spec: &ProblemSpec) -> Option<TypedValue> {
        match self {
            Demand::Design(key) => {
                let limits = key.get(&spec.design);
                match limits.as_slice() {
                    [l] if l.is_fixed() => Some(TypedValue::Number(l.0)),
                    [l] => Some(TypedValue::Numbers(vec![l.0, l.1])),
                    [x, y] if x.is_fixed() && y.is_fixed() => Some(TypedValue::Numbers(vec![x.0, y.0])),
                    [x, y] => Some(TypedValue::Pairs(vec![[x.0, x.1], [y.0, y.1]])),
                    _ => None,
                }
            }
            Demand::Require(kind) => match (kind.definition().choice)(&spec.require) {
                Some(Choice::Word(word)) => Some(TypedValue::Word(word.into())),
                Some(Choice::Words(words)) => {
                    Some(TypedValue::Words(words.into_iter().map(str::to_owned).collect()))
                }
                None => {
                    let limits: Vec<f64> = self.limits(spec)?.iter().map(|l| l.value).collect();
                    Some(match limits.as_slice() {
                        [only] => TypedValue::Number(*only),
                        _ => TypedValue::Numbers(limits),
                    })
                }
            },
        }
    }
}

/// Returns whether each value is at its limit or farther out.
fn reach_out(limits: &[Limit], values: &[f64]) -> bool {
    limits.len() == values.len()
        && limits.iter().zip(values).all(|(limit, value)| limit.outward * (value - limit.value) >= 0.0)
}

impl DesignKey {
    /// Returns the key in the problem file.
    pub fn key(self) -> &'static str {
        match self {
            DesignKey::CrankPivot => "design.A",
            DesignKey::FollowerPivot => "design.B",
            _ => self.rows()[0],
        }
    }

    fn all() -> impl Iterator<Item = DesignKey> {
        DESIGN_KEYS.iter().map(|(key, ..)| *key)
    }

    /// Returns the names of its rows among the requirements.
    fn rows(self) -> &'static [&'static str] {
        DESIGN_KEYS[self as usize].1
    }

    /// Returns its limits: none if the problem does not contain the key, two of a pivot, else one.
    pub fn get(self, design: &DesignSpec) -> Vec<Limits> {
        match DESIGN_KEYS[self as usize].2 {
            Place::Pivot(of) => of(&mut design.clone()).iter().flatten().copied().collect(),
            Place::One(of) => of(&mut design.clone()).iter().copied().collect(),
        }
    }

    fn set(self, design: &mut DesignSpec, limits: impl Fn(usize) -> Limits) {
        match DESIGN_KEYS[self as usize].2 {
            Place::Pivot(of) => *of(design) = Some([limits(0), limits(1)]),
            Place::One(of) => *of(design) = Some(limits(0)),
        }
    }

    /// Returns whether it is a length, which is never negative.
    pub fn is_length(self) -> bool {
        use DesignKey::*;
        matches!(self, Ground | Crank | Coupler | Follower | CrankSide | FollowerSide)
    }

    fn widen(self, problem: &Problem, design: &mut DesignSpec) {
        let (far, centre) = (FAR * problem.task().size(), problem.task().centre());
        let middle = [centre.re, centre.im];
        let old = self.get(design);
        let around = |l: Limits, middle: f64, far: f64| Limits(l.0.min(middle - far), l.1.max(middle + far));
        match self {
            DesignKey::CrankPivot | DesignKey::FollowerPivot | DesignKey::LinePoint => {
                self.set(design, |i| around(old[i], middle[i], far));
            }
            DesignKey::GroundAngle | DesignKey::LineAngle => {
                self.set(design, |i| around(old[i], 0.5 * (old[i].0 + old[i].1), 180.0));
            }
            DesignKey::CouplerX | DesignKey::CouplerY => self.set(design, |i| around(old[i], 0.0, far)),
            _ => self.set(design, |i| Limits(0.0, old[i].1.max(far))),
        }
    }
}

/// Returns the limits that the design gives to one row of the requirements, such as `design.Ax`.
pub fn design_limits(design: &DesignSpec, row: &str) -> Option<Limits> {
    DESIGN_KEYS.iter().find_map(|(key, rows, _)| {
        let place = rows.iter().position(|name| *name == row)?;
        key.get(design).get(place).copied()
    })
}

/// Returns the changes to type that lead from a problem to one in which `demands` have been loosened.
///
/// A key that is typed is no longer filled in by a default, which may remove the default of another key:
/// [`DesignSpec::resolve`] gives no ground if both pivots are given, and no B if the ground is; a bounded length leaves
/// `longest_max` without a default. Such keys are typed as well, with the values that they have.
pub fn changes(problem: &Problem, loosened: &ProblemSpec, demands: &[Demand]) -> Option<Vec<Change>> {
    let spec = problem.spec();
    let change = |demand: Demand| {
        Some(Change { key: demand.key_in(spec), from: demand.typed(spec)?, to: demand.typed(loosened)? })
    };
    let mut keys = demands.to_vec();
    let mut pin = |key: DesignKey| {
        let demand = Demand::Design(key);
        if !keys.contains(&demand) && !key.get(&spec.design).is_empty() {
            keys.push(demand);
        }
    };
    let (size, centre) = (problem.task().size(), problem.task().centre());
    let design = &spec.design;
    let is_default = |l: &Limits, low: f64, high: f64| l.0 == low && l.1 == high;
    let ground_is_default =
        design.ground.is_some_and(|l| is_default(&l, DEFAULT_SHORTEST * size, DEFAULT_REACH * size));
    let pivot_is_default = |p: Option<[Limits; 2]>| {
        p.is_some_and(|p| {
            let at = [centre.re, centre.im];
            p.iter().zip(at).all(|(l, c)| is_default(l, c - DEFAULT_REACH * size, c + DEFAULT_REACH * size))
        })
    };
    if ground_is_default {
        use DesignKey::{CrankPivot, FollowerPivot, Ground};
        let typed = |key| demands.contains(&Demand::Design(key));
        let given = |key, pivot| typed(key) || !pivot_is_default(pivot);
        let both = given(CrankPivot, design.crank_pivot) && given(FollowerPivot, design.follower_pivot);
        if (typed(CrankPivot) || typed(FollowerPivot)) && both {
            pin(Ground);
            pin(FollowerPivot);
        }
        if typed(Ground) {
            pin(FollowerPivot);
        }
    }
    let longest = Demand::Require(RequirementKind::LongestMax);
    if spec.has_default_longest()
        && !keys.contains(&longest)
        && keys.iter().any(|key| removes_default_longest(*key))
    {
        keys.push(longest);
    }
    keys.into_iter().map(change).collect()
}

/// Returns whether `longest_max` may have no default any more where this key is typed.
fn removes_default_longest(demand: Demand) -> bool {
    match demand {
        Demand::Require(kind) => kind == RequirementKind::ExtentMax,
        Demand::Design(key) => !matches!(key, DesignKey::GroundAngle | DesignKey::LineAngle),
    }
}

/// Rounds a limit outward to three significant digits of itself or of its change, whichever is coarser; finer if that
/// would be more than the change.
///
/// ```
/// use linkwright::internals::judge::loosen::rounded_outward;
/// assert_eq!(rounded_outward(32.1472, 40.0, -1.0), 32.1);
/// assert_eq!(rounded_outward(1000.0321, 1000.0, 1.0), 1000.033);
/// ```
pub fn rounded_outward(value: f64, from: f64, outward: f64) -> f64 {
    let change = (value - from).abs();
    let power = |x: f64, digits: i32| (x.log10().floor() as i32) - digits + 1;
    if change == 0.0 || !value.is_finite() || !change.is_finite() {
        return value;
    }
    let own = if value == 0.0 { i32::MIN } else { power(value.abs(), 3) };
    let exponent =
        if value != 0.0 && 10f64.powi(own) > change { power(change, 2) } else { own.max(power(change, 3)) };
    let steps = |x: f64| if exponent >= 0 { x / 10f64.powi(exponent) } else { x * 10f64.powi(-exponent) };
    // A value that lies on a step, up to rounding, stays there.
    let near = 1e-9;
    let count = outward * (outward * steps(value) - near).ceil();
    // Through decimal text, so that it prints with few digits.
    format!("{count}e{exponent}").parse().unwrap_or(value)
}

/// Returns the candidate judged under a problem that is stricter than the one that it was found for.
pub fn judged_under(problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
    assess_again(problem, candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_design_keys_is_in_the_order_of_their_declaration() {
        for (i, (key, ..)) in DESIGN_KEYS.iter().enumerate() {
            assert_eq!(*key as usize, i, "{key:?}");
        }
    }

    #[test]
    fn a_key_that_would_remove_the_default_of_the_longest_link_is_typed_with_it() {
        let text = |require: &str| {
            format!("format = 1\n[task.path]\npoints = [[0, 0], [3, 4], [3, 1]]\n[require]\n{require}\n")
        };
        let keys = |require: &str, demand: Demand| -> Vec<String> {
            let file = crate::parse_problem("it.toml", &text(require), None, &[]).expect("a problem");
            let problem = Problem::new(file.spec.clone()).expect("a problem");
            let wider = demand.dropped(&problem, file.spec);
            let changes = changes(&problem, &wider, &[demand]).expect("they can be typed");
            // What is typed is read as the problem that was meant.
            let set: Vec<_> = changes.iter().map(|c| (c.key.clone(), c.to.to_string())).collect();
            let again = crate::parse_problem("it.toml", &text(require), None, &set).expect("a problem");
            assert_eq!(again.spec, wider);
            changes.into_iter().map(|change| change.key).collect()
        };
        let crank = Demand::Design(DesignKey::Crank);
        assert_eq!(keys("", crank), ["design.a", "require.longest_max"]);
        assert_eq!(keys("longest_max = \"any\"", crank), ["design.a"]);
        assert_eq!(keys("longest_max = 9", crank), ["design.a"]);
        let ratio = Demand::Require(RequirementKind::LinkRatio);
        assert_eq!(keys("", ratio), ["require.link_ratio_max"]);
    }

    #[test]
    fn rounding_goes_outward_and_never_past_twice_the_change() {
        for i in 1..2000 {
            let value = 0.37 * f64::from(i) - 300.0;
            for (from, outward) in [(value - 0.013, 1.0), (value + 5.1, -1.0), (value - 400.0, 1.0)] {
                let rounded = rounded_outward(value, from, outward);
                let slack = 1e-8 * value.abs();
                assert!(outward * (rounded - value) >= -slack, "{value} from {from}: {rounded}");
                assert!((rounded - from).abs() <= 2.0 * (value - from).abs() + slack, "{value} from {from}");
            }
        }
    }
}
