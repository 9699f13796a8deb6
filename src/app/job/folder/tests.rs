//! Tests of the results folder: every write fails in turn, and the process ends at every step.

use super::disk::faults;
use super::*;
use crate::files::generator::FileKind;
use std::collections::BTreeMap;

type Files = Vec<(String, Vec<u8>)>;
type Shown = BTreeMap<String, Vec<u8>>;

/// Returns a valid record, as small as possible.
fn record(name: &str) -> Vec<u8> {
    let text = include_str!("../../../../tests/corpora/record/accepted.json");
    let mut record: Record = serde_json::from_str(text).expect("it is a record");
    record.problem.name = name.into();
    serde_json::to_vec_pretty(&record).expect("it is data")
}

/// Returns a file as a run writes it, with `text` somewhere in it.
fn file(name: &str, text: &str) -> (String, Vec<u8>) {
    let mark = crate::files::generator::mark();
    let content = match name.rsplit_once('.').map(|(_, ending)| ending) {
        Some("json") => format!("{{\"total_s\": 1, \"text\": \"{text}\"}}"),
        Some("toml") => format!("# A four-bar linkage, {mark}.\n# {text}\n[linkage]\n"),
        Some("svg") => format!("<svg>\n<!-- {mark} -->\n{text}</svg>\n"),
        _ => format!("rank,accepted,text\n1,true,{text}\n"),
    };
    (name.into(), content.into_bytes())
}

fn old() -> Files {
    vec![
        ("record.json".into(), record("old")),
        file("timing.json", "old timing"),
        file("candidates.csv", "old candidates"),
        file("linkage-1.toml", "old linkage"),
        file("linkage-2.toml", "old linkage 2"),
        file("exact.svg", "old drawing"),
    ]
}

fn new() -> Files {
    vec![
        file("timing.json", "new timing"),
        ("record.json".into(), record("new")),
        file("candidates.csv", "new candidates"),
        file("linkage-1.toml", "new linkage"),
        file("contact-sheet.svg", "new sheet"),
    ]
}

fn as_shown(files: &Files) -> Shown {
    files.iter().cloned().collect()
}

/// Returns every file of a folder whose name does not begin with a dot.
fn shown(folder: &Path) -> Shown {
    let names = replacement::names(folder).expect("it can be listed");
    let visible = names.into_iter().filter(|name| !name.starts_with('.'));
    visible.map(|name| (name.clone(), fs::read(folder.join(&name)).expect("it can be read"))).collect()
}

fn hidden(folder: &Path) -> Vec<String> {
    let names = replacement::names(folder).expect("it can be listed");
    names.into_iter().filter(|name| name.starts_with('.')).collect()
}

/// Creates a folder with the old result, or an empty one.
fn place(holds_old: bool) -> tempfile::TempDir {
    faults::fail(0..0);
    let place = tempfile::tempdir().expect("a folder");
    if holds_old {
        let mut folder = ResultsFolder::take(&place.path().join("r")).expect("it is free");
        folder.replace(&old()).expect("there is room");
    }
    place
}

/// Takes the folder and replaces its result by the new one.
fn run(path: &Path) -> Result<(), FolderError> {
    ResultsFolder::take(path)?.replace(&new())
}

/// Returns the number of steps of an undisturbed run.
fn steps(holds_old: bool) -> usize {
    let place = place(holds_old);
    faults::fail(0..0);
    run(&place.path().join("r")).expect("nothing fails");
    assert_eq!(shown(&place.path().join("r")), as_shown(&new()));
    assert!(hidden(&place.path().join("r")).is_empty());
    faults::steps()
}

