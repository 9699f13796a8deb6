"""Another front end of `linkwright studio`, in the Python that comes with every system.

Start `linkwright studio --no-open` and give the address that it prints (it lets one client in, once):

    python3 examples/studio-client.py 'http://127.0.0.1:8017/?token=..'

It draws an egg, follows it while a point moves, searches long, saves the result and writes egg.dxf. What it may ask for
is described in docs/studio-interface.md.
"""

import base64
import json
import math
import os
import socket
import struct
import sys
import time
import urllib.request
from urllib.parse import quote, urlsplit


class Studio:
    """A studio that has let us in: `ask` for requests, `live` for the WebSocket."""

    def __init__(self, address):
        parts = urlsplit(address)
        self.host, self.port = parts.hostname, parts.port
        self.origin = f"http://{parts.netloc}"
        # The token is exchanged for a cookie by the first request; what it leads to is the page.
        jar = urllib.request.HTTPCookieProcessor()
        self.opener = urllib.request.build_opener(jar)
        self.opener.open(address).read()
        self.cookie = "; ".join(f"{one.name}={one.value}" for one in jar.cookiejar)

    def ask(self, path, body=None):
        """The bytes of an answer; with a body it is a POST, which says where it comes from."""
        data = None if body is None else json.dumps(body).encode()
        headers = {} if body is None else {"Origin": self.origin, "Content-Type": "application/json"}
        with self.opener.open(urllib.request.Request(self.origin + path, data, headers)) as answer:
            return answer.read()

    def json(self, path, body=None):
        return json.loads(self.ask(path, body))

    def live(self):
        return Live(self)


class Live:
    """A tab's WebSocket (RFC 6455): `tell` sends an Ask, `hear` waits for the next Answer."""

    def __init__(self, studio):
        self.socket = socket.create_connection((studio.host, studio.port))
        self.file = self.socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        head = [
            "GET /live HTTP/1.1", f"Host: {studio.host}:{studio.port}", f"Origin: {studio.origin}", f"Cookie: {studio.cookie}",
            "Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Key: {key}", "", "",
        ]
        self.socket.sendall("\r\n".join(head).encode())
        assert b" 101 " in self.file.readline()
        while self.file.readline().strip():
            pass

    def frame(self, kind, data):
        length = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0xFE]) + struct.pack(">H", len(data)) if len(data) < 65536 else bytes([0xFF]) + struct.pack(">Q", len(data))
        # Clients mask what they send; a mask of zeros leaves it as it is.
        self.socket.sendall(bytes([0x80 | kind]) + length + bytes(4) + data)

    def tell(self, ask):
        self.frame(1, json.dumps(ask).encode())

    def hear(self):
        while True:
            first, length = self.file.read(2)
            if length == 126:
                (length,) = struct.unpack(">H", self.file.read(2))
            elif length == 127:
                (length,) = struct.unpack(">Q", self.file.read(8))
            data = self.file.read(length)
            if first & 15 == 1:
                return json.loads(data)
            if first & 15 == 9:
                self.frame(10, data)


def egg(version, by=0.0, **more):
    """An Ask: 24 points of an egg with one of them moved."""
    points = [[30 * math.cos(t) + (by if i == 3 else 0), 20 * math.sin(t)] for i, t in enumerate(2 * math.pi * i / 24 for i in range(24))]
    return {"version": version, "name": "egg", "unit": "mm", "points": points, "closed": True, "types": ["crank-rocker"], **more}


def main(address):
    studio = Studio(address)
    live = studio.live()
    live.tell(egg(1))
    answer = live.hear()
    while answer["doing"] != "done":
        answer = live.hear()
    print(f"linkages: {len(answer['candidates'])}, the best with an rms error of {answer['candidates'][0]['rms']:.3g} mm")
    for version in range(2, 12):
        live.tell(egg(version, 0.3 * (version - 1), moving=True))
        while answer["version"] != version or answer["doing"] == "refused":
            answer = live.hear()
        print(f"point 3 moved by {0.3 * (version - 1):.1f} mm: the best follows with {answer['candidates'][0]['rms']:.3g} mm")

    job = studio.json("/jobs", {"ask": egg(0, 3.0), "set": {"solve.evaluations": "100000"}, "replace": True})
    while job["state"] == "running":
        time.sleep(0.2)
        job = studio.json(f"/jobs/{quote(job['name'])}")
    print(f"{job['name']}: {job['state']}. {job['said']}")

    best = {"job": {"name": job["name"], "rank": 1}}
    with open("egg.dxf", "wb") as file:
        file.write(studio.ask("/export", {"of": best, "format": "dxf"}))
    print("egg.dxf is written")


if __name__ == "__main__":
    main(sys.argv[1])
