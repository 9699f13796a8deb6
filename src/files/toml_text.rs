//! A TOML text with its errors: reads a type from it and finds the place of a key.
//!
//! Errors of syntax and of type have a place; errors of meaning name a key by its path (`task.path.points.3`), and the
//! place is looked up here. Serde's messages are translated into a designer's words.

use crate::files::diagnostic::{Diagnostic, quoted};
use crate::files::toml_values::TOO_LARGE;
use serde::de::DeserializeOwned;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// A TOML text and the name of its file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TomlText<'a> {
    pub file: &'a str,
    pub text: &'a str,
}

/// A key that is known but not supported yet.
struct KeyToCome {
    key: &'static str,
    /// Another key in the same table: elsewhere the same word is just unknown.
    beside: &'static str,
    /// The feature that is not supported.
    what: &'static str,
    /// The feature to use instead.
    instead: &'static str,
}

const ONLY_PATH: &str = "a problem has one task, and [task.path] is the only kind that is supported";
const KEYS_TO_COME: [KeyToCome; 2] = [
    KeyToCome { key: "motion", beside: "path", what: "[task.motion]", instead: ONLY_PATH },
    KeyToCome { key: "function", beside: "path", what: "[task.function]", instead: ONLY_PATH },
];

impl<'a> TomlText<'a> {
    /// Reads the text as a value of type T.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, Box<Diagnostic>> {
        toml::from_str(self.text).map_err(|error| self.explain(&error))
    }

    /// Returns a diagnostic about the value at a path, or about the nearest table around it if it does not exist.
    pub fn at(&self, path: &str, message: impl Into<String>) -> Diagnostic {
        let diagnostic = self.about_file(message);
        match self.place(path) {
            Some((_, value)) => diagnostic.at(value),
            None => diagnostic,
        }
    }

    /// Returns a diagnostic about the key at a path.
    pub fn at_key(&self, path: &str, message: impl Into<String>) -> Diagnostic {
        let diagnostic = self.about_file(message);
        match self.place(path) {
            Some((key, _)) => diagnostic.at(key),
            None => diagnostic,
        }
    }

    /// Returns a diagnostic about the whole file.
    pub fn about_file(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.file, self.text, message)
    }

    /// Returns the places of the key and of the value at a path, or of the last part of the path that exists.
    fn place(&self, path: &str) -> Option<(Range<usize>, Range<usize>)> {
        let document = DeTable::parse(self.text).ok()?;
        let mut table = Some(document.get_ref());
        let mut array = None;
        let mut found = None;
        for part in path.split('.') {
            let value = match (table, array) {
                (Some(t), _) => {
                    let Some((key, value)) = t.get_key_value(part) else { break };
                    found = Some((key.span(), value.span()));
                    value
                }
                (None, Some(list)) => {
                    let list: &toml::de::DeArray<'_> = list;
                    let Some(value) = part.parse().ok().and_then(|i: usize| list.get(i)) else { break };
                    found = Some((value.span(), value.span()));
                    value
                }
                (None, None) => break,
            };
            (table, array) = match value.get_ref() {
                DeValue::Table(t) => (Some(t), None),
                DeValue::Array(list) => (None, Some(list)),
                _ => (None, None),
            };
        }
        found
    }

    /// Returns the path of the table that contains the key at a place.
    fn table_around(&self, key_start: usize) -> Option<String> {
        fn search(table: &DeTable<'_>, start: usize, path: &str) -> Option<String> {
            table.iter().find_map(|(key, value)| {
                if key.span().start == start {
                    return Some(path.to_owned());
                }
                let below = if path.is_empty() {
                    key.get_ref().to_string()
                } else {
                    format!("{path}.{}", key.get_ref())
                };
                match value.get_ref() {
                    DeValue::Table(t) => search(t, start, &below),
                    DeValue::Array(list) => list.iter().find_map(|item| match item.get_ref() {
                        DeValue::Table(t) => search(t, start, &below),
                        _ => None,
                    }),
                    _ => None,
                }
            })
        }
        search(DeTable::parse(self.text).ok()?.get_ref(), key_start, "")
    }

    /// Returns the key whose value contains a place.
    fn key_around(&self, start: usize) -> Option<String> {
        fn in_table(table: &DeTable<'_>, start: usize) -> Option<String> {
            table.iter().find_map(|(key, value)| {
                let holds = value.span().contains(&start).then(|| key.get_ref().to_string());
                match value.get_ref() {
                    // The span of [table] is that of its header.
                    DeValue::Table(t) => in_table(t, start).or(holds),
                    DeValue::Array(list) => {
                        let below = list.iter().find_map(|item| match item.get_ref() {
                            DeValue::Table(t) => in_table(t, start),
                            _ => None,
                        });
                        below.or(holds)
                    }
                    _ => holds,
                }
            })
        }
        in_table(DeTable::parse(self.text).ok()?.get_ref(), start)
    }

    /// Translates an error of the parser or of serde into a designer's words.
    fn explain(&self, error: &toml::de::Error) -> Box<Diagnostic> {
        let (message, span) = (error.message(), error.span());
        let diagnostic = if let Some((key, allowed)) = unknown(message, "unknown field ") {
            self.unknown_key(key, &allowed, span.as_ref())
        } else if let Some((value, allowed)) = unknown(message, "unknown variant ") {
            self.unknown_value(value, &allowed)
        } else if let Some(key) = message.strip_prefix("missing field ") {
            self.about_file(format!("the key {key} is missing")).with_help("add it to this table")
        } else {
            let (message, help) = match message.split_once('\n') {
                // A value does not know the key that it belongs to.
                Some((message, TOO_LARGE)) => {
                    let key = span.as_ref().and_then(|span| self.key_around(span.start));
                    (message, Some(too_large_help(&key.unwrap_or_default()).to_owned()))
                }
                Some((message, help)) => (message, Some(help.to_owned())),
                None => (message, self.syntax_help(message, span.as_ref())),
            };
            let diagnostic = self.about_file(plain_words(message));
            match help {
                Some(help) => diagnostic.with_help(help),
                None => diagnostic,
            }
        };
        Box::new(match span {
            Some(span) => diagnostic.at(span),
            None => diagnostic,
        })
    }

    fn unknown_key(&self, key: &str, allowed: &[&str], span: Option<&Range<usize>>) -> Diagnostic {
        let to_come = KEYS_TO_COME.iter().find(|k| k.key == key && allowed.contains(&k.beside));
        if let Some(KeyToCome { what, instead, beside, .. }) = to_come {
            let message = match self.place("task.path") {
                Some((key, _)) if *beside == "path" && self.text.get(key.clone()) == Some("path") => {
                    format!("two tasks: [task.path] and {what}, which is not supported yet")
                }
                _ => format!("{what} is not supported yet"),
            };
            return self.about_file(message).with_help(*instead);
        }
        if key == "task" && allowed.contains(&"vector_loop") {
            return self.about_file("this is a problem file, not a linkage file").with_help(
                "`linkwright synth` runs it; a linkage file has [linkage], [vector_loop] or [chain]",
            );
        }
        if matches!(key, "linkage" | "vector_loop" | "chain")
            && allowed.contains(&"task")
            && self.place("task").is_none()
        {
            return self
                .about_file("this is a linkage file, not a problem file")
                .with_help("`linkwright analyze` reads it; a problem file has [task.path]");
        }
        let table = span.and_then(|s| self.table_around(s.start)).unwrap_or_default();
        let place = if table.is_empty() { "at the top of the file".into() } else { format!("in [{table}]") };
        let kind = match self.text.get(..span.map_or(0, |s| s.start)) {
            Some(before) if before.trim_end_matches([' ', '\t']).ends_with('[') => "table",
            _ => "key",
        };
        let hint = nearest(key, allowed).map_or(String::new(), |n| format!("did you mean `{n}`? "));
        self.about_file(format!("unknown {kind} {} {place}", quoted(key)))
            .with_help(format!("{hint}keys allowed here: {}", allowed.join(", ")))
    }

    fn unknown_value(&self, value: &str, allowed: &[&str]) -> Diagnostic {
        let list = allowed.join(", ");
        let hint = nearest(value, allowed).map_or(String::new(), |n| format!("did you mean \"{n}\"? "));
        self.about_file(format!("{} is not known here", quoted(value)))
            .with_help(format!("{hint}values allowed: {list}"))
    }

    /// Returns the remedies for the commonest typing errors.
    fn syntax_help(&self, message: &str, span: Option<&Range<usize>>) -> Option<String> {
        let start = span?.start.min(self.text.len());
        let before = self.text.get(..start)?;
        let after = self.text.get(start..)?;
        let digit = |c: char| c.is_ascii_digit();
        let line = before.rsplit('\n').next().unwrap_or_default();
        if before.ends_with(digit) && after.starts_with(',') && !line.contains('[') {
            return Some("write numbers with a decimal point: 2.5, not 2,5".into());
        }
        if message.starts_with("string values must be quoted") {
            return Some("write text in quotes: name = \"arm\"".into());
        }
        if let Some(text) = message.strip_prefix("invalid type: string \"") {
            let text = text.split('"').next().unwrap_or_default();
            return text.parse::<f64>().is_ok().then(|| format!("remove the quotes: {text}"));
        }
        let slips = [
            ("duplicate key", "each key and each table stands once"),
            ("key with no value", "a line is either key = value, or [table], or a # comment"),
            ("array", "is every [ closed by a ], with commas between?"),
            ("expected a string", "write text in quotes"),
        ];
        slips.iter().find(|(slip, _)| message.contains(slip)).map(|(_, help)| (*help).to_owned())
    }
}