#[test]
fn a_write_that_fails_is_told_and_leaves_a_whole_result() {
    for holds_old in [false, true] {
        let count = steps(holds_old);
        assert!(count > 2 * new().len(), "{count}");
        let mut kept = 0;
        for k in 0..count {
            let place = place(holds_old);
            let path = place.path().join("r");
            faults::fail(k..k + 1);
            let error = run(&path).expect_err("a step failed");
            faults::fail(0..0);
            let FolderError::Io { path: named, source } = &error else { panic!("{error}") };
            assert!(Path::new(named).starts_with(&path), "{named}");
            assert_eq!(source.kind(), io::ErrorKind::StorageFull);
            // The state before the first file was in its place, or a new result that the next run completes.
            let before = if holds_old { as_shown(&old()) } else { Shown::new() };
            let is_before = if path.exists() { shown(&path) == before } else { !holds_old };
            kept += usize::from(is_before);
            if !is_before {
                assert_eq!(read_record(&path).expect("it is there").problem.name, "new", "step {k}");
                drop(ResultsFolder::take(&path).expect("it can be taken"));
                assert_eq!(shown(&path), as_shown(&new()), "step {k}");
            }
            run(&path).expect("there is room again");
            assert_eq!(shown(&path), as_shown(&new()), "step {k}");
            assert!(hidden(&path).is_empty());
        }
        assert!(
            kept > 2 * new().len(),
            "a full disk is found before anything is replaced: {kept} of {count}"
        );
    }
}

#[test]
fn whatever_instant_is_the_last_the_folder_holds_one_result_as_a_whole() {
    for holds_old in [false, true] {
        let (mut olds, mut news) = (0, 0);
        for k in 0..steps(holds_old) {
            let place = place(holds_old);
            let path = place.path().join("r");
            // From here on nothing reaches the disk: nothing is cleaned up either.
            faults::fail(k..usize::MAX);
            run(&path).expect_err("the process is gone");
            faults::fail(0..0);
            if !path.exists() {
                assert!(!holds_old);
                continue;
            }
            let read = read_record(&path).ok().map(|record| record.problem.name);
            drop(ResultsFolder::take(&path).unwrap_or_else(|e| panic!("step {k}: {e}")));
            assert!(hidden(&path).is_empty(), "step {k}");
            match read.as_deref() {
                Some("new") => {
                    news += 1;
                    assert_eq!(shown(&path), as_shown(&new()), "step {k}");
                }
                Some(_) => {
                    olds += 1;
                    assert_eq!(shown(&path), as_shown(&old()), "step {k}");
                }
                None => assert!(!holds_old && shown(&path).is_empty(), "step {k}"),
            }
        }
        assert!(news > 3 && (olds > 10 || !holds_old), "{olds} {news}");
    }
}

#[test]
fn breaking_off_again_and_again_comes_to_the_same_end() {
    let count = steps(true);
    for k in 0..count {
        let place = place(true);
        let path = place.path().join("r");
        faults::fail(k..usize::MAX);
        run(&path).expect_err("the process is gone");
        faults::fail(0..0);
        let read = read_record(&path).expect("one of the two").problem.name;
        // Each run that takes the folder next comes one step further.
        for further in 0.. {
            faults::fail(further..usize::MAX);
            let taken = ResultsFolder::take(&path);
            faults::fail(0..0);
            assert_eq!(read_record(&path).expect("it stays").problem.name, read);
            if taken.is_ok() {
                break;
            }
        }
        let whole = if read == "new" { new() } else { old() };
        assert_eq!(shown(&path), as_shown(&whole), "step {k}");
    }
}

/// Takes two folders, writes a new result into each and puts both in their places together.
fn run_together(paths: &[PathBuf; 2]) -> [Result<(), FolderError>; 2] {
    let written = paths.each_ref().map(|path| {
        let mut folder = ResultsFolder::take(path)?;
        folder.write(&new())?;
        Ok(folder)
    });
    let mut results = Vec::new();
    let mut folders = Vec::new();
    for folder in written {
        match folder {
            Ok(folder) => folders.push(folder),
            Err(e) => results.push(Err(e)),
        }
    }
    results.extend(put_together(&mut folders.iter_mut().collect::<Vec<_>>()));
    results.try_into().expect("one each")
}

