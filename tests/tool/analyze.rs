//! `analyze` and `cognates` as a person meets them.

use crate::common::root;
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

fn linkwright(folder: &Path, arguments: &[&str]) -> Answer {
    let output = Command::cargo_bin("linkwright")
        .expect("it is built")
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("it runs");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: String::from_utf8(output.stdout).expect("text"),
        stderr: String::from_utf8(output.stderr).expect("text"),
    }
}

fn shipped(name: &str) -> String {
    root().join("problems").join(name).display().to_string()
}

const HEADER: &str = "crank_deg,t1,t2,Cx,Cy,Dx,Dy,Px,Py,coupler_deg,follower_deg,transmission_deg,omega3_rad_s,\
omega4_rad_s,vCx,vCy,vDx,vDy,vPx,vPy,alpha3_rad_s2,alpha4_rad_s2,aCx,aCy,aDx,aDy,aPx,aPy,status";

#[test]
fn the_example_of_de_castro_stands_in_table_csv_and_json() {
    let folder = TempDir::new().expect("a folder");
    let example = shipped("seeds/de-castro-2-1.toml");
    let arguments = ["analyze", &example, "--angle", "90,120,150,180", "--omega", "5", "--csv", "out.csv"];
    let run = linkwright(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for figure in ["-150.6966", "589.5396", "10.09733", "30.45945", "Triple-rocker"] {
        assert!(run.stdout.contains(figure), "{figure} in\n{}", run.stdout);
    }
    let csv = fs::read_to_string(folder.path().join("out.csv")).expect("it was written");
    assert_eq!(csv.lines().next(), Some(HEADER));
    assert_eq!(csv.lines().count(), 5);
    let json = linkwright(folder.path(), &["analyze", &example, "--angle", "120", "--omega", "5", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    let row = &value["configurations"][0]["rows"][0];
    assert_eq!(row["status"], "ok");
    assert!((row["alpha4_rad_s2"].as_f64().expect("a number") - 30.45945).abs() < 5e-6);
    assert!((row["P"][1].as_f64().expect("a number") - 589.540).abs() < 5e-4);
}

#[test]
fn methods_stand_side_by_side_and_say_where_they_are_singular() {
    let folder = TempDir::new().expect("a folder");
    let example = shipped("seeds/de-castro-2-1.toml");
    let arguments = ["analyze", &example, "--angle", "90,120", "--method", "algebraic,complex,fixed-point"];
    let run = linkwright(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("singular: Ax = d"), "{}", run.stdout);
    assert_eq!(run.stdout.matches("fixed-point").count(), 2, "{}", run.stdout);
    let negative = linkwright(folder.path(), &["analyze", &example, "--angle", "-120,150"]);
    assert_eq!(negative.code, 0, "{}", negative.stderr);
    let unknown = linkwright(folder.path(), &["analyze", &example, "--method", "magic"]);
    assert_eq!(unknown.code, 2);
    assert!(unknown.stderr.contains("natural, algebraic, complex, fixed-point"), "{}", unknown.stderr);
}

#[test]
fn all_four_configurations_are_given() {
    let folder = TempDir::new().expect("a folder");
    let example = shipped("seeds/romero.toml");
    let run = linkwright(folder.path(), &["analyze", &example, "--all-configurations", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let signs: Vec<(i64, i64)> = value["configurations"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|c| (c["linkage"]["t1"].as_i64().expect("a sign"), c["linkage"]["t2"].as_i64().expect("a sign")))
        .collect();
    assert_eq!(signs, [(1, 1), (1, -1), (-1, 1), (-1, -1)]);
}

/// A linkage file of five lengths.
fn write_linkage(folder: &Path, name: &str, b: &str, lengths: [f64; 5]) -> String {
    let [a, bb, c, d, e] = lengths;
    let text = format!(
        "format = 1\n[linkage]\nA = [0, 0]\nB = {b}\na = {a}\nb = {bb}\nc = {c}\nd = {d}\ne = {e}\nt1 = 1\nt2 = 1\n"
    );
    fs::write(folder.join(name), text).expect("written");
    name.to_owned()
}

#[test]
fn degenerate_linkages_have_a_status_and_no_nan_anywhere() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    let cases = [
        // (linkage, the statuses that must occur over a turn)
        (
            write_linkage(path, "parallelogram.toml", "[5, 0]", [2.0, 5.0, 2.0, 1.0, 4.5]),
            vec!["ok", "singular"],
        ),
        (write_linkage(path, "triple.toml", "[3.5, 0]", [7.0, 3.0, 5.0, 2.0, 2.0]), vec!["ok", "open"]),
        (write_linkage(path, "coincident.toml", "[0, 0]", [2.0, 5.0, 4.0, 3.0, 3.0]), vec!["ok"]),
        (write_linkage(path, "on-b.toml", "[2, 0]", [2.0, 3.0, 3.0, 3.0, 3.0]), vec!["undetermined", "ok"]),
        (write_linkage(path, "apart.toml", "[50, 0]", [2.0, 3.0, 3.0, 3.0, 3.0]), vec!["open"]),
    ];
    for (file, statuses) in cases {
        let arguments = [
            "analyze", &file, "--cycle", "360", "--omega", "3", "--alpha", "1", "--csv", "out.csv", "--svg",
            "out.svg",
        ];
        let run = linkwright(path, &arguments);
        assert_eq!(run.code, 0, "{file}: {}", run.stderr);
        let json = linkwright(path, &["analyze", &file, "--cycle", "360", "--omega", "3", "--json"]);
        serde_json::from_str::<serde_json::Value>(&json.stdout).expect("JSON");
        let csv = fs::read_to_string(path.join("out.csv")).expect("written");
        let svg = fs::read_to_string(path.join("out.svg")).expect("written");
        for text in [&run.stdout, &json.stdout, &csv, &svg] {
            assert!(
                !text.contains("NaN") && !text.contains("inf,") && !text.contains(",inf"),
                "{file}: {text}"
            );
        }
        for status in statuses {
            assert!(csv.lines().any(|line| line.ends_with(&format!(",{status}"))), "{file}: {status}");
        }
    }
    let zero = write_linkage(path, "zero.toml", "[5, 0]", [2.0, 0.0, 5.0, 1.0, 1.0]);
    let run = linkwright(path, &["analyze", &zero]);
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("zero.toml:6"), "{}", run.stderr);
}

#[test]
fn the_assembly_condition_is_printed_beside_the_sufficient_one() {
    let folder = TempDir::new().expect("a folder");
    let example = shipped("seeds/romero-condition-20.toml");
    let run = linkwright(folder.path(), &["analyze", &example, "--angle", "180"]);
    assert_eq!(run.code, 0);
    let words: String = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("= 2.9000 >= 1, holds; b^2 >= l1^2 and d^2 >= l2^2: fails"), "{}", run.stdout);
}

#[test]
fn cognates_are_written_as_linkage_files_that_trace_the_same_curve() {
    let folder = TempDir::new().expect("a folder");
    let hoeken = shipped("linkages/hoeken.toml");
    let run = linkwright(folder.path(), &["cognates", &hoeken, "--out", "two", "--svg", "all.svg"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let original =
        linkwright::internals::files::linkage_file::load(Path::new(&hoeken)).expect("it is one").linkage;
    for n in [1, 2] {
        let path = folder.path().join(format!("two/hoeken-cognate-{n}.toml"));
        let cognate = linkwright::internals::files::linkage_file::load(&path).expect("it is one").linkage;
        let start = cognate.mobility().toggles().first().map_or(0.5, |t| t.crank_angle + 1e-3);
        let curves: Vec<_> = [start, -start]
            .iter()
            .map(|at| {
                linkwright::internals::mechanism::CouplerCurve::through(
                    &cognate,
                    *at,
                    cognate.assembly(),
                    2000,
                )
            })
            .collect();
        for i in 0..36 {
            let point =
                original.position(f64::from(10 * i).to_radians()).joints().expect("a crank").coupler_point;
            let nearest =
                curves.iter().filter_map(|c| c.nearest(point)).map(|n| n.distance).fold(9.0, f64::min);
            assert!(nearest < 1e-6, "cognate {n} at {point}: {nearest}");
        }
    }
    assert!(fs::read_to_string(folder.path().join("all.svg")).expect("drawn").starts_with("<"));
    let here = linkwright(folder.path(), &["cognates", &hoeken]);
    assert_eq!(here.code, 0, "{}", here.stderr);
    assert!(folder.path().join("hoeken-cognate-1.toml").is_file(), "{}", here.stdout);
    let again = linkwright(folder.path(), &["cognates", &hoeken, "--out", "two"]);
    assert_eq!(again.code, 2, "existing files are not overwritten");
}

#[test]
fn usage_errors_name_the_option() {
    let folder = TempDir::new().expect("a folder");
    let romero = shipped("seeds/romero.toml");
    for (arguments, word) in [
        (vec!["analyze", &romero, "--angle", "a"], "--angle"),
        (vec!["analyze", &romero, "--angle", "nan"], "finite"),
        (vec!["analyze", &romero, "--cycle", "0"], "--cycle"),
        (vec!["analyze", &romero, "--omega", "1e400"], "finite"),
        (vec!["analyze", "nowhere.toml"], "no such file"),
        (vec!["analyze", &romero, "--csv", "no/such/folder.csv"], "folder.csv"),
    ] {
        let run = linkwright(folder.path(), &arguments);
        assert_eq!(run.code, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{arguments:?}: {}", run.stderr);
    }
}

#[test]
fn a_jansen_leg_is_analysed_with_every_joint() {
    let folder = TempDir::new().expect("a folder");
    let leg = shipped("linkages/jansen-leg.toml");
    let arguments =
        ["analyze", &leg, "--cycle", "360", "--rpm", "30", "--csv", "leg.csv", "--svg", "leg.svg"];
    let run = linkwright(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let words: String = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("F moves 67.908") && words.contains("22.457"), "{words}");
    let csv = fs::read_to_string(folder.path().join("leg.csv")).expect("written");
    let head = csv.lines().next().expect("a head");
    assert!(
        head.starts_with("crank_deg,Bx,By,vBx,vBy,aBx,aBy,") && head.ends_with(",aFx,aFy,status"),
        "{head}"
    );
    assert_eq!(csv.lines().count(), 361);
    assert!(csv.lines().skip(1).all(|line| line.ends_with(",ok") && !line.contains("NaN")));
    let svg = fs::read_to_string(folder.path().join("leg.svg")).expect("written");
    roxmltree::Document::parse(&svg).expect("it is XML");
    assert!(!svg.contains("NaN"));
    let json = linkwright(folder.path(), &["analyze", &leg, "--angle", "0", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    assert_eq!(value["trace"], "F");
    let refused = linkwright(folder.path(), &["analyze", &leg, "--all-configurations"]);
    assert_eq!(refused.code, 2);
    assert_eq!(linkwright(folder.path(), &["cognates", &leg]).code, 2);
}

#[test]
fn a_chain_that_cannot_turn_says_where_it_opens() {
    let folder = TempDir::new().expect("a folder");
    let text = "format = 1\n[chain.pivots]\nA = [0, 0]\nD = [10, 0]\n[chain.crank]\npivot = \"A\"\njoint = \"B\"\n\
                length = 8\n[[chain.dyad]]\njoint = \"C\"\nfrom = [\"B\", \"D\"]\nlengths = [3, 4]\nside = 1\n";
    fs::write(folder.path().join("short.toml"), text).expect("written");
    let arguments =
        ["analyze", "short.toml", "--angle", "0,180", "--omega", "1", "--csv", "out.csv", "--svg", "out.svg"];
    let run = linkwright(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("open at C") && run.stdout.contains("The crank reaches"), "{}", run.stdout);
    let csv = fs::read_to_string(folder.path().join("out.csv")).expect("written");
    assert!(csv.lines().nth(2).expect("a row").contains(",,") && !csv.contains("NaN"), "{csv}");
}

const SLIDER_COLUMNS: &str =
    "coupler_deg,transmission_deg,omega3_rad_s,alpha3_rad_s2,slider,slider_speed,slider_acceleration,status";

#[test]
fn linkages_with_a_slider_are_analysed_with_every_joint_and_the_slider() {
    let folder = TempDir::new().expect("a folder");
    // In line, 3-4-5, and its inversion: crank 3 upright, the slider is 4 ahead; B is 4 ahead, 5 from C.
    let slider = "format = 1\n[slider_crank]\nA = [0, 0]\na = 3\nb = 5\nline_point = [0, 0]\nline_deg = 0\n\
                  coupler_x = 2.5\ncoupler_y = 0\nt1 = 1\n";
    let inverted = "format = 1\n[inverted_slider_crank]\nA = [0, 0]\nB = [4, 0]\na = 3\noffset = 0\n\
                    coupler_x = 10\ncoupler_y = 0\nt1 = 1\n";
    for (text, kind, place, joints) in [
        (slider, "slider-crank", 4.0, "crank_deg,Cx,Cy,vCx,vCy,aCx,aCy,Dx,Dy,"),
        (inverted, "inverted-slider-crank", 5.0, "crank_deg,Cx,Cy,vCx,vCy,aCx,aCy,Dx,Dy,"),
    ] {
        fs::write(folder.path().join("it.toml"), text).expect("written");
        let run =
            linkwright(folder.path(), &["analyze", "it.toml", "--angle", "90", "--omega", "2", "--json"]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let value: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
        assert_eq!((&value["kind"], &value["circuits"]), (&kind.into(), &2.into()));
        let row = &value["rows"][0];
        assert!((row["slider"].as_f64().expect("a number") - place).abs() < 1e-14, "{row}");
        // The slider-crank's slider goes back with the pin, the rod turns about no point; by hand, psi' of the inversion
        // is a sin(angle) / distance = 2 * 3 * 3/25.
        let (speed, turning) = if kind == "slider-crank" { (-6.0, 0.0) } else { (4.8, 0.72) };
        assert!((row["slider_speed"].as_f64().expect("a number") - speed).abs() < 1e-13, "{row}");
        assert!((row["omega3_rad_s"].as_f64().expect("a number") - turning).abs() < 1e-13, "{row}");
        let files =
            ["analyze", "it.toml", "--cycle", "100", "--rpm", "60", "--csv", "it.csv", "--svg", "it.svg"];
        let run = linkwright(folder.path(), &[&files[..], &["--force"]].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        assert!(
            run.stdout.contains("The slider moves") && run.stdout.contains("2 circuits"),
            "{}",
            run.stdout
        );
        let csv = fs::read_to_string(folder.path().join("it.csv")).expect("written");
        let head = csv.lines().next().expect("a head");
        assert!(head.starts_with(joints) && head.ends_with(SLIDER_COLUMNS), "{head}");
        assert!(csv.lines().skip(1).all(|line| line.ends_with(",ok") && !line.contains("NaN")), "{csv}");
        let svg = fs::read_to_string(folder.path().join("it.svg")).expect("written");
        roxmltree::Document::parse(&svg).expect("it is XML");
        assert!(!svg.contains("NaN"));
        let check = linkwright(folder.path(), &["check", "it.toml"]);
        assert!(check.code == 0 && check.stdout.contains(&kind.replace("inverted-", "inverted ")));
        let refused = linkwright(folder.path(), &["analyze", "it.toml", "--method", "algebraic"]);
        assert!(refused.code == 2 && refused.stderr.contains("for four-bars"), "{}", refused.stderr);
        for command in [
            &["cognates", "it.toml", "--svg", "it.svg"][..],
            &["snap", "it.toml", "--grid", "1", "--keep", "c"],
            &["compare", "it.toml", "it.toml"],
            &["synth", "it.toml"],
        ] {
            let refused = linkwright(folder.path(), command);
            assert_eq!(refused.code, 2, "{command:?}: {}", refused.stderr);
            let plain = ["slider-crank", "linkage file", "a linkage without a target", "of four-bars"];
            let plain = plain.iter().any(|words| refused.stderr.contains(words));
            assert!(plain && !refused.stderr.contains("panicked"), "{command:?}: {}", refused.stderr);
        }
        // Its hole distances are brought to a stock.
        let snapped = linkwright(folder.path(), &["snap", "it.toml", "--grid", "0.5"]);
        assert_eq!(snapped.code, 0, "{} {}", snapped.stdout, snapped.stderr);
        assert!(!snapped.stdout.contains("NaN") && snapped.stdout.contains("stock"), "{}", snapped.stdout);
        // A slider-crank has one cognate, an inverted one none.
        let cognates = linkwright(folder.path(), &["cognates", "it.toml"]);
        if kind == "slider-crank" {
            assert!(cognates.code == 0 && cognates.stdout.contains("a 2.5  b 1.5"), "{}", cognates.stdout);
            let again = linkwright(folder.path(), &["check", "it-cognate.toml"]);
            assert_eq!(again.code, 0, "{}", again.stderr);
        } else {
            assert!(cognates.code == 2 && cognates.stderr.contains("four-bars and slider-cranks"));
        }
        // It is compared on any target.
        let target = "format = 1\n[task.path]\npoints = [[1, 2], [2, 2], [1, 1]]\n";
        fs::write(folder.path().join("target.toml"), target).expect("written");
        let compared = linkwright(folder.path(), &["compare", "it.toml", "--target", "target.toml"]);
        assert_eq!(compared.code, 0, "{}", compared.stderr);
        for command in [&["build", "it.toml"][..], &["export", "it.toml", "--format", "dxf-plates"]] {
            let run = linkwright(folder.path(), command);
            assert_eq!(run.code, 0, "{command:?}: {}", run.stderr);
        }
    }
}

#[test]
fn sliders_that_cannot_turn_have_a_status_and_no_nan_anywhere() {
    let folder = TempDir::new().expect("a folder");
    let slider = |a: &str, line: &str| {
        format!(
            "format = 1\n[slider_crank]\nA = [0, 0]\na = {a}\nb = 3\nline_point = {line}\nline_deg = 0\n\
             coupler_x = 1\ncoupler_y = 1\nt1 = -1\n"
        )
    };
    let inverted = |b: &str, offset: &str| {
        format!(
            "format = 1\n[inverted_slider_crank]\nA = [0, 0]\nB = {b}\na = 2\noffset = {offset}\n\
             coupler_x = 0\ncoupler_y = 0\nt1 = -1\n"
        )
    };
    let cases = [
        (slider("5", "[0, 0]"), vec!["ok", "open at D"]),
        (slider("3", "[0, 0]"), vec!["ok", "singular at D"]),
        (slider("1", "[0, 9]"), vec!["open at D"]),
        (inverted("[2, 0]", "0"), vec!["ok", "undetermined at D"]),
        (inverted("[2, 0]", "-1"), vec!["ok", "open at D"]),
        (inverted("[0, 0]", "1"), vec!["ok"]),
        (inverted("[0, 0]", "2"), vec!["singular at D"]),
        (inverted("[1, 0]", "9"), vec!["open at D"]),
    ];
    for (text, statuses) in cases {
        fs::write(folder.path().join("it.toml"), &text).expect("written");
        let files = ["--csv", "it.csv", "--svg", "it.svg", "--force"];
        let arguments = ["analyze", "it.toml", "--cycle", "360", "--omega", "3", "--alpha", "1"];
        let run = linkwright(folder.path(), &[&arguments[..], &files[..]].concat());
        assert_eq!(run.code, 0, "{text}: {}", run.stderr);
        let table = linkwright(folder.path(), &["analyze", "it.toml", "--omega", "3"]);
        let json = linkwright(folder.path(), &[&arguments[..], &["--json"]].concat());
        serde_json::from_str::<serde_json::Value>(&json.stdout).expect("JSON");
        let csv = fs::read_to_string(folder.path().join("it.csv")).expect("written");
        let svg = fs::read_to_string(folder.path().join("it.svg")).expect("written");
        for output in [&run.stdout, &table.stdout, &json.stdout, &csv, &svg] {
            assert!(!output.contains("NaN") && !output.contains("inf"), "{text}: {output}");
        }
        for status in statuses {
            assert!(csv.lines().any(|line| line.ends_with(&format!(",{status}"))), "{text}: {status}\n{csv}");
        }
    }
}
