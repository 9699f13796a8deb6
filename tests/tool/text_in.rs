//! What good files mean: defaults, overrides, habits of spreadsheets, round trips.

use linkwright::internals::files::problem_template::problem_template;
use linkwright::internals::files::schema::{SchemaKind, schema};
use linkwright::internals::files::{linkage_file, points_file, problem_file};
use linkwright::internals::mechanism::Unit;
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide, FourBar, LinkageType, NaturalCoordinates};
use linkwright::internals::task::AngleOffset;
use linkwright::internals::task::TaskKind;
use linkwright::internals::task::spec::{Limits, Method, RequireSpec, SolveSpec};
use proptest::prelude::*;

fn parsed(text: &str) -> problem_file::ProblemFile {
    problem_file::parse("dir/arm.toml", text, None, &[]).unwrap_or_else(|d| panic!("{d}"))
}

/// A target of size 5 around (1.5, 2).
const PLAIN: &str = "format = 1\n[task.path]\npoints = [[0, 0], [3, 4]]\n";

#[test]
fn silent_keys_get_the_documented_defaults() {
    let file = parsed(PLAIN);
    assert_eq!(file.name, "arm");
    assert_eq!((file.source, file.unit, file.expect, file.warnings), (None, None, None, Vec::new()));
    let design = file.spec.design;
    assert_eq!(design.crank_pivot, Some([Limits(-23.5, 26.5), Limits(-23.0, 27.0)]));
    assert_eq!(design.follower_pivot, design.crank_pivot);
    for length in [design.a, design.b, design.c] {
        assert_eq!(length, Some(Limits(0.1, 25.0)));
    }
    assert_eq!((design.coupler_x, design.coupler_y), (Some(Limits(-25.0, 25.0)), Some(Limits(-25.0, 25.0))));
    assert_eq!((design.d, design.e, design.ground_angle_deg), (None, None, None));
    // Links of 3 sizes at most, of a target whose size is 5.
    assert_eq!(file.spec.require, RequireSpec { longest_max: Some(15.0), ..RequireSpec::default() });
    assert_eq!(file.spec.require.link_ratio_max, 20.0);
    assert_eq!(file.spec.solve, SolveSpec::default());
    let path = file.spec.task;
    assert!(!path.closed && path.weight.is_none() && path.tolerance.is_none() && path.timing.is_none());
}

#[test]
fn longest_max_is_a_length_or_any() {
    let asked =
        |value: &str| parsed(&format!("{PLAIN}[require]\nlongest_max = {value}\n")).spec.require.longest_max;
    assert_eq!((asked("7.5"), asked("8"), asked("\"any\"")), (Some(7.5), Some(8.0), None));
    let set = |value: &str| {
        let typed = [("require.longest_max".to_owned(), value.to_owned())];
        problem_file::parse("arm.toml", PLAIN, None, &typed).map(|file| file.spec.require.longest_max)
    };
    assert_eq!((set("any"), set("\"any\""), set("7")), (Ok(None), Ok(None), Ok(Some(7.0))));
    for (value, says) in [
        ("none", "\"none\" is neither a length nor \"any\""),
        ("\"20\"", "expected a length, or \"any\" for no limit, found the text \"20\""),
        ("[1, 2]", "expected a length, or \"any\" for no limit, found a list"),
        ("0", "longest_max = 0: a length must be positive"),
        ("-1", "longest_max = -1: a length must be positive"),
        ("1e13", "is too large"),
        ("nan", "nan is not a number"),
    ] {
        let refused = set(value).expect_err(value);
        assert!(refused.message.contains(says), "{value}: {refused}");
        assert!(refused.help.is_some() || value.starts_with('['), "{value}: {refused}");
    }
}

