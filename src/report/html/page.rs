//! An HTML page in one file: no network, one style and one script, both named by their hashes in its security policy.
//!
//! Markup is made by `maud`, which escapes every text that is put into it; data from a record reaches the page only in
//! this way or as JSON in a script element that is not executed. The policy lets the browser use only the style and the
//! script that were put in here.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use sha2::{Digest, Sha256};

/// The contents of a page.
pub(in crate::report) struct Page<'a> {
    /// The title, as text.
    pub(in crate::report) title: &'a str,
    /// The style sheets, one after the other.
    pub(in crate::report) styles: &'a [&'a str],
    /// The visible part.
    pub(in crate::report) body: Markup,
    /// The data that the script reads: JSON from [`embedded`].
    pub(in crate::report) data: &'a str,
    /// The ES modules, each after those that it imports: see [`joined`].
    pub(in crate::report) modules: &'a [&'a str],
}

impl Page<'_> {
    /// Returns the whole page as text. Its beginning with the mark of its generator is what
    /// [`crate::files::generator`] looks for.
    pub(in crate::report) fn render(self) -> String {
        let style = self.styles.join("\n");
        let script = joined(self.modules);
        let policy = format!(
            "default-src 'none'; style-src '{}'; script-src '{}'; base-uri 'none'; form-action 'none'",
            source_hash(&style),
            source_hash(&script)
        );
        let generator = concat!("linkwright ", env!("CARGO_PKG_VERSION"));
        html! {
            (PreEscaped("<!doctype html>\n"))
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="generator" content=(generator);
                    meta http-equiv="Content-Security-Policy" content=(policy);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(style)) }
                }
                body {
                    (PreEscaped(visible(self.body)))
                    script type="application/json" id="data" { (PreEscaped(self.data)) }
                    script { (PreEscaped(script)) }
                }
            }
            "\n"
        }
        .into_string()
    }
}

/// Returns markup as text without control characters: spaces are in their place.
pub(super) fn visible(markup: Markup) -> String {
    markup.into_string().replace(|c: char| c.is_control() && c != '\n', " ")
}

/// Returns a section with a heading, as a card.
pub(in crate::report) fn section(id: &str, title: &str, inside: Markup) -> Markup {
    html! {
        section.card id=(id) aria-labelledby={ (id) "-title" } {
            h2 id={ (id) "-title" } { (title) }
            (inside)
        } "\n"
    }
}

/// Returns a paragraph.
pub(in crate::report) fn paragraph(class: &str, text: &str) -> Markup {
    html! { p class=[Some(class).filter(|class| !class.is_empty())] { (text) } }
}

/// Returns a list of sentences.
pub(super) fn list<T: maud::Render>(items: impl IntoIterator<Item = T>) -> Markup {
    html! { ul.said-list { @for item in items { li { (item) } } } }
}

/// Returns the most important figures, each with its name.
pub(super) fn figures<T: maud::Render>(pairs: impl IntoIterator<Item = (&'static str, T)>) -> Markup {
    html! { dl.figures { @for (key, value) in pairs { div { dt { (key) } dd { (value) } } } } }
}

/// Returns a drawing as it is embedded in a page, in which it needs no name space.
pub(super) fn still(drawing: &str) -> Markup {
    let inline = drawing.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    html! { figure.still { (PreEscaped(inline)) } }
}

/// Returns a drawing that is part of the page, with its script too.
pub(super) fn drawn(drawing: &str) -> Markup {
    let inline = drawing.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    html! { figure.drawn { (PreEscaped(inline)) } }
}

/// Returns data as JSON that no text inside can break out of: every `<` is written as `\u003c`.
pub(in crate::report) fn embedded(data: &impl Serialize) -> String {
    // The data has string keys and no maps, so that it can always be written.
    let json = serde_json::to_string(data).unwrap_or_default();
    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        // Characters that end an element, or that hide or turn what stands beside them. They are in texts alone.
        let hides = matches!(c, '<' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{ffff}');
        if hides || c.is_control() {
            out.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            out.push(c);
        }
    }
    out
}

/// Returns ES modules as one script in a scope of its own. Each has to follow those that it imports; `import` has to be
/// on one line, `export` in front of a declaration.
pub(in crate::report) fn joined(modules: &[&str]) -> String {
    let mut script = String::from("(() => {\n\"use strict\";\n");
    for line in modules.iter().flat_map(|module| module.lines()) {
        if !line.starts_with("import ") {
            script.push_str(line.strip_prefix("export ").unwrap_or(line));
            script.push('\n');
        }
    }
    script.push_str("})();\n");
    script
}

/// Returns the hash `sha256-..` of an inline style or script, as a security policy names it.
fn source_hash(text: &str) -> String {
    format!("sha256-{}", STANDARD.encode(Sha256::digest(text.as_bytes())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_policy_names_a_script_by_its_hash() {
        assert_eq!(source_hash(""), "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
    }

    #[test]
    fn modules_are_joined_without_their_imports_and_exports() {
        let one = "export const one = 1;\n";
        let two = "import { one } from \"./one.mjs\";\n\nexport function two() {\n  return one + one;\n}\n";
        let script = joined(&[one, two]);
        assert!(script.contains("\nconst one = 1;\n") && script.contains("\nfunction two() {\n"), "{script}");
        assert!(!script.contains("import") && !script.contains("export"), "{script}");
    }

    #[test]
    fn a_page_holds_no_control_characters() {
        assert_eq!(visible(html! { p { "a\u{0}b\u{9b}\n" } }), "<p>a b \n</p>");
    }

    #[test]
    fn text_cannot_leave_its_place() {
        let hostile = "</script><!--\"'><img src=x onerror=alert(1)>&";
        assert_eq!(
            html! { (hostile) }.into_string(),
            "&lt;/script&gt;&lt;!--&quot;'&gt;&lt;img src=x onerror=alert(1)&gt;&amp;"
        );
        let json = embedded(&hostile);
        assert!(!json.contains('<'));
        assert_eq!(serde_json::from_str::<String>(&json).expect("JSON"), hostile);
    }
}
