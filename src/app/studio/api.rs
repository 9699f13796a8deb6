//! What other programs may ask for over HTTP beside the page: jobs, details, files, comparisons. Each request is read
//! and checked here and answered by the room that knows; the work is done on threads of its own, few at once.

use super::details::{CompareAsk, DetailsAsk, ExportAsk, Handed, Sources};
use super::house::{House, json, refused};
use super::job_messages::{JobAsk, Opened};
use super::jobs::Refusal;
use super::messages::{Ask, Shown};
use super::openapi::document;
use super::shelf::ShelfError;
use crate::files::problem_file::ProblemFile;
use crate::record::Record;
use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Display;
use std::sync::Arc;

/// Requests that are worked on at once; more wait, and not for long.
pub(super) const AT_ONCE: usize = 2;

pub(super) fn routes() -> Router<Arc<House>> {
    Router::new()
        .route("/openapi.json", get(|| async { json(document().to_string()) }))
        .route("/jobs", get(list).post(start))
        .route("/jobs/{name}", get(one))
        .route("/jobs/{name}/cancel", post(cancel))
        .route("/jobs/{name}/resume", post(resume))
        .route("/jobs/{name}/opened", get(opened))
        .route("/jobs/{name}/files/{file}", get(file))
        .route("/details", post(details))
        .route("/export", post(export))
        .route("/compare", post(compare))
}

/// Does work that takes a while on a thread of its own.
async fn worked(house: Arc<House>, work: impl FnOnce(&House) -> Response + Send + 'static) -> Response {
    let Ok(place) = Arc::clone(&house.work).acquire_owned().await else {
        return (StatusCode::SERVICE_UNAVAILABLE, "the studio is closing\n").into_response();
    };
    let done = tokio::task::spawn_blocking(move || {
        // Held until the work is done, even where nobody waits for it any more.
        let _place = place;
        work(&house)
    });
    done.await.unwrap_or_else(|_| {
        let why = "this is a bug of linkwright: please report it\n";
        (StatusCode::INTERNAL_SERVER_ERROR, why).into_response()
    })
}

fn written(what: &impl Serialize) -> Response {
    match serde_json::to_string(what) {
        Ok(text) => json(text),
        Err(e) => (StatusCode::INTERNAL_SERVER_ERROR, format!("{e}\n")).into_response(),
    }
}

/// Answers what the body of a request asks.
async fn asked<T: DeserializeOwned>(
    house: Arc<House>,
    body: Bytes,
    answer: impl FnOnce(&House, T) -> Response + Send + 'static,
) -> Response {
    worked(house, move |house| match serde_json::from_slice(&body) {
        Err(e) => refused(format!("this cannot be read: {e}")),
        Ok(ask) => answer(house, ask),
    })
    .await
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let status = match self {
            Refusal::Absent(_) | Refusal::NotRunning(_) | Refusal::Name(_) => StatusCode::NOT_FOUND,
            Refusal::Taken(_)
            | Refusal::OtherResult { .. }
            | Refusal::Unreadable(_)
            | Refusal::Running(_)
            | Refusal::InUse(_) => StatusCode::CONFLICT,
            Refusal::Ask(_) => StatusCode::UNPROCESSABLE_ENTITY,
            Refusal::Closing | Refusal::TooMany | Refusal::NotBegun(_) => StatusCode::SERVICE_UNAVAILABLE,
        };
        (status, format!("{self}\n")).into_response()
    }
}

fn no_such(why: impl Display) -> Response {
    (StatusCode::NOT_FOUND, format!("{why}\n")).into_response()
}

/// A file, to be saved: nothing that stands in it is shown or run as a part of the studio.
fn handed(file: Handed) -> Response {
    let name = format!("attachment; filename=\"linkage.{}\"", file.ending);
    let mut response = ([(header::CONTENT_TYPE, file.media_type())], file.bytes).into_response();
    if let Ok(value) = HeaderValue::from_str(&name) {
        response.headers_mut().insert(header::CONTENT_DISPOSITION, value);
    }
    response
}

async fn list(State(house): State<Arc<House>>) -> Response {
    worked(house, |house| written(&house.jobs.list())).await
}

