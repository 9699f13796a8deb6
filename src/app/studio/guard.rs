//! Admits requests: those that name this host, from its own pages and from browsers that were let in with the token.

use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::header::{self, HeaderMap, HeaderName, HeaderValue};
use axum::http::{Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The requests a second that are answered in the long run, of browsers with the cookie and of strangers each.
const RATE: f64 = 100.0;
/// The requests that are answered at once after a pause.
const BURST: f64 = 300.0;
/// The longest time that a request may take, its body included.
const PATIENCE: Duration = Duration::from_secs(10);

/// The path of a tab's WebSocket.
pub(super) const LIVE: &str = "/live";
/// The largest body and the largest message, bytes.
pub(super) const MOST_BYTES: usize = 256 * 1024;

/// The secrets and the limits that admit requests.
pub(super) struct Guard {
    pub(super) port: u16,
    /// The token of the address that was printed last; taken by the first who brings it.
    token: Mutex<Option<String>>,
    /// The value of the cookie.
    secret: String,
    known: Bucket,
    /// Apart, so that no page of another origin uses up what ours needs.
    strangers: Bucket,
}

/// The number of requests that would be answered now, and the time of that count.
struct Bucket(Mutex<(f64, Instant)>);

impl Bucket {
    fn new() -> Self {
        Bucket(Mutex::new((BURST, Instant::now())))
    }

    /// Returns whether there is room for one more request now, and takes it.
    fn has_room(&self) -> bool {
        let mut bucket = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let filled = bucket.0 + RATE * now.duration_since(bucket.1).as_secs_f64();
        *bucket = (filled.min(BURST), now);
        let room = bucket.0 >= 1.0;
        if room {
            bucket.0 -= 1.0;
        }
        room
    }
}

/// Returns 256 random bits as hexadecimal digits.
fn random() -> Result<String, getrandom::Error> {
    let mut bytes = [0u8; 32];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.map(|byte| format!("{byte:02x}")).concat())
}

/// Returns whether two secrets are equal, in a time that does not depend on where they differ.
fn same(one: &str, other: &str) -> bool {
    one.len() == other.len() && one.bytes().zip(other.bytes()).fold(0, |apart, (x, y)| apart | (x ^ y)) == 0
}

impl Guard {
    pub(super) fn new(port: u16) -> Result<Self, getrandom::Error> {
        Ok(Guard {
            port,
            token: Mutex::new(Some(random()?)),
            secret: random()?,
            known: Bucket::new(),
            strangers: Bucket::new(),
        })
    }

    /// Returns the token if it has not been used yet.
    pub(super) fn token(&self) -> Option<String> {
        self.token.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Puts a token that nobody knows in the place of the one before, used or not, and returns it.
    pub(super) fn renewed_token(&self) -> Result<String, getrandom::Error> {
        let token = random()?;
        *self.token.lock().unwrap_or_else(PoisonError::into_inner) = Some(token.clone());
        Ok(token)
    }

    /// Takes the token: true once.
    pub(super) fn admits(&self, token: &str) -> bool {
        let mut kept = self.token.lock().unwrap_or_else(PoisonError::into_inner);
        let right = kept.as_deref().is_some_and(|kept| same(kept, token));
        if right {
            *kept = None;
        }
        right
    }

    /// Returns the cookie for a browser that brought the token. Cookies hold for all ports, so its name holds the port.
    pub(super) fn cookie(&self) -> String {
        format!("{}={}; HttpOnly; SameSite=Strict; Path=/", self.cookie_name(), self.secret)
    }

    fn cookie_name(&self) -> String {
        format!("linkwright-studio-{}", self.port)
    }

    /// Returns whether a request brings the cookie.
    pub(super) fn knows(&self, headers: &HeaderMap) -> bool {
        let name = self.cookie_name();
        headers
            .get_all(header::COOKIE)
            .iter()
            .filter_map(|value| value.to_str().ok())
            .flat_map(|value| value.split(';'))
            .filter_map(|pair| pair.trim().split_once('='))
            .any(|(key, value)| key == name && same(value, &self.secret))
    }

    /// Returns whether a request names this host: a page under another name that leads here names that one.
    fn is_for_us(&self, headers: &HeaderMap) -> bool {
        let mut hosts = headers.get_all(header::HOST).iter();
        let host = hosts.next().and_then(|host| host.to_str().ok());
        hosts.next().is_none()
            && host.is_some_and(|host| {
                host == format!("127.0.0.1:{}", self.port)
                    || host.eq_ignore_ascii_case(&format!("localhost:{}", self.port))
            })
    }

    /// Returns whether a request comes from our page alone; `needed`: whether it must say so.
    fn is_from_us(&self, headers: &HeaderMap, needed: bool) -> bool {
        let text = |value: &HeaderValue| value.to_str().map(str::to_ascii_lowercase).ok();
        let ours = headers.get(header::HOST).and_then(text).map(|host| format!("http://{host}"));
        let mut origins = headers.get_all(header::ORIGIN).iter().peekable();
        (origins.peek().is_some() || !needed) && origins.all(|origin| ours.is_some() && text(origin) == ours)
    }

    /// Returns the refusal of a request before anything is done for it.
    fn refusal(&self, request: &Request) -> Option<(StatusCode, &'static str)> {
        let headers = request.headers();
        let live = request.uri().path() == LIVE;
        let bucket = if self.knows(headers) { &self.known } else { &self.strangers };
        if headers.contains_key(header::UPGRADE) && !live {
            Some((StatusCode::BAD_REQUEST, "there is nothing to upgrade here\n"))
        } else if !self.is_for_us(headers) {
            Some((StatusCode::MISDIRECTED_REQUEST, "the studio answers to 127.0.0.1 alone\n"))
        } else if !self.is_from_us(headers, live || request.method() != Method::GET) {
            Some((StatusCode::FORBIDDEN, "only the studio's own page may ask\n"))
        } else if announced(headers) > MOST_BYTES as u64 {
            Some((StatusCode::PAYLOAD_TOO_LARGE, "this is more than the studio reads\n"))
        } else if !bucket.has_room() {
            Some((StatusCode::TOO_MANY_REQUESTS, "too many requests: wait a second\n"))
        } else {
            None
        }
    }
}

/// Returns the announced length of a body; one without is limited as it is read.
fn announced(headers: &HeaderMap) -> u64 {
    let length = headers.get(header::CONTENT_LENGTH).and_then(|value| value.to_str().ok());
    length.and_then(|text| text.parse().ok()).unwrap_or(0)
}

/// Adds the headers that every answer has.
fn with_headers(mut response: Response<Body>) -> Response<Body> {
    let policy = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; \
                  base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    for (name, value) in [
        ("content-security-policy", policy),
        ("cache-control", "no-store"),
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
    ] {
        response.headers_mut().insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
    response
}

/// Refuses or passes on every request, and limits its time.
pub(super) async fn guarded(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response<Body> {
    if let Some(refusal) = guard.refusal(&request) {
        // Whoever is refused makes room for others.
        let mut response = with_headers(refusal.into_response());
        response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
        return response;
    }
    let answer = tokio::time::timeout(PATIENCE, next.run(request)).await;
    let late = || (StatusCode::REQUEST_TIMEOUT, "this took too long\n").into_response();
    with_headers(answer.unwrap_or_else(|_| late()))
}
