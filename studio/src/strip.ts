// The strip of candidates: small pictures that move, with their figures.

import { element, figure, setAll } from "../../src/report/html/player/svg.mjs";
import { isTheSame } from "./choice";
import type { Moving } from "./figures";
import { changing, setChildren } from "./focus";
import { errorUnit, labelOf, nounOf } from "./labels";
import type { Shown, Solution, Task } from "./messages";
import { Picture } from "./picture";
import { longestMax, pinnedFor, sizeOf } from "./task";
import {
  type Graded,
  gaitInWords,
  jams,
  limitedBy,
  longestOf,
  marks,
  nearnessInWords,
  SIGNS,
  sizeInWords,
  strayInWords,
  transmissionInWords,
} from "./words";

const [W, H] = [150, 96];
/** Of more than so many only the pictures in sight are drawn. */
export const MANY = 12;

export const inWords = (shown: Shown) =>
  shown.accepted
    ? jams(shown)
      ? "meets what was asked, but jams"
      : "meets everything that was asked"
    : `not met: ${[...new Set(shown.unmet.map(labelOf))].join(", ") || "a defect"}`;

/** Whether what it misses by is rounding: an error of 1e-14 tells nobody anything. */
export function isExact({ ability, max, linkage }: Shown): boolean {
  return !ability && max < 1e-11 * longestOf(linkage);
}

/** How near it comes: to the last digit where it is one of the linkages through nine points. */
export function nearness(shown: Shown, task: Task): string {
  const length = errorUnit(task);
  if (isExact(shown)) return `through the ${nounOf(task)}s to the last digit`;
  const turned = task.body && shown.angle ? `; angle at most ${figure(shown.angle.max_deg, 2)}°` : "";
  if (!shown.ability) return `rms ${figure(shown.rms, 3)}${length}, at most ${figure(shown.max, 3)}${length}${turned}`;
  return `exactly through the ${nounOf(task)}s${shown.certified_within === undefined ? "" : ", proved"}; ${shown.ability}`;
}

/** How large a linkage is as it moves: the diagonal of the box of all of it. */
function extentOf(moving: Moving): number {
  const [left, low, right, high] = moving.box();
  return Math.hypot(right - left, high - low);
}

/** What a card shows. */
interface Entry {
  moving: Moving;
  /** The target that it was found for. */
  task: Task;
  name: string;
  marks: string[];
  chosen: boolean;
  isWalker: boolean;
  /** Of one that is pinned. */
  colour?: number;
  /** Of a candidate: whether it is pinned. */
  isKept: boolean;
  /** That it is pinned for something else than what stands, if it is. */
  elsewhere: string;
}

/** One card of the strip. */
class Card {
  /** Whether it is in sight. */
  seen = false;
  private moving: Moving | null = null;
  private task: Task | null = null;
  private key = "";
  private picture = new Picture(W, H);
  private title = element("strong");
  private marks = element("span", { class: "tags" });
  private quality = element("span", { class: "quality" });
  private figures = element("span", { class: "figures" });
  private verdict = element("span", { class: "verdict" });
  readonly pick = element("button", { class: "pick" }, [
    this.picture.svg,
    this.title,
    this.marks,
    this.quality,
    this.figures,
    this.verdict,
  ]);
  readonly pin = element("button", { class: "pin-button" });
  readonly node = element("li", { class: "card" }, [this.pick, this.pin]);

  constructor(onPick: () => void, onPin: () => void) {
    this.pick.addEventListener("click", onPick);
    this.pin.addEventListener("click", onPin);
  }