#[test]
fn links_are_three_sizes_long_at_most_where_nothing_else_is_said_about_lengths() {
    let longest = |lines: &str| parsed(&format!("{PLAIN}{lines}")).spec.require.longest_max;
    for silent in [
        "[design]\nA = [0, 0]\n",
        "[design]\nA = [[-1, 1], 0]\nB = [15, 0]\n",
        "[design]\nground_angle_deg = 10\n",
        "[require]\nfootprint_in = [-9, -9, 9, 9]\n",
        "[require]\npivots_in = [-9, -9, 9, 9]\n",
        "[require]\nlink_ratio_max = 5\n",
    ] {
        assert_eq!(longest(silent), Some(15.0), "{silent}");
    }
    for key in ["a", "b", "c", "d", "e", "ground", "coupler_x", "coupler_y"] {
        assert_eq!(longest(&format!("[design]\n{key} = [0.5, 40]\n")), None, "{key}");
    }
    assert_eq!(longest("[require]\nextent_max = 100\n"), None);
    assert_eq!(longest("[task.path.timing]\ncrank_deg = [0, 30]\n"), None);
    // Where the pivots are, no shorter links would do: 15.1 apart, and more than twice 15 from a point.
    for far in [
        "[design]\nA = [0, 0]\nB = [15.1, 0]\n",
        "[design]\nA = [-26, -26]\n",
        "[require]\npivots_in = [40, 0, 60, 10]\n",
    ] {
        assert_eq!(longest(far), None, "{far}");
    }
    // A bare list of points, and one whose size is beyond all numbers.
    let folder = tempfile::tempdir().unwrap();
    let bare = |text: &str| {
        let csv = folder.path().join("p.csv");
        std::fs::write(&csv, text).unwrap();
        problem_file::load_any(&csv, &[]).unwrap().spec.require.longest_max
    };
    assert_eq!(bare("x,y\n0,0\n3,4\n"), Some(15.0));
    assert_eq!(bare("x,y,crank_deg\n0,0,10\n3,4,20\n"), None);
    assert_eq!(bare("x,y\n-1e12,0\n1e12,4\n"), Some(1e12));
}

#[test]
fn every_key_arrives_in_the_specification() {
    let file = parsed(
        r#"
format = 1
name = "every key"
source = "nobody, 2000"
unit = "in"
[task.path]
points = [[0, 0], [3, 4], [5, 5.5]]
closed = true
tolerance = 0.25
[task.path.timing]
crank_deg = [0, 20, -40.5]
offset = "ground"
[design]
A = [[-1, 1], 2]
B = [4, [0, 1e1]]
a = 2
b = [1, 9]
ground_angle_deg = [-30, 30]
coupler_x = 0
[require]
type = ["double-crank", "crank-rocker"]
transmission_deg_min = 30
transmission_over = "used"
link_ratio_max = 10
pivots_in = [-10, -10, 10, 20]
order = "any"
circuit = "any"
branch = "any"
[solve]
method = "differential-evolution"
variables = "nine"
seed = 9223372036854775807
candidates = 9
evaluations = 1e6
time_limit_s = 0.5
[solve.genetic]
population = 50
[solve.differential-evolution]
population = 60
"#,
    );
    assert_eq!((file.name.as_str(), file.unit), ("every key", Some(Unit::In)));
    let path = &file.spec.task;
    assert!(path.closed);
    assert_eq!(path.tolerance, Some(vec![0.25; 3]));
    let timing = path.timing.as_ref().unwrap();
    assert_eq!((timing.crank_deg.as_slice(), timing.offset), (&[0.0, 20.0, -40.5][..], AngleOffset::Ground));
    let design = &file.spec.design;
    assert_eq!(design.crank_pivot, Some([Limits(-1.0, 1.0), Limits(2.0, 2.0)]));
    assert_eq!(design.follower_pivot, Some([Limits(4.0, 4.0), Limits(0.0, 10.0)]));
    assert!(design.a.is_some_and(|a| a.is_fixed()));
    let (require, solve) = (&file.spec.require, &file.spec.solve);
    assert_eq!(require.types, [LinkageType::CrankRocker, LinkageType::DoubleCrank]);
    assert_eq!((require.transmission_deg_min, require.link_ratio_max), (Some(30.0), 10.0));
    assert_eq!((solve.method, solve.seed), (Method::DifferentialEvolution, i64::MAX as u64));
    assert_eq!((solve.candidates, solve.evaluations, solve.time_limit_s), (9, 1_000_000, Some(0.5)));
    assert_eq!((solve.genetic.population, solve.differential_evolution.population), (50, 60));
}

#[test]
fn one_type_may_stand_without_a_list() {
    let file = parsed(&format!("{PLAIN}[require]\ntype = \"crank-rocker\"\n"));
    assert_eq!(file.spec.require.types, [LinkageType::CrankRocker]);
}

