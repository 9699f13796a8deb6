"""Evaluates four-bars on a problem, many at once: error, transmission angle, extent and the requirements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assignment import TURN, Samples, Windows, assigned, moved_between, refined
from linkage import (
    Array,
    Circuits,
    FourBars,
    bounding_box,
    circuits,
    closure,
    extent_of,
    path_and_rate,
    transmission_over_cycle,
    transmission_over_range,
    turns_fully,
    type_violation,
)
from problem import TURNING, Problem


@dataclass(frozen=True)
class Effort:
    """How finely motions are sampled, from how many places the order starts, how often places and boxes are refined.

    Where it is `thorough`, both directions are tried from all places, and the parameters are refined continuously.
    """

    samples: int
    cuts: int
    rounds: int
    box_samples: int
    zooms: int
    thorough: bool


# One evaluation of a search, and the figures that are reported.
SEARCH = Effort(samples=240, cuts=3, rounds=3, box_samples=240, zooms=0, thorough=False)
REPORT = Effort(samples=960, cuts=10, rounds=3, box_samples=960, zooms=5, thorough=True)


@dataclass
class Motions:
    """Where the linkages meet the targets (parameters t of their circuits, one column each), and how well."""

    on: Circuits
    t: Array
    rms: Array
    max_error: Array
    beyond_tolerance: Array
    low: Array
    high: Array


def structural(problem: Problem, bars: FourBars, on: Circuits, t: Array) -> tuple[Array, Array, Array]:
    """Returns rms, greatest error and the greatest excess over a tolerance at parameters t."""
    targets, weights, tolerance = problem.free_targets() if problem.timing is None else timed_targets(problem)
    off = np.abs(path_and_rate(bars, on, t)[0] - targets[:, None])
    rms = np.sqrt((weights[:, None] * off**2).sum(axis=0) / weights.sum())
    beyond = (off - tolerance[:, None]).max(axis=0) if tolerance is not None else np.full(len(rms), -np.inf)
    return rms, off.max(axis=0), beyond


def timed_targets(problem: Problem) -> tuple[Array, Array, Array | None]:
    """Returns all targets, each with weight 1, and the tolerances."""
    return problem.points, np.ones(len(problem.points)), problem.tolerance


def timed_motions(problem: Problem, bars: FourBars, t1: Array, offset: Array) -> Motions:
    """Returns the motions at the prescribed crank angles; of the allowed directions the better one."""
    timing = problem.timing
    assert timing is not None
    base = {"free": offset, "fixed": np.zeros_like(bars.a), "ground": np.angle(bars.B - bars.A)}[timing.offset]
    no = np.zeros(len(base))
    on = Circuits(no.astype(bool), no, no, t1.astype(float))
    rises = timing.crank_angles[-1] >= timing.crank_angles[0]
    free = timing.offset == "free"
    directions = [d for d in (1, -1) if not free or (d if rises else -d) in problem.require.directions]
    best: Motions | None = None
    for direction in directions if free else (1,):
        t = base + direction * timing.crank_angles[:, None]
        low, high = t.min(axis=0), t.max(axis=0)
        if problem.closed:
            high = np.maximum(high, low + TURN)
        found = Motions(on, t, *structural(problem, bars, on, t), low, high)
        if best is None:
            best = found
            continue
        better = found.rms < best.rms
        for name in ("t", "rms", "max_error", "beyond_tolerance", "low", "high"):
            setattr(best, name, np.where(better, getattr(found, name), getattr(best, name)))
    assert best is not None
    return best


def polished(bars: FourBars, on: Circuits, t: Array, goal: tuple[Array, Array], span: Array | None) -> Array:
    """Returns the parameters of every linkage refined continuously, in order."""
    done = np.empty_like(t)
    for i in range(t.shape[1]):
        one, circuit = bars[i : i + 1], on[i : i + 1]

        def curve(at: Array, one: FourBars = one, circuit: Circuits = circuit) -> tuple[Array, Array]:
            return path_and_rate(one, circuit, at)

        ends = None if span is None else (float(span[0][i]), float(span[1][i]))
        done[:, i] = refined(curve, t[:, i], *goal, ends)
    return done


def free_motions(problem: Problem, bars: FourBars, on: Circuits, cyclic: bool, effort: Effort) -> Motions:
    """Returns the motions with the best ordered assignment of the targets; `cyclic`: whole circuits are used."""
    targets, weights, _ = problem.free_targets()
    if cyclic:
        first, step = np.zeros(len(bars.a)), np.full(len(bars.a), TURN / effort.samples)
        span = None
    else:
        first = np.where(on.t1 > 0, -0.5 * np.pi, 0.5 * np.pi)
        step = np.full(len(bars.a), np.pi / (effort.samples - 1))
        span = np.array([first, first + np.pi])
    grid = first + step * np.arange(effort.samples)[:, None]
    samples = Samples(path_and_rate(bars, on, grid)[0], targets, weights)
    directions = problem.require.directions
    places = assigned(samples, Windows(cyclic, problem.returns, directions, effort.cuts, effort.thorough))
    ends = np.zeros((2, len(bars.a))) if span is None else span
    t = moved_between(
        lambda at: path_and_rate(bars, on, at), first + step * places, targets, ends, TURN * cyclic, effort.rounds
    )
    if effort.thorough:
        t = polished(bars, on, t, (targets, weights), span)
    low, high = (np.minimum(t[0], t[-1]), np.maximum(t[0], t[-1]))
    if problem.returns:
        low, high = t[0], t[0] + TURN
    return Motions(on, t, *structural(problem, bars, on, t), low, high)


def motions(problem: Problem, bars: FourBars, sides: tuple[Array, Array, Array], effort: Effort) -> Motions:
    """Returns the motions of linkages that can move as the problem needs; `sides` are t1, the arc, the offset."""
    t1, arc, offset = sides
    if problem.timing is not None:
        return timed_motions(problem, bars, t1, offset)
    on = circuits(bars, t1, arc)
    cyclic = ~on.rocks if not problem.require.branch_any else np.full(len(t1), True)
    if cyclic.all():
        return free_motions(problem, bars, on, True, effort)
    whole = Motions(on, np.zeros((len(problem.free_targets()[0]), len(t1))), *np.zeros((5, len(t1))))
    for kind in (True, False):
        chosen = np.flatnonzero(cyclic == kind)
        if len(chosen):
            part = free_motions(problem, bars[chosen], on[chosen], kind, effort)
            for name in ("t", "rms", "max_error", "beyond_tolerance", "low", "high"):
                getattr(whole, name)[..., chosen] = getattr(part, name)
    return whole


def allowed_types(problem: Problem) -> tuple[str, ...]:
    """Returns the types that serve: where the crank must turn fully, those of the required ones that do."""
    types = problem.require.types
    return tuple(kind for kind in types if kind in TURNING) if problem.must_turn else types


def shape_violations(problem: Problem, bars: FourBars) -> Array:
    """Returns the violations of all that depends on the lengths and pivots alone, in rows, each without a unit."""
    require, size = problem.require, problem.size
    kinds = [type_violation(bars, kind) for kind in allowed_types(problem)]
    rows = [np.min(kinds, axis=0) / size, bars.link_ratio / require.link_ratio_max - 1]
    if require.longest_max is not None:
        rows.append((bars.longest - require.longest_max) / size)
    angle = np.degrees(np.angle(bars.B - bars.A))
    values = {
        "Ax": bars.A.real,
        "Ay": bars.A.imag,
        "Bx": bars.B.real,
        "By": bars.B.imag,
        "a": bars.a,
        "b": bars.b,
        "c": bars.c,
        "d": bars.d,
        "e": bars.e,
        "ground": bars.ground,
        "coupler_x": bars.offset.real,
        "coupler_y": bars.offset.imag,
    }
    for key, (low, high) in problem.bounds.items():
        if key == "ground_angle_deg":
            middle = 0.5 * (low + high)
            near = angle + 360 * np.round((middle - angle) / 360)
            rows.append(np.maximum(low - near, near - high) / 90)
        else:
            rows.append(np.maximum(low - values[key], values[key] - high) / size)
    if require.pivots_in is not None:
        x0, y0, x1, y1 = require.pivots_in
        for pivot in (bars.A, bars.B):
            rows += [(x0 - pivot.real) / size, (pivot.real - x1) / size]
            rows += [(y0 - pivot.imag) / size, (pivot.imag - y1) / size]
    return np.array(rows)


@dataclass
class Figures:
    """The figures of linkages and how far they miss what is required: `violations` in rows, 0 or less where met."""

    rms: Array
    max_error: Array
    transmission_deg: Array
    extent: Array
    violations: Array
    t: Array


def figures_of_motion(problem: Problem, bars: FourBars, motion: Motions, effort: Effort) -> Figures:
    """Returns the figures over the motion used, with the violations of what depends on it."""
    require, size, on = problem.require, problem.size, motion.on
    cycle = transmission_over_cycle(bars)
    used = transmission_over_range(bars, on, motion.low, motion.high)
    over = {"cycle": np.full(len(cycle), True), "used": np.full(len(cycle), False), None: turns_fully(bars)}
    worst = np.where(over[require.transmission_over], cycle, used)
    box = bounding_box(bars, on, motion.low, motion.high, effort.box_samples, effort.zooms)
    extent = extent_of(box)
    rows = [np.clip(motion.beyond_tolerance / size, -1, 1)]
    if require.transmission_deg_min is not None:
        rows.append((require.transmission_deg_min - worst) / 90)
    if require.extent_max is not None:
        rows.append((extent - require.extent_max) / size)
    if require.footprint_in is not None:
        x0, y0, x1, y1 = require.footprint_in
        rows += list((np.array([x0, y0, -x1, -y1])[:, None] - box) / size)
    if problem.timing is not None:
        stops = motion.low + (motion.high - motion.low) * np.linspace(0, 1, 721)[:, None]
        # Rounding opens a loop that lies flat.
        rows.append(closure(bars, stops).max(axis=0) / size - 1e-12)
    return Figures(motion.rms, motion.max_error, worst, extent, np.array(rows), motion.t)


def evaluated(problem: Problem, bars: FourBars, sides: tuple[Array, Array, Array], effort: Effort) -> Figures:
    """Returns the figures of all linkages; one that cannot move as needed gets violations of 1 and poor figures."""
    shape = shape_violations(problem, bars)
    moves = shape[0] <= 0
    count = len(moves)
    chosen = np.flatnonzero(moves)
    if len(chosen) == 0:
        # One column, so that the number of rows is known.
        rows = motion_rows(problem)
        poor = np.full(count, 1e3 * problem.size)
        t = np.zeros((len(problem.points), count))
        return Figures(poor, poor, np.zeros(count), poor, np.vstack([shape, np.ones((rows, count))]), t)
    some = bars[chosen]
    motion = motions(problem, some, tuple(side[chosen] for side in sides), effort)
    part = figures_of_motion(problem, some, motion, effort)
    whole = Figures(
        *(np.full(count, 1e3 * problem.size) for _ in range(2)),
        np.zeros(count),
        np.full(count, 1e3 * problem.size),
        np.ones((len(part.violations), count)),
        np.zeros((len(part.t), count)),
    )
    for name in ("rms", "max_error", "transmission_deg", "extent", "violations", "t"):
        getattr(whole, name)[..., chosen] = getattr(part, name)
    whole.violations = np.vstack([shape, whole.violations])
    return whole


def motion_rows(problem: Problem) -> int:
    """Returns the number of rows of violations that depend on the motion."""
    require = problem.require
    one = [require.transmission_deg_min is not None, require.extent_max is not None, problem.timing is not None]
    return 1 + sum(one) + 4 * (require.footprint_in is not None)
