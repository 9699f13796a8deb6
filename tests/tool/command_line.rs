//! The command as a person or a script meets it: what it prints, writes and returns.

use crate::common::root;
use assert_cmd::Command;
use linkwright::internals::record::Record;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The command in a folder of its own.
fn linkwright(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

fn shipped(name: &str) -> String {
    root().join("problems").join(name).display().to_string()
}

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

fn answer(command: &mut Command) -> Answer {
    let output = command.output().expect("it runs");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: String::from_utf8(output.stdout).expect("text"),
        stderr: String::from_utf8(output.stderr).expect("text"),
    }
}

fn record(folder: &Path) -> Record {
    let text = fs::read_to_string(folder.join("record.json")).expect("a record was written");
    serde_json::from_str(&text).expect("it is a record")
}

#[test]
fn what_can_be_built_has_files_of_its_own_that_go_with_the_next_result() {
    let folder = TempDir::new().expect("a folder");
    let job = |extra: &[&str]| {
        let problem = shipped("literature/a6b.toml");
        let mut arguments = vec!["synth", problem.as_str(), "--out", "r"];
        arguments.extend(extra);
        answer(linkwright(folder.path()).args(arguments))
    };
    let run = job(&[]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("buildable"), "{}", run.stdout);
    let files =
        ["linkage-buildable.toml", "curve-buildable.csv"].map(|name| folder.path().join("r").join(name));
    assert!(files.iter().all(|file| file.is_file()));
    let checked = answer(linkwright(folder.path()).args(["check", "r/linkage-buildable.toml"]));
    assert_eq!(checked.code, 0, "{}", checked.stderr);
    assert_eq!(answer(linkwright(folder.path()).args(["verify", "r"])).code, 0);
    let plain = job(&["--method", "least-squares"]);
    assert_eq!(plain.code, 0, "{}", plain.stderr);
    assert!(files.iter().all(|file| !file.exists()), "they belong to the earlier result");
}

#[test]
fn the_main_job_writes_a_result_that_verifies() {
    let folder = TempDir::new().expect("a folder");
    let run = answer(linkwright(folder.path()).args(["synth", &shipped("literature/k18.toml")]));
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("crank-rocker") && run.stdout.contains("accepted"), "{}", run.stdout);
    assert!(run.stdout.contains("linkwright verify results/k18"), "the next command is named");
    let result = folder.path().join("results/k18");
    let found = record(&result);
    assert!(found.candidates[0].error.sum_sq < 0.0100);
    for name in ["timing.json", "candidates.csv", "curve-1.csv", "linkage-1.toml", "candidate-1.svg"] {
        assert!(result.join(name).is_file(), "{name}");
    }
    assert!(!result.join(".lock").exists());
    let verified = answer(linkwright(folder.path()).args(["verify", "results/k18"]));
    assert_eq!((verified.code, verified.stderr.as_str()), (0, ""));
    let compared = answer(linkwright(folder.path()).args(["compare", "results/k18", "results/k18:2"]));
    assert_eq!(compared.code, 0, "{}", compared.stderr);
    let linkage = answer(linkwright(folder.path()).args(["check", "results/k18/linkage-1.toml"]));
    assert_eq!(linkage.code, 0, "{}", linkage.stderr);
    let bare = answer(linkwright(folder.path()).args([
        "compare",
        "results/k18/linkage-1.toml",
        "results/k18:1",
        "--target",
        &shipped("literature/k18.toml"),
        "--csv",
        "table.csv",
    ]));
    assert_eq!(bare.code, 0, "{}", bare.stderr);
    assert!(folder.path().join("table.csv").is_file());
}

#[test]
fn one_and_two_threads_write_the_same_record_file() {
    let folder = TempDir::new().expect("a folder");
    let bytes = [1, 2].map(|threads| {
        let out = format!("out-{threads}");
        let n = threads.to_string();
        let args = ["synth", &shipped("literature/k18.toml"), "--out", &out, "--threads", &n, "--quiet"];
        assert_eq!(answer(linkwright(folder.path()).args(args)).code, 0);
        fs::read(folder.path().join(out).join("record.json")).expect("it is there")
    });
    assert_eq!(bytes[0], bytes[1]);
}

#[test]
fn json_prints_the_record_alone() {
    let folder = TempDir::new().expect("a folder");
    let run = answer(linkwright(folder.path()).args(["synth", &shipped("literature/e5.toml"), "--json"]));
    assert_eq!(run.code, 0);
    assert_eq!(
        run.stdout,
        fs::read_to_string(folder.path().join("results/e5/record.json")).expect("it is there")
    );
    assert_eq!(run.stderr, "");
}

