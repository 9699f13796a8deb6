//! A commented problem file to start from: it can be run as it is, and is written for a user with a motor and a path, or
//! with a body that is to pass poses.

use crate::files::name;
use crate::files::name::NameError;
use crate::files::problem_file::is_drawing;
use crate::task::TaskKind;
use crate::task::requirement::RequirementKind;
use std::path::Path;

/// A closed path in mm that a crank-rocker of usual proportions draws.
const SAMPLE_POINTS: &str = "\
# The points to pass, in order, in the unit above. Many points: file = \"points.csv\" (columns x,y).
points = [
    [27.1, 91.3], [45.1, 111.6], [45.9, 123.1], [33.2, 126.0], [14.7, 120.1], [-3.5, 106.8],
    [-17.8, 89.5], [-26.6, 71.8], [-29.1, 57.1], [-25.0, 48.7], [-14.4, 50.9], [3.3, 66.7],
]
closed = true                   # the path ends where it begins
tolerance = 0.5                 # the largest error accepted at any point; remove to take the best there is
";

/// The poses of a lid that a four-bar of usual proportions opens.
const SAMPLE_POSES: &str = "\
# The poses to pass, in order: where a point of the body is to be, and the body's angle in degrees, counter-clockwise
# positive. A row of two numbers asks for the place alone. Many poses: file = \"poses.csv\" (columns x,y,angle_deg).
# Here a lid of 600 mm, given by its front edge: shut, three times on the way, and open.
poses = [
    [600, 0, 0], [579, 158, 15], [542, 284, 27], [501, 381, 37], [433, 483, 50],
]
closed = false                  # true: the motion returns to the first pose
tolerance = 3                   # the largest error of the place accepted at any pose; remove to take the best there is
tolerance_deg = 1               # and of the angle
# angle_weight = 300            # a length: an angle error of one radian counts like it; where silent, the target's size
# exact = [0, 4]                # these poses are met exactly, the others as nearly as that allows; they count from 0
# weight = [1, 1, 1, 1, 5]      # one a pose: the last counts five times
";

/// The pairs of a function, and other ways to give them.
const SAMPLE_PAIRS: &str = "\
# How far the follower is to turn as the crank turns, degrees, counter-clockwise positive: one output for each input.
# Many pairs: file = \"table.csv\" (columns input_deg,output_deg). Here a flap that opens faster and faster.
input_deg = [0, 15, 30, 45, 60, 75, 90]
output_deg = [0, 2, 8, 18, 31, 48, 67]
# Or of a formula in x: both links turn in proportion, the crank to x and the follower to the value.
# of = \"log10(x)\"
# over = [1, 2]                   # from the first to the last x
# input_range_deg = 60            # so far does the crank turn; \"free\": that is found too
# output_range_deg = 90           # so far does the follower turn, likewise
# samples = 61
sense = \"any\"                   # \"same\": both turn counter-clockwise; \"opposite\": the follower the other way
input_offset = \"free\"           # where the crank starts is free; \"ground\": inputs count from the line A to B
output_offset = \"free\"          # the same of the follower
tolerance_deg = 1               # the largest error of the output; remove to take the best there is
# weight = [1, 1, 1, 1, 1, 1, 5]  # one a pair: the last counts five times
";

/// Returns the text of a problem file called `name` for a kind of task, with sample targets or with those of a CSV file or, for a
/// path, of an SVG drawing (according to the name's ending) in the same folder.
///
/// # Errors
/// [`NameError`] if the name is not valid.
pub fn problem_template(name: &str, kind: TaskKind, from: Option<&str>) -> Result<String, NameError> {
    name::check(name)?;
    match kind {
        TaskKind::Path => Ok(path_template(name, from)),
        TaskKind::Motion => Ok(motion_template(name, from)),
        TaskKind::Function => Ok(function_template(name, from)),
    }
}

/// Returns a name as a value.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Returns the requirements, each with its comment.
fn requirements() -> String {
    RequirementKind::all().iter().map(|kind| kind.definition().template).collect()
}

