//! The keys of a problem file as they are written: every key optional, nothing checked. The JSON Schema is made from
//! these types.

use super::Expect;
use super::ranges::RangeNumbers;
use crate::files::loads_file::RawLoads;
use crate::files::toml_values::{
    BoundedXY, Bounds, Count, CrankAngle, Number, OneOrEach, OnlyTable, PoseNumbers, XY,
};
use crate::mechanism::{LinkageKind, Unit};
use crate::numbers::optimise::differential_evolution::DifferentialEvolutionParameters;
use crate::numbers::optimise::genetic::GeneticParameters;
use crate::task::requirement::RawRequire;
use crate::task::spec::{Method, Objective, Variables};
use crate::task::values::OneOrMore;
use crate::task::{AngleOffset, Sense};
use schemars::JsonSchema;
use serde::Deserialize;

/// A linkwright problem file.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ProblemFile")]
pub(crate) struct RawProblem {
    /// The format of the file: 1.
    #[schemars(required)]
    pub format: Option<Count>,
    /// 1 to 64 letters, digits, blanks and `- _ .`, not starting with a dot; where silent, the name of the file.
    pub name: Option<String>,
    /// The source of the problem, in words.
    pub source: Option<String>,
    /// The unit of lengths: it labels them and scales drawings.
    pub unit: Option<Unit>,
    /// The task.
    #[schemars(required)]
    pub task: Option<OnlyTable<RawTask>>,
    /// The bounds of the parameters.
    #[serde(default)]
    pub design: OnlyTable<RawDesign>,
    /// The requirements on a linkage.
    #[serde(default)]
    pub require: OnlyTable<RawRequire>,
    /// The options of the search.
    #[serde(default)]
    pub solve: OnlyTable<RawSolve>,
    /// The options of a certificate, where `solve.certify` asks for one.
    #[serde(default)]
    pub certify: Option<OnlyTable<RawCertify>>,
    /// The loads on every linkage that is found; they need the unit of lengths.
    #[serde(default)]
    pub loads: Option<OnlyTable<RawLoads>>,
    /// The known facts about the answer; no search reads them.
    pub expect: Option<OnlyTable<Expect>>,
}

/// The task: a path, a motion or a function.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Task")]
pub(crate) struct RawTask {
    /// A path to trace.
    pub path: Option<OnlyTable<RawPath>>,
    /// Poses that a body is to pass.
    pub motion: Option<OnlyTable<RawMotion>>,
    /// Angles that the follower is to have at angles of the crank.
    pub function: Option<OnlyTable<RawFunction>>,
}

/// Angles that the follower is to have at angles of the crank: pairs, a file of pairs, or a formula.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Function")]
pub(crate) struct RawFunction {
    /// How far the crank has turned at each pair, degrees, counter-clockwise positive. Give input_deg and output_deg, or
    /// file, or of.
    pub input_deg: Option<Vec<Number>>,
    /// How far the follower, or the block of an inverted slider-crank, has turned at each pair, degrees.
    pub output_deg: Option<Vec<Number>>,
    /// In place of output_deg: how far a slider has moved at each pair, a length. Of a slider-crank the slider on its line, of
    /// an inverted one the block along the rod.
    pub output: Option<Vec<Number>>,
    /// A CSV file, named from the problem file's folder: columns input_deg, output_deg and optionally weight,
    /// tolerance_deg; or input_deg, output and optionally weight, tolerance.
    pub file: Option<String>,
    /// A formula in x, such as "log10(x)": the follower turns in proportion to its value as the crank does to x.
    pub of: Option<String>,
    /// The first and the last x of the formula.
    pub over: Option<XY>,
    /// How far the crank turns over the formula's range, degrees; or "free" (30 to 180 degrees) or bounds [least, greatest]:
    /// the range is an unknown too. With pairs, a free range leaves only the proportions of the inputs.
    pub input_range_deg: Option<RangeNumbers>,
    /// How far the follower turns between the least and the greatest value of the formula, degrees; or free, likewise: errors
    /// are then measured in parts of the range.
    pub output_range_deg: Option<RangeNumbers>,
    /// How far a slider moves between the least and the greatest value of the formula, a length; in place of output_range_deg.
    pub output_range: Option<Number>,
    /// The number of pairs taken of the formula, evenly in x; 61 where silent.
    pub samples: Option<Count>,
    /// "free": inputs count from any angle of the crank; "ground": from the line A to B, of a slider-crank from the slider's
    /// line.
    #[serde(default)]
    pub input_offset: AngleOffset,
    /// The same of outputs and the follower. "ground" counts places of a slider from the foot of the perpendicular from A on
    /// its line, those of a block from C.
    #[serde(default)]
    pub output_offset: AngleOffset,
    /// The sense in which the follower turns while the crank turns as written: "same", "opposite" or, where silent,
    /// "any".
    #[serde(default)]
    pub sense: Sense,
    /// The largest error of the output accepted, degrees, 0 or more: a number for every pair, or a list of one a pair.
    pub tolerance_deg: Option<OneOrEach>,
    /// The largest error of a slider's place accepted, a length, likewise.
    pub tolerance: Option<OneOrEach>,
    /// Weights of the squared errors, above 0, one a pair; where silent, all pairs count alike.
    pub weight: Option<Vec<Number>>,
}