#[test]
fn a_batch_runs_all_files_and_ends_with_a_summary() {
    let folder = TempDir::new().expect("a folder");
    let (k18, e5) = (shipped("literature/k18.toml"), shipped("literature/e5.toml"));
    let run = answer(linkwright(folder.path()).args(["synth", &k18, &e5, "--out", "all"]));
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!(
        (record(&folder.path().join("all/k18")).seed, record(&folder.path().join("all/e5")).seed),
        (1, 1)
    );
    assert!(run.stdout.lines().any(|l| l.contains("e5")), "{}", run.stdout);
    let twice = answer(linkwright(folder.path()).args(["synth", &k18, &k18]));
    assert_eq!(twice.code, 2);
    assert!(twice.stderr.contains("would both write to"), "{}", twice.stderr);
}

#[test]
fn a_new_problem_runs_as_it_is() {
    let folder = TempDir::new().expect("a folder");
    let made = answer(linkwright(folder.path()).args(["new", "my path"]));
    assert_eq!(made.code, 0, "{}", made.stderr);
    let run = answer(linkwright(folder.path()).args(["synth", "my path.toml"]));
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    assert!(record(&folder.path().join("results/my path")).candidates[0].accepted);
    let again = answer(linkwright(folder.path()).args(["new", "my path"]));
    assert_eq!(again.code, 2);
    assert!(again.stderr.contains("exists already"), "{}", again.stderr);
    let path = answer(linkwright(folder.path()).args(["new", "../elsewhere"]));
    assert_eq!(path.code, 2);
    assert!(path.stderr.contains("path"), "{}", path.stderr);
    fs::write(folder.path().join("p.csv"), "x,y\n0,0\n10,4\n18,9\n22,17\n").expect("written");
    assert_eq!(answer(linkwright(folder.path()).args(["new", "from-csv", "--from", "p.csv"])).code, 0);
    assert_eq!(answer(linkwright(folder.path()).args(["check", "from-csv.toml", "p.csv"])).code, 0);
}

#[test]
fn a_bare_points_file_runs_with_defaults() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("arc.csv"), "x,y\n0,0\n10,4\n18,9\n22,17\n21,25\n").expect("written");
    let run = answer(linkwright(folder.path()).args(["synth", "arc.csv", "--set", "solve.candidates=2"]));
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!(record(&folder.path().join("results/arc")).problem.resolved.solve.candidates, 2);
}

#[test]
fn a_bare_drawing_runs_with_defaults_and_verifies() {
    let folder = TempDir::new().expect("a folder");
    let svg = "<svg width='100mm' viewBox='0 0 100 100'><ellipse cx='50' cy='50' rx='30' ry='8'/></svg>";
    fs::write(folder.path().join("oval.svg"), svg).expect("written");
    let short = ["--set", "task.path.samples=12", "--set", "solve.evaluations=5000"];
    let run = answer(linkwright(folder.path()).args(["synth", "oval.svg", "--quiet"]).args(short));
    assert!(run.code <= 1 && run.stderr.is_empty(), "{}", run.stderr);
    assert!(run.stdout.contains("12 points") && run.stdout.contains("closed"), "{}", run.stdout);
    assert_eq!(
        record(&folder.path().join("results/oval")).problem.unit,
        Some(linkwright::internals::mechanism::Unit::Mm)
    );
    assert_eq!(answer(linkwright(folder.path()).args(["verify", "results/oval"])).code, 0);
    let check = answer(linkwright(folder.path()).args(["check", "oval.svg"]));
    assert!(check.stdout.contains("60 points of a closed curve, size 62.0"), "{}", check.stdout);
    let new = answer(linkwright(folder.path()).args(["new", "my-oval", "--from", "oval.svg"]));
    assert_eq!(new.code, 0, "{}", new.stderr);
    let text = fs::read_to_string(folder.path().join("my-oval.toml")).expect("written");
    assert!(text.starts_with("#:schema ") && text.contains("svg = \"oval.svg\""), "{text}");
    assert_eq!(answer(linkwright(folder.path()).args(["check", "my-oval.toml"])).code, 0);
}

