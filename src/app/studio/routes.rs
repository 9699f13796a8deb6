//! The requests that the studio answers: a table of routes, each with its description and its answer.
//!
//! [`openapi`](super::openapi) describes the table, [`server`](super::server) serves it. Work that may take a while is
//! done on threads of its own, few at once.

use super::details::{CompareAsk, DetailsAsk, ExportAsk, Handed, JudgeAsk};
use super::guard::LIVE;
use super::house::{Answered, House, Refused, content};
use super::job_messages::{JobAsk, JobShown, Opened};
use super::jobs::Refusal;
use super::loads::LoadsAsk;
use super::messages::{Ask, LinkageAsk, Text, schemas};
use super::openapi::document;
use super::reading;
use super::server::{live, page};
use super::tab::BUG;
use crate::files::{linkage_file, name};
use crate::mechanism::CrankLinkage;
use crate::report::compare::Comparison;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::middleware::map_response;
use axum::response::{IntoResponse, Response};
use axum::routing::{MethodRouter, get, post};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// The most requests that are worked on at once; more wait, and not for long.
pub(super) const AT_ONCE: usize = 2;

/// The refusal of a body that is not what is asked for.
const UNREADABLE: &str = "this cannot be read";
const JSON: &str = "application/json";
const TOML: &str = "application/toml; charset=utf-8";
const JS: &str = "text/javascript; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const HTML: &str = "text/html; charset=utf-8";

/// The body of a request or of an answer, as it is described.
pub(super) enum Body {
    Nothing,
    /// JSON of a type, whose schema the function notes and refers to.
    Json(fn(&mut SchemaGenerator) -> Schema),
    /// Another media type.
    Other(&'static str),
}

/// A route with its description.
pub(super) struct Route {
    pub(super) method: &'static str,
    pub(super) path: &'static str,
    pub(super) summary: &'static str,
    pub(super) takes: Body,
    /// The status of success.
    pub(super) status: StatusCode,
    pub(super) gives: Body,
    pub(super) handler: MethodRouter<Arc<House>>,
}

impl Route {
    fn new(
        method: &'static str,
        path: &'static str,
        gives: Body,
        handler: MethodRouter<Arc<House>>,
    ) -> Route {
        let (takes, status) = (Body::Nothing, StatusCode::OK);
        Route { method, path, summary: "", takes, status, gives, handler }
    }

    /// Creates a request with names in its path and without a body.
    fn named<N: DeserializeOwned + Send + 'static, A: Answer + 'static>(
        method: &'static str,
        path: &'static str,
        answer: fn(&House, N) -> Answered<A>,
    ) -> Route {
        let handler = move |State(house), Path(names)| worked(house, move |house| answer(house, names));
        Route::new(method, path, A::BODY, if method == "get" { get(handler) } else { post(handler) })
    }

    /// Creates a `POST` of a message in JSON; another body is refused with `otherwise`.
    fn asked<M: DeserializeOwned + JsonSchema + 'static, A: Answer + 'static>(
        path: &'static str,
        otherwise: &'static str,
        answer: fn(&House, M) -> Answered<A>,
    ) -> Route {
        let read = move |body: Bytes| {
            let refused = |e| Refused(StatusCode::UNPROCESSABLE_ENTITY, format!("{otherwise}: {e}"));
            serde_json::from_slice(&body).map_err(refused)
        };
        let handler = move |State(house), body| worked(house, move |house| answer(house, read(body)?));
        let takes = Body::Json(SchemaGenerator::subschema_for::<M>);
        Route { takes, ..Route::new("post", path, A::BODY, post(handler)) }
    }

    /// Returns the route with a summary.
    fn summed_up(self, summary: &'static str) -> Route {
        Route { summary, ..self }
    }

    /// Returns the route with another media type of its answer.
    fn giving(self, media_type: &'static str) -> Route {
        Route { gives: Body::Other(media_type), ..self }
    }

    /// Returns the route with JSON of another type as its answer.
    fn giving_json(self, schema: fn(&mut SchemaGenerator) -> Schema) -> Route {
        Route { gives: Body::Json(schema), ..self }
    }

