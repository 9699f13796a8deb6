// The WebSocket: the latest edit goes out and the latest answer comes in at most once a frame, a lost connection is tried again.

import type { Answer, Ask } from "./messages";

export class Connection {
  private socket: WebSocket | null = null;
  private waiting: Ask | null = null;
  private last: Ask | null = null;
  private lost = 0;
  private answer: string | null = null;

  constructor(
    private hear: (answer: Answer) => void,
    private state: (open: boolean, tries: number) => void,
  ) {
    this.open();
  }

  private open() {
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.addEventListener("open", () => {
      this.socket = socket;
      this.lost = 0;
      this.state(true, 0);
      // What waits is later than what went out last.
      const ask = this.waiting ?? this.last;
      if (ask) this.send({ ...ask, moving: false });
    });
    socket.addEventListener("message", (event) => this.take(event.data as string));
    socket.addEventListener("close", () => {
      this.socket = null;
      this.lost += 1;
      this.state(false, this.lost);
      setTimeout(() => this.open(), Math.min(500 * this.lost, 5000));
    });
  }

  /** Of the answers that come within a frame the latest holds: it replaces those before it. */
  private take(text: string) {
    const first = this.answer === null;
    this.answer = text;
    if (document.hidden) this.tell();
    else if (first) requestAnimationFrame(() => this.tell());
  }

  private tell() {
    const { answer } = this;
    this.answer = null;
    if (answer !== null) this.hear(JSON.parse(answer) as Answer);
  }

  send(ask: Ask) {
    const first = this.waiting === null;
    // A target that was begun anew stays so until it has gone out.
    this.waiting = this.waiting?.fresh ? { ...ask, fresh: true } : ask;
    if (first) requestAnimationFrame(() => this.flush());
  }

  private flush() {
    const ask = this.waiting;
    if (!ask) return;
    this.last = ask;
    if (this.socket && this.socket.bufferedAmount > 200_000) {
      requestAnimationFrame(() => this.flush());
      return;
    }
    this.waiting = null;
    this.socket?.send(JSON.stringify(ask));
  }
}
