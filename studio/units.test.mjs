// What the page reckons without a browser: targets, texts of coordinates, steps back, choices. See .ci/check-studio.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { build } from "esbuild";
import { shortenPage, shortenScript } from "./shorten.mjs";

/** A module of the page. */
async function part(name) {
  const entry = new URL(`src/${name}.ts`, import.meta.url).pathname;
  const { outputFiles } = await build({
    entryPoints: [entry],
    bundle: true,
    format: "esm",
    write: false,
    logLevel: "error",
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

const { moved, ofStroke, ofText, segmentAt } = await part("target");
const {
  boxOfSides,
  canBeExact,
  drawnAnew,
  extentTimes,
  isSameButForName,
  longestTimes,
  nearestInstead,
  pivotsBeside,
  withExtent,
  withLengthsTimes,
  withLongest,
} = await part("task");
const view = await part("view");
const labels = await part("labels");
const words = await part("words");
const { followed, placeOf } = await part("choice");
const { Steps } = await part("memory");
const { resized } = await part("boxes");
const { nameFault } = await part("names");
const grab = await part("grab");
const { evenly } = await part("files");
const { ofKinds } = await part("slides");

test("a moved point takes none with it of precise ones, and none is rounded that does not move", () => {
  const far = [
    [1000.123, 500.4567],
    [1003.5671, 501.1],
    [1005.00213, 499.777],
    [1002.1234567890123, 498],
  ];
  const now = moved(far, 1, [1003.61234567, 501.2], false);
  assert.deepEqual([now[0], now[2], now[3]], [far[0], far[2], far[3]]);
  assert.deepEqual(now[1], [1003.6123, 501.2]);
  // Of a dense curve the neighbours come along, and the far side stays to the last digit.
  const circle = Array.from({ length: 60 }, (_, i) => [
    1000 + Math.cos((i * Math.PI) / 30),
    2000 + Math.sin((i * Math.PI) / 30),
  ]);
  const pulled = moved(circle, 0, [1001.5, 2000], true);
  assert.deepEqual(pulled.slice(10, 50), circle.slice(10, 50));
  assert.ok(pulled[3][0] > circle[3][0] + 0.1);
});

test("a small stroke far from the origin keeps its shape", () => {
  const stroke = Array.from({ length: 100 }, (_, i) => [
    5000 + Math.cos((i * 2 * Math.PI) / 99),
    8000 + Math.sin((i * 2 * Math.PI) / 99),
  ]);
  const { points, closed } = ofStroke(stroke, 1);
  assert.ok(closed);
  for (const [x, y] of points) assert.ok(Math.abs(Math.hypot(x - 5000, y - 8000) - 1) < 0.03, `${x} ${y}`);
});

test("boxes far from the origin are as fine as their size", () => {
  assert.deepEqual(resized([1000, 1000, 1002, 1003], 2, [1002.3456, 1003.777], 0.01), [1000, 1000, 1002.346, 1003.777]);
  const [left, low, right, high] = pivotsBeside([
    [1000.2, 50],
    [1001.6, 51],
  ]);
  assert.ok(
    left < 1000.2 && right > 1001.6 && high < 50 && low < high && right - left < 4,
    `${left} ${low} ${right} ${high}`,
  );
});

test("texts of bare numbers: what could be read in two ways is refused with its line and the remedy", () => {
  for (const text of [
    "0,0\n10, 4\n20,5",
    "0 0\n10   4\n20\t5",
    "x,y\n0,0\n10,4\n20 5 # the last",
    "x y\n0\t0\r\n10\t4\r\n2e1\t5\r\n",
  ]) {
    assert.deepEqual(
      ofText(text),
      [
        [0, 0],
        [10, 4],
        [20, 5],
      ],
      text,
    );
  }
  for (const [text, says] of [
    ["0,0\n1,5\t2,5", /^line 2: .*decimal point/],
    ["1,5 2,5\n3,5 4,5", /^line 1: .*decimal point/],
    ["1,5,2,5", /^line 1: .*decimal point/],
    ["1,5;2,5", /^line 1: .*semicolon.*decimal points and a comma/],
    ["1;2\n3;4", /^line 1: .*semicolon/],
    ["0 0 10\n1 2 20", /^line 1: .*3 cells.*header/],
    ["1, 2, 3", /^line 1: .*3 cells.*header/],
    ["1, 2\nthree", /^line 2: .*not two numbers/],
    ["1, 2\n4", /^line 2: .*not two numbers/],
    ["1, ", /^line 1/],
  ]) {
    const read = ofText(text);
    assert.equal(typeof read, "string", `${text} is read as ${JSON.stringify(read)}`);
    assert.match(read, says);
  }
});

test("a click on the line puts a point between, one beside it does not", () => {
  const line = [
    [0, 0],
    [10, 0],
    [10, 10],
  ];
  assert.equal(segmentAt(line, [5, 0.4], false, 1), 0);
  assert.equal(segmentAt(line, [10.5, 6], false, 1), 1);
  assert.equal(segmentAt(line, [5, 5], false, 1), null);
  assert.equal(segmentAt(line, [5, 5.2], true, 1), 2);
  assert.equal(segmentAt([], [5, 5], true, 1), null);
});

test("a choice is a linkage, not a place in a list", () => {
  const shown = (x, rms = 1) => ({
    rms,
    linkage: { A: [x, 0], B: [100, 0], a: 20, b: 80, c: 60, d: 40, e: 10, t1: 1, t2: 1 },
  });
  const all = [shown(0), shown(40), shown(-50)];
  const choice = { candidate: all[1] };
  // The same one, after another has come before it.
  const more = [shown(90), shown(0), shown(40, 0.5)];
  assert.equal(placeOf(followed(choice, more), more, []), 2);
  // What it has become; what is gone; the other assembly is another linkage.
  assert.equal(placeOf(followed(choice, [shown(0), shown(42)]), [shown(0)], []), -1);
  assert.equal(followed(choice, [shown(-50), shown(42)]).candidate.linkage.A[0], 42);
  assert.equal(followed(choice, [shown(-50), shown(-90)]), null);
  assert.equal(followed(choice, []), null);
  assert.equal(followed(choice, [{ ...all[1], linkage: { ...all[1].linkage, t1: -1 } }]), null);
  // A pin stays itself, however many candidates there are.
  const pin = { shown: shown(40), task: {} };
  for (const candidates of [[], all, more])
    assert.equal(placeOf(followed({ pin }, candidates), candidates, [{}, pin]), candidates.length + 1);
  assert.deepEqual([placeOf(null, all, [pin]), placeOf(null, [], [pin])], [0, -1]);
});

test("a path that is drawn anew keeps what is asked of the linkage and nothing of the old points", () => {
  const old = {
    name: "old",
    unit: "mm",
    source: "a paper",
    points: [[0, 0]],
    closed: false,
    types: ["crank-rocker"],
    seed: 7,
    tolerance: 0.5,
    tolerances: [1],
    weights: [2],
    timing: { crank_deg: [0], offset: "free" },
    raw: { points: [[0, 0]] },
    kept: { "design.a": "[1, 2]" },
    method: "genetic",
    transmission_deg_min: 40,
    pivots_in: [0, 0, 1, 1],
  };
  const points = [
    [0, 0],
    [1, 1],
    [2, 0],
  ];
  assert.deepEqual(JSON.parse(JSON.stringify(drawnAnew(old, points, true))), {
    name: "drawing",
    unit: "mm",
    points,
    closed: true,
    types: ["crank-rocker"],
    seed: 7,
    tolerance: 0.5,
    transmission_deg_min: 40,
    pivots_in: [0, 0, 1, 1],
  });
});

test("a step that is given up is neither behind nor before", () => {
  const steps = new Steps();
  steps.note("a");
  steps.note("b");
  assert.equal(steps.giveUp(), "b");
  assert.deepEqual([steps.canRedo, steps.undo("b"), steps.undo("a")], [false, "a", null]);
});

test("a view: pixels and plane, nearer around a point, the same picture of a larger plane", () => {
  const frame = { width: 800, height: 500 };
  const opening = view.opening("mm");
  assert.deepEqual(view.toPixel(opening, frame, [10, 10]), [430, 220]);
  assert.equal(view.opening("cm").scale, 10 * opening.scale);
  const one = { x: 12, y: -7, scale: 2.5 };
  const at = [40, 3];
  const back = view.toPlane(one, frame, view.toPixel(one, frame, at));
  assert.ok(Math.hypot(back[0] - at[0], back[1] - at[1]) < 1e-12);
  const nearer = view.zoomed(one, 2, at);
  const isSame = (one, other) => one.every((value, k) => Math.abs(value - other[k]) < 1e-9);
  assert.ok(isSame(view.toPixel(nearer, frame, at), view.toPixel(one, frame, at)));
  assert.equal(nearer.scale, 5);
  assert.equal(view.zoomed(one, 1e30).scale, 1e7);
  const larger = view.rescaled(one, 4);
  assert.ok(isSame(view.toPixel(larger, frame, [160, 12]), view.toPixel(one, frame, at)));
  const carried = view.carried(one, [1, 2], [5, -3]);
  assert.deepEqual([carried.x, carried.y], [8, -2]);
});

test("a path that is opened fills more than 35 % of the shorter side, with what stands around it if there is room", () => {
  const frame = { width: 800, height: 500 };
  const path = [-20, 5, 100, 65];
  const part = (one) => (120 * one.scale) / 500;
  const alone = view.onPath(frame, path);
  assert.ok(part(alone) >= 0.4 && part(alone) <= 0.5);
  assert.deepEqual([alone.x, alone.y], [40, 35]);
  const near = [-60, -60, 140, 65];
  assert.ok(view.isWithin(near, view.windowOf(view.onPath(frame, path, near), frame)));
  const far = view.onPath(frame, path, [-900, -900, 900, 900]);
  assert.ok(part(far) >= 0.35);
  assert.ok(view.isWithin(path, view.windowOf(far, frame)));
  assert.equal(view.joined([[Number.NaN, 0, 1, 1]]), null);
});

test("in a smaller frame the path is kept in sight at its scale, and a view that holds it stays", () => {
  const frame = { width: 600, height: 200 };
  const at = { x: 0, y: 0, scale: 2 };
  assert.deepEqual(view.inSight(at, frame, [-20, -10, 20, 10]), at);
  const moved = view.inSight(at, frame, [-20, -100, 20, -70]);
  assert.deepEqual([moved.x, moved.scale], [0, 2]);
  assert.ok(view.isWithin([-20, -100, 20, -70], view.windowOf(moved, frame)));
  assert.ok(Math.abs(moved.y) < 100, "no farther than it must");
  const large = view.inSight(at, frame, [-20, -300, 20, 0]);
  assert.deepEqual([large.x, large.y], [0, -150], "no room for it: its middle");
});

test("the box of the pivots lies below a path, of a walking machine above it", () => {
  const path = [
    [0, 0],
    [40, 0],
    [20, 10],
  ];
  assert.ok(pivotsBeside(path)[3] < 0);
  assert.ok(pivotsBeside(path, true)[1] > 10);
});

test("words for a figure: how near, how it transmits, what limits it", () => {
  assert.deepEqual(words.nearnessInWords({ rms: 0.2, max: 0.5 }, 100), {
    grade: "good",
    text: "very close: 0.20 % of the path",
  });
  assert.deepEqual(words.nearnessInWords({ rms: 5, max: 8 }, 100), {
    grade: "poor",
    text: "rough: misses by 8.0 % of the path",
  });
  assert.equal(words.transmissionInWords(31.2).text, "transmission 31° (fair)");
  assert.equal(words.transmissionInWords(3).grade, "poor");
  const linkage = { A: [0, 0], B: [30, 0], a: 10, b: 20, c: 300, d: 15, e: 12 };
  const shown = (rest) => ({ linkage, accepted: true, transmission_deg: 30.0001, link_ratio: 12, ...rest });
  assert.equal(words.sizeInWords(linkage, 100), "longest link 3 × the path");
  assert.equal(
    words.limitedBy(shown(), { longest: 300, transmission: 30, ratio: 20 }),
    "limited by: longest link, least transmission angle",
  );
  assert.equal(words.limitedBy(shown(), { longest: null, ratio: 20 }), "");
  const list = [
    { shown: shown({ transmission_deg: 31 }), extent: 500 },
    { shown: shown({ accepted: false, transmission_deg: 80 }), extent: 10 },
    { shown: shown({ transmission_deg: 60 }), extent: 300 },
  ];
  assert.deepEqual(words.marks(list), [["closest"], [], ["smallest", "best transmission"]]);
  assert.deepEqual(words.marks(list.slice(0, 1)), [[]]);
});

test("a curve that leaves its path between the points is poor, whatever its errors are", () => {
  const square = [
    [0, 0],
    [30, 0],
    [30, 40],
    [0, 40],
  ];
  const along = (far) => ({ curve: Array.from({ length: 80 }, (_, i) => [(30 * i) / 80, i === 40 ? -far : 0]) });
  assert.deepEqual(words.strayInWords(along(65), square, 50), [
    { grade: "poor", text: "its curve leaves the path by 130 %" },
  ]);
  assert.deepEqual(words.strayInWords(along(7), square, 50), []);
});

test("how a machine walks: the lower of two feet carries, half a turn apart", () => {
  const turn = (at) => Array.from({ length: 721 }, (_, i) => at((i * Math.PI) / 360));
  // Round and round: a foot carries over the lower half of its circle, 4 wide.
  const round = turn((t) => [2 * Math.cos(t), 2 * Math.sin(t)]);
  assert.equal(words.gaitInWords(round, "mm"), "steps 4.00 mm, foot lifted 4.00 mm, hips bob 2.00 mm");
  // Flat on the ground for one half of the turn, and back above it: nothing bobs.
  const flat = turn((t) => [30 * Math.cos(t), t < Math.PI ? 0 : 10 * Math.sin(t - Math.PI)]);
  assert.equal(words.gaitInWords(flat), "steps 60.0, foot lifted 10.0, hips bob 0");
  assert.equal(words.gaitInWords([...flat.slice(0, 9), null, ...flat.slice(10)]), "");
});

test("a box of two sides lies about what is there, and around the path", () => {
  const path = [
    [0, 0],
    [40, 10],
  ];
  assert.deepEqual(boxOfSides([100, 60], path, [-20, -30, 60, 70]), [-30, -10, 70, 50]);
  // Moved as far as the path needs it; about the middle of a path that is wider.
  assert.deepEqual(boxOfSides([50, 20], path, [100, 100, 200, 200]), [0, 0, 50, 20]);
  assert.deepEqual(boxOfSides([20, 5], path, [100, -200, 200, -100]), [10, 2.5, 30, 7.5]);
});

test("the longest link is a multiple of the path, and all lengths grow together", () => {
  const square = [
    [0, 0],
    [3, 0],
    [3, 4],
    [0, 4],
  ];
  const task = { name: "square", points: square, closed: true, types: [], seed: 1 };
  assert.equal(longestTimes(task), 3);
  const shorter = withLongest(task, 2);
  assert.equal(shorter.kept["require.longest_max"], "10");
  assert.equal(longestTimes(shorter), 2);
  assert.equal(withLongest(shorter, 3).kept, undefined, "the usual one is not asked");
  assert.equal(longestTimes(withLongest(task, null)), null);
  assert.equal(longestTimes({ ...task, kept: { "design.a": "[1, 2]" } }), null);
  assert.equal(
    longestTimes({ ...task, kept: { "design.ground_angle_deg": "[1, 2]" } }),
    3,
    "an angle bounds no length",
  );
  const bounded = {
    ...task,
    kept: { "design.a": "[1, 2.5]", "design.B": "[[-1, 1], [0, 3]]", "design.ground_angle_deg": "[5, 6]" },
  };
  assert.deepEqual(withLengthsTimes(withLongest(bounded, null), 2).kept, {
    "design.a": "[2, 5]",
    "design.B": "[[-2, 2], [0, 6]]",
    "design.ground_angle_deg": "[5, 6]",
    ...(withLongest(bounded, null).kept["require.longest_max"] && { "require.longest_max": '"any"' }),
  });
  const small = withExtent(task, 4);
  assert.deepEqual([small.kept["require.extent_max"], extentTimes(small), longestTimes(small)], ["20", 4, 3]);
  assert.equal(extentTimes(withExtent(small, null)), null);
  const ten = withLengthsTimes({ ...shorter, tolerance: 0.5, pivots_in: [-1, -2, 3, 0] }, 10);
  assert.deepEqual(ten.points[2], [30, 40]);
  assert.deepEqual(ten.pivots_in, [-10, -20, 30, 0]);
  assert.deepEqual([ten.tolerance, longestTimes(ten)], [5, 2]);
  const anew = drawnAnew(ten, square, true);
  assert.equal(longestTimes(anew), 2, "of the new path");
});

test("names that the studio takes, and why others are none", () => {
  for (const name of ["egg", "my leg 2", "Ei.v2", "com10", "größe", "_x"]) assert.equal(nameFault(name), null, name);
  for (const [name, says] of [
    ["", /at least one/],
    ["a/b", /no \//],
    [".x", /begin with \./],
    ["-x", /begin with -/],
    ["x.", /end with a dot/],
    ["con", /Windows/],
    ["NUL.txt", /Windows/],
    ["com1", /Windows/],
    ["x".repeat(65), /at most 64/],
  ])
    assert.match(nameFault(name) ?? "", says, name);
});

test("a joint is dragged as far as the locks let it, and the linkage is that of the pose", () => {
  const pose = { A: [0, 0], B: [40, 0], C: [0, 20], D: [50, 30], P: [20, 60] };
  const linkage = grab.ofPose(pose);
  assert.deepEqual([linkage.a, linkage.t1, linkage.t2], [20, 1, 1]);
  const moved = grab.dragged(pose, "C", [10, 30], new Set());
  assert.deepEqual([moved.C, moved.D], [[10, 30], pose.D]);
  // One locked length: along its circle. Two: not at all. A locked pivot stays.
  const held = grab.dragged(pose, "C", [30, 40], new Set(["a"]));
  assert.ok(Math.abs(Math.hypot(...held.C) - 20) < 1e-9 && held.C[0] > 0);
  assert.deepEqual(grab.dragged(pose, "C", [30, 40], new Set(["a", "b"])).C, pose.C);
  assert.deepEqual(grab.dragged(pose, "A", [5, 5], new Set(["A"])).A, pose.A);
  assert.equal(grab.ofPose({ ...pose, P: [20, -60] }).t2, -1);
  const round = grab.roundedTo({ ...linkage, a: 0.1, b: 51.2345 }, 0.5, new Set(["A"]));
  assert.deepEqual([round.a, round.b, round.A], [0.5, 51, [0, 0]]);
  assert.deepEqual(grab.keptBy(linkage, new Set(["a", "B", "ground"])), {
    "design.a": "[20, 20]",
    "design.B": "[[40, 40], [0, 0]]",
    "design.ground": "[40, 40]",
  });
  // A locked direction: a pivot goes along its line, rounding keeps it, and two pivots that stay need nothing more.
  const turned = { ...pose, B: [40, 30] };
  const along = grab.dragged(turned, "B", [60, 20], new Set(["ground_angle_deg"]));
  assert.ok(Math.abs(along.B[1] - 0.75 * along.B[0]) < 1e-9 && along.B[0] > 40);
  assert.deepEqual(grab.dragged(turned, "B", [60, 20], new Set(["ground_angle_deg", "ground"])), turned);
  const lines = grab.roundedTo(grab.ofPose({ ...turned, B: [40.4, 30.3] }), 0.5, new Set(["ground_angle_deg"]));
  assert.ok(Math.abs(lines.B[1] - 0.75 * lines.B[0]) < 1e-9 && Math.abs(Math.hypot(...lines.B) - 50.5) < 1e-9);
  assert.deepEqual(Object.keys(grab.keptBy(linkage, new Set(["ground_angle_deg", "a"]))), [
    "design.ground_angle_deg",
    "design.a",
  ]);
  assert.deepEqual(Object.keys(grab.keptBy(linkage, new Set(["A", "B", "ground", "ground_angle_deg"]))), [
    "design.A",
    "design.B",
  ]);
});

test("more points than can be searched become fewer along the same path; an exact wish that fails offers the nearest", () => {
  const points = Array.from({ length: 1500 }, (_, i) => [Math.cos(i / 239), Math.sin(i / 239)]);
  const fewer = evenly({ name: "x", points, closed: false, types: [], seed: 1, weights: points.map(() => 1) });
  assert.deepEqual([fewer.points.length, fewer.weights], [200, undefined]);
  for (const [x, y] of fewer.points) assert.ok(Math.abs(Math.hypot(x, y) - 1) < 1e-4);
  assert.equal(evenly({ name: "x", points: points.slice(0, 1000), closed: false, types: [], seed: 1 }), null);
  const nine = { name: "x", points: points.slice(0, 9), closed: true, types: [], seed: 1, method: "continuation" };
  const answer = { doing: "done", candidates: [{ accepted: false }] };
  const { task, said } = nearestInstead(nine, answer);
  assert.ok(task.method === undefined && task.tolerance > 0 && said.includes("instead of exactly"));
  assert.equal(nearestInstead(nine, { ...answer, candidates: [{ accepted: true }] }), null);
  assert.equal(nearestInstead({ ...nine, method: undefined }, answer), null);
});

test("all linkages are told where there are finitely many: nine points, five poses, mixtures, given pivots", () => {
  const task = (places, poses, kept) => ({
    name: "exact",
    points: Array.from({ length: places + poses }, (_, i) => [i, i * i]),
    closed: false,
    types: [],
    seed: 1,
    kept,
    ...(poses > 0 && { body: { angle_deg: [...Array(poses).fill(10), ...Array(places).fill(null)] } }),
  });
  for (const [places, poses] of [
    [9, 0],
    [8, 1],
    [6, 2],
    [4, 3],
    [2, 4],
    [0, 5],
  ])
    assert.ok(canBeExact(task(places, poses)));
  for (const [places, poses] of [
    [8, 0],
    [10, 0],
    [1, 4],
    [1, 5],
    [0, 4],
  ])
    assert.ok(!canBeExact(task(places, poses)));
  const [a, b] = [{ "design.A": "[0, -20]" }, { "design.B": "[40, -20]" }];
  assert.ok(canBeExact(task(7, 0, a)) && canBeExact(task(5, 0, { ...a, ...b })) && canBeExact(task(2, 3, b)));
  assert.ok(!canBeExact(task(9, 0, a)) && !canBeExact(task(0, 4, a)));
  // Eight of a slider-crank, of no other and not of several.
  const of = (mechanism, ...asked) => canBeExact({ ...task(...asked), mechanism });
  assert.ok(of(["slider-crank"], 8, 0) && of(["inverted-slider-crank"], 8, 0));
  assert.ok(!of(["slider-crank"], 9, 0) && !of(["slider-crank"], 8, 0, a) && !of(["slider-crank"], 7, 1));
  assert.ok(!of(["six-bar"], 8, 0) && !of(["slider-crank", "inverted-slider-crank"], 8, 0));
  // A range is no place.
  assert.ok(canBeExact(task(9, 0, { "design.A": "[[0, 10], [-20, 20]]" })));
  assert.ok(!canBeExact({ ...task(0, 5), timing: { crank_deg: [0, 1, 2, 3, 4], offset: "free" } }));
});

test("a linkage keeps its number while it follows", () => {
  const shown = (number, x) => ({
    number,
    rms: 1,
    linkage: { A: [x, 0], B: [100, 0], a: 20, b: 80, c: 60, d: 40, e: 10, t1: 1, t2: 1 },
  });
  const choice = { candidate: shown(7, 0) };
  assert.equal(followed(choice, [shown(8, 1), shown(7, 60)]).candidate.number, 7);
  assert.equal(followed(choice, [shown(8, 1), shown(9, 90)]).candidate.number, 8, "else the nearest");
});

test("a problem under another name is the same one", () => {
  const task = { name: "a", points: [[0, 0]], closed: false, types: [], seed: 1 };
  assert.ok(isSameButForName(task, { seed: 1, types: [], closed: false, points: [[0, 0]], name: "b", source: "x" }));
  assert.ok(!isSameButForName(task, { ...task, name: "b", seed: 2 }));
});

test("a script that is made shorter does the same; a page keeps its words", () => {
  const script =
    '"use strict";(()=>{let a=[3,-4,"b"],o={"aria-label":"value",valueAsNumber:Math.max(1,2)+Math.max(3,Math.abs(-9)),' +
    "value:[Math.max(...a.slice(0,2)),Math.max(5),Math.max(6)]};" +
    'function f(x){switch(x){case"aria-label":return"value"in o?o["aria-label"]:"aria-label";default:return o?.valueAsNumber}}' +
    'o.valueAsNumber+=1;globalThis.told=[f("aria-label"),f("value"),o.value,o.valueAsNumber,o?.valueAsNumber,' +
    "[1.25,2].map(v=>v.toPrecision(2)),(7.5).toPrecision(2),a.includes(String(o.value.includes(3))),a.includes('b')]})();";
  const told = (text) => {
    new Function(text)();
    return globalThis.told;
  };
  const short = shortenScript(script);
  assert.ok(short.length < script.length && /=Math\.max[,;]/.test(short) && short.includes("aria-label"), short);
  assert.deepEqual(told(short), told(script));
  assert.throws(() => shortenScript("let a = 1;"), /not one function/);
  const page = '<ul id="some-list">\n<li class="a b"> two <b>words</b> apart</li>\n</ul>\n';
  assert.equal(shortenPage(page), '<ul id=some-list><li class="a b"> two <b>words</b> apart</li></ul>');
});

test("what is asked has one name: that of its control, in the page and in what the studio says", () => {
  const read = (path) => readFileSync(new URL(path, import.meta.url), "utf8");
  const page = read("src/index.html").toLowerCase();
  const kinds = new URL("../src/task/requirement/", import.meta.url);
  const said = readdirSync(kinds).flatMap((name) => {
    const text = readFileSync(new URL(name, kinds), "utf8");
    const [, key] = /key: "([\w.]+)"/.exec(text) ?? [];
    const [, plain] = /plain: "([^"]+)"/.exec(text) ?? [];
    // What is asked of poses alone has its words there, in the second script.
    const isOfPoses = key?.startsWith("task.motion.") || key === "require.pins_in";
    return key && !isOfPoses ? [[key, plain]] : [];
  });
  // One file may hold two of a kind.
  said.push(["require.time_ratio", "time ratio of the slider's ways"]);
  const ofSliders = ["require.input", "require.stroke", "require.time_ratio"];
  const controlsOfSliders = read("src/slides.ts");
  assert.ok(said.length >= 16, String(said));
  for (const [key, plain] of said) {
    assert.equal(plain, labels.labelOf(key), key);
    // A line of a pivot is kept as its file says it, and a problem with loads is not taken: there are no controls for them.
    const isKept = ["require.pivot_on", "require.peak_torque_max"].includes(key);
    if (ofSliders.includes(key)) {
      assert.match(controlsOfSliders, new RegExp(`"(require\\.)?${key.slice("require.".length)}"`), key);
      continue;
    }
    assert.ok(isKept || page.includes(`>${plain}`) || page.includes(`> ${plain}`), `${plain}: a label of the page`);
  }
  assert.equal(labels.labelOf("design.Ax"), "place of A");
  assert.equal(labels.labelOf("design.ground"), "bounds of ground");
  for (const [text, wanted] of [
    ["fixed pivots inside", "both fixed pivots inside a box"],
    ["pivots_in ymax = 20 is on its limit", "both fixed pivots inside a box, top = 20 is on its limit"],
    ["costs 1 mm of rms; 1 mm more at xmin gives", "costs 1 mm of rms; 1 mm more at left gives"],
    ["not: type, design.a, pivots_in", "not: driven by, bounds of a, both fixed pivots inside a box"],
    ["`require.link_ratio_max` is 0.5", "longest over shortest link is 0.5"],
    ["coupler_x and a path_of_mine stay", "coupler_x and a path_of_mine stay"],
  ])
    assert.equal(labels.labelled(text), wanted);
});

test("other kinds of linkages keep what they can: a motor, and of a slider-crank its rail and its stroke", () => {
  const path = {
    name: "a",
    points: [
      [0, 0],
      [3, 4],
      [3, 1],
    ],
    closed: true,
    types: ["crank-rocker"],
    seed: 1,
  };
  const asked = { ...path, method: "continuation", objective: "max-deviation" };
  const slider = ofKinds(asked, ["slider-crank"]);
  assert.deepEqual([slider.types, slider.input, slider.mechanism], [[], "full-turn", ["slider-crank"]]);
  assert.deepEqual([slider.method, slider.objective], [undefined, undefined]);
  const held = { ...slider, stroke: [2, 3], kept: { "design.line_point": "[0, [1, 2]]", "design.a": "1" } };
  const twice = withLengthsTimes(held, 2);
  assert.deepEqual([twice.stroke, twice.kept["design.line_point"]], [[4, 6], "[0, [2, 4]]"]);
  const inverted = ofKinds(held, ["inverted-slider-crank"]);
  assert.deepEqual([inverted.stroke, inverted.kept], [undefined, { "design.a": "1" }]);
  const fourBar = ofKinds(inverted, ["four-bar"]);
  assert.deepEqual(
    [fourBar.mechanism, fourBar.input, fourBar.types],
    [undefined, undefined, ["crank-rocker", "double-crank"]],
  );
});

test("a rail that is turned by a hair is the same one, one that leads elsewhere is not", () => {
  const of = (line_deg, number) => ({
    linkage: { kind: "slider-crank", A: [0, 0], a: 0.01, b: 0.03, line_point: [0, 0], line_deg, t1: 1 },
    number,
  });
  const choice = { candidate: of(179.9, 1) };
  assert.deepEqual(followed(choice, [of(20, 2), of(-179.9, 3)]), { candidate: of(-179.9, 3) });
  assert.equal(followed(choice, [of(20, 2)]), null);
});