/// Returns the remedy for a number that is too large for a key (or a column): it differs for lengths, times and angles.
pub(crate) fn too_large_help(key: &str) -> &'static str {
    let is_one = |keys: &[&str]| keys.contains(&key);
    if key == "time_limit_s" {
        "write fewer seconds, or remove the key: without it there is no such limit"
    } else if key.ends_with("_deg") {
        "write an angle in degrees, such as 30"
    } else if is_one(&["gap", "weight", "link_ratio_max", "vector", "goal_sum_sq"]) || key.ends_with("sum_sq")
    {
        TOO_LARGE
    } else {
        "use a larger unit, such as m for mm"
    }
}

/// Returns the faulty word and the allowed words of serde's "unknown field `x`, expected one of `a`, `b`".
fn unknown<'m>(message: &'m str, prefix: &str) -> Option<(&'m str, Vec<&'m str>)> {
    let rest = message.strip_prefix(prefix)?.strip_prefix('`')?;
    let (name, allowed) =
        rest.rsplit_once("`, expected ").or_else(|| rest.rsplit_once("`, there are no "))?;
    Some((name, allowed.split('`').skip(1).step_by(2).collect()))
}

/// Translates serde's words for types and values into plain ones.
fn plain_words(message: &str) -> String {
    let Some((found, expected)) = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))
        .and_then(|rest| rest.rsplit_once(", expected "))
    else {
        return match message {
            "wanted string or table" => "expected a text in quotes".into(),
            "floating-point number overflowed" | "integer number overflowed" => {
                "the number is too large: numbers go up to 1e12".into()
            }
            other => other.to_owned(),
        };
    };
    let expected = match expected {
        "f64" => "a number",
        "usize" | "u64" | "u32" => "a whole number, 0 or more",
        "i64" => "a whole number",
        "a string" => "a text in quotes",
        "a boolean" => "true or false",
        "a sequence" => "a list",
        table if table.starts_with("struct ") => "a table",
        other => other,
    };
    let found = match found {
        "sequence" => "a list".into(),
        "map" => "a table".into(),
        other => match other.split_once(' ') {
            Some(("string", text)) => format!("the text {text}"),
            Some(("integer", number)) => format!("the number {}", number.trim_matches('`')),
            Some(("floating", number)) => {
                format!("the number {}", number.trim_start_matches("point ").trim_matches('`'))
            }
            Some(("boolean", value)) => value.trim_matches('`').to_owned(),
            _ => other.to_owned(),
        },
    };
    format!("expected {expected}, found {found}")
}