#[test]
fn results_that_wait_for_the_disk_together_are_replaced_each_as_a_whole() {
    let two = |place: &Path| {
        let paths = ["r", "s"].map(|name| place.join(name));
        for path in &paths {
            let mut folder = ResultsFolder::take(path).expect("it is free");
            folder.replace(&old()).expect("there is room");
        }
        paths
    };
    faults::fail(0..0);
    let place = tempfile::tempdir().expect("a folder");
    let paths = two(place.path());
    faults::fail(0..0);
    run_together(&paths).into_iter().for_each(|result| result.expect("nothing fails"));
    let count = faults::steps();
    let (mut both, mut one) = (0, 0);
    for last in [false, true] {
        for k in 0..count {
            let place = tempfile::tempdir().expect("a folder");
            let paths = two(place.path());
            faults::fail(if last { k..usize::MAX } else { k..k + 1 });
            let results = run_together(&paths);
            faults::fail(0..0);
            let mut replaced = 0;
            for path in &paths {
                let read = read_record(path).expect("one of the two").problem.name;
                drop(ResultsFolder::take(path).expect("it can be taken"));
                assert!(hidden(path).is_empty(), "step {k}");
                let whole = if read == "new" { new() } else { old() };
                assert_eq!(shown(path), as_shown(&whole), "step {k}");
                replaced += usize::from(read == "new");
            }
            let good = results.iter().filter(|result| result.is_ok()).count();
            assert!(good <= replaced, "step {k}: what is told to be there is there");
            both += usize::from(good == 2);
            one += usize::from(!last && good == 1);
        }
    }
    // If the common wait for the disk fails, each result is waited for alone; other failures concern only one result.
    assert!(both >= 2 && one > new().len(), "{both} {one} of {count}");
}

#[cfg(unix)]
#[test]
fn a_lock_that_nobody_finds_any_more_is_none() {
    let place = place(false);
    let path = place.path().join("r");
    let first = ResultsFolder::take(&path).expect("it is free");
    // Opened before the first removes it: from then on nobody holds its lock, and it is no longer the folder's lock.
    let late = File::options().write(true).open(path.join(LOCK)).expect("it is there");
    drop(first);
    fs::create_dir_all(&path).expect("a folder");
    let mut second = ResultsFolder::take(&path).expect("it is free");
    late.try_lock().expect("nobody has this one");
    assert!(matches!(ResultsFolder::take(&path), Err(FolderError::Locked { .. })));
    // A folder that was removed and belongs to another run by now: its lock is left alone.
    fs::remove_dir_all(&path).expect("it is ours");
    let mut third = ResultsFolder::take(&path).expect("it is free");
    third.replace(&new()).expect("there is room");
    assert!(second.replace(&old()).is_err(), "there is no folder of its own any more");
    drop(second);
    assert!(matches!(ResultsFolder::take(&path), Err(FolderError::Locked { .. })), "the third has it");
    assert_eq!(shown(&path), as_shown(&new()));
    // Half of the third's result, while it is moved to its place, does not count as a foreign file.
    fs::remove_file(path.join(RECORD)).expect("it is ours");
    assert!(matches!(ResultsFolder::take(&path), Err(FolderError::Locked { .. })));
    drop(third);
    assert!(matches!(ResultsFolder::take(&path), Err(FolderError::Foreign { .. })));
}

#[test]
fn many_take_a_folder_in_turn_and_never_two_at_once() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let place = place(true);
    let path = place.path().join("r");
    let inside = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let mut times = 0;
                while times < 100 {
                    match ResultsFolder::take(&path) {
                        Ok(folder) => {
                            assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0, "two have it");
                            std::thread::yield_now();
                            inside.fetch_sub(1, Ordering::SeqCst);
                            drop(folder);
                            times += 1;
                        }
                        Err(FolderError::Locked { .. }) => std::thread::yield_now(),
                        Err(other) => panic!("{other}"),
                    }
                }
            });
        }
    });
}

