//! The studio from outside, by plain sockets: who is let in, what is refused, what a burst does.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// A studio that runs as a program of its own.
pub(crate) struct Studio {
    pub(crate) child: Child,
    port: u16,
    token: String,
}

/// Port and token of the next address that is printed.
fn address(told: &mut impl BufRead) -> (u16, String) {
    let mut line = String::new();
    told.read_line(&mut line).expect("an address");
    let rest = line.trim().strip_prefix("http://127.0.0.1:").expect("an address of this machine");
    let (port, token) = rest.split_once("/?token=").expect("a token");
    (port.parse().expect("a port"), token.to_owned())
}

impl Studio {
    pub(crate) fn start(arguments: &[&str]) -> Studio {
        Studio::at_a_keyboard(arguments, Stdio::null()).0
    }

    /// A studio that hears this keyboard, and what it prints after its address.
    fn at_a_keyboard(arguments: &[&str], keyboard: Stdio) -> (Studio, BufReader<ChildStdout>) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_linkwright"))
            .args(["studio", "--no-open"])
            .args(arguments)
            .stdin(keyboard)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        let mut told = BufReader::new(child.stdout.take().expect("a pipe"));
        let (port, token) = address(&mut told);
        (Studio { child, port, token }, told)
    }

    pub(crate) fn socket(&self) -> TcpStream {
        let socket = TcpStream::connect(SocketAddr::from(([127, 0, 0, 1], self.port))).expect("it listens");
        socket.set_read_timeout(Some(Duration::from_secs(30))).expect("a timeout");
        socket
    }

    pub(crate) fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// The whole answer to a request with these headers.
    pub(crate) fn asks(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Reply {
        Reply(String::from_utf8_lossy(&self.bytes(method, path, headers, body)).into_owned())
    }

    fn bytes(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Vec<u8> {
        let mut text = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n");
        if !headers.iter().any(|(name, _)| *name == "Host") {
            text += &format!("Host: {}\r\n", self.host());
        }
        for (name, value) in headers {
            text += &format!("{name}: {value}\r\n");
        }
        if !body.is_empty() && !headers.iter().any(|(name, _)| *name == "Content-Length") {
            text += &format!("Content-Length: {}\r\n", body.len());
        }
        let mut socket = self.socket();
        socket.write_all((text + "\r\n").as_bytes()).expect("it reads");
        // A body that is refused may find the other side gone.
        let _ = socket.write_all(body);
        let mut answer = Vec::new();
        match socket.read_to_end(&mut answer) {
            Ok(_) => {}
            Err(e) if e.kind() == ErrorKind::ConnectionReset => {}
            Err(e) => panic!("no answer: {e}"),
        }
        answer
    }

    /// Brings the token; the cookie.
    pub(crate) fn cookie(&self) -> String {
        let reply = self.asks("GET", &format!("/?token={}", self.token), &[], b"");
        assert_eq!((reply.status(), reply.header("location").as_deref()), (303, Some("/")));
        let cookie = reply.header("set-cookie").expect("a cookie");
        for part in ["HttpOnly", "SameSite=Strict"] {
            assert!(cookie.contains(part), "{cookie}");
        }
        cookie.split(';').next().expect("a pair").to_owned()
    }

    pub(crate) fn origin(&self) -> String {
        format!("http://{}", self.host())
    }

    pub(crate) fn posts(&self, cookie: &str, path: &str, body: &[u8]) -> Reply {
        let origin = self.origin();
        self.asks("POST", path, &[("Cookie", cookie), ("Origin", &origin)], body)
    }

    /// The body of the answer, which is no text.
    pub(crate) fn posts_for_bytes(&self, cookie: &str, path: &str, body: &[u8]) -> Vec<u8> {
        let origin = self.origin();
        let answer = self.bytes("POST", path, &[("Cookie", cookie), ("Origin", &origin)], body);
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        assert!(answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer[..end]));
        answer[end + 4..].to_vec()
    }

    /// A tab: its WebSocket, upgraded.
    pub(crate) fn tab(&self, cookie: &str) -> Tab {
        let mut socket = self.socket();
        let (host, origin) = (self.host(), self.origin());
        write!(
            socket,
            "GET /live HTTP/1.1\r\nHost: {host}\r\nOrigin: {origin}\r\nCookie: {cookie}\r\nConnection: Upgrade\r\n\
             Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        )
        .expect("it reads");
        let mut head = Vec::new();
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            socket.read_exact(&mut byte).expect("an answer");
            head.push(byte[0]);
        }
        let head = String::from_utf8_lossy(&head).into_owned();
        assert!(head.starts_with("HTTP/1.1 101"), "{head}");
        Tab(socket)
    }

    pub(crate) fn is_well(&self, cookie: &str) {
        let reply = self.asks("GET", "/", &[("Cookie", cookie)], b"");
        assert!(reply.status() == 200 && reply.0.contains("<title>"), "{}", reply.0);
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub(crate) struct Reply(pub(crate) String);

impl Reply {
    pub(crate) fn status(&self) -> u16 {
        self.0.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0)
    }

    pub(crate) fn header(&self, name: &str) -> Option<String> {
        let head = self.0.split("\r\n\r\n").next()?;
        let pairs = head.lines().filter_map(|line| line.split_once(": "));
        pairs.filter(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value.to_owned()).next()
    }
}

pub(crate) struct Tab(pub(crate) TcpStream);

impl Tab {
    /// Sends a text frame, masked with zeros.
    pub(crate) fn send(&mut self, text: &str) {
        let n = text.len();
        let mut frame = vec![0x81];
        match n {
            0..126 => frame.push(0x80 | n as u8),
            126..65536 => {
                frame.push(0x80 | 126);
                frame.extend((n as u16).to_be_bytes());
            }
            _ => {
                frame.push(0x80 | 127);
                frame.extend((n as u64).to_be_bytes());
            }
        }
        frame.extend([0; 4]);
        frame.extend(text.as_bytes());
        // Too large a message may find the other side gone.
        let _ = self.0.write_all(&frame);
    }

    /// The next text; `None` at the end.
    pub(crate) fn hears(&mut self) -> Option<Value> {
        loop {
            let mut head = [0; 2];
            self.0.read_exact(&mut head).ok()?;
            let mut n = u64::from(head[1] & 127);
            if n == 126 {
                let mut long = [0; 2];
                self.0.read_exact(&mut long).ok()?;
                n = u64::from(u16::from_be_bytes(long));
            } else if n == 127 {
                let mut long = [0; 8];
                self.0.read_exact(&mut long).ok()?;
                n = u64::from_be_bytes(long);
            }
            let mut body = vec![0; n as usize];
            self.0.read_exact(&mut body).ok()?;
            match head[0] & 15 {
                1 => return Some(serde_json::from_slice(&body).expect("JSON")),
                8 => return None,
                _ => {}
            }
        }
    }

    /// The first answer of which this holds.
    pub(crate) fn hears_that(&mut self, what: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let answer = self.hears().expect("the tab is open");
            if what(&answer) {
                return answer;
            }
            assert!(start.elapsed() < Duration::from_secs(60), "{answer}");
        }
    }
}

