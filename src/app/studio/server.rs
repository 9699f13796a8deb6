//! Serves the routes, the page and the tabs' WebSockets.

use super::connection::Limited;
use super::guard::{Guard, MOST_BYTES, guarded};
use super::house::{House, content};
use super::jobs::Jobs;
use super::messages::Ask;
use super::routes::{AT_ONCE, routes};
use super::tab::{Mailbox, Told, work};
use axum::Router;
use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{DefaultBodyLimit, Request, State};
use axum::http::{HeaderMap, StatusCode, Uri, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};
use tokio::time::{interval, sleep, timeout};

/// The most tabs at once.
const MOST_TABS: usize = 16;
/// The time after which a tab that takes no answer is closed.
const PATIENCE: Duration = Duration::from_secs(10);
/// The time between two pings of a tab.
const PING: Duration = Duration::from_secs(15);
/// The time between two looks whether the studio is to end.
const LOOK: Duration = Duration::from_millis(50);
/// The time that connections have to end.
const FAREWELL: Duration = Duration::from_secs(2);

/// The reason why there is no studio.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// The port is taken, or may not be used.
    #[error("port {port} of 127.0.0.1 cannot be used: {source}")]
    Port {
        /// The port.
        port: u16,
        /// The error of the system.
        source: io::Error,
    },
    /// The system gives no random numbers for the token.
    #[error("the system gives no random numbers for the token: {0}")]
    Random(getrandom::Error),
    /// The system gives no sockets or threads.
    #[error("the server cannot run: {0}")]
    System(#[from] io::Error),
}

/// Makes addresses that let one more browser in each, for whoever has started the studio.
pub struct Doorkeeper(Arc<Guard>);

impl Doorkeeper {
    /// Returns an address with a token of its own, which lets one browser in; the addresses before it let none in any more.
    ///
    /// # Errors
    /// [`StudioError::Random`].
    pub fn another_address(&self) -> Result<String, StudioError> {
        let token = self.0.renewed_token().map_err(StudioError::Random)?;
        Ok(address(self.0.port, &token))
    }
}

fn address(port: u16, token: &str) -> String {
    format!("http://127.0.0.1:{port}/?token={token}")
}

/// A studio that listens, and answers while it [serves](Studio::serve).
pub struct Studio {
    runtime: Runtime,
    listener: TcpListener,
    house: Arc<House>,
}

impl Studio {
    /// Listens on a port of 127.0.0.1; port 0: one that is free. The page begins with `beginning`; jobs save their
    /// results in folders inside of `results`.
    ///
    /// # Errors
    /// [`StudioError`] if the port is taken or the system gives no server.
    pub fn bind(port: u16, beginning: Option<&Ask>, results: &Path) -> Result<Studio, StudioError> {
        // One thread carries messages; the work is done on others.
        let runtime = Builder::new_current_thread().enable_io().enable_time().build()?;
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let listener = runtime
            .block_on(TcpListener::bind(address))
            .map_err(|source| StudioError::Port { port, source })?;
        let port = listener.local_addr()?.port();
        let house = House {
            guard: Arc::new(Guard::new(port).map_err(StudioError::Random)?),
            beginning: serde_json::to_string(&beginning).map_err(io::Error::other)?,
            searches: Arc::default(),
            jobs: Arc::new(Jobs::new(results)),
            work: Arc::new(Semaphore::new(AT_ONCE)),
            tabs: Arc::new(Semaphore::new(MOST_TABS)),
            closing: watch::Sender::new(false),
        };
        Ok(Studio { runtime, listener, house: Arc::new(house) })
    }

    /// Returns the address to open, with the token that lets one browser in.
    pub fn address(&self) -> String {
        let guard = &self.house.guard;
        address(guard.port, &guard.token().unwrap_or_default())
    }

    /// Returns what lets in other browsers while the studio serves.
    pub fn doorkeeper(&self) -> Doorkeeper {
        Doorkeeper(Arc::clone(&self.house.guard))
    }

    /// Answers until `end` is set; then closes the tabs, stops their searches and returns.
    ///
    /// # Errors
    /// [`StudioError::System`] if the server breaks down.
    pub fn serve(self, end: &AtomicBool) -> Result<(), StudioError> {
        let Studio { runtime, listener, house } = self;
        let (closing, jobs) = (house.closing.clone(), Arc::clone(&house.jobs));
        let app = router(house);
        let served = runtime.block_on(async {
            let mut goodbye = closing.subscribe();
            let server = axum::serve(Limited::new(listener), app).with_graceful_shutdown(async move {
                // An error says that the sender is gone: the end has come as well.
                let _ = goodbye.wait_for(|closing| *closing).await;
            });
            let asked_to_end = async {
                while !end.load(Ordering::SeqCst) {
                    sleep(LOOK).await;
                }
                jobs.close();
                closing.send_replace(true);
                sleep(FAREWELL).await;
            };
            tokio::select! {
                served = server => served,
                () = asked_to_end => Ok(()),
            }
        });
        jobs.close();
        jobs.wait(FAREWELL);
        runtime.shutdown_timeout(FAREWELL);
        Ok(served?)
    }
}

