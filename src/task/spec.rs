//! The problem as data: every key of a problem file with its default filled in.
//!
//! It is written as `problem.resolved` in a record, and a run starts from it; a problem file, a library caller and
//! `verify` all lead to it. Angles in degrees, lengths in the file's unit.

use crate::mechanism::{LinkageKind, MAX_MAGNITUDE};
use crate::numbers::optimise::differential_evolution::DifferentialEvolutionParameters;
use crate::numbers::optimise::genetic::GeneticParameters;
use crate::task::Task;
use crate::task::pivot_on::PivotOn;
use crate::task::similarity::Similarity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use crate::task::limits::Limits;
pub use crate::task::loads::LoadsSpec;
pub use crate::task::requirement::{RequireSpec, TransmissionOver};
pub use crate::task::task_spec::{
    BodySpec, DEGREES, FormulaSpec, OutputSpec, RawPoints, TaskSpec, TimingSpec,
};

/// A problem with every default filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProblemSpec {
    /// The task.
    pub task: TaskSpec,
    /// The bounds of the parameters.
    pub design: DesignSpec,
    /// The requirements on a linkage.
    pub require: RequireSpec,
    /// The options of the search.
    pub solve: SolveSpec,
    /// The loads on every linkage; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<LoadsSpec>,
}

impl ProblemSpec {
    /// Returns the same problem with everything moved by `by`: points, pivots' bounds, boxes.
    #[must_use]
    pub fn shifted(&self, by: [f64; 2]) -> Self {
        let mut spec = self.clone();
        let path = &mut spec.task;
        for point in path.points.iter_mut().chain(path.raw.iter_mut().flat_map(|raw| &mut raw.points)) {
            *point = [point[0] + by[0], point[1] + by[1]];
        }
        for pivot in [&mut spec.design.crank_pivot, &mut spec.design.follower_pivot].into_iter().flatten() {
            for (limits, by) in pivot.iter_mut().zip(by) {
                *limits = Limits(limits.0 + by, limits.1 + by);
            }
        }
        if let Some(region) = &mut spec.require.pivots_in {
            region.points_mut().zip(by.iter().cycle()).for_each(|(x, by)| *x += by);
        }
        for place in spec.require.pivot_on.iter_mut().flat_map(PivotOn::points_mut) {
            *place = [place[0] + by[0], place[1] + by[1]];
        }
        if let Some(b) = &mut spec.require.footprint_in {
            *b = [b[0] + by[0], b[1] + by[1], b[2] + by[0], b[3] + by[1]];
        }
        spec.loads = self.loads.as_ref().map(|loads| loads.placed(&Similarity::shift(by)));
        spec
    }
}

/// The bounds of the parameters. A key that is absent does not bind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DesignSpec {
    /// The kinds of linkages that are searched for, sorted; empty: four-bars alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mechanism: Vec<LinkageKind>,
    /// The crank's pivot.
    #[serde(rename = "A", default, skip_serializing_if = "Option::is_none")]
    pub crank_pivot: Option<[Limits; 2]>,
    /// The follower's pivot.
    #[serde(rename = "B", default, skip_serializing_if = "Option::is_none")]
    pub follower_pivot: Option<[Limits; 2]>,
    /// |AC|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub a: Option<Limits>,
    /// |CD|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b: Option<Limits>,
    /// |BD|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub c: Option<Limits>,
    /// |CP|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub d: Option<Limits>,
    /// |DP|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub e: Option<Limits>,
    /// |AB|.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<Limits>,
    /// The direction from A to B, degrees from the x axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground_angle_deg: Option<Limits>,
    /// The direction of a slider-crank's line, degrees from the x axis; a line has no sense, so that half a turn is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line_deg: Option<Limits>,
    /// A place that a slider-crank's line passes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line_point: Option<[Limits; 2]>,
    /// P along C -> D from C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupler_x: Option<Limits>,
    /// P across C -> D, positive to the left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupler_y: Option<Limits>,
}

/// The default half width of the pivots' box and the greatest default length, in sizes of the target.
pub const DEFAULT_REACH: f64 = 5.0;
/// The least default length of a link, in sizes of the target.
pub const DEFAULT_SHORTEST: f64 = 0.02;

/// The default limits of crank, coupler and follower of a function, in lengths of the ground link.
pub const FUNCTION_RATIOS: [f64; 2] = [0.1, 10.0];

impl DesignSpec {
    /// Returns whether linkages of a kind are searched for.
    pub fn searches(&self, kind: LinkageKind) -> bool {
        if self.mechanism.is_empty() { kind == LinkageKind::FourBar } else { self.mechanism.contains(&kind) }
    }

