//! The OpenAPI 3.1 description of the requests that are answered over HTTP.
//!
//! It is made from the [routes](super::routes) and the types that they read and write. The WebSocket's messages are
//! described by their JSON Schemas alone ([`schemas`](super::messages::schemas)).

use super::routes::{Body, Route, routes};
use schemars::SchemaGenerator;
use schemars::generate::SchemaSettings;
use serde_json::{Value, json};

/// The statuses of refusals with their reasons.
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
        Body::Other(kind) => Some(json!({ kind.split(';').next().unwrap_or(kind): {} })),
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
            "responses": { self.status.as_str(): good, "default": refused },
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
    for route in routes() {
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
