"""Reads a problem file: targets, bounds and requirements of a path task, with the defaults filled in."""

from __future__ import annotations

import csv
import hashlib
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

# The defaults of a problem file, in sizes of the target where they are lengths.
REACH = 5.0
SHORTEST = 0.02
LONGEST = 3.0
LINK_RATIO = 20.0
# The least length that is searched where a bound of 0 means "any positive length".
LEAST_SEARCHED = 1e-4

TURNING = ("crank-rocker", "double-crank")
TYPES = (*TURNING, "rocker-crank", "double-rocker", "triple-rocker")
LENGTHS = ("a", "b", "c", "d", "e", "ground", "coupler_x", "coupler_y")

Interval = tuple[float, float]


@dataclass(frozen=True)
class Timing:
    """Prescribed crank angles [rad] and the direction from which they count: free, fixed or ground."""

    crank_angles: np.ndarray
    offset: str


@dataclass(frozen=True)
class Require:
    """The requirements of a problem; `None` leaves a quantity free."""

    types: tuple[str, ...]
    transmission_deg_min: float | None
    transmission_over: str | None
    link_ratio_max: float
    longest_max: float | None
    extent_max: float | None
    pivots_in: tuple[float, ...] | None
    footprint_in: tuple[float, ...] | None
    directions: tuple[int, ...]
    branch_any: bool


@dataclass(frozen=True)
class Problem:
    """A path task: the targets as complex numbers, the bounds by name, the requirements."""

    name: str
    points: np.ndarray
    closed: bool
    timing: Timing | None
    tolerance: np.ndarray | None
    bounds: dict[str, Interval]
    require: Require

    @property
    def digest(self) -> str:
        """Returns a digest of all that a search depends on: comments and the name may change."""
        timing = None if self.timing is None else (self.timing.crank_angles.tolist(), self.timing.offset)
        tolerance = None if self.tolerance is None else self.tolerance.tolist()
        bounds = sorted((key, float(low), float(high)) for key, (low, high) in self.bounds.items())
        parts = (self.points.tolist(), self.closed, timing, tolerance, bounds, self.require)
        return hashlib.sha256(repr(parts).encode()).hexdigest()

    @property
    def size(self) -> float:
        """Returns the diagonal of the targets' bounding box."""
        return float(np.hypot(np.ptp(self.points.real), np.ptp(self.points.imag)))

    @property
    def repeats_first(self) -> bool:
        """Returns whether the last target repeats the first."""
        return len(self.points) > 2 and self.points[0] == self.points[-1]

    @property
    def returns(self) -> bool:
        """Returns whether the motion has to come back to its first target."""
        return self.closed or (self.timing is None and self.repeats_first)

    @property
    def must_turn(self) -> bool:
        """Returns whether only a crank that turns fully serves."""
        return self.returns and not self.require.branch_any

    def free_targets(self) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
        """Returns targets, weights and tolerances; a repeated first target becomes one target of weight 2."""
        weights = np.ones(len(self.points))
        if not self.repeats_first:
            return self.points, weights, self.tolerance
        weights[0] = 2.0
        return self.points[:-1], weights[:-1], None if self.tolerance is None else self.tolerance[:-1]


def interval(value: float | list[float]) -> Interval:
    """Returns the bounds of a number: a single number fixes it."""
    return (float(value[0]), float(value[1])) if isinstance(value, list) else (float(value), float(value))


def read_points(path: dict[str, Any], folder: Path) -> np.ndarray:
    """Returns the targets of `points` or of the columns x, y of `file`."""
    if "points" in path:
        return np.array([complex(*xy) for xy in path["points"]])
    lines = (folder / path["file"]).read_text(encoding="utf-8-sig").splitlines()
    rows = list(csv.DictReader(line for line in lines if line.strip() and not line.lstrip().startswith("#")))
    if set(rows[0]) - {"x", "y"}:
        raise ValueError(f"{path['file']}: only the columns x and y are read here")
    return np.array([complex(float(row["x"]), float(row["y"])) for row in rows])


