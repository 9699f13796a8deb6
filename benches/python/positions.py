"""Compares positions and searches from Python with the library's own times, NumPy and pylinkage. One thread, one run.

    pip install ./python pylinkage numba
    python benches/python/positions.py

Every answer is checked before it is timed. Times are the least of several, interleaved; processor time is given, which a
busy machine changes less than the time of a clock.
"""

from __future__ import annotations

import functools
import operator
import os
import statistics
import sys
import time
from collections.abc import Callable

# One thread for everything.
os.environ.update(OMP_NUM_THREADS="1", NUMBA_NUM_THREADS="1", RAYON_NUM_THREADS="1")

import numpy as np

import linkwright as lw
from linkwright import _linkwright

N = 1_000_000
LINKAGE = lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5, t1=1, t2=1)


def textbook(linkage: lw.FourBar, phi: np.ndarray) -> tuple[np.ndarray, ...]:
    """C, D and P by the usual closed form (Norton, Design of Machinery: Freudenstein's equation, the quadratic in the
    half-angle of the follower), vectorised with NumPy."""
    (ax, ay), (bx, by) = linkage.A, linkage.B
    a, b, c, g = linkage.a, linkage.b, linkage.c, linkage.ground
    ground = np.arctan2(by - ay, bx - ax)
    theta2 = phi - ground
    k1, k2, k3 = g / a, g / c, (a * a - b * b + c * c + g * g) / (2 * a * c)
    cos, sin = np.cos(theta2), np.sin(theta2)
    p, q, r = cos - k1 - k2 * cos + k3, -2 * sin, k1 - (k2 + 1) * cos + k3
    theta4 = 2 * np.arctan2(-q - linkage.t1 * np.sqrt(q * q - 4 * p * r), 2 * p) + ground
    cx, cy = ax + a * np.cos(phi), ay + a * np.sin(phi)
    dx, dy = bx + c * np.cos(theta4), by + c * np.sin(theta4)
    theta3 = np.arctan2(dy - cy, dx - cx)
    beta = linkage.t2 * np.arccos((b * b + linkage.d**2 - linkage.e**2) / (2 * b * linkage.d))
    return cx, cy, dx, dy, cx + linkage.d * np.cos(theta3 + beta), cy + linkage.d * np.sin(theta3 + beta)


def of_pylinkage(linkage: lw.FourBar, step: float):  # noqa: ANN201
    """The same linkage in pylinkage."""
    from pylinkage.actuators import Crank
    from pylinkage.components import Ground
    from pylinkage.dyads import FixedDyad, RRRDyad
    from pylinkage.simulation import Linkage

    a, b = Ground(*linkage.A, name="A"), Ground(*linkage.B, name="B")
    crank = Crank(anchor=a, radius=linkage.a, angular_velocity=step, initial_angle=0.0, name="C")
    at = linkage.positions(0.0)
    rocker = RRRDyad(anchor1=crank.output, anchor2=b, distance1=linkage.b, distance2=linkage.c, name="D")
    beta = linkage.t2 * np.arccos((linkage.b**2 + linkage.d**2 - linkage.e**2) / (2 * linkage.b * linkage.d))
    plate = FixedDyad(anchor1=crank.output, anchor2=rocker, distance=linkage.d, angle=float(beta), name="P")
    made = Linkage([a, b, crank, rocker, plate], name="four-bar")
    start = [linkage.A, linkage.B, tuple(at.C), tuple(at.D), tuple(at.P)]
    made.set_coords([tuple(map(float, point)) for point in start])
    return made, start


def best(calls: dict[str, Callable[[], object]], rounds: int) -> dict[str, float]:
    """Returns the least processor time of each call, interleaved."""
    least = dict.fromkeys(calls, float("inf"))
    for _ in range(rounds):
        for name, call in calls.items():
            begun = time.process_time()
            call()
            least[name] = min(least[name], time.process_time() - begun)
    return least


