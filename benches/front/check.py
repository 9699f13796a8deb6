"""Checks the members of a front by simulation: every figure of `front.csv` and every requirement of the problem."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from assignment import TURN
from evaluate import (
    REPORT,
    Figures,
    Motions,
    evaluated,
    figures_of_motion,
    shape_violations,
    structural,
    timed_motions,
)
from linkage import Array, Circuits, FourBars, circuits, four_bar
from problem import Problem

# Figures agree within this part of their value; requirements are met within it, in units of their scale.
AGREES = 1e-6
# Transmission angles also agree where sin^2(mu / 2), which is what the lengths give, does up to their rounding: at a
# change point one in the last digit of a length is some 1e-6 degrees.
ROUNDING = 1e-14
# The error of the best assignment may exceed the printed one by this part, and by this part of the size.
RMS_PART, RMS_TINY = 1e-3, 1e-12
KEYS = ("Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e", "t1", "t2")
AXES = ("rms", "transmission_deg", "extent")
FIGURES = ("rms", "max", "transmission_deg", "extent", "longest", "link_ratio")


@dataclass
class Row:
    """A row of `front.csv`: its figures, the linkage's keys and, where the record has them, the crank angles."""

    kind: str
    figures: dict[str, float]
    keys: dict[str, float]
    crank_deg: list[float] | None = None
    t1_at: list[float] | None = None

    @property
    def axes(self) -> tuple[float, float, float]:
        """Returns log10 rms, minus transmission angle and extent: all to be small."""
        rms, transmission, extent = (self.figures[name] for name in AXES)
        return float(np.log10(max(rms, 1e-300))), -transmission, extent


def plain_key(name: str) -> str:
    """Returns a column's name in the spelling used here: A.x, A_x and A[0] are Ax."""
    letters = re.sub(r"[^A-Za-z0-9]", "", name) if name[:1] in "AB" else name
    return {"A0": "Ax", "A1": "Ay", "B0": "Bx", "B1": "By"}.get(letters, letters)


def front_rows(folder: Path) -> list[Row]:
    """Reads the rows of `front.csv`, with crank angles from `record.json` where it has some for the same linkage."""
    lines = (folder / "front.csv").read_text(encoding="utf-8").splitlines()
    rows = []
    for raw in csv.DictReader(line for line in lines if not line.startswith("#")):
        cells = {plain_key(name): text for name, text in raw.items() if name}
        figures = {name: float(cells[name]) for name in FIGURES}
        kind = cells.get("kind", "four-bar")
        keys = {key: float(cells[key]) for key in KEYS} if kind == "four-bar" else {}
        rows.append(Row(kind, figures, keys))
    record = folder / "record.json"
    timed = list(candidates_in(json.loads(record.read_text()).get("front"))) if record.exists() else []
    for row in rows:
        for candidate in timed:
            if row.keys and same_linkage(row.keys, candidate["linkage"]):
                row.crank_deg, row.t1_at = candidate["crank_deg"], candidate.get("t1_at")
    return rows


def candidates_in(part: Any) -> Iterator[dict]:
    """Yields every candidate with a linkage and crank angles in a part of a record, however deep."""
    if isinstance(part, dict):
        if "linkage" in part and "crank_deg" in part:
            yield part
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            yield from candidates_in(inner)


def same_linkage(keys: dict[str, float], linkage: dict) -> bool:
    """Returns whether a record's linkage has the same keys."""
    if "A" not in linkage:
        return False
    flat = {p + axis: linkage[p][i] for p in "AB" for i, axis in enumerate("xy")} | linkage
    return all(np.isclose(flat[key], keys[key], rtol=1e-9, atol=1e-12) for key in KEYS)


def recorded_motion(problem: Problem, bars: FourBars, on: Circuits, row: Row) -> Motions | None:
    """Returns the motion at the record's crank angles; `None` where it has none, or they break the task's order."""
    if row.crank_deg is None:
        return None
    angles = np.radians(row.crank_deg)
    if problem.timing is not None:
        return recorded_timed(problem, bars, on, angles)
    angles = angles[: len(problem.free_targets()[0])]
    if on.rocks[0]:
        offset = (angles - on.middle + np.pi) % TURN - np.pi
        psi = np.arcsin(np.clip(offset / on.half_width, -1, 1))
        t1_at = np.array(row.t1_at if row.t1_at else [row.keys["t1"]] * len(angles))[: len(angles)]
        angles = np.unwrap(np.where(t1_at > 0, psi, np.pi - psi))
    steps = np.diff(angles) * (1 if angles[-1] >= angles[0] else -1)
    if (steps < -1e-9).any() or abs(angles[-1] - angles[0]) > TURN + 1e-9:
        return None
    t = angles[:, None]
    low, high = np.minimum(t[0], t[-1]), np.maximum(t[0], t[-1])
    if problem.returns:
        low, high = t[0], t[0] + TURN
    return Motions(on, t, *structural(problem, bars, on, t), low, high)