fn router(house: Arc<House>) -> Router {
    let guard = Arc::clone(&house.guard);
    let routed = routes().into_iter().fold(Router::new(), |all, one| all.route(one.path, one.handler));
    routed
        .layer(from_fn_with_state(Arc::clone(&house), known))
        .fallback(|| async { (StatusCode::NOT_FOUND, "there is no such page\n") })
        .layer(DefaultBodyLimit::max(MOST_BYTES))
        .layer(from_fn_with_state(guard, guarded))
        .with_state(house)
}

/// Lets in whoever brings the cookie; the page itself lets in whoever brings the token.
async fn known(State(house): State<Arc<House>>, request: Request, next: Next) -> Response {
    let known = request.uri().path() == "/" || house.guard.knows(request.headers());
    if known { next.run(request).await } else { stranger() }
}

fn stranger() -> Response {
    let why = "This browser is not let in. Open the address that linkwright has printed: it holds a token that lets one \
               browser in, once.\nIt is used up? Press Enter in the terminal where linkwright runs: it prints another \
               address, for this browser.\nWhere it has no terminal, end it and start it again.\n";
    (StatusCode::FORBIDDEN, why).into_response()
}

/// Answers with the page; with the token in the address, with the cookie and the way to the address without it.
pub(super) async fn page(State(house): State<Arc<House>>, uri: Uri, headers: HeaderMap) -> Response {
    let token = uri.query().and_then(|query| query.strip_prefix("token="));
    match token {
        Some(token) if house.guard.admits(token) => {
            let to = [(header::LOCATION, "/".to_owned()), (header::SET_COOKIE, house.guard.cookie())];
            (StatusCode::SEE_OTHER, to).into_response()
        }
        _ if !house.guard.knows(&headers) => stranger(),
        // The same address once more, from a browser that is known.
        Some(_) => (StatusCode::SEE_OTHER, [(header::LOCATION, "/")]).into_response(),
        None => content("text/html; charset=utf-8", include_str!("page/index.html")),
    }
}

/// Opens a tab's WebSocket.
pub(super) async fn live(State(house): State<Arc<House>>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(place) = Arc::clone(&house.tabs).try_acquire_owned() else {
        let why = format!("{MOST_TABS} tabs are open: close one\n");
        return (StatusCode::SERVICE_UNAVAILABLE, why).into_response();
    };
    upgrade
        .max_message_size(MOST_BYTES)
        .max_frame_size(MOST_BYTES)
        .max_write_buffer_size(4 * 1024 * 1024)
        .on_upgrade(move |socket| tab(socket, house, place))
}

/// Carries a tab's messages to its mailbox and the latest answer to the tab.
///
/// Its place is free again when its worker has ended.
async fn tab(mut socket: WebSocket, house: Arc<House>, place: OwnedSemaphorePermit) {
    let mail = Arc::new(Mailbox::default());
    let (tell, mut told) = watch::channel(Told::default());
    let (mine, searches) = (Arc::clone(&mail), Arc::clone(&house.searches));
    let worker = std::thread::Builder::new().name("tab".into()).spawn(move || {
        let _place = place;
        work(mine, tell, searches);
    });
    if worker.is_err() {
        return;
    }
    let mut closing = house.closing.subscribe();
    let mut ping = interval(PING);
    loop {
        let send = tokio::select! {
            changed = told.changed() => match changed {
                Ok(()) => Message::Text((&**told.borrow_and_update()).into()),
                // The worker is gone: there is nothing more to say.
                Err(_) => break,
            },
            _ = ping.tick() => Message::Ping(Bytes::new()),
            _ = closing.wait_for(|closing| *closing) => break,
            message = socket.recv() => match message {
                Some(Ok(Message::Text(text))) => {
                    mail.put(text.as_str().to_owned());
                    continue;
                }
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                // Bytes are no edit; anything else is the end.
                _ => break,
            },
        };
        // A tab that takes nothing holds up nobody but itself, and not for long.
        if !matches!(timeout(PATIENCE, socket.send(send)).await, Ok(Ok(()))) {
            break;
        }
    }
    mail.close();
    // The other side may have left without a word.
    let _ = timeout(Duration::from_millis(500), socket.send(Message::Close(None))).await;
}
