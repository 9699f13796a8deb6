//! What all requests share, and the answers that they have in common.

use super::guard::Guard;
use super::jobs::Jobs;
use super::tab::Searches;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use std::fmt::Display;
use std::sync::Arc;
use tokio::sync::{Semaphore, watch};

/// What all requests share.
pub(super) struct House {
    pub(super) guard: Arc<Guard>,
    /// What the page begins with, as JSON; `null`: with what it remembers.
    pub(super) beginning: String,
    pub(super) searches: Arc<Searches>,
    pub(super) jobs: Arc<Jobs>,
    /// Places for requests that take work.
    pub(super) work: Arc<Semaphore>,
    pub(super) tabs: Arc<Semaphore>,
    pub(super) closing: watch::Sender<bool>,
}

pub(super) fn json(text: String) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], text).into_response()
}

pub(super) fn refused(why: impl Display) -> Response {
    (StatusCode::UNPROCESSABLE_ENTITY, format!("{why}\n")).into_response()
}
