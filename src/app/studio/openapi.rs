//! The interface described: routes here, bodies by the types that are read and written.
//!
//! OpenAPI 3.1 describes what is asked over HTTP; the WebSocket's messages are described by their JSON Schemas alone
//! ([`schemas`](super::messages::schemas)). A test compares the paths here with the routes of the server.

use super::details::{CompareAsk, Details, DetailsAsk, ExportAsk};
use super::job_messages::{JobAsk, JobList, JobShown, Opened};
use super::messages::{Ask, LinkageAsk, Reading, Text};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Value, json};

/// A body.
enum Body {
    Nothing,
    /// JSON of a type, whose schema this notes and refers to.
    Json(fn(&mut SchemaGenerator) -> Schema),
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

const fn json<T: JsonSchema>() -> Body {
    Body::Json(|generator| generator.subschema_for::<T>())
}

impl Route {
    /// The route with another status of success than 200.
    const fn giving(self, status: u16) -> Route {
        Route { status, ..self }
    }
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
        json::<Ask>(),
        Body::Other("application/toml"),
        "The problem file that asks the same.",
    ),
    post(
        "/linkage.toml",
        json::<LinkageAsk>(),
        Body::Other("application/toml"),
        "The linkage file of a linkage.",
    ),
    post(
        "/read",
        json::<Text>(),
        json::<Reading>(),
        "What to ask for a text that was pasted or dropped: a points file, a drawing or a problem file.",
    ),
    get(
        "/jobs",
        json::<JobList>(),
        "All jobs: those that run and all results of the folder, whoever made them.",
    ),
    post(
        "/jobs",
        json::<JobAsk>(),
        json::<JobShown>(),
        "Begins a search whose result is saved, the same to the byte as that of `linkwright synth`.",
    )
    .giving(201),
    get("/jobs/{name}", json::<JobShown>(), "One job as it stands now."),
    post(
        "/jobs/{name}/cancel",
        Body::Nothing,
        Body::Other("text/plain"),
        "Stops a job: its threads end at once, its best so far is saved.",
    )
    .giving(202),
    post(
        "/jobs/{name}/resume",
        Body::Nothing,
        json::<JobShown>(),
        "Takes up a job that was stopped or broken off, from its checkpoint where there is one.",
    )
    .giving(202),
    get(
        "/jobs/{name}/opened",
        json::<Opened>(),
        "A saved result: its problem as a tab asks it, its candidates.",
    ),
    get(
        "/jobs/{name}/files/{file}",
        Body::Other("application/octet-stream"),
        "A file of a saved result, such as record.json, as it is on the disk.",
    ),
    post(
        "/details",
        json::<DetailsAsk>(),
        json::<Details>(),
        "Everything that the report says of a linkage.",
    ),
    post(
        "/export",
        json::<ExportAsk>(),
        Body::Other("application/octet-stream"),
        "A linkage as a file, as `linkwright export` and `linkwright report` write it.",
    ),
    post(
        "/compare",
        json::<CompareAsk>(),
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

fn content(body: &Body, generator: &mut SchemaGenerator) -> Option<Value> {
    match body {
        Body::Nothing => None,
        Body::Json(schema) => Some(json!({ "application/json": { "schema": schema(generator) } })),
        Body::Other(kind) => Some(json!({ *kind: {} })),
    }
}

impl Route {
    fn operation(&self, generator: &mut SchemaGenerator) -> Value {
        let names = self.path.split('/').filter_map(|part| part.strip_prefix('{')?.strip_suffix('}'));
        let parameters: Vec<Value> = names
            .map(|name| json!({ "name": name, "in": "path", "required": true, "schema": { "type": "string" } }))
            .collect();
        let mut good = json!({ "description": "Done." });
        if let Some(content) = content(&self.gives, generator) {
            good["content"] = content;
        }
        let refused = json!({ "$ref": "#/components/responses/Refused" });
        let mut operation = json!({
            "summary": self.summary,
            "responses": { self.status.to_string(): good, "default": refused },
        });
        if !parameters.is_empty() {
            operation["parameters"] = parameters.into();
        }
        if let Some(content) = content(&self.takes, generator) {
            operation["requestBody"] = json!({ "required": true, "content": content });
        }
        operation
    }
}

/// The OpenAPI document.
pub fn document() -> Value {
    let mut settings = SchemaSettings::draft2020_12();
    settings.definitions_path = "/components/schemas".into();
    settings.meta_schema = None;
    let mut generator = settings.into_generator();
    let mut paths = json!({});
    for route in &ROUTES {
        paths[route.path][route.method] = route.operation(&mut generator);
    }
    let schemas = generator.take_definitions(true);
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
                    _ if part.starts_with("LIVE") => crate::app::studio::guard::LIVE,
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
