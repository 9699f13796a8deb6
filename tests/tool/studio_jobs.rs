//! The studio's jobs from outside: the same bytes as the command line, stopped, taken up again, many at once.

use crate::studio::{Reply, Studio, egg};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Read};
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// What comes after the head of an answer.
fn body(reply: &Reply) -> &str {
    reply.0.split_once("\r\n\r\n").map_or("", |(_, body)| body)
}

fn value(reply: &Reply) -> Value {
    assert!((200..300).contains(&reply.status()), "{}", reply.0);
    serde_json::from_str(body(reply)).unwrap_or_else(|e| panic!("{e}: {}", reply.0))
}

/// A browser that was let in.
struct Guest<'a> {
    studio: &'a Studio,
    cookie: String,
}

impl Guest<'_> {
    fn of(studio: &Studio) -> Guest<'_> {
        Guest { studio, cookie: studio.cookie() }
    }

    fn gets(&self, path: &str) -> Reply {
        self.studio.asks("GET", path, &[("Cookie", &self.cookie)], b"")
    }

    fn posts(&self, path: &str, what: &Value) -> Reply {
        self.studio.posts(&self.cookie, path, what.to_string().as_bytes())
    }

    fn job(&self, name: &str) -> Value {
        value(&self.gets(&format!("/jobs/{name}")))
    }

    /// Waits until this holds of a job.
    fn waits(&self, name: &str, what: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let job = self.job(name);
            if what(&job) {
                return job;
            }
            assert!(start.elapsed() < Duration::from_secs(240), "{job}");
            sleep(Duration::from_millis(40));
        }
    }

    fn waits_for(&self, name: &str, state: &str) -> Value {
        self.waits(name, |job| job["state"] == state)
    }
}

fn studio(folder: &Path, port: &str) -> Studio {
    Studio::start(&["--port", port, "--out", &folder.display().to_string()])
}

