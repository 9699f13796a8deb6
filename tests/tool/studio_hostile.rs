//! The studio against slow clients, floods and bodies without end: refused or served, never a hang or a growing queue.

use crate::studio::{Studio, egg};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

fn studio(folder: &TempDir, port: &str) -> Studio {
    Studio::start(&["--port", port, "--out", &folder.path().display().to_string()])
}

/// The most memory that a process has had, kB; 0 where the system does not tell.
fn most_memory(studio: &Studio) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", studio.child.id())).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0)
}

/// Everything that comes until the other side closes; whether it did within the socket's patience.
fn closes(socket: &mut TcpStream) -> bool {
    let mut bytes = [0; 4096];
    loop {
        match socket.read(&mut bytes) {
            Ok(0) => return true,
            Ok(_) => {}
            Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return false,
            Err(_) => return true,
        }
    }
}

#[test]
fn clients_that_send_letter_by_letter_hold_their_places_for_seconds_only() {
    let folder = TempDir::new().expect("a folder");
    let studio = studio(&folder, "18431");
    let cookie = studio.cookie();
    // More than there are places.
    let mut slow: Vec<TcpStream> = (0..120).map(|_| studio.socket()).collect();
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(4) {
        for socket in &mut slow {
            let _ = socket.write_all(b"G");
        }
        sleep(Duration::from_millis(250));
    }
    // All the while they go on.
    let (told, asked) = std::sync::mpsc::channel();
    std::thread::scope(|scope| {
        let studio = &studio;
        scope.spawn(move || {
            studio.is_well(&cookie);
            let _ = told.send(());
        });
        while asked.try_recv().is_err() {
            assert!(start.elapsed() < Duration::from_secs(25), "nobody else is served");
            for socket in &mut slow {
                let _ = socket.write_all(b"G");
            }
            sleep(Duration::from_millis(100));
        }
    });
}

#[test]
fn bodies_without_end_and_bodies_that_never_come_are_given_up() {
    let folder = TempDir::new().expect("a folder");
    let studio = studio(&folder, "18432");
    let cookie = studio.cookie();
    let head = |path: &str, length: &str| {
        let (host, origin) = (studio.host(), studio.origin());
        format!(
            "POST {path} HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nCookie: {cookie}\r\n{length}\r\n\r\n"
        )
    };
    // 100 MB in pieces whose sum nobody announced.
    for path in ["/jobs", "/details", "/export", "/compare", "/read", "/problem.toml"] {
        let mut socket = studio.socket();
        socket.write_all(head(path, "Transfer-Encoding: chunked").as_bytes()).expect("it reads");
        let piece = [&b"10000\r\n"[..], &[b' '; 0x10000], b"\r\n"].concat();
        let taken = (0..1600).take_while(|_| socket.write_all(&piece).is_ok()).count();
        // What the system itself holds back counts too; no more is read.
        assert!(taken < 400, "{path} takes {} MB", taken / 16);
        assert!(closes(&mut socket), "{path}");
    }
    // A body that is announced and does not come.
    let mut sockets: Vec<TcpStream> = (0..20).map(|_| studio.socket()).collect();
    let start = Instant::now();
    for socket in &mut sockets {
        socket.write_all(head("/jobs", "Content-Length: 1000").as_bytes()).expect("it reads");
        socket.write_all(b"{").expect("it reads");
    }
    studio.is_well(&cookie);
    for socket in &mut sockets {
        assert!(closes(socket), "it waits for a body");
    }
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    assert!(most_memory(&studio) < 300 * 1024, "{} kB", most_memory(&studio));
    studio.is_well(&cookie);
}

#[test]
fn a_thousand_requests_at_once_are_served_or_refused_and_a_tab_that_hears_nothing_holds_up_nobody() {
    let folder = TempDir::new().expect("a folder");
    let studio = studio(&folder, "18433");
    let cookie = studio.cookie();
    // A tab that sends and never reads.
    let mut deaf = studio.tab(&cookie);
    let mut edit = egg(1, 900, 0.0);
    edit["moving"] = true.into();
    let text = edit.to_string();
    deaf.0.set_write_timeout(Some(Duration::from_millis(200))).expect("a timeout");
    for _ in 0..300 {
        deaf.send(&text);
    }
    let counts: [AtomicUsize; 3] = Default::default();
    let start = Instant::now();
    std::thread::scope(|scope| {
        for i in 0..25 {
            let (studio, counts, cookie) = (&studio, &counts, &cookie);
            scope.spawn(move || {
                for j in 0..40 {
                    let known = [("Cookie", cookie.as_str())];
                    let origin = studio.origin();
                    let posted = [("Cookie", cookie.as_str()), ("Origin", origin.as_str())];
                    let reply = match (i + j) % 5 {
                        0 => studio.asks("GET", "/", &known, b""),
                        1 => studio.asks("GET", "/jobs", &known, b""),
                        2 => studio.asks("GET", "/openapi.json", &known, b""),
                        3 => studio.asks("POST", "/details", &posted, b"{\"of\": 1}"),
                        _ => studio.asks("POST", "/jobs", &posted, b"{}"),
                    };
                    let kind = match reply.status() {
                        200 | 422 => 0,
                        429 => 1,
                        _ => 2,
                    };
                    counts[kind].fetch_add(1, Ordering::Relaxed);
                }
            });
        }
    });
    let [served, refused, other] = counts.map(AtomicUsize::into_inner);
    assert!(served >= 200 && other == 0 && served + refused == 1000, "{served}, {refused}, {other}");
    assert!(start.elapsed() < Duration::from_secs(60));
    // Another tab is answered at once, though one hears nothing.
    sleep(Duration::from_secs(1));
    let mut tab = studio.tab(&cookie);
    tab.send(&egg(1, 16, 0.0).to_string());
    tab.hears_that(|a| a["candidates"].as_array().is_some_and(|c| !c.is_empty()));
    assert!(most_memory(&studio) < 400 * 1024, "{} kB", most_memory(&studio));
    studio.is_well(&cookie);
}