    /// Returns whether several kinds are searched for, of which one has several loops.
    pub fn compares_kinds(&self) -> bool {
        self.mechanism.len() > 1 && self.searches_several_loops()
    }

    /// Returns whether six-bars or eight-bars are searched for.
    pub fn searches_several_loops(&self) -> bool {
        self.mechanism.iter().any(|kind| kind.dyads().is_some())
    }

    /// Returns whether four-bars alone are searched for.
    pub fn is_of_four_bars(&self) -> bool {
        self.mechanism.iter().all(|kind| *kind == LinkageKind::FourBar)
    }

    /// Returns the length of the ground link that a function is scaled to: |AB| of the pivots given, the greatest ground
    /// given, or 1.
    pub fn function_ground(&self) -> f64 {
        let middle = |pivot: [Limits; 2]| pivot.map(|l| 0.5 * l.0 + 0.5 * l.1);
        let apart = self.crank_pivot.map(middle).zip(self.follower_pivot.map(middle));
        let apart = apart.map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).filter(|apart| *apart > 0.0);
        apart.or(self.ground.map(|l| l.1).filter(|most| *most > 0.0)).unwrap_or(1.0)
    }

    /// Fills in the defaults of a function: A in the origin, B to its right at the length of the ground link, the other
    /// links in [0.1, 10] of it, and P in D.
    fn resolve_function(&mut self) {
        let fixed = |x: f64| Limits(x, x);
        let ground = self.function_ground();
        let polar = self.ground.is_some() || self.ground_angle_deg.is_some();
        if !polar {
            // The pivot that is not given lies beside the one that is.
            let beside = |pivot: [Limits; 2], by: f64| {
                let [x, y] = pivot;
                let moved = |l: Limits| Limits(l.0 + by, l.1 + by);
                [moved(x), y]
            };
            match (self.crank_pivot, self.follower_pivot) {
                (None, Some(b)) => self.crank_pivot = Some(beside(b, -ground)),
                (Some(a), None) => self.follower_pivot = Some(beside(a, ground)),
                _ => {}
            }
        }
        let a = *self.crank_pivot.get_or_insert([fixed(0.0), fixed(0.0)]);
        if polar && self.follower_pivot.is_none() {
            self.ground.get_or_insert(fixed(ground));
            self.ground_angle_deg.get_or_insert(fixed(0.0));
        } else {
            self.follower_pivot.get_or_insert([Limits(a[0].0 + ground, a[0].1 + ground), a[1]]);
        }
        let [low, high] = FUNCTION_RATIOS;
        for key in [&mut self.a, &mut self.b, &mut self.c] {
            key.get_or_insert(Limits(low * ground, high * ground));
        }
        self.e = Some(fixed(0.0));
    }

    /// Fills in the defaults of a function of a slider's places: A in the origin, the line of a slider-crank along the x axis,
    /// the pivot of an inverted one's block to the right of A, and crank, coupler and ground in [0.1, 10] of the range of the
    /// places.
    fn resolve_places(&mut self, range: f64) {
        let fixed = |x: f64| Limits(x, x);
        let [low, high] = FUNCTION_RATIOS.map(|ratio| ratio * range);
        let [x, y] = *self.crank_pivot.get_or_insert([fixed(0.0), fixed(0.0)]);
        for key in [&mut self.a, &mut self.b] {
            key.get_or_insert(Limits(low, high));
        }
        if self.searches(LinkageKind::SliderCrank) {
            self.line_deg.get_or_insert(fixed(0.0));
        }
        if self.searches(LinkageKind::InvertedSliderCrank) {
            let Limits(least, most) = self.ground.unwrap_or(Limits(low, high));
            self.follower_pivot.get_or_insert([Limits(x.0 + least, x.1 + most), y]);
        }
    }

    /// Returns whether a length is bounded: a link, a distance of the coupler point or one of its coordinates.
    pub fn bounds_a_length(&self) -> bool {
        let DesignSpec { a, b, c, d, e, ground, coupler_x, coupler_y, .. } = self;
        [a, b, c, d, e, ground, coupler_x, coupler_y].into_iter().any(Option::is_some)
    }

    /// Fills in the defaults for a target: pivots within 5 sizes of its centre, links in [0.02, 5] sizes,
    /// coupler point within 5 sizes along and across.
    ///
    /// A quantity that other given keys determine gets no default of its own: B if `ground` or `ground_angle_deg` is
    /// given, the ground if both pivots are, coupler_x and coupler_y if `d` or `e` is given.
    pub fn resolve(&mut self, task: &Task) {
        if let Some(output) = task.body().filter(|_| task.is_function()) {
            match output.is_of_places() {
                true => self.resolve_places(task.size()),
                false => self.resolve_function(),
            }
            return;
        }
        let (size, centre) = (task.size(), task.centre());
        // No default allows coordinates that a linkage cannot have.
        let within = |low: f64, high: f64| Limits(low.max(-MAX_MAGNITUDE), high.min(MAX_MAGNITUDE));
        let around = |c: f64| within(c - DEFAULT_REACH * size, c + DEFAULT_REACH * size);
        let length = within(DEFAULT_SHORTEST * size, DEFAULT_REACH * size);
        let pivot_box = [around(centre.re), around(centre.im)];
        let polar = self.ground.is_some() || self.ground_angle_deg.is_some();
        let both_pivots = self.crank_pivot.is_some() && self.follower_pivot.is_some();
        self.crank_pivot.get_or_insert(pivot_box);
        if !polar {
            self.follower_pivot.get_or_insert(pivot_box);
        }
        if !both_pivots {
            self.ground.get_or_insert(length);
        }
        for key in [&mut self.a, &mut self.b, &mut self.c] {
            key.get_or_insert(length);
        }
        if self.d.is_none() && self.e.is_none() {
            let offset = within(-DEFAULT_REACH * size, DEFAULT_REACH * size);
            self.coupler_x.get_or_insert(offset);
            self.coupler_y.get_or_insert(offset);
        }
    }
}

