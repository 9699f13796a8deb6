//! The interface described: routes here, bodies by the types that are read and written.
//!
//! OpenAPI 3.1 describes what is asked over HTTP; the WebSocket's messages are described by their JSON Schemas alone
//! ([`schemas`](super::messages::schemas)). A test compares the paths here with the routes of the server.

use super::api::Opened;
use super::details::{CompareAsk, Details, DetailsAsk, ExportAsk};
use super::job_messages::{JobAsk, JobList, JobShown};
use super::messages::{Ask, LinkageAsk};
use super::reading::{Reading, Text};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

/// A body.
enum Body {
    Nothing,
    /// JSON of a type of this name.
    Json(&'static str),
    /// Something else.
    Other(&'static str),
}

/// A route: what it is for, what it takes and what it gives.
struct Route {
    method: &'static str,
    path: &'static str,
    summary: &'static str,
    takes: Body,
    status: u16,
    gives: Body,
}

const fn get(path: &'static str, gives: Body, summary: &'static str) -> Route {
    Route { method: "get", path, summary, takes: Body::Nothing, status: 200, gives }
}

const fn post(path: &'static str, takes: Body, gives: Body, summary: &'static str) -> Route {
    Route { method: "post", path, summary, takes, status: 200, gives }
}

const ROUTES: [Route; 20] = [
    get(
        "/",
        Body::Other("text/html"),
        "The page. With `?token=..`, the token of the address that linkwright prints: the cookie (once), and the way to `/`.",
    ),
    get("/app.js", Body::Other("text/javascript"), "The page's script."),
    get("/style.css", Body::Other("text/css"), "The page's style."),
    get(
        "/live",
        Body::Other("application/json"),
        "A tab's WebSocket: `Ask` messages go in, `Answer` messages come out. Their schemas are at /schemas.json.",
    ),
    get("/schemas.json", Body::Other("application/json"), "The JSON Schemas of the WebSocket's messages."),
    get("/openapi.json", Body::Other("application/json"), "This document."),
    get(
        "/beginning.json",
        Body::Other("application/json"),
        "The `Ask` of the problem that the studio was started with, or null.",
    ),
    post(
        "/problem.toml",
        Body::Json("Ask"),
        Body::Other("application/toml"),
        "The problem file that asks the same.",
    ),
    post(
        "/linkage.toml",
        Body::Json("LinkageAsk"),
        Body::Other("application/toml"),
        "The linkage file of a linkage.",
    ),
    post(
        "/read",
        Body::Json("Text"),
        Body::Json("Reading"),
        "What to ask for a text that was pasted or dropped: a points file, a drawing or a problem file.",
    ),
    get(
        "/jobs",
        Body::Json("JobList"),
        "All jobs: those that run and all results of the folder, whoever made them.",
    ),
    Route {
        method: "post",
        path: "/jobs",
        summary: "Begins a search whose result is saved, the same to the byte as that of `linkwright synth`.",
        takes: Body::Json("JobAsk"),
        status: 201,
        gives: Body::Json("JobShown"),
    },
    get("/jobs/{name}", Body::Json("JobShown"), "One job as it stands now."),
    Route {
        method: "post",
        path: "/jobs/{name}/cancel",
        summary: "Stops a job: its threads end at once, its best so far is saved.",
        takes: Body::Nothing,
        status: 202,
        gives: Body::Other("text/plain"),
    },
    Route {
        method: "post",
        path: "/jobs/{name}/resume",
        summary: "Takes up a job that was stopped or broken off, from its checkpoint where there is one.",
        takes: Body::Nothing,
        status: 202,
        gives: Body::Json("JobShown"),
    },
    get(
        "/jobs/{name}/opened",
        Body::Json("Opened"),
        "A saved result: its problem as a tab asks it, its candidates.",
    ),
    get(
        "/jobs/{name}/files/{file}",
        Body::Other("application/octet-stream"),
        "A file of a saved result, such as record.json, as it is on the disk.",
    ),
    post(
        "/details",
        Body::Json("DetailsAsk"),
        Body::Json("Details"),
        "Everything that the report says of a linkage.",
    ),
    post(
        "/export",
        Body::Json("ExportAsk"),
        Body::Other("application/octet-stream"),
        "A linkage as a file, as `linkwright export` and `linkwright report` write it.",
    ),
    post(
        "/compare",
        Body::Json("CompareAsk"),
        Body::Other("application/json"),
        "Linkages side by side, as `linkwright compare` puts them.",
    ),
];

/// Why requests are refused, with the status of the answer; the reason stands in its text.
const REFUSALS: [(u16, &str); 11] = [
    (400, "It cannot be read as HTTP, or asks for an upgrade where there is none."),
    (403, "Without the cookie, or from another origin."),
    (404, "There is no such job or file."),
    (408, "It took too long."),
    (409, "The name is taken, or the job is not in a state for it."),
    (413, "The body is larger than 256 KiB."),
    (421, "Another host's name."),
    (422, "The body is not what is asked for."),
    (429, "Too many requests: wait a second."),
    (500, "A bug of linkwright's."),
    (503, "Too much is going on: as many jobs run, or tabs are open, as may."),
];

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/components/schemas/{name}") })
}

fn content(body: &Body) -> Option<Value> {
    match body {
        Body::Nothing => None,
        Body::Json(name) => Some(json!({ "application/json": { "schema": reference(name) } })),
        Body::Other(kind) => Some(json!({ *kind: {} })),
    }
}

impl Route {
    fn operation(&self) -> Value {
        let names = self.path.split('/').filter_map(|part| part.strip_prefix('{')?.strip_suffix('}'));
        let parameters: Vec<Value> = names
            .map(|name| json!({ "name": name, "in": "path", "required": true, "schema": { "type": "string" } }))
            .collect();
        let mut good = Map::new();
        good.insert("description".into(), "Done.".into());
        good.extend(content(&self.gives).map(|content| ("content".to_owned(), content)));
        let mut responses = Map::new();
        responses.insert(self.status.to_string(), Value::Object(good));
        responses.insert("default".into(), json!({ "$ref": "#/components/responses/Refused" }));
        let mut operation = Map::new();
        operation.insert("summary".into(), self.summary.into());
        if !parameters.is_empty() {
            operation.insert("parameters".into(), parameters.into());
        }
        let takes = content(&self.takes).map(|content| json!({ "required": true, "content": content }));
        operation.extend(takes.map(|takes| ("requestBody".to_owned(), takes)));
        operation.insert("responses".into(), responses.into());
        Value::Object(operation)
    }
}

fn note<T: JsonSchema>(generator: &mut SchemaGenerator) {
    generator.subschema_for::<T>();
}

/// The OpenAPI document.
pub fn document() -> Value {
    let mut settings = SchemaSettings::draft2020_12();
    settings.definitions_path = "/components/schemas".into();
    settings.meta_schema = None;
    let mut generator = settings.into_generator();
    note::<Ask>(&mut generator);
    note::<LinkageAsk>(&mut generator);
    note::<Text>(&mut generator);
    note::<Reading>(&mut generator);
    note::<JobAsk>(&mut generator);
    note::<JobList>(&mut generator);
    note::<JobShown>(&mut generator);
    note::<Opened>(&mut generator);
    note::<DetailsAsk>(&mut generator);
    note::<Details>(&mut generator);
    note::<ExportAsk>(&mut generator);
    note::<CompareAsk>(&mut generator);
    let schemas = generator.take_definitions(true);
    let mut paths = Map::new();
    for route in &ROUTES {
        let path = paths.entry(route.path).or_insert_with(|| json!({}));
        path[route.method] = route.operation();
    }
    let refusals: Vec<String> = REFUSALS.iter().map(|(status, why)| format!("{status}: {why}")).collect();
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "linkwright studio",
            "version": env!("CARGO_PKG_VERSION"),
            "description": "What `linkwright studio` answers on 127.0.0.1: see docs/studio-interface.md. Requests carry \
                            the cookie of the page; those that are not GET, and the WebSocket, also its Origin.",
        },
        "paths": paths,
        "components": {
            "schemas": schemas,
            "responses": {
                "Refused": {
                    "description": refusals.join("\n"),
                    "content": { "text/plain": { "schema": { "type": "string" } } },
                },
            },
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// `path method` of every route in the sources of the server.
    fn routed() -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for source in [include_str!("server.rs"), include_str!("api.rs")] {
            let code = source.split("#[cfg(test)]").next().unwrap_or(source);
            for part in code.split(".route(").skip(1) {
                let mut words = part.splitn(3, '"');
                let path = match words.nth(1) {
                    Some(path) if part.starts_with('"') => path,
                    _ if part.starts_with("LIVE") => crate::app::studio::server::LIVE,
                    _ => panic!("a route without a path: {}", &part[..40]),
                };
                let line = part.split(".route(").next().unwrap_or(part).lines().next().unwrap_or("");
                for method in ["get", "post", "put", "delete", "patch"] {
                    if line.contains(&format!(" {method}(")) || line.contains(&format!(".{method}(")) {
                        found.insert(format!("{path} {method}"));
                    }
                }
            }
        }
        found
    }

    #[test]
    fn the_document_has_every_route_of_the_server_and_no_other() {
        let document = document();
        let mut documented = BTreeSet::new();
        for (path, methods) in document["paths"].as_object().expect("paths") {
            documented.extend(methods.as_object().expect("methods").keys().map(|m| format!("{path} {m}")));
        }
        assert!(documented.len() == ROUTES.len() && documented.contains("/jobs post"));
        assert_eq!(documented, routed());
    }

    #[test]
    fn every_reference_leads_to_a_schema() {
        fn references(value: &Value, found: &mut BTreeSet<String>) {
            match value {
                Value::Object(object) => {
                    if let Some(Value::String(to)) = object.get("$ref") {
                        found.insert(to.clone());
                    }
                    object.values().for_each(|value| references(value, found));
                }
                Value::Array(list) => list.iter().for_each(|value| references(value, found)),
                _ => {}
            }
        }
        let document = document();
        let mut found = BTreeSet::new();
        references(&document, &mut found);
        assert!(found.len() > 10);
        for to in found {
            let pointer = to.strip_prefix('#').expect("inside the document");
            assert!(document.pointer(pointer).is_some(), "{to}");
        }
    }
}
