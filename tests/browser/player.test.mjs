// The player's position solver beside the Rust kernel: tests/tool/player_golden.rs writes golden.json.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Cycle } from "../../src/report/html/player/cycle.mjs";
import { draggedTo, inputAt, placeOf, rangeOf, within, wrappedDeg } from "../../src/report/html/player/drive.mjs";
import { kernelOf, motionAt, positionAt, transmissionAngle } from "../../src/report/html/player/kinematics.mjs";
import "../../src/report/html/player/sliders.mjs";
import { angleTicks, figure, roundLength, ticks, tickTexts } from "../../src/report/html/player/svg.mjs";

const golden = JSON.parse(readFileSync(new URL("golden.json", import.meta.url), "utf8"));
const TOLERANCE = 1e-12;

/** Numbers agree to the tolerance, in parts of `scale`. */
function near(found, expected, scale, what) {
  const list = [found].flat();
  [expected].flat().forEach((value, i) => {
    const apart = Math.abs(list[i] - value);
    assert.ok(apart <= TOLERANCE * scale, `${what}: ${list[i]} beside ${value}, apart by ${apart / scale} of ${scale}`);
  });
}

test("positions, transmission angles, velocities and accelerations are the kernel's to 1e-12", () => {
  let [closed, open] = [0, 0];
  for (const row of golden.positions) {
    const kernel = kernelOf(row.linkage);
    const joints = positionAt(kernel, row.angle, row.t1);
    if (!row.P) {
      assert.equal(joints, null);
      open += 1;
      continue;
    }
    const { A, B, a, b, c, d } = row.linkage;
    const size = Math.max(...A.map(Math.abs), ...B.map(Math.abs), a, b, c, d);
    for (const name of ["C", "D", "P"]) near(joints[name], row[name], size, name);
    near(transmissionAngle(kernel, joints), row.mu, 1, "mu");
    const motion = motionAt(kernel, joints, golden.omega, golden.alpha);
    // Rates grow towards a toggle, and their rounding with them.
    const sine = Math.abs(Math.sin(row.mu));
    const rate = (vector) => Math.max(size, Math.hypot(...[vector].flat())) / sine;
    near(motion.vP, row.vP, rate(row.vP), "velocity of P");
    near(motion.aP, row.aP, rate(row.aP) / sine, "acceleration of P");
    near(motion.omega3, row.omega3, Math.max(1, Math.abs(row.omega3)) / sine, "omega3");
    near(motion.omega4, row.omega4, Math.max(1, Math.abs(row.omega4)) / sine, "omega4");
    closed += 1;
  }
  assert.ok(closed >= 80 && open >= 5, `${closed} closed, ${open} open`);
});

test("so are those of linkages with a slider", () => {
  const count = { "slider-crank": 0, "inverted-slider-crank": 0, open: 0 };
  for (const row of golden.sliders) {
    const kernel = kernelOf(row.linkage);
    const joints = positionAt(kernel, row.angle, row.t1);
    if (!row.P) {
      assert.equal(joints, null);
      count.open += 1;
      continue;
    }
    for (const name of ["C", "D", "P"]) near(joints[name], row[name], 10, name);
    near(transmissionAngle(kernel, joints), row.mu, 10, "mu");
    const motion = motionAt(kernel, joints, golden.omega, golden.alpha);
    const sine = Math.sin(row.mu);
    const rate = (vector) => Math.max(10, Math.hypot(...[vector].flat())) / sine;
    near(motion.vP, row.vP, rate(row.vP), "velocity of P");
    near(motion.aP, row.aP, rate(row.aP) / sine, "acceleration of P");
    near(motion.omega3, row.omega3, Math.max(1, Math.abs(row.omega3)) / sine, "omega3");
    count[row.linkage.kind] += 1;
  }
  assert.ok(
    count["slider-crank"] >= 25 && count["inverted-slider-crank"] >= 25 && count.open >= 5,
    JSON.stringify(count),
  );
});

test("a whole motion reaches its points where the kernel does, at the places that it names", () => {
  const kinds = new Set();
  for (const { mechanism, target, reached } of golden.motions) {
    const cycle = new Cycle(mechanism, target);
    kinds.add(cycle.drive.kind);
    const size = Math.max(
      ...reached.flat().map(Math.abs),
      ...["a", "b", "c", "d"].map((key) => mechanism.linkage[key]),
    );
    reached.forEach((P, i) => {
      const point = cycle.points[i];
      near(point.reached, P, size, `point ${i}`);
      near(point.error, Math.hypot(P[0] - target.points[i][0], P[1] - target.points[i][1]), size, "its error");
      const [x, y] = cycle.at(point.place).P;
      assert.ok(Math.hypot(x - P[0], y - P[1]) < 1e-9 * size, `the place ${point.place} of point ${i}`);
      assert.ok(Math.abs(wrappedDeg(cycle.crankDeg(point.place) - mechanism.crank_deg[i])) < 1e-9);
    });
  }
  assert.deepEqual([...kinds].sort(), ["rock", "through", "turn"]);
});