/// The program's answer.
fn linkwright(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_linkwright"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("it runs");
    assert!(output.status.code().is_some_and(|code| code < 2), "{output:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// The files of a folder but for its times.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    let files = entries.map(|path| (name(&path), fs::read(&path).expect("a file")));
    files.filter(|(name, _)| name != "timing.json").collect()
}

/// A job that has hours of work.
fn endless(name: &str) -> Value {
    let mut ask = egg(1, 40, 3.0);
    ask["name"] = json!(name);
    json!({"ask": ask, "set": {"solve.method": "genetic", "solve.evaluations": "1000000000"}})
}

/// Hundredths of a second of work that a process has had.
fn work_of(studio: &Studio) -> u64 {
    let stat = fs::read_to_string(format!("/proc/{}/stat", studio.child.id())).expect("a process");
    let fields: Vec<&str> = stat.rsplit(") ").next().expect("fields").split(' ').collect();
    fields[11..13].iter().map(|time| time.parse::<u64>().expect("a time")).sum()
}

#[test]
fn a_job_saves_the_bytes_of_synth_and_all_that_is_told_of_it_is_what_the_commands_tell() {
    let folder = TempDir::new().expect("a folder");
    let (saved, own) = (folder.path().join("results"), folder.path().join("own"));
    let studio = studio(&saved, "18441");
    let guest = Guest::of(&studio);
    assert_eq!(value(&guest.gets("/jobs"))["jobs"], json!([]));
    let mut ask = egg(7, 24, 2.0);
    (ask["name"], ask["unit"], ask["transmission_deg_min"]) = (json!("an egg"), json!("mm"), json!(55));
    let job = json!({"ask": ask, "set": {"solve.evaluations": "10000"}});
    let started = guest.posts("/jobs", &job);
    assert_eq!(started.status(), 201, "{}", started.0);
    let done = guest.waits_for("an%20egg", "done");
    assert!(done["result"]["candidates"].as_u64().is_some_and(|n| n > 0), "{done}");
    // By synth, from the problem file that the page gives.
    let problem = body(&guest.posts("/problem.toml", &ask)).to_owned();
    fs::write(folder.path().join("egg.toml"), &problem).expect("written");
    let set = "solve.evaluations=10000";
    linkwright(folder.path(), &["synth", "egg.toml", "--out", "own", "--set", set, "--threads", "1"]);
    let (studios, synths) = (files(&saved.join("an egg")), files(&own));
    assert!(studios.len() > 5 && studios.contains_key("report.html"));
    assert_eq!(studios.keys().collect::<Vec<_>>(), synths.keys().collect::<Vec<_>>());
    for (name, bytes) in &studios {
        assert!(synths[name] == *bytes, "{name} differs");
    }
    let record = guest.gets("/jobs/an%20egg/files/record.json");
    assert_eq!(body(&record).as_bytes(), studios["record.json"]);
    // A problem file's text is run as it stands; a name is not taken twice without a word.
    let text = json!({"problem": problem.replace("an egg", "again"), "set": {"solve.evaluations": "10000"}});
    assert_eq!(guest.posts("/jobs", &text).status(), 201);
    guest.waits_for("again", "done");
    let again = fs::read_to_string(saved.join("again/record.json")).expect("a record");
    assert_eq!(again.replace("\"again\"", "\"an egg\"").into_bytes(), studios["record.json"]);
    assert_eq!(guest.posts("/jobs", &text).status(), 409);
    let mut replacing = text.clone();
    replacing["replace"] = json!(true);
    assert_eq!(guest.posts("/jobs", &replacing).status(), 201);
    guest.waits_for("again", "done");
    // Opened: the same ask, the same candidates.
    let opened = value(&guest.gets("/jobs/an%20egg/opened"));
    assert_eq!(opened["ask"]["points"], ask["points"]);
    assert_eq!(opened["ask"]["transmission_deg_min"], 55.0);
    assert_eq!(
        value(&guest.posts("/read", &json!({"kind": "problem", "text": problem})))["ask"]["points"],
        ask["points"]
    );
    // Files: as the commands write them.
    let of = json!({"job": {"name": "an egg", "rank": 1}});
    for format in ["dxf", "svg", "csv", "toml", "json", "scad", "cut-list", "dxf-plates"] {
        let ours = guest.posts("/export", &json!({"of": of, "format": format, "set": {}}));
        assert_eq!(ours.status(), 200, "{}", ours.0);
        assert!(ours.header("content-disposition").is_some_and(|value| value.starts_with("attachment")));
        let theirs = linkwright(folder.path(), &["export", "results/an egg:1", "--format", format]);
        assert!(body(&ours) == theirs, "{format}");
    }
    let html = guest.posts("/export", &json!({"of": of, "format": "html"}));
    linkwright(folder.path(), &["report", "results/an egg:1", "--out", "page.html"]);
    assert_eq!(body(&html), fs::read_to_string(folder.path().join("page.html")).expect("a page"));
    for (format, file) in [("sheet", "candidate-1.svg"), ("points", "curve-1.csv")] {
        let ours = guest.posts("/export", &json!({"of": of, "format": format}));
        assert_eq!(body(&ours).as_bytes(), studios[file], "{format}");
    }
    // What a maker takes: the layers, and everything in one archive under its own names.
    let sizes = json!({"hole_mm": "3", "margin_mm": "4", "kerf_mm": "0.1", "sheet_mm": "2000x2000"});
    let layers = guest.posts("/export", &json!({"of": of, "format": "layers", "set": {"hole_mm": "3"}}));
    let theirs = linkwright(folder.path(), &["build", "results/an egg:1", "--hole", "3", "--margin", "3"]);
    assert!(theirs.ends_with(body(&layers)) && body(&layers).contains("from below"), "{}", layers.0);
    let asked = json!({"of": of, "format": "archive", "set": sizes, "name": "egg-1"});
    let archive = studio.posts_for_bytes(&guest.cookie, "/export", asked.to_string().as_bytes());
    let mut archive = zip::ZipArchive::new(Cursor::new(archive)).expect("an archive");
    let names: Vec<String> = archive.file_names().map(str::to_owned).collect();
    assert!(names.iter().all(|name| name.starts_with("egg-1-")) && names.len() == 11, "{names:?}");
    let mut plates = String::new();
    archive.by_name("egg-1-plates.dxf").expect("plates").read_to_string(&mut plates).expect("a text");
    let set = ["hole_mm=3", "margin_mm=4", "kerf_mm=0.1", "sheet_mm=2000x2000"];
    let mut arguments = vec!["export", "results/an egg:1", "--format", "dxf-plates"];
    arguments.extend(set.iter().flat_map(|one| ["--set", one]));
    assert_eq!(plates, linkwright(folder.path(), &arguments));
    for (asked, says) in [
        (json!({"of": of, "format": "archive", "name": "../x"}), "path"),
        (json!({"of": of, "format": "archive", "set": {"hole_mm": "900"}}), "run into each other"),
        (json!({"of": of, "format": "archive", "set": {"sheet_mm": "1x1"}}), "do not fit"),
        (
            json!({"of": of, "format": "layers", "set": {"crank_deg": "1", "nothing": "2"}}),
            "no setting `nothing`",
        ),
    ] {
        let refused = guest.posts("/export", &asked);
        assert!(refused.status() == 422 && body(&refused).contains(says), "{}", refused.0);
    }
    // A comparison too.
    let two = json!({"of": [of, {"job": {"name": "again", "rank": 1}}], "sort": ["transmission"]});
    let ours: Value = value(&guest.posts("/compare", &two));
    let (one, other) = (saved.join("an egg"), saved.join("again"));
    let arguments = [format!("{}:1", one.display()), format!("{}:1", other.display())];
    let theirs = linkwright(
        folder.path(),
        &["compare", &arguments[0], &arguments[1], "--sort", "transmission", "--json"],
    );
    assert_eq!(ours, serde_json::from_str::<Value>(&theirs).expect("JSON"));
    // Details: of the result, and of the same linkage under the hand.
    let first = json!({"job": {"name": "an egg", "rank": 1}});
    let details = value(&guest.posts("/details", &json!({"of": first})));
    let words = details["words"].as_str().expect("words");
    assert!(words.contains("Requirements") && words.contains("Dimensions"), "{words}");
    assert!(words.contains("transmission") && !words.contains("<script"), "{words}");
    let shown = &details["shown"];
    let drawn = json!({"drawn": {"ask": ask, "linkage": shown["linkage"], "crank_deg": shown["crank_deg"],
        "t1_at": shown["t1_at"]}});
    let by_hand = value(&guest.posts("/details", &json!({"of": drawn})));
    for key in ["rms", "max", "type", "transmission_deg", "link_ratio", "accepted", "unmet"] {
        assert_eq!(by_hand["shown"][key], shown[key], "{key}");
    }
    // Changed by hand it is judged over the same target; what cannot be assembled is refused.
    let judged = |linkage: &Value| guest.posts("/judged", &json!({"ask": ask, "linkage": linkage}));
    let same = value(&judged(&shown["linkage"]));
    let rms = |shown: &Value| shown["rms"].as_f64().expect("a number");
    assert!(rms(&same) <= rms(shown) * (1.0 + 1e-9) && same["type"] == shown["type"], "{same}");
    let mut longer = shown["linkage"].clone();
    longer["d"] = json!(1.02 * longer["d"].as_f64().expect("a length"));
    assert!(rms(&value(&judged(&longer))) > rms(shown));
    longer["a"] = json!(1e4);
    assert_eq!(judged(&longer).status(), 422);
    // What its limit costs is told for it as well.
    let costs =
        |details: &Value| details["words"].as_str().is_some_and(|words| words.contains("class=\"cost\""));
    assert!(costs(&details) && costs(&by_hand), "{}", by_hand["words"]);
    let html = guest.posts("/export", &json!({"of": drawn, "format": "html"}));
    assert!(html.status() == 200 && body(&html).contains("an egg"), "{}", html.0);
    // No search was cancelled: there was none.
    assert!(body(&html).contains("by-hand") || body(&html).contains("fitted under the hand"), "{}", html.0);
    // Another studio, later, lists the same.
    drop(studio);
    let later = self::studio(&saved, "18442");
    let guest = Guest::of(&later);
    let list = value(&guest.gets("/jobs"));
    let names: Vec<_> =
        list["jobs"].as_array().expect("a list").iter().map(|job| job["name"].clone()).collect();
    assert_eq!(names, ["again", "an egg"]);
    assert!(list["jobs"].as_array().expect("a list").iter().all(|job| job["state"] == "done"));
}

/// Where a job's search began: evaluations before its first word.
fn begun_at(job: &Value) -> f64 {
    let of = |key: &str| job["progress"][key].as_f64().expect("a number");
    (of("evaluations") - of("rate") * of("elapsed_s")).round()
}

#[test]
fn a_problem_that_is_opened_and_not_touched_is_saved_and_run_with_all_that_its_file_says() {
    let folder = TempDir::new().expect("a folder");
    let k18 = include_str!("../../problems/literature/k18.toml");
    let text = k18.replace("\n[solve]\n", "\n[solve]\nevaluations = 20000\n");
    assert!(text.len() > k18.len());
    fs::write(folder.path().join("k18.toml"), &text).expect("written");
    let saved = folder.path().join("results");
    let studio = studio(&saved, "18449");
    let guest = Guest::of(&studio);
    let opened = value(&guest.posts("/read", &json!({"kind": "problem", "name": "k18.toml", "text": text})));
    assert_eq!(opened["whole"], true);
    let ask = &opened["ask"];
    assert_eq!(ask["expect"]["answer"]["published"].as_array().map(Vec::len), Some(3));
    // Saved: the answers that are known stand in the file, and it is the same problem.
    let again = body(&guest.posts("/problem.toml", ask)).to_owned();
    let table = |text: &str| -> toml::Table {
        let whole: toml::Table = text.parse().expect("TOML");
        whole["expect"].as_table().expect("a table").clone()
    };
    assert_eq!(table(&again), table(&text));
    // Run: the bytes of synth.
    assert_eq!(guest.posts("/jobs", &json!({ "ask": ask })).status(), 201);
    guest.waits_for("k18", "done");
    linkwright(folder.path(), &["synth", "k18.toml", "--out", "own"]);
    let (studios, synths) = (files(&saved.join("k18")), files(&folder.path().join("own")));
    assert_eq!(studios.keys().collect::<Vec<_>>(), synths.keys().collect::<Vec<_>>());
    for (name, bytes) in &studios {
        assert!(synths[name] == *bytes, "{name} differs");
    }
    // Another target is another problem.
    let mut moved = ask.clone();
    moved["points"][2][1] = json!(1.05);
    assert!(!body(&guest.posts("/problem.toml", &moved)).contains("expect"));
}

#[test]
fn a_job_that_was_stopped_goes_on_to_the_same_bytes_and_so_does_one_whose_studio_was_killed() {
    let folder = TempDir::new().expect("a folder");
    let saved = folder.path().join("results");
    let mut ask = egg(1, 30, 3.0);
    ask["name"] = json!("long");
    let set = json!({"solve.method": "genetic", "solve.evaluations": "80000"});
    let ask = json!({"ask": ask, "set": set});
    let first = studio(&saved, "18443");
    let guest = Guest::of(&first);
    assert_eq!(guest.posts("/jobs", &ask).status(), 201);
    let part = |job: &Value| job["progress"]["evaluations"].as_u64().is_some_and(|n| n > 4_000);
    let running = guest.waits("long", part);
    assert!(running["state"] == "running" && running["progress"]["rate"].as_f64() > Some(0.0), "{running}");
    let anew = begun_at(&running);
    assert!(running["progress"]["left_s"].as_f64().is_some(), "{running}");
    assert_eq!(guest.posts("/jobs", &ask).status(), 409);
    // Then the studio dies.
    let start = Instant::now();
    while !saved.join("long/checkpoint.json").exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "no checkpoint: {}", guest.job("long"));
        sleep(Duration::from_millis(20));
    }
    drop(first);
    let second = studio(&saved, "18443");
    let guest = Guest::of(&second);
    let broken = guest.waits_for("long", "broken-off");
    assert!(broken["resumable"] == true, "{broken}");
    assert_eq!(guest.posts("/jobs/long/resume", &json!(null)).status(), 202);
    let at = guest.waits("long", |job| !job["progress"].is_null());
    assert!(begun_at(&at) > 2.0 * anew, "it begins anew, as after {anew} evaluations: {at}");
    let before = Instant::now();
    assert_eq!(guest.posts("/jobs/long/cancel", &json!(null)).status(), 202);
    let stopped = guest.waits_for("long", "stopped");
    assert!(before.elapsed() < Duration::from_secs(30), "{:?}", before.elapsed());
    assert!(stopped["resumable"] == true && stopped["result"]["reproducible"] == false, "{stopped}");
    assert_eq!(guest.posts("/jobs/long/cancel", &json!(null)).status(), 404);
    assert_eq!(guest.posts("/jobs/long/resume", &json!(null)).status(), 202);
    let at = guest.waits("long", |job| !job["progress"].is_null());
    assert!(begun_at(&at) > 2.0 * anew, "it begins anew, as after {anew} evaluations: {at}");
    guest.waits_for("long", "done");
    let mut text = egg(1, 30, 3.0);
    text["name"] = json!("long");
    fs::write(folder.path().join("long.toml"), body(&guest.posts("/problem.toml", &text))).expect("written");
    let arguments = ["--set", "solve.evaluations=80000", "--method", "genetic", "--out", "own"];
    linkwright(folder.path(), &[&["synth", "long.toml"], &arguments[..]].concat());
    assert!(files(&saved.join("long")) == files(&folder.path().join("own")), "the records differ");
    assert_eq!(fs::read_dir(saved.join(".studio")).expect("a folder").count(), 0);
}

