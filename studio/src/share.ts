// Sharing a problem: a link that holds it. It stands behind the # of the address, so that no server is told of it.

import { element } from "../../src/report/html/player/svg.mjs";
import * as api from "./api";
import type { Host } from "./desk";
import { taskOf } from "./task";

const MARK = "#problem=";
/** The longest link that is made or read: what programs pass on whole. */
const MOST_LETTERS = 16_000;
/** The largest text that a link may hold. */
const MOST_BYTES = 200_000;

async function through(bytes: Uint8Array, stream: GenericTransformStream): Promise<Uint8Array> {
  const reader = new Blob([bytes as BlobPart])
    .stream()
    .pipeThrough(stream as unknown as TransformStream<Uint8Array, Uint8Array>)
    .getReader();
  const parts: Uint8Array[] = [];
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    size += value.length;
    // A few letters may stand for gigabytes.
    if (size > MOST_BYTES) {
      await reader.cancel();
      throw new api.Refused("the link holds more than a problem");
    }
    parts.push(value);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

/** A text in letters that may stand in an address. */
export async function packed(text: string): Promise<string> {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** The text of such letters. */
export async function unpacked(letters: string): Promise<string> {
  if (letters.length > MOST_LETTERS) throw new api.Refused("the link is too long");
  if (!/^[\w-]+$/.test(letters)) throw new api.Refused("the link is no link of the studio");
  try {
    const bytes = Uint8Array.from(atob(letters.replaceAll("-", "+").replaceAll("_", "/")), (letter) =>
      letter.charCodeAt(0),
    );
    return new TextDecoder("utf-8", { fatal: true }).decode(
      await through(bytes, new DecompressionStream("deflate-raw")),
    );
  } catch (error) {
    throw error instanceof api.Refused ? error : new api.Refused("the link is broken: a part of it is missing");
  }
}

export class Share {
  private field = element("input", {
    id: "link",
    type: "url",
    "aria-label": "A link to a problem",
    placeholder: "paste a link",
    autocomplete: "off",
    spellcheck: "false",
  }) as HTMLInputElement;

  constructor(
    place: HTMLElement,
    private host: Host,
  ) {
    const copy = element("button", { id: "copy-link" }, ["Copy a web link"]);
    const take = element("button", { id: "take-link" }, ["Take the link"]);
    const file = element("input", {
      type: "file",
      id: "open-problem",
      accept: ".toml,application/toml",
    }) as HTMLInputElement;
    place.append(
      element("div", { class: "row share" }, [copy, this.field, take]),
      element("label", {}, ["Open one that was saved ", file]),
    );
    copy.addEventListener("click", () => void this.copy());
    take.addEventListener("click", () => void this.take(this.field.value));
    file.addEventListener("change", async () => {
      const [chosen] = file.files ?? [];
      file.value = "";
      if (!chosen) return;
      if (chosen.size > MOST_BYTES)
        return this.host.say(`${chosen.name} is larger than a problem of the studio may be.`);
      return this.read(await chosen.text(), chosen.name);
    });
    addEventListener("hashchange", () => void this.fromAddress());
  }

  /** Takes what the address holds, and takes it out of the address: the page remembers it. */
  async fromAddress() {
    const { hash } = location;
    if (!hash.startsWith(MARK)) return;
    history.replaceState(null, "", location.pathname);
    await this.take(hash);
  }

  private async copy() {
    try {
      const letters = await packed(await api.problemOf(this.host.task()));
      if (letters.length > MOST_LETTERS)
        return this.host.say("This problem is too long for a link: save the problem file instead.");
      const link = `${location.origin}/${MARK}${letters}`;
      this.field.value = link;
      try {
        await navigator.clipboard.writeText(link);
        return this.host.say(
          "The link is copied. It holds the problem: who runs linkwright studio can paste it there.",
        );
      } catch {
        this.field.select();
        return this.host.say("The link stands in the field: copy it from there.");
      }
    } catch (error) {
      return this.host.say(`No link can be made: ${api.wordsOf(error)}`, true);
    }
  }

  private async take(link: string) {
    const at = link.indexOf(MARK);
    if (at < 0) return this.host.say(`A link to a problem has ${MARK} in it.`);
    try {
      return await this.read(await unpacked(link.slice(at + MARK.length).trim()), "The link");
    } catch (error) {
      return this.host.say(`The link cannot be read: ${api.wordsOf(error)}`, true);
    }
  }

  private async read(text: string, from: string) {
    try {
      const { ask, warnings } = await api.read({ kind: "problem", name: from, text });
      this.host.take(taskOf(ask));
      if (warnings.length > 0) this.host.say(`${from}: ${warnings.join(". ")}.`);
    } catch (error) {
      this.host.say(`${from} holds no problem that can be drawn: ${api.wordsOf(error)}`, true);
    }
  }
}