/// Poses that a body is to pass, or places of its point alone.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Motion")]
pub(crate) struct RawMotion {
    /// The poses in their order, each [x, y, angle of the body in degrees], or [x, y] where only the place counts. Give
    /// one of poses and file.
    pub poses: Option<Vec<PoseNumbers>>,
    /// A CSV file, named from the problem file's folder: columns x, y, angle_deg (an empty cell: only the place counts) and
    /// optionally crank_deg, weight, tolerance, tolerance_deg.
    pub file: Option<String>,
    /// Whether the motion returns to the first pose; where silent, false.
    pub closed: Option<bool>,
    /// A length: an angle error of one radian counts like an error of the place of this length; where silent, the size of
    /// the target.
    pub angle_weight: Option<Number>,
    /// The largest error of the place accepted, 0 or more: a number for every pose, or a list of one a pose.
    pub tolerance: Option<OneOrEach>,
    /// The largest error of the angle accepted, degrees, likewise.
    pub tolerance_deg: Option<OneOrEach>,
    /// The poses that are to be met exactly, counted from 0; where silent, none: all are approached alike.
    pub exact: Option<Vec<Count>>,
    /// Weights of the squared errors, above 0, one a pose; where silent, all poses count alike.
    pub weight: Option<Vec<Number>>,
    /// Prescribed crank angles; where silent, the timing is free: each pose is met at whatever angle suits it.
    pub timing: Option<OnlyTable<RawTiming>>,
}

/// A path to trace: points, a file of points, or a drawing.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Path")]
pub(crate) struct RawPath {
    /// The target points in their order, each [x, y]. Give one of points, file and svg.
    pub points: Option<Vec<XY>>,
    /// A CSV file, named from the problem file's folder: columns x, y and optionally crank_deg, weight, tolerance.
    pub file: Option<String>,
    /// An SVG drawing, named from the problem file's folder: its first path, polyline, polygon, circle or ellipse.
    pub svg: Option<String>,
    /// The id of the drawing's shape, where it is not the first.
    pub svg_id: Option<String>,
    /// The number of points taken evenly by arc length: of a drawing (60 where silent), or along the points.
    pub samples: Option<Count>,
    /// Smooths digitised points: the standard deviation of the window, a length along the path.
    pub smooth: Option<Number>,
    /// Whether the target is a closed curve; where silent, false, of a drawing as it is drawn.
    pub closed: Option<bool>,
    /// The largest error accepted, 0 or more: a number for every point, or a list of one a point; where silent, any.
    pub tolerance: Option<OneOrEach>,
    /// Weights of the squared errors, above 0, one a point; where silent, all points count alike.
    pub weight: Option<Vec<Number>>,
    /// Prescribed crank angles; where silent, the timing is free: each point is met at whatever angle suits it.
    pub timing: Option<OnlyTable<RawTiming>>,
}

/// Prescribed crank angles.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Timing")]
pub(crate) struct RawTiming {
    /// One a target, degrees, counter-clockwise positive, or "free" where any angle between its neighbours will do; or a
    /// column of the CSV file, whose empty cells are free.
    pub crank_deg: Option<Vec<CrankAngle>>,
    /// Their reference direction.
    #[serde(default)]
    pub offset: AngleOffset,
}