/// An egg of `n` points with one of them moved.
pub(crate) fn egg(version: u64, n: usize, by: f64) -> Value {
    let points: Vec<[f64; 2]> = (0..n)
        .map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            [30.0 * angle.cos() + if i == 3 { by } else { 0.0 }, 20.0 * angle.sin()]
        })
        .collect();
    json!({"version": version, "points": points, "closed": true})
}

#[cfg(target_os = "linux")]
#[test]
fn enter_prints_another_address_for_one_browser_and_ends_the_one_before() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::fs::{File, OpenOptions};
    let keys = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
    grantpt(&keys).and_then(|()| unlockpt(&keys)).expect("it is ours");
    let name = ptsname(&keys, Vec::new()).expect("it has a name").into_string().expect("text");
    let terminal = OpenOptions::new().read(true).write(true).open(name).expect("its other end");
    let (mut studio, mut told) = Studio::at_a_keyboard(&["--port", "0"], terminal.into());
    let mut keys = File::from(keys);
    let mut used: Vec<String> = Vec::new();
    for _ in 0..2 {
        keys.write_all(b"\n").expect("a key");
        let (port, another) = address(&mut told);
        assert!(port == studio.port && another.len() == 64 && another != studio.token);
        used.push(std::mem::replace(&mut studio.token, another));
        for gone in &used {
            let reply = studio.asks("GET", &format!("/?token={gone}"), &[], b"");
            assert_eq!((reply.status(), reply.header("set-cookie")), (403, None));
            assert!(reply.0.contains("Press Enter in the terminal where linkwright runs"), "{}", reply.0);
        }
        // Whoever was let in stays in.
        let cookie = studio.cookie();
        assert_eq!(studio.asks("GET", "/", &[("Cookie", &cookie)], b"").status(), 200);
        assert_eq!(studio.asks("GET", &format!("/?token={}", studio.token), &[], b"").status(), 403);
    }
}