#[test]
fn what_is_expected_never_reaches_the_specification() {
    let expect = "[expect]\nbest_known_sum_sq = 0.5\ngoal_sum_sq = 0.75\n\
                  [[expect.published]]\nsource = \"a, 2000\"\n\
                  vector = []\n\
                  [[expect.published]]\nsource = \"b, 2001\"\nvector = [1, 2, 3, 4, 5, 6, 7, 8, 9]\nt1 = -1\n\
                  crank_deg = [0, 10]\nprinted_sum_sq = 0.0337\n";
    let (without, with) = (parsed(PLAIN), parsed(&format!("{PLAIN}{expect}")));
    assert_eq!(without.spec, with.spec);
    let expect = with.expect.unwrap();
    assert_eq!((expect.best_known_sum_sq, expect.goal_sum_sq), (Some(0.5), Some(0.75)));
    assert_eq!(expect.published[1].vector.len(), 9);
    assert_eq!(expect.published[1].t1, Some(AssemblyMode::Minus));
    assert_eq!(expect.published[1].printed_sum_sq, Some(0.0337));
}

#[test]
fn overrides_mean_what_the_keys_of_the_file_mean() {
    let set = |pairs: &[(&str, &str)]| {
        let pairs: Vec<(String, String)> = pairs.iter().map(|(k, v)| ((*k).into(), (*v).into())).collect();
        problem_file::parse("arm.toml", PLAIN, None, &pairs).unwrap_or_else(|d| panic!("{d}"))
    };
    let file = set(&[
        ("solve.candidates", "9"),
        ("solve.method", "genetic"),
        ("solve.genetic.population", "40"),
        ("design.a", "[1, 2]"),
        ("require.type", "crank-rocker"),
        ("unit", "mm"),
        ("name", "second try"),
        ("solve.candidates", "8"),
        ("task.path.points", "[[0, 0], [1, 1], [2, 0]]"),
    ]);
    assert_eq!((file.spec.solve.candidates, file.spec.solve.method), (8, Method::Genetic));
    assert_eq!(file.spec.solve.genetic.population, 40);
    assert_eq!(file.spec.design.a, Some(Limits(1.0, 2.0)));
    assert_eq!((file.name.as_str(), file.unit), ("second try", Some(Unit::Mm)));
    assert_eq!(file.spec.task.points.len(), 3);
    assert_eq!(set(&[("solve.seed", "7")]).name, "arm");
    let inline = "format = 1\ntask = {path = {points = [[0, 0], [1, 1]]}}\nsolve.seed = 3\n";
    let pairs = [("task.path.closed".into(), "true".into()), ("solve.genetic.elites".into(), "3".into())];
    let file = problem_file::parse("arm.toml", inline, None, &pairs).unwrap_or_else(|d| panic!("{d}"));
    assert!(file.spec.task.closed && file.spec.solve.seed == 3 && file.spec.solve.genetic.elites == 3);
}

#[test]
fn equal_neighbours_at_equal_crank_angles_are_accepted() {
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [3, 4], [3, 4], [0, 0]]\n\
                [task.path.timing]\ncrank_deg = [0, 20, 380, 360]\n";
    assert_eq!(parsed(text).spec.task.points.len(), 4);
    assert_eq!(parsed(&PLAIN.replace("[3, 4]", "[3, 4], [0, 0]")).spec.task.points.len(), 3);
}

#[test]
fn flat_couplers_and_agreeing_bounds_are_accepted() {
    for design in [
        "b = 5\nd = 2\ne = 3",
        "b = 0.3\nd = 0.1\ne = 0.2",
        "b = 5\nd = 5\ne = 0",
        "A = [0, 0]\nB = [3, 4]\nground = 5\nground_angle_deg = 53.130102",
        "A = [0, 0]\nB = [-1, 0]\nground_angle_deg = [170, 190]",
        "A = [0, 0]\nB = [-1, -1]\nground_angle_deg = [200, 240]",
        "A = [0, 0]\nB = [1, 0]\nground_angle_deg = [350, 370]",
        "b = 5\nd = 5\ne = [4, 5]\ncoupler_x = 3\ncoupler_y = [3, 4]",
        "B = [4, 1]\nground = [1, 2]\nground_angle_deg = 0",
        "ground = [0, 3]\nd = [0, 3]",
    ] {
        parsed(&format!("{PLAIN}[design]\n{design}\n"));
    }
}

