"""Tests the evaluator of the comparison against known answers: python benches/front/selftest.py."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np

from assignment import Samples, Windows, assigned, refined
from check import best_offset
from evaluate import REPORT, SEARCH, evaluated
from linkage import FourBars, circuits, extent_of, four_bar, joints, path_and_rate
from problem import Problem, read_problem

ROOT = Path(__file__).resolve().parents[2]
K18 = ROOT / "problems/literature/k18.toml"
EGG = ROOT / "benches/front/egg.toml"
# A crank-rocker within the egg's default bounds.
BARS = FourBars(*(np.array([v]) for v in (10 + 5j, 110 + 40j, 40.0, 120.0, 90.0, 70 + 50j)))


def sum_sq(problem: Problem, bars: FourBars, t1: float) -> float:
    """Returns the sum of squares of a timed problem at the best offset."""
    offset = best_offset(problem, bars, t1)
    found = evaluated(problem, bars, (np.array([t1]), np.ones(1), np.array([offset])), REPORT)
    return float(found.rms[0] ** 2 * len(problem.points))


def test_timed_sums_are_the_known_ones() -> None:
    """The known optimum and the published vectors of the eighteen points have their stated sums."""
    problem, expect = read_problem(K18), tomllib.loads(K18.read_text())["expect"]
    best = {"Ax": 0.548308, "Ay": 0.716512, "Bx": 1.279137, "By": 0.450796}
    best |= {"a": 0.312749, "b": 0.441900, "c": 0.674564, "d": 0.356901, "e": 0.598917, "t2": -1.0}
    # The keys are printed with six digits.
    assert abs(sum_sq(problem, four_bar(best), -1.0) / expect["best_known_sum_sq"] - 1) < 1e-7
    for published in expect["published"]:
        ground, a, b, c, x, y, x0, y0, angle = published["vector"]
        A = complex(x0, y0)
        parts = (A, A + ground * np.exp(1j * angle), a, b, c, complex(x, y))
        bars = FourBars(*(np.array([part]) for part in parts))
        assert abs(sum_sq(problem, bars, published["t1"]) / published["recomputed_sum_sq"] - 1) < 1e-9


def test_points_of_a_curve_are_met() -> None:
    """Points of a linkage's own curve, from any start and in either direction, are met to rounding."""
    problem = read_problem(EGG)
    on = circuits(BARS, np.ones(1), np.ones(1))
    for start, direction in ((0.3, 1), (2.0, -1), (5.9, 1)):
        angles = start + direction * 2 * np.pi * np.arange(40)[:, None] / 40
        own = replace(problem, points=path_and_rate(BARS, on, angles)[0][:, 0])
        found = evaluated(own, BARS, (np.ones(1), np.ones(1), np.zeros(1)), REPORT)
        assert found.rms[0] < 1e-11 * own.size
        assert evaluated(own, BARS, (np.ones(1), np.ones(1), np.zeros(1)), SEARCH).rms[0] < 1e-3 * own.size


def test_order_is_kept_at_the_least_cost() -> None:
    """The assignment of targets out of order equals an exhaustive search, and refining only lowers it."""
    rng = np.random.default_rng(1)
    on = circuits(BARS, np.ones(1), np.ones(1))
    grid = 2 * np.pi * np.arange(12)[:, None] / 12
    curve = path_and_rate(BARS, on, grid)[0]
    for _ in range(5):
        targets = curve[[1, 5, 3, 7], 0] + rng.normal(0, 5, 4) + 1j * rng.normal(0, 5, 4)
        samples = Samples(curve, targets, np.ones(4))
        places = assigned(samples, Windows(True, False, (1, -1), 12, True))[:, 0]
        off = np.abs(curve[:, 0] - targets[:, None]) ** 2
        steps_of_all = combinations_with_replacement(range(12), 4)
        least = min(
            off[range(4), (begin + way * np.array(steps)) % 12].sum()
            for steps in steps_of_all
            for begin in range(12)
            for way in (1, -1)
        )
        got = off[range(4), places % 12].sum()
        assert got <= least * (1 + 2e-3)
        t = refined(lambda at: path_and_rate(BARS, on, at), places * grid[1, 0], targets, np.ones(4), None)
        assert (np.abs(path_and_rate(BARS, on, t)[0] - targets) ** 2).sum() <= got
        assert (np.diff(t) >= 0).all() or (np.diff(t) <= 0).all()


def test_rates_and_extents_agree_with_dense_samples() -> None:
    """dP/dt equals a central difference, on a rocking crank too; the extent equals that of dense samples."""
    rocking = FourBars(*(np.array([v]) for v in (0j, 100 + 0j, 90.0, 50.0, 80.0, 30 + 20j)))
    for bars in (BARS, rocking):
        on = circuits(bars, np.ones(1), np.ones(1))
        t = np.linspace(0.1, 6.0, 31)[:, None]
        difference = (path_and_rate(bars, on, t + 1e-6)[0] - path_and_rate(bars, on, t - 1e-6)[0]) / 2e-6
        assert np.abs(path_and_rate(bars, on, t)[1] - difference).max() < 1e-6 * np.abs(difference).max()
    points = np.array([BARS.A[0], BARS.B[0], *np.ravel(joints(BARS, np.linspace(0, 2 * np.pi, 400_001)[:, None], 1.0))])
    box = [points.real.min(), points.imag.min(), -points.real.max(), -points.imag.max()]
    for effort, agrees in ((REPORT, 1e-9), (SEARCH, 1e-5)):
        found = evaluated(read_problem(EGG), BARS, (np.ones(1), np.ones(1), np.zeros(1)), effort)
        assert abs(found.extent[0] / extent_of(np.array(box)) - 1) < agrees


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print(f"{name}: holds")