test("velocity and acceleration are the derivatives of the position", () => {
  const row = golden.positions.find((one) => one.P && Math.abs(Math.sin(one.mu)) > 0.5);
  const kernel = kernelOf(row.linkage);
  const at = (time) => {
    const angle = row.angle + golden.omega * time + 0.5 * golden.alpha * time * time;
    return positionAt(kernel, angle, row.t1).P;
  };
  const h = 1e-4;
  const motion = motionAt(kernel, positionAt(kernel, row.angle, row.t1), golden.omega, golden.alpha);
  for (const axis of [0, 1]) {
    const [before, now, after] = [at(-h)[axis], at(0)[axis], at(h)[axis]];
    const scale = 1 + Math.hypot(...motion.aP);
    assert.ok(Math.abs((after - before) / (2 * h) - motion.vP[axis]) < 1e-5 * scale);
    assert.ok(Math.abs((after - 2 * now + before) / (h * h) - motion.aP[axis]) < 1e-4 * scale);
  }
});

test("a motion through its toggles stays closed all the way round, a rocking one within its range", () => {
  for (const { mechanism, target } of golden.motions) {
    const cycle = new Cycle(mechanism, target);
    assert.ok(cycle.samples().every((sample) => sample !== null));
    // The circuit is a closed curve without jumps.
    const circuit = cycle.circuit().map((joints) => joints.P);
    const steps = circuit.slice(1).map((P, i) => Math.hypot(P[0] - circuit[i][0], P[1] - circuit[i][1]));
    const length = steps.reduce((sum, step) => sum + step, 0);
    assert.ok(Math.max(...steps) < length / 20, `${mechanism.key}: ${Math.max(...steps)} of ${length}`);
    const [first, last] = [circuit[0], circuit.at(-1)];
    assert.ok(Math.hypot(first[0] - last[0], first[1] - last[1]) < 1e-9 * length);
    const [low, high] = rangeOf(cycle.drive);
    if (!cycle.cyclic) assert.deepEqual([within(cycle.drive, low - 50), within(cycle.drive, high + 50)], [low, high]);
  }
});

test("a crank that is dragged over a toggle comes out on the other branch", () => {
  const drive = { kind: "through", middle_deg: 10, half_width_deg: 60, t1: 1 };
  let q = placeOf(drive, 60, 1);
  assert.equal(inputAt(drive, q).t1, 1);
  for (const crank of [66, 69, 75, 69, 66, 60]) q = draggedTo(drive, q, crank, 1);
  assert.equal(inputAt(drive, q).t1, -1);
  assert.ok(Math.abs((inputAt(drive, q).angle * 180) / Math.PI - 60) < 1e-9);
  // And where the hand goes back, back on the same one.
  let back = placeOf(drive, 60, 1);
  for (const [crank, sense] of [
    [63, 1],
    [60, -1],
    [50, -1],
  ])
    back = draggedTo(drive, back, crank, sense);
  assert.equal(inputAt(drive, back).t1, 1);
});

test("points of another circuit have no place on the motion", () => {
  assert.equal(placeOf({ kind: "turn", middle_deg: 0, half_width_deg: 180, t1: 1 }, 30, -1), null);
  assert.equal(placeOf({ kind: "rock", middle_deg: 0, half_width_deg: 40, t1: 1 }, 90, 1), null);
  assert.equal(placeOf({ kind: "turn", middle_deg: 0, half_width_deg: 180, t1: 1 }, -30, 1), 330);
});

test("axes have round numbers", () => {
  assert.deepEqual(ticks(0, 10, 4), [0, 2, 4, 6, 8, 10]);
  assert.deepEqual(ticks(-1.7, 2.7, 4), [-1, 0, 1, 2]);
  assert.deepEqual(angleTicks(0, 360, 8), [0, 45, 90, 135, 180, 225, 270, 315, 360]);
  assert.deepEqual(tickTexts([-0.5, 0, 0.5]), ["−0.5", "0.0", "0.5"]);
  assert.deepEqual([0.0123, 7, 49, 1].map(roundLength), [0.01, 5, 20, 1]);
  assert.deepEqual([figure(0.022396524), figure(-31.4159), figure(NaN), figure(0)], ["0.02240", "−31.42", "–", "0"]);
});
