"""Assigns target points to parameters of the coupler curve, in order, so that the sum of squares is least.

Dynamic programming over samples of the curve gives the start, for many linkages at once; then the parameters move off
the samples. Targets that want to overtake one another share a parameter (pool adjacent violators, Ayer et al. 1955).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Array = np.ndarray
Curve = Callable[[Array], tuple[Array, Array]]

TURN = 2 * np.pi
# A sum of squares this near to its lower bound cannot be improved by another start or direction.
NEAR_ENOUGH = 1e-3


def prefix_minimum(values: Array, scratch: Array) -> tuple[Array, Array]:
    """Returns each row replaced by the least of the rows up to it, and the other of the two arrays.

    Doubling the reach of each row is faster here than `np.minimum.accumulate`.
    """
    reach = 1
    while reach < len(values):
        scratch[:reach] = values[:reach]
        np.minimum(values[reach:], values[:-reach], out=scratch[reach:])
        values, scratch = scratch, values
        reach *= 2
    return values, scratch


class Samples:
    """Samples of curves, (samples, linkages), and the targets in the same frame, in single precision."""

    def __init__(self, curve: Array, targets: Array, weights: Array) -> None:
        """Stores curve and targets, shifted to the targets' centre in units of their spread."""
        centre, unit = targets.mean(), max(float(np.abs(targets - targets.mean()).max()), 1e-300)
        scaled = (curve - centre) / unit
        # Far joints of hopeless linkages must not overflow.
        self.x = np.clip(scaled.real, -1e6, 1e6).astype(np.float32)
        self.y = np.clip(scaled.imag, -1e6, 1e6).astype(np.float32)
        self.targets = ((targets - centre) / unit).astype(np.complex64)
        self.weights = weights.astype(np.float32)

    def window(self, start: Array, direction: Array, chosen: Array) -> tuple[Array, Array]:
        """Returns the samples of the chosen linkages from `start` on, once around in a direction."""
        count = len(self.x)
        rows = (start + direction * np.arange(count)[:, None]) % count
        return self.x[rows, chosen], self.y[rows, chosen]

    def costs(self, x: Array, y: Array, j: int, out: Array, scratch: Array) -> Array:
        """Writes the weighted squared distances of target j from a window of samples."""
        np.subtract(x, self.targets[j].real, out=out)
        np.multiply(out, out, out=out)
        np.subtract(y, self.targets[j].imag, out=scratch)
        np.multiply(scratch, scratch, out=scratch)
        np.add(out, scratch, out=out)
        if self.weights[j] != 1:
            np.multiply(out, self.weights[j], out=out)
        return out

    def nearest(self, j: int) -> Array:
        """Returns the sample of each curve that is nearest to target j."""
        return self.costs(self.x, self.y, j, np.empty_like(self.x), np.empty_like(self.x)).argmin(axis=0)

    def lower_bound(self) -> Array:
        """Returns the sums of squares where every target takes its nearest sample, in whatever order."""
        out, scratch = np.empty_like(self.x), np.empty_like(self.x)
        rows = [self.costs(self.x, self.y, j, out, scratch).min(axis=0) for j in range(len(self.targets))]
        return np.sum(rows, axis=0)

    def least_sum(self, start: Array, direction: Array, order: Array, chosen: Array) -> Array:
        """Returns the least sums of squares of targets in `order` along windows."""
        x, y = self.window(start, direction, chosen)
        here, scratch, best = np.empty_like(x), np.empty_like(x), np.zeros_like(x)
        for j in order:
            np.add(best, self.costs(x, y, j, here, scratch), out=best)
            best, scratch = prefix_minimum(best, scratch)
        return best[-1]

    def traced(self, start: Array, direction: Array, order: Array, chosen: Array) -> Array:
        """Returns the steps along the windows, (targets, linkages), that give the least sums."""
        x, y = self.window(start, direction, chosen)
        scratch, bests = np.empty_like(x), []
        for j in order:
            here = self.costs(x, y, j, np.empty_like(x), scratch)
            if bests:
                np.add(here, bests[-1], out=here)
            best, scratch = prefix_minimum(here, scratch)
            bests.append(best)
        steps = np.empty((len(order), x.shape[1]), dtype=int)
        last = np.full(x.shape[1], len(x) - 1)
        for row in range(len(order) - 1, -1, -1):
            prefix = bests[row]
            last = (prefix <= prefix[last, np.arange(len(last))]).argmax(axis=0)
            steps[row] = last
        return steps


