"""Computes positions and figures of four-bars, many at once: arrays whose last axis counts the linkages.

Fixed pivots A, B; crank A-C of length a; coupler C-D of length b; follower B-D of length c; coupler point P. The
motion has one parameter on each circuit: the crank angle phi itself where the crank turns fully, else psi with
phi = middle + half_width sin psi and t1 = sign cos psi, which passes both toggles smoothly.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

Array = np.ndarray


@dataclass(frozen=True)
class FourBars:
    """Four-bars by their pivots, lengths and coupler point: `offset` lies along and across C -> D, from C."""

    A: Array
    B: Array
    a: Array
    b: Array
    c: Array
    offset: Array

    def __getitem__(self, chosen: Array) -> FourBars:
        """Returns those that an index array or mask chooses."""
        return FourBars(*(getattr(self, field.name)[chosen] for field in fields(self)))

    @property
    def ground(self) -> Array:
        """Returns |AB|."""
        return np.abs(self.B - self.A)

    @property
    def links(self) -> Array:
        """Returns ground, a, b, c in rows."""
        return np.array([self.ground, self.a, self.b, self.c])

    @property
    def d(self) -> Array:
        """Returns |CP|."""
        return np.abs(self.offset)

    @property
    def e(self) -> Array:
        """Returns |DP|."""
        return np.abs(self.offset - self.b)

    @property
    def longest(self) -> Array:
        """Returns the greatest of ground, a, b, c, d, e."""
        return np.maximum(self.links.max(axis=0), np.maximum(self.d, self.e))

    @property
    def link_ratio(self) -> Array:
        """Returns the longest over the shortest of ground, a, b, c."""
        return self.links.max(axis=0) / self.links.min(axis=0)

    def keys(self, i: int) -> dict[str, float]:
        """Returns linkage i under the keys of a linkage file, without t1."""
        A, B, offset = self.A[i], self.B[i], self.offset[i]
        values = (A.real, A.imag, B.real, B.imag, self.a[i], self.b[i], self.c[i], self.d[i], self.e[i])
        keys = dict(zip(("Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e"), map(float, values), strict=True))
        return keys | {"t2": 1.0 if offset.imag >= 0 else -1.0}


@dataclass(frozen=True)
class Circuits:
    """The circuit of each linkage: t1 where the crank turns fully, else the arc of its crank angles."""

    rocks: Array
    middle: Array
    half_width: Array
    t1: Array

    def __getitem__(self, chosen: Array) -> Circuits:
        """Returns those that an index array or mask chooses."""
        return Circuits(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def crank(self, t: Array) -> tuple[Array, Array, Array]:
        """Returns the crank angle, its derivative and the sign t1 at parameters t."""
        if not self.rocks.any():
            return t, np.ones_like(t), self.t1
        sine, cosine = np.sin(t), np.cos(t)
        angle = np.where(self.rocks, self.middle + self.half_width * sine, t)
        rate = np.where(self.rocks, self.half_width * cosine, 1.0)
        return angle, rate, np.where(self.rocks, np.where(cosine >= 0, 1.0, -1.0), self.t1)


def four_bar(keys: dict[str, float]) -> FourBars:
    """Returns one four-bar from the keys of a linkage file."""
    b, d, e = keys["b"], keys["d"], keys["e"]
    along = (b * b + d * d - e * e) / (2 * b)
    offset = complex(along, keys["t2"] * np.sqrt(max(0.0, d * d - along * along)))
    pivots = [np.array([complex(keys[p + "x"], keys[p + "y"])]) for p in "AB"]
    return FourBars(*pivots, *(np.array([keys[k]]) for k in "abc"), np.array([offset]))


def joints(bars: FourBars, crank: Array, t1: Array) -> tuple[Array, Array, Array]:
    """Returns C, D, P at crank angles: D is where circles about C and B meet, left of C -> B for t1 = +1."""
    C = bars.A + bars.a * np.exp(1j * crank)
    V = bars.B - C
    span_sq = V.real**2 + V.imag**2
    along = 0.5 * (1 + (bars.b**2 - bars.c**2) / span_sq)
    height = np.sqrt(np.maximum(bars.b**2 / span_sq - along**2, 0.0))
    CD = V * (along + 1j * (t1 * height))
    return C, C + CD, C + CD * (bars.offset / bars.b)


def closure(bars: FourBars, crank: Array) -> Array:
    """Returns by how much the loop fails to close at crank angles, a length; 0 or less where it closes."""
    span = np.abs(bars.B - bars.A - bars.a * np.exp(1j * crank))
    return np.maximum(np.abs(bars.b - bars.c) - span, span - bars.b - bars.c)


def path_and_rate(bars: FourBars, on: Circuits, t: Array) -> tuple[Array, Array]:
    """Returns P and dP/dt at parameters t of the circuits."""
    crank, rate, t1 = on.crank(t)
    C, D, P = joints(bars, crank, t1)
    dC = 1j * (C - bars.A) * rate
    CD, BD = D - C, D - bars.B
    # The coupler keeps its length: <CD, D' - C'> = 0 with D' along i BD.
    across = CD.imag * BD.real - CD.real * BD.imag
    across = np.where(np.abs(across) < 1e-14 * bars.b * bars.c, 1e-14 * bars.b * bars.c, across)
    dD = 1j * BD * ((CD.real * dC.real + CD.imag * dC.imag) / across)
    return P, dC + (dD - dC) * (bars.offset / bars.b)


def transmission_deg(bars: FourBars, diagonal: Array) -> Array:
    """Returns min(mu, 180 - mu) in degrees where |CB| is `diagonal`."""
    near = np.maximum((diagonal - bars.b + bars.c) * (diagonal + bars.b - bars.c), 0.0)
    far = np.maximum((bars.b + bars.c - diagonal) * (bars.b + bars.c + diagonal), 0.0)
    mu = np.degrees(2 * np.arctan2(np.sqrt(near), np.sqrt(far)))
    return np.minimum(mu, 180 - mu)


def transmission_over_cycle(bars: FourBars) -> Array:
    """Returns the worst transmission angle over a full turn: the crank lies along the ground line."""
    ends = [transmission_deg(bars, span) for span in (np.abs(bars.ground - bars.a), bars.ground + bars.a)]
    return np.minimum(*ends)


def transmission_over_range(bars: FourBars, on: Circuits, low: Array, high: Array) -> Array:
    """Returns the worst transmission angle over parameters from low to high.

    It lies at an end, where the crank lies along the ground line, or at a toggle.
    """
    inner = [np.where(on.rocks, k * np.pi / 2, np.angle(bars.B - bars.A) + k * np.pi) for k in range(4)]
    stops = np.array([low, high, *(low + (t - low) % (2 * np.pi) for t in inner)])
    span = np.abs(bars.B - bars.A - bars.a * np.exp(1j * on.crank(stops)[0]))
    return np.where(stops <= np.maximum(high, low), transmission_deg(bars, span), 90.0).min(axis=0)


def type_violation(bars: FourBars, kind: str) -> Array:
    """Returns by how much the links miss a type, a length; 0 or less where they have it."""
    links = bars.links
    ordered = np.sort(links, axis=0)
    margin = ordered[1] + ordered[2] - ordered[0] - ordered[3]
    if kind == "triple-rocker":
        open_by = ordered[3] - ordered[:3].sum(axis=0)
        return np.maximum(margin, open_by)
    shortest = {"double-crank": 0, "crank-rocker": 1, "double-rocker": 2, "rocker-crank": 3}[kind]
    others = np.delete(links, shortest, axis=0)
    return np.maximum(np.maximum(-margin, 0.0), links[shortest] - others.min(axis=0))


def turns_fully(bars: FourBars) -> Array:
    """Returns whether the crank turns fully."""
    return np.minimum(type_violation(bars, "crank-rocker"), type_violation(bars, "double-crank")) <= 0


def circuits(bars: FourBars, t1: Array, arc: Array) -> Circuits:
    """Returns the circuit with sign t1 or, where the crank rocks on two arcs, the one on side `arc` of the ground."""
    g, a, b, c = bars.links
    rocks = ~turns_fully(bars)

    def from_ground(span: Array) -> Array:
        return np.arccos(np.clip((g * g + a * a - span * span) / (2 * g * a), -1.0, 1.0))

    near, far = np.abs(b - c), b + c
    low = np.where(near > np.abs(g - a), from_ground(near), 0.0)
    high = np.where(far < g + a, from_ground(far), np.pi)
    two = (low > 0) & (high < np.pi)
    ground = np.angle(bars.B - bars.A)
    middle = np.where(two, ground + arc * 0.5 * (low + high), np.where(low > 0, ground + np.pi, ground))
    half = np.where(two, 0.5 * (high - low), np.where(low > 0, np.pi - low, high))
    return Circuits(rocks, middle, half, t1.astype(float))


def bounding_box(bars: FourBars, on: Circuits, low: Array, high: Array, samples: int, zooms: int) -> Array:
    """Returns [xmin, ymin, -xmax, -ymax] of A, B, C, D, P over parameters from low to high.

    Each extreme of the samples is refined: by the parabola through its neighbours, or by `zooms` finer samplings.
    """
    width = high - low
    step = width / samples
    t = low + width * np.linspace(0, 1, samples + 1)[:, None]
    crank, _, t1 = on.crank(t)
    moving = joints(bars, crank, t1)
    rows = []
    for side in (1, 1j, -1, -1j):
        reach = [(np.conj(side) * pivot).real for pivot in (bars.A, bars.B)]
        for number, joint in enumerate(moving):
            along = (np.conj(side) * joint).real
            best = along.argmin(axis=0)
            if zooms == 0:
                reach.append(vertex(along, best))
                continue
            middle, finer = t[best, np.arange(len(best))], step
            for _ in range(zooms):
                fine = np.clip(middle + finer * np.linspace(-1, 1, 21)[:, None], low, high)
                fine_crank, _, fine_t1 = on.crank(fine)
                along = (np.conj(side) * joints(bars, fine_crank, fine_t1)[number]).real
                middle = fine[along.argmin(axis=0), np.arange(len(best))]
                finer = finer / 10
            reach.append(along.min(axis=0))
        rows.append(np.min(reach, axis=0))
    return np.array(rows)


def vertex(values: Array, least: Array) -> Array:
    """Returns the minimum of the parabolas through the least samples and their neighbours; ends stay as they are."""
    columns = np.arange(values.shape[1])
    middle = np.clip(least, 1, len(values) - 2)
    before, here, after = (values[middle + k, columns] for k in (-1, 0, 1))
    bend = np.maximum(before - 2 * here + after, 1e-300)
    lowest = here - (after - before) ** 2 / (8 * bend)
    return np.where(middle == least, lowest, values[least, columns])


def extent_of(box: Array) -> Array:
    """Returns the diagonal of a box [xmin, ymin, -xmax, -ymax]."""
    return np.hypot(box[0] + box[2], box[1] + box[3])
