//! README.md and docs/*.md: every command runs, and what is shown is what the program prints.
//!
//! - A fenced `sh` block holds commands; each must end with exit code 0.
//! - A fenced `console` block is a session: `$ ` begins a command, what follows is what it prints. A line `...` stands
//!   for any number of lines; a line that ends in `...` for any rest of it. `$ echo $?` shows the exit code of the
//!   command before, which is otherwise 0.
//! - A fenced `toml`, `csv` or `xml` block with a file name after the word is written to that file first.
//! - `linkwright` is the built program; `cargo run --release --` is the same. The commands of one document run in one
//!   folder, in their order, beside a copy of `problems/`.
//!
//! Times are masked. After a change of the program: `LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool documents` puts
//! the lines that differ in digits or words right where they can be told apart, and copies the figures anew.

use crate::common::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Commands of the build, which the documents name and this test does not repeat.
const OF_THE_BUILD: [&str; 9] = [
    "cargo test",
    "cargo install --path .",
    "cargo bench",
    "cargo doc",
    "cargo fmt",
    "cargo clippy",
    "cargo nextest",
    "bash .ci/run",
    "LINKWRIGHT_WRITE_DOCS=1 cargo test",
];

/// The README's whole suite runs for minutes: one problem stands for it.
const WHOLE_SUITE: &str = "cargo run --release -- suite ";
const SHORT_SUITE: &str = "linkwright suite e5 --seeds 1 # ";

/// README.md and every page of docs/.
fn documents() -> Vec<PathBuf> {
    let mut pages: Vec<PathBuf> = fs::read_dir(root().join("docs"))
        .expect("docs/")
        .map(|entry| entry.expect("it can be read").path())
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect();
    pages.sort();
    pages.insert(0, root().join("README.md"));
    pages
}

fn writing() -> bool {
    std::env::var_os("LINKWRIGHT_WRITE_DOCS").is_some()
}

/// A fenced block: its words after the fence, the number of its first line in the page, its lines.
struct Block {
    info: String,
    first: usize,
    lines: Vec<String>,
}

fn blocks(page: &[String]) -> Vec<Block> {
    let mut found = Vec::new();
    let mut open: Option<Block> = None;
    for (i, line) in page.iter().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => {
                open = Some(Block { info: info.trim().into(), first: i + 1, lines: vec![] })
            }
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some(block), None) => block.lines.push(line.clone()),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a fence is not closed");
    found
}

/// A command of a page and what is shown of its output: (line of the page, text) each.
struct Step {
    line: usize,
    command: String,
    shown: Option<Vec<(usize, String)>>,
}

/// The commands of an `sh` block: one a line, `\` at the end of a line continues it.
fn of_sh(block: &Block) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut continues = false;
    for (i, text) in block.lines.iter().enumerate() {
        match steps.last_mut() {
            Some(step) if continues => step.command.push_str(&format!("\n{text}")),
            _ if text.trim().is_empty() || text.starts_with('#') => continue,
            _ => steps.push(Step { line: block.first + i, command: text.clone(), shown: None }),
        }
        continues = text.ends_with('\\');
    }
    steps
}

/// The commands of a `console` block with what is shown of their output.
fn of_console(block: &Block) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut continues = false;
    for (i, text) in block.lines.iter().enumerate() {
        let line = block.first + i;
        match (text.strip_prefix("$ "), steps.last_mut()) {
            (Some(command), _) => {
                steps.push(Step { line, command: command.into(), shown: Some(vec![]) });
            }
            (None, Some(step)) if continues => step.command.push_str(&format!("\n{text}")),
            (None, Some(step)) => step.shown.as_mut().expect("a session").push((line, text.clone())),
            (None, None) => panic!("line {}: a session begins with `$ `", line + 1),
        }
        continues = text.ends_with('\\');
    }
    steps
}

struct Answer {
    code: i32,
    stdout: String,
    stderr: String,
}