def recorded_timed(problem: Problem, bars: FourBars, on: Circuits, angles: Array) -> Motions | None:
    """Returns the motion at recorded angles of a timed task; `None` where they are not the prescribed ones."""
    timing = problem.timing
    assert timing is not None
    turned = angles - angles[0]
    wanted = timing.crank_angles - timing.crank_angles[0]
    mirrored = timing.offset == "free"
    if not (np.allclose(turned, wanted, atol=1e-9) or (mirrored and np.allclose(turned, -wanted, atol=1e-9))):
        return None
    base = {"fixed": 0.0, "ground": float(np.angle(bars.B - bars.A)[0])}.get(timing.offset)
    if base is not None and abs(np.exp(1j * (angles[0] - base - timing.crank_angles[0])) - 1) > 1e-9:
        return None
    t = angles[:, None]
    low, high = t.min(axis=0), t.max(axis=0)
    if problem.closed:
        high = np.maximum(high, low + TURN)
    return Motions(on, t, *structural(problem, bars, on, t), low, high)


def repeated(bars: FourBars, count: int) -> FourBars:
    """Returns one linkage many times."""
    return bars[np.zeros(count, dtype=int)]


def best_offset(problem: Problem, bars: FourBars, t1: float) -> float:
    """Returns the crank angle's offset of least rms: an even scan, then finer ones."""
    if problem.timing is None or problem.timing.offset != "free":
        return 0.0
    middle, reach, count = 0.0, np.pi, 721
    for _ in range(9):
        offsets = middle + reach * np.linspace(-1, 1, count)
        found = timed_motions(problem, repeated(bars, count), np.full(count, t1), offsets)
        middle = float(offsets[found.rms.argmin()])
        reach, count = reach * 3 / (count - 1), 61
    return middle


def simulated(problem: Problem, row: Row) -> list[Figures]:
    """Returns the figures of every motion that a row may mean: on either circuit, best assigned or as recorded."""
    bars = four_bar(row.keys)
    t1 = np.array([row.keys["t1"]])
    found = []
    for arc in (1.0, -1.0):
        side = np.array([arc])
        sides = (t1, side, np.array([best_offset(problem, bars, row.keys["t1"])]))
        found.append(evaluated(problem, bars, sides, REPORT))
        on = circuits(bars, t1, side)
        if problem.timing is not None:
            on = Circuits(np.array([False]), on.middle, on.half_width, t1)
        motion = recorded_motion(problem, bars, on, row)
        if motion is not None:
            figures = figures_of_motion(problem, bars, motion, REPORT)
            figures.violations = np.vstack([shape_violations(problem, bars), figures.violations])
            found.append(figures)
        if not on.rocks[0]:
            break
    return found


def half_sine_squared(mu_deg: float) -> float:
    """Returns sin^2(mu / 2)."""
    return float(np.sin(np.radians(mu_deg) / 2) ** 2)


def complaints(problem: Problem, row: Row, bars: FourBars, found: Figures) -> list[str]:
    """Returns where a motion differs from the row's figures or breaks a requirement."""
    said = row.figures
    faults = []
    if found.rms[0] > said["rms"] * (1 + RMS_PART) + RMS_TINY * problem.size:
        faults.append(f"rms {found.rms[0]:.9g}, printed {said['rms']:.9g}")
    values = {
        "transmission_deg": found.transmission_deg[0],
        "extent": found.extent[0],
        "longest": bars.longest[0],
        "link_ratio": bars.link_ratio[0],
    }
    for name, value in values.items():
        is_angle = name == "transmission_deg"
        if is_angle and abs(half_sine_squared(value) - half_sine_squared(said[name])) <= ROUNDING:
            continue
        if abs(value - said[name]) > AGREES * max(abs(said[name]), 1.0 if is_angle else 0.0):
            faults.append(f"{name} {value:.9g}, printed {said[name]:.9g}")
    if found.violations.max() > AGREES:
        number = int(found.violations[:, 0].argmax())
        faults.append(f"a requirement is broken by {found.violations.max():.3g} of its scale (row {number})")
    return faults


def faults_of(problem: Problem, row: Row) -> list[str]:
    """Returns what is wrong with a row: the complaints about the motion that suits it best; none if it is right."""
    if row.kind != "four-bar":
        return [f"a {row.kind} is not checked here"]
    bars = four_bar(row.keys)
    return min((complaints(problem, row, bars, found) for found in simulated(problem, row)), key=len)


def beaten_within(rows: list[Row]) -> int:
    """Returns the number of rows that another row of the same front beats: as good on all axes, better on one."""
    count = 0
    for row in rows:
        mine = np.array([row.figures[name] for name in AXES]) * (1, -1, 1)
        for other in rows:
            theirs = np.array([other.figures[name] for name in AXES]) * (1, -1, 1)
            equal = 1e-9 * np.maximum(np.abs(mine), np.abs(theirs))
            if (theirs <= mine + equal).all() and (theirs < mine - equal).any():
                count += 1
                break
    return count