@dataclass(frozen=True)
class Windows:
    """The windows that are tried: `cyclic`, the samples go once around; `closed`, so do the targets.

    `cuts` is the number of starts. Unless `thorough`, the first start settles the direction.
    """

    cyclic: bool
    closed: bool
    directions: tuple[int, ...]
    cuts: int
    thorough: bool


def starts_of(samples: Samples, windows: Windows) -> list[tuple[Array, int]]:
    """Returns the windows' starts and the target that comes first in each.

    A closed target starts at the nearest sample of some of its targets; an open one anywhere before its first target.
    """
    count, linkages = samples.x.shape
    cuts = windows.cuts
    if not windows.cyclic:
        return [(np.zeros(linkages, dtype=int), 0)]
    number = len(samples.targets)
    if windows.closed:
        anchors = dict.fromkeys(round(k * number / cuts) % number for k in range(cuts))
        return [(samples.nearest(k), k) for k in anchors]
    nearest = samples.nearest(0)
    return [((nearest + round(k * count / cuts)) % count, 0) for k in range(cuts)]


class Choice:
    """The best window of each linkage so far: its sum, its option (start and first target) and its direction."""

    def __init__(self, samples: Samples) -> None:
        """Begins without any window."""
        linkages = samples.x.shape[1]
        self.samples = samples
        self.bound = samples.lower_bound() * (1 + NEAR_ENOUGH) + 1e-12
        self.least = np.full(linkages, np.inf, dtype=np.float32)
        self.option = np.zeros(linkages, dtype=int)
        self.direction = np.ones(linkages, dtype=int)

    def attempt(self, option: int, begin: Array, first: int, direction: Array) -> None:
        """Tries a window on all linkages that could still gain."""
        chosen = np.flatnonzero(self.least > self.bound)
        if len(chosen) == 0:
            return
        number = len(self.samples.targets)
        order = (first + np.arange(number)) % number
        total = self.samples.least_sum(begin[chosen], direction[chosen], order, chosen)
        better = total < self.least[chosen]
        gained = chosen[better]
        self.least[gained], self.option[gained] = total[better], option
        self.direction[gained] = direction[gained]


def assigned(samples: Samples, windows: Windows) -> Array:
    """Returns the sample numbers of the targets, (targets, linkages), monotone, beyond one turn where they pass it."""
    count, linkages = samples.x.shape
    number = len(samples.targets)
    choice = Choice(samples)
    options = starts_of(samples, windows)

    def begin_of(start: Array, direction: Array) -> Array:
        return start if windows.cyclic else np.where(direction > 0, 0, count - 1)

    for option, (start, first) in enumerate(options):
        tried = [np.full(linkages, d) for d in windows.directions]
        if option > 0 and not windows.thorough:
            tried = [choice.direction.copy()]
        for direction in tried:
            choice.attempt(option, begin_of(start, direction), first, direction)
    places = np.empty((number, linkages), dtype=int)
    for option, (start, first) in enumerate(options):
        chosen = np.flatnonzero(choice.option == option)
        if len(chosen):
            order = (first + np.arange(number)) % number
            direction = choice.direction[chosen]
            begin = begin_of(start, choice.direction)[chosen]
            steps = samples.traced(begin, direction, order, chosen)
            # Targets before the anchor belong to the end of the turn before.
            steps[order < first] -= count
            places[np.ix_(order, chosen)] = begin + direction * steps
    return places


def moved_between(curve: Curve, t: Array, targets: Array, span: Array, turn: float, rounds: int) -> Array:
    """Returns parameters moved towards the nearest places, each at most half-way to its neighbours.

    `span` bounds the parameters where `turn` is 0; else they wrap around after a turn.
    """
    direction = np.where(t[-1] < t[0], -1.0, 1.0)
    u = t * direction
    low_end, high_end = span
    for _ in range(rounds):
        P, rate = curve(u * direction)
        miss = P - targets[:, None]
        squared = np.maximum(rate.real**2 + rate.imag**2, 1e-300)
        step = -(miss.real * rate.real + miss.imag * rate.imag) / squared * direction
        if turn:
            before, after = u[-1:] - turn, u[:1] + turn
        else:
            ends = np.sort([low_end * direction, high_end * direction], axis=0)
            before, after = 2 * ends[:1] - u[:1], 2 * ends[1:] - u[-1:]
        padded = np.concatenate([before, u, after])
        middles = 0.5 * (padded[1:] + padded[:-1])
        u = np.clip(u + np.clip(step, -0.1, 0.1), middles[:-1], middles[1:])
    return u * direction