/// Runs a command in the shell, with `linkwright` found on the path.
fn answer(folder: &Path, command: &str) -> Answer {
    let command = command.replace(WHOLE_SUITE, SHORT_SUITE).replace("cargo run --release --", "linkwright");
    let program = Path::new(env!("CARGO_BIN_EXE_linkwright")).parent().expect("a folder");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path =
        std::env::join_paths(std::iter::once(program.to_path_buf()).chain(std::env::split_paths(&path)));
    let output = Command::new("sh")
        .args(["-c", &command])
        .current_dir(folder)
        .env("PATH", path.expect("a path"))
        .env("NO_COLOR", "1")
        .env_remove("COLUMNS")
        .output()
        .expect("a shell");
    Answer {
        code: output.status.code().expect("it ends by itself"),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// A line without its times and without blanks at its end.
fn masked(line: &str) -> String {
    let mut text = line.trim_end().to_owned();
    for unit in [" s of search", " s more for the buildable one", " s more for"] {
        while let Some(end) = text.find(unit) {
            let start = text[..end].rfind(|c: char| !(c.is_ascii_digit() || c == '.')).map_or(0, |at| at + 1);
            if start == end {
                break;
            }
            text.replace_range(start..end, "");
        }
    }
    text
}

/// Whether a shown line stands for this one.
fn agrees(shown: &str, printed: &str) -> bool {
    match shown.trim_end().strip_suffix("...") {
        Some(start) if !start.is_empty() => masked(printed).starts_with(&masked(start)),
        _ => masked(shown) == masked(printed),
    }
}

/// Whether the lines shown are the lines printed, `...` standing for any number of lines.
fn matches(shown: &[&str], printed: &[&str]) -> bool {
    match (shown.first(), printed.first()) {
        (None, None) => true,
        (Some(&"..."), _) => {
            matches(&shown[1..], printed) || (!printed.is_empty() && matches(shown, &printed[1..]))
        }
        (Some(s), Some(p)) => agrees(s, p) && matches(&shown[1..], &printed[1..]),
        _ => false,
    }
}

/// A line without digits: what stays the same when figures change.
fn shape(line: &str) -> String {
    let mut shape = String::new();
    for c in line.chars() {
        let c = if c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+' | 'e') { '0' } else { c };
        if (c == '0' || c == ' ') && shape.ends_with(c) {
            continue;
        }
        shape.push(c);
    }
    shape.trim().to_owned()
}

/// Puts lines right that differ from what is printed in figures alone. A line that nothing resembles stays.
fn mended(shown: &[(usize, String)], printed: &[&str], page: &mut [String]) {
    let mut from = 0;
    for (line, text) in shown {
        if text == "..." || text.trim_end().ends_with("...") {
            continue;
        }
        let rest = || printed.iter().enumerate().skip(from);
        let found = rest()
            .find(|(_, p)| agrees(text, p))
            .or_else(|| rest().find(|(_, p)| shape(p) == shape(text)))
            .map(|(at, _)| at);
        if let Some(at) = found {
            if !agrees(text, printed[at]) {
                page[*line] = printed[at].trim_end().to_owned();
            }
            from = at + 1;
        }
    }
}

/// Writes the block's text to the file that stands after its language.
fn wrote_file(block: &Block, folder: &Path) -> bool {
    let mut words = block.info.split_whitespace();
    let (language, name) = (words.next(), words.next());
    let Some(name) = name.filter(|_| matches!(language, Some("toml" | "csv" | "xml"))) else { return false };
    fs::write(folder.join(name), block.lines.join("\n") + "\n").expect("it can be written");
    true
}

fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("it can be read").path();
        let place = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copied(&path, &place);
        } else {
            fs::copy(&path, &place).expect("it can be copied");
        }
    }
}

