//! Loads as a person meets them: `analyze` with `[loads]` and with `--loads FILE`.

use crate::common::root;
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    let output = command.current_dir(folder).args(arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

fn shipped(name: &str) -> String {
    root().join("problems/linkages").join(name).display().to_string()
}

/// Hoeken's four-bar in cm, and a weight of 1 kg at P in a file of its own.
fn hoeken(folder: &Path) {
    let text = fs::read_to_string(shipped("hoeken.toml")).expect("it is there");
    fs::write(folder.join("hoeken.toml"), text.replace("format = 1", "format = 1\nunit = \"cm\""))
        .expect("a file");
    let loads = "format = 1\nunit = \"mm\"\n[[loads.force]]\nat = \"P\"\nforce_N = [0, -9.81]\n";
    fs::write(folder.join("weight.toml"), loads).expect("a file");
}

#[test]
fn the_csv_has_torque_and_joint_forces_below_a_comment_on_their_bodies() {
    let folder = TempDir::new().expect("a folder");
    hoeken(folder.path());
    let with = ["analyze", "hoeken.toml", "--cycle", "36", "--loads", "weight.toml", "--csv", "with.csv"];
    let (code, stdout, stderr) = linkwright(folder.path(), &with);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("Loads over a turn: the torque on the crank has its peak of"), "{stdout}");
    let csv = fs::read_to_string(folder.path().join("with.csv")).expect("it was written");
    let mut lines = csv.lines();
    let comment = lines.next().expect("a comment");
    assert!(comment.starts_with("# torque_N_m: of the motor on the crank"), "{comment}");
    for pair in [
        "A on ground from crank",
        "C on crank from coupler",
        "B on ground from follower",
        "D on coupler from follower",
    ] {
        assert!(comment.contains(pair), "{comment}");
    }
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let first = head.iter().position(|name| *name == "torque_N_m").expect("a column");
    let forces = ["Fx_A_N", "Fy_A_N", "Fx_C_N", "Fy_C_N", "Fx_B_N", "Fy_B_N", "Fx_D_N", "Fy_D_N"];
    assert_eq!(&head[first + 1..first + 9], forces);
    assert_eq!(head.last(), Some(&"status"));
    // T = -F . dP/dphi: against the difference of P over the rows, 10 degrees apart.
    let column = |name: &str| head.iter().position(|other| *other == name).expect("a column");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect();
    let y = |i: usize| rows[(i + 36) % 36][column("Py")] / 100.0;
    for (i, row) in rows.iter().enumerate() {
        let slope = (8.0 * (y(i + 1) - y(i + 35)) - (y(i + 2) - y(i + 34))) / (12.0 * 10_f64.to_radians());
        let torque = row[first];
        assert!((torque - 9.81 * slope).abs() < 2e-3, "{i}: {torque} {}", 9.81 * slope);
        // All outer forces together: the ground bears the weight.
        let bears = row[column("Fy_A_N")] + row[column("Fy_B_N")];
        assert!((bears + 9.81).abs() < 1e-9 && (row[column("shaking_Fy_N")] - bears).abs() < 1e-9);
    }
    // Without loads nothing changes.
    let plain = ["analyze", "hoeken.toml", "--cycle", "36", "--csv", "plain.csv"];
    assert_eq!(linkwright(folder.path(), &plain).0, 0);
    let plain = fs::read_to_string(folder.path().join("plain.csv")).expect("it was written");
    assert!(plain.starts_with("crank_deg,t1,t2,Cx") && !plain.contains("torque"));
}

#[test]
fn json_and_svg_have_the_loads_of_a_linkage_file() {
    let folder = TempDir::new().expect("a folder");
    let pump = shipped("slider-crank-loaded.toml");
    let (code, stdout, stderr) = linkwright(folder.path(), &["analyze", &pump, "--angle", "30,60", "--json"]);
    assert_eq!(code, 0, "{stderr}");
    let value: serde_json::Value = serde_json::from_str(&stdout).expect("JSON");
    // 300 turns a minute, from the file.
    assert!((value["omega2_rad_s"].as_f64().expect("a number") - 10.0 * std::f64::consts::PI).abs() < 1e-12);
    let row = &value["rows"][0]["loads"];
    assert!(row["torque_N_m"].is_f64() && row["power_W"].is_f64());
    let forces = row["forces"].as_array().expect("a list");
    assert_eq!(forces.len(), 4);
    assert_eq!((forces[3]["at"].as_str(), forces[3]["on"].as_str()), (Some("D"), Some("ground")));
    assert!(forces[3]["normal_N"].is_f64() && forces[3].get("force_N").is_none());
    assert!(value["loads"]["torque_peak_N_m"]["value"].is_f64());
    assert_eq!(value["loads"]["friction"], "left out");
    let still = linkwright(folder.path(), &["analyze", &pump, "--angle", "30", "--rpm", "0", "--json"]).1;
    let still: serde_json::Value = serde_json::from_str(&still).expect("JSON");
    assert_eq!(still["rows"][0]["loads"]["kinetic_J"], 0.0);
    let drawn = linkwright(folder.path(), &["analyze", &pump, "--svg", "pump.svg"]);
    assert_eq!(drawn.0, 0, "{}", drawn.2);
    let svg = fs::read_to_string(folder.path().join("pump.svg")).expect("it was written");
    assert!(svg.contains("Torque on the crank"));
}