fn motion_template(name: &str, poses_file: Option<&str>) -> String {
    let poses = match poses_file {
        None => SAMPLE_POSES.to_owned(),
        Some(file) => format!(
            "# The poses to pass, in order: columns x,y,angle_deg (an empty cell asks for the place alone) and optionally\n\
             # crank_deg, weight, tolerance, tolerance_deg.\n\
             file = {}\n\
             closed = false                  # true: the motion returns to the first pose\n\
             # tolerance = 2                 # the largest error of the place accepted at any pose\n\
             # tolerance_deg = 1             # and of the angle\n\
             # angle_weight = 300            # a length: an angle error of one radian counts like it\n",
            quoted(file)
        ),
    };
    let head = HEAD.replace("NAME", &quoted(name)).replace("[task.path]", "[task.motion]");
    let head = head.replace("where the points come from", "where the poses come from");
    let design = DESIGN.replace(ANY_COUPLER, PINS_APART);
    // A body that is moved by hand needs no crank that turns fully.
    let requirements = requirements().replace("type = ", "# type = ");
    let timing = TIMING.replace("task.path", "task.motion").replace("point", "pose");
    head + &poses + &timing + &design + BODY + REQUIRE + &requirements + PINS + SOLVE + END
}

fn function_template(name: &str, pairs_file: Option<&str>) -> String {
    let pairs = match pairs_file {
        None => SAMPLE_PAIRS.to_owned(),
        Some(file) => format!(
            "# How far the follower is to turn as the crank turns: columns input_deg,output_deg and optionally weight,\n\
             # tolerance_deg.\n\
             file = {}\n\
             sense = \"any\"                   # \"same\" or \"opposite\": how the follower turns with the crank\n\
             input_offset = \"free\"           # \"ground\": inputs count from the line A to B\n\
             output_offset = \"free\"          # the same of the follower\n\
             # tolerance_deg = 1             # the largest error of the output accepted\n",
            quoted(file)
        ),
    };
    let head = HEAD.replace("NAME", &quoted(name)).replace("[task.path]", "[task.function]");
    let head = head.replace("where the points come from", "where the pairs come from");
    // A follower that is moved to and fro needs no crank that turns fully.
    let requirements = requirements().replace("type = ", "# type = ");
    head + &pairs + FUNCTION_DESIGN + REQUIRE + &requirements + SOLVE + END
}

fn path_template(name: &str, points_file: Option<&str>) -> String {
    let is_drawing = points_file.is_some_and(|file| is_drawing(Path::new(file)));
    let points = match points_file {
        None => SAMPLE_POINTS.to_owned(),
        Some(file) if is_drawing => format!(
            "# The curve to trace: the drawing's first path, polyline, polygon, circle or ellipse, as points.\n\
             svg = {}\n\
             # svg_id = \"leg\"                # the id of another shape of the drawing\n\
             samples = 60                    # how many points, evenly by arc length\n\
             # closed = true                 # where silent, as it is drawn\n\
             # tolerance = 0.5               # the largest error accepted at any point\n",
            quoted(file)
        ),
        Some(file) => format!(
            "# The points to pass, in order: columns x,y and optionally crank_deg, weight, tolerance.\n\
             file = {}\n\
             closed = false                  # true: the path ends where it begins\n\
             # samples = 60                  # take so many points instead, evenly along the path\n\
             # smooth = 2                    # smooth digitised points over about this length of path\n\
             # tolerance = 0.5               # the largest error accepted at any point\n",
            quoted(file)
        ),
    };
    // A drawing may state its unit itself.
    let head =
        if is_drawing { HEAD.replace("\nunit = \"mm\" ", "\n# unit = \"mm\"") } else { HEAD.to_owned() };
    head.replace("NAME", &quoted(name))
        + &points
        + TIMING
        + DESIGN
        + POINT
        + REQUIRE
        + &requirements()
        + SOLVE
        + METHODS
        + END
        + PROOF
}