/// Runs the commands of a page; says what is wrong with it.
fn faults(place: &Path) -> Vec<String> {
    let name = place.file_name().expect("a name").to_string_lossy().into_owned();
    let text = fs::read_to_string(place).expect("it can be read");
    let mut page: Vec<String> = text.lines().map(str::to_owned).collect();
    let folder = TempDir::new().expect("a folder");
    copied(&root().join("problems"), &folder.path().join("problems"));
    let mut faults = Vec::new();
    for block in blocks(&page) {
        if wrote_file(&block, folder.path()) {
            continue;
        }
        let steps = match block.info.as_str() {
            "sh" => of_sh(&block),
            "console" => of_console(&block),
            _ => continue,
        };
        let mut steps = steps.into_iter().peekable();
        while let Some(step) = steps.next() {
            if OF_THE_BUILD.iter().any(|build| step.command.starts_with(build)) {
                continue;
            }
            let answer = answer(folder.path(), &step.command);
            let next = steps.next_if(|next| next.command == "echo $?");
            let expected = next.and_then(|next| next.shown?.first()?.1.trim().parse().ok()).unwrap_or(0);
            let place = format!("{name}:{}: {}", step.line + 1, step.command);
            if answer.code != expected {
                faults.push(format!("{place}\nexit {}\n{}{}", answer.code, answer.stdout, answer.stderr));
                continue;
            }
            let Some(shown) = step.shown else { continue };
            let (out, err) = (&answer.stdout, &answer.stderr);
            let prints = [out.clone(), format!("{err}{out}"), format!("{out}{err}"), err.clone()];
            let lines: Vec<&str> = shown.iter().map(|(_, text)| text.as_str()).collect();
            let fits = |text: &String| {
                let printed: Vec<&str> = text.trim_matches('\n').lines().collect();
                matches(&lines, &printed)
            };
            if !prints.iter().any(fits) {
                mended(&shown, &prints[2].lines().collect::<Vec<_>>(), &mut page);
                faults.push(format!("{place}\nprints\n{out}{err}"));
            }
        }
    }
    faults.extend(figures(&page, &name, folder.path()));
    faults.extend(fields(&name, folder.path()));
    let mended = page.join("\n") + "\n";
    if writing() && mended != text {
        fs::write(place, mended).expect("it can be written");
    }
    faults
}

/// `<!-- drawn: FILE -->` after a figure names the file that a command above has drawn it in.
fn figures(page: &[String], name: &str, folder: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for line in page.iter().filter(|line| line.starts_with("![")) {
        let figure = line.split_once("](").and_then(|(_, rest)| rest.split_once(')')).expect("a link").0;
        let kept = if name == "README.md" { root().join(figure) } else { root().join("docs").join(figure) };
        let drawn = line.split_once("<!-- drawn: ").and_then(|(_, rest)| rest.split_once(" -->"));
        if let Some((drawn, _)) = drawn {
            match fs::read_to_string(folder.join(drawn)) {
                Ok(svg) if roxmltree::Document::parse(&svg).is_ok() => {
                    if writing() {
                        fs::write(&kept, svg).expect("it can be written");
                    }
                }
                _ => faults.push(format!("{name}: no command draws {drawn}")),
            }
        }
        match fs::read_to_string(&kept) {
            Ok(svg) if svg.len() < 120_000 && roxmltree::Document::parse(&svg).is_ok() => {}
            _ => faults.push(format!("{name}: {figure} is no drawing of less than 120 kB")),
        }
    }
    faults
}

/// The keys that docs/results.md explains: `a.b[].c`, or `a.b.*` for all that stands below `a.b`.
fn explained() -> BTreeSet<String> {
    let page = fs::read_to_string(root().join("docs/results.md")).expect("the page");
    let rows = page.split_once("\n## record.json").expect("a section").1;
    let rows = rows.split("\n## ").next().expect("a section");
    let cells = rows.lines().filter_map(|line| line.strip_prefix("| `")?.split_once(" |"));
    cells
        .flat_map(|(keys, _)| keys.split('`').filter(|key| key.trim_matches([',', ' ']) != ""))
        .map(str::to_owned)
        .collect()
}