#[test]
fn the_token_lets_one_in_and_strangers_stay_out() {
    let studio = Studio::start(&["--port", "18461"]);
    let (host, origin) = (studio.host(), studio.origin());
    for path in ["/", "/app.js", "/live", "/beginning.json", "/schemas.json", "/?token=", "/?token=0"] {
        assert_eq!(studio.asks("GET", path, &[("Origin", &origin)], b"").status(), 403, "{path}");
    }
    let cookie = studio.cookie();
    // Once.
    let again = format!("/?token={}", studio.token);
    assert_eq!(studio.asks("GET", &again, &[], b"").status(), 403);
    studio.is_well(&cookie);
    let with = |headers: &[(&str, &str)], path: &str| {
        let mut all = vec![("Cookie", cookie.as_str())];
        all.extend(headers);
        studio.asks("GET", path, &all, b"").status()
    };
    for path in ["/", "/live", "/app.js"] {
        for host in ["evil.example", "evil.example:18461", "127.0.0.1", "127.0.0.1:1", "[::1]:18461", ""] {
            assert_eq!(with(&[("Host", host)], path), 421, "{path} {host}");
        }
        for origin in ["http://evil.example", "null", "https://127.0.0.1:18461", "http://127.0.0.1:1", ""] {
            assert_eq!(with(&[("Origin", origin)], path), 403, "{path} {origin}");
        }
    }
    // An upgrade and a body must say where they come from.
    let upgrade = [
        ("Connection", "Upgrade"),
        ("Upgrade", "websocket"),
        ("Sec-WebSocket-Version", "13"),
        ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
    ];
    assert_eq!(with(&upgrade, "/live"), 403);
    assert_eq!(with(&upgrade, "/"), 400);
    assert_eq!(with(&[("Host", &host), ("Host", "evil.example")], "/"), 421);
    assert_eq!(with(&[("Origin", &origin), ("Origin", "http://evil.example")], "/"), 403);
    let body = egg(1, 12, 0.0).to_string();
    assert_eq!(studio.asks("POST", "/problem.toml", &[("Cookie", &cookie)], body.as_bytes()).status(), 403);
    assert_eq!(studio.asks("POST", "/problem.toml", &[("Origin", &origin)], body.as_bytes()).status(), 403);
    for bad in ["linkwright-studio-18461=", "linkwright-studio-18461=0", "other=1", ";;;="] {
        assert_eq!(studio.asks("GET", "/", &[("Cookie", bad)], b"").status(), 403);
    }
    let page = studio.asks("GET", "/", &[("Cookie", &cookie)], b"");
    let policy = page.header("content-security-policy").expect("a policy");
    assert!(policy.starts_with("default-src 'none'") && !policy.contains("unsafe"), "{policy}");
    assert_eq!(page.header("referrer-policy").as_deref(), Some("no-referrer"));
    assert_eq!(with(&[], "/../Cargo.toml"), 404);
    assert_eq!(with(&[], "/etc/passwd"), 404);
}