    /// Returns the route with another status of success than 200.
    fn with(self, status: StatusCode) -> Route {
        let set = move |answer: Response| async move {
            if answer.status() == StatusCode::OK { (status, answer).into_response() } else { answer }
        };
        Route { status, handler: self.handler.layer(map_response(set)), ..self }
    }
}

/// An answer with the description of its body.
trait Answer {
    const BODY: Body;
    fn response(self) -> Answered<Response>;
}

impl<T: Serialize + JsonSchema> Answer for T {
    const BODY: Body = Body::Json(SchemaGenerator::subschema_for::<T>);

    fn response(self) -> Answered<Response> {
        match serde_json::to_string(&self) {
            Ok(text) => Ok(content(JSON, text)),
            Err(e) => Err(Refused(StatusCode::INTERNAL_SERVER_ERROR, e.to_string())),
        }
    }
}

impl Answer for Handed {
    const BODY: Body = Body::Other("application/octet-stream");

    fn response(self) -> Answered<Response> {
        // A file is saved, so that nothing in it is shown or run as a part of the studio.
        let name = format!("attachment; filename=\"linkage.{}\"", self.ending);
        let head = Some([(header::CONTENT_DISPOSITION, name)]).filter(|_| self.saved);
        Ok((head, content(self.media_type(), self.bytes)).into_response())
    }
}

/// Returns all routes.
pub(super) fn routes() -> Vec<Route> {
    [routes_of_the_page(), routes_of_jobs(), routes_of_linkages()].into_iter().flatten().collect()
}

fn routes_of_the_page() -> Vec<Route> {
    let plain = |path, kind, handler| Route::new("get", path, Body::Other(kind), handler);
    let beginning = async |State(house): State<Arc<House>>| content(JSON, house.beginning.clone());
    vec![
        plain("/", HTML, get(page)).summed_up(
            "The page. With `?token=..`, the token of the address that linkwright prints: the cookie (once), and the \
             way to `/`.",
        ),
        plain("/app.js", JS, get(async || content(JS, include_str!("page/app.js"))))
            .summed_up("The page's script."),
        plain("/style.css", CSS, get(async || content(CSS, include_str!("page/style.css"))))
            .summed_up("The page's style."),
        plain("/more.js", JS, get(async || content(JS, include_str!("page/more.js"))))
            .summed_up("A second script, loaded when it is first needed: motions, functions, building."),
        plain("/more.css", CSS, get(async || content(CSS, include_str!("page/more.css"))))
            .summed_up("The style of what the second script adds."),
        plain(LIVE, JSON, get(live)).summed_up(
            "A tab's WebSocket: `Ask` messages go in, `Answer` messages come out. Their schemas are at /schemas.json.",
        ),
        plain("/schemas.json", JSON, get(async || schemas().response()))
            .summed_up("The JSON Schemas of the WebSocket's messages."),
        plain("/openapi.json", JSON, get(async || document().response())).summed_up("This document."),
        plain("/beginning.json", JSON, get(beginning))
            .summed_up("The `Ask` of the problem that the studio was started with, or null."),
        Route::asked("/problem.toml", "this is no edit", |_, ask: Ask| Ok(Handed::shown("toml", ask.problem_with_text()?.1)))
            .giving(TOML)
            .summed_up("The problem file that asks the same."),
        Route::asked("/linkage.toml", "this is no linkage", |_, ask: LinkageAsk| {
            name::check(&ask.name)?;
            let linkage = CrankLinkage::try_from(ask.linkage)?;
            Ok(Handed::shown("toml", linkage_file::any_to_toml(&ask.name, ask.unit, &linkage)))
        })
        .giving(TOML)
        .summed_up("The linkage file of a linkage."),
        Route::asked("/read", "this is no text with its kind", |_, text: Text| Ok(reading::read(&text)?)).summed_up(
            "What to ask for a text that was pasted or dropped: a points file, a drawing or a problem file.",
        ),
    ]
}

fn routes_of_jobs() -> Vec<Route> {
    vec![
        Route::named("get", "/jobs", |house, ()| Ok(house.jobs.list()))
            .summed_up("All jobs: those that run and all results of the folder, whoever made them."),
        Route::asked("/jobs", UNREADABLE, |house, ask: JobAsk| job(house, &house.jobs.start(&ask)?))
            .with(StatusCode::CREATED)
            .summed_up(
                "Begins a search whose result is saved, the same to the byte as that of `linkwright synth`.",
            ),
        Route::named("get", "/jobs/{name}", |house, name: String| job(house, &name))
            .summed_up("One job as it stands now."),
        Route::new("post", "/jobs/{name}/cancel", Body::Other("text/plain"), post(cancel))
            .with(StatusCode::ACCEPTED)
            .summed_up("Stops a job: its threads end at once, its best so far is saved."),
        Route::named("post", "/jobs/{name}/resume", |house, name: String| {
            house.jobs.resume(&name)?;
            job(house, &name)
        })
        .with(StatusCode::ACCEPTED)
        .summed_up("Takes up a job that was stopped or broken off, from its checkpoint where there is one."),
        Route::named("get", "/jobs/{name}/opened", |house, name: String| {
            let shelf = &house.jobs.shelf;
            Ok(Opened::new(shelf.record(&name)?, shelf.files(&name)))
        })
        .summed_up("A saved result: its problem as a tab asks it, its candidates."),
        Route::named("get", "/jobs/{name}/files/{file}", |house, (name, file): (String, String)| {
            let absent = || format!("there is no file {file} of a result named {name}");
            let bytes = house.jobs.shelf.file(&name, &file);
            Ok(Handed::named(&file, bytes.ok_or_else(|| Refused(StatusCode::NOT_FOUND, absent()))?))
        })
        .summed_up("A file of a saved result, such as record.json, as it is on the disk."),
    ]
}

fn routes_of_linkages() -> Vec<Route> {
    vec![
        Route::asked("/details", UNREADABLE, |house, ask: DetailsAsk| Ok(house.details(&ask)?))
            .summed_up("Everything that the report says of a linkage."),
        Route::asked("/judged", UNREADABLE, |house, ask: JudgeAsk| Ok(house.judged(&ask)?)).summed_up(
            "A linkage that was changed by hand: how near it comes to the target, and what it lacks.",
        ),
        Route::asked("/export", UNREADABLE, |house, ask: ExportAsk| Ok(house.file(&ask)?))
            .summed_up("A linkage as a file, as `linkwright export` and `linkwright report` write it."),
        Route::asked("/loads", UNREADABLE, |house, ask: LoadsAsk| Ok(house.loaded(&ask)?))
            .summed_up("The torque that turns a linkage with a weight at P and springs."),
        Route::asked("/compare", UNREADABLE, |house, ask: CompareAsk| Ok(house.compared(&ask)?))
            .giving_json(Comparison::schema)
            .summed_up("Linkages side by side, as `linkwright compare` puts them."),
    ]
}

/// Does work that takes a while on a thread of its own.
async fn worked<A: Answer>(
    house: Arc<House>,
    work: impl FnOnce(&House) -> Answered<A> + Send + 'static,
) -> Answered<Response> {
    let closing = |_| Refused(StatusCode::SERVICE_UNAVAILABLE, "the studio is closing".into());
    let place = Arc::clone(&house.work).acquire_owned().await.map_err(closing)?;
    let done = tokio::task::spawn_blocking(move || {
        // Held until the work is done, even if nobody waits for it any more.
        let _place = place;
        work(&house)?.response()
    });
    done.await.unwrap_or_else(|_| Err(Refused(StatusCode::INTERNAL_SERVER_ERROR, BUG.into())))
}

/// Returns a job as it stands now.
fn job(house: &House, name: &str) -> Answered<JobShown> {
    Ok(house.jobs.one(name).ok_or_else(|| Refusal::Absent(name.to_owned()))?)
}

/// Stops a job. It needs no place among those who work: a search must be stopped at once whatever else is asked.
async fn cancel(State(house): State<Arc<House>>, Path(name): Path<String>) -> Answered<&'static str> {
    house.jobs.cancel(&name)?;
    Ok("stopping\n")
}