/// The keys of a value as they are written there.
fn keys(value: &serde_json::Value, path: &str, found: &mut BTreeSet<String>) {
    match value {
        serde_json::Value::Object(table) => {
            for (key, value) in table {
                keys(value, &format!("{path}.{key}"), found);
            }
        }
        serde_json::Value::Array(list) if list.iter().any(serde_json::Value::is_object) => {
            list.iter().for_each(|value| keys(value, &format!("{path}[]"), found));
        }
        _ => {
            let path = path.trim_start_matches('.');
            found.insert(
                path.strip_prefix("buildable.").map_or(path.into(), |rest| format!("candidates[].{rest}")),
            );
        }
    }
}

/// Every key of the records that the commands have written is explained; and the guide's hold every key explained.
fn fields(name: &str, folder: &Path) -> Vec<String> {
    let (mut found, explained) = (BTreeSet::new(), explained());
    for entry in fs::read_dir(folder.join("results")).into_iter().flatten() {
        let place = entry.expect("it can be read").path().join("record.json");
        let Ok(text) = fs::read_to_string(place) else { continue };
        keys(&serde_json::from_str(&text).expect("a record"), "", &mut found);
    }
    let covers = |row: &str, key: &str| {
        row == key || row.strip_suffix('*').is_some_and(|start| key.starts_with(start))
    };
    let unknown = found.iter().filter(|key| !explained.iter().any(|row| covers(row, key)));
    let mut faults: Vec<String> = unknown
        .map(|key| format!("{name}: docs/results.md does not explain `{key}` of the record"))
        .collect();
    if name == "guide.md" {
        let unused = explained.iter().filter(|row| !found.iter().any(|key| covers(row, key)));
        faults.extend(
            unused.map(|row| format!("docs/results.md explains `{row}`, which no record of the guide holds")),
        );
    }
    faults
}

fn no_faults(pages: &[PathBuf]) {
    let faults: Vec<String> = pages.iter().flat_map(|page| faults(page)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

#[test]
fn every_command_of_the_readme_runs_and_prints_what_is_shown() {
    no_faults(&documents()[..1]);
}

#[test]
fn every_command_of_the_guide_runs_and_prints_what_is_shown() {
    let (guide, rest): (Vec<_>, Vec<_>) =
        documents().split_off(1).into_iter().partition(|page| page.ends_with("guide.md"));
    assert_eq!(guide.len(), 1);
    assert!(rest.len() >= 5);
    no_faults(&guide);
}

#[test]
fn every_command_of_the_other_pages_runs_and_prints_what_is_shown() {
    let pages = documents().split_off(1);
    no_faults(&pages.into_iter().filter(|page| !page.ends_with("guide.md")).collect::<Vec<_>>());
}

#[test]
fn every_link_between_the_pages_leads_somewhere() {
    for place in documents() {
        let text = fs::read_to_string(&place).expect("it can be read");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link) {
            if link.contains("://") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target =
                if file.is_empty() { place.clone() } else { place.parent().expect("a folder").join(file) };
            assert!(target.exists(), "{}: {link}", place.display());
            if !anchor.is_empty() {
                let page = fs::read_to_string(&target).expect("a page");
                let heading = |line: &str| -> String {
                    let words = line.trim_start_matches('#').trim().to_lowercase();
                    let kept = words.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
                    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
                };
                let there = page.lines().any(|line| line.starts_with('#') && heading(line) == anchor);
                assert!(there, "{}: no heading for {link}", place.display());
            }
        }
    }
}

#[test]
fn a_shown_line_must_be_printed() {
    let printed = ["a", "  0.031 s of search. Written to r", "b 1", "c"];
    assert!(matches(&["a", "..."], &printed));
    assert!(matches(&["a", "  9.5 s of search. Written to r", "...", "c"], &printed));
    assert!(matches(&["...", "b ...", "c"], &printed));
    assert!(!matches(&["a"], &printed));
    assert!(!matches(&["...", "b 2", "c"], &printed));
    assert!(!matches(&["a", "  9.5 s of search. Written to q", "..."], &printed));
}