#[test]
fn bodies_that_are_wrong_or_huge_are_refused() {
    let studio = Studio::start(&["--port", "18462"]);
    let cookie = studio.cookie();
    let good = studio.posts(&cookie, "/problem.toml", egg(1, 12, 0.5).to_string().as_bytes());
    assert!(good.status() == 200 && good.0.contains("format = 1"), "{}", good.0);
    for body in [
        "",
        "{",
        "[]",
        "null",
        "{\"points\": 1}",
        "{\"points\": [[NaN, 1], [2, 3], [4, 5]]}",
        "{\"points\": [[1e999, 1], [2, 3], [4, 5]]}",
        "{\"points\": [[1, 2]], \"file\": \"/etc/passwd\"}",
        "{\"points\": [[1, 2], [3, 4]]}",
        "{\"points\": [[1e300, 2], [3, 4], [5, 6]]}",
        "{\"points\": [[1, 2], [3, 4], [5, 6]], \"name\": \"../x\"}",
        "\u{0}\u{1}",
        "{\"points\": [[1, 2], [3, 4], [5, 6]], \"seed\": 18446744073709551615}",
        "{\"points\": [[1, 2], [3, 4], [5, 6]], \"pivots_in\": [5, 5, 1, 1]}",
    ] {
        let reply = studio.posts(&cookie, "/problem.toml", body.as_bytes());
        assert_eq!(reply.status(), 422, "{body}: {}", reply.0);
    }
    assert_eq!(
        studio.posts(&cookie, "/problem.toml", egg(1, 10_000, 0.0).to_string().as_bytes()).status(),
        413
    );
    assert_eq!(
        studio.posts(&cookie, "/problem.toml", egg(1, 1001, 0.0).to_string().as_bytes()).status(),
        422
    );
    let deep = "[".repeat(200_000);
    assert_eq!(studio.posts(&cookie, "/linkage.toml", deep.as_bytes()).status(), 422);
    // 100 MB that are announced, and 100 MB that come.
    let origin = studio.origin();
    let announced = [("Cookie", cookie.as_str()), ("Origin", &origin), ("Content-Length", "104857600")];
    assert_eq!(studio.asks("POST", "/problem.toml", &announced, b"").status(), 413);
    let reply = studio.posts(&cookie, "/problem.toml", &vec![b' '; 100 << 20]);
    assert!([0, 413].contains(&reply.status()), "{}", reply.0);
    let linkage = json!({"name": "x", "linkage": {"A": [0, 0], "B": [4, 1], "a": 2, "b": 5, "c": 5, "d": 5, "e": 5,
        "t1": 1, "t2": -1}});
    let reply = studio.posts(&cookie, "/linkage.toml", linkage.to_string().as_bytes());
    assert!(reply.status() == 200 && reply.0.contains("[linkage]"), "{}", reply.0);
    // Texts to be read: no file is opened, nothing wrong hangs or breaks.
    for body in [
        "{}",
        "{\"kind\": \"csv\"}",
        "{\"kind\": \"exe\", \"text\": \"\"}",
        "{\"kind\": \"csv\", \"text\": \"x,y\\n1,nan\\n\"}",
        "{\"kind\": \"problem\", \"text\": \"format = 1\\n[task.path]\\nfile = '/etc/passwd'\"}",
        "{\"kind\": \"svg\", \"text\": \"<!DOCTYPE x [<!ENTITY a 'b'>]><svg>&a;</svg>\"}",
    ] {
        let reply = studio.posts(&cookie, "/read", body.as_bytes());
        assert_eq!(reply.status(), 422, "{body}: {}", reply.0);
    }
    let deep = json!({"kind": "svg", "text": "<g>".repeat(60_000)}).to_string();
    assert_eq!(studio.posts(&cookie, "/read", deep.as_bytes()).status(), 422);
    let csv =
        json!({"kind": "csv", "name": "a.csv", "text": "x,y,crank_deg\n0,0,1\n1,1,2\n2,0,3\n"}).to_string();
    let reply = studio.posts(&cookie, "/read", csv.as_bytes());
    assert!(reply.status() == 200 && reply.0.contains("crank_deg"), "{}", reply.0);
    studio.is_well(&cookie);
}

#[test]
fn a_tab_gets_linkages_they_follow_and_nonsense_in_between_is_said_to_be_so() {
    let studio = Studio::start(&["--port", "18463"]);
    let cookie = studio.cookie();
    let mut tab = studio.tab(&cookie);
    tab.send(&egg(1, 16, 0.0).to_string());
    let first =
        tab.hears_that(|a| a["version"] == 1 && a["candidates"].as_array().is_some_and(|c| !c.is_empty()));
    assert!(first["candidates"][0]["rms"].as_f64().is_some_and(|rms| rms < 5.0), "{first}");
    tab.hears_that(|a| a["doing"] == "done");
    let mut moved = egg(2, 16, 1.0);
    moved["moving"] = json!(true);
    tab.send(&moved.to_string());
    let followed = tab.hears_that(|a| a["version"] == 2);
    assert!(
        followed["doing"] == "following" && !followed["candidates"].as_array().expect("a list").is_empty()
    );
    for nonsense in
        ["{", "[[[[", "{\"points\": []}", "nonsense", "{\"version\": 3, \"points\": [[1, 1], [1, 1]]}"]
    {
        tab.send(nonsense);
        let answer = tab.hears_that(|a| a["doing"] == "refused");
        assert!(answer["said"].as_str().is_some_and(|said| said.len() > 10), "{answer}");
        tab.send(&egg(4, 16, 1.0).to_string());
        tab.hears_that(|a| a["version"] == 4 && a["doing"] == "searching");
    }
    // Larger than any message may be: that tab is closed, no other.
    let mut other = studio.tab(&cookie);
    other.send(&" ".repeat(1 << 20));
    assert!(other.hears().is_none());
    tab.send(&egg(5, 16, 0.0).to_string());
    tab.hears_that(|a| a["version"] == 5);
    studio.is_well(&cookie);
}