  /** Shows a linkage; `part`: where in its motion, drawn even out of sight; null: once it is in sight. */
  show({ moving, task, name, marks, chosen, isWalker, colour, isKept, elsewhere }: Entry, part: number | null) {
    const { shown } = moving;
    Object.assign(this, { moving, task });
    const few = part !== null;
    if (this.seen || few) this.draw(part ?? 0);
    const pinned = colour !== undefined;
    setAll(this.node, { class: pinned ? `card pin-${colour}` : "card" });
    const { unit } = task;
    const texts = [name, `${nearness(shown, task)}; ${shown.type}`, elsewhere || inWords(shown)];
    const size = sizeOf(task.points);
    const limits = {
      longest: longestMax(task),
      transmission: task.transmission_deg_min,
      ratio: task.link_ratio_max ?? 20,
      pivots: task.pivots_in,
    };
    const limited = limitedBy(shown, limits);
    const exact = shown.ability !== undefined || isExact(shown);
    const extent = few ? extentOf(moving) : undefined;
    const strays = few && task.closed && !exact ? strayInWords(moving, task.points, size) : [];
    const graded: Graded[] = [
      ...(exact || task.function ? [] : [nearnessInWords(shown, size)]),
      ...strays,
      transmissionInWords(shown.transmission_deg),
    ];
    const gait = few && isWalker && moving.cycle.cyclic ? gaitInWords(moving.curve, unit) : "";
    const large = task.function ? "" : sizeInWords(shown.linkage, size, extent);
    const plain = [large, gait, limited].filter((text) => text !== "");
    // Figures of another path are told as such, and praise nothing.
    const meant = task.body ? "motion" : "path";
    const named = (text: string) => text.replace("the path", `${elsewhere ? "its" : "the"} ${meant}`);
    const aside = (text: string) => element("span", {}, [named(text)]);
    const key = JSON.stringify([elsewhere, texts, graded, plain, marks, shown.accepted, chosen, pinned, isKept]);
    if (key === this.key) return;
    this.key = key;
    [this.title.textContent, this.figures.textContent, this.verdict.textContent] = texts;
    this.marks.replaceChildren(...marks.map((mark) => element("span", {}, [mark])));
    this.quality.replaceChildren(
      ...graded.map(({ grade, text }) =>
        elsewhere ? aside(text) : element("span", { class: grade }, [`${SIGNS[grade]} ${named(text)}`]),
      ),
      ...plain.map(aside),
    );
    // No approval in green beside what is poor.
    const isNotPraised = elsewhere !== "" || graded.some(({ grade }) => grade === "poor");
    this.verdict.classList.toggle("good", shown.accepted && !isNotPraised);
    this.verdict.classList.toggle("plain", elsewhere !== "" || (shown.accepted && isNotPraised));
    setAll(this.pick, { "aria-pressed": String(chosen) });
    const act = pinned ? "Unpin" : isKept ? "Pinned" : "Pin";
    this.pin.textContent = act;
    setAll(this.pin, {
      "aria-label": `${act} ${name.toLowerCase()}`,
      ...(pinned ? {} : { "aria-pressed": String(isKept) }),
    });
  }

  /** Draws what is to be shown, unless it is drawn already. */
  draw(part: number) {
    const { moving, task } = this;
    if (moving && task) this.picture.show(moving, task.function ? [] : task.points, task.closed, part);
  }

  pose(part: number) {
    this.picture.pose(part);
  }
}

export class Strip {
  /** Those of candidates and those of what is pinned: a pin's card stays its own when candidates come and go. */
  private cards: [Card[], Card[]] = [[], []];
  private shown: Card[] = [];
  private found = 0;
  private part = 0;
  /** Only what is in sight moves. */
  private sight = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        const card = this.cards.flat().find((one) => one.node === entry.target);
        if (!card) continue;
        card.seen = entry.isIntersecting;
        if (card.seen) {
          card.draw(this.part);
          card.pose(this.part);
        }
      }
    },
    { rootMargin: "200px" },
  );

  constructor(
    private list: HTMLElement,
    private pick: (index: number) => void,
    private pin: (index: number) => void,
  ) {}

  private card(kind: 0 | 1, i: number): Card {
    const place = () => (kind === 0 ? i : this.found + i);
    const card =
      this.cards[kind][i] ??
      new Card(
        () => this.pick(place()),
        () => this.pin(place()),
      );
    if (!this.cards[kind][i]) this.sight.observe(card.node);
    this.cards[kind][i] = card;
    return card;
  }

  /** Shows candidates, then what is pinned, each over the target that it was found for; `now`: the task that stands;
   * `own`: the number of the user's; `isWalker`: they are legs. */
  show(
    all: Moving[],
    solutions: Solution[],
    found: number,
    chosen: number,
    own: number | null,
    now: Task,
    isWalker: boolean,
  ) {
    const before = this.shown;
    this.found = found;
    this.shown = all.map((_, i) => (i < found ? this.card(0, i) : this.card(1, i - found)));
    const candidates = all.slice(0, found);
    // Of many through nine points no curve is traced that is not looked at.
    const marked =
      found > MANY ? [] : marks(candidates.map((moving) => ({ shown: moving.shown, extent: extentOf(moving) })));
    all.forEach((moving, i) => {
      const name = i < found ? `Linkage ${i + 1}` : `Pinned ${i - found + 1}`;
      const colour = i < found ? undefined : (solutions[i].colour ?? 0);
      const isOwn = own !== null && moving.shown.number === own;
      const tags = [...(isOwn ? ["yours"] : []), ...(marked[i] ?? [])];
      const { task } = solutions[i];
      const elsewhere = i < found ? "" : pinnedFor(task, now);
      const isKept = solutions.slice(found).some(({ shown }) => isTheSame(shown, moving.shown));
      const entry = { moving, task, name, marks: tags, chosen: i === chosen, isWalker, colour, isKept, elsewhere };
      this.shown[i].show(entry, all.length <= MANY ? this.part : null);
    });
    if (this.shown.length !== before.length || this.shown.some((card, i) => card !== before[i])) {
      const heading = this.list.parentElement?.querySelector("h2") ?? this.list;
      changing(
        this.list,
        () =>
          setChildren(
            this.list,
            this.shown.map((card) => card.node),
          ),
        heading,
      );
    }
    this.list.classList.toggle("many", all.length > MANY);
  }

  pose(part: number) {
    this.part = part;
    for (const card of this.shown) if (card.seen) card.pose(part);
  }
}
