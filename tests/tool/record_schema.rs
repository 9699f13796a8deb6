//! `schema record`: every record is what the schema says, and a record that is not is told from it.

use crate::common::root;
use linkwright::internals::files::schema::{SchemaKind, schema};
use serde_json::Value;
use std::fs;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// Checks a value against the part of JSON Schema (draft 2020-12) that our schemas use; a word beyond it is an error of
/// this test. `strict`: keys that the schema does not name are refused too.
struct Judge<'a> {
    root: &'a Value,
    strict: bool,
}

impl Judge<'_> {
    fn judge(&self, schema: &Value, value: &Value, place: &str) -> Result<(), String> {
        let Some(words) = schema.as_object() else {
            return match schema {
                Value::Bool(true) => Ok(()),
                _ => Err(format!("{place}: nothing is allowed here")),
            };
        };
        for (word, asked) in words {
            self.word(word, asked, words, value).map_err(|why| format!("{place}: {why}"))?;
            let below = |schema: &Value, value: &Value, step: &str| {
                self.judge(schema, value, &format!("{place}/{step}"))
            };
            match (word.as_str(), value) {
                ("$ref", _) => {
                    let pointer = asked.as_str().expect("text").trim_start_matches('#');
                    below(self.root.pointer(pointer).expect("it is defined"), value, "")?;
                }
                ("properties", Value::Object(members)) => {
                    for (key, member) in members {
                        match asked.get(key) {
                            Some(schema) => below(schema, member, key)?,
                            None if self.strict => {
                                return Err(format!("{place}: {key} is not in the schema"));
                            }
                            None => {}
                        }
                    }
                }
                ("additionalProperties", Value::Object(members)) if asked.is_object() => {
                    for (key, member) in members {
                        below(asked, member, key)?;
                    }
                }
                ("items", Value::Array(items)) => {
                    for (i, item) in items.iter().enumerate() {
                        below(asked, item, &i.to_string())?;
                    }
                }
                ("prefixItems", Value::Array(items)) => {
                    for (i, (schema, item)) in asked.as_array().expect("a list").iter().zip(items).enumerate()
                    {
                        below(schema, item, &i.to_string())?;
                    }
                }
                ("anyOf" | "oneOf", _) => {
                    let ways = asked.as_array().expect("a list");
                    let failures: Vec<String> =
                        ways.iter().filter_map(|way| below(way, value, word).err()).collect();
                    let held = ways.len() - failures.len();
                    if held == 0 || (word == "oneOf" && held > 1) {
                        return Err(format!("{place}: {held} ways hold: {}", failures.join("; ")));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// What a word says of the value itself.
    fn word(
        &self,
        word: &str,
        asked: &Value,
        words: &serde_json::Map<String, Value>,
        value: &Value,
    ) -> Result<(), String> {
        let is = |kind: &str| match kind {
            "null" => value.is_null(),
            "boolean" => value.is_boolean(),
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "number" => value.is_number(),
            "integer" => value.is_i64() || value.is_u64(),
            other => panic!("an unknown type {other}"),
        };
        let length = value.as_array().map(Vec::len);
        let holds = match word {
            "type" => match asked {
                Value::Array(kinds) => kinds.iter().any(|kind| is(kind.as_str().expect("text"))),
                kind => is(kind.as_str().expect("text")),
            },
            "required" => value.as_object().is_none_or(|members| {
                asked
                    .as_array()
                    .expect("a list")
                    .iter()
                    .all(|k| members.contains_key(k.as_str().expect("text")))
            }),
            "enum" => asked.as_array().expect("a list").contains(value),
            "const" => asked == value,
            "minimum" => value.as_f64().is_none_or(|number| number >= asked.as_f64().expect("a number")),
            "maximum" => value.as_f64().is_none_or(|number| number <= asked.as_f64().expect("a number")),
            "minItems" => length.is_none_or(|n| n as u64 >= asked.as_u64().expect("a number")),
            "maxItems" => length.is_none_or(|n| n as u64 <= asked.as_u64().expect("a number")),
            "additionalProperties" => {
                let named = |key: &String| words.get("properties").is_some_and(|p| p.get(key).is_some());
                asked != &Value::Bool(false) || value.as_object().is_none_or(|m| m.keys().all(named))
            }
            "$schema" | "$defs" | "$ref" | "title" | "description" | "format" | "default" | "properties"
            | "items" | "prefixItems" | "anyOf" | "oneOf" => true,
            other => panic!("a word that this test does not know: {other}"),
        };
        if holds { Ok(()) } else { Err(format!("{word} {asked} does not hold of {value:.60}")) }
    }
}

fn judged(record: &Value, strict: bool) -> Result<(), String> {
    let schema = schema(SchemaKind::Record);
    Judge { root: &schema, strict }.judge(&schema, record, "")
}

fn linkwright(folder: &TempDir, arguments: &[&str]) -> Vec<u8> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_linkwright"));
    command.current_dir(folder.path()).args(arguments).stdin(Stdio::null()).stderr(Stdio::null());
    command.output().expect("it runs").stdout
}

/// The records of the corpus, of fresh runs of several kinds and of `snap`.
fn records() -> Vec<(String, Value)> {
    let mut records = Vec::new();
    for entry in fs::read_dir(root().join("tests/corpora/record")).expect("it is there") {
        let path = entry.expect("it can be read").path();
        let text = fs::read(&path).expect("it can be read");
        records.push((path.display().to_string(), serde_json::from_slice(&text).expect("JSON")));
    }
    assert!(records.len() >= 3);
    let folder = TempDir::new().expect("a folder");
    let literature =
        |name: &str| root().join(format!("problems/literature/{name}.toml")).display().to_string();
    for (name, more) in [
        ("e5", "solve.evaluations=3000"),
        ("a6b", "solve.evaluations=3000"),
        ("k18", "solve.certify=true"),
        ("shape-heart", "solve.evaluations=2000"),
        ("e5", "require.footprint_in=[0,0,1,1]"),
    ] {
        let set = ["--set", more, "--set", "certify.time_limit_s=1"];
        let set = if more.contains("certify") { &set[..] } else { &set[..2] };
        let problem = literature(name);
        let arguments = [&["synth", problem.as_str(), "--json", "--quiet", "--out", "r"], set].concat();
        let text = linkwright(&folder, &arguments);
        records.push((format!("{name} {more}"), serde_json::from_slice(&text).expect("JSON")));
    }
    linkwright(&folder, &["snap", "r", "--grid", "0.5", "--snap", "a", "--out", "snapped"]);
    if let Ok(text) = fs::read(folder.path().join("snapped/record.json")) {
        records.push(("snap".into(), serde_json::from_slice(&text).expect("JSON")));
    }
    records
}

#[test]
fn every_record_is_as_the_schema_says_and_holds_no_key_that_it_does_not_name() {
    for (name, record) in records() {
        for strict in [false, true] {
            judged(&record, strict).unwrap_or_else(|why| panic!("{name}: {why}"));
        }
    }
}

#[test]
fn a_key_left_out_or_of_another_type_is_told_from_the_schema() {
    let text = fs::read(root().join("tests/corpora/record/accepted.json")).expect("it is there");
    let record: Value = serde_json::from_slice(&text).expect("JSON");
    let required =
        ["format", "tool", "problem", "seed", "method", "termination", "evaluations", "candidates"];
    for key in required {
        let mut without = record.clone();
        without.as_object_mut().expect("an object").remove(key);
        assert!(judged(&without, false).is_err(), "{key}");
    }
    for place in [
        "/candidates/0/error/rms",
        "/candidates/0/linkage/t1",
        "/candidates/0/linkage/A",
        "/candidates/0/type",
        "/candidates/0/accepted",
        "/termination/reason",
        "/problem/resolved/task/path/points/0",
        "/method/asked",
    ] {
        let mut wrong = record.clone();
        *wrong.pointer_mut(place).expect("it is there") = Value::String("nonsense".into());
        assert!(judged(&wrong, false).is_err(), "{place}");
    }
    let mut sign = record.clone();
    *sign.pointer_mut("/candidates/0/t1_at/0").expect("it is there") = 2.into();
    assert!(judged(&sign, false).is_err());
}

#[test]
fn the_schema_is_printed_and_has_a_meaning_for_every_key() {
    let folder = TempDir::new().expect("a folder");
    let printed: Value = serde_json::from_slice(&linkwright(&folder, &["schema", "record"])).expect("JSON");
    assert_eq!(printed, schema(SchemaKind::Record));
    assert_eq!(printed["$schema"], "https://json-schema.org/draft/2020-12/schema");
}