#[test]
fn smoothed_points_are_scored_against_the_raw_ones_and_verify_knows() {
    let folder = TempDir::new().expect("a folder");
    let mut csv = String::from("x,y\n");
    for i in 0..48 {
        let angle = std::f64::consts::TAU * f64::from(i) / 48.0;
        let r = 1.0 + 0.02 * (f64::from(i) * 2.4).sin();
        csv += &format!("{},{}\n", 30.0 * r * angle.cos(), 12.0 * r * angle.sin());
    }
    fs::write(folder.path().join("scan.csv"), csv).expect("written");
    let mut synth = linkwright(folder.path());
    synth.args([
        "synth",
        "scan.csv",
        "--quiet",
        "--set",
        "task.path.closed=true",
        "--set",
        "task.path.samples=12",
    ]);
    let run = answer(synth.args(["--set", "task.path.smooth=8", "--set", "solve.evaluations=5000"]));
    assert!(run.code <= 1, "{}", run.stderr);
    assert!(run.stdout.contains("taken along 48 given points, smoothed over 8"), "{}", run.stdout);
    assert!(run.stdout.contains("From the 48 points as given"), "{}", run.stdout);
    let place = folder.path().join("results/scan");
    assert_eq!(answer(linkwright(folder.path()).args(["verify", "results/scan"])).code, 0);
    let honest = record(&place);
    let error = honest.candidates[0].error.to_raw.expect("scored");
    assert!((error.rms - (error.sum_sq / 48.0).sqrt()).abs() < 1e-12 && error.max >= error.rms);
    type Lie = fn(&mut Record);
    let lies: [(&str, Lie); 4] = [
        ("error.to_raw.rms", |r| r.candidates[0].error.to_raw.as_mut().expect("there").rms *= 0.9),
        ("error.to_raw is", |r| r.candidates[0].error.to_raw = None),
        ("task.path.points", |r| r.problem.resolved.task.raw.as_mut().expect("there").smooth = Some(7.0)),
        ("task.path.points", |r| r.problem.resolved.task.points[3][0] += 1e-3),
    ];
    for (what, lie) in lies {
        let mut record = honest.clone();
        lie(&mut record);
        let text = serde_json::to_string(&record).expect("JSON");
        fs::write(place.join("record.json"), text).expect("written");
        let verify = answer(linkwright(folder.path()).args(["verify", "results/scan"]));
        assert_eq!(verify.code, 1, "{what}: {}", verify.stdout);
        assert!(verify.stdout.contains(what) || verify.stderr.contains(what), "{what}: {}", verify.stdout);
    }
}

#[test]
fn manual_pages_are_printed() {
    let folder = TempDir::new().expect("a folder");
    let page = |arguments: &[&str]| answer(linkwright(folder.path()).arg("man").args(arguments));
    let program = page(&[]);
    assert!(program.code == 0 && program.stdout.contains(".TH linkwright 1"), "{}", program.stdout);
    let synth = page(&["synth"]);
    assert!(
        synth.stdout.contains(".TH linkwright\\-synth 1") || synth.stdout.contains(".TH linkwright-synth 1")
    );
    assert!(synth.stdout.contains("KEY=VALUE"), "{}", synth.stdout);
    let unknown = page(&["nothing"]);
    assert!(
        unknown.code == 2 && unknown.stderr.contains("the commands are synth, front, check"),
        "{}",
        unknown.stderr
    );
}

#[test]
fn nothing_acceptable_is_exit_code_one_with_the_reason() {
    let folder = TempDir::new().expect("a folder");
    let args = [
        "synth",
        &shipped("literature/k18.toml"),
        "--set",
        "task.path.tolerance=0.001",
        "--set",
        "solve.evaluations=4000",
    ];
    let run = answer(linkwright(folder.path()).args(args));
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("tolerance"), "{}", run.stdout);
}

#[test]
fn places_that_cannot_take_a_result_are_refused_before_the_search() {
    let folder = TempDir::new().expect("a folder");
    let k18 = shipped("literature/k18.toml");
    let refused = |out: &str| {
        let run = answer(linkwright(folder.path()).args(["synth", &k18, "--out", out]));
        assert_eq!(run.code, 2, "{out}: {}", run.stderr);
        run.stderr
    };
    fs::create_dir(folder.path().join("mine")).expect("made");
    fs::write(folder.path().join("mine/thesis.txt"), "dear").expect("written");
    assert!(refused("mine").contains("thesis.txt"));
    assert_eq!(fs::read_to_string(folder.path().join("mine/thesis.txt")).expect("it is there"), "dear");
    fs::create_dir(folder.path().join("other")).expect("made");
    fs::write(folder.path().join("other/record.json"), "{\"format\": 1}").expect("written");
    assert!(refused("other").contains("not a linkwright record"));
    fs::write(folder.path().join("file"), "x").expect("written");
    assert!(refused("file").contains("is a file"));
    assert!(refused("file/below").contains("file/below"));
    assert!(refused("/proc/nowhere").contains("/proc/nowhere"));
}

