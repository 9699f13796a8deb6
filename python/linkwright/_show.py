"""Drawings, animations and bars. Needs matplotlib where it draws; nothing is computed here but places on the page."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from ._result import Candidate, Front, Result

#: The look of the parts.
_CURVE, _TARGET, _LINKS = "#2a6fbb", "#c0392b", "#444444"
#: The columns of the table in a notebook.
_ROWS = 20


def preformatted(text: str) -> str:
    """Returns a text as markup that keeps its columns."""
    return f'<pre style="line-height:1.25">{escape(text)}</pre>'


def result_html(result: Result) -> str:
    """Returns the drawing of the best candidate and the table of all, as markup without scripts."""
    drawing = result.candidates[0].svg() if result.candidates else ""
    return (
        '<div class="linkwright"><div style="max-width:640px">'
        + drawing
        + "</div>"
        + preformatted(result.text)
        + "</div>"
    )


def _matplotlib() -> Any:
    try:
        import matplotlib.pyplot as plt
    except ImportError as missing:
        raise ImportError("drawings need matplotlib: pip install 'linkwright[plot]'") from missing
    return plt


def _axes(ax: Any) -> Any:
    if ax is None:
        ax = _matplotlib().subplots()[1]
    ax.set_aspect("equal", adjustable="datalim")
    return ax


def _target(candidate: Candidate) -> Any:
    """The places of the targets, shape (n, 2); those of the follower's or the slider's pin in a function."""
    import numpy as np

    task = candidate.result.record["problem"]["resolved"]["task"]
    if "function" in task:
        linkage: Any = candidate.linkage
        sign = -1 if candidate.sense == "opposite" else 1
        if candidate.data["linkage"].get("kind") == "slider-crank":
            along = np.radians(linkage.line_deg)
            s = np.array([np.cos(along), np.sin(along)])
            pivot, point = np.array(linkage.A), np.array(linkage.line_point)
            foot = point + s * np.dot(pivot - point, s)
            places = sign * (candidate.output_offset + np.asarray(task["function"]["output"], dtype=float))
            return foot + places[:, None] * s
        if "kind" in candidate.data["linkage"]:
            return np.empty((0, 2))
        (ax, ay), (bx, by) = linkage.A, linkage.B
        ground = np.degrees(np.arctan2(by - ay, bx - ax))
        outputs = np.asarray(task["function"]["output_deg"], dtype=float)
        # Where the range is free, the task says proportions alone.
        if "output_range_deg" in candidate.data:
            outputs = outputs * (candidate.output_range_deg / np.ptp(outputs))
        psi = np.radians(ground + candidate.output_offset_deg + sign * outputs)
        return np.stack([bx + linkage.c * np.cos(psi), by + linkage.c * np.sin(psi)], axis=-1)
    places = task["path"]["points"] if "path" in task else [pose[:2] for pose in task["motion"]["poses"]]
    return np.asarray(places, dtype=float)


def _first_angle(candidate: Candidate) -> float:
    import math

    angles = candidate.data.get("crank_deg") or [0.0]
    first = angles[0]
    return math.radians(first) if first is not None else 0.0


def plot_candidate(candidate: Candidate, ax: Any = None, *, links: bool = True, **options: Any) -> Any:
    """Draws coupler curve, target and linkage."""
    ax = _axes(ax)
    target = _target(candidate)
    ax.plot(target[:, 0], target[:, 1], "o", color=_TARGET, markersize=4, label="target", zorder=3)
    linkage, angle = candidate.linkage, _first_angle(candidate)
    curve = linkage.coupler_curve(angle)
    style = {"color": _CURVE, "linewidth": 1.5, "label": "coupler curve", **options}
    closed = [*range(len(curve)), 0]
    ax.plot(curve[closed, 0], curve[closed, 1], **style)
    if links:
        _links(ax, linkage, angle)
    ax.legend(loc="best", fontsize="small")
    return ax


def _links(ax: Any, linkage: Any, angle: float) -> list[Any]:
    style = {"color": _LINKS, "linewidth": 2.0, "solid_capstyle": "round", "zorder": 2}
    moving = ax.plot([], [], "-o", markersize=4, **style)[0]
    plate = ax.fill([0, 0, 0], [0, 0, 0], color=_LINKS, alpha=0.15, zorder=1)[0]
    pivots = [linkage.A] if linkage.B is None else [linkage.A, linkage.B]
    ax.plot(*zip(*pivots), "^", color="black", markersize=7, zorder=4)
    if hasattr(linkage, "line_point") and linkage.line_point is not None:
        ax.axline(linkage.line_point, slope=_slope(linkage.line_deg), color="black", linewidth=0.8, zorder=1)
    _pose(moving, plate, linkage, angle)
    return [moving, plate]


def _slope(deg: float) -> float:
    import math

    upright = abs(math.cos(math.radians(deg))) < 1e-12
    return math.inf if upright else math.tan(math.radians(deg))


def _pose(moving: Any, plate: Any, linkage: Any, angle: float) -> None:
    at = linkage.positions(angle)
    joints = [linkage.A, tuple(at.C), tuple(at.D)]
    if linkage.B is not None:
        joints.append(linkage.B)
    moving.set_data([x for x, _ in joints], [y for _, y in joints])
    plate.set_xy([tuple(at.C), tuple(at.P), tuple(at.D)])


def animate_candidate(
    candidate: Candidate, ax: Any = None, *, frames: int = 72, interval: int = 40, **options: Any
) -> Any:
    """Returns an animation of a turn of the crank, or of its range there and back."""
    plt = _matplotlib()
    import numpy as np
    from matplotlib.animation import FuncAnimation

    ax = plot_candidate(candidate, ax, links=False)
    linkage = candidate.linkage
    mobility = linkage.mobility
    first = _first_angle(candidate)
    if mobility["input_turns_fully"]:
        angles = first + np.linspace(0, 2 * np.pi, frames, endpoint=False)
    else:
        arcs = np.radians(np.asarray(mobility["input_arcs_deg"], dtype=float))
        inside = [arc for arc in arcs if (first - arc[0]) % (2 * np.pi) <= arc[1] - arc[0]]
        low, high = inside[0] if inside else arcs[0]
        there = np.linspace(low, high, frames // 2 + 2)[1:-1]
        angles = np.concatenate([there, there[::-1]])
    moving, plate = _links(ax, linkage, first)

    def draw(i: int) -> list[Any]:
        _pose(moving, plate, linkage, float(angles[i]))
        return [moving, plate]

    moved = FuncAnimation(ax.figure, draw, frames=len(angles), interval=interval, blit=True, **options)
    # In a notebook the animation is shown, and not its first picture beside it.
    plt.close(ax.figure)
    return _Playing(moved)


class _Playing:
    """An animation that plays in a notebook; everything else is matplotlib's."""

    def __init__(self, animation: Any) -> None:
        self.animation = animation

    def __getattr__(self, name: str) -> Any:
        return getattr(self.animation, name)

    def _repr_html_(self) -> str:
        html: str = self.animation.to_jshtml()
        return html