#[test]
fn nine_points_give_every_linkage_and_all_of_them_move_along() {
    let studio = Studio::start(&["--port", "18468"]);
    let cookie = studio.cookie();
    let mut tab = studio.tab(&cookie);
    let ask = |version: u64, by: f64| {
        let points = [[0, 0], [11, -6], [24, -8], [37, -4], [45, 6], [42, 19], [30, 27], [14, 25], [3, 14]];
        let mut points = points.map(|p| p.map(f64::from));
        points[3][1] += by;
        json!({"version": version, "points": points, "closed": true, "method": "continuation"})
    };
    tab.send(&ask(1, 0.0).to_string());
    let first = tab.hears_that(|a| a["version"] == 1 && a["nine"].is_object());
    let counted = |a: &Value| (a["nine"]["classes"].as_u64(), a["nine"]["real"].as_u64());
    assert!(counted(&first).0 == Some(1442), "{}", first["nine"]);
    assert_eq!(first["candidates"].as_array().map(|c| c.len() as u64), counted(&first).1);
    assert!(first["candidates"][0]["ability"].is_string());
    // The same counts with proofs when the run has ended.
    let done = tab.hears_that(|a| a["version"] == 1 && a["doing"] == "done");
    assert_eq!(counted(&done), counted(&first));
    assert!(done["nine"]["said"].to_string().contains("Proved"), "{}", done["nine"]);
    let mut moved = ask(2, 0.3);
    moved["moving"] = json!(true);
    tab.send(&moved.to_string());
    let followed = tab.hears_that(|a| a["version"] == 2);
    assert!(followed["doing"] == "following" && counted(&followed).0 == Some(1442), "{}", followed["nine"]);
    // Eight points have no such list.
    let mut eight = egg(3, 8, 5.0);
    eight["method"] = json!("continuation");
    tab.send(&eight.to_string());
    let refused = tab.hears_that(|a| a["doing"] == "refused");
    assert!(refused["said"].as_str().is_some_and(|said| said.contains("9 points")), "{refused}");
    studio.is_well(&cookie);
}

