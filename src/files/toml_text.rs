//! A TOML text with its errors: reads a type from it and finds the place of a key.
//!
//! Errors of syntax and of type have a place; errors of meaning name a key by its path (`task.path.points.3`), and the
//! place is looked up here. Serde's messages are translated into a designer's words.

use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use crate::files::toml_values::TOO_LARGE;
use crate::mechanism::MAX_MAGNITUDE;
use serde::de::DeserializeOwned;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// A TOML text and the name of its file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TomlText<'a> {
    pub file: &'a str,
    pub text: &'a str,
}

/// A key, or an item of a list, with its places in the text.
struct Place<'p> {
    /// The names of the keys and the indices of the items that lead to it, its own last.
    path: &'p [String],
    is_item: bool,
    key: Range<usize>,
    value: Range<usize>,
}

/// Calls `visit` for every key and item inside a value; a table or list comes before its contents.
fn walk(value: &DeValue<'_>, path: &mut Vec<String>, visit: &mut dyn FnMut(&Place<'_>)) {
    let inside: Vec<_> = match value {
        DeValue::Table(table) => table.iter().map(|(k, v)| (k.get_ref().to_string(), k.span(), v)).collect(),
        DeValue::Array(list) => list.iter().enumerate().map(|(i, v)| (i.to_string(), v.span(), v)).collect(),
        _ => return,
    };
    for (name, key, inner) in inside {
        path.push(name);
        visit(&Place { path, is_item: value.is_array(), key, value: inner.span() });
        walk(inner.get_ref(), path, visit);
        path.pop();
    }
}

impl<'a> TomlText<'a> {
    /// Reads the text as a value of type T.
    pub fn read<T: DeserializeOwned>(&self) -> Checked<T> {
        toml::from_str(self.text).map_err(|error| self.explain(&error))
    }

    /// Returns a diagnostic about the value at a path, or about the nearest table around it if it does not exist.
    pub fn at(&self, path: &str, message: impl Into<String>) -> Diagnostic {
        self.about_file(message).at(self.place(path).map(|(_, value)| value))
    }

    /// Returns a diagnostic about the value at a path whose parts may have dots in them.
    pub fn at_path(&self, parts: &[String], message: impl Into<String>) -> Diagnostic {
        self.about_file(message).at(self.span_of(parts).map(|(_, value)| value))
    }

    /// Returns a diagnostic about the key at such a path.
    pub fn at_key_path(&self, parts: &[String], message: impl Into<String>) -> Diagnostic {
        self.about_file(message).at(self.span_of(parts).map(|(key, _)| key))
    }

    /// Returns a diagnostic about the key at a path.
    pub fn at_key(&self, path: &str, message: impl Into<String>) -> Diagnostic {
        self.about_file(message).at(self.place(path).map(|(key, _)| key))
    }

    /// Returns a diagnostic about the whole file.
    pub fn about_file(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.file, self.text, message)
    }

    /// Refuses the value at a path, with a remedy.
    pub fn refuse<T>(&self, path: &str, message: impl Into<String>, help: impl Into<String>) -> Checked<T> {
        Err(Box::new(self.at(path, message).with_help(help)))
    }

    /// Refuses the key at a path, with a remedy.
    pub fn refuse_key<T>(
        &self,
        path: &str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Checked<T> {
        Err(Box::new(self.at_key(path, message).with_help(help)))
    }

    /// Refuses the whole file, with a remedy.
    pub fn refuse_file<T>(&self, message: impl Into<String>, help: impl Into<String>) -> Checked<T> {
        Err(Box::new(self.about_file(message).with_help(help)))
    }

    /// Visits every key and item of the text; none if it is no TOML.
    fn walk(&self, visit: &mut dyn FnMut(&Place<'_>)) {
        if let Ok(document) = DeTable::parse(self.text) {
            walk(&DeValue::Table(document.into_inner()), &mut Vec::new(), visit);
        }
    }

    /// Returns the places of the key and of the value at a path, or of the last part of the path that exists.
    fn place(&self, path: &str) -> Option<(Range<usize>, Range<usize>)> {
        self.span_of(&path.split('.').map(str::to_owned).collect::<Vec<_>>())
    }

    /// Returns the places as [`place`](Self::place) does, for a path whose parts may have dots in them.
    pub fn span_of(&self, parts: &[String]) -> Option<(Range<usize>, Range<usize>)> {
        let mut found = None;
        self.walk(&mut |place| {
            if parts.starts_with(place.path) {
                found = Some((place.key.clone(), place.value.clone()));
            }
        });
        found
    }

    /// Returns the path of the table that contains the key at a place, without indices of lists.
    fn table_around(&self, key_start: usize) -> String {
        let mut table = String::new();
        self.walk(&mut |place| {
            if let ([around @ .., _], false) = (place.path, place.is_item)
                && place.key.start == key_start
            {
                let named = around.iter().filter(|name| name.parse::<usize>().is_err());
                table = named.cloned().collect::<Vec<_>>().join(".");
            }
        });
        table
    }

    /// Returns the innermost key whose value contains a place; that of a `[table]` is its header.
    fn key_around(&self, start: usize) -> Option<String> {
        let mut innermost = None;
        self.walk(&mut |place| {
            if !place.is_item && place.value.contains(&start) {
                innermost = place.path.last().cloned();
            }
        });
        innermost
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
            Diagnostic { help, ..self.about_file(plain_words(message)) }
        };
        Box::new(diagnostic.at(span))
    }

    fn unknown_key(&self, key: &str, allowed: &[&str], span: Option<&Range<usize>>) -> Diagnostic {
        if key == "task" && allowed.contains(&"vector_loop") {
            return self.about_file("this is a problem file, not a linkage file").with_help(
                "`linkwright synth` runs it; a linkage file has [linkage], [vector_loop], [slider_crank], \
                 [inverted_slider_crank] or [chain]",
            );
        }
        if matches!(key, "linkage" | "vector_loop" | "slider_crank" | "inverted_slider_crank" | "chain")
            && allowed.contains(&"task")
            && self.place("task").is_none()
        {
            return self
                .about_file("this is a linkage file, not a problem file")
                .with_help("`linkwright analyze` reads it; a problem file has [task.path]");
        }
        let table = span.map_or(String::new(), |s| self.table_around(s.start));
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
                format!("the number is too large: numbers go up to {MAX_MAGNITUDE:e}")
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