#[test]
fn lengths_that_break_the_link_ratio_are_warned_of() {
    let file = parsed(&format!("{PLAIN}[design]\na = 1\nc = 100\n"));
    let warning = file.warnings.first().expect("a warning");
    assert!(warning.message.contains("c is 100 and a is 1, while link_ratio_max is 20"), "{warning}");
    assert!(parsed(&format!("{PLAIN}[design]\na = 1\nc = 20\n")).warnings.is_empty());
}

#[test]
fn habits_of_spreadsheets_are_read() {
    let plain = points_file::parse("p.csv", "x,y\n0,0\n1.5,-2e-3\n").unwrap();
    for text in [
        "\u{feff}x,y\r\n0,0\r\n1.5,-2e-3\r\n",
        "# a path\n\nx,y\n# first\n0,0\n  # second\n1.5,-2e-3",
        " x , y \n 0 , 0 \n 1.5 ,\t-2e-3 \n",
        "\"x\",\"y\"\n\"0\",\"0\"\n\"1.5\",\"-2e-3\"\n",
        "X,Y\n0,0\n1.5,-0.002\n,\n\n",
        "y,x\n0,0\n-2e-3,1.5\n",
        "sep=,\r\nx,y\r\n0,0\r\n1.5,-2e-3\r\n",
        "x, \"y\"\n0, \"0\"\n\"1.5\", \"-2e-3\"\n",
        "x,y,\n0,0,\n1.5,-2e-3,,\n,,,\n",
        "x,y\r0,0\r1.5,-2e-3\r",
    ] {
        let read = points_file::parse("p.csv", text).unwrap_or_else(|d| panic!("{d}"));
        assert_eq!(read.points, plain.points, "{text:?}");
        assert!(read.warnings.is_empty());
    }
}

#[test]
fn columns_stand_in_any_order_and_strangers_are_named() {
    let text =
        "remark,tolerance,weight,crank_deg,y,x,wieght\nstart,0,2,-10,1,2,9\n\"a, b\",0.5,1,350,3,4,9\n";
    let read = points_file::parse("p.csv", text).unwrap();
    assert_eq!(read.points, [[2.0, 1.0], [4.0, 3.0]]);
    assert_eq!(read.crank_deg, Some(vec![Some(-10.0), Some(350.0)]));
    assert_eq!(read.weight, Some(vec![2.0, 1.0]));
    assert_eq!(read.tolerance, Some(vec![0.0, 0.5]));
    assert_eq!(&read.text[read.rows[1].clone()], "\"a, b\",0.5,1,350,3,4,9");
    assert_eq!(read.warnings.len(), 1);
    assert_eq!(read.warnings[0].message, "the columns \"remark\", \"wieght\" are not used");
}

#[test]
fn a_points_file_gives_points_timing_weights_and_tolerances() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("heart (2).csv");
    std::fs::write(&csv, "x,y,crank_deg,weight,tolerance\n0,0,0,1,0.1\n3,4,20,2,0.2\n").unwrap();
    let bare = problem_file::from_points_file(&csv, &[("solve.seed".into(), "3".into())]).unwrap();
    assert_eq!((bare.name.as_str(), bare.spec.solve.seed), ("heart -2-", 3));

    let toml = folder.path().join("heart.toml");
    std::fs::write(&toml, "format = 1\n[task.path]\nfile = \"heart (2).csv\"\n[solve]\nseed = 3\n").unwrap();
    let named = problem_file::load(&toml, &[]).unwrap();
    assert_eq!((named.name.as_str(), &named.spec), ("heart", &bare.spec));
    let path = named.spec.task;
    assert_eq!((path.weight, path.tolerance), (Some(vec![1.0, 2.0]), Some(vec![0.1, 0.2])));
    let timing = path.timing.unwrap();
    assert_eq!((timing.crank_deg, timing.offset), (vec![0.0, 20.0], AngleOffset::Free));

    let offset = [("task.path.timing.offset".into(), "fixed".into())];
    let fixed = problem_file::load(&toml, &offset).unwrap();
    assert_eq!(fixed.spec.task.timing.unwrap().offset, AngleOffset::Fixed);
}