def read_bounds(design: dict[str, Any], points: np.ndarray, size: float) -> dict[str, Interval]:
    """Returns the bounds by name with the defaults where the design table is silent."""
    middle = [0.5 * (part.min() + part.max()) for part in (points.real, points.imag)]
    around = [(m - REACH * size, m + REACH * size) for m in middle]
    length = (SHORTEST * size, REACH * size)
    bounds: dict[str, Interval] = {}
    for pivot in ("A", "B"):
        polar = pivot == "B" and ("ground" in design or "ground_angle_deg" in design)
        if pivot in design or not polar:
            given = [interval(v) for v in design[pivot]] if pivot in design else around
            bounds[pivot + "x"], bounds[pivot + "y"] = given
    for key in ("a", "b", "c", "d", "e", "ground", "ground_angle_deg", "coupler_x", "coupler_y"):
        if key in design:
            bounds[key] = interval(design[key])
    for key in ("a", "b", "c"):
        bounds.setdefault(key, length)
    if not ("A" in design and "B" in design):
        bounds.setdefault("ground", length)
    if "d" not in design and "e" not in design:
        bounds.setdefault("coupler_x", (-REACH * size, REACH * size))
        bounds.setdefault("coupler_y", (-REACH * size, REACH * size))
    return bounds


def read_require(require: dict[str, Any], design: dict[str, Any], free: bool, size: float) -> Require:
    """Returns the requirements with their defaults, the default of size included."""
    known = {
        *("type", "transmission_deg_min", "transmission_over", "link_ratio_max", "longest_max", "extent_max"),
        *("pivots_in", "footprint_in", "order", "direction", "circuit", "branch"),
    }
    other = set(require) - known
    if other or require.get("order", "required") != "required" or require.get("circuit", "one") != "one":
        raise ValueError(f"[require] asks for something that this harness does not know: {sorted(other)}")
    types = require.get("type", [])
    longest = require.get("longest_max")
    if free and longest is None and "extent_max" not in require and not set(design) & set(LENGTHS):
        longest = LONGEST * size
    box = {key: tuple(require[key]) if key in require else None for key in ("pivots_in", "footprint_in")}
    ratio = require.get("link_ratio_max", LINK_RATIO)
    return Require(
        types=tuple([types] if isinstance(types, str) else types) or TYPES,
        transmission_deg_min=require.get("transmission_deg_min"),
        transmission_over=require.get("transmission_over"),
        link_ratio_max=np.inf if ratio == "any" else ratio,
        longest_max=None if longest == "any" else longest,
        extent_max=require.get("extent_max"),
        pivots_in=box["pivots_in"],
        footprint_in=box["footprint_in"],
        directions={"any": (1, -1), "ccw": (1,), "cw": (-1,)}[require.get("direction", "any")],
        branch_any=require.get("branch", "one") == "any",
    )


def read_problem(file: Path) -> Problem:
    """Reads a problem file with a path task; refuses tasks and keys that the harness does not know."""
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    path, design = table["task"]["path"], table.get("design", {})
    if set(path) - {"points", "file", "closed", "tolerance", "timing"} or "mechanism" in design:
        raise ValueError(f"{file}: a key that this harness does not know")
    points = read_points(path, file.parent)
    size = float(np.hypot(np.ptp(points.real), np.ptp(points.imag)))
    timing = None
    if "timing" in path:
        angles = np.radians(np.array(path["timing"]["crank_deg"], dtype=float))
        timing = Timing(angles, path["timing"].get("offset", "free"))
    tolerance = path.get("tolerance")
    return Problem(
        name=table.get("name", file.stem),
        points=points,
        closed=path.get("closed", False),
        timing=timing,
        tolerance=None if tolerance is None else np.broadcast_to(np.array(tolerance, float), points.shape),
        bounds=read_bounds(design, points, size),
        require=read_require(table.get("require", {}), design, timing is None, size),
    )