/// The rule for the order of the points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OrderPolicy {
    /// The points are passed in their order.
    #[default]
    Required,
    /// Any order will do.
    Any,
}

/// The ways in which the motion may come back to the first point of a target that ends where it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ClosingPolicy {
    /// Without reversing: the crank turns fully or, where branch = "any", the circuit is run through its toggles.
    #[default]
    OneWay,
    /// Also back through all points: a crank that rocks to and fro will do.
    Any,
}

impl ClosingPolicy {
    /// Returns whether it is the default.
    pub fn is_one_way(&self) -> bool {
        *self == ClosingPolicy::OneWay
    }
}

/// The rule for the circuits or the branches of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OnePolicy {
    /// It must.
    #[default]
    One,
    /// It need not.
    Any,
}

impl OnePolicy {
    /// Returns the name in files.
    pub fn name(self) -> &'static str {
        match self {
            OnePolicy::One => "one",
            OnePolicy::Any => "any",
        }
    }
}

/// The direction in which the crank turns along the points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DirectionPolicy {
    /// Either way.
    #[default]
    Any,
    /// Counter-clockwise.
    Ccw,
    /// Clockwise.
    Cw,
}

/// The method of the search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Chooses and combines the others.
    #[default]
    Auto,
    /// A real-coded genetic algorithm on the design vector.
    Genetic,
    /// Differential evolution on the design vector.
    DifferentialEvolution,
    /// Levenberg-Marquardt from many starts.
    LeastSquares,
    /// Every linkage through exactly nine points, or through 5, 4, 3 or 2 poses and 0, 2, 4 or 6 points, by following the
    /// solutions of the equations from a known set. Each fixed pivot that is given takes the place of two points. Where `mechanism`
    /// is one kind with a slider: every linkage of that kind through exactly eight points.
    Continuation,
}

impl Method {
    /// Returns whether linkages with a slider are searched for: by least squares alone.
    pub fn finds_sliders(self) -> bool {
        matches!(self, Method::Auto | Method::LeastSquares)
    }

    /// Returns the name in files.
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Genetic => "genetic",
            Method::DifferentialEvolution => "differential-evolution",
            Method::LeastSquares => "least-squares",
            Method::Continuation => "continuation",
        }
    }
}

/// The quantity that is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// The weighted sum of squared structural errors.
    #[default]
    SumOfSquares,
    /// The largest structural error, each in parts of its point's tolerance where tolerances are given; weights
    /// do not enter.
    MaxDeviation,
}

/// The measure by which candidates are ranked, as it is shown to a reader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// The sum of squared errors: no point has another weight than 1.
    #[default]
    Sum,
    /// The weighted sum of squared errors.
    WeightedSum,
    /// The largest error.
    Largest,
    /// The largest error in parts of its point's tolerance.
    LargestPart,
    /// The weighted sum of squared errors of an output whose range is free, in parts of that range.
    SumInRange,
    /// The largest error of such an output, likewise.
    LargestInRange,
}

/// The variables in which the population searches move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Variables {
    /// The parameters of the linkage, and the crank's offset where it is free: the literature's form.
    #[default]
    Nine,
    /// Ratios of links and at most an angle or two; pivots, size and coupler point by linear least squares.
    Reduced,
}