#[test]
fn loads_of_every_kind_of_linkage_are_found() {
    let folder = TempDir::new().expect("a folder");
    let loads = "format = 1\nunit = \"mm\"\n[loads]\ngravity = [0, -9.81]\n[loads.body.crank]\nmass_kg = 1\ncenter = [10, 0]\n";
    fs::write(folder.path().join("loads.toml"), loads).expect("a file");
    for entry in fs::read_dir(root().join("problems/linkages")).expect("a folder") {
        let text = fs::read_to_string(entry.expect("it can be read").path()).expect("text");
        if text.contains("[loads") {
            continue;
        }
        let with_unit = if text.contains("\nunit") {
            text
        } else {
            text.replace("format = 1", "format = 1\nunit = \"mm\"")
        };
        fs::write(folder.path().join("it.toml"), with_unit).expect("a file");
        let (code, stdout, stderr) =
            linkwright(folder.path(), &["analyze", "it.toml", "--loads", "loads.toml", "--angle", "60"]);
        assert_eq!(code, 0, "{stderr}");
        assert!(stdout.contains("Loads over"), "{stdout}");
    }
}

#[test]
fn a_loads_file_is_refused_with_place_and_remedy() {
    let folder = TempDir::new().expect("a folder");
    hoeken(folder.path());
    let refused = |text: &str, words: &[&str]| {
        fs::write(folder.path().join("bad.toml"), text).expect("a file");
        let (code, _, stderr) = linkwright(folder.path(), &["analyze", "hoeken.toml", "--loads", "bad.toml"]);
        assert_eq!(code, 2, "{stderr}");
        for word in words {
            assert!(stderr.contains(word), "{word} in\n{stderr}");
        }
    };
    refused("format = 1\n[loads]\n", &["unit", "write unit = \"mm\""]);
    refused("format = 1\nunit = \"mm\"\n", &["there are no loads", "[loads]"]);
    let masses = "format = 1\nunit = \"mm\"\n[loads.body.rocker]\nmass_kg = 1\n";
    refused(masses, &["bad.toml:3", "no body \"rocker\"", "ground, crank, coupler, follower"]);
    let spring = "format = 1\nunit = \"mm\"\n[[loads.spring]]\nfrom = \"D\"\nto = \"E\"\nrate_N_per_m = 1\nfree_length = 2\n";
    refused(spring, &["bad.toml:5", "no joint or point \"E\"", "A, B, C, D, P"]);
    refused("format = 1\nunit = \"mm\"\n[loads]\nwind = 3\n", &["unknown key \"wind\" in [loads]"]);
    let missing = linkwright(folder.path(), &["analyze", "hoeken.toml", "--loads", "nowhere.toml"]);
    assert!(missing.0 == 2 && missing.2.contains("there is no such file"), "{}", missing.2);
    // The linkage itself has no unit.
    let plain = linkwright(folder.path(), &["analyze", &shipped("hoeken.toml"), "--loads", "weight.toml"]);
    assert!(plain.0 == 2 && plain.2.contains("the linkage hoeken has no unit"), "{}", plain.2);
}

#[test]
fn check_counts_loads_and_a_rewritten_linkage_says_that_it_drops_them() {
    let folder = TempDir::new().expect("a folder");
    hoeken(folder.path());
    let check = linkwright(folder.path(), &["check", &shipped("slider-crank-loaded.toml"), "weight.toml"]);
    assert_eq!(check.0, 0, "{}", check.2);
    assert!(check.1.contains("; loads: 3 bodies with mass, 2 forces, 1 spring"), "{}", check.1);
    assert!(check.1.contains("loads: 1 force"), "{}", check.1);
    let pump = shipped("slider-crank-loaded.toml");
    let cognate = linkwright(folder.path(), &["cognates", &pump]);
    assert_eq!(cognate.0, 0, "{}", cognate.2);
    assert!(cognate.2.contains("are not carried over"), "{}", cognate.2);
    let exported = linkwright(folder.path(), &["export", &pump, "--format", "dxf", "--out", "pump.dxf"]);
    assert_eq!(exported.0, 0, "{}", exported.2);
}