def positions() -> bool:
    """Compares positions of a million crank angles."""
    step = 1e-5
    phi = step * np.arange(1, N + 1)
    at = LINKAGE.positions(phi)
    columns = np.concatenate([at.C, at.D, at.P], axis=1).T
    assert np.allclose(np.stack(textbook(LINKAGE, phi)), columns, rtol=0, atol=1e-9)
    seconds, total = _linkwright._time_positions(LINKAGE, phi)
    # Added in the same order: the same digits.
    assert seconds > 0 and total == functools.reduce(operator.add, at.P[:, 0].tolist(), 0.0)
    calls: dict[str, Callable[[], object]] = {
        "linkwright": lambda: LINKAGE.positions(phi),
        "NumPy, the textbook's closed form": lambda: textbook(LINKAGE, phi),
    }
    least = best(calls, 15)
    least["Rust, FourBar::position one at a time"] = min(
        _linkwright._time_positions(LINKAGE, phi)[0] for _ in range(15)
    )
    try:
        least |= with_pylinkage(phi, step)
    except ImportError:
        print("pylinkage is not there: pip install pylinkage numba", file=sys.stderr)
    own = least["linkwright"]
    print(f"\n| positions of {N:,} angles, one thread | ns an angle | times linkwright |\n| --- | ---: | ---: |")
    for name, found in sorted(least.items(), key=lambda pair: pair[1]):
        print(f"| {name} | {1e9 * found / N:.1f} | {found / own:.1f} |")
    wanted = {"NumPy, the textbook's closed form": 12, "pylinkage with numba": 25, "pylinkage without numba": 200}
    met = [least[name] >= factor * own for name, factor in wanted.items() if name in least]
    return all(met) and own <= 1.5 * least["Rust, FourBar::position one at a time"]


def with_pylinkage(phi: np.ndarray, step: float) -> dict[str, float]:
    """Returns the times of pylinkage: with numba the whole sweep, without it a two-hundredth of it, scaled."""
    made, start = of_pylinkage(LINKAGE, step)
    made.compile()
    found = made.step_fast(N, dt=1)
    at = LINKAGE.positions(phi)
    # Its angle is summed up step by step.
    assert np.allclose(found[:, 4], at.P, rtol=0, atol=1e-6), np.abs(found[:, 4] - at.P).max()

    def fast() -> None:
        made.set_coords([tuple(map(float, point)) for point in start])
        made.step_fast(N, dt=1)

    few = N // 200

    def slow() -> None:
        made.set_coords([tuple(map(float, point)) for point in start])
        for _ in made.step(few, dt=1):
            pass

    least = best({"pylinkage with numba": fast, "pylinkage without numba": slow}, 5)
    least["pylinkage without numba"] *= N / few
    return least


def searches() -> bool:
    """Compares 200 searches one after the other with the library's own time; and the overhead of a call."""
    problem = lw.load_problem(os.path.join(os.path.dirname(__file__), "../../problems/literature/k18.toml"))
    assert str(lw.synth(problem, threads=1).candidates[0].error["sum_sq"]).startswith("0.009028884630")
    times, rounds = 40, 5
    pairs = []
    for _ in range(rounds):
        rust = _linkwright._time_synth(problem, times, 1)
        begun = time.perf_counter()
        for _ in range(times):
            lw.synth(problem, threads=1)
        pairs.append((rust, time.perf_counter() - begun))
    rust, python = (min(side) for side in zip(*pairs))
    found = python / rust
    print(f"\n{times * rounds} searches of K18, one after the other: {found:.3f} times the library's time "
          f"({1e3 * rust / times:.2f} ms each there)")
    short = lw.path([[0, 0], [1, 1]], solve={"evaluations": 1, "candidates": 1, "advice": False})
    overheads = []
    for _ in range(30):
        rust = _linkwright._time_synth(short, 20, 1) / 20
        begun = time.perf_counter()
        for _ in range(20):
            lw.synth(short, threads=1)
        overheads.append((time.perf_counter() - begun) / 20 - rust)
    print(f"overhead of a call: {1e6 * min(overheads):.0f} us at the least, {1e6 * statistics.median(overheads):.0f} us "
          "in the median")
    return found <= 1.1


if __name__ == "__main__":
    ends = [positions(), searches()]
    sys.exit(0 if all(ends) else 1)