/// The bounds of the parameters: a number fixes, [min, max] bounds.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Design")]
pub(crate) struct RawDesign {
    /// The kinds of linkages to search for, ranked together: one name or a list of four-bar (default), slider-crank and
    /// inverted-slider-crank, six-bar, eight-bar. Six-bars and eight-bars draw paths, of free timing or with every
    /// crank angle given; where a tolerance is asked for they are searched for only if no simpler kind of the list meets it.
    pub mechanism: Option<OneOrMore<LinkageKind>>,
    /// The fixed pivot of the crank: [x, y], each a number or [min, max]; where silent, within 5 sizes of the target.
    #[serde(rename = "A")]
    pub crank_pivot: Option<BoundedXY>,
    /// The fixed pivot of the follower, likewise.
    #[serde(rename = "B")]
    pub follower_pivot: Option<BoundedXY>,
    /// |AC|, the crank; where silent, 0.02 to 5 sizes of the target, as are b, c and ground.
    pub a: Option<Bounds>,
    /// |CD|, the coupler.
    pub b: Option<Bounds>,
    /// |BD|, the follower.
    pub c: Option<Bounds>,
    /// |CP|.
    pub d: Option<Bounds>,
    /// |DP|.
    pub e: Option<Bounds>,
    /// |AB|.
    pub ground: Option<Bounds>,
    /// The direction from A to B, degrees from the x axis.
    pub ground_angle_deg: Option<Bounds>,
    /// The direction of a slider-crank's line, degrees from the x axis; any where silent. Half a turn makes no difference.
    pub line_deg: Option<Bounds>,
    /// A place that a slider-crank's line passes: [x, y], each a number or [min, max]; where silent, it passes within 5 sizes
    /// of the target's centre.
    pub line_point: Option<BoundedXY>,
    /// P along the line from C to D, from C; where silent, at most 5 sizes of the target either way.
    pub coupler_x: Option<Bounds>,
    /// P across the line from C to D, positive to its left; likewise.
    pub coupler_y: Option<Bounds>,
}

/// The options and the limits of a search.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Solve")]
pub(crate) struct RawSolve {
    /// The method.
    #[serde(default)]
    pub method: Method,
    /// The quantity that is minimised.
    #[serde(default)]
    pub objective: Objective,
    /// The variables in which genetic and differential-evolution move.
    #[serde(default)]
    pub variables: Variables,
    /// Every draw comes from this number; 1 where silent.
    pub seed: Option<Count>,
    /// The number of distinct answers, 1 to 100; 5 where silent.
    pub candidates: Option<Count>,
    /// The largest number of evaluations of the objective; 200000 where silent.
    pub evaluations: Option<Count>,
    /// Seconds at most, of search and advice together; a run that the clock ends cannot be repeated to the digit.
    pub time_limit_s: Option<Number>,
    /// Whether advice is worked out beside the answers: which requirements conflict, what can be built, what limits cost; where silent, true.
    pub advice: Option<bool>,
    /// How many times the error of the closest candidate the picks (the smallest, the best transmitting) may have, 1 to 1000; 1.5 where silent. With a tolerance they keep within it instead.
    pub picks_within: Option<Number>,
    /// Whether a lower bound of the sum of squares is proved after the search (prescribed timing); where silent, false.
    #[serde(default)]
    pub certify: bool,
    /// The genetic algorithm's parameters.
    #[serde(default)]
    pub genetic: OnlyTable<GeneticParameters>,
    /// Differential evolution's parameters.
    #[serde(default, rename = "differential-evolution")]
    pub differential_evolution: OnlyTable<DifferentialEvolutionParameters>,
}

/// The options of a certificate.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Certify")]
pub(crate) struct RawCertify {
    /// The relative gap allowed between the best candidate and the proved bound, between 0 and 1; 1e-4 where silent.
    pub gap: Option<Number>,
    /// Seconds at most, up to 1e6; what is proved by then counts; 300 where silent.
    pub time_limit_s: Option<Number>,
}