#[test]
fn a_speed_over_the_crank_angle_has_its_acceleration_in_table_csv_and_json() {
    let folder = TempDir::new().expect("a folder");
    hoeken(folder.path());
    let loads = "format = 1\nunit = \"cm\"\n[loads]\nspeed_rpm = [[0, 60], [120, 90], [240, 75]]\n\
        [loads.body.crank]\nmass_kg = 0\ninertia_kg_m2 = 0.002\n";
    fs::write(folder.path().join("table.toml"), loads).expect("a file");
    let analyze = ["analyze", "hoeken.toml", "--loads", "table.toml", "--cycle", "24"];
    let (code, stdout, stderr) = linkwright(folder.path(), &[&analyze[..], &["--csv", "t.csv"][..]].concat());
    assert_eq!(code, 0, "{stderr}");
    for words in ["The crank turns at", "rpm on average over time: a turn takes", "over the turn"] {
        assert!(stdout.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{words}: {stdout}");
    }
    assert!(!stdout.contains("flywheel of"), "{stdout}");
    let csv = fs::read_to_string(folder.path().join("t.csv")).expect("it was written");
    let mut lines = csv.lines().skip(1);
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| head.iter().position(|other| *other == name).expect("a column");
    let [omega, alpha, torque] = ["omega2_rad_s", "alpha2_rad_s2", "torque_N_m"].map(column);
    for (i, line) in lines.enumerate() {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        assert_eq!(cells.len(), head.len());
        assert!((cells[torque] - 0.002 * cells[alpha]).abs() < 1e-14, "{line}");
        if i == 8 {
            assert!((cells[omega] - 3.0 * std::f64::consts::PI).abs() < 1e-12, "{line}");
        }
    }
    let json = |more: &[&str]| {
        let (code, stdout, stderr) = linkwright(folder.path(), &[&analyze[..], more, &["--json"]].concat());
        assert_eq!(code, 0, "{stderr}");
        serde_json::from_str::<serde_json::Value>(&stdout).expect("JSON")
    };
    let value = json(&[]);
    let over = &value["loads"]["speed_over_turn"];
    assert_eq!(value["omega2_rad_s"], over["mean_rad_s"]);
    assert!(value["loads"].get("fluctuation").is_none() && over["turn_s"].is_f64());
    // A speed of the command goes before the table.
    let steady = json(&["--rpm", "60"]);
    assert!(steady["loads"].get("speed_over_turn").is_none());
    assert!(steady["configurations"][0]["rows"][0]["loads"].get("omega2_rad_s").is_none());
    let (code, _, stderr) = linkwright(folder.path(), &[&analyze[..], &["--alpha", "2"][..]].concat());
    assert!(code == 2 && stderr.contains("follows from it") && stderr.contains("rpm"), "{stderr}");
    let drawn = linkwright(folder.path(), &[&analyze[..], &["--svg", "t.svg"][..]].concat());
    assert_eq!(drawn.0, 0, "{}", drawn.2);
    let mass = "[loads.body.coupler]\nmass_kg = 1\nat = \"P\"\n";
    fs::write(folder.path().join("mass.toml"), loads.to_owned() + mass).expect("a file");
    let balance = ["balance", "hoeken.toml", "--loads", "mass.toml", "--masses", "crank", "--radius", "2"];
    let out = ["--even", "both", "--out", "balanced.toml"];
    let (code, stdout, stderr) = linkwright(folder.path(), &[&balance[..], &out[..]].concat());
    assert!(code == 0 && stdout.contains("counter-masses, at "), "{stdout}{stderr}");
    let written = fs::read_to_string(folder.path().join("balanced.toml")).expect("it was written");
    assert!(written.contains("speed_rpm = [[0.0, 60.0], [120.0, 90.0], [240.0, 75.0]]"), "{written}");
    fs::write(folder.path().join("stops.toml"), loads.replace("90]", "0]")).expect("a file");
    let (code, _, stderr) = linkwright(folder.path(), &["check", "stops.toml"]);
    assert!(code != 0 && stderr.contains("nowhere 0") && stderr.contains("4:23"), "{stderr}");
}

#[test]
fn a_result_is_analysed_under_the_loads_of_its_problem() {
    let folder = TempDir::new().expect("a folder");
    let problem = root().join("problems/examples/walking-stride-loaded.toml").display().to_string();
    let few = "solve.evaluations=3000";
    let made = linkwright(
        folder.path(),
        &["synth", &problem, "--set", few, "--no-advice", "--out", "stride", "--quiet"],
    );
    assert!(made.0 < 2, "{}", made.2);
    let text = fs::read_to_string(folder.path().join("stride/record.json")).expect("a record");
    let record: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let peak = record["candidates"][0]["peak_torque_N_m"].as_f64().expect("a torque");
    let (code, stdout, stderr) =
        linkwright(folder.path(), &["analyze", "stride", "--angle", "0,90", "--json"]);
    assert_eq!(code, 0, "{stderr}");
    let analysis: serde_json::Value = serde_json::from_str(&stdout).expect("JSON");
    let found = analysis["loads"]["torque_peak_N_m"]["value"].as_f64().expect("a torque");
    assert!((found.abs() - peak.abs()).abs() < 1e-6 * peak.abs(), "{found} {peak}");
}
