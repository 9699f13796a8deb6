//! `front` as a person or a script meets it: what it refuses, prints and writes, and how its linkages are named.

use crate::common::root;
use assert_cmd::Command;
use linkwright::internals::record::{Axis, Record};
use linkwright::internals::report::html::front_html;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

fn linkwright(folder: &Path, arguments: &[&str]) -> Answer {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    let output = command.current_dir(folder).env("NO_COLOR", "1").args(arguments).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// A front of few evaluations in the folder `out`.
fn front(folder: &Path, out: &str, more: &[&str]) -> Answer {
    let problem = root().join("problems/literature/k18.toml").display().to_string();
    let mut arguments = vec!["front", problem.as_str(), "--quiet", "--out", out];
    if !more.contains(&"--points") {
        arguments.extend(["--points", "6"]);
    }
    arguments.extend(["--set", "solve.evaluations=4000", "--set", "solve.candidates=2"]);
    arguments.extend(more);
    linkwright(folder, &arguments)
}

fn record(folder: &Path) -> Record {
    let text = fs::read_to_string(folder.join("record.json")).expect("it is there");
    serde_json::from_str(&text).expect("a record")
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).expect("it is there");
    entries.map(|entry| entry.expect("a name").file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn axes_that_make_no_front_are_refused_with_the_remedy() {
    let folder = TempDir::new().expect("a folder");
    for (axes, words) in [
        ("rms", "name 2 to 4 axes"),
        ("rms,max,transmission,extent,longest", "name 2 to 4 axes"),
        ("rms,extent,rms", "rms is named twice"),
        ("rms,speed", "write two to four of rms, max, transmission"),
        ("transmission,extent", "add rms or max"),
        ("rms,peak_torque", "peak_torque needs loads"),
    ] {
        let said = front(folder.path(), "r", &["--axes", axes]);
        assert_eq!(said.code, 2, "{axes}: {}", said.stderr);
        assert!(said.stderr.contains("--axes") && said.stderr.contains(words), "{axes}: {}", said.stderr);
        assert!(!folder.path().join("r").exists(), "{axes}: nothing is begun");
    }
    for points in ["0", "201", "many"] {
        let said = front(folder.path(), "r", &["--points", points]);
        assert_eq!(said.code, 2, "{points}: {}", said.stderr);
    }
}

#[test]
fn a_front_has_all_its_files_and_verify_agrees_with_it() {
    let folder = TempDir::new().expect("a folder");
    let said = front(folder.path(), "r", &["--set", "unit=mm"]);
    assert_eq!(said.code, 0, "{}", said.stderr);
    let out = folder.path().join("r");
    let record = record(&out);
    let members = &record.front.as_ref().expect("a front").members;
    assert!(members.len() > 2 && members.len() <= 6, "{}", members.len());
    for words in
        ["None of these linkages is beaten by another", "rms error, transmission angle and extent", "mm"]
    {
        assert!(said.stdout.contains(words), "{words}: {}", said.stdout);
    }
    let mut wanted: BTreeSet<String> =
        ["record.json", "timing.json", "report.html", "candidates.csv", "front.csv", "front.html"]
            .map(String::from)
            .into();
    wanted.extend((1..=members.len()).flat_map(|n| [format!("linkage-{n}.toml"), format!("curve-{n}.csv")]));
    let found = names(&out);
    assert!(wanted.is_subset(&found), "{:?}", wanted.difference(&found));
    assert!(!found.contains(&format!("linkage-{}.toml", members.len() + 1)));
    let verified = linkwright(folder.path(), &["verify", "r"]);
    assert_eq!(verified.code, 0, "{}", verified.stdout);
    assert!(verified.stdout.contains("of the front"), "{}", verified.stdout);
    // A later run of `synth` leaves nothing of the front behind.
    let problem = root().join("problems/literature/k18.toml").display().to_string();
    let set = ["--set", "solve.evaluations=4000", "--set", "solve.candidates=2"];
    let again =
        linkwright(folder.path(), &[&["synth", &problem, "--out", "r", "--quiet"], &set[..]].concat());
    assert_eq!(again.code, 0, "{}", again.stderr);
    let left = names(&out);
    assert!(!left.contains("front.csv") && !left.contains("front.html") && !left.contains("linkage-3.toml"));
}

#[test]
fn the_rows_of_the_table_are_the_members_of_the_record_to_the_last_digit() {
    let folder = TempDir::new().expect("a folder");
    let said = front(folder.path(), "r", &["--axes", "max,extent", "--set", "unit=in"]);
    assert_eq!(said.code, 0, "{}", said.stderr);
    let record = record(&folder.path().join("r"));
    let front = record.front.as_ref().expect("a front");
    assert_eq!(front.axes, [Axis::Max, Axis::Extent]);
    let text = fs::read_to_string(folder.path().join("r/front.csv")).expect("it is there");
    let mut lines = text.lines();
    let head =
        "rms,max,transmission_deg,extent,longest,link_ratio,sensitivity,kind,Ax,Ay,Bx,By,a,b,c,d,e,t1,t2";
    assert_eq!(lines.next(), Some(head));
    for member in &front.members {
        let cells: Vec<&str> = lines.next().expect("a row").split(',').collect();
        let number = |i: usize| -> f64 { cells[i].parse().expect("a number") };
        // The torque has a column in a problem with loads alone.
        let figures: Vec<f64> = Axis::ALL[..7].iter().map(|axis| member.figures.of(*axis)).collect();
        assert_eq!((0..7).map(number).collect::<Vec<_>>(), figures);
        assert_eq!(cells[7], "four-bar");
        let l = member.candidate.linkage.four_bar().expect("a four-bar");
        let keys = [l.crank_pivot().re, l.crank_pivot().im, l.follower_pivot().re, l.follower_pivot().im];
        assert_eq!((8..12).map(number).collect::<Vec<_>>(), keys);
        let lengths = [l.crank(), l.coupler(), l.follower(), l.crank_side(), l.follower_side()];
        assert_eq!((12..17).map(number).collect::<Vec<_>>(), lengths);
        assert_eq!([number(17), number(18)], [l.assembly().sign(), l.side().sign()]);
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn members_and_picks_are_chosen_after_a_colon() {
    let folder = TempDir::new().expect("a folder");
    assert_eq!(front(folder.path(), "r", &[]).code, 0);
    let record = record(&folder.path().join("r"));
    let members = &record.front.as_ref().expect("a front").members;
    for (name, candidate) in [
        ("front-2", &members[1].candidate),
        ("smallest", record.picks.as_ref().and_then(|picks| picks.smallest.as_ref()).expect("a pick")),
        (
            "best-transmission",
            record.picks.as_ref().and_then(|picks| picks.best_transmission.as_ref()).expect("a pick"),
        ),
    ] {
        let subject = format!("r:{name}");
        let out = format!("{name}.json");
        let said = linkwright(folder.path(), &["export", &subject, "--format", "json", "--out", &out]);
        assert_eq!(said.code, 0, "{name}: {}", said.stderr);
        let text = fs::read_to_string(folder.path().join(&out)).expect("it is there");
        let a = serde_json::to_string(&candidate.linkage.crank()).expect("a number");
        assert!(text.contains(&a), "{name}: {a} in {text}");
        for command in ["build", "analyze"] {
            let said = linkwright(folder.path(), &[command, &subject]);
            assert!(said.code < 2, "{command} {name}: {}", said.stderr);
        }
        let page = format!("{name}.html");
        let said = linkwright(folder.path(), &["report", &subject, "--out", &page]);
        assert_eq!(said.code, 0, "{name}: {}", said.stderr);
    }
    let page = fs::read_to_string(folder.path().join("front-2.html")).expect("it is there");
    assert!(page.contains("\"first\":\"f2\"") && page.contains("The linkage 2 of the front"));
    for (name, words) in [
        ("front-7", "there is no linkage 7 in the front"),
        ("front-0", "front-1, front-2"),
        ("largest", "smallest, best-transmission"),
    ] {
        let said = linkwright(folder.path(), &["build", &format!("r:{name}")]);
        assert_eq!(said.code, 2, "{name}");
        assert!(said.stderr.contains(words), "{name}: {}", said.stderr);
    }
}

#[test]
fn threads_change_no_byte_of_a_front() {
    let folder = TempDir::new().expect("a folder");
    for (out, threads) in [("one", "1"), ("two", "2")] {
        assert_eq!(front(folder.path(), out, &["--threads", threads]).code, 0);
    }
    for name in ["record.json", "front.csv", "front.html"] {
        let read = |out: &str| fs::read(folder.path().join(out).join(name)).expect("it is there");
        assert!(read("one") == read("two"), "{name}");
    }
}

#[test]
fn resume_skips_a_front_only_where_it_is_the_one_that_is_asked_for() {
    let folder = TempDir::new().expect("a folder");
    assert_eq!(front(folder.path(), "r", &[]).code, 0);
    let skipped = |more: &[&str]| {
        let said = front(folder.path(), "r", &[more, &["--resume"]].concat());
        assert_eq!(said.code, 0, "{}", said.stderr);
        said.stdout.contains("Done before")
    };
    assert!(skipped(&[]));
    assert!(!skipped(&["--axes", "rms,extent"]));
    assert!(skipped(&["--axes", "rms,extent"]) && !skipped(&["--axes", "rms,extent", "--points", "5"]));
    let problem = root().join("problems/literature/k18.toml").display().to_string();
    let set = ["--set", "solve.evaluations=4000", "--set", "solve.candidates=2", "--resume", "--quiet"];
    let plain = linkwright(folder.path(), &[&["synth", &problem, "--out", "r"], &set[..]].concat());
    assert!(plain.code == 0 && !plain.stdout.contains("Done before"), "{}", plain.stdout);
}

#[test]
fn a_front_of_a_problem_that_nothing_meets_is_empty_and_ends_with_1() {
    let folder = TempDir::new().expect("a folder");
    let said = front(folder.path(), "r", &["--set", "task.path.tolerance=1e-9"]);
    assert_eq!(said.code, 1, "{}", said.stderr);
    assert!(said.stdout.contains("The front is empty"), "{}", said.stdout);
    let page = fs::read_to_string(folder.path().join("r/front.html")).expect("it is there");
    assert!(page.contains("The front is empty"));
    assert_eq!(linkwright(folder.path(), &["verify", "r"]).code, 0);
}

#[test]
fn the_page_of_a_front_is_one_file_in_which_no_name_becomes_markup() {
    let folder = TempDir::new().expect("a folder");
    assert_eq!(front(folder.path(), "r", &[]).code, 0);
    let mut record = record(&folder.path().join("r"));
    record.problem.name = "</title></style><script>alert(1)</script>".into();
    record.problem.source = Some("<img src=x onerror=alert(1)>".into());
    let page = front_html(&record);
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    for text in ["<script>alert", "<img", "http://", "https://"] {
        assert!(!page.contains(text), "{text}");
    }
    let members = record.front.as_ref().expect("a front").members.len();
    assert_eq!(page.matches("<li id=\"linkage-").count(), members);
    assert_eq!(page.matches("<a href=\"#linkage-").count(), 2 * members, "in the plot and in the table");
    let none = front_html(&Record { front: None, ..record });
    assert!(none.contains("The front is empty"));
}

#[test]
fn a_front_over_a_family_of_exact_linkages_is_true_and_its_errors_are_not_compared_by_their_rounding() {
    let folder = TempDir::new().expect("a folder");
    for problem in ["folding-bed", "sofa-bed"] {
        let file = root().join(format!("problems/motion/{problem}.toml")).display().to_string();
        let arguments = ["front", &file, "--quiet", "--points", "10", "--out", problem];
        let set = ["--set", "solve.evaluations=30000"];
        let answer = linkwright(folder.path(), &[&arguments[..], &set[..]].concat());
        assert_eq!(answer.code, 0, "{}", answer.stderr);
        let answer = linkwright(folder.path(), &["verify", problem]);
        assert_eq!(answer.code, 0, "{}{}", answer.stdout, answer.stderr);
        let record = record(&folder.path().join(problem));
        let members = record.front.expect("a front").members;
        let size = record.problem.resolved.task.to_task().expect("a task").size();
        let exact: Vec<_> = members.iter().map(|m| m.figures).filter(|f| f.rms < 1e-12 * size).collect();
        assert!(members.len() >= 8 && exact.len() > 1, "{problem}: {} of {}", exact.len(), members.len());
        // Of exact ones, the better transmitting is the larger.
        for (i, one) in exact.iter().enumerate() {
            for other in &exact[..i] {
                let steeper = one.transmission_deg > other.transmission_deg;
                assert_eq!(steeper, one.extent > other.extent, "{problem}: {one:?} {other:?}");
            }
        }
    }
}
