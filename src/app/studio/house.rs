//! The state that all requests share, and the form of their answers.

use super::asked::AskError;
use super::details::DetailsError;
use super::guard::Guard;
use super::jobs::{Jobs, Refusal};
use super::shelf::ShelfError;
use super::tab::Searches;
use crate::files::name::NameError;
use crate::mechanism::NoLinkage;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use std::error::Error;
use std::sync::Arc;
use tokio::sync::{Semaphore, watch};

/// The state that all requests share.
pub(super) struct House {
    pub(super) guard: Arc<Guard>,
    /// The edit that the page begins with, as JSON; `null`: the page begins with the one that it remembers.
    pub(super) beginning: String,
    pub(super) searches: Arc<Searches>,
    pub(super) jobs: Arc<Jobs>,
    /// Places for requests that take work.
    pub(super) work: Arc<Semaphore>,
    pub(super) tabs: Arc<Semaphore>,
    pub(super) closing: watch::Sender<bool>,
}

/// The answer to a request, or its refusal.
pub(super) type Answered<T> = Result<T, Refused>;

/// A refusal: the status, and the reason as a line of text.
pub(super) struct Refused(pub(super) StatusCode, pub(super) String);

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        (self.0, self.1 + "\n").into_response()
    }
}

/// An error that refuses a request.
pub(super) trait Refusing: Error {
    /// Returns the status of the answer.
    fn status(&self) -> StatusCode {
        StatusCode::UNPROCESSABLE_ENTITY
    }
}

impl<E: Refusing> From<E> for Refused {
    fn from(why: E) -> Self {
        Refused(why.status(), why.to_string())
    }
}

impl Refusing for AskError {}
impl Refusing for DetailsError {}
impl Refusing for NoLinkage {}
impl Refusing for NameError {}

impl Refusing for ShelfError {
    fn status(&self) -> StatusCode {
        let absent = matches!(self, ShelfError::Absent(_));
        if absent { StatusCode::NOT_FOUND } else { StatusCode::UNPROCESSABLE_ENTITY }
    }
}

impl Refusing for Refusal {
    fn status(&self) -> StatusCode {
        match self {
            Refusal::Absent(_) | Refusal::NotRunning(_) | Refusal::Name(_) => StatusCode::NOT_FOUND,
            Refusal::Taken(_)
            | Refusal::OtherResult { .. }
            | Refusal::Unreadable(_)
            | Refusal::Running(_)
            | Refusal::InUse(_) => StatusCode::CONFLICT,
            Refusal::Ask(_) => StatusCode::UNPROCESSABLE_ENTITY,
            Refusal::Closing | Refusal::TooMany | Refusal::NotBegun(_) => StatusCode::SERVICE_UNAVAILABLE,
        }
    }
}

/// Returns an answer with its media type.
pub(super) fn content(media_type: &'static str, bytes: impl IntoResponse) -> Response {
    ([(header::CONTENT_TYPE, media_type)], bytes).into_response()
}
