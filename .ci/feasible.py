"""Writes problems that a known four-bar solves, runs them, and recomputes what is accepted.

A random four-bar traces a curve. Its targets are taken from the curve and moved so that the four-bar's largest error
is 0.9 of the tolerance; its footprint lies within 1 % of each side of the box, and its least transmission angle 1
degree above the limit. Three classes, a third of the problems each:

- coarse: targets scattered about any curve, tolerance 0.1 % to 1 % of the size;
- fine: the same, tolerance 0.01 % to 0.1 % of the size;
- straight: targets on a straight line that a stretch of the curve follows.

Usage: feasible.py PROGRAM FOLDER SEED
"""
import cmath
import json
import math
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

EACH = 20
LEAST_ACCEPTED = 57
# The targets' extent in the files.
SIZE = 150


class FourBar:
    """Ground 1; z is the coupler point in the coupler's frame."""

    def __init__(self, A, B, a, b, c, z, t1):
        self.A, self.B, self.a, self.b, self.c, self.z, self.t1 = A, B, a, b, c, z, t1

    @staticmethod
    def random(rng):
        length = lambda: math.exp(rng.uniform(math.log(0.25), math.log(3)))
        B = cmath.rect(1, rng.uniform(-math.pi, math.pi))
        a, b, c = length(), length(), length()
        z = complex(rng.gauss(0.5, 0.8), rng.gauss(0, 0.8))
        return FourBar(0, B, a, b, c, z, rng.choice([1, -1]))

    def joints(self, phi, t1=None):
        """C, D, P at a crank angle; None where the loop does not close."""
        C = self.A + cmath.rect(self.a, phi)
        V = self.B - C
        s = abs(V)
        if s == 0:
            return None
        along = (s * s + self.b**2 - self.c**2) / (2 * s)
        k = self.b**2 - along**2
        if k < 0:
            return None
        D = C + V / s * complex(along, (t1 or self.t1) * math.sqrt(k))
        return C, D, C + (D - C) / self.b * self.z

    def transmission(self, C, D):
        mu = abs(math.degrees(cmath.phase((D - C) / (D - self.B))))
        return min(mu, 180 - mu)

    def fits_default_bounds(self, size):
        links = [abs(self.B - self.A), self.a, self.b, self.c]
        return (
            max(links) <= 4.5 * size
            and min(links) >= 0.03 * size
            and max(links) <= 18 * min(links)
            and abs(self.z) <= 4.5 * size
        )


def box(points):
    x, y = [z.real for z in points], [z.imag for z in points]
    return min(x), min(y), max(x), max(y)


def extent(points):
    x0, y0, x1, y1 = box(points)
    return math.hypot(x1 - x0, y1 - y0)


def scattered(rng, tolerances):
    """Targets about a stretch of a random curve, or about the whole of one that is closed."""
    four = FourBar.random(rng)
    start = rng.uniform(-math.pi, math.pi)
    if four.joints(start) is None:
        return None
    step = math.radians(0.5)
    turns = all(four.joints(start + i * step) for i in range(720))
    closed = turns and rng.random() < 0.4
    if closed:
        span = 2 * math.pi
    elif turns:
        span = math.radians(rng.uniform(40, 300))
    else:
        back = ahead = 0
        while four.joints(start + (ahead + 1) * step):
            ahead += 1
        while four.joints(start - (back + 1) * step):
            back += 1
        u, v = sorted((rng.random(), rng.random()))
        start, span = start + (u * (back + ahead) - back) * step, (v - u) * (back + ahead) * step
        if span < math.radians(20):
            return None
    motion = [four.joints(start + span * i / 2000) for i in range(2001)]
    if None in motion:
        return None
    curve = [p[2] for p in motion]
    arc = [0]
    for p, q in zip(curve, curve[1:]):
        arc.append(arc[-1] + abs(q - p))
    n = rng.randint(8, 40)
    targets, j = [], 0
    for i in range(n):
        while j < 2000 and arc[j] < arc[-1] * i / (n if closed else n - 1):
            j += 1
        targets.append(curve[j])
    size = extent(targets)
    tolerance = size * math.exp(rng.uniform(*map(math.log, tolerances)))
    moves = [complex(rng.gauss(0, 1), rng.gauss(0, 1)) for _ in targets]
    most = max(map(abs, moves))
    targets = [z + w / most * 0.9 * tolerance for z, w in zip(targets, moves)]
    if any(abs(p - q) < 1e-6 * size for p, q in zip(targets, targets[1:])):
        return None
    used = not turns or rng.random() < 2 / 3
    over = motion if used else [four.joints(i * step) for i in range(720)]
    return four, motion, over, targets, tolerance, closed, used


def straight(rng):
    """Targets on the longest stretch of a random curve that is straight to a drawn part of its length."""
    four = FourBar.random(rng)
    N = 360
    turn = [four.joints(2 * math.pi * i / N) for i in range(N)]
    part = math.exp(rng.uniform(math.log(3e-4), math.log(3e-3)))
    best = None
    for first in range(0, N, 6):
        run = []
        while len(run) < N and turn[(first + len(run)) % N]:
            run.append(turn[(first + len(run)) % N][2])
        for m in range(18, min(len(run), 200), 4):
            length = abs(run[m - 1] - run[0])
            if length < 0.1:
                continue
            u = (run[m - 1] - run[0]) / length
            placed = [(z - run[0]) / u for z in run[:m]]
            if any(q.real <= p.real for p, q in zip(placed, placed[1:])):
                break
            low, high = min(z.imag for z in placed), max(z.imag for z in placed)
            if high - low <= 2 * part * length and (best is None or length > best[0]):
                best = length, first, m, run[0] + 0.5j * (low + high) * u, u
    if best is None:
        return None
    length, first, m, begin, u = best
    start, span = 2 * math.pi * first / N, 2 * math.pi * (m - 1) / N
    motion = [four.joints(start + span * i / 4000) for i in range(4001)]
    if None in motion:
        return None
    n = rng.randint(8, 30)
    targets = [begin + u * length * i / (n - 1) for i in range(n)]
    error = max(min(abs(z - p[2]) for p in motion) for z in targets)
    return four, motion, motion, targets, error / 0.9, False, True


