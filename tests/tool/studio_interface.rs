//! The studio's interface as it is documented: the committed descriptions are those of the program, every request that
//! they name is answered. To write them after a change of the types or routes:
//! `LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool studio_interface`.

use crate::common::root;
use crate::studio::Studio;
use linkwright::internals::app::studio::{messages, openapi};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

#[test]
fn the_committed_descriptions_are_those_of_the_program() {
    for (file, value) in
        [("studio-openapi.json", openapi::document()), ("studio-messages.json", messages::schemas())]
    {
        let (path, text) = (root().join("docs").join(file), format!("{value:#}\n"));
        if std::env::var_os("LINKWRIGHT_WRITE_DOCS").is_some() {
            fs::write(&path, &text).expect("it can be written");
        }
        let committed = fs::read_to_string(&path).expect("it is there");
        assert!(committed == text, "docs/{file} is not what the program says: write it anew");
    }
}

#[test]
fn every_request_of_the_description_is_answered_and_no_other() {
    let folder = TempDir::new().expect("a folder");
    let studio = Studio::start(&["--port", "18446", "--out", &folder.path().display().to_string()]);
    let cookie = studio.cookie();
    let served = studio.asks("GET", "/openapi.json", &[("Cookie", &cookie)], b"").0;
    let served: Value = serde_json::from_str(served.split("\r\n\r\n").nth(1).expect("a body")).expect("JSON");
    assert_eq!(served, openapi::document());
    let origin = studio.origin();
    let asks = |method: &str, path: &str| {
        studio.asks(method, path, &[("Cookie", &cookie), ("Origin", &origin)], b"").status()
    };
    for (path, methods) in served["paths"].as_object().expect("paths") {
        let place = path.replace("{name}", "none").replace("{file}", "record.json");
        for method in ["GET", "POST", "PUT", "DELETE", "PATCH"] {
            let documented = methods.get(method.to_lowercase()).is_some();
            // What is documented is answered, if only by what is wrong with an empty body or that there is no such job.
            assert_eq!(asks(method, &place) == 405, !documented, "{method} {place}");
        }
        assert_eq!(asks("GET", &format!("{place}x/x/x/x")), 404);
    }
}