#[test]
fn a_folder_that_vanished_is_made_anew() {
    let place = place(true);
    let path = place.path().join("r");
    let mut folder = ResultsFolder::take(&path).expect("it is free");
    fs::remove_dir_all(&path).expect("it is ours");
    folder.replace(&new()).expect("there is room");
    assert!(matches!(ResultsFolder::take(&path), Err(FolderError::Locked { .. })), "it is ours still");
    drop(folder);
    assert_eq!(shown(&path), as_shown(&new()));
    assert!(hidden(&path).is_empty());
}

/// Writes a table and replaces any existing file.
fn write_file(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    write_files(&[OutputFile { path, kind: FileKind::Csv, bytes }], Replace::Anything)
}

/// Writes a table that does not exist yet.
fn create_file(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    write_files(&[OutputFile { path, kind: FileKind::Csv, bytes }], Replace::Nothing)
}

#[test]
fn a_file_is_written_as_a_whole_or_stays_what_it_was() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path().join("table.csv");
    for failing in [0..1, 0..usize::MAX] {
        faults::fail(failing.clone());
        write_file(&path, b"first").expect_err("a step failed");
        assert!(!path.exists());
        faults::fail(failing.clone());
        create_file(&path, b"first").expect_err("a step failed");
        faults::fail(0..0);
        assert!(shown(place.path()).is_empty() && hidden(place.path()).is_empty());
    }
    create_file(&path, b"first").expect("there is room");
    faults::fail(0..1);
    write_file(&path, b"second").expect_err("a step failed");
    faults::fail(0..0);
    assert_eq!(fs::read(&path).expect("it is there"), b"first");
    let error = create_file(&path, b"second").expect_err("it is there");
    assert!(matches!(error, FolderError::Exists { .. }), "{error}");
    assert_eq!(fs::read(&path).expect("it is there"), b"first");
    write_file(&path, b"second").expect("there is room");
    assert_eq!(fs::read(&path).expect("it is there"), b"second");
    // Of several files, either all are written or none.
    let [one, other] = ["one.csv", "other.csv"].map(|name| place.path().join(name));
    let both = [&one, &other].map(|path| OutputFile { path, kind: FileKind::Csv, bytes: b"new" });
    faults::fail(1..2);
    write_files(&both, Replace::Nothing).expect_err("the second cannot be written");
    faults::fail(0..0);
    assert!(!one.exists() && !other.exists());
    let rescued = rescue(&new()).expect("there is room");
    assert_eq!(shown(&rescued), as_shown(&new()));
    fs::remove_dir_all(rescued).expect("it is ours");
}

#[cfg(unix)]
#[test]
fn links_are_followed_by_files_that_a_person_named_and_by_no_replacement() {
    use std::os::unix::fs::symlink;
    let place = place(true);
    let (path, elsewhere) = (place.path().join("r"), place.path().join("elsewhere"));
    fs::create_dir(&elsewhere).expect("a folder");
    fs::write(elsewhere.join("record.json"), record("planted")).expect("there is room");
    symlink(&elsewhere, path.join(".linkwright-whole")).expect("a link");
    drop(ResultsFolder::take(&path).expect("it is free"));
    assert_eq!(shown(&path), as_shown(&old()));
    assert_eq!(shown(&elsewhere).len(), 1, "nothing was taken from there");
    let link = place.path().join("link.csv");
    fs::write(elsewhere.join("real.csv"), "before").expect("there is room");
    symlink(elsewhere.join("real.csv"), &link).expect("a link");
    write_file(&link, b"after").expect("there is room");
    assert_eq!(fs::read(elsewhere.join("real.csv")).expect("it is there"), b"after");
    assert!(fs::symlink_metadata(&link).expect("it is there").is_symlink());
}