#[test]
fn tolerances_and_weights_of_points_can_stand_beside_them() {
    let text = format!("{PLAIN}tolerance = [0.1, 0]\nweight = [1, 2.5]\n");
    let path = parsed(&text).spec.task;
    assert_eq!((path.tolerance, path.weight), (Some(vec![0.1, 0.0]), Some(vec![1.0, 2.5])));
    // What is typed takes its place, for all points.
    let typed = [("task.path.tolerance".into(), "0.3".into())];
    let path = problem_file::parse("arm.toml", &text, None, &typed).unwrap().spec.task;
    assert_eq!(path.tolerance, Some(vec![0.3; 2]));
    for (lines, line, says) in [
        ("tolerance = [0.1]", 4, "2 points and 1 tolerance"),
        ("tolerance = []", 4, "2 points and 0 tolerances"),
        ("tolerance = [0.1, -2]", 4, "tolerance = -2: a distance cannot be negative"),
        ("tolerance = \"small\"", 4, "a number for all points, or a list of one for each"),
        ("tolerance = [1, nan]", 4, "nan is not a number"),
        ("weight = [1, 2, 3]", 4, "2 points and 3 weights"),
        ("weight = [1, 0]", 4, "weight = 0: a weight is positive"),
        ("samples = 20\nweight = [1, 2]", 4, "the weights belong to the old ones"),
        ("samples = 20\ntolerance = [1, 2]", 4, "the tolerances belong to the old ones"),
    ] {
        let refused = problem_file::parse("arm.toml", &format!("{PLAIN}{lines}\n"), None, &[]).unwrap_err();
        assert!(refused.message.contains(says), "{lines}: {refused}");
        assert_eq!(refused.line_column().map(|(line, _)| line), Some(line), "{lines}");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.csv"), "x,y,weight\n0,0,1\n3,4,2\n").unwrap();
    let toml = folder.path().join("p.toml");
    std::fs::write(&toml, "format = 1\n[task.path]\nfile = \"p.csv\"\nweight = [1, 2]\n").unwrap();
    assert!(problem_file::load(&toml, &[]).unwrap_err().message.contains("as a column of p.csv"));
}

#[test]
fn cells_that_nobody_reads_may_be_away() {
    let read = points_file::parse("p.csv", "x,y,note\n0,0\n3,4,end\n").unwrap();
    assert_eq!(read.points, [[0.0, 0.0], [3.0, 4.0]]);
}

#[test]
fn digitised_points_are_smoothed_and_resampled_and_kept() {
    let points: Vec<String> = (0..40)
        .map(|i| {
            let x = f64::from(i);
            format!("[{x}, {}]", 0.02 * x * x + 0.1 * (2.4 * x).sin())
        })
        .collect();
    let text = format!("format = 1\n[task.path]\npoints = [{}]\n", points.join(", "));
    let plain = parsed(&text).spec.task;
    assert!(plain.raw.is_none());
    let smooth = parsed(&format!("{text}smooth = 4\n")).spec.task;
    assert_eq!(smooth.points.len(), 40);
    let raw = smooth.raw.clone().expect("kept");
    assert_eq!((&raw.points, raw.smooth, raw.samples), (&plain.points, Some(4.0), None));
    let off = |path: &[[f64; 2]]| {
        let inner = path.iter().skip(3).take(34).map(|[x, y]| (y - 0.02 * x * x).powi(2));
        inner.sum::<f64>().sqrt()
    };
    assert!(off(&smooth.points) < 0.2 * off(&plain.points), "{} {}", off(&smooth.points), off(&plain.points));

    let both = parsed(&format!("{text}smooth = 4\nsamples = 15\n")).spec.task;
    let steps: Vec<f64> =
        both.points.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).collect();
    let mean = steps.iter().sum::<f64>() / 14.0;
    assert_eq!(both.points.len(), 15);
    assert!(steps.iter().all(|s| (s / mean - 1.0).abs() < 0.01), "{steps:?}");
    assert_eq!(both.points, both.raw.expect("kept").target(false));
}

