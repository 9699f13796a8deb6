// A linkage in the hand: joints that are dragged, lengths and pivots that are locked, what results.

import type { FourBar, Point } from "./messages";

export type Linkage = FourBar;
export type Joint = "A" | "B" | "C" | "D" | "P";
export type Pose = Record<Joint, Point>;
export type Length = "a" | "b" | "c" | "d" | "e" | "ground";
/** What can be locked: a length, a pivot where it stands, or the direction from A to B. */
export type Lock = Length | "A" | "B" | "ground_angle_deg";

/** The ends of each length. */
export const ENDS: Record<Length, [Joint, Joint]> = {
  a: ["A", "C"],
  b: ["C", "D"],
  c: ["B", "D"],
  d: ["C", "P"],
  e: ["D", "P"],
  ground: ["A", "B"],
};
export const LENGTHS = Object.keys(ENDS) as Length[];

const apart = (p: Point, q: Point) => Math.hypot(p[0] - q[0], p[1] - q[1]);
/** Whether r lies left of the way from p to q. */
const isLeft = (p: Point, q: Point, r: Point) => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) >= 0;

export const lengthOf = (linkage: Linkage, name: Length): number =>
  name === "ground" ? apart(linkage.A, linkage.B) : linkage[name];

/** The direction from A to B, degrees. */
export const groundAngle = ({ A, B }: Linkage): number => (Math.atan2(B[1] - A[1], B[0] - A[0]) * 180) / Math.PI;

/** The linkage whose joints stand in a pose. */
export function ofPose({ A, B, C, D, P }: Pose): Linkage {
  const t1 = isLeft(C, B, D) ? 1 : -1;
  const t2 = isLeft(C, D, P) ? 1 : -1;
  return { A, B, a: apart(A, C), b: apart(C, D), c: apart(B, D), d: apart(C, P), e: apart(D, P), t1, t2 };
}

/** The point at a distance from a centre that is nearest to another one. */
function onCircle(centre: Point, radius: number, to: Point): Point {
  const far = apart(centre, to);
  if (far === 0) return [centre[0] + radius, centre[1]];
  return [centre[0] + ((to[0] - centre[0]) * radius) / far, centre[1] + ((to[1] - centre[1]) * radius) / far];
}

/** The point of the line through `through` along the way from p to q that is nearest to another one. */
function onLine(through: Point, p: Point, q: Point, to: Point): Point {
  const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
  const along = ((to[0] - through[0]) * dx + (to[1] - through[1]) * dy) / (dx * dx + dy * dy || 1);
  return [through[0] + along * dx, through[1] + along * dy];
}

/** The pose with a joint brought as near to a place as the locks let it; the other joints stay. */
export function dragged(pose: Pose, joint: Joint, to: Point, locks: ReadonlySet<Lock>): Pose {
  if ((joint === "A" || joint === "B") && locks.has(joint)) return pose;
  const held = LENGTHS.filter((name) => locks.has(name) && ENDS[name].includes(joint));
  const isOnLine = (joint === "A" || joint === "B") && locks.has("ground_angle_deg");
  if (held.length + Number(isOnLine) > 1) return pose;
  if (isOnLine) return { ...pose, [joint]: onLine(pose[joint === "A" ? "B" : "A"], pose.A, pose.B, to) };
  const [name] = held;
  if (!name) return { ...pose, [joint]: to };
  const [one, other] = ENDS[name];
  const centre = pose[one === joint ? other : one];
  return { ...pose, [joint]: onCircle(centre, apart(pose[one], pose[other]), to) };
}

/** Lengths and pivots to multiples of a step, but for what is locked; none becomes nothing. Of a locked direction the
 * distance of the pivots is rounded. */
export function roundedTo(linkage: Linkage, step: number, locks: ReadonlySet<Lock>): Linkage {
  const round = (value: number) => Number((Math.round(value / step) * step).toPrecision(12));
  const place = (name: "A" | "B"): Point => (locks.has(name) ? linkage[name] : (linkage[name].map(round) as Point));
  const length = (name: "a" | "b" | "c" | "d" | "e") =>
    locks.has(name) ? linkage[name] : Math.max(round(linkage[name]), linkage[name] > 0 ? step : 0);
  const [a, b, c, d, e] = (["a", "b", "c", "d", "e"] as const).map(length);
  const A = place("A");
  if (!locks.has("ground_angle_deg") || locks.has("B")) return { ...linkage, A, B: place("B"), a, b, c, d, e };
  const [ground, angle] = [lengthOf(linkage, "ground"), (groundAngle(linkage) * Math.PI) / 180];
  const far = locks.has("ground") ? ground : Math.max(round(ground), step);
  return { ...linkage, A, B: [A[0] + far * Math.cos(angle), A[1] + far * Math.sin(angle)], a, b, c, d, e };
}

/** What a search has to keep of a linkage, as keys of a problem file. */
export function keptBy(linkage: Linkage, locks: ReadonlySet<Lock>): Record<string, string> {
  const digits = (value: number) => String(Number(value.toPrecision(10)));
  const both = (value: number) => `[${digits(value)}, ${digits(value)}]`;
  const keys: Record<string, string> = {};
  const isPlaced = locks.has("A") && locks.has("B");
  for (const lock of locks) {
    // Of two pivots that stay, distance and direction stay too.
    if (isPlaced && (lock === "ground" || lock === "ground_angle_deg")) continue;
    if (lock === "ground_angle_deg") keys[`design.${lock}`] = both(groundAngle(linkage));
    else if (lock === "A" || lock === "B") keys[`design.${lock}`] = `[${linkage[lock].map(both).join(", ")}]`;
    else keys[`design.${lock}`] = both(lengthOf(linkage, lock));
  }
  return keys;
}