/// One job, as it stands now.
fn told(house: &House, name: &str, status: StatusCode) -> Response {
    match house.jobs.one(name) {
        Some(job) => (status, written(&job)).into_response(),
        None => Refusal::Absent(name.to_owned()).into_response(),
    }
}

async fn one(State(house): State<Arc<House>>, Path(name): Path<String>) -> Response {
    worked(house, move |house| told(house, &name, StatusCode::OK)).await
}

async fn start(State(house): State<Arc<House>>, body: Bytes) -> Response {
    asked(house, body, |house, ask: JobAsk| match house.jobs.start(&ask) {
        Ok(name) => told(house, &name, StatusCode::CREATED),
        Err(refusal) => refusal.into_response(),
    })
    .await
}

/// Needs no place among those who work: a search must be stopped at once whatever else is asked.
async fn cancel(State(house): State<Arc<House>>, Path(name): Path<String>) -> Response {
    match house.jobs.cancel(&name) {
        Ok(()) => (StatusCode::ACCEPTED, "stopping\n").into_response(),
        Err(refusal) => refusal.into_response(),
    }
}

async fn resume(State(house): State<Arc<House>>, Path(name): Path<String>) -> Response {
    worked(house, move |house| match house.jobs.resume(&name) {
        Ok(()) => told(house, &name, StatusCode::ACCEPTED),
        Err(refusal) => refusal.into_response(),
    })
    .await
}

async fn opened(State(house): State<Arc<House>>, Path(name): Path<String>) -> Response {
    worked(house, move |house| {
        let shelf = house.jobs.shelf();
        match shelf.record(&name) {
            Err(why @ ShelfError::Absent(_)) => no_such(why),
            Err(why) => refused(why),
            Ok(record) => written(&opened_of(record, shelf.files(&name))),
        }
    })
    .await
}

fn opened_of(record: Record, files: Vec<String>) -> Opened {
    let candidates = record.candidates.iter().map(Shown::from).collect();
    let asked = record.problem;
    let (points, closed) = (asked.resolved.task.path.points.clone(), asked.resolved.task.path.closed);
    let file = ProblemFile {
        name: asked.name.clone(),
        source: asked.source,
        unit: asked.unit,
        spec: asked.resolved,
        expect: None,
        warnings: Vec::new(),
    };
    let (ask, why_not) = match Ask::of(&file) {
        Ok(ask) => (Some(ask), None),
        Err(why) => (None, Some(why.to_string())),
    };
    Opened { ask, why_not, name: asked.name, unit: asked.unit, points, closed, candidates, files }
}

async fn file(State(house): State<Arc<House>>, Path((name, file)): Path<(String, String)>) -> Response {
    worked(house, move |house| match house.jobs.shelf().file(&name, &file) {
        None => no_such(format!("there is no file {file} of a result named {name}")),
        Some(bytes) => {
            let given = file.rsplit_once('.').map_or("", |(_, ending)| ending);
            let ending = ["json", "csv", "svg", "toml", "html"].into_iter().find(|ending| *ending == given);
            handed(Handed { ending: ending.unwrap_or("bin"), bytes })
        }
    })
    .await
}

async fn details(State(house): State<Arc<House>>, body: Bytes) -> Response {
    let answer = |house: &House, ask: DetailsAsk| {
        house.sources().details(&ask).map_or_else(refused, |details| written(&details))
    };
    asked(house, body, answer).await
}

async fn export(State(house): State<Arc<House>>, body: Bytes) -> Response {
    asked(house, body, |house, ask: ExportAsk| house.sources().file(&ask).map_or_else(refused, handed)).await
}

async fn compare(State(house): State<Arc<House>>, body: Bytes) -> Response {
    asked(house, body, |house, ask: CompareAsk| match house.sources().compared(&ask) {
        Ok(Handed { ending: "json", bytes }) => json(String::from_utf8_lossy(&bytes).into_owned()),
        Ok(file) => handed(file),
        Err(why) => refused(why),
    })
    .await
}

impl House {
    /// Where linkages are looked for.
    fn sources(&self) -> Sources<'_> {
        Sources { shelf: self.jobs.shelf(), finished: self.searches.finished() }
    }
}