def plot_front(front: Front, ax: Any = None, **options: Any) -> Any:
    """Draws the members over the first two axes."""
    if ax is None:
        ax = _matplotlib().subplots()[1]
    names = {"transmission": "transmission_deg"}
    x, y = (names.get(axis, axis) for axis in front.axes[:2])
    figures = front.figures
    style = {"marker": "o", "linestyle": "none", "color": _CURVE, **options}
    ax.plot([f[x] for f in figures], [f[y] for f in figures], **style)
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    return ax


def bar(name: str) -> tuple[Callable[[dict[str, Any]], object], Callable[[], None]]:
    """Returns a progress callback with tqdm's bar, or with lines where tqdm is not there; and what ends it."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _lines(name)
    shown = tqdm(desc=name, leave=False, delay=0.7)

    def told(progress: dict[str, Any]) -> None:
        done, total = _share(progress)
        shown.total = total
        shown.n = min(done, total)
        shown.set_postfix_str(_beside(progress), refresh=False)
        shown.refresh()

    return told, shown.close


def _lines(name: str) -> tuple[Callable[[dict[str, Any]], object], Callable[[], None]]:
    import sys
    import time

    last = time.monotonic()

    def told(progress: dict[str, Any]) -> None:
        nonlocal last
        if time.monotonic() - last >= 5.0:
            last = time.monotonic()
            done, total = _share(progress)
            print(f"{name}: {done} of {total}, {_beside(progress)}", file=sys.stderr)

    return told, lambda: None


def _share(progress: dict[str, Any]) -> tuple[int, int]:
    if "evaluations" in progress:
        return progress["evaluations"], progress["budget"]
    if "total" in progress:
        return progress["done"], progress["total"]
    return round(100 * progress.get("decided", 0.0)), 100


def _beside(progress: dict[str, Any]) -> str:
    best = progress.get("best_sum_sq")
    if best is None:
        return str(progress["phase"])
    return f"best {best:.4e}" if progress["accepted"] else f"best {best:.4e} (not acceptable yet)"