#[test]
fn a_job_that_failed_keeps_its_problem_and_goes_on() {
    let folder = TempDir::new().expect("a folder");
    let studio = studio(folder.path(), "18446");
    let guest = Guest::of(&studio);
    let mine = folder.path().join("egg/notes.txt");
    fs::create_dir(folder.path().join("egg")).expect("a folder");
    fs::write(&mine, "not linkwright's").expect("written");
    let mut ask = egg(1, 24, 2.0);
    ask["name"] = json!("egg");
    let job = json!({"ask": ask, "set": {"solve.evaluations": "10000"}, "replace": true});
    assert_eq!(guest.posts("/jobs", &job).status(), 201);
    let failed = guest.waits_for("egg", "failed");
    assert!(failed["said"].as_str().is_some_and(|said| said.contains("notes.txt")), "{failed}");
    assert!(failed["resumable"] == true && mine.exists(), "{failed}");
    fs::remove_file(&mine).expect("removed");
    assert_eq!(guest.posts("/jobs/egg/resume", &json!(null)).status(), 202);
    guest.waits_for("egg", "done");
    assert_eq!(fs::read_dir(folder.path().join(".studio")).expect("a folder").count(), 0);
}

#[test]
fn a_figure_that_was_changed_by_hand_is_not_shown() {
    let folder = TempDir::new().expect("a folder");
    let studio = studio(folder.path(), "18449");
    let guest = Guest::of(&studio);
    let mut ask = egg(1, 24, 2.0);
    ask["name"] = json!("egg");
    guest.posts("/jobs", &json!({"ask": ask, "set": {"solve.evaluations": "10000"}}));
    guest.waits_for("egg", "done");
    let of = json!({"job": {"name": "egg", "rank": 1}});
    let asks = [("/details", json!({"of": of})), ("/export", json!({"of": of, "format": "dxf"}))];
    for (path, ask) in &asks {
        assert_eq!(guest.posts(path, ask).status(), 200, "{path}");
    }
    let file = folder.path().join("egg/record.json");
    let mut record: Value = serde_json::from_slice(&fs::read(&file).expect("a record")).expect("JSON");
    record["candidates"][0]["error"]["rms"] = json!(0.0);
    fs::write(&file, record.to_string()).expect("written");
    for (path, ask) in &asks {
        let refused = guest.posts(path, ask);
        assert!(refused.status() == 422 && body(&refused).contains("not true"), "{path}: {}", refused.0);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_in_the_place_of_a_record_holds_up_nobody() {
    let folder = TempDir::new().expect("a folder");
    let pipe = |name: &str, file: &str| {
        let place = folder.path().join(name);
        fs::create_dir_all(&place).expect("a folder");
        let mode = rustix::fs::Mode::from_raw_mode(0o600);
        rustix::fs::mkfifoat(rustix::fs::CWD, place.join(file), mode).expect("a pipe");
    };
    pipe("record", "record.json");
    pipe("checkpoint", "checkpoint.json");
    pipe("timing", "timing.json");
    let studio = studio(folder.path(), "18447");
    let guest = Guest::of(&studio);
    let list = value(&guest.gets("/jobs"));
    let state = |name: &str| {
        let jobs = list["jobs"].as_array().expect("a list");
        jobs.iter().find(|job| job["name"] == name).map(|job| job["state"].clone())
    };
    assert_eq!(state("record"), Some(json!("unreadable")), "{list}");
    let of = json!({"job": {"name": "record", "rank": 1}});
    for (path, asked) in [("/details", json!({"of": of})), ("/export", json!({"of": of, "format": "dxf"}))] {
        let reply = guest.posts(path, &asked);
        assert!(reply.status() == 422 && body(&reply).contains("a pipe"), "{}", reply.0);
    }
    for name in ["record", "checkpoint", "timing"] {
        let mut ask = egg(1, 12, 2.0);
        ask["name"] = json!(name);
        let job = json!({"ask": ask, "set": {"solve.evaluations": "2000"}, "replace": true});
        let begun = guest.posts("/jobs", &job).status();
        assert!([201, 409, 422].contains(&begun), "{name}");
        if begun == 201 {
            guest.waits(name, |job| job["state"] != "running");
        }
    }
    // Nor does the command line wait for one.
    for command in ["verify", "report", "build"] {
        let place = folder.path().join("record");
        let done =
            Command::new(env!("CARGO_BIN_EXE_linkwright")).arg(command).arg(place).output().expect("it runs");
        assert_eq!(done.status.code(), Some(2), "{command}");
    }
}

#[test]
fn a_second_studio_leaves_the_jobs_of_the_first_alone() {
    let folder = TempDir::new().expect("a folder");
    let (first, second) = (studio(folder.path(), "18447"), studio(folder.path(), "18448"));
    let (guest, other) = (Guest::of(&first), Guest::of(&second));
    assert_eq!(guest.posts("/jobs", &endless("long")).status(), 201);
    guest.waits("long", |job| !job["progress"].is_null());
    let seen = other.job("long");
    assert!(seen["state"] == "elsewhere" && seen["resumable"] == false, "{seen}");
    assert_eq!(other.posts("/jobs/long/resume", &json!(null)).status(), 409);
    let mut again = endless("long");
    again["replace"] = json!(true);
    assert_eq!(other.posts("/jobs", &again).status(), 409);
    assert!(folder.path().join(".studio/long.json").exists());
    assert_eq!(guest.job("long")["state"], "running");
    assert_eq!(guest.posts("/jobs/long/cancel", &json!(null)).status(), 202);
    guest.waits_for("long", "stopped");
}

#[cfg(target_os = "linux")]
#[test]
fn ten_jobs_and_ten_tabs_all_progress_the_page_answers_and_stopping_frees_the_cores() {
    let folder = TempDir::new().expect("a folder");
    let studio = studio(folder.path(), "18444");
    let guest = Guest::of(&studio);
    let names: Vec<String> = (0..10).map(|i| format!("job {i}")).collect();
    let mut tabs: Vec<_> = (0..10).map(|_| studio.tab(&guest.cookie)).collect();
    for (name, tab) in names.iter().zip(&mut tabs) {
        assert_eq!(guest.posts("/jobs", &endless(name)).status(), 201);
        tab.send(&egg(1, 40, 3.0).to_string());
    }
    // Every tab gets its linkages, every job gets on, again and again.
    for tab in &mut tabs {
        tab.hears_that(|a| a["candidates"].as_array().is_some_and(|c| !c.is_empty()));
    }
    let done =
        |name: &String| guest.job(&name.replace(' ', "%20"))["progress"]["evaluations"].as_u64().unwrap_or(0);
    for name in &names {
        guest.waits(&name.replace(' ', "%20"), |job| job["progress"]["evaluations"].as_u64() > Some(0));
    }
    let before: Vec<u64> = names.iter().map(done).collect();
    sleep(Duration::from_secs(4));
    let gained: Vec<u64> =
        names.iter().map(done).zip(&before).map(|(after, before)| after - before).collect();
    let (least, most) = (gained.iter().min(), gained.iter().max());
    assert!(least > Some(&0) && most.zip(least).is_some_and(|(most, least)| *most < 8 * least), "{gained:?}");
    // The page is there at once, and a dragged point is followed.
    let mut waits: Vec<Duration> = (0..20)
        .map(|_| {
            let start = Instant::now();
            studio.is_well(&guest.cookie);
            start.elapsed()
        })
        .collect();
    waits.sort();
    assert!(waits[10] < Duration::from_millis(300), "{waits:?}");
    let start = Instant::now();
    let mut moved = egg(2, 40, 3.2);
    moved["moving"] = json!(true);
    tabs[4].send(&moved.to_string());
    tabs[4].hears_that(|a| a["version"] == 2);
    assert!(start.elapsed() < Duration::from_secs(3), "{:?}", start.elapsed());
    // As many more as may run, and none beyond.
    for i in 10..16 {
        assert_eq!(guest.posts("/jobs", &endless(&format!("job {i}"))).status(), 201);
    }
    assert_eq!(guest.posts("/jobs", &endless("one too many")).status(), 503);
    let status = fs::read_to_string(format!("/proc/{}/status", studio.child.id())).expect("a process");
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a line");
    let most: u64 = most.trim().trim_end_matches(" kB").parse().expect("a number");
    assert!(most < 500 * 1024, "{most} kB");
    // Stopped, they work no more.
    drop(tabs);
    let start = Instant::now();
    for i in 0..16 {
        assert_eq!(guest.posts(&format!("/jobs/job%20{i}/cancel"), &json!(null)).status(), 202);
    }
    for i in 0..16 {
        guest.waits_for(&format!("job%20{i}"), "stopped");
    }
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    let before = work_of(&studio);
    sleep(Duration::from_secs(1));
    let worked = work_of(&studio) - before;
    assert!(worked < 20, "{worked} hundredths of a second of work with nothing to do");
}

#[test]
fn what_is_wrong_with_a_request_is_said_and_nothing_outside_of_the_folder_is_reached() {
    let folder = TempDir::new().expect("a folder");
    let saved = folder.path().join("results");
    fs::create_dir_all(saved.join("broken")).expect("a folder");
    fs::write(saved.join("broken/record.json"), "{").expect("written");
    fs::write(folder.path().join("secret.json"), "secret").expect("written");
    fs::write(folder.path().join("points.csv"), "x,y\n0,0\n1,1\n2,0\n").expect("written");
    // The problem of a job, where no job of the studio would leave it.
    fs::create_dir(saved.join(".studio")).expect("a folder");
    fs::write(folder.path().join("outside.json"), r#"{"problem": "format = 1"}"#).expect("written");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../../outside.json", saved.join(".studio/begun.json")).expect("a link");
        std::os::unix::fs::symlink(folder.path(), saved.join("link")).expect("a link");
        fs::create_dir(saved.join("linked")).expect("a folder");
        std::os::unix::fs::symlink("../../secret.json", saved.join("linked/record.json")).expect("a link");
    }
    let studio = studio(&saved, "18445");
    let origin = studio.origin();
    for (method, path) in [
        ("GET", "/jobs"),
        ("POST", "/jobs"),
        ("POST", "/export"),
        ("GET", "/openapi.json"),
        ("POST", "/jobs/x/cancel"),
    ] {
        assert_eq!(studio.asks(method, path, &[("Origin", &origin)], b"{}").status(), 403, "{path}");
    }
    let guest = Guest::of(&studio);
    let cookie = [("Cookie", guest.cookie.as_str()), ("Origin", "http://evil.example")];
    assert_eq!(studio.asks("POST", "/jobs", &cookie, b"{}").status(), 403);
    assert_eq!(studio.asks("POST", "/jobs/x/cancel", &cookie[..1], b"").status(), 403);
    let list = value(&guest.gets("/jobs"));
    let states: Vec<_> = list["jobs"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|j| (j["name"].clone(), j["state"].clone()))
        .collect();
    #[cfg(unix)]
    assert_eq!(states, [(json!("broken"), json!("unreadable")), (json!("linked"), json!("unreadable"))]);
    assert!(!states.is_empty());
    for path in [
        "/jobs/..",
        "/jobs/%2e%2e",
        "/jobs/%2e%2e%2f",
        "/jobs/..%2fsecret.json",
        "/jobs/..%2f..%2foutside",
        "/jobs/begun",
        "/jobs/link/files/secret.json",
        "/jobs/link/opened",
        "/jobs/linked/files/record.json",
        "/jobs/broken/files/..%2f..%2fsecret.json",
        "/jobs/broken/files/.lock",
        "/jobs/none/opened",
        "/jobs/none",
        "/jobs/%00",
        "/jobs/%ff",
        "/jobs/.studio/files/x.json",
    ] {
        let reply = guest.gets(path);
        assert!([400, 404].contains(&reply.status()) && !reply.0.contains("secret\n"), "{path}: {}", reply.0);
    }
    for path in ["/jobs/linked/opened", "/jobs/broken/opened"] {
        assert_eq!(guest.gets(path).status(), 422, "{path}");
    }
    assert_eq!(guest.posts("/jobs/broken/resume", &json!(null)).status(), 409);
    let ask = egg(1, 12, 0.0);
    let text = |points: &str| format!("format = 1\nname = \"x\"\n[task.path]\n{points}\n");
    let many: Vec<[f64; 2]> = (0..10_000).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
    for bad in [
        json!({}),
        json!([]),
        json!({"ask": ask, "problem": "x"}),
        json!({"problem": ""}),
        json!({"problem": "format = 1"}),
        json!({"problem": text("file = \"../points.csv\"")}),
        json!({"problem": text("file = \"/etc/passwd\"")}),
        json!({"problem": text("svg = \"x.svg\"")}),
        json!({"problem": text("points = [[nan, 1], [2, 3], [4, 5]]")}),
        json!({"problem": text("points = [[1e300, 1], [2, 3], [4, 5]]")}),
        json!({"problem": text(&format!("points = {many:?}"))}),
        json!({"problem": text("points = [[0, 0], [1, 1], [2, 0]]").replace("\"x\"", "\"../x\"")}),
        json!({"ask": ask, "set": {"task.path.file": "/etc/passwd"}}),
        json!({"ask": ask, "set": {"name": "../x"}}),
        json!({"ask": ask, "set": {"solve.evaluations": "-1"}}),
        json!({"ask": ask, "set": {"solve.nothing": "1"}}),
        json!({"ask": ask, "set": {"solve.method": "continuation"}}),
        json!({"ask": ask, "more": 1}),
    ] {
        let reply = guest.posts("/jobs", &bad);
        assert!(reply.status() == 422 && body(&reply).len() > 10, "{bad}: {}", reply.0);
    }
    for path in ["/jobs", "/details", "/export", "/compare"] {
        for bytes in [&b"{"[..], b"", b"\xff\xfe", b"{\"of\": NaN}", "[".repeat(200_000).as_bytes()] {
            assert_eq!(studio.posts(&guest.cookie, path, bytes).status(), 422, "{path}");
        }
        let reply = studio.posts(&guest.cookie, path, &vec![b' '; 300 * 1024]);
        assert!([0, 413].contains(&reply.status()), "{path}: {}", reply.0);
    }
    let linkage =
        json!({"A": [0, 0], "B": [40, 10], "a": 20, "b": 50, "c": 50, "d": 50, "e": 50, "t1": 1, "t2": -1});
    let drawn = |crank_deg: Value, t1_at: Value| json!({"drawn": {"ask": ask, "linkage": linkage, "crank_deg": crank_deg, "t1_at": t1_at}});
    for of in [
        json!({"job": {"name": "none", "rank": 1}}),
        json!({"job": {"name": "../results/broken", "rank": 1}}),
        json!({"job": {"name": "broken", "rank": -1}}),
        json!("job"),
        drawn(json!([]), json!([])),
        drawn(json!([1e300, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]), json!([1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1])),
        drawn(json!([0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]), json!([1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2])),
    ] {
        assert_eq!(guest.posts("/details", &json!({"of": of})).status(), 422, "{of}");
        assert_eq!(guest.posts("/export", &json!({"of": of, "format": "dxf"})).status(), 422, "{of}");
        assert_eq!(guest.posts("/compare", &json!({"of": [of]})).status(), 422, "{of}");
    }
    // Angles of any size are answered.
    let wild = drawn(
        json!([1e300, 0, -1e300, 0, 0, 0, 0, 0, 0, 0, 0, 0]),
        json!([1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]),
    );
    assert!([200, 422].contains(&guest.posts("/details", &json!({"of": wild})).status()));
    let good =
        drawn(json!([0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]), json!([1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]));
    assert_eq!(guest.posts("/details", &json!({"of": good})).status(), 200);
    for (format, set) in [
        ("exe", json!({})),
        ("../x", json!({})),
        ("dxf", json!({"hole_mm": "-1"})),
        ("dxf", json!({"out": "/tmp/x"})),
        ("html", json!({"hole_mm": "1"})),
    ] {
        let reply = guest.posts("/export", &json!({"of": good, "format": format, "set": set}));
        assert_eq!(reply.status(), 422, "{format}: {}", reply.0);
    }
    assert_eq!(guest.posts("/compare", &json!({"of": [], "sort": []})).status(), 422);
    assert_eq!(guest.posts("/compare", &json!({"of": [good], "sort": ["nothing"]})).status(), 422);
    assert_eq!(guest.posts("/compare", &json!({"of": vec![&good; 21]})).status(), 422);
    studio.is_well(&guest.cookie);
}
