//! Limits connections: how many there are at once, and for how long one stays silent.

use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, Join, ReadBuf, join};
use tokio::net::TcpListener;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep, sleep};

/// Connections at once; more wait in the system's own short queue.
const MOST: usize = 96;
/// The time after which a connection that says nothing is closed. A tab answers a ping more often than that.
const SILENCE: Duration = Duration::from_secs(45);

/// The time for the head of a connection's first request: one that comes letter by letter holds its place no longer.
const FIRST_WORDS: Duration = Duration::from_secs(5);
/// The end of a head.
const END_OF_HEAD: &[u8] = b"\r\n\r\n";

/// Listens for connections within the limits.
pub(super) struct Limited {
    listener: TcpListener,
    places: Arc<Semaphore>,
}

impl Limited {
    pub(super) fn new(listener: TcpListener) -> Self {
        Limited { listener, places: Arc::new(Semaphore::new(MOST)) }
    }
}

impl axum::serve::Listener for Limited {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        loop {
            // The semaphore is never closed; were it, no connection would be taken.
            let Ok(place) = Arc::clone(&self.places).acquire_owned().await else {
                std::future::pending::<()>().await;
                continue;
            };
            match self.listener.accept().await {
                Ok((stream, from)) => {
                    // Without it small answers wait for a timer; with an old kernel they may.
                    let _ = stream.set_nodelay(true);
                    let silence = Box::pin(sleep(FIRST_WORDS));
                    let (stream, out) = stream.into_split();
                    return (join(Incoming { stream, silence, head: Some(0), _place: place }, out), from);
                }
                // No more files may be open, or the other side has left: a little later there may be room.
                Err(_) => sleep(Duration::from_millis(100)).await,
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection within the limits.
pub(super) type Connection = Join<Incoming, OwnedWriteHalf>;

/// The bytes that come in. They end when nothing comes for [`SILENCE`], or no whole head of a request within
/// [`FIRST_WORDS`].
pub(super) struct Incoming {
    stream: OwnedReadHalf,
    silence: Pin<Box<Sleep>>,
    /// The length of the part of [`END_OF_HEAD`] that has come last; `None`: all of it has come.
    head: Option<usize>,
    _place: OwnedSemaphorePermit,
}

/// Returns the length of the part of [`END_OF_HEAD`] with which the bytes so far end; `None`: all of it has come.
fn after(mut there: usize, bytes: &[u8]) -> Option<usize> {
    for byte in bytes {
        there = match there {
            _ if *byte == END_OF_HEAD[there] => there + 1,
            _ if *byte == END_OF_HEAD[0] => 1,
            _ => 0,
        };
        if there == END_OF_HEAD.len() {
            return None;
        }
    }
    Some(there)
}

impl AsyncRead for Incoming {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let read = Pin::new(&mut self.stream).poll_read(context, buffer);
        if read.is_ready() {
            self.head = self.head.and_then(|there| after(there, &buffer.filled()[before..]));
            if self.head.is_none() {
                self.silence.as_mut().reset(Instant::now() + SILENCE);
                return read;
            }
            if !self.silence.is_elapsed() {
                return read;
            }
        }
        match self.silence.as_mut().poll(context) {
            Poll::Ready(()) => Poll::Ready(Err(io::ErrorKind::TimedOut.into())),
            Poll::Pending => Poll::Pending,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_head_is_seen_however_it_comes() {
        let head = b"GET / HTTP/1.1\r\nHost: x\r\n\r\nbody";
        assert_eq!(after(0, head), None);
        for cut in 0..head.len() - 4 {
            let ended = after(0, &head[..cut]).and_then(|there| after(there, &head[cut..]));
            assert_eq!(ended, None, "{cut}");
        }
        assert_eq!(after(0, b"GET /\r\nHost: x\r\n"), Some(2));
        assert_eq!(after(0, b"\r\n\r\r\n\r"), Some(3));
        assert_eq!(after(0, b"\n\n\n\n"), Some(0));
    }
}
