//! Applies `--set KEY=VALUE` to the text of a document, which is then read like any other.

use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use crate::files::toml_text::TomlText;
use toml_edit::{DocumentMut, Item, Key, Table, TableLike, Value};

/// Returns the name and the text of a document with the overrides written into it.
pub(super) fn apply(toml: &TomlText<'_>, overrides: &[(String, String)]) -> Checked<(String, String)> {
    if overrides.is_empty() {
        return Ok((toml.file.to_owned(), toml.text.to_owned()));
    }
    // A broken document is reported as it is in the file.
    let _: toml::Table = toml.read()?;
    let mut document: DocumentMut =
        toml.text.parse().map_err(|e: toml_edit::TomlError| Box::new(toml.about_file(e.message())))?;
    let mut file = toml.file.to_owned();
    for (key, value) in overrides {
        file.push_str(&format!(" with --set {key}={value}"));
        set(document.as_table_mut(), key, value).map_err(|(message, help)| {
            Box::new(Diagnostic::new(file.clone(), "", message).with_help(help))
        })?;
    }
    Ok((file, document.to_string()))
}

/// The fault of an override with its remedy.
type Refusal = (String, &'static str);

fn set(root: &mut Table, key: &str, value: &str) -> Result<(), Refusal> {
    let path = Key::parse(key).map_err(|_| {
        (format!("{} is not a key", quoted(key)), "write --set KEY=VALUE with a key such as solve.seed")
    })?;
    let Some((last, tables)) = path.split_last() else {
        return Err(("the key is empty".into(), "write --set KEY=VALUE with a key such as solve.seed"));
    };
    let mut table: &mut dyn TableLike = root;
    for part in tables {
        let dotted = table.is_dotted();
        table = table
            .entry(part.get())
            .or_insert_with(|| {
                let mut new = Table::new();
                new.set_implicit(true);
                new.set_dotted(dotted);
                Item::Table(new)
            })
            .as_table_like_mut()
            .ok_or_else(|| {
                let message = format!("{} in {} is a value, not a table", quoted(part.get()), quoted(key));
                (message, "name a key of a table, such as solve.seed")
            })?;
    }
    // What is no TOML is a bare string: --set solve.method=genetic.
    let mut value = value.parse::<Value>().unwrap_or_else(|_| Value::from(value));
    value.decor_mut().clear();
    match table.get_mut(last.get()) {
        Some(item @ Item::Value(_)) => *item = Item::Value(value),
        Some(_) => {
            return Err((
                format!("{} is a table, not a value", quoted(key)),
                "name a key of that table, such as solve.seed",
            ));
        }
        None => {
            table.insert(last.get(), Item::Value(value));
        }
    }
    Ok(())
}