impl Variables {
    /// Returns whether these are the literature's variables.
    pub fn is_nine(&self) -> bool {
        *self == Variables::Nine
    }
}

fn advised() -> bool {
    true
}

fn is_advised(advice: &bool) -> bool {
    *advice
}

/// The default of `picks_within`.
pub const PICKS_WITHIN: f64 = 1.5;
/// The largest value of `picks_within`.
pub const MOST_PICKS_WITHIN: f64 = 1000.0;

fn usual_picks() -> f64 {
    PICKS_WITHIN
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn are_usual_picks(within: &f64) -> bool {
    *within == PICKS_WITHIN
}

/// The options and the limits of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SolveSpec {
    /// The method.
    pub method: Method,
    /// The quantity that is minimised.
    pub objective: Objective,
    /// The variables in which `genetic` and `differential-evolution` move; the other methods do not read it.
    #[serde(default)]
    pub variables: Variables,
    /// Every draw comes from this number.
    pub seed: u64,
    /// The number of distinct answers.
    pub candidates: usize,
    /// The largest number of evaluations of the objective.
    pub evaluations: u64,
    /// Seconds at most, of search and advice together; when it bites the record says that the run cannot be repeated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Whether advice is worked out beside the answers: what conflicts, what to build, what limits cost.
    #[serde(default = "advised", skip_serializing_if = "is_advised")]
    pub advice: bool,
    /// The picks beside the closest candidate have at most this many times its error; with a tolerance, they keep within
    /// it instead.
    #[serde(default = "usual_picks", skip_serializing_if = "are_usual_picks")]
    pub picks_within: f64,
    /// The options of the certificate that is worked out after the search, where one is asked for. It decides no candidate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certify: Option<CertifySpec>,
    /// The genetic algorithm's parameters.
    pub genetic: GeneticParameters,
    /// Differential evolution's parameters.
    pub differential_evolution: DifferentialEvolutionParameters,
}

impl ProblemSpec {
    /// Returns the measure by which its candidates are ranked.
    pub fn measure(&self) -> Measure {
        let path = &self.task;
        match self.solve.objective {
            _ if path.output.as_ref().is_some_and(|output| output.ranges.output_range_deg.is_some()) => {
                match self.solve.objective {
                    Objective::SumOfSquares => Measure::SumInRange,
                    Objective::MaxDeviation => Measure::LargestInRange,
                }
            }
            Objective::SumOfSquares if path.weight.iter().flatten().any(|w| *w != 1.0) => {
                Measure::WeightedSum
            }
            Objective::SumOfSquares => Measure::Sum,
            Objective::MaxDeviation
                if path.tolerance.is_some()
                    || path.body.as_ref().is_some_and(|body| body.tolerance_deg.is_some()) =>
            {
                Measure::LargestPart
            }
            Objective::MaxDeviation => Measure::Largest,
        }
    }
}

impl SolveSpec {
    /// Returns whether the search moves in the reduced variables: a population search that was asked to.
    pub fn moves_reduced(&self) -> bool {
        let population = matches!(self.method, Method::Genetic | Method::DifferentialEvolution);
        population && self.variables == Variables::Reduced
    }
}

impl Default for SolveSpec {
    fn default() -> Self {
        SolveSpec {
            method: Method::Auto,
            objective: Objective::SumOfSquares,
            variables: Variables::Nine,
            seed: 1,
            candidates: 5,
            evaluations: 200_000,
            time_limit_s: None,
            advice: true,
            picks_within: PICKS_WITHIN,
            certify: None,
            genetic: GeneticParameters::default(),
            differential_evolution: DifferentialEvolutionParameters::default(),
        }
    }
}

/// The options of a certificate ([`crate::judge::certificate`]).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CertifySpec {
    /// The gap between the best candidate and the proved bound at which it ends, relative, in (0, 1).
    pub gap: f64,
    /// Seconds at most; what is proved by then counts.
    pub time_limit_s: f64,
}

impl Default for CertifySpec {
    fn default() -> Self {
        CertifySpec { gap: 1e-4, time_limit_s: 300.0 }
    }
}

/// The longest time for a certificate, seconds.
pub const MAX_CERTIFY_S: f64 = 1e6;

pub use crate::task::resampling::MAX_SMOOTHED;

/// The most points of a target.
pub const MAX_POINTS: usize = 100_000;
/// The most candidates that a run returns.
pub const MAX_CANDIDATES: usize = 100;
/// The largest budget of evaluations.
pub const MAX_EVALUATIONS: u64 = 1_000_000_000_000;
/// The largest population of a population search.
pub const MAX_POPULATION: usize = 1_000_000;
