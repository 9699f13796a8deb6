// The conversation with the studio: edits go out under their versions, answers come in, late ones are passed over.

import { whyClosed } from "./api";
import { Connection } from "./connection";
import { more } from "./kit";
import type { Answer } from "./messages";
import { Pace } from "./pace";
import type { How, Store } from "./store";

export interface Listener {
  /** The target that stands has an answer. */
  answered(answer: Answer): void;
  /** The task that stands cannot be searched. */
  refused(said: string): void;
  /** There is no connection, in words. */
  closed(why: string): void;
}

export class Exchange {
  private connection: Connection | null = null;
  /** The edit that was answered last. */
  private heard = 0;
  private pace = new Pace();

  constructor(
    private store: Store<unknown>,
    private listener: Listener,
  ) {}

  /** Connects; whether it is connected stands in the page's data, for tests and styles. */
  begin() {
    this.connection = new Connection(
      (answer) => this.hear(answer),
      (open, tries) => {
        document.body.dataset.connected = String(open);
        if (!open && tries > 1)
          void whyClosed().then((why) => document.body.dataset.connected === "false" && this.listener.closed(why));
      },
    );
  }

  get isBegun(): boolean {
    return this.connection !== null;
  }

  /** A stroke ends now: its first answer is timed. */
  penUp() {
    this.pace.penUp();
  }

  /** Sends the task that stands; `held`: the number of the linkage that is shown while the hand moves. Too few points
   * are sent all the same: they end the search. */
  send({ moving, from }: How, held: number | undefined) {
    const { task, version, since } = this.store;
    document.body.dataset.asked = String(version);
    // Until a new target is answered it is said to be new.
    const fresh = this.heard < since;
    this.connection?.send({
      ...task,
      version,
      ...(moving ? { moving, held } : {}),
      ...(fresh ? { fresh } : {}),
      ...(more.map ? { map: true } : {}),
      ...(from ? { from } : {}),
    });
  }

  private hear(answer: Answer) {
    const { version, since, isShort } = this.store;
    if (answer.version !== 0 && answer.version < since) return;
    this.heard = answer.version || this.heard;
    if (answer.doing === "refused") {
      if (answer.version !== 0 && answer.version !== version) return;
      if (!isShort) this.listener.refused(answer.said);
      document.body.dataset.doing = "refused";
      return;
    }
    this.pace.answered(answer, version);
    document.body.dataset.doing = answer.doing;
    document.body.dataset.answered = String(answer.version);
    this.listener.answered(answer);
  }
}
