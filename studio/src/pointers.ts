// The pointers on the board: one is followed at a time, others are ignored; two fingers move and zoom the view.

/** What a pointer holds. */
export interface Grip {
  /** The pointer has moved, or has gone up. */
  step(event: PointerEvent, last: boolean): void;
  /** It is given up: nothing of it stays. */
  abort(): void;
}

/** Two fingers have moved. */
type Pinch = (one: PointerEvent, other: PointerEvent) => void;

/** A pointer that moves by fewer pixels stands still: a click is no drag. */
const SLIP = 3;

/** A grip that begins at the first real movement, with `begin`; given up, it calls `undo` if it has begun. */
export function dragging(start: PointerEvent, begin: () => void, step: Grip["step"], undo: () => void): Grip {
  let begun = false;
  return {
    step: (event, last) => {
      if (!begun && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < SLIP) return;
      if (!begun) begin();
      begun = true;
      step(event, last);
    },
    abort: () => begun && undo(),
  };
}

/** Watches the pointers: `take` says what a pointer that goes down holds, `pinch` what two fingers do. */
export function watchPointers(
  place: SVGElement,
  take: (event: PointerEvent) => Grip | null,
  pinch: (one: PointerEvent, other: PointerEvent) => Pinch,
) {
  /** The fingers that are followed, where they were last. */
  let fingers: PointerEvent[] = [];
  let grip: Grip | null = null;
  let pinching: Pinch | null = null;
  const numberOf = (event: PointerEvent) => fingers.findIndex((one) => one.pointerId === event.pointerId);
  place.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const [first] = fingers;
    if (first && (pinching || first.pointerType !== "touch" || event.pointerType !== "touch")) return;
    event.preventDefault();
    place.setPointerCapture(event.pointerId);
    if (first) {
      grip?.abort();
      grip = null;
      fingers = [first, event];
      pinching = pinch(first, event);
      return;
    }
    grip = take(event);
    fingers = [event];
  });
  place.addEventListener("pointermove", (event) => {
    const i = numberOf(event);
    if (i < 0) return;
    fingers[i] = event;
    if (pinching) pinching(fingers[0], fingers[1]);
    else grip?.step(event, false);
  });
  const end = (event: PointerEvent) => {
    const i = numberOf(event);
    if (i < 0) return;
    const held = grip;
    // Of two fingers the other one holds nothing; it can be joined again.
    [fingers, grip, pinching] = [fingers.filter((_, k) => k !== i), null, null];
    if (event.type === "pointerup") held?.step(event, true);
    else held?.abort();
  };
  place.addEventListener("pointerup", end);
  place.addEventListener("pointercancel", end);
}