#[test]
fn an_earlier_result_is_replaced_as_a_whole() {
    let folder = TempDir::new().expect("a folder");
    let k18 = shipped("literature/k18.toml");
    assert_eq!(answer(linkwright(folder.path()).args(["synth", &k18])).code, 0);
    assert!(folder.path().join("results/k18/curve-2.csv").exists());
    let args = ["synth", &k18, "--set", "solve.candidates=1"];
    assert_eq!(answer(linkwright(folder.path()).args(args)).code, 0);
    assert_eq!(record(&folder.path().join("results/k18")).candidates.len(), 1);
    assert!(!folder.path().join("results/k18/curve-2.csv").exists(), "nothing of the earlier result is left");
}

#[test]
fn a_folder_in_use_is_refused() {
    let folder = TempDir::new().expect("a folder");
    fs::create_dir(folder.path().join("out")).expect("made");
    let lock = fs::File::create(folder.path().join("out/.lock")).expect("made");
    lock.lock().expect("locked");
    let args = ["synth", &shipped("literature/k18.toml"), "--out", "out"];
    let run = answer(linkwright(folder.path()).args(args));
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("in use by another run"), "{}", run.stderr);
    drop(lock);
    // A lock that a killed run has left behind is no hindrance.
    assert_eq!(answer(linkwright(folder.path()).args(args)).code, 0);
}

#[test]
fn a_record_that_lies_is_found_out() {
    let folder = TempDir::new().expect("a folder");
    let k18 = shipped("literature/k18.toml");
    assert_eq!(answer(linkwright(folder.path()).args(["synth", &k18, "--quiet"])).code, 0);
    let path = folder.path().join("results/k18/record.json");
    let honest = fs::read_to_string(&path).expect("it is there");
    type Lie = fn(&mut serde_json::Value);
    let lies: [(&str, Lie); 16] = [
        ("error.sum_sq", |r| r["candidates"][0]["error"]["sum_sq"] = 0.009.into()),
        ("error.max_at", |r| r["candidates"][0]["error"]["max_at"] = 3.into()),
        ("error.rms", |r| r["candidates"][0]["linkage"]["a"] = 0.3128.into()),
        ("defects", |r| {
            let other = -r["candidates"][0]["t1_at"][4].as_i64().expect("a sign");
            r["candidates"][0]["t1_at"][4] = other.into();
        }),
        ("transmission_deg.worst", |r| r["candidates"][0]["transmission_deg"]["worst"] = 45.0.into()),
        ("type", |r| r["candidates"][0]["type"] = "double-crank".into()),
        ("accepted", |r| r["candidates"][1]["accepted"] = false.into()),
        ("digest", |r| r["problem"]["resolved"]["solve"]["seed"] = 2.into()),
        ("crank_deg", |r| {
            let moved = r["candidates"][0]["crank_deg"][5].as_f64().expect("a number") + 0.1;
            r["candidates"][0]["crank_deg"][5] = moved.into();
        }),
        ("link_ratio", |r| r["candidates"][0]["link_ratio"] = 2.0.into()),
        ("link_ratio_max", |r| r["candidates"][0]["requirements"][1]["met"] = false.into()),
        ("rank", |r| r["candidates"][1]["rank"] = 1.into()),
        ("linkage.t1", |r| {
            let other = -r["candidates"][0]["linkage"]["t1"].as_i64().expect("a sign");
            r["candidates"][0]["linkage"]["t1"] = other.into();
        }),
        ("reproducible", |r| r["termination"]["reproducible"] = false.into()),
        ("target-reached", |r| r["termination"]["reason"] = "target-reached".into()),
        ("order of ranks", |r| {
            let list = r["candidates"].as_array_mut().expect("a list");
            list.swap(0, 1);
            list[0]["rank"] = 1.into();
            list[1]["rank"] = 2.into();
        }),
    ];
    for (what, lie) in lies {
        let mut record: serde_json::Value = serde_json::from_str(&honest).expect("it is JSON");
        lie(&mut record);
        fs::write(&path, record.to_string()).expect("written");
        let run = answer(linkwright(folder.path()).args(["verify", "results/k18"]));
        assert_eq!(run.code, 1, "{what}: {}{}", run.stdout, run.stderr);
        assert!(run.stdout.contains(what), "{what}: {}", run.stdout);
    }
    for broken in ["", "{", "[]", "{\"format\": 1}", &honest[..honest.len() / 2]] {
        fs::write(&path, broken).expect("written");
        let run = answer(linkwright(folder.path()).args(["verify", "results/k18"]));
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert!(run.stderr.contains("record.json"), "{}", run.stderr);
    }
}

