//! A long run as a person watches it: its progress on a terminal and elsewhere, the pace of its checkpoints.

use crate::common::root;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A search that lasts until its time limit.
fn search(folder: &TempDir, seconds: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwright"));
    command.current_dir(folder.path()).env("NO_COLOR", "1").env("TERM", "xterm").stdout(Stdio::null());
    command.arg("synth").arg(root().join("problems/literature/k18f.toml")).args(["--out", "r"]);
    command.args(["--method", "differential-evolution", "--set", "solve.evaluations=1e8"]);
    command.args(["--set", &format!("solve.time_limit_s={seconds}")]).args(more);
    command
}

/// What a search says where nobody sits at a terminal.
fn said(seconds: &str, more: &[&str]) -> String {
    let folder = TempDir::new().expect("a folder");
    let output = search(&folder, seconds, more).output().expect("it runs");
    assert!(output.status.code().is_some_and(|code| code < 2), "{output:?}");
    String::from_utf8(output.stderr).expect("text")
}

/// What a search shows on a terminal of its own.
#[cfg(target_os = "linux")]
fn shown(more: &[&str]) -> String {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::fs::{File, OpenOptions};
    use std::io::Read;
    let folder = TempDir::new().expect("a folder");
    let screen = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
    grantpt(&screen).and_then(|()| unlockpt(&screen)).expect("it is ours");
    let name = ptsname(&screen, Vec::new()).expect("it has a name").into_string().expect("text");
    let line = OpenOptions::new().read(true).write(true).open(name).expect("its other end");
    let mut command = search(&folder, "2", more);
    let mut child = command.stderr(line).spawn().expect("it runs");
    drop(command);
    let mut seen = Vec::new();
    // At the end, when nobody holds the other end any more, reading fails.
    let _ = File::from(screen).read_to_end(&mut seen);
    assert!(child.wait().expect("it ends").code().is_some_and(|code| code < 2));
    String::from_utf8_lossy(&seen).into_owned()
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_shows_a_bar_with_the_rate_the_time_left_and_the_best_and_clears_it_at_the_end() {
    let seen = shown(&[]);
    for words in ["k18f [", "% of 100000000 evaluations, ", " left, ", "/s, best "] {
        assert!(seen.contains(words), "{words}: {seen:?}");
    }
    let last = seen.rsplit("\u{1b}[2K").next().expect("one part at least");
    assert!(last.len() < seen.len() && !last.contains("k18f"), "the line is left empty: {seen:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn quiet_shows_nothing_on_a_terminal_either() {
    assert_eq!(shown(&["--quiet"]), "");
}

#[test]
fn without_a_terminal_there_are_plain_lines_now_and_then_and_no_bar() {
    let said = said("7", &[]);
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.len() == 1 && !said.contains(['\r', '\u{1b}']), "{said:?}");
    assert!(lines[0].starts_with("k18f: differential-evolution "), "{said:?}");
    for words in [" of 100000000 evaluations, ", "/s, at most ", " left, best "] {
        assert!(said.contains(words), "{words}: {said:?}");
    }
}

#[test]
fn a_short_search_and_a_quiet_one_say_nothing() {
    assert_eq!(said("1", &[]), "");
    assert_eq!(said("6", &["--quiet"]), "");
}

#[test]
fn a_pace_of_checkpoints_that_is_none_is_refused() {
    for value in ["-1", "-0.001", "often", "", "1e9", "86401", "NaN", "inf", "1 s", "0x10"] {
        let folder = TempDir::new().expect("a folder");
        let option = format!("--checkpoint-every={value}");
        let output = search(&folder, "1", &[&option]).output().expect("it runs");
        let stderr = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{value:?}: {stderr}");
        assert!(stderr.contains("--checkpoint-every") && stderr.contains("seconds"), "{value:?}: {stderr}");
        assert!(value.is_empty() || stderr.contains(value), "{value:?}: {stderr}");
        assert!(!folder.path().join("r").exists(), "{value:?}: nothing is begun");
    }
}

#[test]
fn a_negative_pace_as_a_word_of_its_own_names_the_option_too() {
    let folder = TempDir::new().expect("a folder");
    let output = search(&folder, "1", &["--checkpoint-every", "-1"]).output().expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("--checkpoint-every") && stderr.contains("0 to 86400"), "{stderr}");
}