def problem(rng, draw):
    while True:
        drawn = draw(rng)
        if drawn is None:
            continue
        four, motion, over, targets, tolerance, closed, used = drawn
        size = extent(targets)
        least = min(four.transmission(C, D) for C, D, _ in over)
        if size == 0 or least < 16 or not four.fits_default_bounds(size):
            continue
        x0, y0, x1, y1 = box([z for p in motion for z in p] + [four.A, four.B])
        room = complex(0.01 * (x1 - x0), 0.01 * (y1 - y0))
        scale = SIZE / size
        shift = complex(rng.uniform(-200, 200), rng.uniform(-200, 200))
        placed = lambda z: [round((z * scale + shift).real, 9), round((z * scale + shift).imag, 9)]
        return {
            "points": [placed(z) for z in targets],
            "closed": closed,
            "tolerance": round(tolerance * scale, 9),
            "transmission_deg_min": round(least - 1, 6),
            "transmission_over": "used" if used else "cycle",
            "footprint_in": placed(complex(x0, y0) - room) + placed(complex(x1, y1) + room),
        }


def text(p):
    return (
        f'format = 1\n[task.path]\npoints = {p["points"]}\nclosed = {str(p["closed"]).lower()}\n'
        f'tolerance = {p["tolerance"]}\n[require]\ntransmission_deg_min = {p["transmission_deg_min"]}\n'
        f'transmission_over = "{p["transmission_over"]}"\nfootprint_in = {p["footprint_in"]}\n'
    )


def complaint(p, candidate):
    """Something that an accepted candidate does not keep to, by this file's own kinematics; None: nothing."""
    given = candidate["linkage"]
    A, B = complex(*given["A"]), complex(*given["B"])
    along = (given["b"] ** 2 + given["d"] ** 2 - given["e"] ** 2) / (2 * given["b"])
    z = complex(along, given["t2"] * math.sqrt(max(0, given["d"] ** 2 - along**2)))
    four = FourBar(A, B, given["a"], given["b"], given["c"], z, given["t1"])
    angles = [math.radians(deg) for deg in candidate["crank_deg"]]
    assemblies = candidate["t1_at"]
    if len(set(assemblies)) > 1:
        return "two branches"
    at = [four.joints(phi, t1) for phi, t1 in zip(angles, assemblies)]
    if None in at:
        return "open"
    for i, (joints, target) in enumerate(zip(at, p["points"])):
        if abs(joints[2] - complex(*target)) > p["tolerance"] * (1 + 1e-6):
            return f"error at point {i}"
    turns = all(four.joints(2 * math.pi * i / 720, assemblies[0]) for i in range(720))
    if p["closed"] and not turns:
        return "does not turn fully"
    low, high = (0, 2 * math.pi) if p["closed"] else (min(angles), max(angles))
    motion = at + [four.joints(low + (high - low) * i / 720, assemblies[0]) for i in range(721)]
    motion = [joints for joints in motion if joints]
    reach = box([z for joints in motion for z in joints] + [A, B])
    slack = 1e-5 * SIZE
    for value, limit, sign in zip(reach, p["footprint_in"], (1, 1, -1, -1)):
        if sign * (value - limit) < -slack:
            return f"footprint {value} beyond {limit}"
    over = motion
    if p["transmission_over"] == "cycle":
        over = [four.joints(2 * math.pi * i / 720, assemblies[0]) for i in range(720)]
        over = [joints for joints in over if joints]
    worst = min(four.transmission(C, D) for C, D, _ in over)
    if worst < p["transmission_deg_min"] - 1e-4:
        return f"transmission angle {worst}"
    return None


def main(program, folder, seed):
    rng = random.Random(seed)
    classes = [
        ("coarse", lambda rng: scattered(rng, (1e-3, 1e-2))),
        ("fine", lambda rng: scattered(rng, (1e-4, 1e-3))),
        ("straight", straight),
    ]
    jobs = [(f"{name}-{i + 1}", problem(rng, draw)) for name, draw in classes for i in range(EACH)]

    def run(job):
        name, p = job
        file = folder / f"{name}.toml"
        file.write_text(text(p))
        command = [program, "synth", file, "--out", folder / name, "--json", "--quiet", "--threads", "1"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"{name}: exit {done.returncode}: {done.stderr}")
        record = json.loads(done.stdout)
        accepted = [c for c in record["candidates"] if c["accepted"]]
        bad = [why for why in (complaint(p, c) for c in accepted) if why]
        return name, bool(accepted), record.get("conflict"), bad, record["termination"]["reason"]

    accepted, faults = 0, []
    with ThreadPoolExecutor(2) as pool:
        for name, fine, conflict, bad, reason in pool.map(run, jobs):
            accepted += fine
            if not fine:
                print(f"{name}: not solved ({reason})")
            if conflict:
                faults.append(f"{name}: names a conflict that there is not: {conflict['among']}")
            faults += [f"{name}: accepted, but: {why}" for why in bad]
    print(f"feasible problems: {accepted} of {len(jobs)} solved")
    if accepted < LEAST_ACCEPTED:
        faults.append(f"{accepted} solved, {LEAST_ACCEPTED} are asked for")
    sys.exit("\n".join(faults) if faults else 0)


main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]))