#[test]
fn a_drawing_is_a_target_of_a_problem_and_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("ring.svg");
    let drawing =
        "<svg width='10cm' viewBox='0 0 100 100'><circle id='big' r='10'/><circle id='small' r='5'/></svg>";
    std::fs::write(&svg, drawing).unwrap();
    let bare = problem_file::load_any(&svg, &[]).unwrap();
    assert_eq!((bare.name.as_str(), bare.unit, bare.warnings.len()), ("ring", Some(Unit::Mm), 1));
    assert!(bare.spec.task.closed && bare.spec.task.points.len() == 60);
    let text = problem_template("my ring", TaskKind::Path, Some("ring.svg")).unwrap();
    let named =
        problem_file::parse("r.toml", &text, Some(folder.path()), &[]).unwrap_or_else(|d| panic!("{d}"));
    assert_eq!(named.spec.task, bare.spec.task);
    let set = |pairs: &[(&str, &str)]| {
        let pairs: Vec<(String, String)> =
            pairs.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
        problem_file::load_any(&svg, &pairs).unwrap_or_else(|d| panic!("{d}"))
    };
    let small = set(&[("task.path.svg_id", "small"), ("task.path.samples", "4"), ("unit", "cm")]);
    assert!(small.warnings.is_empty() && small.unit == Some(Unit::Cm));
    let path = small.spec.task;
    assert!(path.points.len() == 4 && (path.points[0][0] - 0.5).abs() < 1e-12, "{:?}", path.points);
    assert!(!set(&[("task.path.closed", "false")]).spec.task.closed);
}

#[test]
fn the_template_runs_as_it_is() {
    let text = problem_template("my arm", TaskKind::Path, None).unwrap();
    let file = problem_file::parse("arm.toml", &text, None, &[]).unwrap_or_else(|d| panic!("{d}"));
    assert_eq!(file.name, "my arm");
    assert!(file.warnings.is_empty() && file.spec.task.closed);
    assert_eq!(file.spec.require.types, [LinkageType::CrankRocker, LinkageType::DoubleCrank]);

    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p \"1\".csv"), "x,y\n0,0\n3,4\n").unwrap();
    let text = problem_template("arm", TaskKind::Path, Some("p \"1\".csv")).unwrap();
    let file =
        problem_file::parse("arm.toml", &text, Some(folder.path()), &[]).unwrap_or_else(|d| panic!("{d}"));
    assert_eq!(file.spec.task.points.len(), 2);
    assert!(problem_template("../arm", TaskKind::Path, None).is_err());
}

#[test]
fn every_commented_key_of_the_template_works() {
    let text = problem_template("arm", TaskKind::Path, None).unwrap();
    let active: String = text
        .lines()
        .map(|line| match line.strip_prefix("# ") {
            Some(key) if is_key(key) => key.replace("[0, 30, 60]", &angles()),
            _ => line.to_owned(),
        })
        .filter(|line| !line.contains("direction = "))
        .map(|line| line + "\n")
        .collect();
    let file =
        problem_file::parse("arm.toml", &active, None, &[]).unwrap_or_else(|d| panic!("{d}\n{active}"));
    assert!(file.warnings.is_empty(), "{}", file.warnings[0]);
    assert!(file.spec.task.timing.is_some() && file.spec.require.footprint_in.is_some());
    assert!(file.spec.design.ground.is_some() && file.spec.solve.time_limit_s.is_some());
}

/// Whether a comment is a key with a value or the header of a table.
fn is_key(comment: &str) -> bool {
    let name = |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    comment.starts_with('[') || comment.split_once(" = ").is_some_and(|(key, _)| name(key))
}

/// One crank angle for each point of the template.
fn angles() -> String {
    let list: Vec<String> = (0..12).map(|i| (30 * i).to_string()).collect();
    format!("[{}]", list.join(", "))
}

#[test]
fn the_schema_names_every_table_and_refuses_other_keys() {
    let schema = schema(SchemaKind::Problem);
    let (path, motion) = ("/$defs/Path", "/$defs/Motion");
    for (table, keys) in [
        ("", &["format", "name", "unit", "expect"][..]),
        ("/properties/task", &["path", "motion"]),
        (path, &["points", "file", "svg", "svg_id", "samples", "smooth", "closed", "timing"]),
        (motion, &["poses", "file", "closed", "angle_weight", "tolerance", "tolerance_deg", "weight"]),
        ("/$defs/Timing", &["crank_deg", "offset"]),
        ("/$defs/Design", &["A", "B", "a", "ground_angle_deg", "coupler_y"]),
        ("/$defs/Require", &["type", "footprint_in", "branch"]),
        ("/$defs/Solve", &["method", "seed", "genetic", "differential-evolution"]),
    ] {
        let definition = schema.pointer(table).unwrap_or_else(|| panic!("{table}"));
        assert_eq!(definition["additionalProperties"], false, "{table}");
        for key in keys {
            assert!(definition["properties"][key].is_object(), "{table}: {key}");
        }
    }
    assert_eq!(schema["required"], serde_json::json!(["format", "task"]));
    assert!("leaves".parse::<SchemaKind>().is_err());
}

