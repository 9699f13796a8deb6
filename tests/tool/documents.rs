//! README.md and docs/*.md: every command runs, and what is shown is what the program prints.
//!
//! - A fenced `sh` block holds commands; each must end with exit code 0.
//! - A fenced `console` block is a session: `$ ` begins a command, what follows is what it prints. A line `...` stands
//!   for any number of lines; a line that ends in `...` for any rest of it. `$ echo $?` shows the exit code of the
//!   command before, which is otherwise 0.
//! - A fenced `toml`, `csv` or `xml` block with a file name after the word is written to that file first. A whole TOML
//!   file (`format = 1`) must pass `linkwright check`.
//! - `linkwright` is the built program; `cargo run --release --` is the same. The commands of one document run in one
//!   folder, in their order, beside a copy of `problems/`.
//!
//! Times are masked. After a change of the program: `LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool documents` puts
//! the lines that differ in digits or words right where they can be told apart, and copies the figures anew.

mod session;

use crate::common::root;
use crate::common::thorough::is_thorough;
use session::{Block, blocks, matches, mended, of_console, of_sh, shape};
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

/// The beginnings of commands of a quarter of a minute and more: they run with `THOROUGH=1`, and when the pages are written.
const LONG: [&str; 2] = [
    "linkwright synth problems/shapes/heart.toml --set 'design.mechanism=[",
    "linkwright synth problems/examples --out results/all",
];

/// Returns whether a command is left to the longer tests.
fn is_left_out(command: &str) -> bool {
    !is_thorough() && !writing() && LONG.iter().any(|beginning| command.starts_with(beginning))
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

/// Writes a file of a page to the name that stands after its language; a whole TOML file without one, too.
fn written(block: &Block, folder: &Path) -> Option<String> {
    let mut words = block.info.split_whitespace();
    let language = words.next().filter(|language| matches!(*language, "toml" | "csv" | "xml"))?;
    let whole = language == "toml" && block.lines.iter().any(|line| line == "format = 1");
    let name = words.next().or(whole.then_some("unnamed.toml"))?;
    fs::write(folder.join(name), block.lines.join("\n") + "\n").expect("it can be written");
    Some(name.to_owned())
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
        let file = written(&block, folder.path());
        if let Some(file) = file.filter(|_| block.lines.iter().any(|line| line == "format = 1")) {
            let answer = answer(folder.path(), &format!("linkwright check {file}"));
            if answer.code != 0 {
                faults.push(format!("{name}:{}: {file} is refused\n{}", block.first, answer.stderr));
            }
        }
        let steps = match block.info.as_str() {
            "sh" => of_sh(&block),
            "console" => of_console(&block),
            _ => continue,
        };
        let mut steps = steps.into_iter().peekable();
        while let Some(step) = steps.next() {
            if OF_THE_BUILD.iter().any(|build| step.command.starts_with(build)) || is_left_out(&step.command)
            {
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

/// `<!-- drawn: FILE -->` after a figure names the file that a command has drawn it in: the same but for its numbers.
fn figures(page: &[String], name: &str, folder: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for line in page.iter().filter(|line| line.starts_with("![")) {
        let figure = line.split_once("](").and_then(|(_, rest)| rest.split_once(')')).expect("a link").0;
        let kept = if name == "README.md" { root().join(figure) } else { root().join("docs").join(figure) };
        let drawn = line.split_once("<!-- drawn: ").and_then(|(_, rest)| rest.split_once(" -->"));
        if let Some((drawn, _)) = drawn {
            match fs::read_to_string(folder.join(drawn)) {
                Ok(svg) if roxmltree::Document::parse(&svg).is_ok() => {
                    let same = fs::read_to_string(&kept).is_ok_and(|old| shape(&old) == shape(&svg));
                    if writing() {
                        fs::write(&kept, svg).expect("it can be written");
                    } else if !same {
                        faults.push(format!("{name}: {figure} is drawn otherwise now"));
                    }
                }
                _ => faults.push(format!("{name}: no command draws {drawn}")),
            }
        }
        let bytes = fs::read(&kept).unwrap_or_default();
        let picture = bytes.starts_with(b"\x89PNG\r\n")
            || std::str::from_utf8(&bytes).is_ok_and(|svg| roxmltree::Document::parse(svg).is_ok());
        if !picture || bytes.len() >= 120_000 {
            faults.push(format!("{name}: {figure} is no picture of less than 120 kB"));
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
        .flat_map(|(keys, _)| keys.split('`').filter(|key| !key.trim_matches([',', ' ']).is_empty()))
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
fn every_command_of_the_program_stands_in_the_readme() {
    let help = answer(root(), "linkwright --help").stdout;
    let listed = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list");
    let readme = fs::read_to_string(root().join("README.md")).expect("it can be read");
    let table =
        readme.split("\n## Commands\n").nth(1).and_then(|rest| rest.split("\n## ").next()).expect("a table");
    let commands: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(commands.len() > 10, "{help}");
    for command in commands.iter().filter(|command| **command != "help") {
        let named = |mark: char| table.contains(&format!("`{command}{mark}"));
        assert!(named(' ') || named('`'), "the README's table of commands lacks {command}");
    }
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
                let there = page.lines().any(|line| line.starts_with('#') && anchor_of(line) == anchor);
                assert!(there, "{}: no heading for {link}", place.display());
            }
        }
    }
}

#[test]
fn no_two_headings_of_a_page_have_one_anchor() {
    for place in documents() {
        let text = fs::read_to_string(&place).expect("it can be read");
        let (mut seen, mut in_code) = (BTreeSet::new(), false);
        for line in text.lines() {
            in_code ^= line.starts_with("```");
            if !in_code && line.starts_with('#') {
                assert!(seen.insert(anchor_of(line)), "{}: {line} is there twice", place.display());
            }
        }
    }
}

/// The anchor of a heading, as the usual sites of repositories make it.
fn anchor_of(line: &str) -> String {
    let words = line.trim_start_matches('#').trim().to_lowercase();
    let kept = words.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn every_message_that_is_explained_is_one_of_the_program() {
    fn sources(folder: &Path, text: &mut String) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                sources(&path, text);
            } else if path.extension().is_some_and(|e| e == "rs") {
                text.push_str(&fs::read_to_string(&path).expect("it can be read"));
            }
        }
    }
    let mut source = String::new();
    sources(&root().join("src"), &mut source);
    let page = fs::read_to_string(root().join("docs/troubleshooting.md")).expect("the page");
    let messages: Vec<&str> =
        page.lines().filter_map(|line| Some(line.strip_prefix("| `")?.split_once('`')?.0)).collect();
    assert!(messages.len() > 10);
    for message in messages {
        for part in message.split("..").map(str::trim).filter(|part| part.len() > 6) {
            assert!(source.contains(part), "no source says {part:?}");
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
