// The gallery of examples: small linkages that move, each loaded by one click.

import { element } from "../../src/report/html/player/svg.mjs";
import { EXAMPLES, type Example, MORE } from "./examples";
import { movingOf } from "./figures";
import type { Shown } from "./messages";
import { Picture } from "./picture";
import THUMBNAILS from "./thumbnails.json";

const [WIDTH, HEIGHT] = [104, 76];

export class Gallery {
  private pictures: Picture[] = [];
  private close = element("button", { class: "drop", "aria-label": "Close the examples" }, ["×"]);

  constructor(
    private place: HTMLElement,
    private opener: HTMLButtonElement,
    take: (example: Example) => void,
    takeMore: (name: string) => void,
  ) {
    const item = (name: string, act: () => void, pictures: Node[] = []) => {
      const button = element("button", { class: "example" }, [...pictures, element("span", {}, [name])]);
      button.addEventListener("click", () => {
        this.open(false);
        act();
      });
      return element("li", {}, [button]);
    };
    const items = EXAMPLES.map((example) => {
      const { name, task } = example;
      const shown = (THUMBNAILS as unknown as Record<string, Shown>)[task.name];
      const picture = new Picture(WIDTH, HEIGHT, 0.45);
      if (shown) picture.show(movingOf(shown, task.points), task.points, task.closed, 0);
      this.pictures.push(picture);
      return item(name, () => take(example), [picture.svg]);
    });
    const others = MORE.map((name) => item(name, () => takeMore(name)));
    place.append(element("ul", {}, [...items, ...others]), this.close);
    this.close.addEventListener("click", () => {
      this.open(false);
      opener.focus();
    });
    opener.addEventListener("click", () => this.open(this.place.hidden));
  }

  open(on: boolean) {
    this.place.hidden = !on;
    this.opener.setAttribute("aria-expanded", String(on));
  }

  pose(part: number) {
    if (!this.place.hidden) for (const picture of this.pictures) picture.pose(part);
  }
}