#[test]
fn a_vector_loop_is_a_linkage() {
    let text = "format = 1\nname = \"De Castro\"\nunit = \"mm\"\n[vector_loop]\nO1 = [0, 0]\nO2 = [-350, 0]\n\
                L2 = 700\nL3 = 300\nL4 = 500\nZ1 = 200\nbeta_deg = 30\nt1 = 1\n";
    let file = linkage_file::parse("castro.toml", text).unwrap();
    assert_eq!((file.name.as_str(), file.unit), ("De Castro", Some(Unit::Mm)));
    assert_eq!(file.linkage.crank(), 700.0);
    assert!((file.linkage.crank_side() - 200.0).abs() <= 8.0 * f64::EPSILON * 200.0);
    assert_eq!(file.linkage.side(), CouplerSide::Plus);
}

proptest! {
    #[test]
    fn a_linkage_file_reads_back_to_the_same_digits(
        pivots in prop::array::uniform4(-1e9_f64..1e9),
        links in prop::array::uniform3(1e-9_f64..1e9),
        offset in prop::array::uniform2(-1e9_f64..1e9),
        plus in any::<bool>(),
    ) {
        let [a, b, c] = links;
        let (d, e) = (offset[0].hypot(offset[1]), (offset[0] - b).hypot(offset[1]));
        let linkage = FourBar::new(NaturalCoordinates {
            crank_pivot: [pivots[0], pivots[1]],
            follower_pivot: [pivots[2], pivots[3]],
            crank: a,
            coupler: b,
            follower: c,
            crank_side: d,
            follower_side: e,
            assembly: if plus { AssemblyMode::Plus } else { AssemblyMode::Minus },
            side: CouplerSide::of(offset[1]),
        });
        let linkage = linkage.map_err(|e| TestCaseError::reject(e.to_string()))?;
        let text = linkage_file::to_toml("arm 1", Some(Unit::Cm), &linkage);
        let read = linkage_file::parse("other.toml", &text).map_err(|d| TestCaseError::fail(d.to_string()))?;
        prop_assert_eq!(read.linkage, linkage);
        prop_assert_eq!((read.name.as_str(), read.unit), ("arm 1", Some(Unit::Cm)));
    }

    #[test]
    fn no_text_makes_a_reader_panic(text in "(\\PC|[\\n\\[\\]=,.\"#0-9a-z]){0,200}") {
        let _ = problem_file::parse("f", &text, None, &[]).map_err(|d| d.to_string());
        let _ = linkage_file::parse("f", &text).map_err(|d| d.to_string());
        let _ = points_file::parse("f", &text).map_err(|d| d.to_string());
        let points = format!("x,y\n{text}");
        let _ = points_file::parse("f", &points).map_err(|d| d.to_string());
        let set = [(text.clone(), text.clone())];
        let _ = problem_file::parse("f", PLAIN, None, &set).map_err(|d| d.to_string());
        let key = [("design.a".to_owned(), text)];
        let _ = problem_file::parse("f", PLAIN, None, &key).map_err(|d| d.to_string());
    }
}

#[test]
fn how_a_closed_path_is_closed_is_one_way_or_any() {
    use linkwright::internals::task::spec::ClosingPolicy;
    let with = |tables: &str| parsed(&format!("{PLAIN}{tables}"));
    assert_eq!(with("").spec.require.closing, ClosingPolicy::OneWay);
    assert_eq!(with("[require]\nclosing = \"any\"\n").spec.require.closing, ClosingPolicy::Any);
    assert_eq!(with("[require]\nclosing = \"one-way\"\n").spec.require.closing, ClosingPolicy::OneWay);
}