#[test]
fn bursts_are_served_or_refused_and_ten_tabs_all_get_their_linkages() {
    let studio = Studio::start(&["--port", "18464"]);
    let cookie = studio.cookie();
    let mut tabs: Vec<Tab> = (0..10).map(|_| studio.tab(&cookie)).collect();
    for (i, tab) in tabs.iter_mut().enumerate() {
        for version in 0..200 {
            tab.send(&egg(version, 12, 0.01 * i as f64).to_string());
        }
    }
    let mut counts = [0; 3];
    for _ in 0..1000 {
        let reply = studio.asks("GET", "/", &[("Cookie", &cookie)], b"");
        counts[match reply.status() {
            200 => 0,
            429 => 1,
            _ => 2,
        }] += 1;
    }
    assert!(counts[0] >= 100 && counts[2] == 0, "{counts:?}");
    // What strangers ask is counted apart.
    std::thread::sleep(Duration::from_secs(1));
    let refused = (0..1000).filter(|_| studio.asks("GET", "/", &[], b"").status() == 429).count();
    assert!(refused > 0);
    assert_eq!(studio.asks("GET", "/", &[("Cookie", &cookie)], b"").status(), 200);
    for tab in &mut tabs {
        let last =
            |a: &Value| a["version"] == 199 && a["candidates"].as_array().is_some_and(|c| !c.is_empty());
        tab.hears_that(last);
    }
    // Six more fit when there is room for requests again, and not one beyond.
    std::thread::sleep(Duration::from_secs(1));
    let more: Vec<Tab> = (0..6).map(|_| studio.tab(&cookie)).collect();
    let origin = studio.origin();
    let upgrade = [
        ("Cookie", cookie.as_str()),
        ("Origin", &origin),
        ("Upgrade", "websocket"),
        ("Sec-WebSocket-Version", "13"),
        ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
    ];
    let mut text = format!("GET /live HTTP/1.1\r\nHost: {}\r\nConnection: Upgrade\r\n", studio.host());
    upgrade.iter().for_each(|(name, value)| text += &format!("{name}: {value}\r\n"));
    let mut socket = studio.socket();
    socket.write_all((text + "\r\n").as_bytes()).expect("it reads");
    let mut answer = [0; 12];
    socket.read_exact(&mut answer).expect("an answer");
    assert_eq!(&answer, b"HTTP/1.1 503");
    drop((more, tabs));
    studio.is_well(&cookie);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_cleanly_with_a_search_on() {
    let mut studio = Studio::start(&["--port", "18465"]);
    let cookie = studio.cookie();
    let mut tab = studio.tab(&cookie);
    tab.send(&egg(1, 40, 3.0).to_string());
    tab.hears_that(|a| a["doing"] == "searching");
    let start = Instant::now();
    let killed = Command::new("kill").args(["-INT", &studio.child.id().to_string()]).status();
    assert!(killed.expect("kill").success());
    while tab.hears().is_some() {}
    let code = studio.child.wait().expect("it ends").code();
    assert_eq!(code, Some(0));
    assert!(start.elapsed() < Duration::from_secs(6), "{:?}", start.elapsed());
}

#[test]
fn a_problem_begins_with_all_that_it_says_and_one_of_too_many_points_is_refused() {
    let root = crate::common::root();
    let problem = root.join("problems/examples/pivot-box.toml");
    let studio = Studio::start(&["--port", "18466", &problem.display().to_string()]);
    let cookie = studio.cookie();
    let reply = studio.asks("GET", "/beginning.json", &[("Cookie", &cookie)], b"");
    let body = reply.0.split("\r\n\r\n").nth(1).expect("a body");
    let ask: Value = serde_json::from_str(body).expect("JSON");
    assert_eq!(ask["name"], "pivot-box");
    assert_eq!(ask["pivots_in"], json!([-20.0, -40.0, 100.0, 20.0]));
    let text = studio.posts(&cookie, "/problem.toml", ask.to_string().as_bytes()).0;
    let text = text.split("\r\n\r\n").nth(1).expect("a body");
    let again = crate::common::parse(text);
    let before = crate::common::load(&problem, &[]);
    assert_eq!((again.spec, again.name, again.unit), (before.spec, before.name, before.unit));
    let schemas = studio.asks("GET", "/schemas.json", &[("Cookie", &cookie)], b"").0;
    assert!(schemas.contains("transmission_deg_min") && schemas.contains("half_width_deg"));
    let timed =
        Studio::start(&["--port", "18467", &root.join("problems/literature/e5.toml").display().to_string()]);
    let cookie = timed.cookie();
    let reply = timed.asks("GET", "/beginning.json", &[("Cookie", &cookie)], b"");
    let ask: Value = serde_json::from_str(reply.0.split("\r\n\r\n").nth(1).expect("a body")).expect("JSON");
    let before = crate::common::load(&root.join("problems/literature/e5.toml"), &[]).spec;
    assert_eq!(ask["timing"]["crank_deg"].as_array().map(Vec::len), Some(before.task.points.len()));
    assert!(ask["kept"]["design.a"].is_string(), "{ask}");
    let text = timed.posts(&cookie, "/problem.toml", ask.to_string().as_bytes()).0;
    assert_eq!(crate::common::parse(text.split("\r\n\r\n").nth(1).expect("a body")).spec, before);
    let folder = tempfile::tempdir().expect("a folder");
    let many = folder.path().join("many.csv");
    std::fs::write(&many, format!("x,y\n{}", "0,0\n1,1\n".repeat(600))).expect("written");
    let many = many.display().to_string();
    for (file, says) in [(many.as_str(), "1200 points"), ("problems/none.toml", "none.toml")] {
        let output = Command::new(env!("CARGO_BIN_EXE_linkwright"))
            .args(["studio", "--no-open", file])
            .current_dir(root)
            .output()
            .expect("it runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && said.contains(says), "{said}");
    }
    // A port that is taken is said to be so.
    let output = Command::new(env!("CARGO_BIN_EXE_linkwright"))
        .args(["studio", "--no-open", "--port", "18466"])
        .output()
        .expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("18466"));
}