/// Returns the nearest of the allowed words, if it is near enough to be meant.
pub(crate) fn nearest<'w>(word: &str, allowed: &[&'w str]) -> Option<&'w str> {
    /// The length in bytes above which a word is not taken for a misspelling.
    const LONGEST: usize = 64;
    if word.len() > LONGEST {
        return None;
    }
    let plain = |s: &str| s.to_lowercase().replace('_', "-");
    let reach = 1 + word.chars().count() / 4;
    allowed
        .iter()
        .map(|a| (edit_distance(&plain(word), &plain(a)), *a))
        .filter(|(distance, a)| *distance <= reach && *distance < a.chars().count())
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, a)| a)
}

/// Returns Levenshtein's distance.
fn edit_distance(x: &str, y: &str) -> usize {
    let y: Vec<char> = y.chars().collect();
    let mut row: Vec<usize> = (0..=y.len()).collect();
    for (i, cx) in x.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cy) in y.iter().enumerate() {
            let substituted = diagonal + usize::from(cx != *cy);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[y.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_found_by_its_path() {
        let toml = TomlText { file: "f", text: "a = 1\n[b.c]\nd = [[1, 2], [3, 4]]\n" };
        let text_at = |path| toml.at(path, "m").span.map(|s| &toml.text[s]);
        assert_eq!(text_at("a"), Some("1"));
        assert_eq!(text_at("b.c.d.1"), Some("[3, 4]"));
        assert_eq!(text_at("b.c.d.1.0"), Some("3"));
        assert_eq!(toml.at_key("b.c.d", "m").span.map(|s| &toml.text[s]), Some("d"));
        assert_eq!(text_at("nowhere"), None);
        let key_at = |part: &str| toml.key_around(toml.text.find(part).expect("it is there"));
        assert_eq!(key_at("3, 4").as_deref(), Some("d"));
        assert_eq!(key_at("1\n").as_deref(), Some("a"));
    }

    #[test]
    fn near_misses_are_guessed_and_strangers_are_not() {
        assert_eq!(nearest("coupler_X", &["a", "coupler_x", "coupler_y"]), Some("coupler_x"));
        assert_eq!(
            nearest("differential_evolution", &["differential-evolution"]),
            Some("differential-evolution")
        );
        assert_eq!(nearest("evalutions", &["evaluations", "seed"]), Some("evaluations"));
        assert_eq!(nearest("wings", &["points", "file"]), None);
        assert_eq!(nearest("f", &["a", "b"]), None);
    }
}