def newton_steps(curve: Curve, t: Array, centres: Array) -> Array:
    """Returns Newton steps towards the places of the curve that are nearest to `centres`."""
    width = 1e-6
    P, rate = curve(t)
    bend = (curve(t + width)[1] - curve(t - width)[1]) / (2 * width)
    miss = P - centres
    slope = (np.conj(rate) * miss).real
    gauss = np.abs(rate) ** 2
    full = gauss + (np.conj(bend) * miss).real
    return np.clip(-slope / np.maximum(np.where(full > 0.05 * gauss, full, gauss), 1e-300), -0.02, 0.02)


def settled(curve: Curve, u: Array, centres: Array, span: tuple[float, float]) -> Array:
    """Returns rising parameters after damped Newton steps, clipped to the span; each one's distance only falls."""
    off = np.abs(curve(u)[0] - centres)
    for _ in range(30):
        step = newton_steps(curve, u, centres)
        for _ in range(6):
            trial = np.clip(u + step, *span)
            there = np.abs(curve(trial)[0] - centres)
            worse = there > off
            if not worse.any():
                break
            step = np.where(worse, 0.25 * step, step)
        accepted = ~worse
        moved = np.abs(trial - u)[accepted]
        u, off = np.where(accepted, trial, u), np.where(accepted, there, off)
        if len(moved) == 0 or moved.max() < 1e-13 or (np.diff(u) < 0).any():
            return u
    return u


def pooled(curve: Curve, u: Array, targets: Array, weights: Array, span: tuple[float, float]) -> Array:
    """Returns rising parameters of least sum of squares from a rising start; violators share a parameter."""
    groups = [[j] for j in range(len(u))]
    place = u.copy()
    for _ in range(4 * len(u)):
        mass = np.array([weights[g].sum() for g in groups])
        centres = np.array([(weights[g] * targets[g]).sum() for g in groups]) / mass
        place = settled(curve, place, centres, span)
        if (np.diff(place) >= 0).all():
            break
        merged: list[list[int]] = []
        places: list[float] = []
        masses: list[float] = []
        for group, at, weight in zip(groups, place, mass, strict=True):
            merged, places, masses = [*merged, group], [*places, at], [*masses, weight]
            while len(merged) > 1 and places[-1] < places[-2]:
                both = masses[-2] + masses[-1]
                places[-2:] = [(masses[-2] * places[-2] + masses[-1] * places[-1]) / both]
                masses[-2:], merged[-2:] = [both], [merged[-2] + merged[-1]]
        groups, place = merged, np.array(places)
    refined = u.copy()
    for group, at in zip(groups, place, strict=True):
        refined[group] = at
    return refined


def refined(curve: Curve, t: Array, targets: Array, weights: Array, span: tuple[float, float] | None) -> Array:
    """Returns the parameters of one linkage's targets, refined from samples in order; never a worse sum.

    Without a span the parameters go around: of a closed target the order starts after its widest gap.
    """
    direction = -1.0 if t[-1] < t[0] else 1.0
    u = t * direction
    gaps = np.diff(np.append(u, u[0] + TURN))
    first = 0 if span else (int(gaps.argmax()) + 1) % len(u)
    order = (first + np.arange(len(u))) % len(u)
    lifted = np.where(np.arange(len(u)) < first, u + TURN, u)[order]

    def along(v: Array) -> tuple[Array, Array]:
        P, rate = curve(v * direction)
        return P, rate * direction

    limits = tuple(sorted(direction * end for end in span)) if span else (-np.inf, np.inf)
    goal, mass = targets[order], weights[order]

    def total(v: Array) -> float:
        return float((mass * np.abs(along(v)[0] - goal) ** 2).sum())

    best, least = lifted, total(lifted)
    for _ in range(3):
        trial = pooled(along, best, goal, mass, limits)
        found = total(trial)
        in_order = (np.diff(trial) >= 0).all() and trial[-1] - trial[0] <= TURN
        if not in_order or found >= least * (1 - 1e-10):
            break
        best, least = trial, found
    back = np.empty_like(best)
    back[order] = best
    return np.where(np.arange(len(u)) < first, back - TURN, back) * direction
