//! Fenced blocks of a page as commands with what is shown of their output, and whether that is what was printed.

/// A fenced block: its words after the fence, the number of its first line in the page, its lines.
pub struct Block {
    pub info: String,
    pub first: usize,
    pub lines: Vec<String>,
}

pub fn blocks(page: &[String]) -> Vec<Block> {
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
pub struct Step {
    pub line: usize,
    pub command: String,
    pub shown: Option<Vec<(usize, String)>>,
}

/// The commands of an `sh` block: one a line, `\` at the end of a line continues it.
pub fn of_sh(block: &Block) -> Vec<Step> {
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
pub fn of_console(block: &Block) -> Vec<Step> {
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

/// A line without its times and without blanks at its end.
pub fn masked(line: &str) -> String {
    let mut text = line.trim_end().to_owned();
    for unit in [" s in all", " s of search", " s for ", " s more for"] {
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
pub fn agrees(shown: &str, printed: &str) -> bool {
    match shown.trim_end().strip_suffix("...") {
        Some(start) if !start.is_empty() => masked(printed).starts_with(&masked(start)),
        _ => masked(shown) == masked(printed),
    }
}

/// Whether the lines shown are the lines printed, `...` standing for any number of lines.
pub fn matches(shown: &[&str], printed: &[&str]) -> bool {
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
pub fn shape(line: &str) -> String {
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
pub fn mended(shown: &[(usize, String)], printed: &[&str], page: &mut [String]) {
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
