// Linkages of several loops, six-bars and eight-bars: their motion is read from samples over a turn of the crank.

/** @typedef {[number, number]} Point */
/** @typedef {{names: string[], pivots: Point[], links: number[][], dyads: number[], rows: number[][]}} Track names: of the joints, the fixed pivots first, P the last; links: indices of their joints; dyads: of each link, 0 the crank; rows: over a turn, x and y of each moving joint, the transmission angle of each dyad, velocity and acceleration of P at one radian a second */

/** The weights of four neighbours in periodic cubic interpolation, at a share of the step between the second and the third. */
const weights = (f) => [
  ((2 - f) * f - 1) * f * 0.5,
  (f * f * (3 * f - 5) + 2) * 0.5,
  ((4 - 3 * f) * f + 1) * f * 0.5,
  (f - 1) * f * f * 0.5,
];

/** The row of a track at a crank angle. @param {number[][]} rows @param {number} angle radians */
function rowAt(rows, angle) {
  const n = rows.length;
  const turns = angle / (2 * Math.PI);
  const x = (turns - Math.floor(turns)) * n;
  const i = Math.floor(x);
  const near = [-1, 0, 1, 2].map((by) => rows[(i + by + n) % n]);
  const w = weights(x - i);
  return near[0].map((_, k) => near.reduce((sum, row, j) => sum + w[j] * row[k], 0));
}

/** The kernel of a track. @param {Track} track @returns {any} */
export function trackKernel(track) {
  const { names, pivots, rows } = track;
  const moving = names.length - pivots.length;
  const flat = (mu) => Math.min(mu, Math.PI - mu);
  const mus = (joints) => joints.row.slice(2 * moving, -4);
  return {
    track,
    solve(angle) {
      const row = rowAt(rows, angle);
      const places = [...pivots];
      for (let i = 0; i < moving; i += 1) places.push([row[2 * i], row[2 * i + 1]]);
      const at = (name) => places[names.indexOf(name)];
      return { C: at("C"), D: at("D"), P: at("P"), places, row };
    },
    mus,
    /** The transmission angle nearest to flat. */
    mu: (joints) => mus(joints).reduce((worst, mu) => (flat(mu) < flat(worst) ? mu : worst)),
    rates(joints, omega, alpha) {
      const [vx, vy, ax, ay] = joints.row.slice(-4);
      const along = (v, a) => a * omega * omega + v * alpha;
      return { vP: [vx * omega, vy * omega], aP: [along(vx, ax), along(vy, ay)], omega3: 0, omega4: 0 };
    },
  };
}

/** The corners of the convex hull of a few points. @param {Point[]} points */
export function hullOf(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain;
  };
  return [...half(sorted).slice(0, -1), ...half(sorted.reverse()).slice(0, -1)];
}