const HEAD: &str = "\
#:schema linkwright-problem.schema.json
# (For editors that complete keys: `linkwright schema problem > linkwright-problem.schema.json` beside this file.)
# A problem for linkwright: run it with `linkwright synth`, check it with `linkwright check`.
# Lines that start with # are comments; remove the # to use a key.
format = 1
name = NAME
# source = \"author, year\"       # where the points come from
unit = \"mm\"                     # mm, cm, m or in: labels lengths, scales drawings

[task.path]
";

const TIMING: &str = r#"
# Does it matter at which crank angle each point is passed? One angle a point, counter-clockwise positive.
# [task.path.timing]
# crank_deg = [0, 30, 60]       # "free" in place of an angle: any between its neighbours will do
# offset = "free"               # only the increments count; "fixed": from the x axis; "ground": from A to B
"#;

const DESIGN: &str = r#"
# Where the linkage may be. A number fixes, [min, max] bounds; what is silent is set from the target's size.
[design]
# A = [0, 0]                    # pivot of the crank: where the motor sits
# B = [[50, 200], [-50, 50]]    # pivot of the follower: x between 50 and 200, y between -50 and 50
# a = [10, 60]                  # crank
# b = [20, 200]                 # coupler
# c = [20, 200]                 # follower
# ground = [50, 200]            # from A to B
"#;

/// The design of a function.
const FUNCTION_DESIGN: &str = r#"
# The size of the linkage: the function alone says nothing about it. A number fixes, [min, max] bounds.
[design]
A = [0, 0]                      # pivot of the crank
B = [100, 0]                    # pivot of the follower
# a = [20, 300]                 # crank; where silent, a tenth to ten times the line from A to B, as are b and c
# b = [20, 300]                 # coupler
# c = [20, 300]                 # follower
"#;

/// The tracing point on the coupler.
const POINT: &str = "\
# coupler_x = [-100, 200]       # the tracing point along the coupler, from the crank's pin
# coupler_y = [-100, 100]       # and across it
";

/// The coupler's length in the lines of a path and of a motion.
const ANY_COUPLER: &str = "# b = [20, 200]                 # coupler\n";
const PINS_APART: &str =
    "b = [100, 400]                  # coupler: so far apart are the two pins in the body\n";

/// The body's point on the coupler.
const BODY: &str = "\
# coupler_x = [-500, 500]       # the body's point along the coupler, from the crank's pin
# coupler_y = [-500, 500]       # and across it
";

/// The requirements of a motion that others cannot have, or seldom.
const PINS: &str = "\
# pivot_on = { A = [[0, 0], [100, 0]] }    # the line of a fixed pivot, through two points; or a point [[x, y]]
# pins_in = [-300, -200, 300, 200]         # where in the body's own frame there is room for its two pins; or a polygon
";

const REQUIRE: &str = "
# What an answer must satisfy.
[require]
";

const SOLVE: &str = r#"
# How to search.
[solve]
candidates = 5                  # how many different answers
seed = 1                        # the same seed gives the same answers; another one may give others
# objective = "max-deviation"   # the least largest error; where silent, the least sum of squared errors
"#;

/// The methods of a path.
const METHODS: &str = r#"# method = "differential-evolution"   # or "genetic", "least-squares"; where silent, "auto" chooses
# variables = "reduced"         # for the first two of these; where silent, the literature's "nine"
"#;

const END: &str = r#"# evaluations = 200000          # how long to search
# time_limit_s = 60             # seconds at most; a run that it ends cannot be repeated to the digit
# advice = false                # the answers alone: not what conflicts, what to build or what limits cost
# picks_within = 1.5            # the smallest and the best transmitting linkage have at most this many times the least error
"#;

/// The proof of prescribed timing.
const PROOF: &str = r#"# certify = true                # with crank angles: prove afterwards how little better any linkage could be
# [certify]
# gap = 1e-4                    # until that part of the best sum is left open
# time_limit_s = 300            # or this time is over
"#;