#[test]
fn entries_that_no_run_writes_under_a_name_are_refused_and_stay() {
    let folders = [
        "candidate-9.svg",
        "curve-3.csv",
        "linkage-buildable.toml",
        "linkage-best-transmission.toml",
        "front.html",
        "record.json",
        "report.html",
        "checkpoint.json",
        "certificate.leaves",
        "certificate.checkpoint",
        ".lock",
        ".linkwright-mine",
        ".linkwright-ab12cd",
        ".linkwright-new",
        ".linkwright-whole",
        ".linkwright-moving",
    ];
    for name in folders {
        for holds_old in [false, true] {
            let place = place(holds_old);
            let path = place.path().join("r");
            let kept = path.join(name).join("kept.txt");
            let _ = fs::remove_file(path.join(name));
            fs::create_dir_all(kept.parent().expect("it has one")).expect("there is room");
            fs::write(&kept, "a user's").expect("there is room");
            let error = run(&path).expect_err("it is not ours");
            let FolderError::Foreign { foreign, .. } = &error else { panic!("{name}: {error}") };
            assert!(foreign.contains(name), "{foreign}");
            assert_eq!(fs::read(&kept).expect("it is there"), b"a user's", "{name}");
        }
    }
    for name in
        ["candidate-09.svg", "curve-0.csv", "linkage-99999999999.toml", ".linkwright-notes", "candidate-.svg"]
    {
        let place = place(true);
        let path = place.path().join("r");
        fs::write(path.join(name), "a user's").expect("there is room");
        assert!(matches!(run(&path), Err(FolderError::Foreign { .. })), "{name}");
    }
}

#[test]
fn a_folder_that_comes_while_a_search_runs_stays_whatever_its_name() {
    for name in ["candidate-9.svg", "candidates.csv", ".linkwright-new", ".linkwright-whole"] {
        let place = place(true);
        let path = place.path().join("r");
        let mut folder = ResultsFolder::take(&path).expect("it is free");
        let kept = path.join(name).join("kept.txt");
        let _ = fs::remove_file(path.join(name));
        fs::create_dir(path.join(name)).expect("there is room");
        fs::write(&kept, "a user's").expect("there is room");
        let replaced = folder.replace(&new());
        assert_eq!(replaced.is_ok(), name == "candidate-9.svg", "{name}: {replaced:?}");
        assert_eq!(fs::read(&kept).expect("it is there"), b"a user's", "{name}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_among_the_files_of_a_result_is_foreign() {
    let place = place(true);
    let path = place.path().join("r");
    fs::write(place.path().join("mine.svg"), "a user's").expect("there is room");
    std::os::unix::fs::symlink("../mine.svg", path.join("candidate-3.svg")).expect("a link");
    let error = run(&path).expect_err("a run writes no links");
    assert!(error.to_string().contains("candidate-3.svg"), "{error}");
    assert!(fs::symlink_metadata(path.join("candidate-3.svg")).is_ok());
}

#[test]
fn a_file_of_a_user_under_the_name_of_a_results_file_is_refused_and_stays() {
    let names = [
        "candidates.csv",
        "timing.json",
        "report.html",
        "contact-sheet.svg",
        "exact.svg",
        "candidate-7.svg",
        "linkage-7.toml",
        "curve-buildable.csv",
    ];
    for name in names {
        let place = place(true);
        let path = place.path().join("r");
        for text in
            ["my notes\n", "<svg><!-- drawn by hand --></svg>", "{\"total\": 3}", "x,y\n1,2\n", "a = 1\n"]
        {
            fs::write(path.join(name), text).expect("there is room");
            let error = run(&path).expect_err("it is a user's");
            assert!(error.to_string().contains(name), "{error}");
            assert_eq!(fs::read_to_string(path.join(name)).expect("it is there"), text);
        }
        // An empty file contains nothing that could be lost.
        fs::write(path.join(name), "").expect("there is room");
        run(&path).expect("it is free");
    }
}