#[test]
fn usage_errors_are_exit_code_two_and_name_the_remedy() {
    let folder = TempDir::new().expect("a folder");
    let k18 = shipped("literature/k18.toml");
    let cases: [(&[&str], &str); 17] = [
        (&["synth"], "FILE"),
        (&["synth", "no-such-file.toml"], "no such file"),
        (&["synth", "."], "folder"),
        (&["synth", &k18, "--threads", "0"], "--threads"),
        (&["synth", &k18, "--set", "solve.seed"], "KEY=VALUE"),
        (&["synth", &k18, "--set", "solve.sead=3"], "seed"),
        (&["synth", &k18, "--method", "magic"], "differential-evolution"),
        (&["synth", &k18, "--seed", "18446744073709551615"], "9223372036854775807"),
        (&["synth", &k18, "--seed", "x"], "--seed"),
        (&["synth", &k18, "--seed", "-1"], "invalid value '-1' for '--seed <N>'"),
        (&["synth", &k18, "--threads", "-1"], "-1 is not in 1..=1024"),
        (&["suite", "--seeds", "-1"], "-1 is not in 1..=100000"),
        (&["synth", &k18, "--set", "solve"], "for example solve.candidates=9"),
        (&["certify", "r", "--set", "time"], "for example certify.time_limit_s=60"),
        (&["snap", &k18, "--grid", "1", "--set", "a"], "for example a=2.5"),
        (&["compare", "nowhere"], "nowhere"),
        (&["schema", "nothing"], "problem"),
    ];
    for (arguments, word) in cases {
        let run = answer(linkwright(folder.path()).args(arguments));
        assert_eq!(run.code, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stdout, "", "{arguments:?}");
    }
    assert!(!folder.path().join("results").exists());
}

#[test]
fn schemas_and_completions_are_printed() {
    let folder = TempDir::new().expect("a folder");
    for kind in ["problem", "linkage"] {
        let run = answer(linkwright(folder.path()).args(["schema", kind]));
        assert_eq!(run.code, 0);
        let schema: serde_json::Value = serde_json::from_str(&run.stdout).expect("it is JSON");
        assert!(schema["properties"].is_object());
    }
    for shell in ["bash", "zsh", "fish"] {
        let run = answer(linkwright(folder.path()).args(["completions", shell]));
        assert_eq!(run.code, 0);
        assert!(run.stdout.contains("linkwright"));
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_saves_the_best_so_far() {
    use std::process::{Command as Process, Stdio};
    let folder = TempDir::new().expect("a folder");
    let program = assert_cmd::cargo::cargo_bin("linkwright");
    let args = ["--method", "differential-evolution", "--set", "solve.evaluations=100000000000"];
    let child = Process::new(program)
        .args(["synth", &shipped("literature/k18.toml"), "--out", "out"])
        .args(args)
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let sent = Process::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    let found = record(&folder.path().join("out"));
    assert!(!found.candidates.is_empty());
    assert!(!found.termination.reproducible);
    let verified = answer(linkwright(folder.path()).args(["verify", "out"]));
    assert_eq!(verified.code, 0, "{}", verified.stdout);
}

#[test]
fn a_time_limit_bites_and_says_so() {
    let folder = TempDir::new().expect("a folder");
    let args = [
        "synth",
        &shipped("literature/k18.toml"),
        "--method",
        "genetic",
        "--set",
        "solve.evaluations=100000000000",
        "--set",
        "solve.time_limit_s=0.3",
        "--json",
    ];
    let run = answer(linkwright(folder.path()).args(args));
    let found: Record = serde_json::from_str(&run.stdout).expect("it is a record");
    assert_eq!(serde_json::to_value(found.termination).expect("data")["reason"], "time-limit");
    assert!(!found.termination.reproducible);
}
